"""Labels of maps in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _core
from ..base.classes.by_partition import ByPartition
from ..labels.labels import AzimuthBox, AzimuthPeak, Box, GhostLabel, Labels, ObjectLabel, Peak
from ..labels.left_out import LeftOut
from ..paths.resolution import Interval
from .h5 import blames_group, read_array, read_attribute, read_group, read_texts, write_array, write_attribute, write_texts
from .seeds import read_seed, write_seed


class Plane(NamedTuple):
    """Name and unit of the axis of the rows; what a label's peak and box are."""

    rows: str
    unit: str
    make_peak: type
    make_box: type


PLANES = {"range_doppler": Plane("velocity", "m/s", Peak, Box),
          "range_azimuth": Plane("azimuth", "rad", AzimuthPeak, AzimuthBox)}
SETTINGS = ("noise_power", "noise_margin_db", "dynamic_range_db")
CELL_FIELDS = {"whole": (np.float64, "W"), "above_noise": (np.uint8, ""), "mask": (np.uint8, ""), "dominant": (np.int16, ""),
               "object_map": (np.int16, ""), "ghost_map": (np.int16, "")}
PART_FIELDS = {"mean_power": "W", "mean_share": "", "power_error": "W", "share_error": ""}  # [K, V, R], where asked for
NOTHING = np.nan  # in the peak and box of what has no cells, and in an interval that is not known


def write_all_labels(group, labels: dict, compress: bool = False) -> None:
    """Writes {partition: Labels}, a group for each; compress: powers too, which pays where most of them are 0."""
    for index, (partition, one) in enumerate(labels.items()):
        target = group.create_group(str(index))
        write_attribute(target, "partition", partition)
        write_labels(target, one, compress)


@blames_group
def read_all_labels(group) -> dict:
    """{partition: Labels}; the same bits that were written."""
    folders = [read_group(group, str(index)) for index in range(len(group))]
    return ByPartition({read_attribute(folder, "partition", str): read_labels(folder) for folder in folders})


@blames_group
def read_names(group) -> dict:
    """{map of indices: what each index means} of the labels of one partition, without its maps; ghosts as GhostLabel."""
    plane = _read_plane(group)
    return {"dominant": read_texts(group, "part"), "object_map": read_texts(read_group(group, "objects"), "name"),
            "ghost_map": _read_ghosts(read_group(group, "ghosts"), plane)}


def write_labels(group, labels: Labels, compress: bool = False) -> None:
    """Writes the labels of one partition; compress: powers too."""
    plane = PLANES[labels.plane]
    write_attribute(group, "plane", labels.plane)
    for name in SETTINGS:
        write_attribute(group, name, getattr(labels, name))
    write_seed(group, "seed", labels.seed)
    write_array(group, plane.rows, getattr(labels, plane.rows), unit=plane.unit)
    write_array(group, "range", labels.range, unit="m")
    write_texts(group, "part", labels.part_names)
    write_array(group, "power", labels.power, unit="W", compress=compress)
    for name, (dtype, unit) in CELL_FIELDS.items():
        write_array(group, name, np.asarray(getattr(labels, name), dtype), unit=unit,
                    compress=compress or dtype is not np.float64)
    if labels.certain is not None:
        write_array(group, "certain", np.asarray(labels.certain, np.uint8), compress=True)
        for name, unit in PART_FIELDS.items():
            write_array(group, name, getattr(labels, name), unit=unit, compress=compress)
    if labels.part_received is not None:
        _write_received(group, "part_received", labels.part_received)
    if labels.left_out is not None:
        write_array(group, "left_out", np.array(labels.left_out, np.float64))
    _write_objects(group.create_group("objects"), labels.objects)
    _write_ghosts(group.create_group("ghosts"), labels.ghosts)


@blames_group
def read_labels(group) -> Labels:
    """The labels of one partition; shares are computed from the powers as they were."""
    plane = _read_plane(group)
    axes = {"velocity": None, "azimuth": None, plane.rows: read_array(group, plane.rows, np.float64, (None,)),
            "range": read_array(group, "range", np.float64, (None,))}
    shape, names = (len(axes[plane.rows]), len(axes["range"])), read_texts(group, "part")
    cells = {name: read_array(group, name, dtype, shape) for name, (dtype, _) in CELL_FIELDS.items()}
    cells |= {name: cells[name].astype(bool) for name in ("above_noise", "mask")}
    power = read_array(group, "power", np.float64, (len(names), *shape))
    objects, ghosts = _read_objects(read_group(group, "objects"), plane), _read_ghosts(read_group(group, "ghosts"), plane)
    _check_indices(group, cells, {"dominant": len(names), "object_map": len(objects), "ghost_map": len(ghosts)})
    settings = {name: read_attribute(group, name, float) for name in SETTINGS}
    settings["seed"] = read_seed(group, "seed")
    return Labels(plane=read_attribute(group, "plane", str), **axes, part_names=names, power=power,
                  share=_core.power_shares(power), objects=objects, ghosts=ghosts,
                  part_received=_read_part_received(group, len(names)), left_out=_read_left_out(group), **settings, **cells,
                  **_read_errors(group, power.shape))


def _read_plane(group) -> Plane:
    name = read_attribute(group, "plane", str)
    if name not in PLANES:
        raise _core.FileError(f"{group.name}: unknown plane '{name}', known are {', '.join(PLANES)}")
    return PLANES[name]


def _read_errors(group, shape: tuple) -> dict:
    if "certain" not in group:
        return {}
    errors = {name: read_array(group, name, np.float64, shape) for name in PART_FIELDS}
    return errors | {"certain": read_array(group, "certain", np.uint8, shape[1:]).astype(bool)}


