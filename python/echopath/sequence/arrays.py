"""The maps of a sequence as one xarray.Dataset: what StoredSequence.to_xarray does."""
from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from .. import _core
from ..frame.maps import mean_power
from ..frame_file.container import our_file
from ..frame_file.h5 import read_array, read_group
from ..frame_file.labels import read_all_labels
from ..frame_file.truth import truth_in
from ..labels.ghost_names import ghost_name
from ..labels.labels import NONE
from ..presentation.xarray_maps import axis, xarray_module
from ..signals.measures import SMALLEST_POWER, in_dbm
from ..truth import Truth, joined
from ..truth.arrays import coordinates
from ..truth.arrays import variables as truth_variables

_INDICES = {"dominant": "dominant", "object": "object_map", "ghost": "ghost_map"}  # variable: field of Labels


def dataset_of(stored):
    """A StoredSequence as a Dataset; see StoredSequence.to_xarray."""
    xarray = xarray_module()
    files = [(time, path) for time, path, is_done in zip(stored.times, stored.paths_of_files, stored.is_done) if is_done]
    if not files:
        raise ValueError(f"{stored.path}: must have frames, has none that is done")
    names: dict[str, list[str]] = {}
    frames = [_variables(path, names) for _, path in files]
    coords = {name: axis(name, values) for name, values in frames[0][1].items()}
    coords["time"] = "time", [time for time, _ in files], {"units": "s", "long_name": "start of the frame"}
    variables = {}
    for name, (dims, _, attrs) in list(frames[0][0].items()):  # popped, so that nothing is held twice
        attrs = attrs | ({"names": names[name]} if name in names else {})
        variables[name] = ("time", *dims), np.stack([found.pop(name)[1] for found, _ in frames]), attrs
    if stored.settings.get("truth") is not None:
        truth, places = _truth_of([path for _, path in files], range(len(files)))
        variables |= truth_variables(truth, places, len(files), prefix="truth_")
        coords |= coordinates(truth, prefix="truth_")
    return xarray.Dataset(variables, coords=coords, attrs={"path": str(stored.path), "keep": stored.keep})


def truth_of_files(stored) -> Truth:
    """The Truth of the frames of a StoredSequence that are there; see StoredSequence.truth."""
    files = [(place, stored.paths_of_files[place]) for place in np.flatnonzero(stored.is_done).tolist()]
    if stored.settings.get("truth") is None:
        raise ValueError(f"{stored.path}: must be of a run with truth=True, keeps no truth; ep.truth finds that of frames with "
                         "their paths")
    if not files:
        raise ValueError(f"{stored.path}: must have frames, has none that is done")
    places, paths = zip(*files)
    return _truth_of(paths, places)[0]


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


def _variables(path: Path, names: dict) -> tuple[dict, dict]:
    """{variable: (dims, values, attributes)} of the file of a frame, and {axis: values}; adds to `names` of indices."""
    with our_file(path) as file:
        variables, axes = _power(file)
        labels = read_all_labels(read_group(file, "labels")) if "labels" in file else {}
    for partition, one in labels.items():
        row = "velocity" if one.azimuth is None else "azimuth"
        axes |= {row: getattr(one, row), "range": one.range}
        for name, values, words in _label_maps(one):
            name = name if len(labels) == 1 or name != "dominant" else f"{name}_{partition}"
            if words is not None:
                values = _renumbered(values, words, names.setdefault(name, []))
            variables[name] = ("range", row), np.ascontiguousarray(values.T), {}
    return variables, axes


def _power(file) -> tuple[dict, dict]:
    """The map with noise of a file that has one."""
    if "maps" in file:
        group = read_group(file, "maps")
        power = read_array(group, "power", np.float32, (None, None)) if "power" in group else None
    else:
        group = read_group(file, "spectra")
        power = mean_power(read_array(group, "values", np.complex128, (None, None, None, None)))
    if power is None:
        return {}, {}
    axes = {name: read_array(group, name, np.float64, (None,)) for name in ("velocity", "range")}
    values = in_dbm(power.T.astype(np.float64), SMALLEST_POWER).astype(np.float32)
    attrs = {"units": "dBm", "long_name": "received power with noise, mean over channels"}
    return {"power": (("range", "velocity"), values, attrs)}, axes


def _label_maps(labels):
    """(variable, values [V, R], names of its indices or None) of the maps of Labels."""
    words = {"dominant": labels.part_names, "object": [label.name for label in labels.objects],
             "ghost": [ghost_name(label) for label in labels.ghosts]}
    for name, field in _INDICES.items():
        yield name, getattr(labels, field), words[name]
    yield "mask", labels.mask, None


def _renumbered(indices, words: list, known: list):
    """Indices into `words` as indices into `known`, to which new words are added."""
    known += [word for word in words if word not in known]
    numbers = np.array([*(known.index(word) for word in words), NONE], np.int16)  # the last one for NONE
    return numbers[indices]
