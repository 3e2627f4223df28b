"""Foreign files as models: the same mesh through every format gives the same hits; motions and materials of USD and frames."""
from __future__ import annotations

import shutil
import sys

import numpy as np
import pytest

import echopath as ep
from fuzz.feeds.foreign_seeds import USD, archive
from support.files.mesh_texts import npz, obj, off, ply, stl, stl_text, usda

SPHERE = ep.actors.sphere(0.5, subdivisions=4)
VERTICES = SPHERE.vertices.astype(np.float32).astype(float)  # what every format can hold
ROUNDING = 1e-12
SINGLE = 1e-6  # m, of coordinates of a few metres that USD keeps in float


WRITERS = {".obj": obj, ".ply": ply, ".stl": stl, "_text.stl": stl_text, ".off": off, ".usda": usda, ".npz": npz}


def hits_of(model, radar) -> tuple:
    scene = ep.Scene()
    scene.add(model, name="ball", position=(4, 0.3, 0.2))
    assert not any(node.smooth for node in model.nodes)
    paths = ep.trace(scene, radar, num_rays=400)
    return paths.hits.tobytes(), paths.offsets.tobytes(), scene.num_triangles


@pytest.fixture(scope="module")
def radar():
    waveform = ep.ChirpSequence(start_frequency=10e9, bandwidth=1e9, num_samples=64, sampling_rate=5e6, num_chirps=4,
                                chirp_interval=1e-4)
    return ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


@pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")
def test_one_mesh_gives_the_same_hits_through_every_format(tmp_path, radar):
    """A sharp-edged ball, whose coordinates floats hold, against the Mesh of its own arrays."""
    faces = SPHERE.triangles.astype(np.int64)
    (tmp_path / "mesh.ply").write_bytes(ply(VERTICES, faces))
    (tmp_path / "scene.xml").write_text('<scene version="3.0.0"><shape type="ply"><string name="filename" value="mesh.ply"/>'
                                        "</shape></scene>")
    wanted = ep.Model((ep.ModelNode("ball", mesh=ep.Mesh(VERTICES, faces), material="metal"),))
    models = {"scene.xml": ep.load_model(tmp_path / "scene.xml", materials={"*": "metal"})}
    for suffix, write in WRITERS.items():
        (tmp_path / f"ball{suffix}").write_bytes(write(VERTICES, faces))
        models[suffix] = ep.load_model(tmp_path / f"ball{suffix}", materials={"*": "metal"})
    first = hits_of(wanted, radar)
    assert len(first[0]) > 0
    for name, model in models.items():
        assert hits_of(model, radar) == first, name


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".off", ".npz", ".usda"])
def test_units_and_vertical_axes_turn_every_format_alike(tmp_path, suffix):
    vertices, faces = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0.0]]), np.array([[0, 1, 2]])
    (tmp_path / f"a{suffix}").write_bytes(WRITERS[suffix](vertices, faces))
    model = ep.load_model(tmp_path / f"a{suffix}", unit=0.01, up="y")
    # y of the file is up, its x to the left, its z ahead
    assert np.allclose(sorted(model.nodes[0].mesh.vertices.tolist()), sorted([[0, 0, 0], [0, 0.01, 0], [0, 0, 0.02]]), atol=1e-15)
    assert (model.unit, model.up) == (0.01, "y")


def test_groups_of_an_obj_are_taken_apart_by_material(tmp_path):
    (tmp_path / "house.mtl").write_text("newmtl brick wall\nKd 1 0 0\n")
    (tmp_path / "house.obj").write_text("mtllib house.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng wall\n"
                                        "usemtl brick wall\nf 1 2 3\nusemtl window\nf 1 3 4\ng door\nusemtl oak\nf 1 2 4\n")
    model = ep.load_model(tmp_path / "house.obj")
    scene = ep.Scene()
    scene.add(model, name="house")
    assert [(mesh.name, mesh.material_name) for mesh in scene.meshes] == [
        ("house/wall/brick wall", "brick"), ("house/wall/window", "glass"), ("house/door", "wood")]
    assert any("gone.mtl" in note for note in model.notes)
    assert [name for name, _ in ep.load_meshes(tmp_path / "house.obj")] == ["wall", "door"]


