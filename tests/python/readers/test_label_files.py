"""Labels in files: HDF5 that reads back the same bits, images whose pixels are labels, xarray, scene files, the command."""
from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from PIL import Image

import echopath as ep
from echopath.base.colours import colours_of
from echopath.cli import main
from echopath.plots import plot_ghosts, plot_labels
from support.frame_edits import edited
from support.scene_text import WAVEFORM, moving_plate

SAME_SHARES = 1e-9  # of doubles summed by other groups; of the strongest cell
SCENE = """
title = "a person behind a van, beside a wall"
""" + WAVEFORM + """\
[radar]
transmit_power = 10.0
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.01, 1.0]
[[radar.receivers]]
position = [0.0, 0.012, 1.0]
""" + moving_plate("van", 2.0, 2.0, 6.0, -2.0) + moving_plate("person", 0.3, 1.0, 8.0, -1.0) + """
[[objects]]
name = "wall"
actor = "wall"
parameters = {length = 30.0, height = 6.0}
position = [10.0, 4.0, 0.0]
material = {base = "concrete", mirror = true}
[trace]
num_rays = 3000
batches = 2
[parts.by]
"the van" = "T 'van' R"
"over the wall" = "T .* 'wall' .* R"
[parts.power]
strong = "power > 1e-14"
"""
DETECTIONS = "[detections]\nmethod = 'os'\nfalse_alarm_rate = 1e-3\ntraining_velocity = 0\n"
LABELS = "[labels]\nobjects = {truck = 'van', person = ['person', 'pers*']}\nerrors = true\nnoise_margin_db = 6.0\n"


