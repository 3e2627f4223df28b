"""Truth of objects in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..truth.record import Truth
from .h5 import blames_group, read_array, read_group, read_texts, write_array, write_texts

# Field of Truth: shape beside that of its rows, unit. The frame is that of the file.
NUMBERS = {
    "time": ((), "s"), "position": ((3,), "m"), "velocity": ((3,), "m/s"), "heading": ((), "rad"), "size": ((3,), "m"),
    "rotation": ((3, 3), ""), "yaw": ((), "rad"), "angular_velocity": ((3,), "rad/s"), "origin": ((3,), "m"),
    "position_in_radar": ((3,), "m"), "velocity_in_radar": ((3,), "m/s"), "yaw_in_radar": ((), "rad"), "range": ((), "m"),
    "rotation_in_radar": ((3, 3), ""), "direction_in_radar": ((3,), ""),
    "azimuth": ((), "rad"), "elevation": ((), "rad"), "radial_velocity": ((), "m/s"), "visible_share": ((), ""),
    "received": ((), "W"), "rcs": ((), "m^2"), "rcs_low": ((), "m^2"), "rcs_high": ((), "m^2")}
MAY_BE_NAN = ("heading", "direction_in_radar", "rcs", "rcs_low", "rcs_high")
MAY_BE_MISSING = ("rotation_in_radar", "direction_in_radar")  # in files of before there were these: NaN


def write_truth(group, truth: Truth) -> None:
    """Writes the truth of one frame."""
    write_texts(group, "name", truth.name.tolist())
    for field, (_, unit) in NUMBERS.items():
        write_array(group, field, np.asarray(getattr(truth, field), np.float64), unit=unit)


def truth_in(file) -> Truth | None:
    """What `write_truth` wrote to a file, of frame 0; None: nothing."""
    return _read_truth(read_group(file, "truth")) if "truth" in file else None


@blames_group
def _read_truth(group) -> Truth:
    names = read_texts(group, "name")
    if len(set(names)) < len(names):
        raise _core.FileError(f"{group.name}/name: must name each object once")
    columns = {field: _read_numbers(group, field, (len(names), *shape)) for field, (shape, _) in NUMBERS.items()}
    return Truth(frame=np.zeros(len(names), np.int32), name=np.array(names, dtype=str), **columns)


def _read_numbers(group, field: str, shape: tuple):
    if field in MAY_BE_MISSING and field not in group:
        return np.full(shape, np.nan)
    values = read_array(group, field, np.float64, shape)
    if field not in MAY_BE_NAN and not np.isfinite(values).all():
        raise _core.FileError(f"{group.name}/{field}: must hold finite numbers")
    return values
