"""Skins and morph targets of glTF files against the formulas of the specification."""
import warnings

import numpy as np
import pytest

import echopath as ep
from support.files.gltf_files import BOX, BOX_SIDES, loaded, rig_file, tube
from support.files.gltf_loaded import TO_SCENE, morph_file, rotated, scene_of, vertices_at

SINGLE = 2e-6


def about_z(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def bent(points, angle: float):
    """The tube of rig_file where its upper bone is turned: the blend of both bones, in closed form."""
    upper = np.clip(points[:, 1:2] - 0.5, 0.0, 1.0)
    return (1 - upper) * points + upper * ((points - [0, 1, 0]) @ about_z(angle).T + [0, 1, 0])


@pytest.mark.parametrize("quantised,tolerance", [("", 1e-6), ("u1", 4e-3), ("u2", 2e-5)])
def test_a_skinned_tube_is_the_blend_of_its_bones(tmp_path, quantised, tolerance):
    scene = scene_of(loaded(tmp_path, rig_file(quantised=quantised)))
    points = tube()[0]
    for time, angle in ((0.0, 0.0), (0.5, np.pi / 4), (1.0, np.pi / 2), (1.5, np.pi / 4), (9.0, 0.0)):
        parts = vertices_at(scene, time)
        assert sorted(parts) == ["tube/lower", "tube/upper"]  # regions by dominant joint, named by joint
        found = np.concatenate(list(parts.values()))
        wanted = bent(points, angle)[:, TO_SCENE]
        distance = np.linalg.norm(found[:, None] - wanted[None], axis=2)
        assert distance.min(axis=1).max() < tolerance and distance.min(axis=0).max() < tolerance


@pytest.mark.parametrize("dtype,most", [("u1", 255), ("u2", 65535)])
def test_quantised_weights_are_right_to_a_millionth(tmp_path, dtype, most):
    skin = loaded(tmp_path, rig_file(quantised=dtype)).nodes[0].deformation
    upper = np.round(np.clip(tube()[0][:, 1] - 0.5, 0, 1) * most)
    lower = np.round((1 - np.clip(tube()[0][:, 1] - 0.5, 0, 1)) * most)
    found = (skin.weights * (skin.joint_indices == 1)).sum(axis=1)
    assert np.abs(found - upper / (upper + lower)).max() < 1e-12


def test_a_skin_at_rest_is_meshes_by_joint_without_motion(tmp_path):
    scene = scene_of(loaded(tmp_path, rig_file(), animation=""))
    assert [mesh.name for mesh in scene.meshes] == ["m/tube/lower", "m/tube/upper"]
    assert not any(scene.is_moving(mesh.id) for mesh in scene.meshes)
    found = np.concatenate(list(vertices_at(scene, 0.0).values()))
    assert np.abs(np.ptp(found, axis=0) - np.ptp(tube()[0], axis=0)[TO_SCENE]).max() < SINGLE


def test_what_carries_a_skin_moves_it_through_its_joints_alone(tmp_path):
    """The mesh's own place counts for nothing (glTF 2.0, 3.7.3.3), but that of the joints does."""
    file = rig_file()
    file.json["nodes"] += [{"name": "figure", "children": [0, 1], "translation": [0, 0, 3], "rotation": [0, 0.6, 0, 0.8]}]
    file.json["scenes"] = [{"nodes": [3]}]
    found = vertices_at(scene_of(loaded(tmp_path, file)), 1.0)
    assert sorted(found) == ["figure/tube/lower", "figure/tube/upper"]
    wanted = rotated(np.array([0, 0.6, 0, 0.8]), bent(tube()[0], np.pi / 2)) + [0, 0, 3]
    distance = np.linalg.norm(np.concatenate(list(found.values()))[:, None] - wanted[:, TO_SCENE][None], axis=2)
    assert distance.min(axis=1).max() < SINGLE


def test_faults_of_skins_are_told_with_their_places(tmp_path):
    def refused(said, **parts):
        file = rig_file()
        for name, value in parts.items():
            file.json["skins"][0][name] = value
        with pytest.raises(ep.FileError, match=said):
            loaded(tmp_path, file)

    refused(r"skins\[0\]\.joints\[1\]: must be a whole number from 0 to 2, is 9", joints=[1, 9])
    refused(r"skins\[0\]\.joints\[1\]: nodes\[1\] is a joint twice", joints=[1, 1])
    refused(r"must name joints 0 to 0 of skins\[0\], names 1", joints=[1])
    refused(r"skins\[0\]\.joints: must hold at least one joint", joints=[])
    refused(r"inverseBindMatrices: must be a whole number", inverseBindMatrices=99)
    file = rig_file()
    file.json["scenes"] = [{"nodes": [0]}]
    with pytest.raises(ep.FileError, match=r"skins\[0\]\.joints\[0\]: nodes\[1\] is not in the scene"):
        loaded(tmp_path, file)


def test_morph_targets_add_up_at_rest(tmp_path):
    for file in (morph_file(weights=[0.5, 9, 2.0]), morph_file(weights=[1, 1, 1])):
        file.json["nodes"][0] |= {} if file.json["meshes"][0]["weights"][0] == 0.5 else {"weights": [0.5, 9, 2.0]}
        found = vertices_at(scene_of(loaded(tmp_path, file)), 0.0)["box"]
        assert np.abs(found - (BOX * [3, 1, 1] + [0, 0.5, 0])[:, TO_SCENE]).max() < SINGLE


@pytest.mark.parametrize("interpolation", ["STEP", "LINEAR", "CUBICSPLINE"])
def test_morph_targets_follow_their_weights(tmp_path, interpolation):
    shares = np.array([[0, 0, 0], [1, 5, 0.5]], float)
    values = shares if interpolation != "CUBICSPLINE" else np.stack([0 * shares, shares, 0 * shares], axis=1)
    file = morph_file()
    file.animation((0, "weights", [0, 1], values.ravel(), interpolation))
    scene = scene_of(loaded(tmp_path, file))
    t = {"STEP": 0.0, "LINEAR": 0.25, "CUBICSPLINE": 3 * 0.25**2 - 2 * 0.25**3}[interpolation]
    assert np.abs(vertices_at(scene, 0.25)["box"] - (BOX * [1 + 0.5 * t, 1, 1] + [0, t, 0])[:, TO_SCENE]).max() < SINGLE


def test_faces_that_morph_targets_open_are_kept(tmp_path):
    file = morph_file()
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = file.accessor(BOX * [0, 1, 1])  # folded flat
    file.animation((0, "weights", [0, 1], [0, 0, 0, 0, 0, 1], "LINEAR"))
    scene = scene_of(loaded(tmp_path, file))
    assert scene.num_triangles == len(BOX_SIDES)
    assert np.abs(vertices_at(scene, 0.5)["box"] - (BOX * [0.5, 1, 1])[:, TO_SCENE]).max() < SINGLE


def test_a_node_moves_while_morph_targets_shape_its_mesh(tmp_path):
    file = morph_file()
    file.animation((0, "weights", [0, 1], [0, 0, 0, 1, 0, 0.5], "LINEAR"),
                   (0, "translation", [0, 1], [[0, 0, 0], [4, 8, -2]], "LINEAR"))
    found = vertices_at(scene_of(loaded(tmp_path, file)), 0.25)["box/primitive_0"]
    assert np.abs(found - (BOX * [1.125, 1, 1] + [1, 2.25, -0.5])[:, TO_SCENE]).max() < SINGLE


def test_a_skin_moves_what_morph_targets_shape(tmp_path):
    file = rig_file()
    points = tube()[0]
    wider = points * [0.5, 0.0, 0.5]
    file.json["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": file.accessor(wider)}]
    sampler = {"input": file.accessor([0, 1]), "output": file.accessor([0, 1])}
    animation = file.json["animations"][0]
    animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"node": 0, "path": "weights"}})
    animation["samplers"].append(sampler)
    found = np.concatenate(list(vertices_at(scene_of(loaded(tmp_path, file)), 0.5).values()))
    wanted = bent(points + 0.5 * wider, np.pi / 4)[:, TO_SCENE]
    distance = np.linalg.norm(found[:, None] - wanted[None], axis=2)
    assert distance.min(axis=1).max() < SINGLE


@pytest.mark.parametrize("scale, says", [(1.0, None), (4.9, None), (100.0, "of 200 m .* or unit=0.01 [(]cm[)] or"),
                                         (0.02, "of 40 mm .*; unit tells")])
def test_a_figure_of_a_size_that_cannot_be_is_warned_of(tmp_path, scale, says):
    """The tube of rig_file is 2 m long; whoever gives the unit hears nothing."""
    file = rig_file()
    file.json["nodes"] += [{"name": "figure", "children": [0, 1], "scale": [scale] * 3}]
    file.json["scenes"] = [{"nodes": [3]}]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loaded(tmp_path, file, unit=1.0)
        if says is None:
            loaded(tmp_path, file)
    if says is not None:
        with pytest.warns(RuntimeWarning, match="a figure with a skeleton " + says):
            loaded(tmp_path, file)
