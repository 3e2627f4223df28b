"""Detections in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..detections.detections import Detections
from ..detections.echo_fields import EchoFields
from .h5 import blames_group, read_array, read_texts, write_array, write_texts

NUMBERS = {"range": (np.float64, "m"), "velocity": (np.float64, "m/s"), "azimuth": (np.float64, "rad"),
           "elevation": (np.float64, "rad"), "power": (np.float64, "W"), "noise": (np.float64, "W"),
           "share": (np.float64, ""),
           "ghost_type": (np.int32, ""), "order": (np.int32, ""), "class_code": (np.int32, "")}
FLAGS = ("is_noise", "is_resolved")  # u8, 0 or 1
TEXTS = ("part", "object")


def write_detections(group, detections: Detections) -> None:
    """Writes all but the paths behind them, which the record tells."""
    write_array(group, "cells", np.asarray(detections.cells, np.int64))
    write_array(group, "centre", np.asarray(detections.centre, np.float64), unit="m")
    for name, (dtype, unit) in NUMBERS.items():
        write_array(group, name, np.asarray(getattr(detections, name), dtype), unit=unit)
    for name in FLAGS:
        write_array(group, name, np.asarray(getattr(detections, name), np.uint8))
    for name in TEXTS:
        write_texts(group, name, [str(text) for text in getattr(detections, name)])


@blames_group
def read_detections(group, shape: tuple, *, seed, noise_seed, echoes: EchoFields | None = None) -> Detections:
    """The detections of a group; shape: (V, R) of the map; seed, noise_seed: of the frame; echoes: None without its paths."""
    cells = read_array(group, "cells", np.int64, (None, 2))
    count = len(cells)
    columns = {name: read_array(group, name, dtype, (count,)) for name, (dtype, _) in NUMBERS.items()}
    columns |= {name: read_array(group, name, np.uint8, (count,)).astype(bool) for name in FLAGS}
    columns |= {name: np.array(read_texts(group, name, count), dtype=str) for name in TEXTS}
    if count and (cells.min() < 0 or np.any(cells >= shape)):
        raise _core.FileError(f"{group.name}/cells: must lie within the {shape} cells of the map")
    return Detections(cells=cells, centre=read_array(group, "centre", np.float64, (3,)), echoes=echoes, seed=seed,
                      noise_seed=noise_seed, **columns)
