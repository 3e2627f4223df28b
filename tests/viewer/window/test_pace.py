"""How much is drawn in the time that a picture may take."""
from __future__ import annotations

import pytest

from echopath_viewer.window.scene.pace import FEWEST_RAYS, GROWTH, SLOW, Pace, Smoothing


@pytest.mark.parametrize("coarsest", [1, 3])
@pytest.mark.parametrize("seconds_of_ray, base", [(6e-6, 0.01), (1e-4, 0.01), (1e-9, 1e-3), (1e-3, 0.2)])
def test_rays_are_as_many_as_the_time_of_a_picture_allows(seconds_of_ray, base, coarsest):
    pace, num_there = Pace(coarsest, 2000), 20_000

    def seconds(num_rays, coarseness):
        return base / coarseness**2 + seconds_of_ray / coarseness * min(num_rays, num_there)
    for _ in range(80):
        pace.follow(seconds(pace.num_rays, pace.coarseness), num_there)
    drawn = min(pace.num_rays, num_there)
    assert seconds(drawn, pace.coarseness) <= SLOW or drawn == FEWEST_RAYS
    assert seconds(GROWTH**3 * drawn, pace.coarseness) > SLOW or drawn == num_there
    assert pace.coarseness == 1 or seconds(drawn, pace.coarseness - 1) > SLOW or seconds(num_there, pace.coarseness) > SLOW


def test_pixels_get_coarse_before_rays_are_left_out():
    pace = Pace(3, 20_000)
    for _ in range(20):
        pace.follow({1: 0.120, 2: 0.060, 3: 0.040}[pace.coarseness] * min(pace.num_rays, 20_000) / 20_000, 20_000)
    assert (pace.num_rays, pace.coarseness) == (20_000, 3)


def test_what_is_far_too_slow_is_quick_within_some_pictures():
    pace = Pace(3, 100_000)
    pictures = []
    for _ in range(5):
        pictures.append(9.0 / pace.coarseness * pace.num_rays / 100_000)
        pace.follow(pictures[-1], 100_000)
    assert pictures[0] == 9.0 and pictures[-1] < 1.01 * SLOW


def test_one_slow_picture_changes_nothing():
    pace = Pace(3, 2000)
    for seconds in (0.04, 1.0) * 20:
        pace.follow(seconds, 2000)
    assert (pace.num_rays, pace.coarseness) == (2000, 1)


def test_another_motion_tries_again_what_was_too_much():
    pace = Pace(1, 2000)
    while pace.num_rays > FEWEST_RAYS:
        pace.follow(1.0, 20_000)
    for _ in range(60):
        pace.follow(0.001, 20_000)
    assert pace.num_rays < 20_000
    pace.begin()
    for _ in range(60):
        pace.follow(0.001, 20_000)
    assert pace.num_rays == 20_000


def test_edges_are_smoothed_where_pictures_are_quick_and_stay_so():
    quick, slow, coarse = Smoothing(), Smoothing(), Smoothing()
    for _ in range(10):
        quick.follow(0.002)
        slow.follow(0.05)
        coarse.follow(0.05 if coarse.samples else 0.002)  # quick without, slow with them: once is enough
    assert (quick.samples, slow.samples, coarse.samples) == (4, 0, 0)
