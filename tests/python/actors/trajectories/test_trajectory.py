"""Trajectories: paths, speeds and stops against closed forms, and the curves that the core follows."""
import inspect
import math
import pickle
import time

import numpy as np
import pytest

import echopath as ep
from echopath.trajectories.knots import curve_through
from echopath.trajectories.path import SplinePath
from echopath.trajectories.profile import Profile, hermite_coefficients, slopes_of
from support.odd_values import is_named, refusals

MICROMETRES = 10e-6      # m, what positions may err by, as the docstring says
ROUNDING = 1e-9
RADIUS = 12.0            # m


def circle(radius=RADIUS, points=181, turn=2.0 * np.pi):
    angle = np.linspace(0.0, turn, points)
    return radius * np.stack([np.sin(angle), 1.0 - np.cos(angle)], axis=-1)


def corner(**keywords):
    """40 m along x, then 40 m along y, by an arc of RADIUS."""
    return ep.Trajectory([(0, 0), (40, 0), (40, 40)], turn_radius=RADIUS, **keywords)


def test_a_straight_line_is_travelled_evenly():
    line = ep.Trajectory([(1, 2, 3), (7, 10, 3)], speed=2.5, start_time=4.0)
    assert (line.begin, line.end, line.length) == pytest.approx((4.0, 8.0, 10.0), abs=ROUNDING)
    np.testing.assert_allclose(line.position([4.0, 6.0, 8.0]), [[1, 2, 3], [4, 6, 3], [7, 10, 3]], atol=ROUNDING)
    np.testing.assert_allclose(line.velocity(5.0), [1.5, 2.0, 0.0], atol=ROUNDING)
    assert line.yaw(5.0) == pytest.approx(math.atan2(8, 6))


@pytest.mark.parametrize("speed", [0.02, 0.05, 0.099, 0.11])
def test_what_creeps_between_rows_of_a_fast_table_moves(speed):
    """A robot or a drawer at some cm/s, by a tracker of 100 Hz: less than a millimetre from row to row."""
    times = 0.01 * np.arange(2001)
    direction = np.array([np.cos(0.4), np.sin(0.4)])
    slow = ep.Trajectory((1.0, -2.0) + speed * times[:, None] * direction, times=times)
    inside = np.linspace(0.0, 20.0, 777)
    np.testing.assert_allclose(slow.position(inside)[:, :2], (1.0, -2.0) + speed * inside[:, None] * direction, atol=MICROMETRES)
    np.testing.assert_allclose(slow.speed(inside), speed, rtol=1e-6)
    assert slow.length == pytest.approx(20.0 * speed) and np.ptp(slow.yaw(inside)) == pytest.approx(0.0, abs=1e-6)


def test_what_slows_down_to_a_creep_on_an_arc_goes_on_without_a_jump():
    times = 0.01 * np.arange(1501)
    speeds = np.interp(times, [0.0, 3.0, 5.0, 10.0, 12.0, 15.0], [0.4, 0.4, 0.03, 0.03, 0.4, 0.4])
    angle = np.concatenate([[0.0], np.cumsum(0.005 * (speeds[1:] + speeds[:-1]))]) / 2.0  # of a circle of 2 m
    points = 2.0 * np.stack([np.sin(angle), 1.0 - np.cos(angle)], axis=-1)
    arc = ep.Trajectory(points, times=times)
    inside = np.linspace(0.01, 14.99, 999)
    assert np.abs(arc.speed(inside) - np.interp(inside, times, speeds)).max() < 0.002
    assert np.abs(arc.position(times)[:, :2] - points).max() < MICROMETRES
    assert np.abs(arc.yaw(times) - angle).max() < 0.01


def test_what_stands_has_no_length():
    still = ep.Trajectory([(2.0, 1.0), (2.0, 1.0)], times=[0.0, 5.0], goes_on=1.0)
    assert (still.length, still.distance(5.0), still.speed(2.0)) == (0.0, 0.0, 0.0) and "0 m" in str(still)
    np.testing.assert_array_equal(still.position([-1.0, 2.0, 7.0]), np.tile([2.0, 1.0, 0.0], (3, 1)))


def test_a_turn_has_the_length_and_the_rates_of_its_arc():
    turn, speed = corner(speed=6.0), 6.0
    assert turn.length == pytest.approx(2 * (40 - RADIUS) + RADIUS * np.pi / 2, abs=ROUNDING)
    middle = turn.time_at(0.5 * turn.length)
    assert turn.yaw_rate(middle) == pytest.approx(speed / RADIUS, rel=1e-9)
    assert turn.yaw(middle) == pytest.approx(np.pi / 4)
    center = np.array([40 - RADIUS, RADIUS, 0.0])
    inward = (center - turn.position(middle)) / RADIUS
    np.testing.assert_allclose(turn.acceleration(middle), speed**2 / RADIUS * inward, atol=1e-9)
    np.testing.assert_allclose(turn.position(middle), center + RADIUS * np.array([1, -1, 0]) / np.sqrt(2), atol=ROUNDING)
    assert turn.yaw_rate(1.0) == 0.0


