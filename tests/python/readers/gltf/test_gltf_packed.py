"""glTF files packed by Draco and by meshoptimizer, made by the encoders of these, against the numbers that were packed."""
from __future__ import annotations

import sys

import numpy as np
import pytest

import echopath as ep
from support.files.gltf_files import GltfFile, rig_file, tube
from support.files.packed_gltf import MESHOPT, TRIANGLES, VERTICES, draco_tube, meshopt_tube, pack_by_draco, pack_view

DRACO = "KHR_draco_mesh_compression"
BITS = 14
SINGLE = 1e-6  # m


def loaded(tmp_path, file: GltfFile, **options):
    (tmp_path / "packed.glb").write_bytes(file.glb())
    return ep.load_model(tmp_path / "packed.glb", **options)


def corners(mesh) -> np.ndarray:
    """[F, 9] corners of each triangle in m, begun at the least one, in some order of the triangles."""
    points = np.round(mesh.vertices[mesh.triangles], 9)
    rows = [np.roll(triangle, -int(np.lexsort(triangle.T[::-1])[0]), axis=0).ravel() for triangle in points]
    return np.array(sorted(map(tuple, rows)))


# --- Draco ---

def test_a_draco_mesh_is_the_mesh_that_was_packed_to_its_quantisation(tmp_path):
    wanted = corners(ep.Mesh(VERTICES[:, [2, 0, 1]].astype(np.float32), TRIANGLES))
    mesh = loaded(tmp_path, draco_tube(quantization_bits=BITS)).nodes[0].mesh
    step = np.ptp(VERTICES, axis=0).max() / (2**BITS - 1)
    nearest = np.linalg.norm(mesh.vertices[:, None] - VERTICES[:, [2, 0, 1]][None], axis=2).min(axis=1)
    assert len(mesh.vertices) == len(VERTICES) and len(mesh.triangles) == len(TRIANGLES)
    assert 0.0 < nearest.max() < step and mesh.area == pytest.approx(0.5 * sum(
        np.linalg.norm(np.cross(t[3:6] - t[:3], t[6:] - t[:3])) for t in wanted), rel=1e-3)


def test_a_skinned_draco_mesh_moves_as_the_unpacked_one(tmp_path):
    plain, packed = rig_file(), rig_file()
    vertices, triangles = tube()
    upper = np.clip(vertices[:, 1] - 0.5, 0.0, 1.0)
    joints = np.tile(np.array([0, 1, 0, 0], np.uint8), (len(vertices), 1))
    weights = np.stack([1 - upper, upper, 0 * upper, 0 * upper], axis=1).astype(np.float32)
    pack_by_draco(packed, vertices, triangles, {"JOINTS_0": joints, "WEIGHTS_0": weights}, quantization_bits=24)
    for time in (0.0, 0.4, 1.0):
        posed = []
        for file in (plain, packed):
            scene = ep.Scene()
            scene.add(loaded(tmp_path, file), name="m")
            posed.append(np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes]))
        distance = np.linalg.norm(posed[0][:, None] - posed[1][None], axis=2)
        assert distance.min(axis=0).max() < 2 * SINGLE and distance.min(axis=1).max() < 2 * SINGLE


@pytest.mark.parametrize("change, said", [
    (lambda packed: packed["attributes"].update(POSITION=77), r"attributes\.POSITION: names the attribute 77, which the"),
    (lambda packed: packed.update(bufferView=9), r"KHR_draco_mesh_compression\.bufferView: must be a whole number from 0"),
])
def test_faults_of_draco_meshes_are_told_with_their_places(tmp_path, change, said):
    file = draco_tube()
    change(file.json["meshes"][0]["primitives"][0]["extensions"][DRACO])
    with pytest.raises(ep.FileError, match=said):
        loaded(tmp_path, file)


def test_draco_meshes_that_do_not_fit_their_accessors_or_are_none_are_refused(tmp_path):
    file = draco_tube()
    file.json["accessors"][0]["count"] += 1
    with pytest.raises(ep.FileError, match=r"accessors\[0\]\.count: is 721 of VEC3, where .*POSITION has entries \[720, 3\]"):
        loaded(tmp_path, file)
    file = draco_tube()
    file.bytes = file.bytes[:-400] + bytes(400)
    with pytest.raises(ep.FileError, match="KHR_draco_mesh_compression: is no Draco mesh"):
        loaded(tmp_path, file)
    file = draco_tube()
    file.json["meshes"][0]["primitives"][0]["mode"] = 5
    with pytest.raises(ep.FileError, match="is packed by KHR_draco_mesh_compression, which is not read but for triangles"):
        loaded(tmp_path, file)


