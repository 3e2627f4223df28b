"""Persons who run and stand, and the dog: feet that do not slide, flight, published stride and joints."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors.human.anthropometry import Proportions
from echopath.actors.human.running import RunningGait
from support.closed import extent, scene_of

SLIDE = 0.004       # m over the time, of a point of the sole within TOUCH of the floor: at its rim it rolls
TOUCH = 0.001       # m
CONTACT = 0.003     # m: triangles of 3 cm stand for a round sole


def angles(height, speed):
    """Phase [T], knee bend and ankle height of the right leg over a cycle."""
    gait = RunningGait(Proportions(height), speed)
    phase = np.linspace(0.0, 1.0, 201)
    frames = gait.frames(phase)
    hip, knee, ankle = (frames[f"leg_right/{name}"].origin for name in ("thigh", "shank", "foot"))
    cosine = np.sum((hip - knee) * (knee - ankle), 1) / np.linalg.norm(hip - knee, axis=1) / np.linalg.norm(knee - ankle, axis=1)
    return gait, phase, np.degrees(np.arccos(cosine)), ankle[:, 2]


@pytest.mark.parametrize("height, speed", [(1.78, 3.0), (1.78, 4.5), (1.10, 2.0)])
def test_a_foot_that_touches_the_floor_does_not_slide_and_there_is_flight(height, speed):
    scene = scene_of(ep.actors.runner(height=height, speed=speed, edge=0.03))
    times = np.arange(0.0, 0.8, 0.004)
    on_floor = np.zeros(len(times), bool)
    for side in ("left", "right"):
        (mesh,) = [mesh.id for mesh in scene.meshes if mesh.name == f"a/leg_{side}/foot"]
        points = np.stack([scene.world_vertices(mesh, float(t)) for t in times])
        assert points[:, :, 2].min() > -CONTACT
        near = points[:, :, 2] < TOUCH
        both = near[1:] & near[:-1]
        step = np.where(both, np.linalg.norm(np.diff(points[:, :, :2], axis=0), axis=-1), 0.0)
        assert both.sum() > 20 and step.sum(axis=0).max() < SLIDE
        on_floor |= near.any(axis=1)
    assert 0.3 < np.mean(on_floor) < 0.95               # never both feet: some of the time none is on the floor


def test_stride_and_joints_are_as_published_of_runs_at_3_m_s():
    gait, phase, knee, _ = angles(1.78, 3.0)
    assert 2.5 < 2.0 / gait.cycle.duration < 3.0          # steps a second
    assert 0.33 < gait.cycle.support < 0.42               # 0.39 at 3.2 m/s (Novacheck 1998)
    stance = phase < gait.cycle.support
    assert 40.0 < knee[stance].max() < 65.0               # about 45 deg at midstance
    assert 90.0 < knee.max() < 140.0                      # in swing
    assert knee.min() > 5.0


def test_mean_speed_of_a_run_is_the_asked_one():
    gait = RunningGait(Proportions(1.78), 3.7)
    assert gait.cycle.length / gait.cycle.duration == pytest.approx(3.7, rel=1e-12)


def test_speeds_out_of_range_are_refused():
    with pytest.raises(ValueError, match="speed: must be a finite number from 1.8 to 5 m/s for a height of 1.78 m, got 9.0"):
        ep.actors.runner(speed=9.0)


@pytest.mark.parametrize("height", [1.78, 1.55])
def test_a_standing_person_has_its_height_and_stands_on_the_floor(height):
    size, lowest = extent(ep.actors.standing_person(height=height, edge=0.03))
    assert size[2] == pytest.approx(height, abs=0.02 * height)
    assert lowest == pytest.approx(0.0, abs=CONTACT)


def test_a_child_stands_walks_or_runs_by_its_speed():
    standing, walking, running = (ep.actors.child(height=1.2, edge=0.05, **o) for o in ({"speed": 0.0}, {}, {"speed": 2.6}))
    assert all(part.motion is None for part in standing.parts)
    assert all(part.motion is not None for part in walking.parts + running.parts)
    size, _ = extent(standing)
    assert size[2] == pytest.approx(1.2, abs=0.03)


@pytest.mark.parametrize("speed", [1.5, 2.2, 3.5])
def test_paws_of_a_dog_rest_on_the_ground_while_they_bear(speed):
    scene = scene_of(ep.actors.dog(speed=speed))
    times = np.arange(0.0, 0.9, 0.004)
    for leg in ("fore_left", "hind_left", "fore_right", "hind_right"):
        (mesh,) = [mesh.id for mesh in scene.meshes if mesh.name == f"a/leg_{leg}/lower"]
        points = np.stack([scene.world_vertices(mesh, float(t)) for t in times])
        lowest = points[:, :, 2].min(axis=1)
        assert lowest.min() > -0.003
        center = np.array([one[one[:, 2] < least + 0.012].mean(axis=0) for one, least in zip(points, lowest)])
        bears = (lowest[1:] < 1e-3) & (lowest[:-1] < 1e-3)
        speeds = np.abs(np.diff(center[:, 0])) / 0.004
        assert bears.sum() > 50 and np.median(speeds[bears]) < 0.35 * speed   # the contact rolls over a round paw


def legs_of(dog, height, times):
    """{leg: [4, T, 3]}: both ends of the upper and of the lower bar, downwards, in m."""
    motions, found = {part.name: part.motion for part in dog.parts}, {}
    for leg, length in (("fore_left", 0.34 * height), ("hind_left", 0.36 * height)):
        poses = [np.array([motions[f"leg_{leg}/{bar}"].at(float(time)) for time in times]) for bar in ("upper", "lower")]
        found[leg] = np.array([pose[:, :3, 3] + side * length * pose[:, :3, 2] for pose in poses for side in (0.5, -0.5)])
    return found


@pytest.mark.parametrize("speed", [1.0, 2.2, 4.0])
def test_the_parts_of_a_dogs_leg_meet_and_none_is_faster_than_its_paw(speed):
    rate = 240.0  # 1/s, of the keyframes
    times = np.arange(0, 160) / rate
    for top, knee, below, paw in legs_of(ep.actors.dog(speed=speed, start_time=0.0, duration=1.0), 0.57, times).values():
        assert np.linalg.norm(knee - below, axis=1).max() < 1e-9
        fastest = [np.linalg.norm(np.diff(joint, axis=0), axis=1).max() * rate for joint in (top, knee, paw)]
        assert max(fastest[:2]) < fastest[2]


def test_dogs_of_all_heights_trot_alike():
    """At one ratio of speed^2 to height, the ways of their paws are alike in heights and roots of heights (Froude)."""
    times, paws = np.linspace(0.0, 0.5, 41), []
    for height in (0.57, 0.3):
        scale = np.sqrt(height / 0.57)
        dog = ep.actors.dog(height=height, speed=4.0 * round(scale, 3), start_time=0.0)
        paws.append(legs_of(dog, height, times * scale)["fore_left"][3] / height)
    assert np.abs(paws[1] - paws[0]).max() < 0.02   # of keyframes at other phases, and of the rounding of the speed
    with pytest.raises(ValueError, match="speed: must be a finite number from 0 to 2.902 m/s for a height of 0.3 m, got 4"):
        ep.actors.dog(height=0.3, speed=4.0)


def test_a_dog_at_rest_has_no_motion_and_its_withers_height():
    dog = ep.actors.dog(height=0.6, speed=0.0)
    assert all(part.motion is None for part in dog.parts)
    size, lowest = extent(dog, lambda name: name == "trunk" or name.startswith("leg"))
    assert size[2] == pytest.approx(0.6, abs=0.03) and lowest == pytest.approx(0.0, abs=0.003)
