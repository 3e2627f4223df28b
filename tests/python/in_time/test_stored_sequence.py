"""Frames in time that are read from a folder: the same bits as those that were simulated."""
from __future__ import annotations

import dataclasses
import pickle
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.frame.maps import FrameMaps
from echopath.frame_file.maps import load_maps, save_maps
from echopath.sequence.folder import FolderStore
from support.frames_in_time import DISTANCE, INTERVAL, SPEED, make_radar, make_sequence


@pytest.fixture(scope="module")
def folders(tmp_path_factory) -> dict[str, Path]:
    """{keep: folder}"""
    made = {keep: tmp_path_factory.mktemp(keep) for keep in ("all", "maps", "labels")}
    for keep, folder in made.items():
        make_sequence().save(folder, keep=keep)
    return made


def test_files_hold_what_was_simulated(folders):
    stored = ep.load_sequence(folders["all"])
    for made, read in zip(make_sequence(), stored):
        assert np.array_equal(made.noisy_cube, read.noisy_cube) and made.labels == read.labels
        assert made.detections == read.detections
    assert stored.times.tolist() == make_sequence().times.tolist() and stored.interval == INTERVAL
    assert len(stored) == 4 and stored.is_done.all() and stored.keep == "all"
    assert [mesh.name for mesh in stored.scene.meshes] == ["plate"] and stored.radar == make_radar()
    assert stored.settings["num_rays"] == 500 and stored.settings["parts"] == {"parts": {"plate": "T 'plate' R"}}


def test_stored_frames_are_found_as_in_any_sequence(folders):
    stored = ep.load_sequence(folders["maps"])
    part = stored[::-1][1:]
    assert part.times.tolist() == stored.times[2::-1].tolist() and part.interval == -INTERVAL
    assert part[0] == stored[2] == stored[-2] and [frame.start_time for frame in part] == part.times.tolist()
    assert repr(part).endswith("3 frames from 0.2 to 0 s, 3 done, keep='maps')") and "maps" in part._repr_html_()
    with pytest.raises(IndexError, match="^frame: must be from -4 to 3"):
        stored[4]


@pytest.mark.parametrize("use", [lambda stored: stored.plot(num_frames=1), lambda stored: stored.to_xarray()])
def test_twice_as_many_frames_have_their_files_named_twice_as_often(folders, use, monkeypatch):
    named, frame_path = [], FolderStore.frame_path
    monkeypatch.setattr(FolderStore, "frame_path", lambda store, place: named.append(place) or frame_path(store, place))
    stored, counts = ep.load_sequence(folders["maps"]), []
    for frames in (stored[:2], stored):
        use(frames)
        counts.append(len(named))
        named.clear()
    assert counts[1] == 2 * counts[0] > 0


@pytest.mark.parametrize("keep", ["maps", "labels"])
def test_small_files_keep_labels_and_maps(folders, keep):
    for made, kept in zip(make_sequence(), ep.load_sequence(folders[keep])):
        whole, labels = made.labels["parts"], kept.labels["parts"]
        for name in ("mask", "dominant", "object_map", "ghost_map", "above_noise"):
            assert np.array_equal(getattr(whole, name), getattr(labels, name)), name
        assert labels.objects == whole.objects and labels.ghosts == whole.ghosts
        assert np.array_equal(labels.power, np.where(whole.mask, whole.power, 0.0))
        assert np.array_equal(labels.share, np.where(whole.mask, whole.share, 0.0))
        assert np.array_equal(kept.detections.range, made.detections.range) and kept.detections.echoes is None
        power = np.abs(made.spectrum.values[0, 0]) ** 2
        assert kept.power is None if keep == "labels" else np.allclose(kept.power, power, rtol=1e-6, atol=0.0)


def test_what_is_stored_travels(folders):
    stored = pickle.loads(pickle.dumps(ep.load_sequence(folders["maps"])[1:]))
    assert len(stored) == 3 and stored[0] == pickle.loads(pickle.dumps(ep.load_sequence(folders["maps"])[1]))


