"""Truth of objects against closed forms: boxes of all vertices, motions, cross sections of spheres, axes of radars."""
import copy
import csv
import pickle
import warnings
from pathlib import Path
from time import process_time

import numpy as np
import pytest

import echopath as ep
from echopath.truth.boxes import boxes_at
from echopath.truth.cross_section import cross_section_dbsm, isotropic_power
from echopath.truth.places import true_places
from support.radars import build_radar

ROOT = Path(__file__).parents[3]
TOUCH = 1e-9         # m, of vertices and faces of a box: rounding
DIFFERENCES = 1e-9   # rad/s, of rates by differences over 0.1 ms: rounding
RATE_ERROR = 1e-6    # m/s, of differences over 0.1 ms
SPHERE_ERROR_DB = 0.1


def trace(scene, radar=None, start_time=0.0, num_rays=2000):
    return ep.trace(scene, radar or build_radar(num_chirps=16), num_rays=num_rays, start_time=start_time, polarization="scalar")


def box_scene(**placing):
    scene = ep.Scene()
    scene.add(ep.actors.box((4.0, 2.0, 1.5)), name="car", material="metal", **placing)
    return scene


def turned(axis, angle):
    """Rotation by `angle` about a unit vector (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


# --- boxes ---

@pytest.mark.parametrize("name, speed", [("car", 8.0), ("motorcycle", 7.0), ("cyclist", 4.5)])
def test_traffic_of_the_roundabout_stays_on_its_ring(name, speed):
    """A ring of 12 m about (18, 0), counter-clockwise: ways along it are its radius times the angle, noses look along it."""
    motion = ep.load_scene(ROOT / "data" / "scenes" / "roundabout.toml").scene[name].motion
    poses = [motion.at(time) for time in (0.0, 1.0, 2.5, 4.0)]
    places = np.array([pose[:2, 3] for pose in poses]) - [18.0, 0.0]
    assert np.hypot(*places.T) == pytest.approx(12.0, abs=0.01)
    angles = np.unwrap(np.arctan2(places[:, 1], places[:, 0]))
    assert 12.0 * (angles - angles[0]) == pytest.approx(speed * np.array([0.0, 1.0, 2.5, 4.0]), abs=0.02)
    for pose, place in zip(poses, places):
        assert abs(pose[:2, 0] @ place) / 12.0 < 0.015


@pytest.mark.parametrize("name", ["roundabout", "street"])
def test_boxes_hold_all_vertices_and_touch_them(name):
    file = ep.load_scene(ROOT / "data" / "scenes" / f"{name}.toml")
    paths = trace(file.scene, file.radar, start_time=0.05)
    found = ep.truth(paths)
    assert len(found) == len(ep.families(paths).objects) >= 1
    for row in range(len(found)):
        below = found.name[row] + "/"
        vertices = np.concatenate([paths.scene.world_vertices(mesh.id, paths.frame.trace_time) for mesh in paths.scene.meshes
                                   if mesh.name.startswith(below) or mesh.name == found.name[row]])
        axes = found.rotation[row]
        assert axes.T @ axes == pytest.approx(np.eye(3), abs=1e-12) and np.linalg.det(axes) > 0
        own = (vertices - found.position[row]) @ axes
        half = 0.5 * found.size[row]
        assert np.all(np.abs(own) <= half + TOUCH)
        assert np.abs(own.max(axis=0) - half).max() < TOUCH and np.abs(own.min(axis=0) + half).max() < TOUCH
        assert np.abs(found.corners[row].mean(axis=0) - found.position[row]).max() < TOUCH


def test_a_box_stands_as_its_object():
    found = ep.truth(trace(box_scene(position=(12, 3, 0), yaw=0.4)))
    assert found.size[0] == pytest.approx([4.0, 2.0, 1.5]) and found.yaw[0] == pytest.approx(0.4)
    assert found.origin[0] == pytest.approx([12, 3, 0])
    corner = found.position[0] + np.array([2 * np.cos(0.4) - np.sin(0.4), 2 * np.sin(0.4) + np.cos(0.4), 0.75])
    assert np.abs(found.corners[0] - corner).sum(axis=1).min() < 1e-9
    assert np.isnan(found.heading[0]) and np.all(found.velocity == 0.0)


def test_scale_of_a_placement_is_in_the_size():
    transform = np.eye(4)
    transform[:3, :3] = 2.0 * np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    transform[:3, 3] = 15, 0, 0
    found = ep.truth(trace(box_scene(transform=transform)))
    assert found.size[0] == pytest.approx([8.0, 4.0, 3.0]) and found.yaw[0] == pytest.approx(np.pi / 2)


@pytest.mark.parametrize("mirror", [(-1, 1, 1), (1, -1, 1), (1, 1, -1), (-2, -2, -2)])
def test_the_box_of_a_mirrored_body_turns_with_it(mirror):
    """A body that is mirrored by its placement turns as any other: its box keeps to its +x and +z and does not jump."""
    scene, turn = ep.Scene(), ep.LinearMotion(velocity=(1, 2, 0), angular_velocity=(0, 0, 3))
    scene.add(ep.actors.box((2.0, 1.0, 0.6)), name="box", material="metal", motion=turn,
              transform=np.diag([*mirror, 1.0]))
    times = np.linspace(0.0, 1.0, 23)
    boxes = [boxes_at(scene, [["box"]], time, 0.01) for time in times]
    signs = np.sign(mirror)
    expected = np.array([turned((0, 0, 1), 3.0 * time) for time in times]) * np.array([signs[0], signs[0] * signs[2], signs[2]])
    assert np.array([box.rotation[0] for box in boxes]) == pytest.approx(expected, abs=1e-12)
    assert np.array([box.angular_velocity[0] for box in boxes]) == pytest.approx(np.tile([0, 0, 3.0], (23, 1)), abs=DIFFERENCES)


@pytest.mark.parametrize("scale", [(0.5, -1.0, 1.0), (1.0, -1.0, 1.0), (1.0, -2.0, 0.5), (-0.5, 1.0, 2.0), (1.5, 1.0, -0.5)])
def test_a_mirrored_object_looks_where_its_nose_points(scale):
    """Axes of a box are a rotation: those of what is mirrored look ahead and up with it, whatever side is its shortest."""
    placed = np.eye(4)
    placed[:3, :3], placed[:3, 3] = turned((0, 0, 1), 0.3) * scale, (20, 1, 0)
    found = ep.truth(trace(box_scene(transform=placed)))
    ahead, _, up = turned((0, 0, 1), 0.3).T * np.sign(scale)[:, None]
    assert found.rotation[0].T == pytest.approx(np.array([ahead, np.cross(up, ahead), up]), abs=1e-12)
    assert found.yaw[0] == pytest.approx(np.arctan2(ahead[1], ahead[0]))
    assert found.size[0] == pytest.approx(np.abs(scale) * [4.0, 2.0, 1.5])


def test_objects_of_several_nodes_stand_in_the_axes_above_them():
    scene = ep.Scene()
    scene.add(name="group", position=(10, 0, 0), yaw=0.3)
    for name, side in (("left", 2.0), ("right", -2.0)):
        scene.add(ep.actors.box(1.0), name=name, material="metal", parent="group", position=(0, side, 0), yaw=0.5)
    scene.add(ep.actors.box(1.0), name="third", material="metal", position=(14, 5, 0))
    both = ep.truth(trace(scene), {"both": ["group/left", "group/right"], "all": ["*"]})
    assert both.name.tolist() == ["both", "all"]
    assert both.yaw == pytest.approx([0.3, 0.0])
    assert both.size[0, 1] == pytest.approx(4.0 + np.cos(0.5) + np.sin(0.5))


def test_a_trailer_that_turns_at_its_hitch_has_its_own_box():
    """As long and wide in a curve as in line; where it points, and how fast, by the rigid motion that fits its vertices best."""
    turn = ep.Trajectory([(50, 20), (20, 20), (20, 60)], turn_radius=8, speed=6, goes_on=2)
    scene = ep.Scene()
    scene.add(ep.actors.truck(trajectory=turn), name="truck")

    def vertices(time):
        return np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes if "/trailer/" in mesh.name])

    def direction(time):  # of a yaw, of Procrustes in the plane: argument of the sum of products of complex numbers
        before, after = ((points - points.mean(axis=0)) @ [1.0, 1j, 0.0] for points in (vertices(0.0), vertices(time)))
        return np.pi + np.angle(np.sum(np.conj(before) * after))

    in_line = np.ptp(vertices(0.0), axis=0)
    found = ep.truth(trace(scene, start_time=5.0, num_rays=200), ["truck/trailer"])
    time, step = found.time[0], 1e-3
    assert found.size[0] == pytest.approx(in_line, abs=1e-6)
    assert np.cos(found.yaw[0] - direction(time)) == pytest.approx(1.0, abs=1e-9)
    rate = np.angle(np.exp(1j * (direction(time + step) - direction(time - step)))) / (2.0 * step)
    assert found.angular_velocity[0] == pytest.approx([0.0, 0.0, rate], abs=1e-4)
    velocity = (vertices(time + step) - vertices(time - step)) / (2.0 * step)
    arm = found.position[0] - vertices(time).mean(axis=0)
    assert found.velocity[0] == pytest.approx(velocity.mean(axis=0) + rate * np.array([-arm[1], arm[0], 0.0]), abs=1e-3)


def test_names_are_those_of_whole_objects_and_the_scene_is_listed_once(monkeypatch):
    from echopath.truth import boxes

    scene, listed = ep.Scene(), []
    for place, name in enumerate(("car", "car_2", "cart")):
        scene.add(name=name, position=(10.0 + 5.0 * place, 0, 0))
        for part, side in (("body", 1.0), ("wheel", -1.0)):
            scene.add(ep.actors.box(1.0 + place), name=part, material="metal", parent=name, position=(0, side * (2.0 + place), 0))
    alike = {"name": ["car"], "glob": ["ca?"], "both": ["car/body", "car/wheel"], "part": ["car_2/wheel"], "none": ["cart"]}
    named = boxes._NamedScene
    monkeypatch.setattr(boxes, "_NamedScene", lambda scene: listed.append(scene) or named(scene))
    found = boxes.boxes_at(scene, list(alike.values()), 0.0, 1e-3)
    assert found.size == pytest.approx(np.array([[1, 5, 1], [1, 5, 1], [1, 5, 1], [2, 2, 2], [3, 11, 3]]))
    assert found.centre == pytest.approx(np.array([[10, 0, 0], [10, 0, 0], [10, 0, 0], [15, -3, 0], [20, 0, 0]]))
    assert len(listed) == 1


# --- motions ---

def test_velocity_of_what_goes_straight():
    velocity = np.array([-7.0, 2.0, 0.5])
    found = ep.truth(trace(box_scene(position=(20, 1, 0), yaw=0.2, motion=ep.LinearMotion(velocity=velocity)), start_time=0.3))
    assert found.velocity[0] == pytest.approx(velocity, abs=RATE_ERROR)
    assert found.origin[0] == pytest.approx(np.array([20, 1, 0]) + velocity * found.time[0])
    assert found.heading[0] == pytest.approx(np.arctan2(2.0, -7.0))
    assert np.abs(found.angular_velocity).max() < 1e-6


def test_what_rises_has_a_direction_and_no_heading():
    found = ep.truth(trace(box_scene(position=(20, 1, 0), motion=ep.LinearMotion(velocity=(0.0, 0.0, 3.0)))))
    assert np.isnan(found.heading[0]) and found.direction_in_radar[0] == pytest.approx([0.0, 0.0, 1.0], abs=RATE_ERROR)


@pytest.mark.parametrize("name", ["axis", "axis/gondola"])
def test_velocity_of_what_goes_round(name):
    """A box 3 m from an axis that turns: v = omega x r, of the box's centre, wherever the object's own origin is."""
    spin, radius, scene = 6.0, 3.0, ep.Scene()
    scene.add(name="axis", position=(12, 0, 0), motion=ep.LinearMotion(angular_velocity=(0, 0, spin)))
    scene.add(ep.actors.box(1.0), name="gondola", material="metal", parent="axis", position=(radius, 0, 0))
    found = ep.truth(trace(scene, start_time=0.2), [name])
    angle = spin * found.time[0]
    assert found.position[0, :2] == pytest.approx([12 + radius * np.cos(angle), radius * np.sin(angle)])
    assert found.velocity[0] == pytest.approx(spin * radius * np.array([-np.sin(angle), np.cos(angle), 0]), abs=RATE_ERROR)
    assert found.angular_velocity[0] == pytest.approx([0, 0, spin], abs=1e-6)
    assert found.size[0] == pytest.approx([1, 1, 1])


def test_velocity_of_what_turns_below_a_body_that_is_scaled_along_one_axis():
    """A box that goes round, whose way is an ellipse and which grows and shrinks along the scaled axis."""
    scene, spin, scale = ep.Scene(), 5.0, np.diag([2.0, 1.0, 1.0])
    stretched = np.eye(4)
    stretched[:3, :3], stretched[:3, 3] = scale, (12, 0, 0)
    scene.add(name="wide", transform=stretched)
    scene.add(name="arm", parent="wide", motion=ep.LinearMotion(angular_velocity=(0, 0, spin)))
    scene.add(ep.actors.box(1.0), name="hand", parent="wide/arm", position=(2.0, 1.0, 0.0), material="metal")
    found = ep.truth(trace(scene, start_time=0.2), ["wide/arm"])
    c, s = np.cos(spin * found.time[0]), np.sin(spin * found.time[0])
    middle, rate = np.array([2 * c - s, 2 * s + c, 0.0]), spin * np.array([-2 * s - c, 2 * c - s, 0.0])
    assert found.position[0] == pytest.approx([12, 0, 0] + scale @ middle)
    assert found.velocity[0] == pytest.approx(scale @ rate, abs=RATE_ERROR)


def test_velocity_of_a_body_that_deforms():
    """A tetrahedron that goes along y while it grows about its centroid: the centroid has the speed, whatever the box does."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    mesh = ep.Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    faces = corners[mesh.triangles]
    areas = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1)
    centroid = areas @ faces.mean(axis=1) / areas.sum()
    times = np.linspace(0.0, 1.0, 51)
    frames = np.array([centroid + (1 + 0.5 * t) * (corners - centroid) + np.array([0, 3.0 * t, 0]) for t in times])
    scene = ep.Scene()
    scene.add(mesh, name="cloth", material="metal", position=(8, 0, 0), yaw=np.pi / 2,
              motion=ep.VertexSequence(times=times, vertices=frames))
    found = ep.truth(trace(scene, start_time=0.5))
    assert found.velocity[0] == pytest.approx([-3.0, 0.0, 0.0], abs=RATE_ERROR)  # its own y is the world's -x
    assert found.size[0] == pytest.approx(np.full(3, 1 + 0.5 * found.time[0]))


