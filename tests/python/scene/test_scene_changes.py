"""Scenes that change: a street of twenty objects after each change is, to the last bit, the street built so from the start."""
from __future__ import annotations

import gc
import itertools
import math
import threading
from unittest import mock

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.tracing import tessellation
from support.radars import build_radar
from support.scene_text import WAVEFORM
from support.street import ARRAYS, NUM_RAYS, assert_same_bits, box_mesh, built, radar, street_table, traced

ROUNDING = 1e-12         # of lengths of some metres and of rates of some m/s
OFF_SIGHT = 1e-3         # relative: a range changes by less than the speed where the object is off the line of sight
SPEED = 15.0             # m/s
SWAY = 0.3               # m/s: the torso of a walker speeds up and slows down within a step
RADAR_FILE = WAVEFORM + """\
[[radar.transmitters]]
position = [0.0, 0.0, 0.0]
[[radar.receivers]]
position = [0.0, 0.0, 0.0]
"""


def record_bytes(paths) -> bytes:
    return b"".join(np.ascontiguousarray(getattr(paths, name)).tobytes() for name in ARRAYS)


@pytest.fixture
def table():
    return street_table()


# Each changes the scene, and the table as it would have been written from the start.
def set_position(scene, table):
    scene["box5"].position = table["box5"]["position"] = (21.0, 2.0, 0.25)


def set_yaw(scene, table):
    scene["box3"].yaw = table["box3"]["yaw"] = -1.25


def set_transform(scene, table):
    place = np.array([[1.0, 0, 0, 19], [0, 0, -1, 1], [0, 1, 0, 0.5], [0, 0, 0, 1]])
    scene["box2"].transform = place
    del table["box2"]["position"], table["box2"]["yaw"]
    table["box2"]["transform"] = place


def set_motion(scene, table):
    scene["box1"].motion = table["box1"]["motion"] = ep.LinearMotion(velocity=(3, -1, 0))


def stop_motion(scene, table):
    scene["box4"].motion = table["box4"]["motion"] = None


def stop_everything(scene, table):
    for name in ("bus", "box0", "box4", "box8", "box12"):
        scene[name].motion = table[name]["motion"] = None


def set_material(scene, table):
    scene["box6"].material = table["box6"]["material"] = ep.Material(permittivity=4 - 0.5j)


def set_material_of_group(scene, table):
    scene["bus"].material = table["bus"]["material"] = "wood"


def hide(scene, table):
    scene["bus"].visible = table["bus"]["visible"] = False


def hide_one_and_show_it(scene, table):
    scene["box7"].visible = False
    traced(scene)
    scene["box7"].visible = True


def hide_one_and_show_another(scene, table):
    scene["box7"].visible = table["box7"]["visible"] = False
    scene["box8"].visible = False
    traced(scene)
    scene["box8"].visible = True


def remove_one(scene, table):
    scene.remove("box9")
    del table["box9"]


def remove_group(scene, table):
    scene.remove("bus")
    del table["bus"]


def remove_and_add(scene, table):
    scene.remove("box9")
    table["new"] = table.pop("box9")
    keywords = dict(table["new"])
    scene.add(keywords.pop("content"), name="new", **keywords)


CHANGES = [set_position, set_yaw, set_transform, set_motion, stop_motion, stop_everything, set_material,
           set_material_of_group, hide, hide_one_and_show_it, hide_one_and_show_another, remove_one, remove_group,
           remove_and_add]


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
def test_a_changed_scene_is_traced_as_if_built_so(table, change):
    scene = built(table)
    assert len([name for name in scene if "/" not in name]) == 20
    for _ in range(2):  # the second trace keeps its geometry for the third
        before = traced(scene)
    change(scene, table)
    after, anew = traced(scene), traced(built(table))
    assert_same_bits(after, anew)
    assert np.array_equal(ep.synthesize(after, radar()), ep.synthesize(anew, radar()))
    if change is not hide_one_and_show_it:
        assert not all(np.array_equal(getattr(after, name), getattr(before, name)) for name in ARRAYS)


def test_paths_of_before_a_change_stay_what_they_are(table):
    scene = built(table)
    paths = traced(scene)
    cube, arrays = ep.synthesize(paths, radar()), {name: np.array(getattr(paths, name)) for name in ARRAYS}
    names = [mesh.name for mesh in paths.scene.meshes]
    effects = [(effect.name, effect.reason) for effect in paths.effects]
    for change in (set_position, set_yaw, set_motion, set_material, hide, remove_one):
        change(scene, table)
    traced(scene)
    assert np.array_equal(ep.synthesize(paths, radar()), cube)
    assert [mesh.name for mesh in paths.scene.meshes] == names
    assert [(effect.name, effect.reason) for effect in paths.effects] == effects
    for name, values in arrays.items():
        assert np.array_equal(getattr(paths, name), values)


