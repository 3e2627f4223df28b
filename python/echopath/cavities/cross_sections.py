"""Cross sections of bodies with cavities: rays outside, waves inside."""
from __future__ import annotations

import numpy as np

from .. import _core
from .cavity import Cavity
from .walls import facets_of
from .waves import cavity_field

LEAST_SINE = 1e-9  # of the angle to the z axis, below which horizontal is along x


def rcs_with_cavities(scene: _core.Scene, cavities: tuple[Cavity, ...], *, frequency, incidence, observation, polarization,
                      components, **tracing):
    """What `ep.rcs` returns, of rays that stay outside of the cavities and the waves in these, in m^2."""
    walls = [([mesh.id for mesh in one.meshes_in(scene)], one.mouth[0], _normal_of(one)) for one in cavities]
    _check_walls(scene, [mesh for meshes, _, _ in walls for mesh in meshes])
    wavenumber = 2.0 * np.pi * frequency / _core.speed_of_light
    facets = [facets_of(scene, one, 2.0 * np.pi / wavenumber) for one in cavities]  # before the rays: it may refuse them
    rays = _core.rcs(scene, frequency=frequency, incidence=incidence, observation=observation, polarization=polarization,
                     cavities=walls, **tracing)
    channels, is_list = _channels_of(polarization)
    toward, back = _directions_of(incidence, observation)
    pairs = [_across(toward, back, channel) for channel in channels]
    count, shape = len(toward), (len(channels), len(toward))
    waves = [np.concatenate(columns) for columns in zip(*((toward, back, *pair) for pair in pairs))]
    inside = sum(cavity_field(*one, wavenumber, *waves) for one in facets).reshape(shape).T
    is_one = np.ndim(incidence) == 1 and (observation is None or np.ndim(observation) == 1)
    inside = inside.reshape((() if is_one else (count,)) + ((len(channels),) if is_list else ()))
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


def _channels_of(polarization) -> tuple[list, bool]:
    """Pairs (transmitted, received) of "v", "h" or a vector [3], and whether they are a list."""
    if isinstance(polarization, str):
        return [tuple(polarization)], False
    if isinstance(polarization[0], str):
        return [tuple(name) for name in polarization], True
    vectors = np.atleast_2d(np.asarray(polarization, float))
    return [(vectors[0], vectors[-1])], False


def _directions_of(incidence, observation) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors [N, 3] toward both antennas."""
    toward = np.atleast_2d(np.asarray(incidence, float))
    back = toward if observation is None else np.atleast_2d(np.asarray(observation, float))
    return tuple(np.broadcast_arrays(*(one / np.linalg.norm(one, axis=1)[:, None] for one in (toward, back))))


def _across(toward, back, channel) -> list[np.ndarray]:
    """Unit vectors [N, 3] of the polarisations of both antennas."""
    return [_polarization(part, sight) for part, sight in zip(channel, (toward, back))]


def _polarization(part, sight) -> np.ndarray:
    """[N, 3] across lines of sight [N, 3], by the rule of em/polarization/jones.h for "v" and "h"."""
    if isinstance(part, str):
        level = np.hypot(sight[:, 0], sight[:, 1])
        turned = np.column_stack([-sight[:, 1], sight[:, 0], 0.0 * level]) / np.maximum(level, 1e-300)[:, None]
        along_x = np.sign(sight[:, 2])[:, None] * [1.0, 0.0, 0.0]
        horizontal = np.where(level[:, None] > LEAST_SINE, turned, along_x)
        return horizontal if part == "h" else np.cross(sight, horizontal)
    rest = part / np.linalg.norm(part)
    rest = rest - (sight @ rest)[:, None] * sight
    return rest / np.linalg.norm(rest, axis=1)[:, None]
