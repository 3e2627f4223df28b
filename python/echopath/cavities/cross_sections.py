"""Cross sections of bodies with cavities: rays outside, waves inside."""
from __future__ import annotations

import numpy as np

from .. import _core
from .cavity import Cavity
from .walls import facets_of
from .waves import cavity_field


def rcs_with_cavities(scene: _core.Scene, cavities: tuple[Cavity, ...], *, frequency, components, **tracing):
    """What `ep.rcs` returns, of rays that stay outside of the cavities and the waves in these, in m^2.

    tracing: the other keywords of `ep.rcs`
    """
    walls = [([mesh.id for mesh in one.meshes_in(scene)], one.mouth[0], _normal_of(one)) for one in cavities]
    _check_walls(scene, [mesh for meshes, _, _ in walls for mesh in meshes])
    wavenumber = 2.0 * np.pi * frequency / _core.speed_of_light
    facets = [facets_of(scene, one, 2.0 * np.pi / wavenumber) for one in cavities]  # before the rays: it may refuse them
    rays = _core.rcs(scene, frequency=frequency, cavities=walls, **tracing)
    waves = [rays[name] for name in ("incidence", "observation", "transmitted", "received")]
    inside = sum(cavity_field(*one, wavenumber, *waves) for one in facets).reshape(np.shape(rays["field"]))
    coherent = 4.0 * np.pi * np.abs(rays["field"] + inside) ** 2
    parts = {name: float(part) if np.ndim(part) == 0 else part
             for name, part in (("coherent", coherent), ("diffuse", rays["diffuse"]))}
    return parts if components else parts["coherent"] + parts["diffuse"]


def _check_walls(scene, meshes: list) -> None:
    """Raises ValueError for a mesh that lines two cavities. meshes: IDs of the walls of all"""
    twice = [mesh.name for mesh in scene.meshes if meshes.count(mesh.id) > 1]
    if twice:
        raise ValueError(f"cavities: each mesh must line one cavity, {twice[0]!r} lines two")


def _normal_of(cavity) -> np.ndarray:
    """A unit normal [3] of the mouth."""
    corners = cavity.triangles_of_mouth
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
    return normal / np.linalg.norm(normal)