def test_a_radar_before_the_origin_swings_in_a_curve():
    """Its velocity is that of the origin and, across, its distance times the yaw rate, at every time that its curve has."""
    speed, ahead, step = 10.0, 2.2, 1e-5
    motion = ep.Trajectory(circle(), speed=speed).motion((ahead, 0.0, 0.0))
    times = motion.translation.times
    for at in times[(times > 0.2 * times[-1]) & (times < 0.8 * times[-1])][::5]:
        velocity = (motion.at(at + step) - motion.at(at - step))[:2, 3] / (2.0 * step)
        c, s = np.cos(speed * at / RADIUS), np.sin(speed * at / RADIUS)
        wanted = speed * np.array([c, s]) + ahead * speed / RADIUS * np.array([-s, c])
        np.testing.assert_allclose(velocity, wanted, atol=1e-3)


@pytest.mark.parametrize("turning", [0.0, 0.3, -0.8])
def test_what_looks_elsewhere_than_it_goes_rolls_the_way_along_its_own_axis(turning):
    """At 10 m/s along x with the yaw 0.5 + w t: the integral of 10 cos(0.5 + w t)."""
    times, begin, speed = np.linspace(0.0, 4.0, 41), 0.5, 10.0
    points = np.column_stack([speed * times, np.zeros_like(times)])
    rolled = ep.Trajectory(points, times=times, yaw=begin + turning * times)._track.rolled.at(times)[0]
    wanted = speed * times * np.sinc(0.5 * turning * times / np.pi) * np.cos(begin + 0.5 * turning * times)
    np.testing.assert_allclose(rolled - rolled[0], wanted, atol=1e-5)


@pytest.mark.parametrize("values", [[0.0, 0.1, 1.0], [1.0, 0.1, 0.0], [0.0, 1.0, 1.1], [0.0, 0.1, 1.0, 1.0, 5.0, 5.1]])
def test_monotone_cubics_never_turn_back(values):
    """The parabola at an end has a slope of the other sign where values change faster and faster from there."""
    knots, values = np.arange(len(values), dtype=float), np.array(values)
    slopes = slopes_of(knots, values)
    curve = Profile(knots, hermite_coefficients(np.diff(knots), values, slopes))
    found = curve.at(np.linspace(0.0, knots[-1], 1001))[0]
    assert np.all(np.sign(values[-1] - values[0]) * np.diff(found) > -1e-12)
    np.testing.assert_allclose(curve.at(knots)[0], values, atol=1e-12)


def test_a_spline_through_a_circle_is_one():
    """Cubics through points d apart on a circle are off by about d^4 / (384 R^3): 5e-6 m here, more at the ends."""
    ring, speed = ep.Trajectory(circle(), speed=10.0), 10.0
    times = np.linspace(0.1 * ring.end, 0.9 * ring.end, 500)
    assert ring.length == pytest.approx(2.0 * np.pi * RADIUS, rel=1e-6)
    assert np.abs(np.linalg.norm(ring.position(times)[:, :2] - [0, RADIUS], axis=1) - RADIUS).max() < MICROMETRES
    np.testing.assert_allclose(ring.yaw(times), speed * times / RADIUS, atol=1e-5)      # goes on beyond half a turn
    np.testing.assert_allclose(ring.yaw_rate(times), speed / RADIUS, rtol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(ring.acceleration(times), axis=1), speed**2 / RADIUS, rtol=1e-3)


def test_distance_is_the_integral_of_the_speed():
    """The trapezoidal rule over a fine grid, of every kind of profile."""
    kinds = [corner(speed=[(0, 3), (20, 9), (50, 4)]), corner(speed=[(0, 2), (3, 10), (4, 10), (9, 0.5)], speed_over="time"),
             corner(speed=12.0, stops=[(0, 1.0), (30, 2.0), (math.inf, 0.0)], lateral_acceleration=2.0),
             ep.Trajectory([(0, 0), (3, 0), (3, 0), (9, 4)], times=[0, 2, 3, 6])]
    for one in kinds:
        times = np.linspace(one.begin, one.end, 200_001)
        speeds = one.speed(times)
        summed = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(times) * (speeds[1:] + speeds[:-1]))])
        np.testing.assert_allclose(one.distance(times), summed, atol=1e-5)
        assert one.distance(one.end) == pytest.approx(one.length, abs=1e-6)


