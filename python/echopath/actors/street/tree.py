"""Trees: a trunk, branches, and bunches of leaves that fill a crown."""
from __future__ import annotations

import numpy as np

from ... import _core
from ...arguments.checks import checked, count, seed as seed_rule
from ..actor import Actor, Part
from ..limits import size_rule
from ..solids import tube
from ..surfaces import joined

# Wet leaves that lie at random, effective: reflectivity and share of the crown that bunches cover make a cross section of
# about -10 dB per square metre of crown, in the middle of what is told of broadleaf trees at 95 GHz (-15 to -8 dB; quoted
# from memory of handbooks).
FOLIAGE = _core.Material(reflectivity=0.06, scattering=1.0)
BARK = _core.Material(permittivity=complex(4.0, -1.0), scattering=1.0)
TRUNK_SHARE = 0.035     # radius of the trunk over the height of the tree, at the ground
NUM_BRANCHES = 9


@checked(height=size_rule, crown_radius=size_rule, num_bunches=count(1, 1_000_000), bunch_size=size_rule,
         seed=seed_rule)
def tree(*, height: float = 7.0, crown_radius: float = 2.0, num_bunches: int = 900, bunch_size: float = 0.28,
         seed: int = 1) -> Actor:
    """A broadleaf tree at the origin: a rough trunk with branches, and bunches of leaves as small rough facets.

    The crown is an ellipsoid volume whose facets are nearer to its rim than to its middle; rays reach into it. All echoes
    are diffuse. Parts: trunk, branches, crown.
    height: m. crown_radius: m, across; the crown reaches from 0.35 of the height to its top. num_bunches: number of
    facets, squares whose sides are 0.6 to 1.3 times `bunch_size` m. seed: of their places and of the branches.
    Raises TypeError or ValueError naming the argument.
    """
    random = np.random.default_rng(seed)
    middle, semi = np.array([0.0, 0.0, 0.675 * height]), np.array([crown_radius, crown_radius, 0.325 * height])
    trunk = tube((0, 0, -0.05), (0, 0, 0.7 * height), TRUNK_SHARE * height, 0.3 * TRUNK_SHARE * height, segments=10)
    return Actor([Part("trunk", _core.Mesh(*trunk), BARK),
                  Part("branches", _core.Mesh(*_branches(random, height, middle, semi)), BARK),
                  Part("crown", _core.Mesh(*_bunches(random, middle, semi, num_bunches, bunch_size)), FOLIAGE)])


def _branches(random, height, middle, semi):
    bars = []
    for n in range(NUM_BRANCHES):
        angle = 2.399963 * n + random.uniform(-0.3, 0.3)   # the golden angle, as shoots grow
        rise = random.uniform(-0.5, 0.6)
        tip = middle + 0.8 * semi * np.array([np.cos(angle) * np.sqrt(1 - rise**2), np.sin(angle) * np.sqrt(1 - rise**2), rise])
        root = np.array([0.0, 0.0, max(0.3 * height, tip[2] - 0.18 * height)])
        bars.append(tube(root, tip, 0.25 * TRUNK_SHARE * height, 0.08 * TRUNK_SHARE * height, segments=5))
    return joined(*bars)


def _bunches(random, middle, semi, number, size):
    """Squares of random place and direction in the ellipsoid."""
    direction = _unit(random.normal(size=(number, 3)))
    place = middle + direction * semi * (random.uniform(0.12, 1.0, size=(number, 1)) ** (1 / 4))
    normal = _unit(random.normal(size=(number, 3)))
    u = _unit(np.cross(normal, _unit(random.normal(size=(number, 3)))))
    v = np.cross(normal, u)
    half = 0.5 * size * random.uniform(0.6, 1.3, size=(number, 1))
    corners = np.stack([place - half * u - half * v, place + half * u - half * v, place + half * u + half * v,
                        place - half * u + half * v], axis=1).reshape(-1, 3)
    first = 4 * np.arange(number)[:, None]
    return corners, np.concatenate([first + [0, 1, 2], first + [0, 2, 3]])


def _unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
