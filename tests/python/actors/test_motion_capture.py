"""Motion capture onto the walking person: joints of the file, where they are captured and as fast as they are captured."""
from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.actors.human.captured_joints import find_joints, missing_joints, plain
from echopath.actors.human.motion_capture import read_capture
from fuzz.feeds.foreign_seeds import bvh_text, walk_frames

CM = 0.01
KEY_ROUNDING = 1e-9  # m, of a spline at its own keys


@pytest.fixture
def walk(tmp_path):
    """One second of a walk at 1.3 m/s along +z of the file, y up, in cm."""
    (tmp_path / "walk.bvh").write_text(bvh_text(walk_frames(31)))
    return tmp_path / "walk.bvh"


def parts_of(scene) -> dict:
    return {node.name.removeprefix("person/"): node for node in scene.nodes}


def origin(node, time: float) -> np.ndarray:
    """Where the origin of a part is: at its proximal joint."""
    return (node.motion.at(time) @ [0, 0, 0, 1])[:3]


def test_joints_follow_their_channels_as_written_by_hand(tmp_path):
    """Z then X rotation: v' = Rz Rx v, by hand for one joint; position channels replace the offset."""
    (tmp_path / "a.bvh").write_text("""HIERARCHY
ROOT a
{
 OFFSET 9 9 9
 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
 JOINT b
 {
  OFFSET 0 0 2
  CHANNELS 3 Zrotation Xrotation Yrotation
  End Site
  { OFFSET 0 1 0 }
 }
}
MOTION
Frames: 2
Frame Time: 0.5
1 2 3 0 0 0 0 0 0
1 2 3 90 90 0 0 0 90
""")
    capture = read_capture(tmp_path / "a.bvh")
    assert [joint.name for joint in capture.joints] == ["a", "b", "b_end"] and capture.times.tolist() == [0, 0.5]
    assert np.allclose(capture.positions[0], [[1, 2, 3], [1, 2, 5], [1, 3, 5]])
    # Rx(90) takes z to -y, Rz(90) takes -y to +x: b is 2 ahead along x; the end, (0, 1, 0), is its own after Ry(90),
    # becomes z by Rx(90) and stays it by Rz(90)
    assert np.allclose(capture.positions[1], [[1, 2, 3], [3, 2, 3], [3, 2, 4]])


@pytest.mark.parametrize("name, wanted", [
    ("mixamorig:LeftUpLeg", "leftupleg"), ("Character1|RightHand", "righthand"), ("Bip01 L Thigh", "leftthigh"),
    ("upper_arm.L", "leftupperarm"), ("lShldr", "leftshldr"), ("R_Foot", "rightfoot"), ("Head", "head"),
    ("LowerBack", "lowerback"), ("LHipJoint", "lefthipjoint"), ("l_knee", "leftknee"),
    ("LeftForeArm", "leftforearm"), ("AnkleLeft", "leftankle"), ("hip_right", "righthip"),
    ("lowerback", "lowerback"), ("Root", "root"),
])
def test_names_are_read_past_what_programs_put_around_them(name, wanted):
    assert plain(name) == wanted


@pytest.mark.parametrize("names", [
    ["Hips", "LHipJoint", "LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToeBase", "RHipJoint", "RightUpLeg", "RightLeg", "RightFoot",
     "Neck", "Head", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand", "RightShoulder", "RightArm", "RightForeArm",
     "RightHand"],
    ["hip", "LeftHip", "LeftKnee", "LeftAnkle", "RightHip", "RightKnee", "RightAnkle", "Head", "LeftShoulder", "LeftElbow",
     "LeftWrist", "RightShoulder", "RightElbow", "RightWrist"],
    ["hip", "lThigh", "lShin", "lFoot", "rThigh", "rShin", "rFoot", "head", "lShldr", "lForeArm", "lHand", "rShldr", "rForeArm",
     "rHand"],
])
def test_skeletons_of_usual_programs_have_all_joints(names):
    found = find_joints(names)
    assert missing_joints(found) == [] and len(set(found.values())) == len(found)
    assert names[found["left_hip"]] in ("LeftUpLeg", "LeftHip", "lThigh")
    assert names[found["left_shoulder"]] in ("LeftArm", "LeftShoulder", "lShldr") and "Arm" in names[
        found["left_elbow"]] or names[found["left_elbow"]] == "LeftElbow"