def test_a_stop_takes_the_way_and_the_time_of_its_brakes():
    speed, brakes, drive, wait = 10.0, 4.0, 2.5, 3.0
    one = ep.Trajectory([(0, 0), (100, 0)], speed=speed, stops=[(60, wait)], deceleration=brakes, acceleration=drive)
    braking, starting = speed**2 / (2 * brakes), speed**2 / (2 * drive)
    cruise = (100 - braking - starting) / speed
    assert one.end == pytest.approx(cruise + speed / brakes + wait + speed / drive, abs=ROUNDING)
    stopped = (60 - braking) / speed + speed / brakes
    assert one.time_at(60.0) == pytest.approx(stopped, abs=1e-6)
    np.testing.assert_allclose(one.position([stopped, stopped + wait]), [[60, 0, 0], [60, 0, 0]], atol=ROUNDING)
    assert one.speed(stopped + 0.5 * wait) == 0.0
    assert one.distance(stopped - 1.0) == pytest.approx(60 - brakes / 2, abs=1e-6)
    assert one.acceleration(stopped + wait + 0.1)[0] == pytest.approx(drive)


@pytest.mark.parametrize("middle, end", [(2.1, 6.8), (2.1, 7.8), (3.1, 13.3)])
def test_a_stop_at_the_end_is_there_however_the_length_rounds(middle, end):
    """At 1 m/s, 1 m/s^2 of brakes and 2 s of standing: the way of the middle point adds up to less or more than `end` by
    rounding."""
    one = ep.Trajectory([(0, 0), (middle, 0), (end, 0)], speed=1.0, stops=[(end, 2.0)], deceleration=1.0)
    assert one.end == pytest.approx((end - 0.5) + 1.0 + 2.0) and one.position(one.end - 1.0)[0] == pytest.approx(end)
    with pytest.raises(ValueError, match=f"^stops: must be at distances from 0 to {end:g} m"):
        ep.Trajectory([(0, 0), (end, 0)], speed=1.0, stops=[(end + 1e-6, 2.0)])


def test_near_stops_are_reached_by_full_throttle_and_brakes():
    """Between stops d apart the peak is sqrt(2 d a b / (a + b))."""
    one = ep.Trajectory([(0, 0), (20, 0)], speed=50.0, stops=[(0, 0), (10, 0), (20, 0)], acceleration=2, deceleration=3)
    times = np.linspace(one.begin, one.end, 100_001)
    assert one.speed(times).max() == pytest.approx(np.sqrt(2 * 10 * 2 * 3 / 5), rel=1e-6)


@pytest.mark.parametrize("points, num_turns", [([(0, 0), (10, 0), (0, 0)], 1), ([(0, 0), (8, 6), (4, 3), (16, 12)], 2),
                                               ([(0, 0), (10, 0), (10, 0.01), (0, 0.02)], 0)])
def test_what_turns_back_on_the_spot_stands_there_where_curves_are_limited(points, num_turns):
    """The narrower a hairpin, the slower it is taken: back on itself at full speed it would have no finite acceleration."""
    one = ep.Trajectory(points, speed=10.0, lateral_acceleration=2.0)
    times, step = np.linspace(one.begin, one.end, 4001, retstep=True)
    velocities = np.diff(one.position(times), axis=0) / step
    assert np.linalg.norm(np.diff(velocities, axis=0), axis=1).max() / step < 3.7  # hypot of 2 aside and 3 of the brakes
    turned = np.sum(velocities[:-1] * velocities[1:], axis=1) < 0.0
    assert np.sum(turned) == num_turns and np.linalg.norm(velocities, axis=1).max() > 5.0
    stop = ep.Trajectory(points, speed=10.0, lateral_acceleration=2.0, stops=[(10.0, 1.0)])
    assert stop.speed(stop.time_at(10.0) + 0.5) == 0.0


def test_curves_slow_down_to_the_lateral_acceleration():
    one = corner(speed=15.0, lateral_acceleration=3.0)
    times = np.linspace(one.begin, one.end, 2001)
    across = np.abs(np.cross(one.velocity(times), one.acceleration(times))[:, 2]) / one.speed(times)
    along = np.sum(one.velocity(times) * one.acceleration(times), axis=1) / one.speed(times)
    assert across.max() == pytest.approx(3.0, rel=1e-6)
    assert -3.0 - 1e-6 < along.min() and along.max() < 2.0 + 1e-6       # what it brakes and drives by unless told
    assert one.speed(one.time_at(one.length / 2)) == pytest.approx(np.sqrt(3.0 * RADIUS))


def test_given_times_and_speeds_are_met():
    points, times = [(0, 0), (4, 1), (8, 0), (8, 0), (12, -1)], [0.0, 1.0, 2.0, 5.0, 6.0]
    one = ep.Trajectory(points, times=times)
    np.testing.assert_allclose(one.position(times)[:, :2], points, atol=ROUNDING)
    assert np.all(one.speed(np.linspace(2.0, 5.0, 50)) == 0.0)
    assert np.all(one.speed(np.linspace(0.0, 6.0, 1000)) >= 0.0)
    told = ep.Trajectory([(0, 0), (4, 0), (8, 0)], times=[0, 1, 2], speed=[3.0, 5.0, 3.0])
    np.testing.assert_allclose(told.speed([0, 1, 2]), [3.0, 5.0, 3.0])


