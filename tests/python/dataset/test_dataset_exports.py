"""Exports of datasets: there whole or not at all, and of datasets that keep less than they need, whose frames are made again."""
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath import dataset
from echopath.dataset.classes import classes_of
from support.files.small_dataset import bytes_of

TEMPLATE = """
[dataset]
scenes = 1
frames = 2
interval = 0.05
keep = "{keep}"
seed = 4
[radar.waveform]
start_frequency = 77e9
bandwidth = 0.7e9
num_samples = 256
sampling_rate = 10e6
num_chirps = 64
chirp_interval = 40e-6
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.0050, 1.0]
[[radar.receivers]]
position = [0.0, 0.0069, 1.0]
[[objects]]
name = "walker"
{walker}
position = [{{uniform = [5.0, 9.0]}}, 1.0, 0.0]
[trace]
num_rays = 1000
[labels]
"""
PERSON = 'actor = "pedestrian"'
BOX = 'actor = "box"\nparameters = {size = [0.4, 0.4, 1.7]}\nmaterial = "metal"\nspeed = -1.0'  # one mesh: its files are short
BALL = 'actor = "sphere"\nparameters = {radius = 0.5}\nmaterial = "metal"\nsmooth = true'
EXPORTS = {"carrada": "Carrada", "radar_scenes": "data", "osi": "traces"}  # module: folder that it writes
ENDED = """
import os, sys
from echopath import dataset
name, folder, out = sys.argv[1:]
module = sys.modules[f"echopath.dataset.exports.{name}"]
last = "_write_trace" if name == "osi" else "write_texts"
before = getattr(module, last)
setattr(module, last, lambda *given: (before(*given), os._exit(9)))
getattr(dataset, f"write_{name}")(dataset.open(folder).remade(), out)
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """{what frames keep: folder of a dataset}."""
    folder = tmp_path_factory.mktemp("exports")
    for keep in ("all", "labels"):
        text = TEMPLATE.format(keep=keep, walker=BOX) + '[dataset.classes]\nwalker = "pedestrian"\n'
        (folder / f"{keep}.toml").write_text(text)
        list(dataset.make(folder / f"{keep}.toml", folder / keep))
    return {keep: folder / keep for keep in ("all", "labels")}


def write(name: str, given, out: Path) -> None:
    if name == "osi":
        pytest.importorskip("osi3")
    getattr(dataset, f"write_{name}")(given, out)


def test_a_frame_that_is_remade_alone_is_the_one_that_was_made(made):
    whole, again = dataset.open(made["all"]), dataset.open(made["labels"]).remade()
    assert again.keep == "all" and again[1:].keep == "all" and "keep='all'" in repr(again)
    ours, theirs = again[1], whole[1]
    assert ours[:4] == theirs[:4]
    np.testing.assert_array_equal(ours.frame.spectrum.values, theirs.frame.spectrum.values)
    for name in ("offsets", "mesh_id", "triangle_id", "u", "amplitude"):
        np.testing.assert_array_equal(getattr(ours.frame.paths, name), getattr(theirs.frame.paths, name))


@pytest.mark.parametrize("name", EXPORTS)
def test_what_a_dataset_does_not_keep_is_told_and_remade(made, tmp_path, name):
    labels = dataset.open(made["labels"])
    with pytest.raises(ValueError, match=r'dataset: must be of a template with .*keep = "all", or its remade\(\)'):
        write(name, labels, tmp_path / "refused")
    assert not bytes_of(tmp_path)
    write(name, dataset.open(made["all"]), tmp_path / "kept")
    write(name, labels.remade(), tmp_path / "remade")
    assert [one.name for one in (tmp_path / "kept").iterdir()] == [EXPORTS[name]]
    assert bytes_of(tmp_path / "kept") == bytes_of(tmp_path / "remade") != {}


@pytest.mark.parametrize("name", EXPORTS)
def test_the_same_call_goes_on_after_a_kill(made, tmp_path, name):
    """A process is ended, while it writes what the other makes again, behind its first table or trace."""
    write(name, dataset.open(made["all"]), tmp_path / "whole")
    killed = subprocess.run([sys.executable, "-c", ENDED, name, made["labels"], tmp_path / "out"])
    assert killed.returncode == 9 and not (tmp_path / "out" / EXPORTS[name]).exists() and bytes_of(tmp_path / "out")
    write(name, dataset.open(made["all"]), tmp_path / "out")
    assert bytes_of(tmp_path / "out") == bytes_of(tmp_path / "whole")
    with pytest.raises(ValueError, match=f"folder: must be one that has no folder '{EXPORTS[name]}' yet"):
        write(name, dataset.open(made["all"]), tmp_path / "out")


def test_frames_of_one_chirp_tell_no_velocity_over_ground(tmp_path):
    """A target at rest beside a radar at 4 m/s is not said to move: all velocities look the same to one chirp."""
    text = TEMPLATE.format(keep="all", walker=BALL).replace("num_chirps = 64", "num_chirps = 1")
    (tmp_path / "still.toml").write_text(text.replace("[radar.waveform]", "[radar]\nspeed = 4.0\n[radar.waveform]"))
    list(dataset.make(tmp_path / "still.toml", tmp_path / "made"))
    dataset.write_radar_scenes(dataset.open(tmp_path / "made"), tmp_path / "out")
    with h5py.File(tmp_path / "out" / "data" / "sequence_1" / "radar_data.h5") as file:
        points, ground = file["radar_data"][:], file["odometry"][:]
    assert len(points) > 0 and ground["vx"] == pytest.approx(4.0)
    assert not points["vr"].any() and not points["vr_compensated"].any()


def test_remade_frames_go_to_other_processes(made):
    frames = dataset.open(made["labels"]).remade()
    first = frames[0].frame.cube
    assert np.array_equal(pickle.loads(pickle.dumps(frames))[0].frame.cube, first)


def test_files_that_a_template_names_are_found_from_where_it_was(tmp_path):
    """A wall beside the template, a dataset elsewhere: until that is moved away, and then by the folder that is given."""
    (tmp_path / "work" / "models").mkdir(parents=True)
    (tmp_path / "work" / "models" / "wall.obj").write_text("v 8 -2 0\nv 8 2 0\nv 8 2 3\nv 8 -2 3\nf 1 2 3 4\n")
    wall = '[[objects]]\nname = "wall"\nmodel = "models/wall.obj"\nmaterial = "brick"\n[trace]'
    (tmp_path / "work" / "walls.toml").write_text(TEMPLATE.format(keep="maps", walker=BOX).replace("[trace]", wall))
    list(dataset.make(tmp_path / "work" / "walls.toml", tmp_path / "disk" / "made"))
    made = dataset.open(tmp_path / "disk" / "made")
    assert "wall" in made.remade()[1].frame.paths.scene
    np.testing.assert_array_equal(made.remade()[1].frame.labels["parts"].object_map, made[1].frame.labels["parts"].object_map)
    shutil.move(tmp_path / "work", tmp_path / "away")
    with pytest.raises(ep.FileError, match=r"made.dataset.toml: line \d+: scene 0: objects.wall.model: /[^:]*models.wall.obj: "):
        dataset.open(made.folder).remade()[1]
    assert "wall" in made.remade(tmp_path / "away")[1].frame.paths.scene


def test_motion_captures_are_people():
    found = classes_of([{"name": "a", "model": "walks/Fast.BVH"}, {"name": "b", "model": "bvh.obj"},
                        {"name": "c", "actor": "van"}, {"name": "d", "model": "ride.bvh"}], {"d": "cyclist"})
    assert found == {"a": "pedestrian", "b": "static", "c": "van", "d": "cyclist"}


def test_groups_are_what_they_carry():
    """By the objects below them, not by what these carry in turn; a glob goes before it."""
    objects = [{"name": "lane", "group": True}, {"name": "convoy", "group": True, "parent": "lane"},
               {"name": "car", "actor": "car", "parent": "lane/convoy"},
               {"name": "roof", "actor": "standing_person", "parent": "lane/convoy/car"},
               {"name": "sign", "actor": "traffic_sign", "parent": "lane"}, {"name": "yard", "group": True},
               {"name": "dog", "actor": "dog", "parent": "yard"}, {"name": "child", "actor": "child", "parent": "yard"},
               {"name": "crowd", "group": True}, {"name": "one", "actor": "runner", "parent": "crowd"},
               {"name": "fence", "group": True}, {"name": "wall", "actor": "wall", "parent": "fence"}]
    found = classes_of(objects, {"crowd": "pedestrian_group"})
    assert {name: found[name] for name in ("lane", "convoy", "yard", "crowd", "fence")} == {
        "lane": "car", "convoy": "car", "yard": "other", "crowd": "pedestrian_group", "fence": "static"}
    assert found["roof"] == "pedestrian"


def test_what_an_object_carries_leaves_others_of_its_name_their_class():
    """Names are unique beside each other alone, and labels have those of the root."""
    rider, sledge = {"name": "rider", "actor": "pedestrian"}, {"name": "sledge", "actor": "box"}
    bag = {"name": "rider", "actor": "box", "parent": "sledge"}
    for objects in ([rider, sledge, bag], [sledge, bag, rider]):
        assert classes_of(objects, {}) == {"rider": "pedestrian", "sledge": "static"}
        for glob, expected in (("sledge/rider", "static"), ("rider", "pedestrian")):  # what labels call so
            assert classes_of(objects, {}, [("rider", (glob,))])["rider"] == expected


def test_labels_of_what_one_object_carries_have_its_class_whatever_another_carries():
    man = {"name": "load", "actor": "standing_person", "parent": "cart"}
    sack = {"name": "load", "actor": "box", "parent": "sledge"}
    for objects in ([man, sack], [sack, man]):
        for name, expected in (("cart", "pedestrian"), ("sledge", "static")):
            for told in ("load", f"{name}/load"):
                assert classes_of(objects, {}, [(told, (f"{name}/load",))])[told] == expected


def test_objects_that_labels_name_have_the_class_of_what_they_are(tmp_path):
    """By a glob of [dataset.classes] that takes their name or what they consist of, else by the object that they are part of."""
    text = TEMPLATE.format(keep="labels", walker=PERSON).replace("frames = 2\ninterval = 0.05\n", "").replace(
        "[radar.waveform]", '[dataset.classes]\n"street/pole" = "other"\nlorry = "truck"\n[radar.waveform]')
    (tmp_path / "street.obj").write_text("v 9 2 0\nv 9 3 0\nv 9 2 4\nv 9 -2 0\nv 9 -3 0\nv 9 -2 4\n"
                                         "o pole\nf 1 2 3\no van\nf 4 5 6\n")
    (tmp_path / "named.toml").write_text(text.replace("[trace]", '[[objects]]\nname = "street"\nmodel = "street.obj"\n'
                                                      '[[objects]]\nname = "cat"\nactor = "dog"\nparent = "street"\n'
                                                      "position = [8.0, 5.0, 0.0]\n[trace]") +
                                         'objects = {person = "walker/*", post = "street/pole", lorry = "street/van", '
                                         'pet = "street/cat"}\n[detections]\n')
    list(dataset.make(tmp_path / "named.toml", tmp_path / "made"))
    made = dataset.open(tmp_path / "made")
    assert list(made.classes(0).items()) == [("walker", "pedestrian"), ("street", "static"), ("cat", "animal"),
                                             ("person", "pedestrian"), ("post", "other"), ("lorry", "truck"), ("pet", "animal")]
    codes = {"person": 7, "post": 10, "lorry": 2, "pet": 9, "": 11}  # of RadarScenes
    dataset.write_radar_scenes(made, tmp_path)
    with h5py.File(tmp_path / "data" / "sequence_1" / "radar_data.h5") as file:
        points = file["radar_data"][:]
    found = made[0].frame.detections
    assert "person" in found.object.tolist()
    assert points["label_id"].tolist() == [codes[name] for name in found.object.tolist()]
    assert [bool(track) for track in points["track_id"]] == [bool(name) for name in found.object.tolist()]


def test_labels_of_several_kinds_of_road_users_are_other():
    objects = [{"name": "car", "actor": "car"}, {"name": "person", "actor": "pedestrian"}, {"name": "house", "actor": "wall"}]
    named = (("all", ("*",)), ("who", ("person/**", "house")), ("what", ("car", "person")), ("walls", ("house",)))
    found = classes_of(objects, {}, named)
    assert {name: found[name] for name, _ in named} == {"all": "other", "who": "pedestrian", "what": "other", "walls": "static"}
