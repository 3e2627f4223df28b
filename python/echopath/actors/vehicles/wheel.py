"""Wheels: tyre, and rim with spokes, that turn about their axle as they roll.

A wheel's mesh lies about its centre with the axle along y; its outer side is +y.
"""
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ... import _core
from .. import solids
from ..actor import Part
from ..surfaces import joined


@dataclass(frozen=True)
class Wheel:
    """In m: diameter over the tread, width, rim_diameter; num_spokes, of spoke_width."""

    diameter: float
    width: float
    rim_diameter: float
    num_spokes: int = 5
    spoke_width: float = 0.07
    segments: int = 24

    @property
    def radius(self):
        return self.diameter / 2


def wheel_parts(wheel, name, center, driving, *, outer=1.0, wheelbase=None):
    """Parts name/tyre and name/rim of a wheel at `center` [3] that rolls as its vehicle drives (driving.Driving).

    outer: 1 where its outer side faces left, -1 right. wheelbase: m, of a wheel that steers along a trajectory.
    """
    tyre, rim = _meshes(wheel, outer)
    motion = driving.wheel(wheel.radius, center=center, wheelbase=wheelbase)
    place = tuple(float(value) for value in center)
    return [Part(f"{name}/tyre", tyre, "rubber", motion, place, smooth=True),
            Part(f"{name}/rim", rim, "metal", motion, place, smooth=True)]


@lru_cache(maxsize=64)
def _meshes(wheel, outer):
    """Meshes of tyre and rim, which wheels share; the wheel of the right side is that of the left one, turned about z."""
    turn = np.array([outer, outer, 1.0])
    return [_core.Mesh(vertices * turn, triangles) for vertices, triangles in (_tyre(wheel), _rim(wheel))]


def _tyre(wheel):
    """Tread, shoulders and side walls; it ends inside the rim's flanges."""
    radius, half, bead = wheel.radius, wheel.width / 2, wheel.rim_diameter / 2
    profile = [(bead, -0.84 * half), (0.6 * bead + 0.4 * radius, -half), (radius, -0.75 * half), (radius, 0.75 * half),
               (0.6 * bead + 0.4 * radius, half), (bead, 0.84 * half)]
    return solids.revolved(profile, 3 * wheel.segments // 4)


def _rim(wheel):
    """Barrel under the tyre, dished spokes from hub to barrel near the outer side."""
    bead, half = 0.995 * wheel.rim_diameter / 2, wheel.width / 2
    thick = 0.02 * wheel.diameter
    barrel = solids.revolved([(bead - thick, -0.8 * half), (bead, -0.8 * half), (bead, 0.86 * half),
                              (bead - thick, 0.86 * half)], wheel.segments)
    hub = 0.17 * wheel.rim_diameter
    disc = solids.revolved([(0.0, 0.35 * half), (hub, 0.35 * half), (hub, 0.62 * half), (0.55 * hub, 0.72 * half),
                            (0.0, 0.74 * half)], max(12, wheel.segments // 2))
    spokes = [_spoke(wheel, 2 * np.pi * n / wheel.num_spokes, 0.9 * hub, bead - 0.5 * thick) for n in range(wheel.num_spokes)]
    return joined(barrel, disc, *spokes)


def _spoke(wheel, angle, begin, end):
    half, middle = wheel.spoke_width / 2, wheel.width / 2
    corners = np.array([[r, y, s * w] for r, w, ys in ((begin, 1.0, (0.40, 0.60)), (end, 0.75, (0.58, 0.78)))
                        for y in ys for s, w in ((-half, w), (half, w))])
    corners[:, 1] *= middle
    vertices = np.stack([corners[:, 0] * np.cos(angle) - corners[:, 2] * np.sin(angle), corners[:, 1],
                         corners[:, 0] * np.sin(angle) + corners[:, 2] * np.cos(angle)], axis=-1)
    return solids.hexahedron(vertices)
