"""Blend shapes of USD against what the library of USD itself makes of them."""
from __future__ import annotations

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdSkel

import echopath as ep
from fuzz.feeds.foreign_seeds import USD

SINGLE = 1e-6  # m, of what USD keeps in float
HALF = 1e-3    # m, of scales up to 2 of two joints, which USD keeps and interpolates in half precision: 2^-11 each
FACE = USD[-1]
JOINTS = """        int[] primvars:skel:jointIndices = [0, 0, 1, 1] (
            elementSize = 1
            interpolation = "vertex"
        )
        float[] primvars:skel:jointWeights = [1, 1, 1, 1] (
            elementSize = 1
            interpolation = "vertex"
        )
        matrix4d primvars:skel:geomBindTransform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0.25,0,1))
"""
TWO = "((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0.5,1))"


def skinned_face() -> str:
    """The face with a jaw that moves beside its shapes."""
    text = FACE.replace('joints = ["hip"]', 'joints = ["hip", "hip/jaw"]')
    text = text.replace("((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))", TWO)
    text = text.replace('        uniform token[] blendShapes = ["smile"', '''        uniform token[] joints = ["hip", "hip/jaw"]
        float3[] translations.timeSamples = { 0: [(0, 0, 0), (0, 0, 0.5)], 10: [(0, 1, 0), (2, 0, 0.5)], }
        quatf[] rotations = [(1, 0, 0, 0), (1, 0, 0, 0)]
        half3[] scales = [(1, 1, 1), (1, 1, 1)]
        uniform token[] blendShapes = ["smile"''')
    return text.replace("        uniform token[] skel:blendShapes", JOINTS + "        uniform token[] skel:blendShapes")


def growing_face() -> str:
    """The same with a jaw that turns and grows, in each direction by another amount."""
    text = skinned_face().replace("half3[] scales = [(1, 1, 1), (1, 1, 1)]", "half3[] scales.timeSamples = "
                                  "{ 0: [(1, 1, 1), (1, 1, 1)], 4: [(1, 2, 1), (0.5, 1, 1)], 10: [(1, 1, 1), (2, 1, 0.25)] }")
    return text.replace("quatf[] rotations = [(1, 0, 0, 0), (1, 0, 0, 0)]", "quatf[] rotations.timeSamples = "
                        "{ 0: [(1, 0, 0, 0), (1, 0, 0, 0)], 10: [(1, 0, 0, 0), (0.8, 0, 0.6, 0)] }")


def loaded(tmp_path, text: str, **options):
    (tmp_path / "face.usda").write_text(text)
    model = ep.load_model(tmp_path / "face.usda", **options)
    scene = ep.Scene()
    scene.add(model, name="m")
    return model, scene


def points_of_usd(path, code: float) -> np.ndarray:
    """[V, 3] of the only mesh, deformed by its shapes and then by its joints."""
    stage = Usd.Stage.Open(str(path))
    root, cache = UsdSkel.Root(stage.GetPrimAtPath("/face")), UsdSkel.Cache()
    cache.Populate(root, Usd.PrimDefaultPredicate)
    binding = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)[0]
    query, target = cache.GetSkelQuery(binding.GetSkeleton()), binding.GetSkinningTargets()[0]
    shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(target.GetPrim()))
    points = UsdGeom.Mesh(target.GetPrim()).GetPointsAttr().Get()
    weights = target.GetBlendShapeMapper().Remap(query.GetAnimQuery().ComputeBlendShapeWeights(code))
    assert shapes.ComputeDeformedPoints(*shapes.ComputeSubShapeWeights(weights), shapes.ComputeBlendShapePointIndices(),
                                        shapes.ComputeSubShapePointOffsets(), points)
    if target.HasJointInfluences():
        assert target.ComputeSkinnedPoints(query.ComputeSkinningTransforms(code), points, code)
    return np.array(points, float)


def same_points(ours, theirs, tolerance: float = SINGLE) -> bool:
    distance = np.linalg.norm(np.asarray(ours)[:, None] - theirs[None], axis=2)
    return max(distance.min(axis=0).max(), distance.min(axis=1).max()) < tolerance


@pytest.mark.parametrize("text, kind, tolerance", [(FACE, "MorphTargets", SINGLE), (skinned_face(), "Skin", SINGLE),
                                                   (growing_face(), "Skin", HALF)])
def test_blend_shapes_move_as_the_library_of_usd_says(tmp_path, text, kind, tolerance):
    model, scene = loaded(tmp_path, text)
    assert {type(node.deformation).__name__ for node in model.nodes if node.mesh} == {kind} and model.duration == 1.0
    for code in (0.0, 1.0, 4.9, 5.0, 5.1, 7.5, 10.0, 99.0):  # the shape in between is passed at 5
        points = np.concatenate([scene.world_vertices(mesh.id, code / 10) for mesh in scene.meshes])
        assert same_points(points, points_of_usd(tmp_path / "face.usda", code), tolerance), code


def test_looped_shapes_go_on_and_resting_ones_rest(tmp_path):
    _, scene = loaded(tmp_path, FACE, loop=True, offset=0.25)
    for time in (0.0, 0.6, 5000.5):
        assert same_points(scene.world_vertices(0, time), points_of_usd(tmp_path / "face.usda", 10 * ((time + 0.25) % 1.0)))
    model, resting = loaded(tmp_path, FACE, animation="")
    assert not any(node.deformation for node in model.nodes)
    assert same_points(resting.world_vertices(0, 0.7), points_of_usd(tmp_path / "face.usda", 0.0))


def test_weights_that_stay_shape_a_mesh_and_shapes_without_weights_do_not(tmp_path):
    still = FACE.replace("blendShapeWeights.timeSamples = { 0: [0, 0], 10: [1, 0.5] }", "blendShapeWeights = [1, 0]")
    moving = still.replace('def Mesh "skin"', 'def Xform "other"\n    {\n        double3 xformOp:translate.timeSamples = '
                           '{ 0: (0, 0, 0), 10: (1, 0, 0) }\n'
                           '        uniform token[] xformOpOrder = ["xformOp:translate"]\n    }\n    def Mesh "skin"')
    _, scene = loaded(tmp_path, moving)
    assert same_points(scene.world_vertices(0, 0.3), points_of_usd(tmp_path / "face.usda", 0.0))
    assert scene.world_vertices(0, 0.3)[:, 1] == pytest.approx(1.0)
    model, _ = loaded(tmp_path, FACE.replace('blendShapes = ["smile", "open"]', 'blendShapes = ["frown", "wink"]', 1))
    assert not any(node.deformation for node in model.nodes)


@pytest.mark.parametrize("change, note", [
    (("pointIndices = [0, 1]", "pointIndices = [0, 9]"), "have 2 offsets for 2 of 4 points"),
    (("pointIndices = [0, 1]", "pointIndices = [0, 1, 2]"), "have 2 offsets for 3 of 4 points"),
    (("[(0, 0, -1), (0, 0, -1)]", "[(0, 0, -1), (0, 0, inf)]"), "have offsets that are not finite"),
    (("10: [1, 0.5]", "10: [1, inf]"), "have weights that are not finite"),
])
def test_shapes_that_do_not_fit_their_mesh_are_left_out_with_a_note(tmp_path, change, note):
    assert change[0] in FACE
    model, _ = loaded(tmp_path, FACE.replace(*change))
    assert any(note in one for one in model.notes), model.notes
