"""glTF files: their nodes, meshes and materials as a scene has them, and what is said of bad ones."""
import re

import numpy as np
import pytest

import echopath as ep
from support.files.gltf_files import BOX, BOX_SIDES, GltfFile, box_file, loaded, tube

TO_SCENE = [2, 0, 1]      # axes of a file, y up, that become x, y and z
SINGLE = 1e-6             # of numbers in single precision of order 1


def world(model, time: float = 0.0, **place) -> dict:
    """{name of a mesh below the model: its vertices [V, 3] at a time}."""
    scene = ep.Scene()
    scene.add(model, name="m", **place)
    return {mesh.name.removeprefix("m/"): scene.world_vertices(mesh.id, time) for mesh in scene.meshes}


def same_points(a, b, tolerance: float) -> bool:
    """Whether two sets of points are the same, in whatever order."""
    a, b = (np.array(sorted(np.round(np.asarray(points, float), 5).tolist())) for points in (a, b))
    return a.shape == b.shape and bool(np.abs(a - b).max() <= tolerance + 1e-5)


# --- axes, units and nodes ---

def test_what_faces_z_with_y_up_faces_x_with_z_up(tmp_path):
    model = loaded(tmp_path, box_file())
    assert np.ptp(world(model)["box"], axis=0) == pytest.approx([4.0, 1.0, 2.0])  # z, x and y of the file
    assert (model.format, model.unit, model.up, model.num_triangles) == ("glTF 2.0", 1.0, "y", 12)


def test_the_caller_knows_axes_and_units_better(tmp_path):
    model = loaded(tmp_path, box_file(translation=[1, 2, 3]), unit=0.01, up="z")
    points = world(model)["box"]
    assert points.mean(axis=0) == pytest.approx([0.01, 0.02, 0.03])
    assert np.ptp(points, axis=0) == pytest.approx([0.01, 0.02, 0.04])


def test_nodes_nest_as_their_transforms_multiply(tmp_path):
    file = box_file(rotation=[0, 0, np.sqrt(0.5), np.sqrt(0.5)], scale=[2, 3, 1], translation=[1, 0, 0])
    file.json["nodes"].append({"name": "carrier", "children": [0], "translation": [0, 10, 0], "scale": [1, 1, -1]})
    file.json["scenes"][0]["nodes"] = [1]
    turned = np.stack([-BOX[:, 1] * 3, BOX[:, 0] * 2, BOX[:, 2]], axis=1) + [1, 0, 0]  # a quarter turn about z
    wanted = turned * [1, 1, -1] + [0, 10, 0]
    assert same_points(world(loaded(tmp_path, file))["carrier/box"], wanted[:, TO_SCENE], SINGLE)


def test_a_matrix_stands_for_the_same_as_its_parts(tmp_path):
    columns = [0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1, 0, 1, 5, 0, 1]
    of_matrix = world(loaded(tmp_path, box_file(matrix=columns)))["box"]
    parts = box_file(rotation=[0, 0, np.sqrt(0.5), np.sqrt(0.5)], scale=[2, 3, 1], translation=[1, 5, 0])
    assert np.abs(of_matrix - world(loaded(tmp_path, parts))["box"]).max() < SINGLE


def test_names_are_made_fit_and_unique_and_that_is_told(tmp_path):
    file = box_file()
    file.json["nodes"] = [{"name": name, "mesh": 0} for name in ("a/b*", "a_b_", " ", "'", "x" * 100)]
    file.json["scenes"] = [{"nodes": [0, 1, 2, 3, 4]}]
    model = loaded(tmp_path, file)
    assert list(world(model)) == ["a_b_", "a_b__2", "node_2", "_", "x" * 64]
    assert any("'a/b*' to 'a_b_'" in note for note in model.notes)


def test_each_primitive_is_a_mesh_named_by_its_material(tmp_path):
    file = box_file()
    file.json["materials"] = [{"name": "glass"}, {"name": "steel of mine"}]
    one = file.json["meshes"][0]["primitives"][0]
    file.json["meshes"][0]["primitives"] = [one | {"material": 0}, one | {"material": 1}, one]
    scene = ep.Scene()
    model = loaded(tmp_path, file, materials={"steel of mine": "metal", "glass": ep.materials["glass"]})
    scene.add(model, name="m")
    assert [mesh.name for mesh in scene.meshes] == ["m/box/glass", "m/box/steel of mine", "m/box/primitive_2"]
    assert scene.meshes[1].material == ep.materials["metal"]
    assert [node.foreign_material for node in model.nodes[1:]] == ["glass", "steel of mine", ""]
    assert len([note for note in model.notes if "without a material" in note]) == 1


