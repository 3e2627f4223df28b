"""Remarks on scenes whose lengths look like those of other units."""
from __future__ import annotations

import warnings

import numpy as np

from . import _core

LARGE = 1000.0     # m, all sides of an object that no scene has
LONG = 250.0       # m, all sides of a closed body: mountains are as high, but open below
SMALL = 0.5        # wavelengths, the longest side of an object


def warn_of_sizes(scene: _core.Scene, wavelength: float, time: float, stacklevel: int = 2) -> None:
    """Warns (RuntimeWarning) of an empty scene, and of objects that look as if their lengths were not in m.

    wavelength: m; time: s, at which the scene is looked at; one outside of its motions is not for this to tell of
    """
    meshes = scene.meshes
    try:
        sides = _sides(scene, meshes, time)
    except ValueError:
        return
    remark = _remark(sides, wavelength) if meshes else "scene: has no mesh that takes part: no ray hits"
    if remark:
        warnings.warn(remark, RuntimeWarning, stacklevel=stacklevel + 1)


def _sides(scene, meshes, time: float) -> dict:
    """{name: (shortest, longest side of its bounding box in m, whether its meshes are closed)} of the children of the root."""
    corners: dict = {}
    is_closed: dict = {}
    for mesh in meshes:
        vertices, name = np.asarray(scene.world_vertices(mesh.id, time)), mesh.name.split("/")[0]
        corners.setdefault(name, []).extend([vertices.min(axis=0), vertices.max(axis=0)])
        is_closed[name] = is_closed.get(name, True) and mesh.mesh.is_closed
    sides = {name: np.ptp(ends, axis=0) for name, ends in corners.items()}
    return {name: (float(side.min()), float(side.max()), is_closed[name]) for name, side in sides.items()}


def _remark(sides: dict, wavelength: float) -> str:
    for name, (shortest, longest, is_closed) in sides.items():
        if shortest > LARGE or (longest > LARGE and shortest > LONG and is_closed):
            return (f"scene: '{name}' is {longest:,.0f} m long and {shortest:,.0f} m thick; is it in mm? "
                    "load_mesh(path, unit=0.001) reads such files")
        if longest < SMALL * wavelength:
            return (f"scene: '{name}' is {longest:.3g} m large, less than half a wavelength ({wavelength:.3g} m), where ray "
                    "optics ends; is it in m?")
    return ""
