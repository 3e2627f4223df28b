"""In whose axes velocities and speeds of objects and radars are."""
from __future__ import annotations

import math

import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar
from support.scenes.one_target import RADAR_FILE, scene_with
from support.street import NUM_RAYS, box_mesh

ROUNDING = 1e-12         # of lengths of some metres and of rates of some m/s
OFF_SIGHT = 1e-3         # relative: a range changes by less than the speed where the object is off the line of sight
SPEED = 15.0             # m/s
SWAY = 0.3               # m/s: the torso of a walker speeds up and slows down within a step


def range_rate(scene, name, radar=None, duration=1e-3):
    """m/s, receding positive, of the shortest direct echo of an object, from the replayed lengths of its paths."""
    radar = radar or build_radar()
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=1).select(f"T '{name}' R")
    lengths = paths.lengths([0.0, duration], radar.transmitters[0].position, radar.receivers[0].position)
    nearest = np.argmin(lengths[0])
    return float(lengths[1, nearest] - lengths[0, nearest]) / (2.0 * duration)


def test_a_velocity_is_in_the_axes_of_the_parent_whatever_the_yaw():
    """The bumper of a car that looks at the radar: with velocity (15, 0, 0) it drives backwards, away from it."""
    car = {"content": box_mesh(4, 2, 1.5), "position": (30, 0, 0), "yaw": math.pi, "material": "metal"}
    assert range_rate(scene_with(**car, motion=ep.LinearMotion(velocity=(SPEED, 0, 0))), "target") == pytest.approx(
        SPEED, abs=OFF_SIGHT * SPEED)
    assert range_rate(scene_with(**car, speed=SPEED), "target") == pytest.approx(-SPEED, abs=OFF_SIGHT * SPEED)
    car["yaw"] = 0.0
    assert range_rate(scene_with(**car, speed=SPEED), "target") == pytest.approx(SPEED, abs=OFF_SIGHT * SPEED)


def test_a_pedestrian_walks_where_its_yaw_points():
    for yaw, sign in ((math.pi, -1.0), (0.0, 1.0)):
        scene = scene_with(ep.actors.pedestrian(speed=1.4), position=(10, 0, -1), yaw=yaw)
        torso = next(name for name in scene if "torso" in name)
        rates = [np.diff([scene.world_vertices(scene[torso].meshes[0].id, time).mean(axis=0)[0] for time in (0.0, 1.0)])[0]]
        assert rates[0] == pytest.approx(sign * 1.4, abs=SWAY)
        assert sign * range_rate(scene, torso) > 0.0


def test_what_a_turned_object_carries_has_its_axes():
    scene = ep.Scene()
    scene.add(None, name="lane", position=(30, 0, 0), yaw=math.pi)
    scene.add(box_mesh(4, 2, 1.5), name="car", parent="lane", material="metal",
              motion=ep.LinearMotion(velocity=(SPEED, 0, 0)))
    assert range_rate(scene, "lane/car") == pytest.approx(-SPEED, abs=OFF_SIGHT * SPEED)


def test_the_velocity_of_a_radar_is_in_the_axes_of_the_world():
    drives = build_radar(motion=ep.LinearMotion(velocity=(10, 0, 0)))
    scene = scene_with(box_mesh(1, 2, 2), position=(20, 0, 0), yaw=math.pi, material="metal")
    assert range_rate(scene, "target", drives) == pytest.approx(-10.0, abs=OFF_SIGHT * 10)


def test_speed_goes_along_the_x_axis_of_a_transform():
    climbs = np.array([[0.6, 0, -0.8, 5], [0, 1, 0, 0], [0.8, 0, 0.6, 0], [0, 0, 0, 1]])
    climbs[:3, :3] *= 2.0  # a scale is no part of the speed
    scene = scene_with(box_mesh(1, 1, 1), transform=climbs, speed=5.0, material="metal")
    assert scene["target"].motion.velocity == pytest.approx([3, 0, 4], abs=ROUNDING)


@pytest.mark.parametrize("keys, rate", [
    ("yaw_deg = 180.0\nspeed = 15.0", -SPEED), ("speed = 15.0", SPEED), ("yaw_deg = 180.0\nspeed = 15", -SPEED),
    ("yaw_deg = 180.0\nmotion = {kind = \"linear\", velocity = [15.0, 0.0, 0.0]}", SPEED),
])
def test_scene_files_mean_the_same(tmp_path, keys, rate):
    path = tmp_path / "scene.toml"
    path.write_text(RADAR_FILE + f"""[[objects]]
name = "car"
actor = "box"
parameters = {{size = [4.0, 2.0, 1.5]}}
material = "metal"
position = [30.0, 0.0, 0.0]
{keys}
""")
    assert range_rate(ep.load_scene(path).scene, "car") == pytest.approx(rate, abs=OFF_SIGHT * SPEED)


def test_scene_files_hide_objects_and_refuse_speed_beside_motion(tmp_path):
    path = tmp_path / "scene.toml"
    box = RADAR_FILE + '[[objects]]\nname = "car"\nactor = "box"\nparameters = {size = [4, 2, 1]}\nmaterial = "metal"\n'
    path.write_text(box + "visible = false\n")
    scene = ep.load_scene(path).scene
    assert not scene.meshes and not scene["car"].visible
    scene["car"].visible = True
    assert len(scene.meshes) == 1
    path.write_text(box + 'speed = 3.0\nmotion = {kind = "linear", velocity = [1.0, 0.0, 0.0]}\n')
    with pytest.raises(ValueError, match=r"objects\[0\]\.speed: must not stand beside motion, got 3.0"):
        ep.load_scene(path)