@pytest.mark.parametrize("yaw", [0.0, 2.5])
def test_the_origin_goes_with_a_body_that_drives_by_itself(yaw):
    """As that of one that follows a trajectory, and as the box does: v t along where it points."""
    for time in (0.0, 0.45):
        scene, ahead = ep.Scene(), np.array([np.cos(yaw), np.sin(yaw), 0])
        scene.add(ep.actors.car(speed=10), name="car", position=(25, 0, 0), yaw=yaw)
        scene.add(ep.actors.bicycle(speed=5), name="bicycle", position=(15, 8, 0), yaw=yaw)
        found = ep.truth(trace(scene, start_time=time, num_rays=200))
        for name, speed, start in (("car", 10, [25, 0, 0]), ("bicycle", 5, [15, 8, 0])):
            one = found.of_object(name)
            assert one.origin[0] == pytest.approx(start + speed * one.time[0] * ahead, abs=1e-3)  # m: spokes of wheels


def test_the_origin_of_a_wheel_is_its_hub():
    """It stays as high as the wheel's radius and goes with the car, while tyre and rim turn about it."""
    way = ep.Trajectory([(8.0, -4.0), (8.0, 20.0)], speed=6.0)
    scene = ep.Scene()
    scene.add(ep.actors.car(trajectory=way), name="car")
    one, other = (ep.truth(trace(scene, start_time=start, num_rays=50), objects={"wheel": "car/wheel/front_left"})
                  for start in (0.2, 0.9))
    assert one.origin[0] == pytest.approx(one.position[0], abs=0.02)  # the middle of the wheel's box
    gone = 6.0 * (other.time[0] - one.time[0])
    assert other.origin[0] - one.origin[0] == pytest.approx([0.0, gone, 0.0], abs=1e-4)


