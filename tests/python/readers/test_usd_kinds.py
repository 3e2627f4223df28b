"""USD: solids with two radii, held samples, what changes its visibility, subdivision surfaces."""
from __future__ import annotations

import numpy as np
import pytest
from pxr import Usd, UsdGeom

import echopath as ep

SINGLE = 1e-6  # m, of what USD keeps in float
HEAD = """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Z"
    timeCodesPerSecond = 10
    startTimeCode = 0
    endTimeCode = 10
)
"""
TRIANGLE = """    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
"""


def loaded(tmp_path, text: str, **options) -> tuple:
    (tmp_path / "stage.usda").write_text(HEAD + text)
    model = ep.load_model(tmp_path / "stage.usda", **options)
    scene = ep.Scene()
    scene.add(model, name="m")
    return model, scene


def solid(kind: str, axis: str = "Z", **sizes) -> str:
    lines = "".join(f"    double {name} = {value}\n" for name, value in sizes.items())
    return f'def {kind} "solid"\n{{\n    uniform token axis = "{axis}"\n{lines}}}\n'


def test_a_cylinder_of_two_radii_is_a_frustum_with_lids(tmp_path):
    below, above, height = 0.5, 0.3, 1.2
    model, scene = loaded(tmp_path, solid("Cylinder_1", radiusBottom=below, radiusTop=above, height=height))
    points = scene.world_vertices(0, 0.0)
    side = np.pi * (below + above) * np.hypot(height, below - above)
    assert model.nodes[0].mesh.area == pytest.approx(side + np.pi * (below**2 + above**2), rel=0.01)
    for z, radius in ((-0.6, below), (0.6, above)):
        ends = points[np.abs(points[:, 2] - z) < SINGLE]
        assert np.hypot(ends[:, 0], ends[:, 1]).max() == pytest.approx(radius)
    _, lying = loaded(tmp_path, solid("Cylinder_1", "X", radiusBottom=below, radiusTop=above, height=height))
    points = lying.world_vertices(0, 0.0)
    assert np.hypot(points[:, 1], points[:, 2])[points[:, 0] > 0.5].max() == pytest.approx(above)


def test_a_capsule_of_two_radii_ends_with_two_half_spheres(tmp_path):
    model, scene = loaded(tmp_path, solid("Capsule_1", radiusBottom=0.5, radiusTop=0.3, height=1.0))
    points = scene.world_vertices(0, 0.0)
    assert model.nodes[0].mesh.is_closed and model.nodes[0].smooth
    assert points[:, 2].min() == pytest.approx(-1.0) and points[:, 2].max() == pytest.approx(0.8)
    upper = points[points[:, 2] > 0.5 + SINGLE]
    assert np.allclose(np.linalg.norm(upper - [0, 0, 0.5], axis=1), 0.3)
    _, plain = loaded(tmp_path, solid("Capsule", radius=0.5, height=1.0))
    _, equal = loaded(tmp_path, solid("Capsule_1", radiusBottom=0.5, radiusTop=0.5, height=1.0))
    assert np.allclose(plain.world_vertices(0, 0.0), equal.world_vertices(0, 0.0))


@pytest.mark.parametrize("axis", "XYZ")
def test_a_plane_lies_where_usd_says_and_looks_along_its_axis(tmp_path, axis):
    _, scene = loaded(tmp_path, solid("Plane", axis, width=4.0, length=1.0))
    points, (corners, *_) = scene.world_vertices(0, 0.0), scene.meshes[0].triangles
    stage = Usd.Stage.Open(str(tmp_path / "stage.usda"))
    plane = UsdGeom.Boundable(stage.GetPrimAtPath("/solid"))
    extent = UsdGeom.Boundable.ComputeExtentFromPlugins(plane, Usd.TimeCode.Default())
    assert np.allclose([points.min(axis=0), points.max(axis=0)], extent, atol=SINGLE)
    a, b, c = points[corners]
    assert np.allclose(np.cross(b - a, c - a) / 4.0, np.eye(3)["XYZ".index(axis)])