def test_what_the_file_hides_or_flattens_is_left_out(tmp_path):
    file = box_file()
    file.json["nodes"] += [{"mesh": 0, "scale": [0, 1, 1]}, {"children": [3], "extensions": {"KHR_node_visibility": {
        "visible": False}}}, {"mesh": 0}, {"camera": 0}]
    file.json["scenes"] = [{"nodes": [0, 1, 2, 4]}]
    model = loaded(tmp_path, file)
    assert list(world(model)) == ["box"]
    assert len(model.notes) == 3 and any("scaled to nothing" in note for note in model.notes)


# --- meshes ---

def test_strips_and_fans_are_triangles_with_one_winding(tmp_path):
    corners = [[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 0, 1], [2, 0, 0]]
    for mode, points in ((5, corners), (6, [[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 0]])):
        file = GltfFile(nodes=[{"mesh": 0}])
        file.mesh(points, mode=mode)
        mesh = loaded(tmp_path, file).nodes[0].mesh
        assert len(mesh.triangles) == len(points) - 2
        a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
        assert (np.cross(b - a, c - a)[:, 2] > 0).all()  # all look up


def test_points_and_lines_are_left_out_with_a_note(tmp_path):
    file = box_file()
    one = file.json["meshes"][0]["primitives"][0]
    file.json["meshes"][0]["primitives"] += [one | {"mode": mode} for mode in range(4)]
    model = loaded(tmp_path, file)
    assert model.num_triangles == 12 and "points and lines are left out" in model.notes


def test_strides_sparse_entries_and_small_indices_are_read(tmp_path):
    file = GltfFile(nodes=[{"mesh": 0}])
    moved = BOX.copy()
    moved[[1, 6]] = [[0, 0, 9], [0, 7, 0]]
    sparse = {"count": 2, "indices": {"bufferView": file.view(np.array([1, 6], "<u2")), "componentType": 5123},
              "values": {"bufferView": file.view(moved[[1, 6]].astype("<f4"))}}
    position = file.accessor(BOX, stride=20, sparse=sparse)
    file.mesh(position, indices=file.accessor(BOX_SIDES.ravel(), "u1"))
    assert np.abs(loaded(tmp_path, file).nodes[0].mesh.vertices - moved[:, TO_SCENE]).max() < SINGLE


@pytest.mark.parametrize("dtype,most", [("i1", 127), ("u1", 255), ("i2", 32767), ("u2", 65535)])
def test_quantised_positions_are_those_of_the_specification(tmp_path, dtype, most):
    steps = np.random.default_rng(1).integers(0, most + 1, (8, 3))
    for normalized in (True, False):
        file = GltfFile(nodes=[{"mesh": 0, "scale": [2.0, 2.0, 2.0]}], extensionsRequired=["KHR_mesh_quantization"])
        file.mesh(file.accessor(steps, dtype, normalized=normalized, stride=8), BOX_SIDES)
        wanted = 2.0 * (steps / most if normalized else steps)
        found = world(loaded(tmp_path, file))["node_0"]
        assert len(found) == len(wanted) and np.abs(found - wanted[:, TO_SCENE]).max() <= 1e-12 * (1 if normalized else most)


def test_vertices_split_for_textures_are_one_and_flat_shading_stays_flat(tmp_path):
    corners = BOX[BOX_SIDES].reshape(-1, 3)
    sides = np.cross(corners[1::3] - corners[0::3], corners[2::3] - corners[0::3])
    normals = np.repeat(sides / np.linalg.norm(sides, axis=1)[:, None], 3, axis=0)
    file = GltfFile(nodes=[{"mesh": 0}])
    file.mesh(corners, NORMAL=file.accessor(normals))
    node = loaded(tmp_path, file).nodes[0]
    assert len(node.mesh.vertices) == 8 and node.mesh.is_closed and not node.smooth


def test_normals_that_turn_over_a_face_stand_for_a_curved_surface(tmp_path):
    vertices, triangles = tube()
    rims = [0, 8 * 12]
    caps = [[rim + (i if rim else 0), rim + (i + 1 if not rim else 0), rim + (i if not rim else i + 1)]
            for rim in rims for i in range(1, 11)]
    normals = vertices * [1, 0, 1] / 0.1
    file = GltfFile(nodes=[{"mesh": 0}])
    seam = len(vertices) + np.arange(len(vertices))  # the caps have vertices and normals of their own
    file.mesh(np.concatenate([vertices, vertices]), np.concatenate([triangles, seam[np.array(caps)]]),
              NORMAL=file.accessor(np.concatenate([normals, np.tile([0.0, 1.0, 0.0], (len(vertices), 1))])))
    node = loaded(tmp_path, file).nodes[0]
    assert node.smooth
    rim = node.mesh.vertices[:, 2].max()  # the edge of a cap stays an edge: its vertices are there twice
    assert (np.abs(node.mesh.vertices[:, 2] - rim) < 1e-6).sum() == 24