# --- meshoptimizer ---

def test_a_meshopt_mesh_is_the_mesh_that_was_packed_to_the_last_bit(tmp_path):
    mesh = loaded(tmp_path, meshopt_tube()).nodes[0].mesh
    assert np.array_equal(corners(mesh), corners(ep.Mesh(VERTICES[:, [2, 0, 1]].astype(np.float32), TRIANGLES)))
    assert np.array_equal(mesh.vertices, VERTICES[:, [2, 0, 1]].astype(np.float32))


def test_sequences_of_corners_and_quantised_rows_are_unpacked(tmp_path):
    steps = np.round(VERTICES * 10_000).astype(np.int16)
    file = GltfFile(nodes=[{"mesh": 0, "scale": [1e-4] * 3}], extensionsRequired=[MESHOPT, "KHR_mesh_quantization"])
    file.mesh(file.accessor(steps, "i2", stride=8), TRIANGLES)
    pack_view(file, 0, np.concatenate([steps, 0 * steps[:, :1]], axis=1))
    pack_view(file, 1, TRIANGLES.astype(np.uint32).ravel(), byteStride=2, mode="INDICES")
    model = loaded(tmp_path, file)
    assert np.array_equal(model.nodes[0].mesh.vertices, steps[:, [2, 0, 1]])


def test_filters_are_undone_as_the_extension_says(tmp_path):
    """EXPONENTIAL: a number is a mantissa of 24 bits times two to an exponent of 8, both with a sign."""
    mantissa = np.round(VERTICES * 2**12).astype(np.int64)
    words = ((-12 & 0xFF) << 24 | (mantissa & 0xFFFFFF)).astype(np.uint32)
    file = GltfFile(nodes=[{"mesh": 0}], extensionsRequired=[MESHOPT])
    file.mesh(VERTICES, TRIANGLES)
    pack_view(file, 0, words, filter="EXPONENTIAL")
    mesh = loaded(tmp_path, file).nodes[0].mesh
    assert np.array_equal(mesh.vertices, (mantissa / 2**12)[:, [2, 0, 1]])


@pytest.mark.parametrize("change, said", [
    ({"mode": "LINES"}, "mode: must be ATTRIBUTES, TRIANGLES or INDICES, is 'LINES'"),
    ({"filter": "BLUR"}, "filter: must be NONE, or OCTAHEDRAL, QUATERNION, EXPONENTIAL for rows that it takes, is 'BLUR'"),
    ({"filter": "QUATERNION"}, "filter: must be NONE, or"), ({"byteStride": 6}, "byteStride: must be a multiple of 4, is 6"),
    ({"byteLength": 300}, "EXT_meshopt_compression: cannot be unpacked"), ({"count": 719}, "accessors.0.: ends at byte 8640"),
    ({"count": 2**31}, "needs more than 257 MiB of memory"),
    ({"byteLength": 10**7}, "byteLength: ends at byte"), ({"mode": "TRIANGLES"}, "must have indices of 2 or 4 bytes"),
    ({"buffer": 2}, "buffer: must be a whole number from 0 to 1, is 2"),
])
def test_faults_of_packed_views_are_told_with_their_places(tmp_path, change, said):
    file = meshopt_tube()
    file.json["bufferViews"][0]["extensions"][MESHOPT] |= change
    with pytest.raises(ep.FileError, match=rf"bufferViews\[0\]\.extensions\.EXT_meshopt.*{said}|{said}"):
        loaded(tmp_path, file)


@pytest.mark.parametrize("library, extra, make", [("DracoPy", "gltf", draco_tube), ("meshoptimizer", "meshopt", meshopt_tube)])
def test_what_to_install_is_said_without_the_library(tmp_path, monkeypatch, library, extra, make):
    file = make()
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ModuleNotFoundError, match=rf"needs {library}, which is not installed: pip install 'echopath\[{extra}\]'"):
        loaded(tmp_path, file)
