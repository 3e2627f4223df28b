"""Meshes, mesh files and scenes as Python sees them."""
import gc
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
SQUARE = [[0, 1, 2], [0, 2, 3]]
ROUNDING = 1e-12     # of lengths and areas of some metres


@pytest.fixture
def square():
    return ep.Mesh(CORNERS, SQUARE)


def about_z(angle):
    matrix = np.eye(4)
    matrix[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    return matrix


def shifted(x, y, z):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def test_mesh_arrays_are_views_that_outlive_the_mesh(square):
    vertices, triangles = square.vertices, square.triangles
    assert not vertices.flags.owndata and not vertices.flags.writeable
    assert vertices.dtype == np.float64 and triangles.dtype == np.uint32
    assert square.vertices.ctypes.data == vertices.ctypes.data
    del square
    gc.collect()
    assert np.array_equal(vertices, CORNERS) and np.array_equal(triangles, SQUARE)


def test_mesh_says_what_it_did_to_its_input():
    mesh = ep.Mesh(np.vstack([CORNERS, [[0, 0, 1], [9, 9, 9]]]), [[0, 1, 2], [0, 0, 1], [2, 1, 0], [0, 2, 4]])
    assert mesh.num_removed_triangles == 1
    assert mesh.original_triangle.tolist() == [0, 2, 3]
    assert mesh.num_input_vertices == 6
    assert mesh.num_duplicated_vertices == len(mesh.vertices) - 4
    assert 5 not in mesh.original_vertex
    assert not mesh.is_closed
    assert mesh.area == pytest.approx(0.5 + 0.5 + math.sqrt(2) / 2, abs=ROUNDING)


def test_mesh_made_from_its_own_arrays_keeps_the_map_to_the_file():
    mesh = ep.Mesh(CORNERS, [[1, 1, 2], *SQUARE])
    again = ep.Mesh(mesh.vertices, mesh.triangles, original_triangle=mesh.original_triangle)
    assert again.original_triangle.tolist() == [1, 2]


@pytest.mark.parametrize("vertices, triangles, word", [
    (CORNERS[:, :2], SQUARE, "vertices"),
    (CORNERS, [[0, 1, 4]], "triangles"),
    (CORNERS, [[0, 1, -1]], "triangles"),
    (CORNERS, [[0, 1]], "triangles"),
    (CORNERS, np.zeros((0, 3), int), "triangles"),
])
def test_bad_meshes_are_refused_by_name(vertices, triangles, word):
    with pytest.raises(ValueError, match=word):
        ep.Mesh(vertices, triangles)


def test_fractions_are_no_indices():
    with pytest.raises(TypeError, match="triangles"):
        ep.Mesh(CORNERS, [[0.0, 1.0, 2.0]])


def test_mesh_files_give_named_meshes(tmp_path):
    path = tmp_path / "car.obj"
    path.write_text("v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\ng body\nf 1 2 3\ng glass\nf 1 2 4\n")
    meshes = ep.load_meshes(path, unit=0.5)
    assert [name for name, _ in meshes] == ["body", "glass"]
    assert meshes[0][1].area == 0.5
    assert len(ep.load_mesh(str(path)).triangles) == 2


def test_mesh_file_errors_are_os_errors(tmp_path):
    with pytest.raises(OSError, match="none.ply"):
        ep.load_mesh(tmp_path / "none.ply")
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0\n")
    with pytest.raises(ep.FileError, match="bad.obj, line 2"):
        ep.load_mesh(tmp_path / "bad.obj")
    with pytest.raises(ValueError, match="unit"):
        ep.load_mesh(tmp_path / "bad.obj", unit=-1.0)


def test_position_and_yaw_place_a_mesh(square):
    scene = ep.Scene()
    assert scene.add(square, name="sign", material="metal", position=(1, 2, 3), yaw=math.pi / 2) == "sign"
    np.testing.assert_allclose(scene.world_vertices(0)[1], (1, 3, 3), atol=ROUNDING)
    np.testing.assert_allclose(scene.nodes[0].placement, shifted(1, 2, 3) @ about_z(math.pi / 2), atol=ROUNDING)


def test_nested_motions_are_the_product_of_their_matrices(square):
    scene = ep.Scene()
    scene.add(name="car", position=(10, 0, 0), yaw=0.5, motion=ep.LinearMotion((3, 1, 0), (0, 0, 0.2)))
    dish = shifted(0, 0, 2) @ np.diag([1, -1, -1, 1])
    full_name = scene.add(square, name="dish", material="metal", parent="car", transform=dish,
                          motion=ep.LinearMotion(angular_velocity=(0, 0, 2)))
    assert full_name == "car/dish"
    time = 0.7
    car = shifted(10 + 3 * time, time, 0) @ about_z(0.2 * time) @ about_z(0.5)
    dish_now = shifted(0, 0, 2) @ about_z(2 * time) @ np.diag([1, -1, -1, 1])
    expected = (car @ dish_now @ np.c_[CORNERS, np.ones(4)].T).T[:, :3]
    np.testing.assert_allclose(scene.world_vertices(0, time), expected, atol=ROUNDING)


def test_vertex_sequence_moves_the_vertices_of_a_mesh(square):
    scene = ep.Scene()
    raised = CORNERS + [0, 0, 2]
    scene.add(square, name="lift", material="metal", position=(0, 0, 1),
              motion=ep.VertexSequence(times=[0, 1], vertices=[CORNERS, raised]))
    np.testing.assert_allclose(scene.world_vertices(0, 0.5), CORNERS + [0, 0, 2], atol=ROUNDING)
    node = scene.nodes[0]
    assert isinstance(node.deformation, ep.VertexSequence) and node.motion is None
    assert scene.is_moving(0)
    scene.require_times(0.0, 1.0)
    with pytest.raises(ValueError, match="lift"):
        scene.require_times(0.0, 1.5)


def test_group_of_meshes_hangs_below_one_node(square):
    scene = ep.Scene()
    group = [("body", square), ("wheels/left", square), ("wheels/right", square)]
    scene.add(group, name="car", material="metal", position=(5, 0, 0))
    assert [node.name for node in scene.nodes] == [
        "car", "car/body", "car/wheels", "car/wheels/left", "car/wheels/right"]
    assert [node.parent for node in scene.nodes] == [-1, 0, 0, 2, 2]
    assert [mesh.name for mesh in scene.meshes] == ["car/body", "car/wheels/left", "car/wheels/right"]
    assert [mesh.id for mesh in scene.meshes] == [0, 1, 2]
    assert scene.world_vertices(2)[0].tolist() == [5, 0, 0]
    assert scene.num_triangles == 6


def part(name, mesh, material="skin", motion=None, position=(0.0, 0.0, 0.0)):
    return SimpleNamespace(name=name, mesh=mesh, material=material, motion=motion, position=position)


def test_actor_brings_materials_motions_and_places_of_its_parts(square):
    swing = ep.LinearMotion(angular_velocity=(0, 1, 0))
    head, hand = part("head", square, position=(0, 0, 1.6)), part("arm/hand", square, "clothing", swing)
    actor = SimpleNamespace(parts=[head, hand])
    scene = ep.Scene()
    scene.add(actor, name="person", position=(2, 0, 0), motion=ep.LinearMotion((1, 0, 0)))
    names = {mesh.name: mesh.material_name for mesh in scene.meshes}
    assert names == {"person/head": "skin", "person/arm/hand": "clothing"}
    np.testing.assert_allclose(scene.world_vertices(0, 3.0)[0], (5, 0, 1.6), atol=ROUNDING)
    assert scene.nodes[-1].motion is swing
    scene.add(actor, name="statue", material="metal")
    assert {mesh.material_name for mesh in scene.meshes if mesh.name.startswith("statue")} == {"metal"}


def test_material_is_a_name_or_an_object(square):
    scene = ep.Scene()
    own = ep.Material(permittivity=3)
    scene.add(square, name="a", material="concrete")
    scene.add(square, name="b", material=ep.materials["glass"])
    scene.add(square, name="c", material=own)
    assert [mesh.material_name for mesh in scene.meshes] == ["concrete", "glass", ""]
    assert scene.meshes[0].material is ep.materials["concrete"]
    assert scene.meshes[2].material is own
    assert scene.nodes[2].mesh is square


def test_arrays_of_a_scene_outlive_it():
    scene = ep.Scene()
    scene.add(ep.Mesh(CORNERS, SQUARE), name="wall", material=ep.Material(permittivity=3))
    triangles, material = scene.meshes[0].triangles, scene.meshes[0].material
    del scene
    gc.collect()
    assert np.array_equal(triangles, SQUARE)
    assert material.permittivity == 3


def test_breakpoints_of_all_motions_are_joined(square):
    scene = ep.Scene()
    for name, times in (("a", [0, 0.5, 1]), ("b", [0, 0.25, 0.5, 1])):
        motion = ep.KeyframeMotion(times=times, translations=np.zeros((len(times), 3)), interpolation="linear")
        scene.add(square, name=name, material="metal", motion=motion)
    assert scene.breakpoints.tolist() == [0.25, 0.5]
    assert len(ep.Scene().breakpoints) == 0


@pytest.mark.parametrize("keywords, words", [
    ({"name": "a/b"}, ["name", "free of", "a/b"]),
    ({"name": "a\0b"}, ["name", "without", "NUL"]),
    ({"name": ""}, ["name", "empty"]),
    ({"name": "wall"}, ["name", "unique", "wall"]),
    ({"name": "x", "material": None}, ["material", "'x'", "concrete", "wood"]),
    ({"name": "x", "material": "concret"}, ["material", "concret", "concrete"]),
    ({"name": "x", "parent": "wal"}, ["parent", "wall", "'wal'"]),
    ({"name": "x", "position": (1, 2)}, ["position", "[3]"]),
    ({"name": "x", "position": (1, 2, math.nan)}, ["position", "finite"]),
    ({"name": "x", "yaw": math.inf}, ["yaw", "finite"]),
    ({"name": "x", "transform": np.eye(4), "yaw": 1.0}, ["transform", "yaw"]),
    ({"name": "x", "transform": np.eye(3)}, ["transform", "[4, 4]"]),
    ({"name": "x", "transform": np.diag([1, 1, 0, 1])}, ["transform", "flatten"]),
    ({"name": "x", "motion": ep.VertexSequence(times=[0, 1], vertices=np.zeros((2, 3, 3)))}, ["deformation", "got 3"]),
])
def test_bad_values_are_refused_by_name_and_add_nothing(square, keywords, words):
    scene = ep.Scene()
    scene.add(square, name="wall", material="metal")
    with pytest.raises(ValueError) as caught:
        scene.add(square, **({"material": "metal"} | keywords))
    for word in words:
        assert word in str(caught.value)
    assert len(scene) == 1


@pytest.mark.parametrize("content, keywords, word", [
    (ep.Mesh(CORNERS, SQUARE), {"materil": "metal"}, "'material'"),
    (ep.Mesh(CORNERS, SQUARE), {"material": 3}, "material"),
    (ep.Mesh(CORNERS, SQUARE), {"material": "metal", "motion": "fast"}, "motion"),
    ("wall.obj", {"material": "metal"}, "mesh_or_actor: .*; ep.load_mesh and ep.load_model read files, got 'wall.obj'"),
    (Path("wall.obj"), {"material": "metal"}, "mesh_or_actor: .*; ep.load_mesh and ep.load_model read files, got .*wall.obj"),
    (Path("."), {"material": "metal"}, "mesh_or_actor: .*; ep.load_mesh and ep.load_model read files"),
    (SimpleNamespace(parts=["head", "hand"]), {}, "mesh_or_actor: must be a Mesh, an Actor"),
    ([ep.Mesh(CORNERS, SQUARE)], {"material": "metal"}, "mesh_or_actor"),
])
def test_bad_kinds_are_refused_by_name(content, keywords, word):
    with pytest.raises(TypeError, match=word):
        ep.Scene().add(content, name="x", **keywords)


def test_an_actor_is_added_whole_or_not_at_all(square):
    scene = ep.Scene()
    with pytest.raises(ValueError, match="unique"):
        scene.add([("a", square), ("a", square)], name="pair", material="metal")
    with pytest.raises(ValueError, match="VertexSequence"):
        scene.add([("a", square)], name="one", material="metal",
                  motion=ep.VertexSequence(times=[0, 1], vertices=np.zeros((2, 4, 3))))
    assert len(scene) == 0 and scene.add(name="pair") == "pair"


def test_mesh_ids_are_checked(square):
    scene = ep.Scene()
    scene.add(square, name="wall", material="metal")
    for mesh_id in (1, -1):
        with pytest.raises(IndexError, match="mesh_id"):
            scene.world_vertices(mesh_id)


def test_overlaps_name_their_meshes_and_tell_area_and_distance():
    scene = ep.Scene()
    scene.add(ep.actors.ground(10.0), name="ground", material="asphalt", position=(0, 0, -0.3))
    scene.add(ep.actors.box(0.6), name="box", material="metal", motion=ep.LinearMotion(velocity=(0, 0, 4e-6)))
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=(3, 0, 1))
    found, = scene.coplanar_overlaps()
    assert found.names == ("ground", "box") and found.mesh_ids == (0, 1) and found.num_triangles == 4
    assert found.area == pytest.approx(0.36, rel=ROUNDING) and found.distance < 1e-3 * ROUNDING
    assert str(found) == "CoplanarOverlap('ground', 'box', 4 triangles, 0.36 m^2)"
    later, = scene.coplanar_overlaps(time=2.0)
    assert later.distance == pytest.approx(8e-6, abs=ROUNDING)
    assert scene.coplanar_overlaps(time=2.0, max_distance=7e-6) == [] == ep.Scene().coplanar_overlaps()
    with pytest.raises(ValueError, match="max_distance: must be positive and finite, m, got 0"):
        scene.coplanar_overlaps(max_distance=0.0)