def test_yaw_that_is_given_goes_on_over_a_turn():
    one = ep.Trajectory([(0, 0), (1, 0), (2, 0)], times=[0, 1, 2], yaw=[3.0, -3.0, -2.8])     # over pi, to the left
    np.testing.assert_allclose(one.yaw([0.0, 1.0, 2.0]), [3.0, 2 * np.pi - 3.0, 2 * np.pi - 2.8])
    assert np.all(one.yaw_rate(np.linspace(0, 2, 20)) > 0.0)


MOVES = {"turn": corner(speed=8.0, stops=[(0, 1), (20, 2)]), "ring": ep.Trajectory(circle(3.0, 20), speed=9.0),
         "times": ep.Trajectory([(0, 0), (4, 1), (8, 0), (8, 0), (12, -1)], times=[0, 1, 2, 5, 6], yaw=[0, 1, 4, 4, 2]),
         "climb": ep.Trajectory([(0, 0, 0), (20, 0, 1), (40, 5, 8), (60, 5, 8)], speed=20.0, pitch=True, goes_on=0.5),
         "lane": ep.Lane([(0, 0), (40, 0), (40, 40)], turn_radius=RADIUS).trajectory(speed=14, offset=3.5, changes=[(5, 20, 0)])}


@pytest.mark.parametrize("name", MOVES)
def test_the_core_follows_to_micrometres(name):
    one = MOVES[name]
    times = np.linspace(one.begin - 0.2, one.end + 0.2, 4001)
    poses = np.array([one.at(time) for time in times])
    assert np.abs(poses[:, :3, 3] - one.position(times)).max() < MICROMETRES
    ahead = np.stack([np.cos(one.yaw(times)), np.sin(one.yaw(times))], axis=-1)
    found = poses[:, :2, 0] / np.linalg.norm(poses[:, :2, 0], axis=1, keepdims=True)
    assert np.abs(found - ahead).max() < 4e-6
    assert len(one.translation.times) < 60 * (one.end - one.begin) + 10


def test_a_nose_follows_the_slope_where_it_is_asked_to():
    hill = [(0, 0, 0), (30, 0, 10), (60, 0, 20)]
    assert np.allclose(ep.Trajectory(hill, speed=1.0).at(3.0)[:3, 0], [1, 0, 0])
    np.testing.assert_allclose(ep.Trajectory(hill, speed=1.0, pitch=True).at(3.0)[:3, 0], np.array([3, 0, 1]) / np.sqrt(10),
                               atol=1e-6)


def test_it_stands_beyond_its_ends_or_goes_on():
    stands, on = corner(speed=5.0), corner(speed=5.0, goes_on=2.0)
    np.testing.assert_allclose(stands.position([-5.0, stands.end + 9.0]), [[0, 0, 0], [40, 40, 0]], atol=ROUNDING)
    assert np.all(stands.speed([-0.1, stands.end + 0.1]) == 0.0)
    np.testing.assert_allclose(on.position([-1.0, stands.end + 1.0]), [[-5, 0, 0], [40, 45, 0]], atol=ROUNDING)
    assert (on.begin, on.end) == pytest.approx((-2.0, stands.end + 2.0))


def test_rates_of_what_climbs_and_of_what_times_say_are_differences():
    """Of the nose above the plane over the way, and of the velocity over time, on a hill that is passed by given times."""
    hill = ep.Trajectory([(0, 0, 0), (10, 1, 6), (20, -1, 9), (30, 2, 4)], times=[0.0, 1.0, 4.0, 5.0], pitch=True)
    path, step = hill._track.path, 1e-5
    ways = np.linspace(1.0, path.length - 1.0, 17)
    rate = (path.slopes(ways + step)[0] - path.slopes(ways - step)[0]) / (2 * step)
    np.testing.assert_allclose(path.slopes(ways)[1], rate, atol=1e-6)
    times = np.array([0.2, 0.8, 1.3, 2.5, 3.6, 4.7])
    change = (hill.velocity(times + step) - hill.velocity(times - step)) / (2 * step)
    np.testing.assert_allclose(hill.acceleration(times), change, atol=1e-3)


def test_what_backs_up_a_hill_stands_as_what_drives_down_it():
    down = ep.Trajectory([(10, 2, 1), (0, 0, 0)], times=[0.0, 5.0], pitch=True)
    up = ep.Trajectory([(0, 0, 0), (10, 2, 1)], times=[0.0, 5.0], yaw=np.full(2, down.yaw(0.0)), pitch=True)
    for at in (0.0, 1.3, 5.0):
        np.testing.assert_allclose(up.at(5.0 - at), down.at(at), atol=1e-6)


