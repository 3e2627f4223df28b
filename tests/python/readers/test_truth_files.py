"""Truth in files: the same bits in frame files and folders, tables of it, old files, damaged ones, the command line."""
import csv

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.cli import main
from support.files.frame_edits import edited
from support.files.scene_text import ANTENNAS, WAVEFORM, moving_plate
from support.frames_in_time import make_sequence
from support.radars import build_radar

SPEED = 3.0  # m/s


def two_boxes():
    """One drives by, one enters from behind the radar, where it has no cross section."""
    scene = ep.Scene()
    for name, place, speed in (("car", (12, 3, 0), SPEED), ("bus", (-6, 2, 0), 0.0)):
        scene.add(ep.actors.box((4.0, 2.0, 1.5)), name=name, material="metal", position=place, speed=speed)
    return scene, build_radar((ep.Antenna(pattern=ep.CosinePower(2.0)),), num_chirps=16)


@pytest.fixture(scope="module")
def frame():
    return ep.simulate(*two_boxes(), num_rays=500, guard=False, truth=True)


@pytest.fixture
def path(frame, tmp_path):
    ep.save_frame(frame, tmp_path / "frame.h5")
    return tmp_path / "frame.h5"


# --- frame files ---

def test_a_frame_file_gives_back_the_same_truth(frame, path):
    found = ep.load_frame(path)
    assert found.kept_truth == frame.kept_truth == found.truth == ep.truth(found)
    assert found.truth.name.tolist() == ["car", "bus"] and np.isnan(found.truth.rcs[1])
    assert ep.truth(found, ["car"]) == ep.truth(frame.paths, ["car"])  # others than those of the file: from the paths


def test_what_was_not_asked_for_costs_nothing(tmp_path):
    plain = ep.simulate(*two_boxes(), num_rays=500, guard=False)
    assert plain.kept_truth is None and "truth" not in [stage.name for stage in plain.stages]
    ep.save_frame(plain, tmp_path / "plain.h5")
    with h5py.File(tmp_path / "plain.h5") as file:
        assert "truth" not in file
    old = ep.load_frame(tmp_path / "plain.h5")  # the layout of files from before there was a group `truth`
    assert old.kept_truth is None and old.truth == plain.truth


@pytest.mark.parametrize("asked, names", [({"objects": ["car"]}, ["car"]), ({"objects": {"both": ["*"]}}, ["both"]),
                                          ({}, ["car", "bus"])])
def test_objects_may_be_chosen(asked, names):
    scene, radar = two_boxes()
    assert ep.simulate(scene, radar, num_rays=200, guard=False, truth=asked).truth.name.tolist() == names
    named = ep.simulate(scene, radar, num_rays=200, guard=False, truth=True, labels={"objects": ["bus"]})
    assert named.truth.name.tolist() == ["bus"]  # as those of the labels


@pytest.mark.parametrize("asked, words", [
    (3, "truth: must be True, False or a dict"), ({"object": "car"}, "truth: unknown keyword 'object', the nearest .* 'objects'"),
    ({"objects": ["lorry"]}, "truth: .*lorry"), ({"objects": 3}, "truth: objects: must be a dict or a list of globs")])
def test_wrong_requests_are_refused_before_the_work(asked, words):
    with pytest.raises((TypeError, ValueError), match=words):
        ep.simulate(*two_boxes(), num_rays=1e9, guard=False, truth=asked)


def _without(group, name):
    del group[name]


def _replaced(group, name, values):
    del group[name]
    group[name] = values
    group[name].attrs["unit"] = ""


@pytest.mark.parametrize("change, words", [
    (lambda group: _without(group, "rcs"), "/truth/rcs: no such dataset"),
    (lambda group: _replaced(group, "rcs", np.zeros(5)), r"/truth/rcs must have the shape \[2\], has \[5\]"),
    (lambda group: _replaced(group, "yaw", np.zeros(2, np.float32)), "/truth/yaw must hold float64, holds float32"),
    (lambda group: _replaced(group, "rotation", np.full((2, 3, 3), np.nan)), "/truth/rotation: must hold finite numbers"),
    (lambda group: _replaced(group, "name", np.array([b"a", b"a"])), "/truth/name: must name each object once"),
    (lambda group: _replaced(group, "name", np.array([b"\xff", b"a"])), "/truth/name: .*utf-8")])
def test_a_file_that_was_changed_is_refused_by_name(path, change, words):
    with edited(path) as file:
        change(file["truth"])
    with pytest.raises(ep.FileError, match=words):
        ep.load_frame(path)


def test_files_from_before_there_were_boxes_in_radar_axes_lack_them(frame, path):
    import h5py

    with h5py.File(path, "r+") as file:
        for name in ("rotation_in_radar", "direction_in_radar"):
            del file[f"truth/{name}"]
    found = ep.load_frame(path).truth
    assert np.isnan(found.rotation_in_radar).all() and np.isnan(found.corners_in_radar).all()
    assert np.array_equal(found.position_in_radar, frame.truth.position_in_radar)


def test_a_value_that_lost_a_bit_is_noticed(path):
    with h5py.File(path, "r+") as file:
        file["truth/position"][0, 0] += 1e-9
    with pytest.raises(ep.FileError, match="/truth/position: damaged, its values do not have its check sum"):
        ep.load_frame(path)


