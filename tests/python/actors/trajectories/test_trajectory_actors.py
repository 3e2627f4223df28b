"""Actors that follow trajectories: wheels that roll, cranks that turn, paws that stay on the ground."""
import math

import numpy as np
import pytest

import echopath as ep
from echopath.actors.following import Repeated, _steering
from support.drives import WALK

RADIUS = 8.0
DRIVE = ep.Trajectory([(0, 0), (25, 0), (25, 25)], turn_radius=RADIUS, speed=7.0, stops=[(0, 0.3), (10, 0.5), (math.inf, 0)])
ANGLE = 2e-5           # rad, of the curves of a wheel


def motion_of(actor, name):
    return next(part.motion for part in actor.parts if part.name == name)


def angle_about_y(rotation):
    return np.arctan2(rotation[..., 0, 2], rotation[..., 2, 2])


def about_z(angle):
    return np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])


def assert_same_angle(found, expected):
    assert np.abs(np.angle(np.exp(1j * (found - expected)))).max() < ANGLE


@pytest.fixture(scope="module")
def car():
    return ep.actors.car(trajectory=DRIVE)


def test_wheels_turn_by_the_distance_over_their_radius(car):
    """On the first straight, through a stop: tyres of 0.632 m diameter."""
    assert car.motion is DRIVE
    times = np.linspace(-0.2, DRIVE.time_at(14.0), 60)
    rear = motion_of(car, "wheel/rear_left/tyre")
    assert_same_angle(angle_about_y(np.array([rear.at(time)[:3, :3] for time in times])), DRIVE.distance(times) / (0.632 / 2))


def test_wheels_of_the_outer_side_go_farther(car):
    """After a turn to the left by 90 degrees a wheel y m to the left of the middle has gone y pi / 2 less."""
    wheel = next(part for part in car.parts if part.name == "wheel/rear_right/rim")
    way = DRIVE.length - wheel.position[1] * np.pi / 2
    assert wheel.position[1] < -0.6
    assert_same_angle(angle_about_y(wheel.motion.at(DRIVE.end)[:3, :3]), way / (0.632 / 2))


def test_wheels_that_do_not_steer_roll_their_own_arcs_all_along(car):
    """Left and right share what is worked out of their vehicle: turned by the way less y times the yaw, at any time."""
    times = np.linspace(DRIVE.begin, DRIVE.end, 397)
    for part in car.parts:
        if part.name.startswith("wheel/rear") and part.name.endswith("/tyre"):
            spin = np.array([part.motion.at(time)[:3, :3] for time in times])
            assert_same_angle(angle_about_y(spin), (DRIVE.distance(times) - part.position[1] * DRIVE.yaw(times)) / (0.632 / 2))


def rolling_of(scene, name, time):
    """(m/s by which the middle of a wheel goes where the wheel points, m/s of its tread about its axle), by its vertices."""
    mesh, step = next(mesh.id for mesh in scene.meshes if mesh.name == name), 1e-3
    before, now, after = (scene.world_vertices(mesh, time + shift) for shift in (-step, 0.0, step))
    away = now - now.mean(axis=0)
    axle = np.linalg.svd(away)[2][2]
    axle *= np.sign(axle[1] * math.cos(DRIVE.yaw(time)) - axle[0] * math.sin(DRIVE.yaw(time)))   # to the left
    speed = (after.mean(axis=0) - before.mean(axis=0)) / (2.0 * step)
    turning = np.cross(away, (after - before) / (2.0 * step) - speed).sum(axis=0)
    across = away - np.outer(away @ axle, axle)
    radii = np.linalg.norm(across, axis=1)
    return speed @ np.cross(axle, [0.0, 0.0, 1.0]), turning @ axle / np.sum(radii**2) * radii.max()


