"""A few paths that stand for all of those from another radar."""
import numpy as np
import pytest

import echopath as ep
from echopath.signals.interference_paths import few_paths
from support.hand_made import diffuse_paths
from support.radars import build_radar

C = ep.speed_of_light
COUNT, RATE = 256, 20e6
RECEIVER = build_radar(num_samples=COUNT, position=(0, 0, 1))
SENDER = build_radar(num_samples=COUNT, position=(20, 0, 1))  # parallel chirps: each path is a tone at the beat of its delay
SHARE = 2e-3     # relative: one kept path of about 1024, and the thousandth that may be left out of few paths
RANGE_SHARE = 0.05  # relative: of the power of a tenth of the paths, about 100 kept ones
LEVEL = 1.0      # dB: speckle of a hundred beats


def traced(num_rays, *, is_rough, seed=1):
    """Paths over a rough wall, or over a car, whose rays add up as fields."""
    scene = ep.Scene()
    if is_rough:
        scene.add(ep.actors.wall(length=40.0, height=8.0), name="wall", position=(10, 4, -4),
                  material=ep.Material(permittivity=5 - 0.3j, scattering=1.0))
    else:
        scene.add(ep.actors.car(), name="car", position=(10, 3, 0))
    return ep.trace(scene, ep.interference_radar(RECEIVER, SENDER), num_rays=num_rays, max_bounces=1, seed=seed)


def lengths(paths):
    return paths.lengths([paths.frame.trace_time], 0, 0)[0]


def fields(paths):
    turned = np.exp(-2j * np.pi * 77e9 / C * lengths(paths))
    return paths.amplitudes([paths.frame.trace_time], 0, 0)[0] * turned


def test_diffuse_paths_keep_their_power_at_every_length():
    paths = traced(30_000, is_rough=True)
    few, scale = few_paths(paths)
    assert few.num_paths < 1100 < 10_000 < paths.num_paths
    kept = few.power * scale ** 2
    assert kept.sum() == pytest.approx(paths.power.sum(), rel=SHARE)
    edges = np.quantile(lengths(paths), np.linspace(0, 1, 11))
    whole, found = (np.histogram(lengths(which), edges, weights=power)[0]
                    for which, power in ((paths, paths.power), (few, kept)))
    np.testing.assert_allclose(found, whole, rtol=RANGE_SHARE)


def test_paths_that_add_up_as_fields_keep_their_field():
    """A car of 50 000 rays; 17 dB are lost where the strongest stand for all."""
    paths = traced(100_000, is_rough=False)
    few, scale = few_paths(paths)
    assert few.num_paths < 1100 < 10_000 < paths.num_paths
    whole, found = fields(paths).sum(), (fields(few) * scale).sum()
    assert abs(found - whole) < 0.5 * abs(whole)


def test_the_draw_is_that_of_the_seed():
    again = [few_paths(traced(5_000, is_rough=True, seed=seed))[0].weight.tobytes() for seed in (1, 1, 2)]
    assert again[0] == again[1] != again[2]


@pytest.mark.parametrize("power, count", [([4.0, 1.0], 2), ([1.0, 0.5, 2e-3], 3), ([1.0, 0.5, 1e-3], 2)])
def test_the_fewest_paths_that_hold_999_of_1000_stand_for_all(power, count):
    """Of paths over a plate each, whose powers are these but for their common level."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(5, 0, 0), yaw=np.pi)
    paths = diffuse_paths(scene, [[0]] * len(power), np.sqrt(power))
    assert paths.power / paths.power[0] == pytest.approx(np.array(power) / power[0])
    few, scale = few_paths(paths)
    assert few.num_paths == count and np.all(scale == 1.0)


def test_few_paths_are_all_there_and_none_is_none():
    few, scale = few_paths(traced(500, is_rough=True))
    assert np.all(scale == 1.0) and few.num_paths < 500
    with pytest.warns(RuntimeWarning, match="no mesh"):
        empty = ep.trace(ep.Scene(), ep.interference_radar(RECEIVER, SENDER), num_rays=10)
    assert few_paths(empty)[0].num_paths == 0 and not ep.interference(RECEIVER, SENDER, empty).any()


def test_more_rays_leave_the_signal_as_strong():
    levels = [10 * np.log10(np.mean(np.abs(ep.interference(RECEIVER, SENDER, traced(num_rays, is_rough=True))[0, 0, 0]) ** 2))
              for num_rays in (1_000, 100_000)]
    assert levels[1] == pytest.approx(levels[0], abs=LEVEL)