def test_noses_that_look_aside_lie_on_a_ground_that_rises_with_the_path_and_turn_at_its_rate():
    hill = ep.Trajectory([(0, 0, 0), (10, 1, 2), (20, -1, 3), (30, 2, 1)], times=[0.0, 2.0, 5.0, 7.0], yaw=[0.3, 2.0, 4.0, 1.0],
                         pitch=True)
    step = 1e-5
    for at in (0.4, 1.7, 3.1, 4.4, 6.2):
        ahead = hill.velocity(at)
        ground = np.cross(ahead, np.cross([0.0, 0.0, 1.0], ahead))
        assert hill.at(at)[:3, 0] @ ground / np.linalg.norm(ground) == pytest.approx(0.0, abs=5e-6)
        change = (hill._track.pitches(np.array([at + step]))[0] - hill._track.pitches(np.array([at - step]))[0]) / (2 * step)
        np.testing.assert_allclose(hill._track.pitches(np.array([at]))[1], change, atol=1e-6)


@pytest.mark.parametrize("length, end", [(30.0, 6.0), (70.0, 10.0), (94.0, 12.0)])
def test_speeds_over_time_end_where_the_path_does(length, end):
    """2 t + t^2 / 2 for 10 s, which are 70 m, and 12 m/s from then on."""
    one = ep.Trajectory([(0, 0), (length, 0)], speed=[(0.0, 2.0), (10.0, 12.0)], speed_over="time")
    assert one.end == pytest.approx(end) and one.position(one.end)[0] == pytest.approx(length)
    assert one.distance(4.0) == pytest.approx(2 * 4.0 + 0.5 * 4.0**2)


def test_copies_are_equal_and_change():
    for one in MOVES.values():
        assert pickle.loads(pickle.dumps(one)) == one
        later = one.shifted(3.0)
        assert later.begin == pytest.approx(one.begin + 3.0)
        np.testing.assert_allclose(later.position(later.end), one.position(one.end))
    assert corner(speed=5.0) == corner(speed=5.0) != corner(speed=6.0)
    assert corner(speed=5.0).replace(speed=6.0) == corner(speed=6.0)
    assert corner(speed=5.0, kind="bus").replace(is_person=True) == corner(speed=5.0, kind="bus", is_person=True) \
        != corner(speed=5.0, kind="bus")


@pytest.mark.parametrize("other", [None, 5.0, "bus", ep.LinearMotion(velocity=(5.0, 0.0, 0.0))])
def test_it_equals_nothing_else(other):
    one = corner(speed=5.0)
    assert one != other and not one == other and other != one and one not in [other]
    assert one == one.motion() and one.motion() == one  # what scenes keep of it


def test_a_scene_and_a_radar_take_it():
    one, scene = corner(speed=5.0), ep.Scene()
    scene.add(ep.actors.plate(1, 1), name="plate", material="metal", motion=one, position=(0, 1, 0))
    place = scene.world_vertices(0, 3.0).mean(axis=0)
    np.testing.assert_allclose(place, [15, 1, 0], atol=MICROMETRES)
    assert scene["plate"].motion == one
    scene["plate"].motion = one.shifted(1.0)
    np.testing.assert_allclose(scene.world_vertices(0, 4.0).mean(axis=0), place, atol=MICROMETRES)
    radar = ep.Radar(ep.ChirpSequence(), transmitters=[ep.Antenna()], receivers=[ep.Antenna()], motion=one)
    np.testing.assert_allclose(radar.world_from_radar(one.end)[:3, 3], [40, 40, 0], atol=MICROMETRES)
    np.testing.assert_allclose(radar.world_from_radar(one.end)[:3, 0], [0, 1, 0], atol=1e-5)


@pytest.mark.parametrize("frame", [0, 1])
def test_a_reflector_on_a_circle_has_the_doppler_of_the_closed_form(frame):
    """Two frames 0.4 s apart: range and range rate of a small ball that runs around a centre 20 m ahead of the radar."""
    radius, speed, start = 5.0, 8.0, 0.3 + 0.4 * frame
    arc = ep.Trajectory(circle(radius, 200) + [20.0, -radius], speed=speed)
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=10e6, num_chirps=128,
                              chirp_interval=60e-6)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", motion=arc, smooth=True)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna()], transmit_power=1.0)
    spectrum = ep.simulate(scene, radar, start_time=start, num_rays=1000, guard=False).spectrum
    power = np.abs(spectrum.values[0, 0]) ** 2
    v, r = np.unravel_index(np.argmax(power), power.shape)
    angle = speed * (start + 0.5 * radar.frame_duration) / radius
    place = np.array([20 + radius * np.sin(angle), -radius * np.cos(angle)])
    rate = speed * np.array([np.cos(angle), np.sin(angle)]) @ place / np.linalg.norm(place)
    assert spectrum.velocity[v] == pytest.approx(rate, abs=1.1 * chirps.velocity_resolution(1))
    assert spectrum.range[r] == pytest.approx(np.linalg.norm(place) - 0.1, abs=0.25)


