"""Labels in scene files, by commands, as images and in xarray."""
from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
from PIL import Image

import echopath as ep
from echopath.base.text.colours import colours_of
from echopath.cli import main
from echopath.plots import plot_ghosts, plot_labels
from support.files.scene_files import without_line
from support.labelled_scene import SCENE


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
    assert dict(named.sizes) == {"velocity": labels.shape[0], "range": labels.shape[1], "part": 3, "dominant_number": 3,
                                 "object_number": len(labels.objects), "ghost_number": len(labels.ghosts)}
    assert np.array_equal(named.power.sel(part="the van"), labels.power[0]) and named.power.attrs["units"] == "W"
    v, r = np.argwhere(labels.object_map >= 0)[0]
    found = int(named.object.sel(velocity=labels.velocity[v], range=labels.range[r]))
    assert named.object_names[found] == labels.objects[labels.object_map[v, r]].name
    assert np.shares_memory(named.share.values, labels.share) and "share_error" in named
    assert named.attrs["plane"] == "range_doppler" and named.range.attrs["units"] == "m"


def test_pictures_colour_exactly_the_cells_and_tell_what_is_hidden(labels):
    figure = plot_labels(labels)
    axes, = (one for one in figure.axes if one.get_xlabel().startswith("Range"))
    assert _num_cells(axes) == labels.mask.sum()
    hidden = [label for label in labels.objects if label.status != "seen"]
    assert all(f"{label.name}: {label.status}" in axes.get_xlabel() for label in hidden)
    axes = next(one for one in plot_ghosts(labels).axes if one.get_xlabel().startswith("Range"))
    assert _num_cells(axes) == (labels.object_map >= 0).sum() + (labels.ghost_map >= 0).sum()


def test_a_picture_without_cells_of_objects_is_the_map_alone(labels):
    none = np.full(labels.shape, -1, np.int16)
    unseen = [dataclasses.replace(one, status="hidden in noise", cells=0, peak=None, box=None) for one in labels.objects]
    bare = dataclasses.replace(labels, object_map=none, ghost_map=none, objects=unseen, ghosts=[])
    figure = plot_ghosts(bare)
    assert all(axes.has_data() for axes in figure.axes) and len(figure.axes) == 2  # the map and its colour bar
    assert any("none has a cell" in text.get_text() for text in figure.texts)
    assert len(plot_ghosts(labels).axes) == 4


def test_a_picture_of_a_map_that_kept_nothing_is_black(labels):
    """As of files that keep no power outside of an empty mask: it had been white, on a scale about -2975 dBm."""
    nothing = np.zeros(labels.shape)
    empty = dataclasses.replace(labels, whole=nothing, mask=nothing.astype(bool), objects=[], ghosts=[],
                                object_map=nothing.astype(np.int16) - 1, ghost_map=nothing.astype(np.int16) - 1)
    image = plot_ghosts(empty).axes[0].collections[0]
    low, high = image.get_clim()
    noise = 10.0 * np.log10(1e3 * labels.noise_power)
    assert low == pytest.approx(noise) and noise < high < noise + 20.0 and (image.get_array() < low).all()


def _num_cells(axes) -> int:
    from matplotlib.collections import PolyCollection

    return sum(len(one.get_paths()) for one in axes.collections if type(one) is PolyCollection)


def test_labels_of_a_scene_file_are_keywords_of_annotate(scene_path, tmp_path):
    assert ep.load_scene(scene_path).labels == ep.LabelSettings(
        plane="range_doppler", objects={"truck": "van", "person": ["person", "pers*"]}, noise=True, noise_margin_db=6.0,
        dynamic_range_db=60.0, errors=True)
    scene_path = tmp_path / "plain.toml"
    scene_path.write_text(SCENE)
    assert ep.load_scene(scene_path).labels is None and ep.load_scene(scene_path).detection_settings() is None


@pytest.mark.parametrize("table, message", [
    ("objects = 3", 'labels.objects: must be globs in an array, a table of name = glob or name = [globs], or "found", got 3'),
    ("objects = {a = []}", "labels.objects: must be globs in an array"),
    ("objects = ['vam']",
     "labels.objects: path expression: expected a glob that takes a mesh, got 'vam'; nearest names: van"),
    ("dynamic_range_db = -3.0", "labels.dynamic_range_db: must be at least 0"),
    ("planes = 'x'", "labels.planes: unknown key; did you mean 'plane'?"),
    ("[detections]\nfalse_alarm_rate = 0.0", "detections.false_alarm_rate: must be at least 1e-15"),
    ("[detections]\nmethod = 'gold'", "detections.method: must be 'ca', 'os', 'go' or 'so', got 'gold'"),
    ("[detections]\nrank = 1.5", "detections.rank: must be at most 1"),
])
def test_faults_of_labels_name_the_key(tmp_path, table, message):
    path = tmp_path / "bad.toml"
    path.write_text(f"{SCENE}[labels]\n{table}\n")
    with pytest.raises(ValueError) as fault:
        ep.load_scene(path)
    assert without_line(str(fault.value)).startswith(f"{path}: {message}")


@pytest.mark.usefixtures("blank_pictures")
def test_commands_write_labels(scene_path, tmp_path, capsys):
    assert main(["run", str(scene_path), "--out", str(tmp_path / "run"), "--part", "one=T . R"]) == 0
    told = capsys.readouterr().out
    assert "cells labelled, by" in told and "label_maps/parts_by.png" in told and "ghosts " in told
    assert "detections, detections.csv" in told and (tmp_path / "run" / "detections.csv").read_text().startswith("range_m,")
    assert (tmp_path / "run" / "objects_and_ghosts.png").exists()
    assert (tmp_path / "run" / "label_maps" / "parts_power.json").exists()
    arguments = ["labels", str(tmp_path / "run" / "frame.h5"), "--out", str(tmp_path / "more"), "--part", "near=T . R",
                 "--object", "person = pers*", "--dynamic-range", "30"]
    assert main([*arguments, "--cfar", "os", "--false-alarm-rate", "1e-3", "--beams"]) == 0
    told = capsys.readouterr().out
    assert "detections, detections.csv" in told and len((tmp_path / "more" / "detections.csv").read_text().splitlines()) > 1
    assert "cells labelled, choice 2" in told and "hidden by" in told and "van 100%" in told
    made = ep.load_labels(tmp_path / "more" / "labels.h5")
    assert list(made) == ["by", "power", "choice", "choice 2"] and made["choice 2"].dynamic_range_db == 30.0
    assert [label.name for label in made["by"].objects] == ["person"]
    assert (tmp_path / "more" / "labels_choice_2.png").exists()


@pytest.mark.parametrize("arguments, message", [
    (("--object", "person"), "object: must be NAME=GLOB"),
    (("--part", "T . R"), "part: must be NAME=SELECTION"),
    (("--plane", "range_azimuth", "--errors"), "errors: in the plane 'range_azimuth' need"),
])
def test_bad_options_are_told(saved, tmp_path, capsys, arguments, message):
    assert main(["labels", str(saved), "--out", str(tmp_path / "out"), *arguments]) == 2
    assert message in capsys.readouterr().err and not (tmp_path / "out").exists()