def test_the_origin_of_what_follows_a_trajectory_is_on_it():
    """Also while a trailer swings out behind its truck, and while legs swing."""
    turn = ep.Trajectory([(10, -20), (40, -20), (40, 20)], turn_radius=12, speed=6)
    walk = ep.Trajectory([(8, 3), (12, 3), (12, 7)], turn_radius=1, speed=1.4)
    scene = ep.Scene()
    scene.add(ep.actors.truck(trajectory=turn), name="truck")
    scene.add(ep.actors.pedestrian(trajectory=walk), name="walker")
    found = ep.truth(trace(scene, start_time=5.0, num_rays=200))
    for name, way in (("truck", turn), ("walker", walk)):
        one = found.of_object(name)
        assert one.origin[0] == pytest.approx(way.position(one.time[0]), abs=1e-4)


def test_what_moves_from_a_later_time_on_has_a_truth():
    scene = box_scene(position=(8, 0, 0))
    scene.add(ep.actors.plate(0.5, 0.5), name="door", parent="car", material="metal", position=(0.0, 1.0, 0.0),
              motion=ep.KeyframeMotion(times=[1.0, 3.0], translations=[(0, 0, 0), (2, 0, 0)]))
    found = ep.truth(trace(scene, start_time=2.0))
    assert found.name.tolist() == ["car"] and np.all(np.isfinite(found.origin))
    half_way = 1.0 + 0.5 * build_radar(num_chirps=16).frame_duration  # s since the door began to move, at 1 m/s
    moved = 0.25 / (0.25 + 2 * (4 * 2 + 4 * 1.5 + 2 * 1.5)) * half_way  # of the centroid, by the door's share of the area
    assert found.origin[0] == pytest.approx((8.0 + moved, 0.0, 0.0), abs=1e-9)