CALLS = {"Trajectory": (ep.Trajectory, {"points": [(0, 0), (9, 0)], "speed": 3.0}),
         "of times": (ep.Trajectory, {"points": [(0, 0), (9, 0)], "times": [0.0, 1.0], "speed": None, "yaw": [0.0, 1.0]}),
         "Lane": (ep.Lane, {"points": [(0, 0), (9, 0)], "width": 3.0}),
         "trajectory": (ep.Lane([(0, 0), (9, 0)]).trajectory, {"speed": 3.0}),
         **{name: (getattr(MOVES["turn"], name), {"time": 1.0}) for name in ("position", "velocity", "acceleration", "speed",
                                                                             "distance", "yaw", "yaw_rate")},
         "time_at": (MOVES["turn"].time_at, {"distance": 1.0}), "shifted": (MOVES["turn"].shifted, {"seconds": 1.0})}


@pytest.mark.parametrize("name", CALLS)
def test_wrong_arguments_are_named(name):
    function, right = CALLS[name]
    refused = list(refusals(function, right, inspect.signature(function).parameters))
    found = [(argument, odd, repr(error)) for argument, odd, value, error in refused if not is_named(argument, value, error)]
    assert not found, "\n".join(map(str, found))
    assert len(refused) > 25


@pytest.mark.parametrize("wrong, words", [
    ({"speed": 0.0}, "speed: must be above 0"), ({"speed": [(0, 0), (5, 0), (9, 3)]}, "speed: must be above 0"),
    ({"speed": [(5, 1), (0, 2)]}, "speed: .*ascending"), ({"stops": [(50, 1)]}, "stops: must be at distances from 0 to 9"),
    ({"stops": [(5, 1), (5, 1)]}, "stops: must be at ascending"), ({"stops": [(1, -1)]}, "stops: "),
    ({"points": [(0, 0), (0, 0)]}, "points: must be at least"), ({"points": [(0, 0, 0), (0, 0, 5)]}, "points: .*straight above"),
    ({"yaw": [0, 1]}, "yaw: must be given with times"), ({"speed_over": "time", "stops": [(1, 1)]}, "speed_over"),
    ({"points": [(0, 0), (9, 0), (9, 9)], "turn_radius": 20.0}, "turn_radius: .*9 m is the largest"),
    ({"points": [(0, 0), (9, 0), (0, 0)], "turn_radius": 1.0}, r"turn_radius: must be None where .* back, .* at points\[1\]"),
    ({"speed": [(0, 0), (9, 0)]}, "speed: .*speeds of at least 0 m/s, one of them above"),
    ({"speed": None}, "speed: must be given"), ({"times": [0, 1], "speed": None, "stops": [(1, 1)]}, "stops: .*without times"),
    ({"times": [0, 1, 2], "speed": None}, "times: must be as many as the 2 points"),
    ({"times": [0, 1], "speed": [1, -1]}, "speed: ")])
def test_what_makes_no_sense_is_refused(wrong, words):
    with pytest.raises(ValueError, match=words):
        ep.Trajectory(**{"points": [(0, 0), (9, 0)], "speed": 3.0} | wrong)


def test_a_million_seconds_need_keys_where_they_turn():
    """Two lines and an arc at 1 m/s with a wait, against their closed forms."""
    side, wait = 4e5, 2e5
    long = ep.Trajectory([(0, 0), (side, 0), (side, side)], speed=1.0, turn_radius=RADIUS, stops=[(1e5, wait)],
                         acceleration=1.0, deceleration=1.0)
    arc = side - RADIUS + wait + 1.0  # s, when it begins: brakes and start take a second more than going on
    angle = 0.5 * np.pi * np.linspace(0.0, 1.0, 201)
    times = np.concatenate([np.linspace(0.0, 99_999.0, 2003), np.linspace(100_002.0 + wait, arc, 4001), arc + RADIUS * angle,
                            np.linspace(arc + RADIUS * 0.5 * np.pi, long.end, 4001)])
    x = np.concatenate([times[:2003], times[2003:6004] - wait - 1.0, side - RADIUS + RADIUS * np.sin(angle), np.full(4001, side)])
    y = np.concatenate([np.zeros(6004), RADIUS * (1.0 - np.cos(angle)), RADIUS + times[6205:] - times[6205]])
    poses = np.array([long.at(time) for time in times])
    assert np.abs(poses[:, :2, 3] - np.stack([x, y], axis=-1)).max() < MICROMETRES
    bearing = np.concatenate([np.zeros(6004), angle, np.full(4001, 0.5 * np.pi)])
    assert np.abs(poses[:, :2, 0] - np.stack([np.cos(bearing), np.sin(bearing)], axis=-1)).max() < 4e-6
    assert len(long.translation.times) < 70_000 and long.end == pytest.approx(1e6 - 2 * RADIUS + RADIUS * 0.5 * np.pi + 1.0)


