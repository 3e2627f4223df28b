"""The maps of frames in files as one xarray.Dataset: what StoredSequence.to_xarray and xarray.open_dataset do."""
from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from .. import _core
from ..frame_file.container import our_file
from ..frame_file.truth import truth_in
from ..presentation.xarray_maps import axis, words_of, xarray_module
from ..truth import Truth, joined
from ..truth.arrays import coordinates, variables as truth_variables
from .lazy_maps import maps_of, over_time


def dataset_of(stored, there):
    """The frames at some places of a StoredSequence as a Dataset; see StoredSequence.to_xarray."""
    if not len(there):
        raise ValueError(f"{stored.path}: must have frames, has none that is done")
    files = stored.paths_of_files  # a list that is made anew each time
    paths = [files[place] for place in there]
    has_truth = stored.settings.get("truth") is not None
    return dataset_of_files(paths, stored.times[there], has_truth, {"path": str(stored.path), "keep": stored.keep})


def dataset_of_files(paths: list[Path], times, has_truth: bool, attrs: dict):
    """The files of frames of one sequence, or of one frame, as a Dataset; times: starts of the frames in s"""
    xarray, maps = xarray_module(), maps_of(paths)
    coords = {name: axis(name, values) for map in maps.values() for name, values in map.axes.items()}
    for name, map in maps.items():
        coords |= {} if map.words is None else words_of(name, map.words)
    coords["time"] = "time", times, {"units": "s", "long_name": "start of the frame"}
    variables = {name: over_time(paths, map) for name, map in maps.items()}
    if has_truth:
        truth, places = _truth_of(paths, range(len(paths)))
        variables |= truth_variables(truth, places, len(paths), prefix="truth_")
        coords |= coordinates(truth, prefix="truth_")
    return xarray.Dataset(variables, coords=coords, attrs=attrs)


def truth_of_files(stored, there) -> Truth:
    """The Truth of the frames at some places of a StoredSequence; see StoredSequence.truth."""
    places = there.tolist()
    if stored.settings.get("truth") is None:
        raise ValueError(f"{stored.path}: must be of a run with truth=True, keeps no truth; ep.truth finds that of frames with "
                         "their paths")
    if not places:
        raise ValueError(f"{stored.path}: must have frames, has none that is done")
    paths = stored.paths_of_files
    return _truth_of([paths[place] for place in places], places)[0]


def _truth_of(paths, places) -> tuple:
    """The Truth of files, and the index of the file of each row [N]; places: of the files, which become numbers of frames."""
    rows = []
    for path, place in zip(paths, places):
        with our_file(path) as file:
            found = truth_in(file)
            if found is None:
                raise _core.FileError("holds no truth, which the run was asked for")
        rows.append(dataclasses.replace(found, frame=np.full(len(found), place, np.int32)))
    return joined(rows), np.repeat(np.arange(len(rows)), [len(one) for one in rows])
