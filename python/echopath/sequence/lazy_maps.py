"""The maps of frame files as arrays over time that read of each file what is asked for."""
from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .. import _core
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..frame_file.container import our_file
from ..frame_file.h5 import read_array, read_attribute, read_group
from ..frame_file.labels import CELL_FIELDS, PLANES, read_names
from ..frame_file.maps import axes_in_file, has_power, power_in_file
from ..labels.ghost_names import ghost_name
from ..labels.labels import NONE
from ..presentation.xarray_maps import index_of, xarray_module

_INDICES = {"dominant": "dominant", "object": "object_map", "ghost": "ghost_map"}  # variable: field of Labels


class Map(NamedTuple):
    """A variable of frames: its axes, type and shape in each, and how it is read from the open file of one.

    dims: names of its axes; axes: {name: values}; dtype: of read(file, place) [range, row]; attrs: of the variable
    words: what its values are indices of, None: they are none
    """

    dims: tuple
    axes: dict
    dtype: np.dtype
    attrs: dict
    read: Callable
    words: list[str] | None = None

    def read_file(self, path: Path, place: int = 0) -> np.ndarray:
        """Its values of the frame in a file. Raises ep.FileError, also for maps of another size."""
        with our_file(path) as file:
            values, wanted = self.read(file, place), [len(self.axes[name]) for name in self.dims]
            if list(values.shape) != wanted:
                raise _core.FileError(f"must have maps of {wanted} cells, as the first frame, has {list(values.shape)}")
        return values


def power_of(path: Path) -> Map | None:
    """The map with noise of the file of a frame; None: it has none. Raises ep.FileError."""
    with our_file(path) as file:
        return _power(file).get("power")


def maps_of(paths: list[Path]) -> dict[str, Map]:
    """{variable: Map} of the files of frames of one sequence. Raises ep.FileError."""
    with our_file(paths[0]) as file:
        found = _power(file)
        labels = read_group(file, "labels") if "labels" in file else {}
        planes = {name: _partition(read_group(labels, name)) for name in labels}
    words = [_words(path) for path in paths] if planes else []
    for group, (partition, dims, axes) in planes.items():
        for name, field in (_INDICES | {"mask": "mask"}).items():
            names, known, dtype = None, None, np.dtype(bool)
            if name != "mask":
                names, known = _numbered([one[group][field] for one in words])
                dtype = known[0].dtype
            variable = name if len(planes) == 1 or name != "dominant" else f"{name}_{partition}"
            read = functools.partial(_read_labels, f"labels/{group}", field, known)
            found[variable] = Map(dims, axes, dtype, index_of(variable) if names is not None else {}, read, names)
    return found


def over_time(paths: list[Path], map: Map):
    """A Map as an xarray.Variable [time, ...], which reads the files of the frames that are asked for, each time anew."""
    from .frames_array import FramesArray  # late: a class of xarray's, which is not always installed

    xarray = xarray_module()
    return xarray.Variable(("time", *map.dims), xarray.core.indexing.LazilyIndexedArray(FramesArray(paths, map)), map.attrs)


def _power(file) -> dict[str, Map]:
    """The map with noise of a file that has one."""
    if not has_power(file):
        return {}
    attrs = {"units": "dBm", "long_name": "received power with noise, mean over channels"}
    return {"power": Map(("range", "velocity"), axes_in_file(file), np.dtype(np.float32), attrs, _read_power)}


def _read_power(file, _place: int) -> np.ndarray:
    return in_dbm(power_in_file(file).T.astype(np.float64), SMALLEST_POWER).astype(np.float32)


def _partition(group) -> tuple[str, tuple, dict]:
    """(name, names of axes, {axis: values}) of the labels of a partition."""
    row = PLANES[read_attribute(group, "plane", str)].rows
    axes = {name: read_array(group, name, np.float64, (None,)) for name in ("range", row)}
    return read_attribute(group, "partition", str), ("range", row), axes


def _words(path: Path) -> dict:
    """{group: {field: what its indices mean}} of the labels of a file."""
    with our_file(path) as file:
        labels = read_group(file, "labels")
        found = {name: read_names(read_group(labels, name)) for name in labels}
    return {name: words | {"ghost_map": [ghost_name(label) for label in words["ghost_map"]]} for name, words in found.items()}


def _numbered(words: list[list[str]]) -> tuple[list[str], list[np.ndarray]]:
    """(all words of frames, each once; the number of each word of each frame among them, that of none last)"""
    names = list(dict.fromkeys(word for one in words for word in one))
    number = {name: place for place, name in enumerate(names)}
    dtype = np.int16 if len(names) <= np.iinfo(np.int16).max else np.int32  # all frames together may have many ghosts
    return names, [np.array([*(number[word] for word in one), NONE], dtype) for one in words]


def _read_labels(group: str, field: str, numbers: list | None, file, place: int) -> np.ndarray:
    values = read_array(read_group(file, group), field, CELL_FIELDS[field][0], (None, None)).T
    if numbers is None:
        return values.astype(bool)
    if values.size and not -1 <= values.min() <= values.max() < len(numbers[place]) - 1:
        raise _core.FileError(f"{group}/{field}: must be -1 to {len(numbers[place]) - 2}, its labels")
    return numbers[place][values]
