"""Copies of a mesh by EXT_mesh_gpu_instancing against its definition: node times translation, rotation and scale."""
from __future__ import annotations

import importlib

import numpy as np
import pytest

import echopath as ep
from support.files.gltf_files import BOX, GltfFile, box_file, loaded

READ = importlib.import_module("echopath.readers.gltf.read")  # the package has a function of that name
TO_SCENE = [2, 0, 1]  # axes of a file, y up, that become x, y and z
SINGLE = 1e-5         # of places of about 10 m in single precision
EXTENSION = "EXT_mesh_gpu_instancing"
HALF = np.sqrt(0.5)
SHIFTS = np.array([[1, 2, 3], [0, 5, 0], [-4, 0, 1.0]])
TURNS = np.array([[0, 0, 0, 1], [0, 0, HALF, HALF], [HALF, 0, 0, HALF]])  # (x, y, z, w): none, about z, about x
SCALES = np.array([[1, 1, 1], [2, 1, 0.5], [1, -1, 3.0]])
MATRICES = np.array([np.eye(3), [[0, -1, 0], [1, 0, 0], [0, 0, 1]], [[1, 0, 0], [0, 0, -1], [0, 1, 0]]])  # of TURNS


def forest(**attributes) -> GltfFile:
    """A box at (0, 10, 0), turned by half a turn about y, with copies; attributes: values, or (values, dtype, normalized)."""
    file = box_file(translation=[0, 10, 0], rotation=[0, 1, 0, 0])
    made = {}
    for name, value in attributes.items():
        values, dtype, normalized = value if isinstance(value, tuple) else (value, "f4", False)
        made[name] = file.accessor(values, dtype, normalized=normalized)
    file.json["nodes"][0]["extensions"] = {EXTENSION: {"attributes": made}}
    file.json |= {"extensionsUsed": [EXTENSION], "extensionsRequired": [EXTENSION]}
    return file


def wanted(copy: int, scaled: bool = True) -> np.ndarray:
    points = BOX * SCALES[copy] if scaled else BOX
    points = points @ MATRICES[copy].T + SHIFTS[copy]
    return (points * [-1, 1, -1] + [0, 10, 0])[:, TO_SCENE]


def vertices(model) -> dict:
    scene = ep.Scene()
    scene.add(model, name="m")
    return {mesh.name: scene.world_vertices(mesh.id, 0.0) for mesh in scene.meshes}


def test_copies_stand_where_the_extension_says_below_their_node(tmp_path):
    model = loaded(tmp_path, forest(TRANSLATION=SHIFTS, ROTATION=TURNS, SCALE=SCALES))
    found = vertices(model)
    assert list(found) == ["m/box/box_0", "m/box/box_1", "m/box/box_2"]
    for copy, points in enumerate(found.values()):
        assert np.abs(points - wanted(copy)).max() < SINGLE
    meshes = [node.mesh for node in model.nodes if node.mesh is not None]
    assert meshes[0] is meshes[1] is meshes[2] and not any("cop" in note for note in model.notes)


def test_rotations_may_be_normalised_bytes_and_what_is_missing_stays_at_rest(tmp_path):
    bytes_of = np.round(127 * TURNS[[0, 1]]).astype(np.int8)
    found = vertices(loaded(tmp_path, forest(TRANSLATION=SHIFTS[:2], ROTATION=(bytes_of, "i1", True))))
    for copy, points in enumerate(found.values()):
        assert np.abs(points - wanted(copy, scaled=False)).max() < SINGLE
    assert list(vertices(loaded(tmp_path, forest()))) == ["m/box"]


def test_children_of_a_node_are_not_copied_with_it(tmp_path):
    file = forest(TRANSLATION=SHIFTS)
    file.json["nodes"][0]["children"] = [1]
    file.json["nodes"].append({"name": "bird", "mesh": 0})
    assert sorted(vertices(loaded(tmp_path, file))) == ["m/box/bird", "m/box/box_0", "m/box/box_1", "m/box/box_2"]


def test_copies_that_cannot_be_are_told(tmp_path):
    nothing = SCALES * [[1], [0], [1]]
    model = loaded(tmp_path, forest(TRANSLATION=SHIFTS, SCALE=nothing))
    assert list(vertices(model)) == ["m/box/box_0", "m/box/box_2"]
    assert any("a copy that is scaled to nothing is left out" in note for note in model.notes)
    with pytest.raises(ep.FileError, match="attributes: must have as many entries in each accessor, has 3 in TRANSLATION, 2 in"):
        loaded(tmp_path, forest(TRANSLATION=SHIFTS, SCALE=SCALES[:2]))
    with pytest.raises(ep.FileError, match="ROTATION: must hold unit quaternions"):
        loaded(tmp_path, forest(ROTATION=4 * TURNS))


@pytest.mark.parametrize("count, place", [(2_000_000_000, "count"), (3_000_000, "attributes")])
def test_many_copies_of_a_small_file_are_refused_before_they_are_made(tmp_path, count, place):
    """Accessors without bytes are all zeros: 2e9 entries do not fit themselves, 3e6 do, but their transforms do not."""
    file = forest(TRANSLATION=SHIFTS)
    accessor = file.json["accessors"][-1]
    del accessor["bufferView"]
    accessor["count"] = count
    with pytest.raises(ep.FileError, match=f"{place}: needs more than .* MiB of memory, too much for a file"):
        loaded(tmp_path, file)


def test_nodes_are_limited_with_all_copies(tmp_path, monkeypatch):
    monkeypatch.setattr(READ, "MAX_NODES", 4)
    assert len(vertices(loaded(tmp_path, forest(TRANSLATION=SHIFTS)))) == 3
    monkeypatch.setattr(READ, "MAX_NODES", 3)
    with pytest.raises(ep.FileError, match="nodes: must make 3 nodes of a scene at most, with all copies"):
        loaded(tmp_path, forest(TRANSLATION=SHIFTS))
