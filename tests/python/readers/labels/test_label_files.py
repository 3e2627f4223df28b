"""Labels in files: HDF5 that reads back the same bits."""
from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.cli.info import describe_file
from support.files.frame_edits import edited

SAME_SHARES = 1e-9  # of doubles summed by other groups; of the strongest cell


def assert_same(first, second):
    """Every field has the same type, shape and bits."""
    for field in dataclasses.fields(ep.Labels):
        one, other = getattr(first, field.name), getattr(second, field.name)
        assert type(one) is type(other), field.name
        if isinstance(one, np.ndarray):
            assert one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes(), field.name
        else:
            assert one == other, field.name


def test_labels_of_a_frame_file_are_the_same_bits(frame, labels, saved):
    loaded = ep.load_frame(saved).labels
    assert list(loaded) == ["by", "power"] and labels.certain is not None
    for partition, one in loaded.items():
        assert_same(one, frame.labels[partition])
    assert list(ep.load_labels(saved)) == list(loaded)


def test_info_tells_of_a_file_of_labels_alone(frame, tmp_path):
    ep.save_labels(frame.labels, tmp_path / "labels.h5")
    told = "\n".join(describe_file(tmp_path / "labels.h5"))
    assert "\n".join(describe_file(tmp_path)) == told  # the folder that they were written to
    cells = {name: np.count_nonzero(of.mask) for name, of in frame.labels.items()}
    assert "labels of a frame, without its map and paths" in told
    assert all(f"{count:,} of" in told and f"labelled, {name}" in told for name, count in cells.items())


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
    section = (Path(__file__).parents[4] / "data" / "README.md").read_text().split("## Frame files (HDF5)")[1]
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


def test_parts_of_a_saved_frame_have_their_selections(frame, saved):
    """Errors of labels, which need these, were refused: the parts were cubes alone."""
    made, wanted = (ep.annotate(one.paths, one.parts["by"], errors=True) for one in (ep.load_frame(saved), frame))
    assert_same(made, wanted)


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