MOVING = '''def Xform "cart"
{
    double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 4: (8, 0, 0), 10: (2, 0, 0), }
    float xformOp:rotateZ.timeSamples = { 0: 0, 4: 90, 10: 0, }
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ"]
    def Mesh "box"
    {
TRIANGLE    }
}
'''.replace("TRIANGLE", TRIANGLE)


@pytest.mark.parametrize("held", [False, True])
def test_transforms_are_held_or_linear_between_their_samples_as_the_stage_says(tmp_path, monkeypatch, held):
    """Against the library of USD, between all samples and at them."""
    open_stage = Usd.Stage.Open

    def opened(path):
        stage = open_stage(path)
        stage.SetInterpolationType(Usd.InterpolationTypeHeld if held else Usd.InterpolationTypeLinear)
        return stage

    monkeypatch.setattr(Usd.Stage, "Open", opened)
    _, scene = loaded(tmp_path, MOVING)
    stage = opened(str(tmp_path / "stage.usda"))
    for code in (0.0, 1.0, 3.9, 4.0, 7.0, 10.0):
        matrix = np.array(UsdGeom.Xformable(stage.GetPrimAtPath("/cart")).GetLocalTransformation(code)).T
        wanted = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) @ matrix[:3, :3].T + matrix[:3, 3]
        assert np.allclose(scene.world_vertices(0, code / 10 + 1e-9), wanted, atol=2e-3)


def test_what_changes_its_visibility_stays_as_at_first_and_that_is_told(tmp_path):
    mesh = 'def Mesh "box"\n{\n    token visibility.timeSamples = { 0: "inherited", 5: "invisible" }\n' + TRIANGLE + "}\n"
    model, scene = loaded(tmp_path, mesh)
    assert len(scene.meshes) == 1 and any("visibility of a prim changes over time" in note for note in model.notes)
    with pytest.raises(ep.FileError, match="holds no surface; .*visibility of a prim changes over time"):
        loaded(tmp_path, mesh.replace('0: "inherited", 5: "invisible"', '0: "invisible", 5: "inherited"'))


@pytest.mark.parametrize("opens", [True, False])
def test_faces_that_are_shut_in_the_first_frame_are_left_out_and_that_is_told(tmp_path, opens):
    first = "(1, 0, 0)" if opens else "(0, 0, 1)"  # of the fourth point: on the second, or where it makes a face with an area
    model, _ = loaded(tmp_path, f"""def Mesh "leaf"
{{
    int[] faceVertexCounts = [3, 3]
    int[] faceVertexIndices = [0, 1, 2, 0, 1, 3]
    point3f[] points.timeSamples = {{ 0: [(0, 0, 0), (1, 0, 0), (0, 1, 0), {first}],
                                      5: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)] }}
}}
""")
    assert model.num_triangles == (1 if opens else 2)
    assert any("without area in the first frame" in note for note in model.notes) == opens


@pytest.mark.parametrize("is_shut", [True, False])
def test_faces_of_a_skin_that_are_shut_at_rest_are_left_out_and_that_is_told(tmp_path, is_shut):
    """A mouth: its lower lip is a point that moves with a joint of its own, at rest on the upper one, or below it."""
    unit = "((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))"
    lip = "(0, 0, 0)" if is_shut else "(0, 0, -1)"
    model, scene = loaded(tmp_path, f"""def SkelRoot "person"
{{
    def Skeleton "bones" ( prepend apiSchemas = ["SkelBindingAPI"] )
    {{
        uniform token[] joints = ["head", "jaw"]
        uniform matrix4d[] bindTransforms = [{unit}, {unit}]
        uniform matrix4d[] restTransforms = [{unit}, {unit}]
        rel skel:animationSource = </person/talk>
    }}
    def SkelAnimation "talk"
    {{
        uniform token[] joints = ["head", "jaw"]
        float3[] translations.timeSamples = {{ 0: [(0, 0, 0), (0, 0, 0)], 10: [(0, 0, 0), (0, 0, -1)] }}
        quatf[] rotations = [(1, 0, 0, 0), (1, 0, 0, 0)]
        half3[] scales = [(1, 1, 1), (1, 1, 1)]
    }}
    def Mesh "skin" ( prepend apiSchemas = ["SkelBindingAPI"] )
    {{
        int[] faceVertexCounts = [3, 3]
        int[] faceVertexIndices = [0, 1, 2, 0, 1, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, 1), {lip}]
        int[] primvars:skel:jointIndices = [0, 0, 0, 1] ( elementSize = 1; interpolation = "vertex" )
        float[] primvars:skel:jointWeights = [1, 1, 1, 1] ( elementSize = 1; interpolation = "vertex" )
        rel skel:skeleton = </person/bones>
    }}
}}
""")
    assert scene.num_triangles == (1 if is_shut else 2)
    assert any("skinned meshes without area at rest" in note for note in model.notes) == is_shut


