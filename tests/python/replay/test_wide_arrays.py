"""Arrays wider than the ways to what they see: no path is left out whose launch cell is dark to some antennas alone."""
import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar

RELATIVE = 1e-6  # of the strongest sample: what interpolation between nodes may err


def paths_of(transmitters, receivers, num_rays):
    """A ball that comes nearer in front, a wall that follows behind, both within a metre."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material="metal", position=(0.6, 0.0, 0.0), smooth=True,
              motion=ep.LinearMotion((1.0, 0.2, 0.0)))
    scene.add(ep.actors.plate(4.0, 4.0), name="wall", material="metal", position=(-0.6, 0.0, 0.0),
              motion=ep.LinearMotion((0.5, 0.0, 0.0)))
    radar = build_radar(transmitters, receivers, num_samples=32, num_chirps=32)
    return ep.trace(scene, radar, num_rays=num_rays, max_bounces=3), radar


@pytest.mark.parametrize("width", [0.3, 2.0, 8.0])
@pytest.mark.parametrize("side", ["transmitters", "receivers"])
def test_every_channel_of_a_wide_array_has_the_echo_of_each_chirp(width, side):
    alone, apart = [(0.0, 0.0, 0.0)], [(0.0, 0.0, 0.0), (0.0, width, 0.0)]
    num_rays = 10_000 if width < 4.0 else 30_000  # few of those of an antenna far aside meet the ball
    paths, radar = paths_of(*((apart, alone) if side == "transmitters" else (alone, apart)), num_rays)
    for some in (paths, paths.select("T 'ball' 'wall' R"), paths.select("T 'wall' 'ball' R")):
        assert some.num_paths > 0
        found, expected = ep.synthesize(some, radar), ep.synthesize(some, radar, evaluate="chirps")
        assert np.abs(found - expected).max() < RELATIVE * np.abs(expected).max()
