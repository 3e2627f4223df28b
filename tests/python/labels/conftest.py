"""What tests of labels share."""
from __future__ import annotations

import pytest

import echopath as ep
from support.scenes.small_spheres import TARGETS, radar_with, scene_of


@pytest.fixture(scope="module")
def spheres():
    """(radar, paths, spectrum with noise) of three spheres at known places and speeds."""
    radar = radar_with()
    paths = ep.trace(scene_of(TARGETS), radar, num_rays=6000, max_bounces=1)
    return radar, paths, ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)