def test_a_trace_beside_changes_of_its_scene_sees_one_state_of_it(table):
    """The record is that of the one place or of the other, to the last bit, however often the object moves meanwhile."""
    scene, places, records = built(table), ((24.0, 2.0, 0.0), (12.0, -2.0, 0.0)), []
    for place in places:
        scene["bus"].position = place
        records.append(record_bytes(traced(scene)))
    assert records[0] != records[1]
    changes, is_over = itertools.count(), threading.Event()

    def move():
        while not is_over.is_set():
            scene["bus"].position = places[next(changes) % 2]

    mover = threading.Thread(target=move)
    mover.start()
    try:
        found = [record_bytes(traced(scene)) for _ in range(8)]
    finally:
        is_over.set()
        mover.join()
    assert set(found) <= set(records) and next(changes) > len(found)


def test_paths_of_before_a_change_save_their_scene(table, tmp_path):
    scene = built(table)
    paths = traced(scene)
    scene.remove("ground")
    paths.save(tmp_path / "frame.h5")
    assert_same_bits(ep.Paths.load(tmp_path / "frame.h5"), paths)


# --- what is hidden ---

def test_what_is_hidden_leaves_the_record_of_a_scene_without_it(table):
    """Arrays, mesh IDs and strata; but for the indices of nodes, which count what is hidden."""
    hidden, without = built(table), built(table)
    hidden["bus"].visible = False
    without.remove("bus")
    one, other = traced(hidden), traced(without)
    assert_same_bits(one, other)
    assert [mesh.name for mesh in hidden.meshes] == [mesh.name for mesh in without.meshes]
    assert hidden.num_triangles == without.num_triangles
    strata = [[(stratum.name, stratum.num_rays) for stratum in paths.frame.strata] for paths in (one, other)]
    assert strata[0] == strata[1]
    assert [(effect.modelled, effect.reason) for effect in one.effects] == [(e.modelled, e.reason) for e in other.effects]


def test_what_is_hidden_takes_part_in_nothing():
    scene = ep.Scene()
    scene.add(box_mesh(1, 1, 1), name="near", position=(8, 0, 0), material="metal")
    scene.add(box_mesh(1, 2, 2), name="far", position=(12, 0, 0), material="metal")
    scene.add(box_mesh(1, 1, 1), name="copy", position=(8, 0, 0), material="metal")
    assert scene.coplanar_overlaps()
    scene["copy"].visible = False
    assert not scene.coplanar_overlaps()
    scene["near"].visible = False
    seen = ep.visibility(scene, radar())
    assert [one.name for one in seen] == ["far"]
    assert seen[0].transmitter.visible_share == 1.0
    frame = ep.simulate(scene, radar(), num_rays=NUM_RAYS, labels=True, guard=False)
    assert [one.name for one in next(iter(frame.labels.values())).objects] == ["far"]
    with pytest.raises(IndexError):
        scene.world_vertices(1)


def test_motions_of_what_is_hidden_need_not_cover_the_frame():
    scene = ep.Scene()
    scene.add(box_mesh(1, 1, 1), name="box", position=(8, 0, 0), material="metal")
    late = ep.KeyframeMotion(times=[5.0, 6.0], translations=[(0, 0, 0), (1, 0, 0)])
    scene.add(box_mesh(1, 1, 1), name="late", position=(8, 3, 0), material="metal", motion=late, visible=False)
    assert ep.trace(scene, radar(), num_rays=NUM_RAYS).num_paths > 0
    scene["late"].visible = True
    with pytest.raises(ValueError, match="late"):
        ep.trace(scene, radar(), num_rays=NUM_RAYS)


def test_selections_and_objects_may_name_what_is_hidden(table):
    scene = built(table)
    scene["bus"].visible = False
    paths = traced(scene)
    assert paths.select("T .* 'bus' .* R").num_paths == 0
    assert paths.select("T .* 'bus/body' .* R").num_paths == 0
    assert paths.select("T [^ 'bus']* R").num_paths == paths.num_paths
    found = ep.families(paths, ["bus", "box1"])
    assert found.objects == ("box1",)
    assert ep.families(paths, ["bus"]).objects == ()
    with pytest.raises(ValueError, match="bux"):
        paths.select("T 'bux' R")
    with pytest.raises(ValueError, match="bux"):
        ep.families(paths, ["bux"])