def test_frames_are_read_in_any_working_folder(folders, tmp_path, monkeypatch):
    monkeypatch.chdir(folders["all"].parent)
    stored = ep.load_sequence(folders["all"].name)
    monkeypatch.chdir(tmp_path)
    assert stored.is_done.all() and np.array_equal(stored[1].cube, ep.load_sequence(folders["all"])[1].cube)
    assert repr(stored).startswith(f"StoredSequence('{folders['all'].name}', 4 frames")


def test_damaged_settings_are_told_by_their_file(folders, tmp_path):
    path = tmp_path / "sequence.h5"
    path.write_bytes((folders["maps"] / "sequence.h5").read_bytes())
    with h5py.File(path, "r+") as file:
        file["settings"].attrs["keep"] = np.bytes_('"some"')
    with pytest.raises(ep.FileError, match=r"sequence.h5: damaged settings \(keep 'some'\)"):
        ep.load_sequence(tmp_path)
    path.write_bytes((folders["maps"] / "frame_0000.h5").read_bytes())
    with pytest.raises(ep.FileError, match="sequence.h5: is a single frame, not a sequence"):
        ep.load_sequence(tmp_path)


@pytest.mark.parametrize("name, text, told", [
    ("frames", "Infinity", "frames: must be a whole number"), ("frames", "1000000000", "whole number from 0 to 1000000,"),
    ("start_time", "NaN", "start_time: must be a finite number"), ("interval", "[]", "interval: must be a finite number"),
    ("number_step", "0", r"range\(\) arg 3 must not be zero"), ("weather", "3", "must be a mapping"),
    ("weather", '{"rain": 1}', "rain"), ("frames", "[" * 50_000, "settings")], ids=lambda value: value[:12])
def test_settings_that_no_run_writes_are_told_by_their_file(folders, tmp_path, name, text, told):
    path = tmp_path / "sequence.h5"
    path.write_bytes((folders["maps"] / "sequence.h5").read_bytes())
    with h5py.File(path, "r+") as file:
        file["settings"].attrs[name] = np.bytes_(text)
    with pytest.raises(ep.FileError, match=f"sequence.h5: .*{told}"):
        ep.load_sequence(tmp_path)


def test_frames_that_are_not_done_say_so(tmp_path):
    next(iter(make_sequence().save_frames(tmp_path)))
    stored = ep.load_sequence(tmp_path)
    assert stored.is_done.tolist() == [True, False, False, False]
    with pytest.raises(ep.FileError, match="frame_0002.h5: has not been simulated yet"):
        stored[2]
    assert stored.to_xarray().sizes["time"] == 1


def test_frames_that_were_removed_since_are_not_said_to_be_missing_yet(folders, tmp_path):
    moved = tmp_path / "moved"
    shutil.copytree(folders["maps"], moved)
    stored = ep.load_sequence(moved)
    moved.rename(tmp_path / "elsewhere")
    for read in (lambda: stored[2], lambda: next(iter(stored)), lambda: stored.plot(num_frames=2)):
        with pytest.raises(ep.FileError, match="sequence.h5: no such file any more"):
            read()


@pytest.mark.parametrize("keep", ["all", "maps"])
def test_the_maps_of_all_frames_are_one_dataset(folders, keep):
    pytest.importorskip("xarray")
    stored = ep.load_sequence(folders[keep])
    maps = stored.to_xarray()
    assert maps.power.dims == ("time", "range", "velocity") and maps.power.attrs["units"] == "dBm"
    assert maps.time.values.tolist() == stored.times.tolist() and maps.range.attrs["units"] == "m"
    for place, frame in enumerate(make_sequence()):
        power = np.mean(np.abs(frame.spectrum.values) ** 2, axis=(0, 1))
        assert np.allclose(maps.power[place].T, 10.0 * np.log10(power / 1e-3), rtol=0.0, atol=1e-3)
        labels = frame.labels["parts"]
        assert np.array_equal(maps.mask[place].T, labels.mask) and np.array_equal(maps.dominant[place].T, labels.dominant)
        assert np.array_equal(maps.object[place].T, labels.object_map)
    assert maps.object_names.values.tolist() == ["plate"] and maps.dominant_names.values.tolist() == ["plate", "other"]
    moved = maps.range.values[maps.power.max("velocity").argmax("range")]
    assert np.allclose(moved, DISTANCE + SPEED * stored.times, atol=0.3)  # a cell