@pytest.mark.parametrize("make", [ep.actors.car, ep.actors.van, ep.actors.truck])
def test_front_wheels_roll_where_they_point(make):
    """Into a bend, in it and out of it: a truck's go 5 % farther than its drive axle."""
    scene = ep.Scene()
    scene.add(make(trajectory=DRIVE), name="a")
    for time in DRIVE.time_at(np.array([10.0, 14.0, 16.0, 21.0, 26.0, 30.0])):
        for side in ("left", "right"):
            ahead, turning = rolling_of(scene, f"a/wheel/front_{side}/tyre", float(time) + 0.01)
            assert turning == pytest.approx(ahead, rel=1e-3, abs=1e-3)


def test_front_wheels_of_what_slides_sideways_roll_where_they_point():
    """A table of a circle whose yaw lags by 0.1 rad, so that all wheels slide outwards."""
    angles = np.linspace(0.0, math.pi, 49)
    circle = RADIUS * np.stack([np.sin(angles), 1.0 - np.cos(angles)], axis=-1)
    slides = ep.Trajectory(circle, times=2.0 * angles, yaw=angles - 0.1)
    wheel = next(part for part in ep.actors.car(trajectory=slides).parts if part.name == "wheel/front_right/rim")
    x, y, steer, speed, turn = *wheel.position[:2], math.atan(2.637 / RADIUS), 0.5 * RADIUS, 0.5    # m, rad, m/s, rad/s
    ahead = (speed * math.cos(0.1) - y * turn) * math.cos(steer) + (speed * math.sin(0.1) + x * turn) * math.sin(steer)
    spins = [angle_about_y(about_z(-steer) @ wheel.motion.at(time)[:3, :3]) for time in (3.0, 3.1)]
    assert np.angle(np.exp(1j * (spins[1] - spins[0]))) / 0.1 == pytest.approx(ahead / (0.632 / 2), rel=2e-3)


def test_cars_of_a_kind_share_their_meshes(car):
    other = ep.actors.car(trajectory=DRIVE.shifted(1.0))
    assert all(one.mesh is two.mesh for one, two in zip(car.parts, other.parts, strict=True))


def test_front_wheels_steer_as_the_curve_asks(car):
    middle = float(DRIVE.time_at(25 - RADIUS + RADIUS * np.pi / 4))
    axle = motion_of(car, "wheel/front_left/tyre").at(middle)[:3, 1]
    assert math.atan2(-axle[0], axle[1]) == pytest.approx(math.atan(2.637 / RADIUS), abs=1e-4)
    assert abs(motion_of(car, "wheel/front_left/tyre").at(1.0)[0, 1]) < 1e-6


@pytest.mark.parametrize("ahead", [True, False])
def test_front_wheels_of_what_reverses_steer_to_the_side_of_the_centre(ahead):
    """On a circle about a point on the left the wheels look to the left, whether it drives forwards or backs up."""
    angles = np.linspace(0.0, math.pi, 25) if ahead else np.linspace(math.pi, 0.0, 25)
    circle = RADIUS * np.stack([np.sin(angles), 1.0 - np.cos(angles)], axis=-1)
    backing = ep.Trajectory(circle, times=np.linspace(0.0, 12.0, 25), yaw=angles)
    axle = motion_of(ep.actors.car(trajectory=backing), "wheel/front_left/tyre").at(6.0)[:3, 1]
    assert math.atan2(-axle[0], axle[1]) == pytest.approx(math.atan(2.637 / RADIUS), abs=1e-3)


def test_what_backs_up_straight_does_not_steer():
    there = ep.Trajectory([(0, 0), (2, 0), (4, 0), (5, 0), (4, 0), (2, 0), (0, 0)], times=np.arange(7.0), yaw=np.zeros(7))
    wheel = motion_of(ep.actors.car(trajectory=there), "wheel/front_left/tyre")
    assert all(abs(wheel.at(time)[0, 1]) < 1e-6 for time in np.linspace(0.0, 6.0, 61))


