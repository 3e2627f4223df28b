"""Truth as named arrays over frames and objects: what Truth.to_xarray does."""
from __future__ import annotations

import numpy as np

from ..presentation.xarray_maps import AXES, xarray_module
from .fields import FIELDS, SIDES, XYZ

_OF_ROWS = ("frame", "time", "name")  # what tells rows apart becomes coordinates


def truth_dataset(truth):
    """A Truth as a Dataset; see Truth.to_xarray."""
    frames, places = np.unique(truth.frame, return_inverse=True)
    times = np.zeros(len(frames))
    times[places] = truth.time
    coords = coordinates(truth) | {"time": ("time", times, AXES["time"] | {"long_name": "middle of the frame"}),
                                   "frame": ("time", frames)}
    return xarray_module().Dataset(variables(truth, places, len(frames)), coords=coords)


def coordinates(truth, prefix: str = "") -> dict:
    """{dimension: its values} of `variables`; prefix: of all of them"""
    found = {"object": list(dict.fromkeys(truth.name.tolist())), "axis": list(XYZ), "side": list(SIDES)}
    return {prefix + name: (prefix + name, np.array(values, dtype=str)) for name, values in found.items()}


def variables(truth, places, num_frames: int, prefix: str = "") -> dict:
    """{name: (dimensions, values [T, O, ...], attributes)}: NaN where a frame does not have an object.

    places: [N] index of the frame of each row; prefix: of all names and dimensions but time
    """
    names = list(dict.fromkeys(truth.name.tolist()))
    columns = np.array([names.index(name) for name in truth.name.tolist()], int)
    found = {}
    for field in (one for one in truth.__dataclass_fields__ if one not in _OF_ROWS):
        given, (_, unit, dims, meaning) = getattr(truth, field), FIELDS[field]
        values = np.full((num_frames, len(names), *given.shape[1:]), np.nan)
        values[places, columns] = given
        named = ("time", *(prefix + dim for dim in ("object", *dims)))
        found[prefix + field] = named, values, {"units": unit or "1", "long_name": meaning}
    return found
