"""Normals in a file make a mesh smooth by one rule, whatever the format, and cut it where they say that there is an edge."""
from __future__ import annotations

import struct

import numpy as np
import pytest

import echopath as ep
from fuzz.feeds.foreign_seeds import archive
from support.files.gltf_files import GltfFile
from support.files.mesh_texts import usd_mesh

POINT, POWER = 1e-6, 1e-5  # m, and of the greatest power of a path: normals of files are single numbers, of 6 digits in texts
DEFORMING = 1e-5           # m, of hits on meshes that have a motion of their vertices, if one that stands still
FROM_SCENE = [1, 2, 0]     # axes of a scene that become x, y and z of a glTF file
ROUGH = ep.Material(permittivity=5.0, scattering=0.7)
AROUND = 24                # turns of 15 degrees, and one of 25 between the side and the shoulder: below the crease guard
PROFILE = [(1.0, 0.0), (1.0, 1.2), (1.0 - 0.5 * np.tan(np.radians(25.0)), 1.7)]  # (radius, height) m: side and shoulder

pytestmark = pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")


def tin() -> tuple:
    """(vertices [V, 3] that floats hold, faces [F, 3], normals [F, 3, 3], group of each face) of a tin with a flat lid."""
    angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    up = np.array([0.0, 0.0, 1.0])
    vertices = np.concatenate([radius * circle + height * up for radius, height in PROFILE] + [[PROFILE[-1][1] * up]])
    first, after = np.arange(AROUND), (np.arange(AROUND) + 1) % AROUND
    faces, normals = [], []
    for ring, tilt in ((0, 0.0), (1, np.radians(25.0))):
        low, high = ring * AROUND, (ring + 1) * AROUND
        outward = np.cos(tilt) * circle + np.sin(tilt) * up
        for a, b in zip(first, after):
            faces += [[low + a, low + b, high + b], [low + a, high + b, high + a]]
            normals += [outward[[a, b, b]], outward[[a, b, a]]]
    faces += [[2 * AROUND + a, 2 * AROUND + b, 3 * AROUND] for a, b in zip(first, after)]
    normals += [[up, up, up]] * AROUND
    group = np.repeat([1, 2, 3], [2 * AROUND, 2 * AROUND, AROUND])
    return vertices.astype(np.float32).astype(float), np.array(faces), np.array(normals), group


VERTICES, FACES, NORMALS, GROUP = tin()
CORNERS = VERTICES[FACES].reshape(-1, 3)             # as formats with one normal for each vertex have it
OWN = np.arange(len(CORNERS)).reshape(-1, 3)


def obj(faces, lines) -> bytes:
    vertices = [f"v {x!r} {y!r} {z!r}" for x, y, z in VERTICES.tolist()]
    return "\n".join([*vertices, "g tin", *lines, *faces, ""]).encode()


def obj_normals() -> bytes:
    faces = [f"f {a + 1}//{3 * i + 1} {b + 1}//{3 * i + 2} {c + 1}//{3 * i + 3}" for i, (a, b, c) in enumerate(FACES.tolist())]
    return obj(faces, [f"vn {x:.6f} {y:.6f} {z:.6f}" for x, y, z in NORMALS.reshape(-1, 3).tolist()])


def obj_groups() -> bytes:
    return obj([f"s {group}\nf {a + 1} {b + 1} {c + 1}" for group, (a, b, c) in zip(GROUP, FACES.tolist())], [])


def ply() -> bytes:
    words = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(CORNERS)}\n{words}element face {len(OWN)}\n"
            "property list uchar int vertex_indices\nend_header\n")
    rows = np.column_stack([CORNERS, NORMALS.reshape(-1, 3)]).astype("<f4")
    return head.encode() + rows.tobytes() + b"".join(struct.pack("<B3i", 3, *face) for face in OWN.tolist())


def glb() -> bytes:
    file = GltfFile(nodes=[{"name": "tin", "mesh": 0}], scenes=[{"nodes": [0]}])
    file.mesh(CORNERS[:, FROM_SCENE], OWN, NORMAL=file.accessor(NORMALS.reshape(-1, 3)[:, FROM_SCENE]))
    return file.glb()