@pytest.mark.parametrize("kind, size", [("Sphere", "radius"), ("Cube", "size"), ("Cylinder", "height")])
def test_a_solid_that_changes_its_size_stays_as_at_first_and_that_is_told(tmp_path, kind, size):
    text = solid(kind, **{size: 2.0})
    changing = text.replace(f"{size} = 2.0", f"{size}.timeSamples = {{ 0: 2, 10: 4 }}")
    plain, told = (loaded(tmp_path, one)[0] for one in (text, changing))
    assert np.allclose(told.nodes[0].mesh.vertices, plain.nodes[0].mesh.vertices)
    assert [any("size of a solid changes" in note for note in model.notes) for model in (plain, told)] == [False, True]


@pytest.mark.parametrize("scheme, cage", [("catmullClark", True), ("loop", True), ("none", False), ("", False)])
def test_of_a_subdivision_surface_the_cage_is_taken_and_that_is_told(tmp_path, scheme, cage):
    """A mesh that does not say is taken as it stands."""
    said = f'    uniform token subdivisionScheme = "{scheme}"\n' if scheme else ""
    model, _ = loaded(tmp_path, f'def Mesh "box"\n{{\n{said}{TRIANGLE}}}\n')
    assert model.nodes[0].smooth is cage
    assert any("control cage" in note for note in model.notes) is cage


def test_scopes_and_other_prims_without_a_place_name_what_is_below_them(tmp_path):
    """Both walls had been children of the stage, as "wall" and "wall_2"."""
    wall = f'def Mesh "wall"\n{{\n{TRIANGLE}}}\n'
    districts = f'def Scope "north"\n{{\n{wall}}}\ndef "south"\n{{\n{wall}}}\n'
    paints = 'def Scope "Looks"\n{\ndef Material "paint"\n{\n}\n}\n'
    _, scene = loaded(tmp_path, f'def Xform "town"\n{{\n{districts}{paints}}}\n')
    assert [node.name for node in scene.nodes if node.mesh] == ["m/town/north/wall", "m/town/south/wall"]
    assert len(scene.nodes) == 6
    _, scene = loaded(tmp_path, f'def District "east"\n{{\n{wall}}}\ndef PhysicsScene "west"\n{{\n{wall}}}\n')
    assert [node.name for node in scene.nodes if node.mesh] == ["m/east/wall", "m/west/wall"]


def test_what_turns_by_half_a_turn_from_sample_to_sample_goes_on(tmp_path):
    """Quaternions of such turns have a product of 0, to which neither sign is nearer."""
    _, scene = loaded(tmp_path, 'def Xform "door"\n{\n    matrix4d xformOp:transform.timeSamples = {\n'
                      "        0: ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),\n"
                      "        5: ((-1, 0, 0, 0), (0, -1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),\n"
                      "        10: ((-1, 0, 0, 0), (0, -1, 0, 0), (0, 0, 1, 0), (5, 0, 0, 1)),\n    }\n"
                      '    uniform token[] xformOpOrder = ["xformOp:transform"]\n    def Mesh "box"\n    {\n'
                      f"{TRIANGLE}    }}\n}}\n")
    for time, wanted in ((0.0, [[0, 0, 0], [1, 0, 0], [0, 1, 0]]), (0.5, [[0, 0, 0], [-1, 0, 0], [0, -1, 0]]),
                         (1.0, [[5, 0, 0], [4, 0, 0], [5, -1, 0]])):
        assert np.allclose(scene.world_vertices(0, time), wanted, atol=SINGLE), time


