"""The walking person against the published proportions and walking model, the floor, and measured gaits."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors.human.anthropometry import Proportions
from echopath.actors.human.boulic import Cycle, Walk
from echopath.actors.human.gait import Gait
from echopath.base.numerics.rotations import about_x, about_y, about_z, quaternions
from support.scenes.pedestrians import HEIGHT, SPEED, Person

HIP_HEIGHT = 0.530                       # of the body height: Drillis and Contini (1966), in Winter (2009)
SLIDE = 0.02                             # m a stance: what the pedestrian promises
SINK = 0.015                             # m
CONTACT = 0.002                          # m: triangles of 2.4 cm lie up to 1 mm above the round sole they stand for
WALKERS = [(1.78, 1.4), (1.78, 0.5), (1.10, 1.0), (1.95, 2.2)]   # height in m, speed in m/s


def cycle_of(height, speed):
    """Length in m and duration in s of a cycle as published: relative length 1.346 sqrt(v_R)."""
    hip = HIP_HEIGHT * height
    length = 1.346 * np.sqrt(speed / hip) * hip
    return length, length / speed


def strikes(ankle_x, times):
    """Places and times at which a foot comes to rest: middle of each interval in which the ankle stands still."""
    still = np.abs(np.gradient(ankle_x, times)) < 1e-3
    begins = np.flatnonzero(still[1:] & ~still[:-1]) + 1
    ends = np.flatnonzero(~still[1:] & still[:-1])
    ends = ends[ends > begins[0]]
    return [(ankle_x[(b + e) // 2], times[(b + e) // 2]) for b, e in zip(begins, ends)]


@pytest.mark.parametrize("height, speed", WALKERS)
def test_stride_has_the_published_length_and_duration(height, speed):
    times = np.arange(0.0, 3.0 * cycle_of(height, speed)[1], 0.002)
    gait = Gait(Proportions(height), speed)
    ankle = gait.frames(times / gait.cycle.duration)["leg_right/foot"].origin[:, 0]
    places = np.diff(np.array(strikes(ankle, times)), axis=0)
    assert len(places) >= 1
    np.testing.assert_allclose(places[:, 0], cycle_of(height, speed)[0], rtol=1e-9)
    np.testing.assert_allclose(places[:, 1], cycle_of(height, speed)[1], atol=0.004)   # two time steps


def test_support_share_follows_the_published_line():
    # Duration of support 0.752 T - 0.143 s of a cycle of T s: about 60 % of a usual walk.
    cycle = Cycle.of(SPEED, HIP_HEIGHT * HEIGHT)
    assert cycle.support == pytest.approx((0.752 * cycle.duration - 0.143) / cycle.duration)
    assert 0.58 < cycle.support < 0.64


@pytest.mark.parametrize("height, speed", WALKERS)
def test_mean_speed_is_the_asked_one(height, speed):
    duration = cycle_of(height, speed)[1]
    person = Person(height, speed)
    for name in ("torso", "arm_left/hand", "leg_right/foot"):
        way = np.diff(person.center(name, [0.0, 2 * duration])[:, 0])[0]
        assert way / (2 * duration) == pytest.approx(speed, rel=1e-3, abs=0)


def test_pelvis_is_above_the_origin_at_time_zero(person):
    assert np.abs(person.center("pelvis", [0.0])[0, :2]).max() < 0.04


CONTROL_POINTS = [   # phase, degrees of the published trajectories at relative speed 1
    ("hip", 0.5, -15.0), ("hip", 0.9, 25.0), ("knee", 0.17, 3.0), ("knee", 0.4, 3.0), ("knee", 0.75, 70.0),
    ("ankle", 0.08, -18.0), ("ankle", 0.5, 8.0), ("ankle", 0.85, -3.0), ("elbow", 0.05, 11.0), ("elbow", 0.50625, 35.0),
    ("elbow", 0.9, 13.625), ("shoulder", 0.0, 3 - 1.5 * 9.88), ("shoulder", 0.5, 3 + 0.5 * 9.88)]
SMOOTHING_ERROR = 2.0   # deg: curves with corners in their slope are smoothed over 1 % of a cycle


@pytest.mark.parametrize("joint, phase, degrees", CONTROL_POINTS)
def test_trajectories_pass_the_published_control_points(joint, phase, degrees):
    walk = Walk(1.0, support_share(1.0))
    assert np.degrees(getattr(walk, joint)(phase)) == pytest.approx(degrees, abs=SMOOTHING_ERROR)


def support_share(relative_speed):
    duration = 1.346 / np.sqrt(relative_speed)
    return (0.752 * duration - 0.143) / duration


@pytest.mark.parametrize("height, speed", WALKERS)
def test_feet_stand_on_the_floor_without_sliding(height, speed):
    person = Person(height, speed)
    times = np.arange(0.0, 2.2, 0.002)
    supported = np.zeros(len(times), bool)
    for side in ("left", "right"):
        points = person.vertices(f"leg_{side}/foot", times)
        touches = points[:, :, 2] < CONTACT
        assert slide_while(touches, points).max() <= SLIDE
        lowest = points[:, :, 2].min(axis=1)
        assert lowest.min() > -SINK / 5
        supported |= lowest < SINK / 3
    assert supported.all()           # a walker never flies


def slide_while(touches, points):
    """Greatest distance [V] in the floor's plane between any two positions of a vertex within one contact."""
    slides = np.zeros(points.shape[1])
    for v in np.flatnonzero(touches.any(axis=0)):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], touches[:, v].astype(int), [0]])))
        for begin, end in edges.reshape(-1, 2):
            track = points[begin:end, v, :2]
            slides[v] = max(slides[v], np.linalg.norm(np.ptp(track, axis=0)))
    return slides