def test_a_material_file_is_found_where_windows_says(tmp_path):
    (tmp_path / "look").mkdir()
    (tmp_path / "look/my house.mtl").write_text("newmtl oak\n")
    (tmp_path / "a.obj").write_text("mtllib look\\my house.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl oak\nf 1 2 3\n")
    assert ep.load_model(tmp_path / "a.obj").notes == ()


@pytest.mark.parametrize("read, name", [
    *((ep.load_model, f"a.{suffix}") for suffix in ("glb", "obj", "ply", "stl", "off", "usda", "npz", "bvh", "xml")),
    (ep.load_mesh, "a.obj"), (ep.load_meshes, "a.stl"), (ep.read_trajectories, "a.gpx")])
def test_a_pointer_of_git_lfs_is_told_as_such(tmp_path, read, name):
    """As its specification says, a pointer begins with the version of that."""
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"
    (tmp_path / name).write_text(pointer)
    with pytest.raises(ep.FileError, match="is a pointer of Git LFS, not the file itself"):
        read(tmp_path / name)


def test_a_shape_of_mitsuba_that_is_a_pointer_is_told_as_such(tmp_path):
    """Its faces had been taken to be none."""
    (tmp_path / "a.obj").write_text("version https://git-lfs.github.com/spec/v1\n")
    shape = '<shape type="obj"><string name="filename" value="a.obj"/></shape>'
    (tmp_path / "a.xml").write_text(f'<scene version="3.0.0">{shape}</scene>')
    with pytest.raises(ep.FileError, match=r"a\.xml, line 1: <shape>: .*a\.obj: is a pointer of Git LFS"):
        ep.load_model(tmp_path / "a.xml")


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_names_in_latin_1_are_those_of_the_mtl_file(tmp_path, end):
    (tmp_path / "house.mtl").write_bytes(f"# made{end}newmtl grün{end}Kd 0 1 0{end}".encode("latin-1"))
    text = "mtllib house.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\no Straße\nusemtl grün\nf 1 2 3\n"
    (tmp_path / "house.obj").write_bytes(text.encode("latin-1"))
    model = ep.load_model(tmp_path / "house.obj", materials={"grün": "wood"})
    assert [node.name for node in model.nodes] == ["Straße"] and model.notes == ()
    scene = ep.Scene()
    scene.add(model, name="a")
    assert scene.meshes[0].material_name == "wood"


def test_letters_and_marks_that_a_file_has_apart_are_those_that_a_keyboard_writes(tmp_path):
    """As names of macOS are; the parts of the letter look the same in every message."""
    apart = "gru\u0308n", "Ha\u0308user"
    text = f"v 5 0 0\nv 5 1 0\nv 5 1 1\no {apart[1]}\nusemtl {apart[0]}\nf 1 2 3\n"
    (tmp_path / f"{apart[1]}.obj").write_text(text, encoding="utf-8")
    model = ep.load_model(tmp_path / f"{apart[1]}.obj", materials={"gr\u00fcn": "wood"})
    assert not model.notes
    scene = ep.Scene()
    scene.add(model, name="town")
    ep.hits("town/H\u00e4user").check(scene)
    assert [(mesh.name, mesh.material_name) for mesh in scene.meshes] == [("town/H\u00e4user", "wood")]


@pytest.mark.parametrize("name, content", [("a.obj", b"v 0 0 \xca\n"), ("a.stl", b"solid a\nouter loop\nvertex 0 0 \xca\n"),
                                           ("a.off", b"OFF\n3 1 0\n0 0 \xca\n")])
def test_words_that_are_no_text_are_written_out_in_messages(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ep.FileError, match=r"a\..*, line \d: not a number: '.xca'"):
        ep.load_mesh(tmp_path / name)


def usd_scene(tmp_path, text: str, **options) -> tuple:
    (tmp_path / "stage.usda").write_text(text)
    model = ep.load_model(tmp_path / "stage.usda", **options)
    scene = ep.Scene()
    scene.add(model, name="stage")
    return model, scene