def test_turns_between_keys_that_lie_far_apart_are_met():
    """Keys of a week begin 16 s apart, of which 6.25 turns a second make whole turns, as 0.5, 0.23 and 0.77 of them do."""
    rate = 2.0 * np.pi * 6.25

    def wheel(times):
        return np.cos(rate * times)[:, None], -rate * np.sin(rate * times)[:, None]

    with pytest.raises(ValueError, match="^trajectory: .*too long or too wild"):
        curve_through(wheel, [0.0, 6e5], 1e-6)
    assert len(curve_through(wheel, [0.0, 60.0], 1e-6).times) > 60 * 6.25 * 8


def test_what_lasts_too_long_is_refused_at_once():
    """At a key a second, as turns need them, 1e7 s would fill the memory for minutes."""
    begin = time.process_time()
    with pytest.raises(ValueError, match="^trajectory: must be followed by at most 2000000 keys"):
        ep.Trajectory([(0, 0), (9, 0)], times=[0, 9e6])
    assert time.process_time() - begin < 1.0


@pytest.mark.parametrize("points", [[(0, 0), (4, 0), (0, 0)], [(0, 0), (1, 0), (2, 0), (1, 0), (0, 0)],
                                    [(0, 0), (3, 3), (0, 0)]])
def test_whoever_walks_there_and_back_turns_where_the_way_does(points):
    """The way lies on a line, so that the place is the distance, there and back, and each second has as much of it."""
    walk = ep.Trajectory(points, speed=1.0)
    times = np.linspace(0.0, walk.end, 101)
    farthest = 0.5 * walk.length
    assert farthest == pytest.approx(np.linalg.norm(points, axis=-1).max(), abs=1e-9)
    found = np.linalg.norm(walk.position(times), axis=-1)
    np.testing.assert_allclose(found, farthest - np.abs(times - farthest), atol=MICROMETRES)
    of_core = [walk.translation.at(float(time)) for time in times]
    np.testing.assert_allclose(of_core, walk.position(times), atol=MICROMETRES)
    assert np.isfinite(walk.yaw(times)).all() and np.isfinite(walk.yaw_rate(times)).all()


def test_tight_turns_of_a_spline_are_taken_as_slowly_as_wide_ones():
    """What turns within a hand's breadth: the sideways part of the acceleration, by differences of the places."""
    hairpins = ep.Trajectory([(74, 70), (128, 37), (54, 47), (93, 40), (83, 31)], speed=30.0, lateral_acceleration=3.0)
    keys = hairpins.rotation.times[1:-1]
    times = np.concatenate([np.linspace(one, other, 40) for one, other in zip(keys, keys[1:])])
    before, at, after = (hairpins.position(times + step)[:, :2] for step in (-1e-4, 0.0, 1e-4))
    velocities, accelerations = (after - before) / 2e-4, (after - 2.0 * at + before) / 1e-8
    speeds = np.maximum(np.linalg.norm(velocities, axis=1), 1e-3)
    sideways = (velocities[:, 0] * accelerations[:, 1] - velocities[:, 1] * accelerations[:, 0]) / speeds
    assert np.abs(sideways).max() < 3.1


def test_what_turns_back_looks_ahead_until_it_does():
    """At 1 m/s it goes to (5, 0) and back; the core has its yaw up to that instant."""
    walk = ep.Trajectory([(0, 0), (5, 0), (0, 0)], speed=1.0)
    for moment, ahead in ((4.2, 1.0), (4.7, 1.0), (4.9999, 1.0), (5.0001, -1.0), (5.5, -1.0)):
        np.testing.assert_allclose(walk.at(moment)[:3, :3], np.diag([ahead, ahead, 1.0]), atol=1e-6)
        np.testing.assert_allclose(walk.at(moment)[:2, 3], [5.0 - abs(moment - 5.0), 0.0], atol=MICROMETRES)


def test_noise_of_what_stands_tells_how_far_it_has_come_not_where_it_goes():
    rng = np.random.default_rng(3)
    way = np.interp(np.arange(0.0, 12.0, 0.1), [0.0, 4.0, 8.0, 12.0], [0.0, 20.0, 20.0, 40.0])
    noisy = np.stack([way, 0.0 * way], axis=-1) + rng.uniform(-0.02, 0.02, (len(way), 2))
    drive = ep.Trajectory(noisy, times=np.arange(len(way)) / 10, spacing=0.1)
    times = np.linspace(0.0, 11.9, 500)
    np.testing.assert_allclose(drive.position(times)[:, 0], np.interp(times, np.arange(len(way)) / 10, way), atol=0.15)
    assert np.abs(drive.yaw(times)).max() < 0.5
    with pytest.raises(ValueError, match="^spacing: must be given with times, got 0.1"):
        ep.Trajectory([(0, 0), (5, 0)], speed=1.0, spacing=0.1)