def test_frame_files_keep_what_is_hidden(table, tmp_path):
    scene = built(table)
    scene["bus"].visible = False
    scene["box3"].visible = False
    paths = traced(scene)
    paths.save(tmp_path / "frame.h5")
    read = ep.Paths.load(tmp_path / "frame.h5")
    assert_same_bits(read, paths)
    again = ep.Scene(read.scene)
    assert not again["bus"].visible and not again["box3"].visible and again["box4"].visible
    again["bus"].visible = again["box3"].visible = True
    assert_same_bits(traced(again), traced(built(street_table())))


def test_hidden_parts_stay_hidden_when_their_group_is_shown(table):
    scene = built(table)
    scene["bus/wheel"].visible = False
    scene["bus"].visible = False
    assert scene["bus/body"].visible  # its own flag
    scene["bus"].visible = True
    assert [mesh.name for mesh in scene["bus"].meshes] == ["bus/body", "bus/mirror"]


# --- names ---

def test_a_scene_is_a_mapping_of_full_names(table):
    scene = built(table)
    names = list(scene)
    assert names == [node.name for node in scene.nodes] and len(scene) == len(names)
    assert "bus/wheel" in scene and "wheel" not in scene and 5 not in scene and "\ud800" not in scene
    bus = scene["bus"]
    assert [child.name for child in bus.children] == ["bus/body", "bus/mirror", "bus/wheel"]
    assert bus.children[2] == scene["bus/wheel"] and bus.children[2].parent == bus and bus.parent is None
    assert [mesh.id for mesh in bus.meshes] == [mesh.id for mesh in scene.meshes if mesh.name.startswith("bus/")]
    assert bus.mesh is None and scene["bus/body"].mesh is table["bus"]["content"][0][1]
    assert len({scene["bus"], scene["bus"], scene["box1"]}) == 2


@pytest.mark.parametrize("call", [lambda scene: scene["buss"], lambda scene: scene.remove("buss")])
def test_an_unknown_name_is_a_key_error_with_the_nearest(table, call):
    scene = built(table)
    with pytest.raises(KeyError, match=r"name: must be the full name of a node \(nearest: bus.*'buss'"):
        call(scene)


def test_a_name_in_no_text_is_told_apart():
    scene = ep.Scene()
    with pytest.raises(KeyError, match="the scene is empty"):
        scene["car"]
    with pytest.raises(TypeError, match="name: must be the full name of a node, got 5"):
        scene[5]
    with pytest.raises(KeyError, match="name"):
        scene["\ud800"]


def test_a_handle_of_what_was_removed_says_so(table):
    scene = built(table)
    wheel = scene["bus/wheel"]
    scene.remove("bus")
    assert repr(wheel) == "SceneNode('bus/wheel', removed)"
    with pytest.raises(KeyError, match="bus/wheel"):
        _ = wheel.position
    with pytest.raises(KeyError, match="bus/wheel"):
        wheel.visible = False


# --- handles ---

def test_what_is_set_is_read(table):
    box = built(table)["box2"]
    box.position = [1, 2, 3]
    assert box.position.tolist() == [1.0, 2.0, 3.0]
    box.position += (0.5, 0, 0)
    assert box.position.tolist() == [1.5, 2.0, 3.0]
    box.yaw += 0.25
    assert box.yaw == pytest.approx(0.65, abs=ROUNDING)
    assert box.position.tolist() == [1.5, 2.0, 3.0]
    assert box.transform[:3, 3].tolist() == [1.5, 2.0, 3.0]
    box.material = "concrete"
    assert box.material is ep.materials["concrete"]
    motion = ep.LinearMotion(velocity=(1, 0, 0))
    box.motion = motion
    assert box.motion is motion
    box.motion = None
    assert box.motion is None
    assert "position=(1.5, 2, 3) m" in repr(box)


def test_entries_of_what_is_read_cannot_be_set_in_vain(table):
    box = built(table)["box2"]
    with pytest.raises(ValueError, match="read-only"):
        box.position[0] = 5.0
    with pytest.raises(ValueError, match="read-only"):
        box.transform[0, 3] = 5.0
    with pytest.raises(AttributeError):
        box.posision = (1, 2, 3)