def test_nothing_sinks_below_the_floor(person):
    for name in person.ids:
        assert person.vertices(name, np.linspace(0.0, 1.2, 61))[:, :, 2].min() > -SINK


def test_left_side_is_the_right_side_half_a_cycle_later(person):
    length, duration = cycle_of(HEIGHT, SPEED)
    times = np.linspace(0.0, 1.0, 11)
    for name in ("arm_{}/hand", "leg_{}/shank", "leg_{}/foot"):
        right = person.center(name.format("right"), times)
        left = person.center(name.format("left"), times + duration / 2)
        mirrored = right * [1, -1, 1] + [length / 2, 0, 0]
        np.testing.assert_allclose(left, mirrored, atol=5e-4)    # keyframes fall on other phases


def knee_bend(person, times):
    """Angle [T] in degrees between thigh and shank from their keyframed axes, and from their meshes' long axes."""
    axes = []
    for name in ("leg_right/thigh", "leg_right/shank"):
        local = np.asarray(person.parts[name].mesh.vertices)
        top, bottom = np.argmax(local[:, 2]), np.argmin(local[:, 2])
        world, rest = person.vertices(name, times), local[top] - local[bottom]
        axes.append(world[:, top] - world[:, bottom])
        assert rest[2] / np.linalg.norm(rest) > 0.99             # the long axis is nearly the segment's
    cosine = np.sum(axes[0] * axes[1], axis=1) / np.prod([np.linalg.norm(a, axis=1) for a in axes], axis=0)
    return np.degrees(np.arccos(cosine))


def test_knee_bends_as_measured_ones_do(person):
    # Normal gait: about 60 to 65 deg in swing, 15 to 25 deg under load, nearly straight in between.
    duration = cycle_of(HEIGHT, SPEED)[1]
    phase = np.arange(0.0, 1.0, 0.01)
    bend = knee_bend(person, phase * duration)
    assert 55.0 < bend.max() < 67.0
    assert 0.68 < phase[bend.argmax()] < 0.82
    assert 12.0 < bend[(phase > 0.08) & (phase < 0.25)].max() < 28.0
    assert bend[(phase > 0.3) & (phase < 0.45)].min() < 12.0


def test_limb_speeds_are_those_of_a_walker(person):
    # Radar and motion capture: feet reach about three times the walking speed, arms swing by about one.
    duration = cycle_of(HEIGHT, SPEED)[1]
    times = np.arange(0.0, 1.5 * duration, 0.002)
    speed = {name: np.gradient(person.center(name, times)[:, 0], times) for name in
             ("leg_right/foot", "arm_right/hand", "torso", "head")}
    assert 2.5 < speed["leg_right/foot"].max() / SPEED < 4.5
    assert speed["leg_right/foot"].min() > -0.1 * SPEED
    assert 0.4 < np.abs(speed["arm_right/hand"] - SPEED).max() / SPEED < 1.4
    for name in ("torso", "head"):
        assert np.abs(speed[name] - SPEED).max() < 0.35 * SPEED


def test_arms_swing_against_the_legs(person):
    times = np.arange(0.0, cycle_of(HEIGHT, SPEED)[1], 0.02)
    for side in ("left", "right"):
        hand = person.center(f"arm_{side}/hand", times)[:, 0] - SPEED * times
        foot = person.center(f"leg_{side}/foot", times)[:, 0] - SPEED * times
        assert np.corrcoef(hand, foot)[0, 1] < -0.7


def test_knees_and_elbows_bend_the_human_way_and_toes_point_forward(person):
    for side in ("left", "right"):
        hip, knee, ankle, shoulder, elbow, wrist = (
            np.asarray(person.parts[name.format(side)].motion.translations) for name in
            ("leg_{}/thigh", "leg_{}/shank", "leg_{}/foot", "arm_{}/upper", "arm_{}/forearm", "arm_{}/hand"))
        assert np.cross(knee - hip, ankle - knee)[:, 1].min() > 0        # shank backwards of the thigh
        assert np.cross(elbow - shoulder, wrist - elbow)[:, 1].max() < 0  # forearm ahead of the upper arm
        foot = np.asarray(person.parts[f"leg_{side}/foot"].mesh.vertices)
        toe, heel = np.argmax(foot[:, 0]), np.argmin(foot[:, 0])
        flat = person.vertices(f"leg_{side}/foot", np.arange(0.0, 1.1, 0.05))
        assert (flat[:, toe, 0] - flat[:, heel, 0]).min() > 0.0