# --- folders ---

@pytest.mark.parametrize("keep", ["all", "maps", "labels"])
def test_a_folder_has_the_truth_of_each_of_its_frames(tmp_path, keep):
    frames = make_sequence(frames=3, truth=True)
    stored = frames.save(tmp_path / "frames", keep=keep)
    expected = ep.truth(frames)
    assert stored.truth == expected == ep.truth(stored) and expected.frame.tolist() == [0, 1, 2]
    assert stored[1:].truth.frame.tolist() == [0, 1] and stored[2].kept_truth.frame.tolist() == [0]
    (tmp_path / "frames" / "frame_0001.h5").unlink()
    assert stored.truth.frame.tolist() == [0, 2]
    with pytest.raises(ValueError, match="path: must be new, or of this sequence .truth is"):
        make_sequence(frames=3).save(tmp_path / "frames", keep=keep)
    with edited(tmp_path / "frames" / "frame_0002.h5") as file:
        del file["truth"]
    with pytest.raises(ep.FileError, match="frame_0002.h5: holds no truth, which the run was asked for"):
        stored.truth  # noqa: B018
    for left in (tmp_path / "frames").glob("frame_*.h5"):
        left.unlink()
    with pytest.raises(ValueError, match="frames: must have frames, has none that is done"):
        stored.truth  # noqa: B018


def test_a_folder_without_truth_says_so(tmp_path):
    stored = make_sequence(frames=1).save(tmp_path / "frames", keep="maps")
    with pytest.raises(ValueError, match="must be of a run with truth=True, keeps no truth"):
        stored.truth  # noqa: B018
    with pytest.raises(ValueError, match="frame: must be of a run with truth=True, got FrameMaps"):
        ep.truth(stored)


def test_named_arrays_have_a_gap_where_a_frame_lacks_an_object(frame):
    pytest.importorskip("xarray")
    car = frame.truth.of_object("car")
    both = np.concatenate([frame.truth.to_records(), car.to_records()])
    both["frame"][2], both["time"][2] = 4, 0.5
    found = ep.Truth.from_records(both).to_xarray()
    assert dict(found.sizes) == {"time": 2, "object": 2, "axis": 3, "side": 3}
    assert found.frame.values.tolist() == [0, 4] and found.time.values[1] == 0.5
    assert found.velocity.sel(object="car", axis="x").values == pytest.approx([SPEED, SPEED])
    assert np.isnan(found.position.sel(object="bus")[1]).all() and found.rcs.attrs["units"] == "m^2"
    assert np.array_equal(found.rotation.sel(object="car")[0], frame.truth.rotation[0])


def test_named_arrays_of_a_folder_have_the_truth(tmp_path):
    pytest.importorskip("xarray")
    stored = make_sequence(frames=2, truth=True).save(tmp_path / "frames", keep="maps")
    found = stored.to_xarray()
    assert found.truth_position.dims == ("time", "truth_object", "truth_axis")
    assert np.array_equal(found.truth_position[1, 0], stored[1].kept_truth.position[0]) and len(found.range) > 10


# --- command line ---

SCENE = 'title = "two plates"\nguard = false\n' + WAVEFORM + ANTENNAS + moving_plate("near", 1.0, 1.0, 5.0, -1.0) + moving_plate(
    "far", 2.0, 1.0, 9.0, 2.0) + "[trace]\nnum_rays = 400\n"


def rows_of(path):
    return list(csv.DictReader(path.open(encoding="utf-8")))


@pytest.mark.usefixtures("blank_pictures")
def test_a_run_writes_a_table(tmp_path, capsys):
    (tmp_path / "scene.toml").write_text(SCENE)
    assert main(["run", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out"), "--truth"]) == 0
    rows = rows_of(tmp_path / "out" / "truth.csv")
    assert [row["name"] for row in rows] == ["near", "far"] and float(rows[1]["vx_m_per_s"]) == pytest.approx(2.0)
    assert "truth" in capsys.readouterr().out
    assert main(["info", str(tmp_path / "out" / "frame.h5")]) == 0
    said = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["near", "5.10", "m", "-0.1", "deg", "-0.98", "m/s"] in [words[:7] for words in said]


@pytest.mark.usefixtures("blank_pictures")
def test_a_scene_file_may_ask_for_it(tmp_path, capsys):
    (tmp_path / "scene.toml").write_text(SCENE + '[truth]\nobjects = ["far"]\n')
    assert main(["run", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out"), "--frames", "2", "--interval", "0.1",
                 "--keep", "maps"]) == 0
    rows = rows_of(tmp_path / "out" / "truth.csv")
    assert [(row["frame"], row["name"]) for row in rows] == [("0", "far"), ("1", "far")]
    assert float(rows[1]["x_m"]) - float(rows[0]["x_m"]) == pytest.approx(0.2)
    capsys.readouterr()
    (tmp_path / "bad.toml").write_text(SCENE + '[truth]\nobjects = ["lorry"]\n')
    assert main(["run", str(tmp_path / "bad.toml"), "--out", str(tmp_path / "out")]) == 2
    assert "truth.objects" in capsys.readouterr().err