def test_what_grows_out_of_a_point_has_a_truth(tmp_path):
    """A plate that grows by 1 m a second about its middle, which goes aside at 1 m/s: its origin goes with the middle."""
    mesh, times = ep.actors.plate(1.0, 1.0), [0.0, 1.0, 2.0]
    frames = [time * (mesh.vertices + [0.0, 1.0, 0.0]) for time in times]
    scene = ep.Scene()
    scene.add(mesh, name="cloud", material="metal", position=(9, 0, 0),
              motion=ep.VertexSequence(times=times, vertices=frames, interpolation="linear"))
    for start in (0.0, 0.5):
        frame = ep.simulate(scene, build_radar(num_chirps=16), num_rays=200, start_time=start, guard=False, truth=True)
        frame.save(tmp_path / "frame.h5")
        found = ep.load_frame(tmp_path / "frame.h5").truth
        assert found.origin[0] == pytest.approx((9.0, found.time[0], 0.0))
        assert found.velocity[0] == pytest.approx((0.0, 1.0, 0.0), abs=RATE_ERROR)


def test_a_walking_person_goes_at_their_speed_in_the_mean():
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(speed=1.4, duration=3.0), name="walker", position=(8, 0, 0), yaw=np.pi)
    radar = build_radar(num_chirps=8)
    found = ep.truth([trace(scene, radar, start_time=start, num_rays=200) for start in np.arange(0.5, 1.5, 0.125)])
    assert len(found) == 8 and found.frame.tolist() == list(range(8))
    assert found.velocity[:, 0].mean() == pytest.approx(-1.4, abs=0.1)
    assert len(found.of_object("walker")) == 8 and len(found.of_frame(3)) == 1
    with pytest.raises(KeyError, match="must be one of walker, got 'runner'"):
        found.of_object("runner")
    with pytest.raises(TypeError, match="^name: must be text"):
        found.of_object(["walker", "walker"])