def usda() -> bytes:
    values = ", ".join(f"({x!r}, {y!r}, {z!r})" for x, y, z in NORMALS.reshape(-1, 3).tolist())
    mesh = usd_mesh(VERTICES, FACES, "tin").replace("{\n", f"""{{
    uniform token subdivisionScheme = "none"
    normal3f[] normals = [{values}] (
        interpolation = "faceVarying"
    )
""", 1)
    return f'#usda 1.0\n(\n    metersPerUnit = 1\n    upAxis = "Z"\n)\n{mesh}'.encode()


def usda_with_dropped_faces() -> bytes:
    """The same behind an edge and a hole, which are no faces, and whose normals tell nothing."""
    text, counts = usda().decode(), "    int[] faceVertexCounts = ["
    more = {counts: "2, 3, ", "faceVertexIndices = [": "0, 1, 3, 9, 30, ",
            "normals = [": "(1, 0, 0), (0, 0, -1), (0, 0, 1), (0, -1, 0), (-1, 0, 0), "}
    for name, values in more.items():
        text = text.replace(name, name + values, 1)
    return text.replace(counts, f"    int[] holeIndices = [1]\n{counts}").encode()


def write_all(folder) -> list:
    files = {"normals.obj": obj_normals, "groups.obj": obj_groups, "tin.ply": ply, "tin.glb": glb, "tin.usda": usda}
    for name, content in files.items():
        (folder / name).write_bytes(content())
    (folder / "tin.xml").write_text('<scene version="3.0.0"><shape type="ply" id="tin"><string name="filename" value="tin.ply"/>'
                                    "</shape></scene>")
    return [folder / name for name in (*files, "tin.xml")]


def echoes(model) -> tuple:
    """(points of hits [H, 3] m, powers [P]) of one trace."""
    scene = ep.Scene()
    scene.add(model, name="m", position=(6.0, 0.7, -0.4), yaw=0.4)
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=5e6, num_chirps=4,
                                chirp_interval=1e-4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0, 1.1))])
    paths = ep.trace(scene, radar, num_rays=2000, seed=5)
    return paths.points(0.0), np.abs(paths.amplitude) ** 2


def wanted(smooth: bool = True) -> tuple:
    """Side, shoulder and lid as sheets of their own, within each of which normals are interpolated."""
    used = [np.unique(FACES[GROUP == group]) for group in (1, 2, 3)]
    begin = np.cumsum([0, *map(len, used)])
    faces = np.concatenate([begin[i] + np.searchsorted(used[i], FACES[GROUP == i + 1]) for i in range(3)])
    mesh = ep.Mesh(VERTICES[np.concatenate(used)], faces)
    return echoes(ep.Model((ep.ModelNode("tin", mesh=mesh, material=ROUGH, smooth=smooth),)))


def assert_same(name: str, found: tuple, expected: tuple, point: float = POINT) -> None:
    for ours, theirs, tolerance in zip(found, expected, (point, POWER * expected[1].max())):
        assert ours.shape == theirs.shape and np.abs(ours - theirs).max() < tolerance, name


def test_normals_of_every_format_make_the_same_smooth_surface_with_the_same_edges(tmp_path):
    expected, faceted = wanted(), wanted(smooth=False)
    assert len(expected[1]) > 300
    assert expected[1].shape != faceted[1].shape or np.abs(expected[1] - faceted[1]).max() > 0.01 * expected[1].max()
    for path in write_all(tmp_path):
        model = ep.load_model(path, materials={"*": ROUGH})
        assert [node.smooth for node in model.nodes] == [True], path.name
        assert_same(path.name, echoes(model), expected)


def test_normals_of_faces_that_are_dropped_are_dropped_with_them(tmp_path):
    meshes = []
    for name, content in (("whole", usda), ("more", usda_with_dropped_faces)):
        (tmp_path / f"{name}.usda").write_bytes(content())
        (node,) = ep.load_model(tmp_path / f"{name}.usda", materials={"*": ROUGH}).nodes
        meshes.append((node.mesh.vertices, node.mesh.triangles, node.smooth))
    rings = 4 * AROUND + AROUND + 1  # sides and lid are cut from the shoulder, so that its two rings are there twice
    for ours, theirs in zip(*meshes):
        np.testing.assert_array_equal(ours, theirs)
    assert len(meshes[1][0]) == rings and meshes[1][2]