def hits_of(mesh, unit: float = 1.0):
    scene = ep.Scene()
    scene.add(mesh, name="box", material="metal", position=(8, 0, 0), yaw=0.4)
    radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=32, sampling_rate=5e6, num_chirps=4,
                                      chirp_interval=1e-4), transmitters=[ep.Antenna((0, 0, 0))],
                     receivers=[ep.Antenna((0, 0.01, 0))])
    paths = ep.trace(scene, radar, num_rays=2000, seed=3)
    return paths.triangle_id, paths.points(0.0), paths.amplitude


def test_the_same_mesh_gives_the_same_hits_through_every_format(tmp_path):
    points = BOX[:, TO_SCENE]
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in points) + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in BOX_SIDES)
    (tmp_path / "box.obj").write_text(text)
    ids, places, amplitudes = hits_of(ep.load_mesh(tmp_path / "box.obj"))
    assert len(ids) > 100
    for content, name in ((box_file().glb(), "box.glb"), (box_file().gltf().encode(), "box.gltf")):
        (tmp_path / name).write_bytes(content)
        found = hits_of(ep.load_model(tmp_path / name).nodes[0].mesh)
        assert np.array_equal(found[0], ids) and np.array_equal(found[1], places) and np.array_equal(found[2], amplitudes)


def test_a_mirrored_node_has_the_mirrored_echoes(tmp_path):
    def amplitude(vertices, scale):
        file = GltfFile(nodes=[{"mesh": 0, "scale": scale}])
        file.mesh(vertices, [[0, 1, 2], [0, 2, 3]])
        scene = ep.Scene()
        scene.add(loaded(tmp_path, file), name="m", position=(9, 0, 0), material="metal")
        return abs(ep.rcs(scene, frequency=77e9, incidence=(-1, 0, 0), observation=(-1, 0, 0), num_rays=4000))

    plate = np.array([[0, -0.1, 0.05], [0.3, -0.1, 0], [0.3, 0.2, 0], [0, 0.2, 0.05]])
    assert amplitude(plate * [-1, 1, 1], [-1, 1, 1]) == pytest.approx(amplitude(plate, [1, 1, 1]), rel=1e-9)


# --- files ---

def test_bytes_may_stand_in_the_file_or_beside_it_but_nowhere_else(tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    wanted = world(loaded(tmp_path, box_file()))["box"]
    for uri in (None, "a%20b.bin", "./a b.bin"):
        (inner / "box.gltf").write_text(box_file().gltf(uri))
        (inner / "a b.bin").write_bytes(box_file().bytes)
        assert np.array_equal(world(ep.load_model(inner / "box.gltf"))["box"], wanted)
    (tmp_path / "a b.bin").write_bytes(box_file().bytes)
    for uri in ("../a b.bin", str(tmp_path / "a b.bin"), "file:///etc/passwd", "http://a.b/c.bin", "%2e%2e/a b.bin"):
        (inner / "box.gltf").write_text(box_file().gltf(uri))
        with pytest.raises(ep.FileError, match=r"buffers\[0\].uri: must be the name of a file in the folder of this one"):
            ep.load_model(inner / "box.gltf")


def test_model_and_bytes_may_be_links_into_a_store(tmp_path):
    """As caches of large files keep them: names that tell nothing in one folder, links to them in another."""
    store, model = tmp_path / "store", tmp_path / "model"
    for folder in (store, model):
        folder.mkdir()
    (store / "0af3").write_text(box_file().gltf("box.bin"))
    (store / "91c7").write_bytes(box_file().bytes)
    (model / "box.gltf").symlink_to("../store/0af3")
    (model / "box.bin").symlink_to("../store/91c7")
    assert np.array_equal(world(ep.load_model(model / "box.gltf"))["box"], world(loaded(tmp_path, box_file()))["box"])


@pytest.mark.parametrize("uri", ["gone.bin", "a" * 300, "box.gltf/box.bin", "loop", "."])
def test_bytes_that_cannot_be_read_are_named(tmp_path, uri):
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "box.gltf").write_text(box_file().gltf(uri))
    with pytest.raises(ep.FileError, match=re.escape(str(tmp_path))):
        ep.load_model(tmp_path / "box.gltf")


@pytest.mark.parametrize("extension, ahead", [("VRM", -1), ("VRMC_vrm", 1)])
def test_figures_of_vrm_look_along_x(tmp_path, extension, ahead):
    """VRM 0.0: "Model faces towards -Z direction"; VRM 1.0, definition 1.1: "standing straight toward the +Z axis"."""
    file = box_file(translation=[0.1, 0.0, 0.5 * ahead])
    file.json |= {"extensionsUsed": [extension], "extensions": {extension: {}}}
    (tmp_path / "figure.vrm").write_bytes(file.glb())
    points = world(ep.load_model(tmp_path / "figure.vrm")).popitem()[1]
    assert np.allclose(points, (BOX * [ahead, 1, ahead] + [0.1 * ahead, 0, 0.5])[:, TO_SCENE], atol=1e-6)
