"""How many rays are drawn while the camera moves."""
from __future__ import annotations

import pytest

from echopath_viewer.window.pace import FEWEST_RAYS, SLOW, Pace


@pytest.mark.parametrize("seconds_of_ray, base", [(8e-6, 0.01), (1e-4, 0.01), (1e-9, 1e-3), (1e-3, 0.2)])
def test_rays_are_as_many_as_the_time_of_a_picture_allows(seconds_of_ray, base):
    pace, num_there = Pace(), 20_000
    for _ in range(40):
        pace.follow(base + seconds_of_ray * min(pace.num_rays, num_there), num_there)
    drawn = min(pace.num_rays, num_there)
    assert base + seconds_of_ray * drawn <= SLOW or drawn == FEWEST_RAYS
    assert base + seconds_of_ray * 4 * drawn > SLOW or drawn == num_there
