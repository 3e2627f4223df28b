"""Lanes: ways beside a path, changes from one to another, and what offsets are refused."""
import numpy as np
import pytest

import echopath as ep
from echopath.trajectories.lane import OffsetPath, Offsets

ROUNDING = 1e-9
RADIUS = 12.0  # m


def test_lanes_lie_beside_each_other():
    """A concentric arc at an offset d to the left has the radius R - d."""
    lane = ep.Lane([(0, 0), (40, 0), (40, 40)], width=3.0, turn_radius=RADIUS)
    left, right = lane.trajectory(speed=5.0, offset=lane.width), lane.trajectory(speed=5.0, offset=-lane.width)
    assert (left.length, right.length) == pytest.approx(
        (2 * (40 - RADIUS) + (RADIUS - 3) * np.pi / 2, 2 * (40 - RADIUS) + (RADIUS + 3) * np.pi / 2))
    assert left.yaw_rate(left.time_at(left.length / 2)) == pytest.approx(5.0 / (RADIUS - 3), rel=1e-6)
    back = lane.trajectory(speed=5.0, offset=-lane.width, reverse=True)
    np.testing.assert_allclose(back.position([back.begin, back.end]), right.position([right.end, right.begin]), atol=1e-9)
    np.testing.assert_allclose(lane.position([5.0, lane.length - 5.0], 1.0), [[5, 1, 0], [39, 35, 0]], atol=ROUNDING)


def test_who_drives_against_the_points_changes_to_the_side_that_is_asked_for():
    """Offsets are to the left of the line as its points go, +y, whichever way it is driven."""
    back = ep.Lane([(0, 0), (200, 0)]).trajectory(speed=10.0, offset=-1.0, changes=[(50, 60, 3.5), (120, 40, 2.0)], reverse=True)
    places = back.position(np.linspace(back.begin, back.end, 4001))
    for distance, side in ((0.0, -1.0), (50.0, -1.0), (110.0, 3.5), (120.0, 3.5), (160.0, 2.0), (200.0, 2.0)):
        assert np.interp(distance, 200.0 - places[:, 0], places[:, 1]) == pytest.approx(side, abs=1e-3)


def test_a_change_of_lanes_is_a_quintic():
    """Its largest sideways acceleration is 10 / sqrt(3) times offset (speed / length)^2."""
    speed, length, offset = 20.0, 60.0, 3.5
    one = ep.Lane([(0, 0), (200, 0)]).trajectory(speed=speed, changes=[(50, length, offset)])
    times = np.linspace(one.begin, one.end, 1001)
    across = one.position(times)[:, 1]
    assert across[0] == 0.0 and across[-1] == pytest.approx(offset)
    assert np.interp(80.0, one.position(times)[:, 0], across) == pytest.approx(0.5 * offset, abs=1e-4)
    most = 10 / np.sqrt(3) * offset * (speed / length) ** 2
    assert np.abs(one.acceleration(times)[:, 1]).max() == pytest.approx(most, rel=0.02)


def test_rates_beside_arcs_are_those_of_the_own_side_up_to_their_ends():
    """Of the velocity and the yaw over time, micrometres before and behind the places at which arcs and changes begin and end."""
    lane = ep.Lane([(0, 0), (50, 0), (50, 50), (100, 50)], turn_radius=20.0)
    one, step = lane.trajectory(speed=10.0, changes=[(20, 60, 3.0)]), 1e-7
    times = np.add.outer(one._track.junctions()[1:-1], [-1e-5, -1e-6, 1e-6, 1e-5]).ravel()
    change = (one.velocity(times + step) - one.velocity(times - step)) / (2 * step)
    np.testing.assert_allclose(one.acceleration(times), change, atol=0.01)
    np.testing.assert_allclose(one.yaw_rate(times), (one.yaw(times + step) - one.yaw(times - step)) / (2 * step), atol=0.001)
    assert np.linalg.norm(one.acceleration(np.linspace(one.begin, one.end, 999)), axis=1).max() < 10.0**2 / (20.0 - 3.0)


@pytest.mark.parametrize("changes", [[(500, 40, 3.5)], [(50, 400, 3.5)], [(1, 5, 2.0), (8, 60, 0.0)]])
def test_changes_beyond_the_end_of_the_lane_are_refused(changes):
    lane = ep.Lane([(0, 0), (60, 0)])
    with pytest.raises(ValueError, match=r"^changes: must be made within the 60 m of the lane, got \[\d+.0, \d+.0, \d.\d\]$"):
        lane.trajectory(speed=5.0, changes=changes)
    assert lane.trajectory(speed=5.0, changes=[(20, 40, 2.0)]).position(1e3)[1] == pytest.approx(2.0)


def test_changes_follow_each_other():
    lane = ep.Lane([(0, 0), (60, 0)])
    with pytest.raises(ValueError, match="^changes: must be rows .*, each behind the one before, got"):
        lane.trajectory(speed=5.0, changes=[(10, 20, 2.0), (25, 10, 0.0)])
    both = lane.trajectory(speed=5.0, changes=[(10, 20, 2.0), (30, 10, 0.5)])
    assert both.position(1e3)[1] == pytest.approx(0.5)


def test_offsets_beyond_the_middle_of_a_curve_are_refused():
    with pytest.raises(ValueError, match="offset: .*radius"):
        ep.Lane([(0, 0), (40, 0), (40, 40)], turn_radius=5.0).trajectory(speed=5.0, offset=6.0)


@pytest.mark.parametrize("points", [[(0, 0), (50, 0), (0, 1)], [(0, 0), (30, 0), (31, 0.3), (0, 5)], [(0, 0), (40, 0), (40, 40)]])
def test_a_way_outside_of_a_turn_is_longer_by_the_turn_times_its_offset(points):
    """That of a centre line which turns to one side only, also within millimetres; and no step of it is longer than the way."""
    lane = ep.Lane(points)
    center, offset = lane._path, 0.5
    turn = np.ptp(center.bearings(np.array([0.0, center.length]))[0])
    outside = OffsetPath(center, Offsets(-offset, np.zeros((0, 3))))
    assert outside.length == pytest.approx(lane.length + turn * offset, abs=1e-5)
    places = outside.points(np.linspace(0.0, outside.length, 3001))
    assert np.linalg.norm(np.diff(places, axis=0), axis=1).max() < 1.00001 * outside.length / 3000


@pytest.mark.parametrize("aside", [0.0, 1e-6])
def test_beside_a_lane_that_turns_back_on_itself_no_way_leads_on(aside):
    with pytest.raises(ValueError, match="offset: must be 0 where the lane turns back on itself, as it does at 50 m, got"):
        ep.Lane([(0, 0), (50, 0), (0, aside)]).trajectory(speed=5.0, offset=2.0)
