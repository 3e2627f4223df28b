"""Mitsuba's own mesh files: written here by its documentation."""
from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest

import echopath as ep

ROUNDING = 1e-12
# A pyramid: a square of 2 m and a tip 1 m above its middle.
VERTICES = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [0, 0, 1]], float)
TRIANGLES = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
NORMALS, TEXTURE, COLOURS, FACETED, SINGLE, DOUBLE = 0x1, 0x2, 0x8, 0x10, 0x1000, 0x2000


def packed(vertices, triangles, *, version: int = 4, flags: int = SINGLE, name: str = "pyramid", normals=None) -> bytes:
    """One mesh as the documentation of Mitsuba 0.6 has it, without the table at the end of a file."""
    number = "<f8" if flags & DOUBLE else "<f4"
    stream = struct.pack("<I", flags) + (name.encode() + b"\0" if version == 4 else b"")
    stream += struct.pack("<QQ", len(vertices), len(triangles)) + np.asarray(vertices, number).tobytes()
    if flags & NORMALS:
        stream += np.asarray(normals, number).tobytes()
    stream += np.zeros((len(vertices), 2), number).tobytes() if flags & TEXTURE else b""
    stream += np.ones((len(vertices), 3), number).tobytes() if flags & COLOURS else b""
    return struct.pack("<HH", 0x041C, version) + zlib.compress(stream + np.asarray(triangles, "<u4").tobytes())


def file_of(*meshes: bytes, version: int = 4) -> bytes:
    begins = np.cumsum([0, *(len(mesh) for mesh in meshes[:-1])])
    return b"".join(meshes) + begins.astype("<u8" if version == 4 else "<u4").tobytes() + struct.pack("<I", len(meshes))


def scene_of(tmp_path, content: bytes, more: str = "", **options) -> ep.Scene:
    (tmp_path / "some.serialized").write_bytes(content)
    (tmp_path / "scene.xml").write_text('<scene version="0.6.0"><shape type="serialized"><string name="filename" '
                                        f'value="some.serialized"/>{more}</shape></scene>')
    scene = ep.Scene()
    scene.add(ep.load_model(tmp_path / "scene.xml", **options), name="m")
    return scene


@pytest.mark.parametrize("flags", [SINGLE, DOUBLE, SINGLE | TEXTURE | COLOURS])
@pytest.mark.parametrize("version", [3, 4])
def test_meshes_of_all_versions_and_precisions(tmp_path, version, flags):
    scene = scene_of(tmp_path, file_of(packed(VERTICES, TRIANGLES, version=version, flags=flags), version=version))
    assert np.array_equal(scene.world_vertices(0), VERTICES) and np.array_equal(scene.meshes[0].mesh.triangles, TRIANGLES)


def test_the_index_of_a_shape_chooses_its_mesh(tmp_path):
    content = file_of(packed(VERTICES, TRIANGLES), packed(3.0 * VERTICES, TRIANGLES))
    for index, scale in (("0", 1.0), ("1", 3.0)):
        scene = scene_of(tmp_path, content, f'<integer name="shape_index" value="{index}"/>', unit=0.5)
        assert np.allclose(scene.world_vertices(0), 0.5 * scale * VERTICES, atol=ROUNDING)


@pytest.mark.parametrize("flags, more, is_smooth", [
    (NORMALS, "", True), (NORMALS | FACETED, "", False), (0, "", False),
    (NORMALS, '<boolean name="face_normals" value="true"/>', False)])
def test_normals_of_vertices_make_curved_surfaces(tmp_path, flags, more, is_smooth):
    ball = ep.actors.sphere(1.0)
    directions = np.asarray(ball.vertices) / np.linalg.norm(ball.vertices, axis=1)[:, None]
    content = file_of(packed(ball.vertices, ball.triangles, flags=SINGLE | flags, normals=directions))
    assert scene_of(tmp_path, content, more).nodes[-1].smooth == is_smooth


PYRAMID = packed(VERTICES, TRIANGLES)
# Of a hundred bytes that say that 2^60 vertices follow, none is made room for.
BOASTS = struct.pack("<HH", 0x041C, 4) + zlib.compress(struct.pack("<I", SINGLE) + b"\0" + struct.pack("<QQ", 2**60, 1))
WRONG = {
    "is cut off": b"", "is no serialized mesh of Mitsuba: has 0x6c70 at byte 0": b"ply\nformat",
    "must have numbers of single or of double precision": file_of(packed(VERTICES, TRIANGLES, flags=SINGLE | DOUBLE)),
    "must have indices below 5, the number of its vertices, has 5": file_of(packed(VERTICES, [[0, 1, 5]])),
    "must be of version 3 or 4, is of version 5": file_of(PYRAMID).replace(b"\x1c\x04\x04", b"\x1c\x04\x05"),
    "mesh 0 must begin within the file": PYRAMID + struct.pack("<QI", 10**9, 1),
    "must end with where its meshes begin": PYRAMID + struct.pack("<QI", 0, 0),
    "must have finite positions": file_of(packed(np.full((5, 3), np.nan), TRIANGLES)),
    "is cut off: .* bytes are not in what is left of it": file_of(BOASTS)}


@pytest.mark.parametrize("told", WRONG)
def test_wrong_files_are_refused_by_name(tmp_path, told):
    with pytest.raises(ep.FileError, match=f"scene.xml, line 1: <shape>: .*some.serialized: {told}"):
        scene_of(tmp_path, WRONG[told])


@pytest.mark.parametrize("index", ["1", "-1", "0.5"])
def test_wrong_indices_are_refused(tmp_path, index):
    with pytest.raises(ep.FileError, match="shape_index must be"):
        scene_of(tmp_path, file_of(packed(VERTICES, TRIANGLES)), f'<integer name="shape_index" value="{index}"/>')