def test_a_yaw_turns_a_tilted_object_about_the_vertical(table):
    box = built(table)["box2"]
    tilt = np.array([[0.8, 0, -0.6], [0, 1, 0], [0.6, 0, 0.8]])  # +x points up by 37 degrees
    box.transform = np.block([[2.0 * tilt, np.array([[1.0], [2], [3]])], [np.zeros((1, 3)), 1.0]])
    box.yaw = math.pi / 2
    assert np.allclose(box.transform[:3, 0], [0, 1.6, 1.2], atol=ROUNDING)
    assert np.allclose(box.transform[:3, 1], [-2, 0, 0], atol=ROUNDING)
    assert box.position.tolist() == [1.0, 2.0, 3.0]
    assert box.yaw == pytest.approx(math.pi / 2, abs=ROUNDING)


def test_the_material_of_a_group_is_that_of_its_meshes(table):
    scene = built(table)
    assert scene["bus"].material is ep.materials["metal"]
    scene["bus/wheel"].material = "wood"
    assert scene["bus"].material is None
    scene["bus"].material = "wood"
    assert {mesh.name: mesh.material_name for mesh in scene["bus"].meshes} == {
        "bus/body": "wood", "bus/mirror": "wood", "bus/wheel": "wood"}


def test_vertices_that_move_are_a_motion_of_their_mesh():
    mesh = box_mesh(1, 1, 1)
    corners = np.asarray(mesh.vertices)
    scene = ep.Scene()
    scene.add(mesh, name="jelly", material="metal")
    shakes = ep.VertexSequence(times=[0.0, 1.0], vertices=[corners, 1.5 * corners])
    scene["jelly"].motion = shakes
    assert scene["jelly"].motion is shakes and scene.nodes[0].motion is None
    assert np.allclose(scene.world_vertices(0, 1.0), 1.5 * corners, atol=ROUNDING)
    scene["jelly"].motion = ep.LinearMotion(velocity=(1, 0, 0))
    assert scene.nodes[0].deformation is None
    assert np.allclose(scene.world_vertices(0, 1.0), corners + [1, 0, 0], atol=ROUNDING)


WRONG = {
    "position": ["abc", (1, 2), None, (1, 2, math.nan), (1, 2, "x"), {1, 2, 3}, 5, [[1], [2, 3]]],
    "yaw": ["abc", None, math.inf, (1, 2), 1j, 10**400],
    "transform": ["abc", np.eye(3), None, np.full((4, 4), math.nan), np.ones((4, 4)), np.diag([1.0, 0, 1, 1])],
    "motion": ["abc", 5, (1, 0, 0), ep.Material.metal()],
    "material": ["metl", 5, None, ep.Scene(), "\ud800"],
    "visible": ["no", None, 2, 0.0],
}


@pytest.mark.parametrize("argument, value", [(name, value) for name, values in WRONG.items() for value in values],
                         ids=lambda value: value if isinstance(value, str) and value in WRONG else ascii(value)[:30])
def test_wrong_values_are_refused_by_name_and_change_nothing(argument, value):
    scene = ep.Scene()
    scene.add(box_mesh(1, 1, 1), name="box", material="metal")
    with pytest.raises((TypeError, ValueError), match=f"^{argument}: "):
        setattr(scene["box"], argument, value)
    box = scene["box"]
    assert np.array_equal(box.transform, np.eye(4)) and box.motion is None and box.visible
    assert box.material is ep.materials["metal"]


@pytest.mark.parametrize("argument, value", [(name, value) for name, values in WRONG.items() for value in values
                                             if not (name == "transform" and value is None)],
                         ids=lambda value: value if isinstance(value, str) and value in WRONG else ascii(value)[:30])
def test_wrong_values_of_add_are_refused_by_name_and_add_nothing(argument, value):
    scene = ep.Scene()
    with pytest.raises((TypeError, ValueError), match=f"^{argument}: "):
        scene.add(box_mesh(1, 1, 1), **({"name": "box", "material": "metal"} | {argument: value}))
    assert len(scene) == 0


@pytest.mark.parametrize("keywords, message", [
    ({"name": 5}, "^name: "), ({"name": "a/b"}, "^name: "), ({"name": "\ud800"}, "^name: "), ({"name": "a\0b"}, "^name: "),
    ({"parent": "bx"}, r"^parent: .*nearest: box"), ({"parent": 5}, "^parent: "), ({"smooth": 1}, "^smooth: "),
    ({"speed": "fast"}, "^speed: "), ({"speed": math.nan}, "^speed: "),
    ({"speed": 1.0, "motion": ep.LinearMotion(velocity=(1, 0, 0))}, "^speed: .*without motion"),
    ({"transform": np.eye(4), "yaw": 1.0}, "^transform: "), ({"postion": (1, 2, 3)}, "unknown keyword 'postion'"),
])
def test_wrong_arguments_of_add_are_refused_by_name(keywords, message):
    scene = ep.Scene()
    scene.add(box_mesh(1, 1, 1), name="box", material="metal")
    with pytest.raises((TypeError, ValueError), match=message):
        scene.add(box_mesh(1, 1, 1), **({"name": "other", "material": "metal"} | keywords))
    assert list(scene) == ["box"]