def test_a_rolling_tyre_touches_the_road_without_slipping(car):
    """A point of the tread has no velocity where it touches the road: it moves by (w t)^2 / 2 times the radius alone."""
    scene = ep.Scene()
    scene.add(car, name="car")
    mesh = next(mesh.id for mesh in scene.meshes if mesh.name == "car/wheel/rear_left/tyre")
    time, step = float(DRIVE.time_at(14.0)), 1e-3
    before, after = (scene.world_vertices(mesh, time + shift) for shift in (-0.5 * step, 0.5 * step))
    lowest = np.argmin(before[:, 2] + after[:, 2])
    height = 0.5 * (before[lowest, 2] + after[lowest, 2])
    speed = np.linalg.norm(after[lowest] - before[lowest]) / step
    assert speed < 7.0 * math.sqrt(2 * height / 0.316) + 0.05


def test_motorcycles_trucks_vans_and_bicycles_roll_too():
    short = ep.Trajectory([(0, 0), (6, 0)], speed=6.0)
    for actor, wheel, diameter in ((ep.actors.motorcycle(trajectory=short, rider=False), "wheel/rear/tyre", 0.63),
                                   (ep.actors.truck(trajectory=short), "wheel/trailer_1_left/rim", 1.01),
                                   (ep.actors.van(trajectory=short), "wheel/front_right/rim", 0.712),
                                   (ep.actors.bicycle(trajectory=short), "wheel_front/rim", 0.686)):
        assert_same_angle(angle_about_y(motion_of(actor, wheel).at(0.7)[:3, :3]), 4.2 / (diameter / 2))


STROLL = ep.Trajectory([(0, 0), (5, 0), (5, 6)], turn_radius=2.0, speed=2.0, stops=[(0, 0.4), (6, 0.7), (math.inf, 0)])
LEGS = ("fore_left", "hind_right", "fore_right", "hind_left")
SOLE = 0.04 * 0.57   # m, radius of a paw


def paws_of(dog, trajectory, leg, times):
    """The centre of the paw [T, 3] in the world: the lower end of the lower bar, of .34 or .36 withers' heights."""
    motion, half = motion_of(dog, f"leg_{leg}/lower"), 0.5 * 0.57 * (0.34 if leg.startswith("fore") else 0.36)
    return np.array([world_of(trajectory, motion, np.array([0.0, 0.0, -half]), time) for time in times])


def test_paws_of_a_dog_stand_still_in_curves_and_at_stops():
    dog = ep.actors.dog(trajectory=STROLL)
    assert dog.motion is STROLL
    step = 0.008  # s
    times = np.arange(STROLL.begin + 0.5, STROLL.end - 0.3, step)
    down = np.zeros(len(times))
    for leg in LEGS:
        paws = paws_of(dog, STROLL, leg, times)
        stands = np.abs(paws[:, 2] - SOLE) < 5e-4
        assert paws[:, 2].min() > SOLE - 2e-3
        both = stands[1:] & stands[:-1]
        slip = np.linalg.norm(np.diff(paws[:, :2], axis=0), axis=1)[both] / step
        assert both.mean() > 0.4 and np.quantile(slip, 0.9) < 0.05   # m/s, of a body at 2 m/s
        waits = (STROLL.speed(times) == 0.0)
        assert waits.sum() * step > 0.4 and np.abs(paws[waits, 2] - SOLE).max() < 3e-3
        down += stands
    assert set(np.unique(down)) <= {0, 1, 2, 3, 4}


def test_a_dog_steps_as_long_as_its_trot_does():
    straight = ep.Trajectory([(0, 0), (12, 0)], speed=2.2)
    paws = paws_of(ep.actors.dog(trajectory=straight), straight, "fore_left", np.arange(1.0, 4.5, 0.002))
    stands = np.abs(paws[:, 2] - SOLE) < 2e-4
    places = np.unique(np.round(paws[stands, 0], 1))
    strides = np.diff(places[np.concatenate([[True], np.diff(places) > 0.3])])
    assert strides == pytest.approx(2.2 / (1.35 + 0.33 * 2.2), rel=0.12)   # m, by the stride frequency of the model
    with pytest.raises(ValueError, match="trajectory: must be one of at most 4 m/s for a dog"):
        ep.actors.dog(trajectory=straight.replace(speed=5.0))