def test_what_quaternions_turn_about_a_pivot_goes_round_it(tmp_path):
    """A door that opens by 90 degrees in one step about hinges 5 m away, against the library of USD."""
    _, scene = loaded(tmp_path, 'def Xform "door"\n{\n    double3 xformOp:translate:hinge = (-5, 0, 0)\n'
                      "    quatf xformOp:orient.timeSamples = { 0: (1, 0, 0, 0), 5: (0.70710678, 0, 0, -0.70710678) }\n"
                      '    uniform token[] xformOpOrder = ["xformOp:translate:hinge", "xformOp:orient",\n'
                      '        "!invert!xformOp:translate:hinge"]\n    def Mesh "box"\n    {\n' + f"{TRIANGLE}    }}\n}}\n")
    stage = Usd.Stage.Open(str(tmp_path / "stage.usda"))  # which its prims need alive
    door = UsdGeom.Xformable(stage.GetPrimAtPath("/door"))
    for code in (0.0, 1.3, 2.5, 4.9, 5.0, 8.0):
        matrix = np.array(door.GetLocalTransformation(code)).T
        wanted = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) @ matrix[:3, :3].T + matrix[:3, 3]
        assert np.allclose(scene.world_vertices(0, code / 10), wanted, atol=6e-6), code  # of floats


TURNS = {  # degrees in a second, of a blade 5 m from the origin of its prim
    "about a pivot": ("double", "rotateZ", "-20", "3580",
                      '"xformOp:translate:hub", "xformOp:{0}", "!invert!xformOp:translate:hub"'),
    "about three axes": ("double3", "rotateXYZ", "(0, 10, 0)", "(200, -150, 900)", '"xformOp:{0}"'),
    "before it is moved": ("double", "rotateY", "0", "1000", '"xformOp:{0}", "xformOp:translate:hub"'),
}


@pytest.mark.parametrize("kind, word, begin, end, order", TURNS.values(), ids=TURNS)
def test_what_turns_about_another_place_is_where_and_as_fast_as_usd_says(tmp_path, kind, word, begin, end, order):
    """It went along chords of 5 degrees of its prim's origin: a tip of 19 m/s at 16 to 22."""
    blade = TRIANGLE.replace("(0, 0, 0), (1, 0, 0), (0, 1, 0)", "(4.7, 0, 0), (4.8, 0, 0), (4.7, 0.1, 0)")
    _, scene = loaded(tmp_path, f'def Mesh "blade"\n{{\n{blade}    double3 xformOp:translate:hub = (5, 0, 0)\n'
                      f"    {kind} xformOp:{word}.timeSamples = {{ 0: {begin}, 10: {end} }}\n"
                      f"    uniform token[] xformOpOrder = [{order.format(word)}]\n}}\n")
    step = 1e-5  # s
    for time in np.linspace(0.01, 0.99, 41):
        wanted = [transform_of_usd(tmp_path, "/blade", 10.0 * at) @ [4.7, 0.0, 0.0, 1.0] for at in (time, time + step)]
        found = [scene.world_vertices(0, at)[0] for at in (time, time + step)]
        assert np.allclose(found, np.array(wanted)[:, :3], atol=1e-5), time
        assert np.allclose(found[1] - found[0], (wanted[1] - wanted[0])[:3], atol=0.01 * step), time


def transform_of_usd(tmp_path, path: str, code: float) -> np.ndarray:
    """[4, 4] world from prim, by the library of USD."""
    stage = Usd.Stage.Open(str(tmp_path / "stage.usda"))
    return np.array(UsdGeom.XformCache(code).GetLocalToWorldTransform(stage.GetPrimAtPath(path))).T


