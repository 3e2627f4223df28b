"""How much is drawn in the time that a picture may take."""
from __future__ import annotations

import pytest

from echopath_viewer.window.pace import FEWEST_RAYS, SLOW, Pace, Smoothing


@pytest.mark.parametrize("seconds_of_ray, base", [(8e-6, 0.01), (1e-4, 0.01), (1e-9, 1e-3), (1e-3, 0.2)])
def test_rays_are_as_many_as_the_time_of_a_picture_allows(seconds_of_ray, base):
    pace, num_there = Pace(), 20_000
    for _ in range(40):
        pace.follow(base + seconds_of_ray * min(pace.num_rays, num_there), num_there)
    drawn = min(pace.num_rays, num_there)
    assert base + seconds_of_ray * drawn <= SLOW or drawn == FEWEST_RAYS
    assert base + seconds_of_ray * 4 * drawn > SLOW or drawn == num_there


def test_edges_are_smoothed_where_pictures_are_quick_and_stay_so():
    quick, slow, coarse = Smoothing(), Smoothing(), Smoothing()
    for _ in range(10):
        quick.follow(0.002)
        slow.follow(0.05)
        coarse.follow(0.05 if coarse.samples else 0.002)  # quick without, slow with them: once is enough
    assert (quick.samples, slow.samples, coarse.samples) == (4, 0, 0)