def test_a_usd_stage_gives_its_solids_subsets_instances_and_materials(tmp_path):
    model, scene = usd_scene(tmp_path, USD[0])
    materials = {mesh.name.removeprefix("stage/World/"): mesh.material_name for mesh in scene.meshes}
    assert materials["wall/pane"] == "glass" and materials["wall/rest"] == "concrete"
    assert [name for name in materials if name.startswith("trees")] == ["trees/tree_0/tree/crown", "trees/tree_1/tree/crown"]
    crowns = [mesh.mesh for mesh in scene.meshes if mesh.name.endswith("crown")]
    assert crowns[0] is crowns[1] or crowns[0] == crowns[1]
    assert (model.unit, model.up, model.animation, model.duration) == (0.01, "y", "timeline", 1.0)
    box = next(mesh for mesh in scene.meshes if mesh.name.endswith("box"))
    vertices = scene.world_vertices(box.id, 0.0)
    # at (0, 1, 2) cm with y up: 2 cm ahead and 1 cm high, sides of 2 cm
    assert np.allclose(vertices.min(axis=0), [0.01, -0.01, 0.0]) and np.allclose(vertices.max(axis=0), [0.03, 0.01, 0.02])


def test_a_usd_rotation_goes_round_between_its_samples_and_is_held_beyond(tmp_path):
    turning = """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Z"
    timeCodesPerSecond = 10
    startTimeCode = 0
    endTimeCode = 10
)
def Xform "rotor"
{
    float xformOp:rotateZ.timeSamples = { 0: 0, 10: 720, }
    uniform token[] xformOpOrder = ["xformOp:rotateZ"]
    def Mesh "blade"
    {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(1, 0, 0), (2, 0, 0), (1, 0, 1)]
    }
}
"""
    _, scene = usd_scene(tmp_path, turning)
    for time in (0.0, 0.11, 0.5, 0.77):
        angle = 2 * np.pi * 2 * time
        assert np.allclose(scene.world_vertices(0, time)[1], [2 * np.cos(angle), 2 * np.sin(angle), 0], atol=2e-3)
    assert np.allclose(scene.world_vertices(0, 5.0)[1], [2, 0, 0], atol=1e-9)
    _, looped = usd_scene(tmp_path, turning, loop=True, offset=0.25)
    for time in (0.0, 0.9, 7.3, 55.5):
        angle = 4 * np.pi * (time + 0.25)
        assert np.allclose(looped.world_vertices(0, time)[1], [2 * np.cos(angle), 2 * np.sin(angle), 0], atol=2e-3)
    _, resting = usd_scene(tmp_path, turning, animation="")
    assert np.allclose(resting.world_vertices(0, 0.3)[1], [2, 0, 0])
    with pytest.raises(ValueError, match="animation: must be 'timeline', got 'walk'"):
        usd_scene(tmp_path, turning, animation="walk")


def test_a_usd_skin_moves_as_the_library_of_usd_says(tmp_path):
    from pxr import Usd, UsdGeom, UsdSkel

    model, scene = usd_scene(tmp_path, USD[1])
    assert [type(node.deformation).__name__ for node in model.nodes if node.mesh] == ["Skin"]
    stage = Usd.Stage.Open(str(tmp_path / "stage.usda"))
    root, cache = UsdSkel.Root(stage.GetPrimAtPath("/person")), UsdSkel.Cache()
    cache.Populate(root, Usd.PrimDefaultPredicate)
    binding = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)[0]
    query, target = cache.GetSkelQuery(binding.GetSkeleton()), binding.GetSkinningTargets()[0]
    for code in (0.0, 2.5, 10.0):
        points = UsdGeom.Mesh(target.GetPrim()).GetPointsAttr().Get()
        assert target.ComputeSkinnedPoints(query.ComputeSkinningTransforms(code), points, code)
        ours = np.concatenate([scene.world_vertices(mesh.id, code / 24) for mesh in scene.meshes])
        wanted = 0.01 * np.array(points)
        assert np.allclose(sorted(set(map(tuple, np.round(ours, 7)))), sorted(map(tuple, wanted.astype(float))), atol=SINGLE)


@pytest.mark.parametrize("method, is_told", [("classicLinear", False), ("dualQuaternion", True)])
def test_a_usd_skin_of_dual_quaternions_is_told_to_be_taken_as_a_linear_one(tmp_path, method, is_told):
    said = f'uniform token primvars:skel:skinningMethod = "{method}"\n        int[] primvars:skel:jointIndices'
    assert USD[1].count("int[] primvars:skel:jointIndices") == 1
    model, _ = usd_scene(tmp_path, USD[1].replace("int[] primvars:skel:jointIndices", said))
    assert any("dual quaternions" in note for note in model.notes) is is_told