def test_what_has_very_many_samples_moves_through_all_of_them(tmp_path):
    """A vehicle of 10 minutes at 10 codes a second, which stood still behind the 5000th sample, and two that stand on it."""
    samples = ", ".join(f"{code}: ({code}, 0, 0)" for code in range(6001))
    places = ", ".join(f"{code}: [({code}, 1, 0), ({code}, 2, 0)]" for code in range(6001))
    _, scene = loaded(tmp_path, f'def Mesh "cart"\n{{\n{TRIANGLE}    double3 xformOp:translate.timeSamples = {{ {samples} }}\n'
                      '    uniform token[] xformOpOrder = ["xformOp:translate"]\n}\ndef PointInstancer "riders"\n{\n'
                      f"    point3f[] positions.timeSamples = {{ {places} }}\n    int[] protoIndices = [0, 0]\n"
                      f'    rel prototypes = </riders/body>\n    def Mesh "body"\n    {{\n{TRIANGLE}    }}\n}}\n')
    for code in (4900, 5100, 5999):
        cart, *riders = (scene.world_vertices(mesh.id, code / 10)[0] for mesh in scene.meshes)
        assert np.allclose(cart, transform_of_usd(tmp_path, "/cart", code)[:3, 3])
        assert np.allclose(riders, [[code, 1, 0], [code, 2, 0]])


def test_jumps_between_samples_as_near_as_the_library_of_usd_advises_are_jumps(tmp_path):
    """Of two such samples the second was left out: transforms and points drifted from the first to the next one instead."""
    near = 5.0 - Usd.TimeCode.SafeStep()
    corners = TRIANGLE.split("    point3f")[0]
    places = ((0, 0), (near, 1), (5, 5), (10, 6))
    points = ", ".join(f"{code!r}: [({x}, 0, 0), ({x + 1}, 0, 0), ({x}, 1, 0)]" for code, x in places)
    moved = ", ".join(f"{code!r}: ({x}, 0, 0)" for code, x in places)
    _, scene = loaded(tmp_path, f'def Mesh "cart"\n{{\n{TRIANGLE}    double3 xformOp:translate.timeSamples = {{ {moved} }}\n'
                      '    uniform token[] xformOpOrder = ["xformOp:translate"]\n}\ndef Mesh "slug"\n{\n'
                      f"{corners}    point3f[] points.timeSamples = {{ {points} }}\n}}\n")
    for code in (0.0, 4.9, 5.1, 7.5, 10.0):
        wanted = transform_of_usd(tmp_path, "/cart", code)[:3, 3]
        assert np.allclose([scene.world_vertices(mesh, code / 10)[0] for mesh in (0, 1)], wanted, atol=SINGLE), code


def test_instances_that_move_alone_are_an_animation(tmp_path):
    """They stood still where nothing else of the stage moved; linear between their samples."""
    model, scene = loaded(tmp_path, 'def PointInstancer "birds"\n{\n'
                          "    point3f[] positions.timeSamples = { 2: [(0, 0, 0), (0, 5, 0)], 12: [(10, 0, 0), (0, 5, 20)] }\n"
                          f'    int[] protoIndices = [0, 0]\n    rel prototypes = </birds/bird>\n    def Mesh "bird"\n    {{\n'
                          f"{TRIANGLE}    }}\n}}\n")
    assert (model.animation, model.duration) == ("timeline", 1.2)
    for code, wanted in ((0, [[0, 0, 0], [0, 5, 0]]), (7, [[5, 0, 0], [0, 5, 10]]), (15, [[10, 0, 0], [0, 5, 20]])):
        assert np.allclose([scene.world_vertices(mesh.id, code / 10)[0] for mesh in scene.meshes], wanted), code


@pytest.mark.parametrize("name, first, then", [("protoIndices", "[0, 0]", "[0, 1]"), ("ids", "[1, 2]", "[1, 3]"),
                                               ("invisibleIds", "[]", "[1]")])