def _check_indices(group, cells: dict, counts: dict) -> None:
    for name, count in counts.items():
        if cells[name].size and not -1 <= cells[name].min() <= cells[name].max() < count:
            raise _core.FileError(f"{group.name}/{name}: must be -1 to {count - 1}, its labels")


# --- objects and ghosts ---

def _write_objects(group, objects: list) -> None:
    write_texts(group, "name", [label.name for label in objects])
    write_texts(group, "status", [label.status for label in objects])
    write_array(group, "visible_share", np.array([label.visible_share for label in objects], np.float64))
    _write_cells(group, objects)
    occluders = [(index, name, share) for index, label in enumerate(objects) for name, share in label.occluders.items()]
    write_array(group, "occluded", np.array([index for index, _, _ in occluders], np.int32))
    write_texts(group, "occluder", [name for _, name, _ in occluders])
    write_array(group, "occluder_share", np.array([share for _, _, share in occluders], np.float64))


def _read_objects(group, plane: Plane) -> list:
    names = read_texts(group, "name")
    count = len(names)
    texts, shares = read_texts(group, "status", count), read_array(group, "visible_share", np.float64, (count,))
    occluders = _read_occluders(group, count)
    return [ObjectLabel(name=names[i], status=texts[i], visible_share=float(shares[i]), occluders=occluders[i], **cells)
            for i, cells in enumerate(_read_cells(group, count, plane))]


def _read_occluders(group, count: int) -> list:
    """Of each object {name: share}."""
    occluded = read_array(group, "occluded", np.int32, (None,))
    names = read_texts(group, "occluder", len(occluded))
    shares = read_array(group, "occluder_share", np.float64, (len(occluded),))
    found = [{} for _ in range(count)]
    for index, name, share in zip(_within(group, "occluded", occluded, count), names, shares):
        found[index][name] = float(share)
    return found


def _write_ghosts(group, ghosts: list) -> None:
    write_texts(group, "object", [label.object for label in ghosts])
    for name in ("ghost_type", "order", "class_code"):
        write_array(group, name, np.array([getattr(label, name) for label in ghosts], np.int32))
    _write_cells(group, ghosts)
    mirrors = [(index, name) for index, label in enumerate(ghosts) for name in label.via]
    write_array(group, "mirrored", np.array([index for index, _ in mirrors], np.int32))
    write_texts(group, "mirror", [name for _, name in mirrors])


def _read_ghosts(group, plane: Plane) -> list:
    objects = read_texts(group, "object")
    count = len(objects)
    codes = {name: read_array(group, name, np.int32, (count,)) for name in ("ghost_type", "order", "class_code")}
    mirrored = read_array(group, "mirrored", np.int32, (None,))
    via = [[] for _ in range(count)]
    for index, name in zip(_within(group, "mirrored", mirrored, count), read_texts(group, "mirror", len(mirrored))):
        via[index].append(name)
    return [GhostLabel(object=objects[i], via=tuple(via[i]), **{name: int(values[i]) for name, values in codes.items()},
                       **cells)
            for i, cells in enumerate(_read_cells(group, count, plane))]


def _write_received(group, name: str, intervals) -> None:
    """Writes a list of Interval; None, of what is not known, is a row of NaN."""
    rows = [(NOTHING,) * 3 if interval is None else interval for interval in intervals]
    write_array(group, name, np.array(rows, np.float64).reshape(-1, 3), unit="W")


def _read_received(group, name: str, count: int) -> list:
    """List of Interval or None, of what is not known."""
    rows = read_array(group, name, np.float64, (count, 3))
    return [None if np.isnan(row[0]) else Interval(*map(float, row)) for row in rows]


def _read_part_received(group, count: int) -> list | None:
    """None of cubes whose selections nobody knows."""
    return _read_received(group, "part_received", count) if "part_received" in group else None


def _read_left_out(group) -> LeftOut | None:
    """None of frames with keyframes, which leave out nothing."""
    if "left_out" not in group:
        return None
    families, power, bound = read_array(group, "left_out", np.float64, (3,))
    return LeftOut(int(families), float(power), float(bound))


def _write_cells(group, labels: list) -> None:
    """Number of cells, power and its interval, peak and box of labels."""
    _write_received(group, "received", [label.received for label in labels])
    write_array(group, "cells", np.array([label.cells for label in labels], np.int64))
    write_array(group, "power", np.array([label.power for label in labels], np.float64), unit="W")
    for name, count in (("peak", 3), ("box", 4)):
        rows = [getattr(label, name) or (NOTHING,) * count for label in labels]
        write_array(group, name, np.array(rows, np.float64).reshape(-1, count))


def _read_cells(group, count: int, plane: Plane) -> list[dict]:
    cells, power = read_array(group, "cells", np.int64, (count,)), read_array(group, "power", np.float64, (count,))
    peaks, boxes = (read_array(group, name, np.float64, (count, size)) for name, size in (("peak", 3), ("box", 4)))

    received = _read_received(group, "received", count)

    def made(kind, row):
        return None if np.isnan(row[0]) else kind(*map(float, row))

    return [{"cells": int(cells[i]), "power": float(power[i]), "peak": made(plane.make_peak, peaks[i]),
             "box": made(plane.make_box, boxes[i]), "received": received[i]}
            for i in range(count)]


def _within(group, name: str, indices, count: int):
    if len(indices) and not 0 <= indices.min() <= indices.max() < count:
        raise _core.FileError(f"{group.name}/{name}: must be 0 to {count - 1}")
    return indices