@pytest.fixture(scope="module")
def scene_path(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "van.toml"
    path.write_text(SCENE + LABELS + DETECTIONS)
    return path


@pytest.fixture(scope="module")
def frame(scene_path):
    file = ep.load_scene(scene_path)
    return ep.simulate(file.scene, file.radar, trace=file.trace, signal=file.signal, parts=file.partitions(),
                       labels=file.labels, detections=file.detection_settings())


@pytest.fixture(scope="module")
def labels(frame):
    """With cells of objects, of ghosts and an object that is hidden, else these tests prove little."""
    made = frame.labels["by"]
    assert {label.status for label in made.objects} >= {"seen"} and any(label.occluders for label in made.objects)
    assert (made.object_map >= 0).any() and (made.ghost_map >= 0).any() and any(ghost.box is None for ghost in made.ghosts)
    assert len(set(made.dominant[made.mask])) > 1
    return made


@pytest.fixture
def saved(frame, tmp_path):
    ep.save_frame(frame, tmp_path / "frame.h5")
    return tmp_path / "frame.h5"


def assert_same(first, second):
    """Every field has the same type, shape and bits."""
    for field in dataclasses.fields(ep.Labels):
        one, other = getattr(first, field.name), getattr(second, field.name)
        assert type(one) is type(other), field.name
        if isinstance(one, np.ndarray):
            assert one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes(), field.name
        else:
            assert one == other, field.name


# --- HDF5 ---

def test_labels_of_a_frame_file_are_the_same_bits(frame, labels, saved):
    loaded = ep.load_frame(saved).labels
    assert list(loaded) == ["by", "power"] and labels.certain is not None
    for partition, one in loaded.items():
        assert_same(one, frame.labels[partition])
    assert list(ep.load_labels(saved)) == list(loaded)


def test_labels_of_a_file_of_their_own_are_the_same_bits(frame, labels, tmp_path):
    without_errors = dict.fromkeys(("mean_power", "mean_share", "power_error", "share_error", "certain"))
    plain = dataclasses.replace(labels, objects=[], ghosts=[], object_map=np.full(labels.shape, -1, np.int16),
                                ghost_map=np.full(labels.shape, -1, np.int16), dynamic_range_db=np.inf, **without_errors)
    above = ep.annotate(frame.paths, {"a": "T . R"}, plane="range_azimuth")
    given = {"plain": plain, "from above": above, "": labels}
    ep.save_labels(given, tmp_path / "labels.h5")
    loaded = ep.load_labels(tmp_path / "labels.h5")
    assert list(loaded) == list(given)
    for partition, one in loaded.items():
        assert_same(one, given[partition])


DAMAGES = {
    "a part that is not there": (lambda group: group["dominant"].write_direct(np.full(group["dominant"].shape, 3, np.int16)),
                                 "dominant: must be -1 to 2"),
    "a ghost that is not there": (lambda group: group["ghost_map"].write_direct(
        np.full(group["ghost_map"].shape, -2, np.int16)),
                                  "ghost_map: must be -1 to"),
    "another plane": (lambda group: group.attrs.modify("plane", np.bytes_("range_height")), "unknown plane 'range_height'"),
    "powers of other parts": (lambda group: group.move("mean_power", "power2"), "mean_power: no such dataset"),
    "an occluder of nobody": (lambda group: group["objects/occluded"].write_direct(
        np.full(group["objects/occluded"].shape, 7, np.int32)), "occluded: must be 0 to 1"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_labels_that_contradict_themselves_are_refused(saved, damage):
    change, message = DAMAGES[damage]
    with edited(saved) as file:
        change(file["labels/0"])
    with pytest.raises(ep.FileError, match=message):
        ep.load_frame(saved)


def test_a_file_without_labels_is_told(frame, tmp_path):
    frame.paths.save(tmp_path / "paths.h5")
    with pytest.raises(ep.FileError, match="labels: no such group"):
        ep.load_labels(tmp_path / "paths.h5")


def test_the_layout_is_written_down(saved):
    """Each name of the group stands in data/README.md."""
    with h5py.File(saved, "r") as file:
        names, attributes = [], list(file["labels/0"].attrs)
        for group in ("labels/0", "detections"):
            file[group].visit(names.append)
    section = (Path(__file__).parents[3] / "data" / "README.md").read_text().split("## Frame files (HDF5)")[1]
    missing = [name for name in [*names, *attributes] if not re.search(f"[`/]{name.rpartition('/')[2]}/?`", section)]
    assert not missing


def test_detections_of_a_frame_file_are_the_same_bits_and_know_their_paths(frame, saved):
    given, loaded = frame.detections, ep.load_frame(saved).detections
    assert len(given) > 2 and {"truck"} <= set(given.object)
    for field in dataclasses.fields(ep.Detections):
        if field.name != "echoes":
            one, other = np.asarray(getattr(given, field.name)), np.asarray(getattr(loaded, field.name))
            same = np.array_equal(one, other) if one.dtype.kind == "U" else one.tobytes() == other.tobytes()
            assert same and one.dtype.kind == other.dtype.kind and one.shape == other.shape, field.name
    for index in range(len(given)):
        for one, other in zip(given.paths(index), loaded.paths(index)):
            assert np.array_equal(one, other)


def test_detections_outside_of_the_map_are_refused(saved):
    with edited(saved) as file:
        file["detections/cells"][0, 1] = 64
    with pytest.raises(ep.FileError, match="detections/cells: must lie within"):
        ep.load_frame(saved)


# --- a saved frame is enough ---

def test_labels_of_a_saved_frame_are_those_of_the_simulation(frame, labels, saved):
    again = ep.annotate_frame(ep.load_frame(saved), {"more": {"near": "T . R"}},
                              objects={"truck": "van", "person": "person"},
                              noise_margin_db=6.0, errors=True)
    assert list(again) == ["by", "power", "more"]
    for name in ("power", "share", "dominant", "mask", "whole"):  # of cubes in the file
        assert np.array_equal(getattr(again["by"], name), getattr(labels, name)), name
    assert [label.status for label in again["by"].objects] == [label.status for label in labels.objects]
    assert np.array_equal(again["by"].ghost_map, labels.ghost_map) and again["more"].part_names == ["near", "other"]
    difference = again["more"].power.sum(axis=0) - ep.annotate(frame.paths, {"near": "T . R"}).power.sum(axis=0)
    assert np.abs(difference).max() < SAME_SHARES * labels.whole.max()


def test_a_file_of_paths_alone_can_be_labelled(frame, labels, tmp_path):
    frame.paths.save(tmp_path / "paths.h5")
    made = ep.annotate_frame(ep.load_frame(tmp_path / "paths.h5"), objects=["van", "person"])
    assert list(made) == ["parts"] and made["parts"].part_names == ["other"]
    assert np.allclose(made["parts"].whole, labels.whole, rtol=0.0, atol=SAME_SHARES * labels.whole.max())


def test_other_parts_take_the_place_of_a_partition_of_the_same_name(frame):
    again = ep.annotate_frame(frame, {"by": {"near": "T . R"}})
    alone = ep.annotate(frame.paths, {"near": "T . R"})
    assert list(again) == list(frame.parts) and again["by"].part_names == ["near", "other"]
    assert np.abs(again["by"].power.sum(axis=0) - alone.power.sum(axis=0)).max() < SAME_SHARES * alone.whole.max()


def test_parts_of_a_frame_name_meshes(frame):
    with pytest.raises(ValueError, match=r"parts.more.a: path expression: expected a glob that takes a mesh, got 'vam'"):
        ep.annotate_frame(frame, {"more": {"a": "T 'vam' R"}})


# --- images ---

def test_pixels_are_labels_and_the_palette_names_them(labels, tmp_path):
    written = ep.save_label_images(labels, tmp_path, {"parts": "parts of cells", "objects": "objects", "ghosts": "ghosts"})
    assert [path.name for path in written] == ["parts of cells.png", "objects.png", "ghosts.png"]
    for path, cells in zip(written, (labels.dominant, labels.object_map, labels.ghost_map)):
        image, palette = Image.open(path), json.loads(path.with_suffix(".json").read_text())
        assert np.array_equal(np.array(image, int) - 1, cells)
        colours = np.array(image.getpalette()).reshape(-1, 3)
        for row in palette["labels"]:
            assert "#{:02x}{:02x}{:02x}".format(*colours[row["index"]]) == row["colour"]
        assert [row["index"] for row in palette["labels"]] == list(range(len(palette["labels"])))
        assert palette["axes"]["rows"] == {"name": "velocity", "unit": "m/s", "values": labels.velocity.tolist()}
        assert palette["image"] == path.name and len(palette["axes"]["columns"]["values"]) == labels.shape[1]
    assert [row["name"] for row in json.loads((tmp_path / "parts of cells.json").read_text())["labels"]] == [
        "none", *labels.part_names]
    hidden = next(index for index, label in enumerate(labels.objects) if label.occluders)
    entry, label = json.loads((tmp_path / "objects.json").read_text())["labels"][1 + hidden], labels.objects[hidden]
    assert all(entry[key] == getattr(label, key) for key in ("status", "visible_share", "occluders", "is_occluded"))
    ghost = json.loads((tmp_path / "ghosts.json").read_text())["labels"][1]
    assert (ghost["object"], ghost["class_code"], tuple(ghost["via"])) == (
        labels.ghosts[0].object, labels.ghosts[0].class_code, labels.ghosts[0].via)


def test_more_labels_than_colours_take_16_bits(labels, tmp_path):
    names = [f"part {index}" for index in range(300)]
    dominant = np.arange(labels.whole.size, dtype=np.int16).reshape(labels.shape) % 301 - 1
    many = dataclasses.replace(labels, part_names=names, dominant=dominant)
    path, = ep.save_label_images(many, tmp_path, {"parts": "parts"})
    assert np.array_equal(np.array(Image.open(path), int) - 1, dominant)


def test_colours_differ_and_stay_with_their_place():
    names = [f"part {index}" for index in range(40)]
    colours = np.array(colours_of(names))
    apart = np.abs(colours[:, None] - colours[None]).max(axis=2) + 255 * np.eye(len(names), dtype=int)
    assert apart.min() >= 8 and colours_of(names[:5]) == colours_of(names)[:5]
    assert colours_of(["a", "other", "b"]) == [colours_of(["a"])[0], (128, 128, 128), colours_of(["a", "b"])[1]]


def test_xarray_has_the_cells_by_name(labels):
    named = labels.to_xarray()
    assert dict(named.sizes) == {"velocity": labels.shape[0], "range": labels.shape[1], "part": 3}
    assert np.array_equal(named.power.sel(part="the van"), labels.power[0]) and named.power.attrs["units"] == "W"
    v, r = np.argwhere(labels.object_map >= 0)[0]
    found = int(named.object.sel(velocity=labels.velocity[v], range=labels.range[r]))
    assert named.object.attrs["names"][found] == labels.objects[labels.object_map[v, r]].name
    assert np.shares_memory(named.share.values, labels.share) and "share_error" in named
    assert named.attrs["plane"] == "range_doppler" and named.range.attrs["units"] == "m"


# --- pictures ---

def test_pictures_colour_exactly_the_cells_and_tell_what_is_hidden(labels):
    figure = plot_labels(labels)
    axes, = (one for one in figure.axes if one.get_xlabel().startswith("Range"))
    assert _num_cells(axes) == labels.mask.sum()
    hidden = [label for label in labels.objects if label.status != "seen"]
    assert all(f"{label.name}: {label.status}" in axes.get_xlabel() for label in hidden)
    axes = next(one for one in plot_ghosts(labels).axes if one.get_xlabel().startswith("Range"))
    assert _num_cells(axes) == (labels.object_map >= 0).sum() + (labels.ghost_map >= 0).sum()


def _num_cells(axes) -> int:
    from matplotlib.collections import PolyCollection

    return sum(len(one.get_paths()) for one in axes.collections if type(one) is PolyCollection)


# --- scene files and commands ---

def test_labels_of_a_scene_file_are_keywords_of_annotate(scene_path, tmp_path):
    assert ep.load_scene(scene_path).labels == ep.LabelSettings(
        plane="range_doppler", objects={"truck": "van", "person": ["person", "pers*"]}, noise=True, noise_margin_db=6.0,
        dynamic_range_db=60.0, errors=True)
    scene_path = tmp_path / "plain.toml"
    scene_path.write_text(SCENE)
    assert ep.load_scene(scene_path).labels is None and ep.load_scene(scene_path).detection_settings() is None


@pytest.mark.parametrize("table, message", [
    ("objects = 3", "labels.objects: must be globs in an array, or a table of name = glob or name = [globs], got 3"),
    ("objects = {a = []}", "labels.objects: must be globs in an array"),
    ("objects = ['vam']",
     "labels.objects: path expression: expected a glob that takes a mesh, got 'vam'; nearest names: van"),
    ("dynamic_range_db = -3.0", "labels.dynamic_range_db: must be at least 0"),
    ("planes = 'x'", "labels.planes: unknown key; did you mean 'plane'?"),
    ("[detections]\nfalse_alarm_rate = 0.0", "detections.false_alarm_rate: must be at least 1e-15"),
    ("[detections]\nmethod = 'go'", "detections.method: must be 'ca' or 'os', got 'go'"),
    ("[detections]\nrank = 1.5", "detections.rank: must be at most 1"),
])
def test_faults_of_labels_name_the_key(tmp_path, table, message):
    path = tmp_path / "bad.toml"
    path.write_text(f"{SCENE}[labels]\n{table}\n")
    with pytest.raises(ValueError) as fault:
        ep.load_scene(path)
    assert str(fault.value).startswith(f"{path}: {message}")


def test_commands_write_labels(scene_path, tmp_path, capsys):
    assert main(["run", str(scene_path), "--out", str(tmp_path / "run"), "--part", "one=T . R"]) == 0
    told = capsys.readouterr().out
    assert "cells labelled, by" in told and "label_maps/parts_by.png" in told and "ghosts " in told
    assert "detections, detections.csv" in told and (tmp_path / "run" / "detections.csv").read_text().startswith("range_m,")
    assert (tmp_path / "run" / "objects_and_ghosts.png").exists()
    assert (tmp_path / "run" / "label_maps" / "parts_power.json").exists()
    arguments = ["labels", str(tmp_path / "run" / "frame.h5"), "--out", str(tmp_path / "more"), "--part", "near=T . R",
                 "--object", "person = pers*", "--dynamic-range", "30"]
    assert main([*arguments, "--cfar", "os", "--false-alarm-rate", "1e-3"]) == 0
    told = capsys.readouterr().out
    assert "detections, detections.csv" in told and len((tmp_path / "more" / "detections.csv").read_text().splitlines()) > 1
    assert "cells labelled, choice 2" in told and "hidden by" in told and "van 100%" in told
    made = ep.load_labels(tmp_path / "more" / "labels.h5")
    assert list(made) == ["by", "power", "choice", "choice 2"] and made["choice 2"].dynamic_range_db == 30.0
    assert [label.name for label in made["by"].objects] == ["person"]
    assert (tmp_path / "more" / "labels_choice_2.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("arguments, message", [
    (("--object", "person"), "object: must be NAME=GLOB"),
    (("--part", "T . R"), "part: must be NAME=SELECTION"),
    (("--plane", "range_azimuth", "--errors"), "errors: in the plane 'range_azimuth' need"),
])
def test_bad_options_are_told(saved, tmp_path, capsys, arguments, message):
    assert main(["labels", str(saved), "--out", str(tmp_path / "out"), *arguments]) == 2
    assert message in capsys.readouterr().err and not (tmp_path / "out").exists()
