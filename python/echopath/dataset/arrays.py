"""The maps of a dataset as an xarray.Dataset that reads a frame when a value of it is asked for."""
from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..presentation.xarray_maps import axis, index_of, words_of, xarray_module
from .classes import CODES

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Dataset as XarrayDataset
    from .opened import Dataset, DatasetFrame

CELLS = ("nothing", "object", "ghost")
KINDS = tuple(CODES)
_POWER = {"units": "W"}
_SCENES = 64  # whose classes are remembered


def lazy_arrays(dataset: Dataset) -> XarrayDataset:
    """See `Dataset.to_xarray`."""
    xarray = xarray_module()
    from .maps_array import MapsArray  # late: a class of xarray's, which is not always installed

    first = dataset[0].frame
    labels = next(iter(first.labels.values()), None)
    axes = {"velocity": first.velocity, "range": first.range}
    if labels is not None and labels.azimuth is not None:
        axes["azimuth"] = labels.azimuth
    row = "azimuth" if "azimuth" in axes else "velocity"

    def maps(read: Callable[[DatasetFrame], NDArray[Any]], row: str, dtype: str, attributes: dict[str, Any]) -> Any:
        shape = (len(dataset), len(axes[row]), len(axes["range"]))
        lazy = xarray.core.indexing.LazilyIndexedArray(MapsArray(dataset, read, shape, dtype))
        return ("frame", row, "range"), lazy, attributes

    variables: dict[str, Any] = {}
    words: dict[str, Any] = {}
    if dataset.keep != "labels":
        variables["power"] = maps(_power, "velocity", "f4", _POWER | {"long_name": "power with noise, mean over channels"})
        if row == "azimuth":
            variables["azimuth_power"] = maps(_azimuth_power, row, "f4", _POWER | {"long_name": "power with noise"})
    if labels is not None:
        kinds = _Kinds(dataset)
        variables["cell"] = maps(_cells, row, "i1", {"long_name": "index into cell_names"})
        variables["kind"] = maps(kinds.of, row, "i1", index_of("kind") | {"comment": "class of whose cell it is"})
        words = words_of("cell", CELLS) | words_of("kind", KINDS)
    per_scene = dataset.template.settings.frames
    scenes = np.array([number // per_scene for number in dataset.numbers])
    splits = {scene: dataset.template.split_of(int(scene)) for scene in np.unique(scenes)}
    coordinates = {"frame": dataset.numbers, "scene": ("frame", scenes), "split": ("frame", [splits[one] for one in scenes])}
    coordinates |= {name: axis(name, values) for name, values in axes.items()}
    return xarray.Dataset(variables, coords=coordinates | words)


def _power(one: DatasetFrame) -> NDArray[np.float32]:
    return np.asarray(one.frame.power)


def _azimuth_power(one: DatasetFrame) -> NDArray[np.float32]:
    return np.asarray(one.frame.azimuth_power)


def _cells(one: DatasetFrame) -> NDArray[np.int8]:
    labels = next(iter(one.frame.labels.values()))
    return np.where(labels.ghost_map >= 0, 2, np.where(labels.object_map >= 0, 1, 0)).astype(np.int8)


class _Kinds:
    """Classes of the owners of cells, as indices of KINDS, -1: nothing's."""

    def __init__(self, dataset: Dataset):
        self._dataset = dataset
        self._classes = lru_cache(_SCENES)(dataset.classes)  # threads read frames of several scenes at a time

    def __reduce__(self) -> tuple[type[_Kinds], tuple[Dataset]]:
        return _Kinds, (self._dataset,)  # what is remembered stays behind

    def of(self, one: DatasetFrame) -> NDArray[np.int8]:
        known = self._classes(one.scene)
        labels = next(iter(one.frame.labels.values()))
        kinds = np.full(labels.object_map.shape, -1, np.int8)
        for owners, names in ((labels.object_map, [one.name for one in labels.objects]),
                              (labels.ghost_map, [one.object for one in labels.ghosts])):
            codes = np.array([KINDS.index(known.get(name, "static")) for name in names], np.int8)
            kinds[owners >= 0] = codes[owners[owners >= 0]]
        return kinds