def test_a_loop_over_the_frames_of_a_long_truth_takes_a_few_times_what_their_numbers_take_to_compare():
    records = np.repeat(ep.truth(trace(box_scene(position=(10.0, 0.0, 0.0)))).to_records(), 100_000)
    records["frame"] = np.arange(100_000) // 50
    long = ep.Truth.from_records(records)
    begin = process_time()
    compared = [np.count_nonzero(long.frame == number) for number in range(100)]
    middle = process_time()
    found = [len(long.of_frame(number)) for number in range(100)]
    assert found == compared == [50] * 100
    assert process_time() - middle < 25.0 * max(middle - begin, 1e-3)


# --- what the radar sees ---

@pytest.mark.parametrize("radius", [0.1, 0.4])
def test_cross_section_of_a_sphere(radius):
    """pi a^2, whatever the distance, the antennas' gains and where they look."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius), name="ball", material=ep.Material.metal(), position=(9, 2, 0), smooth=True)
    antenna = ep.Antenna(pattern=ep.CosinePower(4.0), yaw=-0.2)
    radar = build_radar((antenna,), (antenna,), num_chirps=4, position=(1, -1, 0), yaw=0.3, transmit_power=0.5)
    found = ep.truth(trace(scene, radar, num_rays=20000))
    # Geometrical optics: P ~ (a / (2 (R - a) R))^2, where the radar equation for the centre has (a / (2 R^2))^2.
    near = 20 * np.log10((found.range[0] - radius) / found.range[0])
    assert found.rcs_dbsm[0] + near == pytest.approx(10 * np.log10(np.pi * radius**2), abs=SPHERE_ERROR_DB)
    assert found.rcs_low[0] <= found.rcs[0] <= found.rcs_high[0] and found.visible_share[0] == 1.0


def test_ghosts_are_no_part_of_a_cross_section():
    """A ball beside a mirror: what comes by way of the mirror is left out of its power."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material="metal", position=(8, 0, 0), smooth=True)
    scene.add(ep.actors.plate(40.0, 20.0), name="wall", material=ep.Material.metal(mirror=True), position=(8, -1.5, 0),
              yaw=np.pi / 2)
    paths = trace(scene, num_rays=20000)
    found = ep.truth(paths, ["ball"])
    alone = ep.received_power(paths.select("T 'ball'+ R"))
    assert found.received[0] / alone.power == pytest.approx(1.0) and 0 < alone.low < alone.power < alone.high
    assert found.rcs_low[0] / found.rcs[0] == pytest.approx(alone.low / alone.power)
    assert found.rcs_high[0] / found.rcs[0] == pytest.approx(alone.high / alone.power)
    assert abs(ep.received_power(paths.select(ep.hits("ball"))).power / alone.power - 1.0) > 0.1