@pytest.mark.parametrize("content", ["car.obj", 5, [box_mesh(1, 1, 1)], [("a", 5)], [(5, box_mesh(1, 1, 1))]])
def test_what_is_no_mesh_is_refused_by_name(content):
    with pytest.raises(TypeError, match="^mesh_or_actor: "):
        ep.Scene().add(content, name="car", material="metal")


def test_an_add_that_fails_halfway_adds_nothing():
    scene = ep.Scene()
    parts = [("body", box_mesh(1, 1, 1)), ("a*b", box_mesh(1, 1, 1))]
    with pytest.raises(ValueError, match="name"):
        scene.add(parts, name="car", material="metal")
    assert len(scene) == 0 and not scene.meshes


def test_a_scene_is_copied_from_a_scene_alone():
    with pytest.raises(TypeError, match="^scene: "):
        ep.Scene("street.toml")


# --- axes of motions ---

def range_rate(scene, name, radar=None, duration=1e-3):
    """m/s, receding positive, of the shortest direct echo of an object, from the replayed lengths of its paths."""
    radar = radar or build_radar()
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=1).select(f"T '{name}' R")
    lengths = paths.lengths([0.0, duration], radar.transmitters[0].position, radar.receivers[0].position)
    nearest = np.argmin(lengths[0])
    return float(lengths[1, nearest] - lengths[0, nearest]) / (2.0 * duration)


def scene_with(content, **keywords):
    scene = ep.Scene()
    scene.add(content, name="target", **keywords)
    return scene


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


# --- what traces keep ---

def test_a_mesh_is_measured_once_and_forgotten_with_its_scene():
    gc.collect()
    before = len(tessellation._known)
    scene = scene_with(ep.actors.sphere(radius=1.0, subdivisions=3), position=(9, 0, 0), material="metal")
    with mock.patch.object(tessellation, "_tessellation_of", wraps=tessellation._tessellation_of) as measure:
        for _ in range(3):
            with pytest.warns(ep.TessellationWarning):
                ep.trace(scene, build_radar(), num_rays=256)
            gc.collect()
    assert measure.call_count == 1
    assert len(tessellation._known) == before + 1
    del scene, measure
    gc.collect()
    assert len(tessellation._known) == before


def test_a_table_of_meshes_forgets_those_that_are_gone():
    table, meshes = _core.MeshTable(), [box_mesh(1, 1, 1) for _ in range(200)]
    for number, mesh in enumerate(meshes):
        table.set(mesh, number)
    assert len(table) == 200 and table.get(meshes[150], None) == 150
    del meshes[:], mesh
    assert len(table) == 0
    assert table.get(box_mesh(1, 1, 1), "none") == "none"


def test_the_keywords_of_an_actor_are_looked_up_once(tmp_path):
    from echopath.scene_file import objects

    objects._parameter_table.cache_clear()
    path = tmp_path / "scene.toml"
    path.write_text(RADAR_FILE + "".join(
        f'[[objects]]\nname = "box{number}"\nactor = "box"\nparameters = {{size = [1, 1, 1]}}\nmaterial = "metal"\n'
        for number in range(30)))
    with mock.patch.object(objects, "create_model", wraps=objects.create_model) as made:
        assert len(ep.load_scene(path).scene) == 30
    assert made.call_count == 1


def test_objects_of_one_mesh_file_share_its_meshes(tmp_path):
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    path = tmp_path / "scene.toml"
    path.write_text(RADAR_FILE + "".join(
        f'[[objects]]\nname = "quad{number}"\nmesh = "quad.obj"\nunit = {unit}\nmaterial = "metal"\n'
        for number, unit in enumerate((1.0, 2.0, 1.0))))
    meshes = [mesh.mesh for mesh in ep.load_scene(path).scene.meshes]
    assert meshes[0] is meshes[2] and [mesh.area for mesh in meshes] == pytest.approx([0.5, 2.0, 0.5])
