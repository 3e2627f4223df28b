"""Maps of datasets as arrays, which threads may read."""
import pickle
import threading
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from echopath import dataset
from echopath.dataset.arrays import KINDS, _Kinds
from echopath.frame_file.maps import load_maps
from support.files.small_dataset import HEAD, SCENE, make, written


def test_classes_of_cells_are_those_of_their_scene_in_every_thread():
    """Two scenes whose objects of one name differ in class, of which the second is read while the first is."""
    kinds = _Kinds(SimpleNamespace(classes=lambda scene: {"user": ("car", "pedestrian")[scene]}))

    def frame(scene: int, labels) -> SimpleNamespace:
        return SimpleNamespace(scene=scene, frame=SimpleNamespace(labels={"parts": labels}))

    class Plain:
        object_map, ghost_map, ghosts = np.zeros((1, 1), int), np.full((1, 1), -1), []
        objects = [SimpleNamespace(name="user")]

    class Meanwhile(Plain):
        @property
        def objects(self):
            other = threading.Thread(target=kinds.of, args=(frame(1, Plain()),))
            other.start()
            other.join()
            return Plain.objects

    assert KINDS[kinds.of(frame(0, Meanwhile())).item()] == "car" and KINDS[kinds.of(frame(1, Plain())).item()] == "pedestrian"


def test_classes_and_paths_of_files_need_no_meshes(tmp_path):
    """A loop over frames asks for both, and the meshes of a street take ten times as long to read as a frame."""
    folder = tmp_path / "out"
    make(written(tmp_path, HEAD.replace("scenes = 6", "scenes = 2") + SCENE), folder)
    opened = dataset.open(folder)
    classes = [opened.classes(scene) for scene in opened.scenes]
    shuffled = opened[[3, 0]]
    assert shuffled.paths_of_files == [opened.sequence(one.scene).paths_of_files[one.place] for one in shuffled]
    for scene in opened.scenes:
        with h5py.File(folder / "scenes" / f"{scene:06d}" / "sequence.h5", "a") as file:
            del file["scene"]
    assert [opened.classes(scene) for scene in opened.scenes] == classes


def test_xarray_reads_the_frames_that_are_asked_for_and_no_others(tmp_path, monkeypatch):
    pytest.importorskip("xarray")
    folder = tmp_path / "out"
    make(written(tmp_path, HEAD.replace('keep = "labels"', 'keep = "maps"').replace("scenes = 6", "scenes = 3") + SCENE), folder)
    opened, read = dataset.open(folder), []
    monkeypatch.setattr("echopath.dataset.sources.read_frame",
                        lambda path, keep: read.append(path.name) or load_maps(path))
    arrays = opened.to_xarray()
    read.clear()
    assert arrays.power.dims == ("frame", "velocity", "range") and arrays.power.shape == arrays.cell.shape == (6, 8, 32)
    part = arrays.power.isel(frame=slice(3, 5), range=4)
    assert read == []
    values = part.values
    assert read == ["frame_0001.h5", "frame_0000.h5"]
    np.testing.assert_array_equal(values, [opened[place].frame.power[:, 4] for place in (3, 4)])
    labels = opened[2].frame.labels["parts"]
    np.testing.assert_array_equal(arrays.cell.sel(frame=2) > 0, labels.mask)
    names = arrays.kind_names.values
    assert {str(names[index]) for index in np.unique(arrays.kind[2]) if index >= 0} == {"static"}
    assert list(arrays.split.values) == [one.split for one in opened] and list(arrays.scene.values) == [0, 0, 1, 1, 2, 2]
    travelled = pickle.loads(pickle.dumps(opened.to_xarray()))  # as to the workers of a loader that spawns them
    for name in ("power", "cell", "kind"):
        np.testing.assert_array_equal(travelled[name].values, arrays[name].values)


@pytest.mark.parametrize("keep", ["maps", "labels"])
def test_xarray_has_the_cells_of_maps_over_azimuth(tmp_path, keep):
    """Beside the range-Doppler map, which has another number of rows."""
    pytest.importorskip("xarray")
    scene = SCENE.replace("[[objects]]", "[[radar.receivers]]\nposition = [0.0, 0.012, 1.0]\n[[objects]]", 1)
    head = HEAD.replace('keep = "labels"', f'keep = "{keep}"').replace("scenes = 6", "scenes = 1")
    make(written(tmp_path, head + scene + 'plane = "range_azimuth"\nnoise = false\n'), tmp_path / "out")
    opened = dataset.open(tmp_path / "out")
    arrays, labels = opened.to_xarray(), opened[1].frame.labels["parts"]
    assert arrays.cell.dims == arrays.kind.dims == ("frame", "azimuth", "range") and labels.mask.any()
    np.testing.assert_array_equal(arrays.azimuth, labels.azimuth)
    np.testing.assert_array_equal(arrays.cell[1], np.where(labels.ghost_map >= 0, 2, labels.object_map >= 0))
    np.testing.assert_array_equal(arrays.kind[1] >= 0, arrays.cell[1] > 0)
    assert set(arrays) == {"cell", "kind"} | ({"power", "azimuth_power"} if keep == "maps" else set())
    if keep == "maps":
        np.testing.assert_array_equal(arrays.azimuth_power[1], opened[1].frame.azimuth_power)
        assert arrays.power.dims == ("frame", "velocity", "range")
