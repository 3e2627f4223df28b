"""Small files of frames: maps, labels and detections without the record and its signals (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from ..base.classes.by_partition import ByPartition
from ..frame.frame import power_of_map
from ..frame.maps import FrameMaps
from .container import new_file, our_file
from .detections import read_detections, write_detections
from .h5 import check_sums, read_array, read_attribute, read_group, write_array, write_attribute
from .labels import read_all_labels, write_all_labels
from .seeds import read_optional_seed, read_seed, write_seed
from .truth import truth_in, write_truth


def save_maps(maps: FrameMaps, path) -> None:
    """Writes FrameMaps to a file, whole or not at all. Raises ep.FileError."""
    with new_file(path) as file:
        group = file.create_group("maps")
        write_attribute(group, "start_time", maps.start_time)
        write_seed(group, "seed", maps.seed)
        write_seed(group, "noise_seed", maps.noise_seed)
        write_array(group, "velocity", maps.velocity, unit="m/s")
        write_array(group, "range", maps.range, unit="m")
        if maps.power is not None:
            write_array(group, "power", maps.power, unit="W")
        if maps.azimuth is not None:
            write_array(group, "azimuth", maps.azimuth, unit="rad")
            write_array(group, "azimuth_power", maps.azimuth_power, unit="W")
        if maps.labels:
            write_all_labels(file.create_group("labels"), maps.labels, compress=True)
        if maps.detections is not None:
            write_detections(file.create_group("detections"), maps.detections)
        if maps.kept_truth is not None:
            write_truth(file.create_group("truth"), maps.kept_truth)


def load_maps(path) -> FrameMaps:
    """What `save_maps` wrote: the same bits. Raises ep.FileError."""
    with our_file(path) as file:
        group = read_group(file, "maps")
        seeds = {"seed": read_seed(group, "seed"), "noise_seed": read_optional_seed(group, "noise_seed")}
        axes = {name: read_array(group, name, np.float64, (None,)) for name in ("velocity", "range")}
        shape = len(axes["velocity"]), len(axes["range"])
        labels = read_all_labels(read_group(file, "labels")) if "labels" in file else ByPartition()
        detections = read_detections(read_group(file, "detections"), shape, **seeds) if "detections" in file else None
        return FrameMaps(start_time=read_attribute(group, "start_time", float), **seeds, labels=labels,
                         detections=detections, **axes,
                         power=read_array(group, "power", np.float32, shape) if "power" in group else None,
                         kept_truth=truth_in(file), **_read_azimuth(group, shape[1]))


def _read_azimuth(group, num_ranges: int) -> dict:
    if "azimuth" not in group:
        return {}
    azimuth = read_array(group, "azimuth", np.float64, (None,))
    return {"azimuth": azimuth, "azimuth_power": read_array(group, "azimuth_power", np.float32, (len(azimuth), num_ranges))}


def start_time_in(path) -> float:
    """Start in s of the frame in a whole file, of either kind; every check sum is held against the values.

    Raises ep.FileError for a file that is damaged or none of ours.
    """
    with our_file(path) as file:
        check_sums(file)
        return start_time_in_file(file)


def start_time_in_file(file) -> float:
    """Start in s of the frame in an open file, of either kind. Raises ep.FileError."""
    group = read_group(file, "maps") if "maps" in file else read_group(read_group(file, "record"), "frame")
    return read_attribute(group, "start_time", float)


def axes_in_file(file) -> dict[str, np.ndarray]:
    """{axis: values} of the range-Doppler map in an open file of either kind, in m and m/s. Raises ep.FileError."""
    group = _map_group(file)
    return {name: read_array(group, name, np.float64, (None,)) for name in ("range", "velocity")}


def has_power(file) -> bool:
    """Whether an open file of either kind keeps the powers of its range-Doppler map. Raises ep.FileError."""
    return "maps" not in file or "power" in _map_group(file)


def power_in_file(file, shape: tuple = (None, None)) -> np.ndarray:
    """Power of the range-Doppler map with its noise in such a file, mean over channels: f32 [V, R] in W.

    shape: of a small file, None: any number. Raises ep.FileError.
    """
    if "maps" in file:
        return read_array(_map_group(file), "power", np.float32, shape)
    return power_of_map(read_array(_map_group(file), "values", np.complex128, (None,) * 4))


def _map_group(file):
    return read_group(file, "maps" if "maps" in file else "spectra")