def test_what_no_antenna_sees_has_no_cross_section():
    scene = box_scene(position=(-8, 0, 0))
    found = ep.truth(trace(scene, build_radar((ep.Antenna(pattern=ep.CosinePower(2.0)),), num_chirps=4)))
    assert np.isnan(found.rcs[0]) and found.received[0] == 0.0


def test_a_plate_in_front_of_half_of_another_leaves_half_of_it():
    scene = ep.Scene()
    for name, x, y, width in (("far", 10.0, 0.0, 2.0), ("near", 5.0, 1.0, 2.0)):
        scene.add(ep.actors.plate(width, 4.0), name=name, material="metal", position=(x, y, 0))
    found = ep.truth(trace(scene))
    assert dict(zip(found.name, found.visible_share)) == {"far": pytest.approx(0.5, abs=0.01), "near": 1.0}


# --- axes of the radar ---

def test_axes_of_a_radar_that_drives_and_turns():
    """Rates of coordinates against differences of them, worked out by hand from the radar's place and turn."""
    spin, ahead = 0.8, np.array([9.0, 0.0, 0.0])
    radar = build_radar(num_chirps=64, position=(1, 2, 0.5), yaw=0.2,
                        motion=ep.LinearMotion(velocity=ahead, angular_velocity=(0, 0, spin)))
    velocity = np.array([-5.0, 1.0, 0.0])
    scene = box_scene(position=(25, 4, 0), motion=ep.LinearMotion(velocity=velocity))
    found = ep.truth(trace(scene, radar))

    def own(time):
        angle = 0.2 + spin * time
        turn = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        at = found.position[0] + velocity * (time - found.time[0])
        return turn @ (at - np.array([1, 2, 0.5]) - ahead * time)

    now, step = found.time[0], 1e-5
    rate = (own(now + step) - own(now - step)) / (2 * step)
    assert found.position_in_radar[0] == pytest.approx(own(now))
    assert found.velocity_in_radar[0] == pytest.approx(rate, abs=1e-6)
    assert found.radial_velocity[0] == pytest.approx(own(now) @ rate / np.linalg.norm(own(now)), abs=1e-6)
    assert found.azimuth[0] == pytest.approx(np.arctan2(own(now)[1], own(now)[0]))
    assert found.yaw_in_radar[0] == pytest.approx(-0.2 - spin * now)


def test_boxes_in_the_axes_of_a_radar_that_pitches_and_rolls():
    """Vertices of a tilted box that drives, taken into the radar's axes one by one, against its corners there."""
    place, spin, ahead = np.array([1.0, 2.0, 1.5]), np.array([1.2, -0.7, 0.4]), np.array([9.0, 0.0, 0.2])
    radar = build_radar(num_chirps=64, position=place, yaw=0.2, pitch=-0.15,
                        motion=ep.LinearMotion(velocity=ahead, angular_velocity=spin))
    tilt, velocity = turned((0, 0, 1), 0.6) @ turned((0.6, 0.8, 0.0), 0.3), np.array([-5.0, 1.0, 0.5])
    transform = np.eye(4)
    transform[:3, :3], transform[:3, 3] = tilt, (20, 3, 0.5)
    paths = trace(box_scene(transform=transform, motion=ep.LinearMotion(velocity=velocity)), radar, start_time=0.3)
    found, now = ep.truth(paths), paths.frame.trace_time
    rate = np.linalg.norm(spin)
    axes = turned(spin / rate, rate * now) @ turned((0, 0, 1), 0.2) @ turned((0, 1, 0), 0.15)  # up is a turn about -y
    seen = (paths.scene.world_vertices(0, now) - place - ahead * now) @ axes
    apart = np.linalg.norm(found.corners_in_radar[0][:, None] - seen, axis=2)
    assert apart.min(axis=0).max() < TOUCH and apart.min(axis=1).max() < TOUCH
    assert found.rotation_in_radar[0] == pytest.approx(axes.T @ tilt, abs=1e-12)
    assert found.direction_in_radar[0] == pytest.approx(axes.T @ velocity / np.linalg.norm(velocity), abs=1e-6)
    w, x, y, z = found.quaternions_in_radar[0]
    assert w >= 0 and turned(np.array([x, y, z]) / np.sin(np.arccos(w)), 2 * np.arccos(w)) == pytest.approx(axes.T @ tilt)
    assert np.isnan(ep.truth(trace(box_scene(position=(12, 3, 0)), radar)).direction_in_radar).all()