def test_feet_behind_ankles_and_hands_behind_wrists_are_balls_and_palms():
    """As the skeleton of SMPL has them, whose left_foot is the joint of the toes."""
    names = ["Pelvis", "Left_hip", "Right_hip", "Left_knee", "Right_knee", "Left_ankle", "Right_ankle", "Left_foot", "Right_foot",
             "Head", "Left_collar", "Left_shoulder", "Right_shoulder", "Left_elbow", "Right_elbow", "Left_wrist", "Right_wrist",
             "Left_hand", "Right_hand"]
    found = {ours: names[index] for ours, index in find_joints(names).items()}
    assert (found["left_ankle"], found["left_toe"], found["right_wrist"]) == ("Left_ankle", "Left_foot", "Right_wrist")
    assert "left_toe" not in find_joints([name for name in names if "ankle" not in name])  # the foot is the ankle, then


def test_names_may_have_several_words(walk, tmp_path):
    spaced = walk.read_text().replace("JOINT LeftUpLeg", "JOINT Bip01 L Thigh").replace("JOINT RightUpLeg", "JOINT Bip01 R Thigh")
    (tmp_path / "spaced.bvh").write_text(spaced)
    capture, plainly = read_capture(tmp_path / "spaced.bvh"), read_capture(walk)
    assert {"Bip01 L Thigh", "Bip01 R Thigh", "LeftLeg"} <= {joint.name for joint in capture.joints}
    assert np.array_equal(capture.positions, plainly.positions)
    assert len(ep.load_model(tmp_path / "spaced.bvh").nodes) == len(ep.load_model(walk).nodes)


def test_hands_bend_at_the_wrist_as_captured(tmp_path):
    """About the axis across the forearm by 60 degrees: not at all in one frame, in which hand and forearm are one line."""
    frames, straight = walk_frames(21), 13
    channel = 6 + 3 * 5 + 1  # turn about y of the left hand, whose forearm lies along x of the file
    frames[:, channel] = 60.0 * np.sin(np.arange(21) - straight)
    (tmp_path / "wave.bvh").write_text(bvh_text(frames))
    capture, scene = read_capture(tmp_path / "wave.bvh"), ep.Scene()
    assert capture.joints[[joint.name for joint in capture.joints].index("LeftHand")].offset.tolist() == [25, 0, 0]
    scene.add(ep.load_model(tmp_path / "wave.bvh"), name="person")
    parts = parts_of(scene)
    for frame in (0, 5, straight, 20):
        forearm, hand = (parts[f"arm_left/{name}"].motion.at(capture.times[frame])[:3, 2] for name in ("forearm", "hand"))
        bend = np.degrees(np.arccos(np.clip(forearm @ hand, -1.0, 1.0)))
        assert bend == pytest.approx(abs(frames[frame, channel]), abs=1e-3), frame


def test_parts_sit_at_the_captured_joints_and_move_as_fast(walk):
    capture = read_capture(walk)
    index = {joint.name: number for number, joint in enumerate(capture.joints)}
    scene = ep.Scene()
    scene.add(ep.load_model(walk), name="person")
    parts = parts_of(scene)
    names = {"leg_left/thigh": "LeftUpLeg", "leg_left/shank": "LeftLeg", "leg_right/foot": "RightFoot",
             "arm_left/upper": "LeftArm", "arm_right/forearm": "RightForeArm", "arm_right/hand": "RightHand", "head": "Head"}
    hips = CM * 0.5 * (capture.positions[0, index["LeftUpLeg"]] + capture.positions[0, index["RightUpLeg"]])
    for part, joint in names.items():
        way = CM * capture.positions[:, index[joint]] - hips * [1, 0, 1]   # x ahead is z of the file, y left is its x
        wanted = way[:, [2, 0, 1]]
        ours = np.array([origin(parts[part], time) for time in capture.times])
        floor = ours[:, 2] - wanted[:, 2]
        assert np.ptp(floor) < KEY_ROUNDING
        assert np.allclose(ours[:, :2], wanted[:, :2], atol=KEY_ROUNDING), part
        middle, step = capture.times[15], 1e-4
        speed = (origin(parts[part], middle + step) - origin(parts[part], middle - step)) / (2 * step)
        captured = (wanted[16] - wanted[14]) / (capture.times[16] - capture.times[14])
        assert np.allclose(speed, captured, atol=0.02), part  # m/s, of a central difference over 1/15 s