def test_instances_that_change_are_told_to_stay_as_at_first(tmp_path, name, first, then):
    """They stayed so without a word."""
    arrays = {"protoIndices": ("int[]", "[0, 0]"), "ids": ("int64[]", "[1, 2]"), "invisibleIds": ("int64[]", "[]")}
    birds = "".join(f'    def Mesh "bird_{k}"\n    {{\n{TRIANGLE}    }}\n' for k in (0, 1))

    def text(changing):
        lines = [f"    {kind} {key}" + (f".timeSamples = {{ 0: {first}, 10: {then} }}" if key == changing else f" = {value}")
                 for key, (kind, value) in arrays.items()]
        return ('def PointInstancer "birds"\n{\n    point3f[] positions = [(0, 0, 0), (0, 5, 0)]\n' + "\n".join(lines) +
                f"\n    rel prototypes = [</birds/bird_0>, </birds/bird_1>]\n{birds}}}\n")

    (plain, scene), (told, as_first) = loaded(tmp_path, text(None)), loaded(tmp_path, text(name))
    assert [mesh.name for mesh in as_first.meshes] == [mesh.name for mesh in scene.meshes]
    assert [any("point instancer change over time" in note for note in model.notes) for model in (plain, told)] == [False, True]


@pytest.mark.parametrize("num_codes, turns", [(2, 3000.0), (4000, 2.5)])
def test_rotors_turn_as_fast_as_the_stage_says(tmp_path, num_codes, turns):
    """Turns between two samples, many in one step or some in each of many: of all but 5000 steps they were taken for fewer."""
    step = 50
    samples = ", ".join(f"{step * index}: {360.0 * turns * index}" for index in range(num_codes))
    _, scene = loaded(tmp_path, f'def Mesh "rotor"\n{{\n{TRIANGLE}    double xformOp:rotateZ.timeSamples = {{ {samples} }}\n'
                      '    uniform token[] xformOpOrder = ["xformOp:rotateZ"]\n}\n')
    for code in (0.0, 0.003, 13.37, 49.9):
        wanted = transform_of_usd(tmp_path, "/rotor", code)[:3, 0]
        assert np.allclose(scene.world_vertices(0, code / 10)[1], wanted, atol=SINGLE), code


def test_instances_have_the_materials_that_are_bound_above_them(tmp_path):
    """All had that of the first one."""
    names = ("wood", "metal", "glass")
    looks = "".join(f'    def Material "{name}"\n    {{\n    }}\n' for name in names)
    subset = ('        def GeomSubset "door"\n        {\n            uniform token elementType = "face"\n'
              '            uniform token familyName = "materialBind"\n            int[] indices = [0]\n        }\n')
    corners = TRIANGLE.replace("[3]", "[3, 3]").replace("[0, 1, 2]", "[0, 1, 2, 0, 2, 1]")
    text = f'def Scope "Looks"\n{{\n{looks}}}\nclass "house"\n{{\n    def Mesh "wall"\n    {{\n{corners}{subset}    }}\n}}\n'
    for name in names:
        text += (f'def Xform "{name}_house" (\n    prepend apiSchemas = ["MaterialBindingAPI"]\n    instanceable = true\n'
                 f"    references = </house>\n)\n{{\n    rel material:binding = </Looks/{name}>\n}}\n")
    surfaces = [node for node in loaded(tmp_path, text)[0].nodes if node.mesh]
    wanted = [(name, part) for name in names for part in ("door", "rest")]
    assert [(node.foreign_material, node.name) for node in surfaces] == wanted
    assert len({id(node.mesh) for node in surfaces}) == 2


@pytest.mark.parametrize("deforms", [False, True])
def test_the_time_of_the_scene_is_that_of_the_stage_after_its_start(tmp_path, deforms):
    """The stage starts with code 5, 10 of which are 1 s; what moves does so from 0.5 s before that to 1.5 s behind it."""
    end = "[(10, 0, 0), (11, 0, 0), (10, 1, 0)]"
    face = TRIANGLE
    if deforms:
        face = TRIANGLE.replace("points = [", "points.timeSamples = { 0: [").replace(", 1, 0)]", f", 1, 0)], 20: {end} }}")
    else:
        face += """    double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 20: (10, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
"""
    head = HEAD.replace("startTimeCode = 0", "startTimeCode = 5").replace("endTimeCode = 10", "endTimeCode = 25")
    (tmp_path / "stage.usda").write_text(f'{head}def Mesh "face"\n{{\n{face}}}\n')
    for offset in (0.0, 0.4):
        scene = ep.Scene()
        scene.add(ep.load_model(tmp_path / "stage.usda", offset=offset), name="m")
        found = [scene.world_vertices(0, time - offset)[0, 0] for time in (-0.7, 0.0, 0.5, 1.3, 2.5)]
        assert found == pytest.approx([0.0, 2.5, 5.0, 9.0, 10.0], abs=10.0 * SINGLE)