def test_quaternions_of_objects_that_look_backward_have_no_negative_w():
    scene = ep.Scene()
    for name, yaw in (("left", 3.0), ("right", -3.0)):
        scene.add(ep.actors.box((4.0, 2.0, 1.5)), name=name, material="metal", position=(20, yaw, 0), yaw=yaw)
    found = ep.truth(trace(scene)).quaternions_in_radar
    assert found == pytest.approx(np.array([[np.cos(half), 0, 0, np.sin(half)] for half in (1.5, -1.5)]))


def test_ranges_and_directions_count_from_between_the_antennas():
    """Of a box high above to the left, by the place between antennas that stand apart on a radar that drives and turns."""
    antennas, middle = (ep.Antenna((0.9, -0.2, 0.4)), ep.Antenna((0.1, 0.8, -0.2))), np.array([0.5, 0.3, 0.1])
    place, spin, ahead, velocity = np.array([1.0, 2.0, 1.5]), 0.8, np.array([9.0, 0.0, 0.2]), np.array([-5.0, 1.0, 0.5])
    radar = build_radar(antennas[:1], antennas[1:], num_chirps=64, position=place, yaw=0.2,
                        motion=ep.LinearMotion(velocity=ahead, angular_velocity=(0, 0, spin)))
    scene = box_scene(position=(12, 9, 8), motion=ep.LinearMotion(velocity=velocity))
    found = ep.truth(trace(scene, radar))
    now, step = found.time[0], 1e-5

    def sight(time):
        axes = turned((0, 0, 1), 0.2 + spin * time)
        at = found.position[0] + velocity * (time - now)
        return (at - place - ahead * time) @ axes - middle

    x, y, z = sight(now)
    distance = np.linalg.norm(sight(now))
    assert found.range[0] == pytest.approx(distance) and found.azimuth[0] == pytest.approx(np.arctan2(y, x))
    assert found.elevation[0] == pytest.approx(np.arcsin(z / distance))
    assert true_places(scene, radar, ["car"], now) == {"car": pytest.approx((distance, np.arctan2(y, x)))}
    rate = (np.linalg.norm(sight(now + step)) - np.linalg.norm(sight(now - step))) / (2 * step)
    assert found.radial_velocity[0] == pytest.approx(rate, abs=1e-6)


# --- as tables and rows ---

@pytest.fixture(scope="module")
def frame():
    return ep.simulate(box_scene(position=(12, 3, 0), yaw=0.4), build_radar(num_chirps=16), num_rays=500, guard=False)


def test_rows_travel(frame, tmp_path):
    import h5py

    found = frame.truth
    assert found == ep.truth(frame) == pickle.loads(pickle.dumps(found)) == copy.deepcopy(found)
    with h5py.File(tmp_path / "truth.h5", "w") as file:
        file["truth"] = found.to_records()
        assert ep.Truth.from_records(file["truth"][()]) == found
    np.save(tmp_path / "truth.npy", found.to_records())
    assert ep.Truth.from_records(np.load(tmp_path / "truth.npy")) == found
    empty = found.of_frame(5)
    assert len(empty) == 0 and ep.Truth.from_records(empty.to_records()) == empty and len(empty.corners) == 0
    with pytest.raises(ValueError, match="records: must be a structured array as Truth.to_records"):
        ep.Truth.from_records(np.zeros(3))
    assert "1 row, 1 frame, 1 object: car" in repr(found)


def test_what_a_loop_kept_of_its_frames_is_the_truth_of_all():
    scene = ep.Scene()
    scene.add(ep.actors.box((4, 2, 1.5)), name="car", material="metal", position=(10, 0, 0), speed=8.0)
    starts = [0.0, 0.1, 0.3]
    traced = [trace(scene, start_time=start) for start in starts]
    kept = ep.truth([ep.truth(one) for one in traced])
    assert kept.frame.tolist() == [0, 1, 2]
    assert kept.position[:, 0] == pytest.approx(10.0 + 8.0 * kept.time)
    assert kept.time - kept.time[0] == pytest.approx(starts)
    points = [position[None] for position in kept.position]
    assert set(ep.track(points, kept.time, truth=kept, truth_distance=5.0).object) == {"car"}
    at_one_time = ep.truth([traced[0], traced[0]])
    for several in (kept, at_one_time):
        with pytest.raises(ValueError, match="frame: must be the Truth of one frame, got Truth"):
            ep.truth([several, several])
    with pytest.raises(ValueError, match="frame: must be a Frame for objects of a call, which need its paths, got Truth"):
        ep.truth([ep.truth(traced[0])], {"all": "*"})