BIPED = {"UpLeg": "Thigh", "Leg": "Calf", "Foot": "Foot", "ToeBase": "Toe0",
         "Arm": "UpperArm", "ForeArm": "Forearm", "Hand": "Hand"}


def test_names_with_spaces_and_numbers_behind_a_colon_are_read(walk, tmp_path):
    """As 3ds Max calls the joints of its biped, and as some programs write the head of the motion."""
    text = walk.read_text()
    for theirs, of_biped in BIPED.items():
        for side in ("Left", "Right"):
            text = re.sub(rf"\b(JOINT|ROOT) {side}{theirs}\b", rf"\1 Bip01 {side[0]} {of_biped}", text)
    text = text.replace("JOINT Head", "JOINT Bip01 Head").replace("Frames: ", "Frames:").replace("Frame Time: ", "Frame Time:")
    assert text.count("Bip01") > 12 and "Frames:31\n" in text
    (tmp_path / "biped.bvh").write_text(text)
    own, other = read_capture(walk), read_capture(tmp_path / "biped.bvh")
    assert "Bip01 L Thigh" in [joint.name for joint in other.joints]
    assert np.array_equal(other.positions, own.positions) and np.array_equal(other.times, own.times)
    assert ep.load_model(tmp_path / "biped.bvh").num_triangles == ep.load_model(walk).num_triangles


def test_a_file_of_one_frame_is_a_person_who_stands_still(walk, tmp_path):
    head, motion, rest = walk.read_text().partition("MOTION")
    frame = rest.strip().splitlines()[2] + "\n"
    scenes = []
    for count in (1, 2):  # the same pose once, and again after 10 ms
        (tmp_path / "pose.bvh").write_text(f"{head}{motion}\nFrames: {count}\nFrame Time: 0.01\n{count * frame}")
        scenes.append(ep.Scene())
        scenes[-1].add(ep.load_model(tmp_path / "pose.bvh"), name="person")
    for mesh in scenes[0].meshes:
        for time in (-5.0, 0.0, 1e9):
            assert np.allclose(scenes[0].world_vertices(mesh.id, time), scenes[1].world_vertices(mesh.id, 0.0), atol=KEY_ROUNDING)


def test_segments_have_the_captured_lengths_and_the_feet_stand_on_the_floor(walk):
    scene = ep.Scene()
    scene.add(ep.load_model(walk), name="person")
    parts = parts_of(scene)
    for time in (0.0, 0.4, 0.99):
        thigh = np.linalg.norm(origin(parts["leg_left/thigh"], time) - origin(parts["leg_left/shank"], time))
        assert thigh == pytest.approx(0.42, abs=1e-6)
    lowest = [min(scene.world_vertices(mesh.id, time)[:, 2].min() for mesh in scene.meshes if mesh.name.endswith("foot"))
              for time in np.linspace(0, 0.99, 21)]
    assert abs(np.quantile(lowest, 0.1)) < 0.005


def test_units_are_guessed_by_the_size_of_a_person(tmp_path):
    for unit, scale in ((1.0, 0.01), (0.01, 1.0), (0.0254, 1 / 2.54)):
        frames = walk_frames(5)
        frames[:, :3] *= scale
        text = bvh_text(frames)
        head, motion, rest = text.partition("MOTION")
        lines = [" ".join(["OFFSET", *(f"{scale * float(word):.9g}" for word in line.split()[1:])]) if "OFFSET" in line else line
                 for line in head.split("\n")]
        (tmp_path / "a.bvh").write_text("\n".join(lines) + motion + rest)
        assert ep.load_model(tmp_path / "a.bvh").unit == pytest.approx(unit)