@pytest.mark.parametrize("text, message", [
    ("#usda 1.0\n(\n    timeCodesPerSecond = 0\n)\n", "must have timeCodesPerSecond other than 0"),
    ("#usda 1.0\ndef Mesh", "is no USD stage that can be read .*(?:stage.usda:2:|on line 2 )"),
])
def test_stages_that_cannot_be_read_are_refused_by_name(tmp_path, text, message):
    with pytest.raises(ep.FileError, match=f"stage.usda: .*{message}"):
        usd_scene(tmp_path, text)


@pytest.mark.parametrize("stage, change, note", [
    (0, ("int[] protoIndices = [0, 0]", "whole[] protoIndices = [0, 0]"), "point instancer /World/trees is left out"),
    (0, ("int[] indices = [1]", "whole[] indices = [1]"), "the mesh /World/wall is left out: it has indices of another type"),
    (0, ("double size = 2", 'text size = "2"'), "the mesh /World/box is left out: it has no number as its size"),
    (0, ("int[] faceVertexCounts = [4, 3]", "int[] faceVertexCounts = [4, 4]"), "has 7 corners, where its faces ask for 8"),
    (1, ("float[] primvars:skel:jointWeights = [1, 0,", "float[] primvars:skel:jointWeights = ["),
     "does not move with its skeleton"),
    (1, ("((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,1,1))]\n        uniform matrix4d[] rest",
         "((1,0,0,0),(0,1,0,0),(0,0,0,0),(0,0,1,1))]\n        uniform matrix4d[] rest"), "bind transforms that flatten space"),
])
def test_prims_that_cannot_be_are_left_out_with_a_note(tmp_path, stage, change, note):
    """What mutations of these files found."""
    assert change[0] in USD[stage]
    model, _ = usd_scene(tmp_path, USD[stage].replace(*change))
    assert any(note in one for one in model.notes), model.notes


def test_times_beyond_all_bounds_and_text_that_is_none_do_no_harm(tmp_path):
    text = USD[0].replace("24: (0, 90, 0), }", "24: (0, 90, 0), 1e300: (0, 0, 0), 24.000001: (0, 0, 0), }")
    assert usd_scene(tmp_path, text)[0].duration == pytest.approx(1.0)
    (tmp_path / "bad.usda").write_bytes(USD[0].encode().replace(b"def Cube", b"d\xffef Cube"))
    with pytest.raises(ep.FileError, match="bad.usda: is no USD stage that can be read"):
        ep.load_model(tmp_path / "bad.usda")


def test_usd_says_what_to_install_without_its_library(tmp_path, monkeypatch):
    (tmp_path / "stage.usda").write_text(USD[0])
    for name in [name for name in sys.modules if name.partition(".")[0] == "pxr"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(ModuleNotFoundError, match=r"pip install 'echopath\[usd\]'"):
        ep.load_model(tmp_path / "stage.usda")


def test_frames_of_a_folder_and_of_an_archive_move_alike(tmp_path):
    times = np.arange(5) / 20.0
    base = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    frames = np.stack([base + [0, 0, time**2] for time in times])  # falls up with 2 m/s^2
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    folder = tmp_path / "frames"
    folder.mkdir()
    for number, vertices in enumerate(frames):
        (folder / f"frame{number + 8}.obj").write_bytes(obj(vertices, faces))  # 8, 9, 10: by number, not by letters
    (folder / "frame_rate.txt").write_text("20\n")
    (tmp_path / "frames.npz").write_bytes(archive(vertices=frames, triangles=faces, frame_rate=20.0))
    for path in (folder, tmp_path / "frames.npz"):
        scene = ep.Scene()
        scene.add(ep.load_model(path), name="sheet")
        for time in (0.0, 0.05, 0.125, 0.2):
            assert np.allclose(scene.world_vertices(0, time)[:, 2], time**2, atol=2e-4)
        assert ep.load_model(path).duration == pytest.approx(0.2)


def frames_of_quads(folder, *frames) -> None:
    """One quad of four vertices [4, 3], beside a triangle that never moves."""
    folder.mkdir()
    for number, vertices in enumerate(frames):
        points = [*vertices, (0, 0, 3), (1, 0, 3), (0, 1, 3)]
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in points) + "o sheet\nf 1 2 3 4\nf 5 6 7\n"
        (folder / f"walk{number}.obj").write_text(text)
    (folder / "frame_rate.txt").write_text("10\n")