def test_tables_have_names_and_units(frame, tmp_path):
    pytest.importorskip("pandas")
    table = frame.truth.to_dataframe()
    assert table.loc[0, "name"] == "car" and table.loc[0, "length"] == pytest.approx(4.0)
    assert table.attrs["units"]["rcs"] == "m^2" and table.attrs["units"]["vx"] == "m/s"
    frame.truth.to_csv(tmp_path / "truth.csv")
    rows = list(csv.DictReader((tmp_path / "truth.csv").open(encoding="utf-8")))
    assert len(rows[0]) == len(table.columns) and {"frame", "time_s", "vx_m_per_s", "rcs_m2", "received_w"} < set(rows[0])
    assert float(rows[0]["yaw_rad"]) == frame.truth.yaw[0] and rows[0]["heading_rad"] == ""


def test_a_scene_without_objects_has_no_rows():
    scene = ep.Scene()
    scene.add(ep.actors.ground(50.0), name="ground", material=ep.materials["concrete"].replace(mirror=True), position=(0, 0, -1))
    assert len(ep.truth(trace(scene))) == 0
    with pytest.raises(TypeError, match="frame: must be a Frame, Paths, the Truth of a frame, or some of these, got 3"):
        ep.truth(3)


def test_records_that_are_no_array_are_refused_by_name():
    with pytest.raises(ValueError, match="records: must be a structured array as Truth.to_records makes it"):
        ep.Truth.from_records(np)


def test_a_square_metre_between_two_antennas_sends_what_the_radar_equation_says():
    """Pt Gt Gr lambda^2 / ((4 pi)^3 Rt^2 Rr^2) of antennas 5 m apart, 2 (n + 1) cos^n of the angle from where each looks."""
    sent = ep.Antenna((0.0, 4.0, 0.0), yaw=-0.3, pattern=ep.CosinePower(4.0))
    heard = ep.Antenna((1.0, -1.0, 0.5), yaw=0.4, pattern=ep.CosinePower(2.0, peak_gain=3.0))
    radar = build_radar((sent,), (heard,), num_chirps=4, position=(2, -3, 1), yaw=0.5, transmit_power=0.7)
    point = np.array([14.0, 5.0, 2.0])
    expected = 0.7 * (ep.speed_of_light / radar.waveform.start_frequency) ** 2 / (4 * np.pi) ** 3
    for antenna, yaw, exponent, peak in ((sent, -0.3, 4, 10.0), (heard, 0.4, 2, 3.0)):
        way = point - [2, -3, 1] - turned((0, 0, 1), 0.5) @ antenna.position
        cosine = way @ [np.cos(0.5 + yaw), np.sin(0.5 + yaw), 0.0] / np.linalg.norm(way)
        expected *= peak * cosine**exponent / (way @ way)
    assert isotropic_power(radar, point[None], 0.0)[0] == pytest.approx(expected)


def test_what_is_right_beside_a_radar_that_looks_ahead_has_no_cross_section():
    """Rounding left of its gain, which is 0 at 90 degrees, some 1e-33, by which a lorry had 1e63 m^2."""
    antenna = ep.Antenna((0.0, 0.0, 0.0), pattern=ep.CosinePower(2.0))
    for yaw in np.linspace(-np.pi, np.pi, 40):
        radar = build_radar((antenna,), (antenna,), num_chirps=4, position=(20.0, -30.0, 1.0), yaw=yaw)
        place = np.array([20.0, -30.0, 2.5]) + turned((0, 0, 1), yaw) @ [0.0, 8.0, 0.0]
        assert isotropic_power(radar, place[None], 0.0)[0] == 0.0
        assert np.isnan(cross_section_dbsm(np.array([1e-14]), radar, place[None], 0.0)[0])


def test_cross_sections_of_nulls_are_told_without_a_warning():
    """An echo of no power has none, and where the antennas hear nothing nobody knows it."""
    pattern = ep.CosinePower(2.0)
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)], num_samples=16, num_chirps=4)
    ahead = radar.replace(transmitters=[ep.Antenna(pattern=pattern)], receivers=[ep.Antenna(pattern=pattern)])
    places = np.array([(10.0, 0.0, 0.0), (10.0, 0.0, 0.0), (-10.0, 0.0, 0.0)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = cross_section_dbsm(np.array([isotropic_power(ahead, places[:1], 0.0)[0], 0.0, 1e-12]), ahead, places, 0.0)
    assert found[0] == pytest.approx(0.0, abs=1e-9) and found[1] == -np.inf and np.isnan(found[2])
