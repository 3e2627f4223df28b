"""Maps of frames in files as xarray: read where they are asked for, from folders, files of all frames and files of one."""
from __future__ import annotations

import pickle
import tomllib
from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from echopath.sequence import lazy_maps
from support.frames_in_time import make_sequence

xarray = pytest.importorskip("xarray")
from echopath.sequence.xarray_engine import Engine  # a class of xarray's

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def drive(tmp_path_factory) -> ep.StoredSequence:
    return make_sequence(truth=True).save(tmp_path_factory.mktemp("xarray") / "drive.h5", keep="maps")


@pytest.fixture
def opened(monkeypatch) -> list[str]:
    """Names of the frames that arrays over time read."""
    names, our_file = [], lazy_maps.our_file

    def told(path):
        names.append(path.name)
        return our_file(path)

    monkeypatch.setattr(lazy_maps, "our_file", told)
    return names


def test_a_dataset_reads_the_frames_that_are_asked_for_and_no_others(drive, opened):
    maps = drive.to_xarray()
    opened.clear()
    assert maps.power.shape == (4, 64, 32) and maps.power.dtype == np.float32
    third = maps.power[2].values
    assert opened == ["000002"]
    opened.clear()
    assert maps.power[1::2, 5:9].shape == (2, 4, 32) and opened == []
    assert np.array_equal(maps.power[1::2, 5:9].values[0], maps.power[1, 5:9].values) and opened == ["000001", "000003", "000001"]
    assert np.array_equal(maps.power.load()[2], third)
    assert np.allclose(third, 10.0 * np.log10(drive[2].power.T / 1e-3), atol=1e-4, rtol=0.0)


@pytest.mark.parametrize("engine", ["scipy", "h5netcdf"])
def test_datasets_become_netcdf(drive, engine, tmp_path):
    """Those of SciPy are of the third kind, which has no lists of words beside a variable and no whole numbers of 64 bits."""
    pytest.importorskip(engine)
    frame = make_sequence(frames=1, seed=2 ** 40)[0]
    for name, made in {"maps": drive.to_xarray(), "one": drive[1:2].to_xarray(), "truth": drive.truth.to_xarray(),
                       "labels": frame.labels["parts"].to_xarray()}.items():
        made.to_netcdf(tmp_path / f"{name}.nc", engine=engine)
        with xarray.open_dataset(tmp_path / f"{name}.nc", engine=engine) as read:
            assert read.equals(made) and read.attrs.keys() == made.attrs.keys()
            for variable in read.data_vars:  # whoever has the file alone knows what its values are
                assert read[variable].attrs or read[variable].dtype == bool, variable
                if f"{variable}_names" in read:
                    assert read[variable].attrs["long_name"] == f"index into {variable}_names, -1: none"


KEYS = [0, -1, slice(None), slice(None, None, -2), slice(2, 2), np.array([3, 0]), np.array([], int)]


@pytest.mark.parametrize("key", KEYS, ids=str)
def test_every_index_gives_what_it_does_of_an_array_in_memory(drive, key):
    lazy, whole = drive.to_xarray().power, drive.to_xarray().power.load()
    for place in ((key,), (slice(1, 3), key), (0, key, 3), (slice(None), key, np.array([4, 1]))):
        assert np.array_equal(lazy[place].values, whole[place].values)
    picked = {"time": xarray.DataArray([0, 2], dims="point"), "range": xarray.DataArray([3, 4], dims="point")}
    assert np.array_equal(lazy.isel(picked).values, whole.isel(picked).values)


def test_xarray_opens_a_file_of_all_frames_a_folder_and_the_file_of_one(drive, tmp_path):
    folder = make_sequence(truth=True).save(tmp_path / "drive", keep="maps")
    whole = drive.to_xarray().load()
    for path in (drive.path, folder.path, str(folder.path)):
        assert xarray.open_dataset(path, engine=Engine).equals(whole)
    ep.save_frame(make_sequence()[1], tmp_path / "frame.h5")
    for path in (tmp_path / "frame.h5", drive.paths_of_files[1], folder.paths_of_files[1]):
        one = xarray.open_dataset(path, engine=Engine)
        assert one.time.values.tolist() == [drive.times[1]]
        assert np.allclose(one.power, whole.power[1:2], atol=1e-4, rtol=0.0) and np.array_equal(one.object, whole.object[1:2])
    assert "power" not in xarray.open_dataset(drive.path, engine=Engine, drop_variables="power")


def test_the_engine_leaves_files_of_others_alone(drive, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = 1.0
    taken = {"other.h5": False, "none.h5": False, ".": False, "": False}
    assert {name: Engine().guess_can_open(str(tmp_path / name)) for name in taken} == taken
    assert Engine().guess_can_open(drive.path) and Engine().guess_can_open(str(drive.paths_of_files[0]))
    assert not Engine().guess_can_open("https://somewhere/drive.h5") and not Engine().guess_can_open(b"bytes")
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]["xarray.backends"]
    assert declared == {"echopath": f"{Engine.__module__}:{Engine.__name__}"}


def test_lazy_maps_travel_to_workers(drive):
    dask = pytest.importorskip("dask")
    maps = drive.to_xarray()
    assert pickle.loads(pickle.dumps(maps)).power[3].equals(maps.power[3])
    with dask.config.set(scheduler="synchronous"):
        assert np.allclose(maps.chunk(time=1).power.mean("time"), maps.power.load().mean("time"), rtol=1e-5)


def test_names_are_the_same_in_all_frames_where_objects_come_and_go(tmp_path):
    first, second = (make_sequence(labels={"objects": {name: "plate"}})[0] for name in ("left", "right"))
    for place, frame in enumerate((first, second)):
        ep.save_frame(frame, tmp_path / f"frame_{place}.h5")
    from echopath.sequence.arrays import dataset_of_files

    maps = dataset_of_files([tmp_path / "frame_0.h5", tmp_path / "frame_1.h5"], [0.0, 1.0], False, {})
    assert maps.object_names.values.tolist() == ["left", "right"] and maps.object.dtype == np.int16
    found = [first.labels["parts"].object_map.T, second.labels["parts"].object_map.T]
    assert np.array_equal(maps.object[0], found[0]) and np.array_equal(maps.object[1], np.where(found[1] == 0, 1, -1))


def test_many_frames_have_more_names_of_ghosts_than_one():
    words = [[f"{frame}: {ghost}" for ghost in range(12_000)] for frame in range(3)]
    names, numbers = lazy_maps._numbered(words)
    assert len(names) == 36_000
    for one, known in zip(words, numbers):
        assert [names[number] for number in known[:-1]] == one and known[-1] == -1