def test_globs_take_names_and_their_descendants():
    assert ep._core.glob_takes("ped*/arm_?", "pedestrian/arm_l/hand")
    assert not ep._core.glob_takes("arm_?", "pedestrian/arm_l")


def test_reprs_are_short(square):
    scene = ep.Scene()
    scene.add(square, name="wall", material="metal")
    assert repr(square) == "Mesh(4 vertices, 2 triangles, open, 1 m^2)"
    assert repr(scene) == "Scene(1 node, 1 mesh, 2 triangles)"
    assert repr(scene.meshes) == "[SceneMesh(0, 'wall', 2 triangles)]"
    assert repr(scene.nodes) == "[Node('wall', mesh)]"


def test_a_trace_sees_the_scene_as_it_was_when_it_was_asked():
    """The pilot of a trace and the trace itself used to see what was added between them."""
    scene, plate = ep.Scene(), ep.actors.plate(1.0, 1.0)
    for i in range(20):
        scene.add(plate, name=f"first {i}", material="metal", position=(10, 2 * i, 0))
    added = []

    def add_one(stage, fraction):
        added.append(scene.add(plate, name=f"later {len(added)}", material="metal", position=(20, 2 * len(added), 0)))

    paths = ep.trace(scene, build_radar([(0, 0, 0)], [(0, 0, 0)]), num_rays=1_000_000, max_bounces=2, progress=add_one)
    assert added and [mesh.name for mesh in paths.scene.meshes] == [f"first {i}" for i in range(20)]