CURVE, SPEED = 15.0, 6.0                         # m, m/s
DRIVE_AXLE, HITCH, AXLES = 3.15, 3.70, -5.29     # m along the truck: rear axle of the tractor, kingpin, middle of the trailer's


@pytest.fixture(scope="module")
def circling():
    """(trajectory, truck) on a straight line and two laps of a circle: a hexagon whose corners are all arc."""
    side = 2.0 * CURVE * math.tan(math.pi / 6)
    points = np.cumsum([(0.0, 0.0), (40.0 + 0.5 * side, 0.0),
                        *((side * math.cos(k * math.pi / 3), side * math.sin(k * math.pi / 3)) for k in range(1, 13))], axis=0)
    trajectory = ep.Trajectory(points, turn_radius=CURVE, speed=SPEED)
    return trajectory, ep.actors.truck(trajectory=trajectory)


def world_of(trajectory, motion, points, time):
    """Points [3] of the vehicle, m, which a motion moves, in the world."""
    own, yaw = motion.at(time), float(trajectory.yaw(time))
    turn = np.array([[math.cos(yaw), -math.sin(yaw), 0.0], [math.sin(yaw), math.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    return trajectory.position(time) + turn @ (own[:3, :3] @ points + own[:3, 3])


def yaw_of(motion, time):
    return math.atan2(*motion.at(time)[[1, 0], 0])


def test_a_trailer_comes_to_the_angle_of_its_circle(circling):
    """asin(L / R_hitch) - atan(a / R), and its wheels to the speed of their own circle: R_trailer^2 = R_hitch^2 - L^2."""
    trajectory, truck = circling
    ahead, behind = motion_of(truck, "tractor/chassis"), motion_of(truck, "trailer/chassis")
    a, length = HITCH - DRIVE_AXLE, HITCH - AXLES
    lag = math.asin(length / math.hypot(CURVE, a)) - math.atan(a / CURVE)
    time = float(trajectory.end) - 3.0
    assert yaw_of(ahead, time) - yaw_of(behind, time) == pytest.approx(lag, abs=1e-4)
    assert yaw_of(behind, 2.0) == pytest.approx(0.0, abs=1e-6)          # still on the line
    wheel = next(part for part in truck.parts if part.name == "wheel/trailer_2_left/rim")
    radius = math.sqrt(CURVE**2 + a**2 - length**2)
    rolled = []
    for at in (time, time + 0.01):                                      # about its own axle
        own, turn = wheel.motion.at(at)[:3, :3], yaw_of(behind, at)
        about_z = np.array([[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
        rolled.append(angle_about_y(about_z.T @ own))
    rate = np.angle(np.exp(1j * (rolled[1] - rolled[0]))) / 0.01
    assert rate == pytest.approx(SPEED / CURVE * (radius - wheel.position[1]) / (1.01 / 2), rel=2e-3)


def test_a_trailer_hangs_on_its_hitch_and_does_not_slip_sideways(circling):
    """At any time, also where the curve begins: both ends of the hitch are one, the trailer's axles go where it points."""
    trajectory, truck = circling
    ahead, behind = motion_of(truck, "cab/body"), motion_of(truck, "trailer/side_left")
    for time in np.linspace(0.5, trajectory.end - 0.5, 40):
        ends = [world_of(trajectory, one, np.array([HITCH, 0.0, 1.1]), time) for one in (ahead, behind)]
        assert np.linalg.norm(ends[0] - ends[1]) < 1e-4
        before, after = (world_of(trajectory, behind, np.array([AXLES, 0.0, 0.0]), time + step) for step in (-1e-3, 1e-3))
        velocity = (after - before) / 2e-3
        yaw = yaw_of(behind, time) + float(trajectory.yaw(time))
        assert abs(velocity[1] * math.cos(yaw) - velocity[0] * math.sin(yaw)) < 5e-3
        axle = world_of(trajectory, ahead, np.array([DRIVE_AXLE, 0.0, 0.0]), time)
        if time + DRIVE_AXLE / SPEED < trajectory.end:
            assert np.linalg.norm(axle - trajectory.position(time + DRIVE_AXLE / SPEED)) < 1e-4  # on the path


def test_a_trailer_follows_a_tractor_whose_yaw_is_given():
    """A table with places and yaws of a circle, as traffic simulations write them."""
    times = np.linspace(0.0, 20.0, 401)
    angle = SPEED / CURVE * times
    points = CURVE * np.stack([np.sin(angle), 1.0 - np.cos(angle)], axis=-1)
    trajectory = ep.Trajectory(points, times=times, yaw=angle)
    truck = ep.actors.truck(trajectory=trajectory)
    hitch = math.hypot(CURVE, HITCH)
    lag = math.asin((HITCH - AXLES) / hitch) - math.atan(HITCH / CURVE)
    assert yaw_of(motion_of(truck, "cab/body"), 18.0) == pytest.approx(0.0, abs=1e-6)
    assert -yaw_of(motion_of(truck, "trailer/roof"), 18.0) == pytest.approx(lag, abs=1e-3)


@pytest.mark.parametrize("pitch", [False, True])
def test_a_radar_on_the_cab_turns_with_the_drive_axle(circling, pitch):
    """On a circle about a centre, whose tangent the drive axle has: a place ahead of that axle is on a larger circle."""
    trajectory, truck = circling[0].replace(pitch=pitch), circling[1]
    x, y = 8.3, 0.4
    mount = trajectory.motion((x, y, 0.7), axle=DRIVE_AXLE)
    for time in np.linspace(trajectory.end - 12.0, trajectory.end - 2.0, 9):
        at = mount.at(time)
        place = at[:3, 3] - [40.0, CURVE, 0.7]
        assert np.hypot(*place[:2]) == pytest.approx(math.hypot(CURVE - y, x - DRIVE_AXLE), abs=1e-4)
        bearing = math.atan2(place[1], place[0]) - math.atan2(x - DRIVE_AXLE, CURVE - y) + math.pi / 2
        assert np.angle(np.exp(1j * (bearing - math.atan2(at[1, 0], at[0, 0])))) == pytest.approx(0.0, abs=1e-5)
        assert place[2] == pytest.approx(0.0, abs=1e-5)
        cab = world_of(trajectory, motion_of(truck, "cab/body"), np.array([x, y, 0.7]), time)
        assert np.linalg.norm(at[:3, 3] - cab) < 2e-4


def test_a_truck_that_backs_up_is_where_it_was_when_it_pulled_out_that_way():
    """A trailer that does not slip goes back as it came, in line where the way out begins."""
    angles = np.linspace(0.0, 0.5 * math.pi, 13)
    circle = 30.0 * np.stack([np.sin(angles), 1.0 - np.cos(angles)], axis=-1)
    out = ep.Trajectory(circle, times=np.linspace(0.0, 12.0, 13), yaw=angles)
    back = ep.Trajectory(circle[::-1], times=np.linspace(0.0, 12.0, 13), yaw=angles[::-1])
    ways = [(motion_of(ep.actors.truck(trajectory=one), "trailer/side_left"), one) for one in (out, back)]
    for time in np.linspace(0.0, 12.0, 7):
        there, here = (yaw_of(motion, at) + one.yaw(at) for (motion, one), at in zip(ways, (time, 12.0 - time)))
        assert here == pytest.approx(there, abs=1e-4)


def test_ways_that_fold_a_truck_are_warned_of():
    with pytest.warns(RuntimeWarning, match=r"^trajectory: folds the truck by \d+ degrees, from .* s on by more than 90"):
        ep.actors.truck(trajectory=ep.Trajectory([(0, 0), (40, 0), (40, 8), (0, 8)], turn_radius=4 - 1e-6, speed=5))


def test_a_cyclist_pedals_with_the_distance():
    """One turn of the crank of 0.17 m for each 4.2 m; the pedals stay level, and the shoes over them."""
    rider = ep.actors.cyclist(trajectory=DRIVE, phase=0.0, edge=0.05)
    for time in (0.1, 1.5, 3.0, float(DRIVE.end)):
        turn = 2 * np.pi * DRIVE.distance(time) / 4.2
        pedal, foot = (motion_of(rider, name).at(time)[:3, 3] for name in ("bicycle/pedal_left", "rider/leg_left/foot"))
        np.testing.assert_allclose(pedal[[0, 2]], [0.17 * np.sin(turn), 0.285 + 0.17 * np.cos(turn)], atol=1e-5)
        assert np.linalg.norm((foot - pedal)[[0, 2]]) < 0.25
        assert_same_angle(angle_about_y(motion_of(rider, "bicycle/crank").at(time)[:3, :3]), turn)


FOLLOWING = ["car", "van", "truck", "motorcycle", "bicycle", "cyclist", "pedestrian", "runner", "child", "dog"]


@pytest.mark.parametrize("make", FOLLOWING)
def test_who_waits_all_the_time_stands_still_on_the_floor(make):
    waits = ep.Trajectory([(5, 6)] * 3, times=[0, 1, 2], yaw=[1.0] * 3)
    scene = ep.Scene()
    scene.add(getattr(ep.actors, make)(trajectory=waits), name="a")
    first, later = (np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes]) for time in (0.3, 1.7))
    np.testing.assert_allclose(first, later, rtol=0, atol=1e-9)
    assert -1e-9 <= first[:, 2].min() < 0.01 and np.hypot(*(first[:, :2] - [5, 6]).T).min() < 1.0


@pytest.mark.parametrize("make", FOLLOWING)
def test_what_a_trajectory_replaces_is_refused_beside_it(make):
    with pytest.raises(ValueError, match="^speed: must be left out beside trajectory, got 2.5"):
        getattr(ep.actors, make)(trajectory=WALK, speed=2.5)
    with pytest.raises(TypeError, match="^trajectory: must be a Trajectory"):
        getattr(ep.actors, make)(trajectory=5)


def test_other_refusals():
    with pytest.raises(ValueError, match="^trajectory: must be one of at most 2.83 m/s"):
        ep.actors.pedestrian(trajectory=DRIVE)
    with pytest.raises(ValueError, match="^speed: must be left out for an actor or model that follows"):
        ep.Scene().add(ep.actors.bicycle(trajectory=WALK), name="a", speed=1.0)
    with pytest.raises(ValueError, match="^motion: must be left out for an actor or model that follows"):
        ep.Scene().add(ep.actors.bicycle(trajectory=WALK), name="a", motion=WALK)


@pytest.mark.parametrize("make, speed", [("pedestrian", 1.2), ("dog", 1.5), ("cyclist", 3.0)])
def test_who_waits_for_long_moves_as_who_does_not_wait(make, speed):
    """Ten seconds of a way amid 3600 s, as of a person of SUMO who waits for a bus: keys are needed where it moves alone."""
    def vertices(begin, end, times):
        way = ep.Trajectory([(0, 0), (0, 0), (10 * speed, 0), (10 * speed, 0)], times=[begin, 1800.0, 1810.0, end])
        scene = ep.Scene()
        scene.add(getattr(ep.actors, make)(trajectory=way), name="a")
        return [np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes]) for time in times]

    times = (1799.5, 1800.4, 1803.137, 1809.9, 1812.0)
    first, *rest = vertices(0.0, 3600.0, (0.0, 600.0, 1200.0, 1799.0, *times))
    waiting, moving = rest[:3], rest[3:]
    np.testing.assert_allclose(moving, vertices(1798.0, 1813.0, times), rtol=0, atol=1e-4)
    np.testing.assert_allclose(waiting, [first] * 3, rtol=0, atol=1e-9)
    with pytest.raises(ValueError, match="^trajectory: must be at most .* s on the move at such a keyframe_rate"):
        getattr(ep.actors, make)(trajectory=ep.Trajectory([(0, 0), (4000, 0)], speed=1.2))


def test_steps_that_no_legs_reach_are_refused_with_their_time():
    """A walk of 1.4 m/s with 4 m in a second amid it, which by cubics through the places is fastest between 3 and 4 s."""
    way = ep.Trajectory([(x, 0) for x in (0, 1.4, 2.8, 4.2, 8.2, 9.6, 11)], times=range(7))
    with pytest.raises(ValueError, match=r"^trajectory: must be one along which the legs of a person of 1.78 m, .*, reach the "
                       r"ground, got '[34]\.\d+ m/s at 3\.\d+ s'$"):
        ep.actors.pedestrian(trajectory=way)


def test_wheels_steer_at_the_rate_at_which_their_angle_changes():
    """Into the bend of DRIVE, at 7 m/s: differences of the angle over time."""
    times, step = np.linspace(DRIVE.begin + 3.5, DRIVE.end - 1.0, 200), 1e-5
    before, after = (_steering(DRIVE._track, times + late, 2.7)[0] for late in (-step, step))
    rates = _steering(DRIVE._track, times, 2.7)[1]
    assert np.abs(rates).max() > 0.1 and rates == pytest.approx((after - before) / (2.0 * step), abs=1e-3)


def test_what_is_asked_for_at_other_times_is_worked_out_for_these():
    def curves(times):
        return np.stack([np.sin(times), np.cos(times)])

    repeated = Repeated(curves)
    for times in (np.array([0.0, 1.0, 2.0]), np.array([2.0, 0.5, 1.0, 3.0]), np.array([])):
        np.testing.assert_array_equal(repeated.anew()(times), curves(times))


@pytest.mark.parametrize("make, speed", [("cyclist", 5.0), ("pedestrian", 1.3), ("runner", 2.8), ("child", 1.0), ("dog", 2.0)])
def test_what_pitches_on_a_slope_is_as_on_level_ground_which_is_turned(make, speed):
    """Soles and paws, too, lie on the slope."""
    angle, settings = math.atan(0.15), {"speed": speed, "stops": [(0, 0.2), (5, 0.3), (math.inf, 0)]}
    turn = np.array([[math.cos(angle), 0.0, -math.sin(angle)], [0.0, 1.0, 0.0], [math.sin(angle), 0.0, math.cos(angle)]])
    level = ep.Trajectory([(0, 0, 0), (10, 0, 0)], **settings)
    scenes = [ep.Scene(), ep.Scene()]
    for scene, trajectory in zip(scenes, (level, ep.Trajectory([(0, 0, 0), 10.0 * turn[:, 0]], pitch=True, **settings))):
        scene.add(getattr(ep.actors, make)(trajectory=trajectory), name="a")
    for mesh in scenes[0].meshes:
        for time in np.linspace(0.1, level.end, 5).tolist():
            on_level, on_slope = (scene.world_vertices(mesh.id, time) for scene in scenes)
            np.testing.assert_allclose(on_slope, on_level @ turn.T, rtol=0, atol=1e-5)   # m, the tolerance of positions


@pytest.mark.parametrize("pitch", [False, True])
def test_wheels_of_a_truck_roll_the_whole_way_up_a_slope(pitch):
    truck = ep.actors.truck(trajectory=ep.Trajectory([(0, 0, 0), (30, 0, 4.5)], speed=8.0, pitch=pitch))
    for wheel in ("front_left", "drive_right", "trailer_2_left"):
        turned = motion_of(truck, f"wheel/{wheel}/tyre").at(3.0)[:3, :3]
        assert_same_angle(angle_about_y(turned), 8.0 * 3.0 / (1.01 / 2))   # tyres of 1.01 m
