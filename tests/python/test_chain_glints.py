"""Rays lie closer about points of reflection behind bounces off curved surfaces: two bodies against geometrical optics."""
import numpy as np
import pytest
from scipy.optimize import least_squares

import echopath as ep
from echopath.bench.closed_forms import WAVELENGTH
from echopath.bench.crowd_coverage import FLANK_AND_BALL, flank_and_ball
from echopath.bench.targets import radar

RAYS, SEEDS = 1 << 16, 3
LEVEL_DB = 0.25     # of the mean; without such foci it is 1.7 to 2.2 dB low
SCATTER_DB = 0.8    # of a seed
STEP = 1e-7         # rad, of launch directions
TURNS = np.linspace(-0.3, 0.3, 3001)  # rad, from the middle of the first body: where the search begins


def met(start, direction, centre, semi_axes):
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


def reflected(direction, bodies):
    """(last point, direction behind it) of a ray from the origin off all bodies in turn, or None."""
    start = np.zeros(3)
    for centre, semi_axes in bodies:
        found = met(start, direction, centre, semi_axes)
        if found is None:
            return None
        start, normal = found
        direction = direction - 2.0 * (direction @ normal) * normal
    return start, direction


def power_by_geometrical_optics(bodies, transmit_power: float) -> float:
    """W, of the ray from the origin off all bodies back to the origin, isotropic antennas: Pt/(4 pi) (dOmega/dA) lambda^2/(4 pi).

    bodies: [(centre, semi-axes)] of ellipsoids that stand upright at one height, in the order in which they are met
    """
    ahead = bodies[0][0] / np.linalg.norm(bodies[0][0])
    aside = np.cross(ahead, [0.0, 0.0, 1.0])
    above = np.cross(aside, ahead)

    def launched(turn):
        direction = ahead + turn[0] * aside + turn[1] * above
        return reflected(direction / np.linalg.norm(direction), bodies)

    def miss(turn):
        found = launched(turn)
        if found is None or found[0] @ found[1] >= 0.0:
            return np.array([10.0, 10.0])
        point, direction = found
        nearest = point - (point @ direction) * direction
        return np.array([nearest @ np.cross(direction, [0.0, 0.0, 1.0]), nearest[2]])

    first = min(TURNS, key=lambda turn: np.linalg.norm(miss((turn, 0.0))))
    root = least_squares(miss, (first, 0.0), xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale=1e-3).x
    _, direction = launched(root)

    def arrives(turn):
        """At the plane through the origin across the ray."""
        point, of_ray = launched(turn)
        return point - of_ray * (point @ direction) / (of_ray @ direction)

    across, up = ((arrives(root + STEP * axis) - arrives(root - STEP * axis)) / (2.0 * STEP) for axis in np.eye(2))
    assert np.linalg.norm(miss(root)) < 1e-9
    return transmit_power * WAVELENGTH ** 2 / ((4.0 * np.pi) ** 2 * abs(np.cross(across, up) @ direction))


@pytest.mark.parametrize("order", [("ball", "flank"), ("flank", "ball")])
def test_the_echo_over_two_curved_bodies_is_that_of_geometrical_optics(order):
    truth = power_by_geometrical_optics([FLANK_AND_BALL[name] for name in order], radar().transmit_power)
    expression = "T '{}' '{}' R".format(*order)
    found = [ep.received_power(ep.trace(flank_and_ball(), radar(), num_rays=RAYS, max_bounces=2, seed=seed).select(expression))
             for seed in range(1, SEEDS + 1)]
    error_db = 10.0 * np.log10([one.power / truth for one in found])
    assert abs(error_db.mean()) < LEVEL_DB and np.abs(error_db).max() < SCATTER_DB
    assert all(one.low <= truth <= one.high for one in found)