def test_the_largest_radius_between_two_turns_is_told():
    """Each right angle takes its radius of the 10 m between them."""
    with pytest.raises(ValueError, match=r"turn_radius: must fit between points\[1\] .* where 5 m is the largest, got 6"):
        ep.Trajectory([(0, 0), (20, 0), (20, 10), (40, 10)], speed=5.0, turn_radius=6.0)


def test_between_places_of_a_table_the_acceleration_is_constant_beside_other_limits():
    """Mean of both speeds over 100 m."""
    for limits in ({}, {"lateral_acceleration": 3.0}):
        drive = ep.Trajectory([(0, 0), (100, 0)], speed=[(0, 2.0), (100, 10.0)], **limits)
        assert drive.end - drive.begin == pytest.approx(100.0 / 6.0, rel=1e-9)


@pytest.mark.parametrize("is_lost_at_end", (False, True))
def test_a_track_lost_beside_its_end_does_not_swing(is_lost_at_end):
    """Ten fixes 1 m apart with 10 cm of noise, 100 m from the first: a cubic whose slopes at both ends differ from those of its
    chord by .3, as those of such noise may, swings by 4/27 of 100 m times their sum. Not-a-knot it swings by 600 m."""
    along = np.concatenate([[0.0], 100.0 + np.arange(10.0)])
    across = 0.1 * np.random.default_rng(1).uniform(-1.0, 1.0, len(along))
    if is_lost_at_end:
        along, across = along[-1] - along[::-1], across[::-1]
    track = ep.Trajectory(np.stack([along, across, np.zeros(len(along))], axis=-1), times=0.1 * along)
    times = np.linspace(track.begin, track.end, 2001)
    assert np.abs(track.position(times)[:, 1]).max() < 4.0 / 27.0 * 100.0 * 0.6
    assert np.linalg.norm(track.velocity(times), axis=-1).max() < 12.0


# --- cost ---

def test_a_path_of_thousands_of_kilometres_is_made_of_few_pieces(monkeypatch):
    """As where a fix of latitude 0 stands among those of a town: its length rounds to more than a nanometre, to which no halving
    of its pieces leads, and each doubles their number."""
    monkeypatch.setattr("echopath.trajectories.path.MOST_HALVINGS", 12)
    path = SplinePath(np.array([(0.0, 0.0, 0.0), (1e7, 0.0, 0.0), (3.0, 5.0, 0.0), (4.0, 6.0, 0.0)]))
    assert path.length > 2e7 and path._is_met


def test_places_on_a_spline_are_found_without_search_or_by_it(monkeypatch):
    """Uneven points: quintics over the distance and Newton steps from coarse ones agree within a nanometre."""
    steps = np.abs(np.random.default_rng(4).normal(size=40)) + 0.05
    points = np.stack([np.cumsum(steps), 2.0 * np.sin(np.cumsum(steps)), np.zeros(40)], axis=-1)
    table = SplinePath(points)
    distances = np.linspace(0.0, table.length, 5001)
    assert table._is_met and np.abs(table.distances(table._parameters(distances)) - distances).max() < 1e-9
    monkeypatch.setattr("echopath.trajectories.path.MOST_HALVINGS", 0)
    coarse = SplinePath(points)
    assert not coarse._is_met
    assert np.abs(coarse.points(distances) - table.points(distances)).max() < 2e-9


def test_a_minute_of_a_car_is_made_without_search(monkeypatch):
    """58 s on a spline: four wheels of some 6000 keys each, whose places come from the table, not from lengths of their own."""
    asked, integrated = [], []

    def counted(name, counts, count):
        method = getattr(SplinePath, name)
        monkeypatch.setattr(SplinePath, name, lambda path, *given: (counts.append(count(given)), method(path, *given))[1])

    counted("_parameters", asked, lambda given: np.size(given[0]))
    counted("_integral", integrated, lambda given: np.size(given[0]))
    along = np.linspace(0.0, 464.0, 26)
    trajectory = ep.Trajectory(np.stack([along, 12.0 * np.sin(along / 50.0)], axis=-1), speed=8.4)
    ep.actors.car(trajectory=trajectory)
    assert sum(asked) > 20000 and sum(integrated) < 0.1 * sum(asked)


def test_fine_times_are_close_where_it_moves_or_turns_alone():
    """It goes for a second, turns where it stands, waits for an hour, and goes on: an hour has no times of its own."""
    times = [0.0, 1.0, 2.0, 3602.0, 3603.0]
    one = ep.Trajectory([(0, 0), (2, 0), (2, 0), (2, 0), (4, 0)], times=times, yaw=[0.0, 0.0, 1.0, 1.0, 1.0])
    found = one._track.fine_times(0.25)
    gaps = np.diff(found)
    assert found[0] == 0.0 and found[-1] == 3603.0 and gaps.max() == pytest.approx(3600.0) and len(found) < 20
    assert np.sort(gaps)[-2] <= 0.25
