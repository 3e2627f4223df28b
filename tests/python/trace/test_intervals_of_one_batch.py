"""Intervals of powers that one lattice of rays claims: how often they hold what many more rays say."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors import shapes
from echopath.bench.physics import targets

RAYS, SEEDS = 3000, 40
TRUE_RAYS = 2 ** 19
LEAST, MOST_TOO_WIDE = 0.85, 4.0  # of 95 %, which 40 scenes know to 7 %; of half an interval over 1.96 standard deviations
ROUGH = ep.Material(reflectivity=0.3, scattering=1.0)


def _tree():
    return ep.actors.tree()


def _ball():
    return shapes.sphere(0.5, edge=0.05)


@pytest.mark.parametrize("body, sampler", [(_tree, "lattice"), (_ball, "lattice"), (_tree, "random"), (_ball, "random")])
def test_they_hold_the_power_and_are_not_much_wider(body, sampler):
    """Of a crown, in which rays next to each other hit leaves of any direction, and of a ball, which has one outline."""
    scene = ep.Scene()
    scene.add(body(), name="body", position=(15.0, 0.0, 0.0), material=None if body is _tree else ROUGH)

    def power(num_rays, seed, of=sampler):
        paths = ep.trace(scene, targets.radar(), max_bounces=1, num_rays=num_rays, seed=seed, sampler=of)
        return ep.received_power(paths)

    truth = power(TRUE_RAYS, 1000, "lattice").power
    found = [power(RAYS, seed) for seed in range(SEEDS)]
    assert np.mean([one.low <= truth <= one.high for one in found]) > LEAST
    wide = np.median([one.high - one.low for one in found]) / (2.0 * 1.96 * np.std([one.power for one in found]))
    assert wide < MOST_TOO_WIDE