def test_keyframes_are_unit_continuous_and_dense():
    person = ep.actors.pedestrian(start_time=1.0, duration=0.7, keyframe_rate=90.0)
    for part in person.parts:
        times, q = np.asarray(part.motion.times), np.asarray(part.motion.rotations)
        assert (times[0], times[-1]) == pytest.approx((1.0, 1.7))
        assert np.diff(times).max() <= 1 / 90 + 1e-12
        np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1.0, atol=1e-12)
        assert np.sum(q[1:] * q[:-1], axis=1).min() > 0.9


@pytest.mark.parametrize("about, axis", [(about_x, 0), (about_y, 1), (about_z, 2)])
def test_quaternions_follow_two_turns_without_a_jump(about, axis):
    angle = np.linspace(0.0, 4.0 * np.pi, 101)
    expected = np.zeros((101, 4))
    expected[:, 0], expected[:, 1 + axis] = np.cos(angle / 2), np.sin(angle / 2)
    np.testing.assert_allclose(quaternions(about(angle)), expected, atol=1e-12)


def test_keyframes_hold_the_gait_between_them(person):
    # 77 GHz: 0.1 mm is 0.3 rad of phase, over a whole motion; within a frame it hardly changes.
    gait = Gait(Proportions(HEIGHT), SPEED)
    times = np.linspace(0.2, 1.5, 700) + 1e-4
    for name, frame in gait.frames(times / gait.cycle.duration).items():
        local = np.asarray(person.parts[name].mesh.vertices)[::50]
        exact = frame.origin[:, None] + np.einsum("tij,vj->tvi", frame.rotation, local)
        assert np.abs(person.vertices(name, times)[:, ::50] - exact).max() < 1e-4, name


def test_motion_is_the_same_walk_whatever_the_phase_and_start():
    late = ep.actors.pedestrian(start_time=0.3, duration=1.0, keyframe_rate=100.0)
    early = ep.actors.pedestrian(start_time=0.0, duration=1.5, keyframe_rate=100.0)
    _, duration = cycle_of(HEIGHT, SPEED)
    ahead = ep.actors.pedestrian(start_time=0.0, duration=1.0, keyframe_rate=100.0, phase=0.3 / duration)
    for a, b, c in zip(early.parts, late.parts, ahead.parts):
        expected = np.asarray(a.motion.translations)[30:131]
        np.testing.assert_allclose(np.asarray(b.motion.translations), expected, atol=1e-9)
        np.testing.assert_allclose(np.asarray(c.motion.translations), expected - [0.3 * SPEED, 0, 0], atol=1e-9)


@pytest.mark.parametrize("arguments, message", [
    ({"height": -1.0}, "height: must be a finite number from 0.5 to 2.5 m, got -1.0"),
    ({"speed": 0.0}, "speed: must be a finite number above 0 m/s, got 0.0"),
    ({"speed": 5.0}, "speed: must be a finite number from 0.1 to 2.83 m/s for a height of 1.78 m, got 5.0"),
    ({"duration": 0.0}, "duration: must be a finite number above 0 s, got 0.0"),
    ({"keyframe_rate": 10.0}, "keyframe_rate: must be a finite number of at least 60 1/s, got 10.0"),
    ({"edge": 1e-7}, "edge: must be long enough"),
    ({"edge": 1.0}, "edge: must be a finite number from 0 to 0.089 m, got 1.0"),
    ({"phase": float("inf")}, "phase: must be a finite number in cycles, got inf"),
])
def test_bad_arguments_name_rule_and_value(arguments, message):
    with pytest.raises(ValueError, match=message):
        ep.actors.pedestrian(**arguments)


def test_unknown_keyword_names_the_nearest_right_one():
    with pytest.raises(TypeError, match="unknown keyword 'hieght', the nearest right one is 'height'"):
        ep.actors.pedestrian(hieght=1.8)


@pytest.mark.parametrize("person", [ep.actors.pedestrian, ep.actors.runner])
def test_a_speed_that_is_not_for_a_height_names_both(person):
    with pytest.raises(ValueError, match="^speed: must be a finite number from .* m/s for a height of 0.5 m, got"):
        person(height=0.5)


@pytest.mark.parametrize("actor, most", [("pedestrian", 0.089), ("runner", 0.089), ("standing_person", 0.089),
                                         ("cyclist", 0.089), ("child", 0.0575)])
def test_no_person_has_triangles_too_long_for_a_body(actor, most):
    """A twentieth of the height, 1.78 m or 1.15 m."""
    with pytest.raises(ValueError, match=f"edge: must be a finite number from 0 to {most} m, got 0.5"):
        getattr(ep.actors, actor)(edge=0.5)
