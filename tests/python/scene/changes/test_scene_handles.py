"""A scene is a mapping of names to handles, through which objects are read and changed; what is wrong is refused by name."""
from __future__ import annotations

import math

import numpy as np
import pytest

import echopath as ep
from support.street import box_mesh, built

ROUNDING = 1e-12         # of lengths of some metres and of rates of some m/s


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