def test_at_rest_a_stage_is_as_in_its_first_frame(tmp_path):
    """Transforms as the points are, whatever samples lie before it."""
    (tmp_path / "stage.usda").write_text(HEAD.replace("startTimeCode = 0", "startTimeCode = 4") + MOVING)
    scene = ep.Scene()
    scene.add(ep.load_model(tmp_path / "stage.usda", animation=""), name="m")
    stage = Usd.Stage.Open(str(tmp_path / "stage.usda"))
    matrix = np.array(UsdGeom.Xformable(stage.GetPrimAtPath("/cart")).GetLocalTransformation(4.0)).T
    wanted = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.allclose(scene.world_vertices(0, 0.0), wanted, atol=SINGLE)


def test_triangles_of_parts_know_their_faces_of_the_file_and_their_materials_what_sensors_are_told(tmp_path):
    """A face of two corners, and two squares side by side, the second of a part of its own."""
    _, scene = loaded(tmp_path, '''def Material "paint_7"
{
    custom string omni:simready:nonvisual:base = "aluminum"
}
def Mesh "face" (
    prepend apiSchemas = ["MaterialBindingAPI"]
)
{
    int[] faceVertexCounts = [2, 4, 4]
    int[] faceVertexIndices = [0, 1, 0, 1, 2, 3, 1, 4, 5, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
    rel material:binding = </paint_7>
    def GeomSubset "second"
    {
        uniform token elementType = "face"
        uniform token familyName = "materialBind"
        int[] indices = [2]
    }
}
''')
    found = {mesh.name.rpartition("/")[2]: mesh for mesh in scene.meshes}
    assert len(found) == 2 and {mesh.material_name for mesh in found.values()} == {"metal"}
    for name, mesh in found.items():
        face, left = (2, 1.0) if name == "second" else (1, 0.0)
        assert mesh.mesh.original_triangle.tolist() == [face, face]
        assert mesh.mesh.vertices[mesh.mesh.triangles][..., 0].min() == left


def test_the_front_of_a_left_handed_mesh_is_where_its_corners_go_clockwise(tmp_path):
    mesh = 'def Mesh "face"\n{\n' + TRIANGLE + '    uniform token orientation = "leftHanded"\n%s}\n'
    for normals in ("", "    normal3f[] normals = [(.1, 0, -1), (0, .1, -1), (0, 0, -1)]\n"):
        face = loaded(tmp_path, mesh % normals)[0].nodes[0].mesh
        a, b, c = face.vertices[face.triangles[0]]
        assert np.allclose(np.cross(b - a, c - a), (0, 0, -1))


def test_a_unit_of_single_precision_counts(tmp_path, monkeypatch):
    """As Blender 2.9 wrote it; type 8 of a value of the binary format is float, 9 is double."""
    monkeypatch.setattr("echopath.readers.usd.stage.refuse_what_ends_usd", lambda path: None)  # a process for each file
    stage = Usd.Stage.CreateNew(str(tmp_path / "ball.usdc"))
    UsdGeom.SetStageMetersPerUnit(stage, 0.3125)
    UsdGeom.Sphere.Define(stage, "/ball").CreateRadiusAttr(2.0)
    stage.GetRootLayer().Save()
    content = (tmp_path / "ball.usdc").read_bytes()
    single, double = (np.float32(0.3125).tobytes() + bytes([0, 0, kind, 0x40]) for kind in (8, 9))
    assert content.count(double) == 1
    (tmp_path / "single.usdc").write_bytes(content.replace(double, single))
    model = ep.load_model(tmp_path / "single.usdc")
    assert model.unit == 0.3125 and np.ptp(model.nodes[0].mesh.vertices[:, 2]) == pytest.approx(4 * 0.3125)