@pytest.mark.parametrize("read", [ep.actors.captured_pedestrian, ep.load_model], ids=["actor", "model"])
def test_who_falls_and_stays_on_the_floor_stood_before(tmp_path, read):
    """A turn of the root about x by 90 degrees puts the body along z: in three of four frames it lies."""
    frames = walk_frames(40)
    frames[10:, 1], frames[10:, 5] = 15.0, 90.0
    (tmp_path / "fall.bvh").write_text(bvh_text(frames))
    scene = ep.Scene()
    with pytest.warns(RuntimeWarning, match=r'^up: fall.bvh has a body along y in 25 % .*: say up="y" where it is, else up="z"$'):
        scene.add(read(tmp_path / "fall.bvh"), name="person")
    for time, height in ((0.1, 1.75), (1.2, 0.35)):
        assert height_of(scene, time) == pytest.approx(height, abs=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read(tmp_path / "fall.bvh", up="y")


def test_a_file_with_z_up_is_known_by_who_stands_in_it(tmp_path):
    frames = walk_frames(31)
    frames[:, 1], frames[:, 2], frames[:, 5] = 0.0, 90.0, 90.0
    (tmp_path / "z.bvh").write_text(bvh_text(frames))
    scene = ep.Scene()
    scene.add(ep.actors.captured_pedestrian(tmp_path / "z.bvh"), name="person")
    assert height_of(scene, 0.5) == pytest.approx(1.75, abs=0.1)


def height_of(scene, time: float) -> float:
    """From the lowest to the highest point of a scene, in m."""
    return float(np.ptp(np.concatenate([scene.world_vertices(mesh.id, time)[:, 2] for mesh in scene.meshes])))


def test_a_captured_pedestrian_is_an_actor_of_any_height(walk):
    low, high = (ep.actors.captured_pedestrian(walk, height=height, offset=0.5) for height in (1.5, 2.0))
    assert {part.name for part in low.parts} == {part.name for part in ep.actors.pedestrian().parts}
    head = [next(part for part in actor.parts if part.name == "head").motion.at(0.0)[2, 3] for actor in (low, high)]
    assert head[1] / head[0] == pytest.approx(2.0 / 1.5, rel=0.01)
    assert np.allclose(low.parts[0].motion.at(0.0)[:2, 3], 0.0, atol=1e-6)  # the pelvis at time 0


def test_a_first_pose_of_its_own_is_left_out(tmp_path):
    frames = walk_frames(20)
    frames[0, 6 + 18:] = 60.0  # arms and legs flung aside
    (tmp_path / "a.bvh").write_text(bvh_text(frames))
    model = ep.load_model(tmp_path / "a.bvh")
    assert any("first frame" in note for note in model.notes) and model.duration == pytest.approx(18 / 30)


@pytest.mark.parametrize("change, message", [
    (("HIERARCHY", "HIERARCHIE"), "must have 'HIERARCHY' where it has 'HIERARCHIE'"),
    (("OFFSET 0 -42 0", "OFFSET 0 nan 0"), "must have a number where it has 'nan'"),
    (("Frames: 31", "Frames: 4000000000"), "must have a whole number from 1 to"),
    (("Frames: 31", "Frames: 32"), "the file ends too early"),
    (("Frame Time: 0.0333333333", "Frame Time: 0"), "the frame time must be from 1e-6 to 100 s"),
    (("OFFSET 0 45 0", "OFFSET 0 4500 0"), "its neck is .* times as long as that of a body of such legs"),
    (("LeftForeArm", "Left"), "must be the capture of a person, but has no joint for left_elbow; its joints are Hips"),
    (("CHANNELS 3 Zrotation", "CHANNELS 3 Wrotation"), "must have a channel such as Xrotation where it has 'Wrotation'"),
])
def test_faults_are_told_by_name(walk, change, message):
    text = walk.read_text()
    assert change[0] in text
    walk.write_text(text.replace(*change))
    with pytest.raises(ep.FileError, match=f"walk.bvh: .*{message}"):
        ep.load_model(walk)
    with pytest.raises(ep.FileError):
        ep.actors.captured_pedestrian(walk)


def test_a_capture_that_is_carried_as_fast_as_light_is_refused(tmp_path):
    frames = walk_frames(8)
    frames[5:, 2] += 1e12  # cm, in a thirtieth of a second
    (tmp_path / "a.bvh").write_text(bvh_text(frames))
    with pytest.raises(ep.FileError, match=r"a.bvh: its pelvis moves by 3e\+11 m/s"):
        ep.load_model(tmp_path / "a.bvh")


# --- along a trajectory ---

def along(path, **settings) -> tuple:
    """(trajectory of 6 m straight ahead, {part: motion} of the captured person on it)"""
    trajectory = ep.Trajectory([(0, 0), (6, 0)], **{"speed": 1.3} | settings)
    person = ep.actors.captured_pedestrian(path, trajectory=trajectory)
    assert person.motion is trajectory
    return trajectory, {part.name: part.motion for part in person.parts}


def ahead_of(trajectory, motion, time: float) -> np.ndarray:
    """Where the origin of a part is in the world."""
    return trajectory.position(time) + motion.at(time)[:3, 3]


@pytest.fixture
def strides(tmp_path):
    """A second and a half of the walk: its cycle of one second closes within."""
    (tmp_path / "strides.bvh").write_text(bvh_text(walk_frames(46)))
    return tmp_path / "strides.bvh"


def test_a_captured_walk_goes_on_along_a_trajectory_as_it_was_captured(strides):
    """At the captured speed every joint goes as in the capture from some frame on, wherever the cycle begins."""
    trajectory, moved = along(strides)
    captured = {part.name: part.motion for part in ep.actors.captured_pedestrian(strides).parts}
    times = np.linspace(0.05, 0.45, 9)
    errors = []
    for begin in np.arange(16) / 30.0:
        apart = []
        for name in ("leg_left/foot", "leg_right/shank", "arm_left/hand", "head"):
            found = np.array([ahead_of(trajectory, moved[name], time) for time in times])
            expected = np.array([captured[name].at(time + begin)[:3, 3] for time in times])
            expected[:, 0] -= 1.3 * begin
            apart.append(np.abs(found - expected).max())
        errors.append(max(apart))
    assert min(errors) < 2e-3


def test_a_captured_walk_is_as_fast_as_its_way(strides):
    moved, moved_faster = along(strides)[1], along(strides, speed=2.6)[1]
    for time in (0.2, 0.9, 1.7):
        for name in ("leg_left/foot", "arm_right/forearm"):
            assert moved_faster[name].at(0.5 * time) == pytest.approx(moved[name].at(time), abs=1e-4)
            assert moved[name].at(time + 1.0) == pytest.approx(moved[name].at(time), abs=1e-4)  # a cycle takes a second
    stopping, moved = along(strides, stops=[(3.0, 0.8)])
    waits = float(stopping.time_at(3.0))
    foot = moved["leg_left/foot"]
    assert foot.at(waits + 0.1) == pytest.approx(foot.at(waits + 0.7), abs=1e-6)


def test_captures_that_do_not_go_along_are_told(tmp_path, strides):
    still = walk_frames(46)
    still[:, 2] = 0.0
    (tmp_path / "still.bvh").write_text(bvh_text(still))
    with pytest.raises(ep.FileError, match="still.bvh: goes less than 0.5 m"):
        along(tmp_path / "still.bvh")
    wild = walk_frames(46)
    wild[:, 6:] += 40.0 * np.random.default_rng(3).normal(size=wild[:, 6:].shape)
    (tmp_path / "wild.bvh").write_text(bvh_text(wild))
    with pytest.raises(ep.FileError, match="wild.bvh: has no cycle of steps"):
        along(tmp_path / "wild.bvh")
    with pytest.raises(ValueError, match="offset: must be left out beside trajectory"):
        ep.actors.captured_pedestrian(strides, offset=0.2, trajectory=ep.Trajectory([(0, 0), (6, 0)], speed=1.0))