@pytest.mark.parametrize("bent", [[(0, 0, 0), (0.4, 0.6, 0), (1, 1, 0), (0, 1, 0)],   # concave: other ears than in the first
                                  [(0, 0, 0), (0, 0, 0), (1, 1, 0), (0, 1, 0)]])     # a triangle of it has no area
def test_quads_of_frames_may_become_concave_or_collapse(tmp_path, bent):
    square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    frames_of_quads(tmp_path / "walk", square, bent, square)
    model = ep.load_model(tmp_path / "walk")
    scene = ep.Scene()
    scene.add(model, name="m")
    assert len(scene.meshes) == 1 and scene.num_triangles == 3
    for time, wanted in ((0.0, square), (0.1, bent), (0.2, square)):
        assert np.allclose(scene.world_vertices(0, time)[:4], wanted, atol=SINGLE)


def test_what_has_no_area_in_the_first_frame_is_left_out_of_all_with_a_note(tmp_path):
    square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    frames_of_quads(tmp_path / "walk", [(0, 0, 0), (1, 0, 0), (1, 0, 0), (0, 1, 0)], square)
    model = ep.load_model(tmp_path / "walk")
    assert model.num_triangles == 2 and any("without area in the first frame" in note for note in model.notes)


def test_groups_of_one_name_are_kept_apart_by_their_objects(tmp_path):
    (tmp_path / "cars.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no car1\ng wheel\nusemtl rubber\nf 1 2 3\n"
                                       "usemtl steel\nf 1 3 4\no car2\ng wheel\nf 1 2 4\ng\nf 2 3 4\n")
    scene = ep.Scene()
    scene.add(ep.load_model(tmp_path / "cars.obj"), name="m")
    assert [mesh.name for mesh in scene.meshes] == ["m/car1/wheel/rubber", "m/car1/wheel/steel", "m/car2/wheel", "m/car2/rest"]
    assert [name for name, _ in ep.load_meshes(tmp_path / "cars.obj")] == ["car1/wheel", "car2/wheel", "car2/rest"]
    (tmp_path / "frames").mkdir()
    for number in (0, 1):
        shutil.copy(tmp_path / "cars.obj", tmp_path / "frames" / f"{number}.obj")
    scene.add(ep.load_model(tmp_path / "frames"), name="f")
    assert [mesh.name[1:] for mesh in scene.meshes[4:]] == [mesh.name[1:] for mesh in scene.meshes[:4]]


def test_frames_that_do_not_fit_together_are_refused_by_name(tmp_path):
    folder = tmp_path / "frames"
    folder.mkdir()
    with pytest.raises(ep.FileError, match="is a folder without .obj files"):
        ep.load_model(folder)
    (folder / "a1.obj").write_bytes(obj(VERTICES[:3], np.array([[0, 1, 2]])))
    (folder / "a2.obj").write_bytes(obj(VERTICES[:4], np.array([[0, 1, 2], [0, 2, 3]])))
    with pytest.raises(ep.FileError, match="a2.obj: must have the vertices, faces, groups .* of the first frame, a1.obj"):
        ep.load_model(folder)


@pytest.mark.parametrize("arrays, message", [
    ({}, "has no array 'vertices'; it has none"),
    ({"vertices": np.zeros((2, 3))}, "vertices must have 3 dimensions"),
    ({"vertices": np.zeros((2, 3, 3)), "triangles": [[0.0, 1, 2]]}, "triangles must have 2 dimensions, got .* of float64"),
    ({"vertices": np.full((2, 3, 3), np.nan), "triangles": [[0, 1, 2]]}, "vertices must be finite"),
    ({"vertices": np.eye(3)[None].repeat(2, 0), "triangles": [[0, 1, 3]]}, "triangles"),
    ({"vertices": np.eye(3)[None].repeat(2, 0), "triangles": [[0, 1, 2]], "times": [0.0, 0.0]}, "must be 2 ascending numbers"),
    ({"vertices": np.eye(3)[None].repeat(2, 0), "triangles": [[0, 1, 2]], "frame_rate": 0.0}, "the frame rate must be"),
    ({"vertices": np.array([None])}, "is no .npz file of plain arrays"),
])
def test_archives_that_do_not_fit_together_are_refused_by_name(tmp_path, arrays, message):
    np.savez(tmp_path / "a.npz", **arrays)
    with pytest.raises(ep.FileError, match=f"a.npz: .*{message}"):
        ep.load_model(tmp_path / "a.npz")
