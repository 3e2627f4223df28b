"""Truth as named arrays over frames and objects: what Truth.to_xarray does."""
from __future__ import annotations

import numpy as np

from ..presentation.xarray_maps import AXES, xarray_module

_AXIS, _SIDE = ("x", "y", "z"), ("length", "width", "height")
# Field of Truth: its dimensions beside frame and object, and unit.
_VARIABLES = {
    "position": (("axis",), "m"), "velocity": (("axis",), "m/s"), "heading": ((), "rad"), "size": (("side",), "m"),
    "rotation": (("axis", "side"), "1"), "yaw": ((), "rad"), "angular_velocity": (("axis",), "rad/s"),
    "origin": (("axis",), "m"), "position_in_radar": (("axis",), "m"), "velocity_in_radar": (("axis",), "m/s"),
    "yaw_in_radar": ((), "rad"), "rotation_in_radar": (("axis", "side"), "1"), "direction_in_radar": (("axis",), "1"),
    "range": ((), "m"), "azimuth": ((), "rad"), "elevation": ((), "rad"),
    "radial_velocity": ((), "m/s"), "visible_share": ((), "1"), "received": ((), "W"), "rcs": ((), "m^2"),
    "rcs_low": ((), "m^2"), "rcs_high": ((), "m^2")}


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
    found = {"object": list(dict.fromkeys(truth.name.tolist())), "axis": list(_AXIS), "side": list(_SIDE)}
    return {prefix + name: (prefix + name, np.array(values, dtype=str)) for name, values in found.items()}


def variables(truth, places, num_frames: int, prefix: str = "") -> dict:
    """{name: (dimensions, values [T, O, ...], attributes)}: NaN where a frame does not have an object.

    places: [N] index of the frame of each row; prefix: of all names and dimensions but time
    """
    names = list(dict.fromkeys(truth.name.tolist()))
    columns = np.array([names.index(name) for name in truth.name.tolist()], int)
    found = {}
    for field, (dims, unit) in _VARIABLES.items():
        given = getattr(truth, field)
        values = np.full((num_frames, len(names), *given.shape[1:]), np.nan)
        values[places, columns] = given
        named = ("time", *(prefix + dim for dim in ("object", *dims)))
        found[prefix + field] = named, values, {"units": unit}
    return found
