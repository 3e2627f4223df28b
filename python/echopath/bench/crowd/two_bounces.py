"""Geometrical optics of a ray off several curved bodies and back, the truth for echoes over them."""
from __future__ import annotations

import numpy as np

from ...actors.surfaces import cross
from ..physics.closed_forms import WAVELENGTH

_TURNS = np.linspace(-0.3, 0.3, 3001)  # rad, from the middle of the first body: where the search begins
_STEP = 1e-7                           # rad, of launch directions
_STEPS = 30
_UPWARD = np.array([0.0, 0.0, 1.0])
_HITS = 1e-9                           # m, from the origin


def power_over_ellipsoids(bodies, transmit_power: float) -> float:
    """Power in W of the ray from the origin off all bodies back to the origin, isotropic antennas, metal.

    Pt/(4 pi) (dOmega/dA) lambda^2/(4 pi), with the area dA at the receiver of the tube that leaves in dOmega
    bodies: [(centre, semi-axes)] in m, axes along x, y, z, of ellipsoids at the height of the origin, in the order in which
    they are met; transmit_power: W. Raises ValueError where no ray comes back.
    """
    chain = _Chain(bodies)
    turn = np.array([min(_TURNS, key=lambda turn: np.linalg.norm(chain.miss((turn, 0.0)))), 0.0])
    for _ in range(_STEPS):
        turn = turn - np.linalg.solve(_slope(chain.miss, turn), chain.miss(turn))
    if not np.linalg.norm(chain.miss(turn)) < _HITS:
        raise ValueError("bodies: must send a ray back to the origin, got none")
    direction = chain.reflected(turn)[1]

    def arrival(turn):
        """Where a ray meets the plane through the origin across the one that comes back."""
        point, of_ray = chain.reflected(turn)
        return point - of_ray * (point @ direction) / (of_ray @ direction)

    across, up = _slope(arrival, turn).T
    return transmit_power * WAVELENGTH ** 2 / ((4.0 * np.pi) ** 2 * abs(np.cross(across, up) @ direction))


def _slope(function, turn):
    """Derivatives [value, 2] by both turns."""
    steps = _STEP * np.eye(2)
    return np.column_stack([(function(turn + step) - function(turn - step)) / (2.0 * _STEP) for step in steps])


class _Chain:
    """Rays from the origin, launched by turns in rad (aside, up) from the middle of the first body."""

    def __init__(self, bodies):
        self._bodies = [(np.asarray(centre, float), np.asarray(semi_axes, float)) for centre, semi_axes in bodies]
        self._ahead = self._bodies[0][0] / np.linalg.norm(self._bodies[0][0])
        self._aside = cross(self._ahead, _UPWARD)
        self._up = cross(self._aside, self._ahead)

    def reflected(self, turn):
        """(last point, direction behind it), or None for a ray that misses a body."""
        direction = self._ahead + turn[0] * self._aside + turn[1] * self._up
        direction, start = direction / np.linalg.norm(direction), np.zeros(3)
        for centre, semi_axes in self._bodies:
            found = _met(start, direction, centre, semi_axes)
            if found is None:
                return None
            start, normal = found
            direction = direction - 2.0 * (direction @ normal) * normal
        return start, direction

    def miss(self, turn):
        """How far aside and above the origin the ray passes it, m; far away where it does not come near."""
        found = self.reflected(turn)
        if found is None or found[0] @ found[1] >= 0.0:
            return np.array([10.0, 10.0])
        point, direction = found
        nearest = point - (point @ direction) * direction
        return np.array([nearest @ cross(direction, _UPWARD), nearest[2]])


def _met(start, direction, centre, semi_axes):
    """(point, unit normal) where a line first meets an ellipsoid, or None."""
    begin, way = (start - centre) / semi_axes, direction / semi_axes
    square, product = way @ way, begin @ way
    rest = product ** 2 - square * (begin @ begin - 1.0)
    distance = (-product - np.sqrt(max(rest, 0.0))) / square
    if rest <= 0.0 or distance <= 1e-6:
        return None
    point = start + distance * direction
    normal = (point - centre) / semi_axes ** 2
    return point, normal / np.linalg.norm(normal)