def test_a_mitsuba_shape_may_ask_for_facets(tmp_path):
    (tmp_path / "tin.ply").write_bytes(ply())
    text = ('<scene version="3.0.0"><shape type="ply" id="tin"><string name="filename" value="tin.ply"/>'
            '<boolean name="face_normals" value="FACETS"/></shape></scene>')
    for word, smooth in (("true", False), ("false", True)):
        (tmp_path / "tin.xml").write_text(text.replace("FACETS", word))
        assert [node.smooth for node in ep.load_model(tmp_path / "tin.xml").nodes] == [smooth]


def test_frames_are_smooth_as_the_normals_of_the_first_one_say(tmp_path):
    expected = wanted()
    for name, content in (("normals", obj_normals()), ("groups", obj_groups())):
        (tmp_path / name).mkdir()
        for number in (1, 2):
            (tmp_path / name / f"f{number}.obj").write_bytes(content)
    _, place = np.unique(np.column_stack([CORNERS, np.round(NORMALS.reshape(-1, 3), 9)]), axis=0, return_inverse=True)
    first = np.unique(place, return_index=True)[1]
    arrays = {"vertices": np.stack([CORNERS[first]] * 2), "triangles": place.reshape(-1, 3)}
    (tmp_path / "tin.npz").write_bytes(archive(**arrays, normals=NORMALS.reshape(-1, 3)[first]))
    (tmp_path / "plain.npz").write_bytes(archive(**arrays))
    for name in ("normals", "groups", "tin.npz"):
        model = ep.load_model(tmp_path / name, materials={"*": ROUGH})
        assert [node.smooth for node in model.nodes] == [True], name
        assert_same(name, echoes(model), expected, DEFORMING)
    plain = ep.load_model(tmp_path / "plain.npz")
    assert not plain.nodes[0].smooth and any("unless smooth=True" in note for note in plain.notes)
    asked = ep.load_model(tmp_path / "plain.npz", smooth=True)
    assert asked.nodes[0].smooth and not any("smooth" in note for note in asked.notes)


def test_flat_normals_leave_facets_and_the_keyword_goes_before_the_file(tmp_path):
    sides = [VERTICES[FACES[:, k]] - VERTICES[FACES[:, 0]] for k in (1, 2)]
    flat = [f"vn {x:.6f} {y:.6f} {z:.6f}" for x, y, z in np.cross(*sides)]
    faces = [f"f {a + 1}//{i + 1} {b + 1}//{i + 1} {c + 1}//{i + 1}" for i, (a, b, c) in enumerate(FACES.tolist())]
    (tmp_path / "flat.obj").write_bytes(obj(faces, flat))
    (tmp_path / "round.obj").write_bytes(obj_normals())
    load = lambda name, **options: ep.load_model(tmp_path / name, **options).nodes[0].smooth
    assert not load("flat.obj") and load("flat.obj", smooth=True)
    assert load("round.obj") and not load("round.obj", smooth=False)
    with pytest.raises(TypeError, match="smooth: must be"):
        load("flat.obj", smooth="yes")


def cylinder_file(segments: int, dtype: str) -> GltfFile:
    """A cylinder about y with its exact normals, rounded to a type."""
    angle = 2.0 * np.pi * np.arange(segments) / segments
    normals = np.tile(np.column_stack([np.sin(angle), 0.0 * angle, np.cos(angle)]), (2, 1))
    low, after = np.arange(segments), (np.arange(segments) + 1) % segments
    faces = np.column_stack([low, after, after + segments, low, after + segments, low + segments]).reshape(-1, 3)
    file = GltfFile(nodes=[{"name": "pole", "mesh": 0}], scenes=[{"nodes": [0]}])
    rounded = np.round(127 * normals).astype(np.int8) if dtype == "i1" else normals
    file.mesh(normals + np.repeat([[0, 0, 0], [0, 1, 0]], segments, axis=0), faces,
              NORMAL=file.accessor(rounded, dtype, normalized=dtype == "i1"))
    return file


@pytest.mark.parametrize("segments, dtype, smooth", [(365, "f4", True), (3500, "f4", True), (3700, "f4", False), (60, "i1", True),
                                                     (720, "i1", False)])
def test_fine_cylinders_are_smooth_as_far_as_their_normals_tell(tmp_path, segments, dtype, smooth):
    """Turns of a segment are 360 degrees over their number."""
    (tmp_path / "pole.glb").write_bytes(cylinder_file(segments, dtype).glb())
    assert [node.smooth for node in ep.load_model(tmp_path / "pole.glb").nodes] == [smooth]