def test_frames_have_the_names_and_the_values_of_their_small_files(folders):
    whole, maps = (ep.load_sequence(folders[keep])[1] for keep in ("all", "maps"))
    assert isinstance(whole, ep.Frame) and isinstance(maps, FrameMaps)
    for name in (field.name for field in dataclasses.fields(FrameMaps)):
        kept, own = getattr(maps, name), getattr(whole, name)
        if isinstance(kept, np.ndarray):
            assert own.dtype == kept.dtype
            np.testing.assert_array_equal(own, kept)
        elif name not in ("labels", "detections"):
            assert own == kept
    for name, told in (("cube", "'cube'; small files have maps and labels alone"), ("cubes", "'cubes'$")):
        with pytest.raises(AttributeError, match=f"^'FrameMaps' object has no attribute {told}"):
            getattr(maps, name)


def test_the_power_of_a_frame_is_the_mean_square_of_its_map_over_the_channels():
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(5, 0, 0))
    frame = ep.simulate(scene, make_radar().replace(receivers=[ep.Antenna((0, 0.002 * place, 0)) for place in range(3)]),
                        num_rays=500, guard=False)
    channels = np.abs(frame.spectrum.values.reshape(3, *frame.power.shape)) ** 2
    np.testing.assert_allclose(frame.power, (channels[0] + channels[1] + channels[2]) / 3.0, rtol=1e-6)
    assert frame.azimuth_power.shape == (len(frame.azimuth), len(frame.range))


@pytest.mark.parametrize("name", ["seed", "noise_seed"])
def test_small_files_with_negative_seeds_are_refused(tmp_path, name):
    path = tmp_path / "frame.h5"
    save_maps(FrameMaps(0.0, seed=1, noise_seed=2, labels={}, detections=None, velocity=np.arange(2.0), range=np.arange(3.0)),
              path)
    with h5py.File(path, "r+") as file:
        file["maps"].attrs.create(name, -1)
    with pytest.raises(ep.FileError, match=f"attribute '{name}' must not be negative, is -1"):
        load_maps(path)


@pytest.mark.parametrize("keep", ["maps", "labels"])
@pytest.mark.parametrize("over_time", [ep.spectrogram, ep.range_time, lambda frames: ep.spectrogram(frames, labels=True),
                                       lambda frames: ep.range_time(frames[0])])
def test_files_without_signals_say_which_ones_have_them(folders, keep, over_time):
    maps = r"; their maps over time are .*to_xarray\(\)\.power" if keep == "maps" else ""
    with pytest.raises(TypeError, match=f"^frames: must have signals, got FrameMaps.* saved with keep=.all. do{maps}$"):
        over_time(ep.load_sequence(folders[keep]))


@pytest.mark.parametrize("share", [0.0, 0.0001, 0.5, 0.99])
def test_a_frame_that_has_lost_its_end_is_not_done_and_named(tmp_path, share):
    stored = make_sequence(frames=3).save(tmp_path)
    path = stored.paths_of_files[1]
    whole = path.read_bytes()
    path.write_bytes(whole[:int(share * len(whole))])
    assert stored.is_done.tolist() == [True, False, True] and "2 done" in repr(stored)
    for read in (lambda: stored[1], stored.to_xarray, lambda: list(stored)):
        with pytest.raises(ep.FileError, match="frame_0001.h5: damaged"):
            read()
    with pytest.warns(RuntimeWarning, match="frame_0001.h5: damaged .*: it is made again") as said:
        told = list(make_sequence(frames=3).save_frames(tmp_path))
    assert len(said) == 1 and [one.seconds is None for one in told] == [True, False, True]
    assert path.read_bytes()[100:] == whole[100:] and stored.is_done.all()
