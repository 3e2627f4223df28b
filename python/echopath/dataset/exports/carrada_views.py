"""The views and masks of one frame as CARRADA has them (Ouaknine et al. 2021, doi 10.1109/ICPR48806.2021.9413181).

Its annotations (valeoai/carrada_dataset, utils/transform_annotations.py) fix the axes: range-Doppler has the nearest range in
row 0 and approaching echoes to the right of column 32, range-angle the farthest range in row 0 and what is to the right of the
radar to the right of column 128, in steps of pi / 256.
"""
from __future__ import annotations

import dataclasses
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...arguments.checks import refused
from ...arguments.settings import LabelSettings
from ...frame.frame import Frame
from ...frame.labels import annotate_frame
from ...labels.labels import Labels
from ...spectra.angles import beamform
from ..classes import ClassName

NUM_RANGES, NUM_VELOCITIES, NUM_ANGLES = 256, 64, 256
CLASSES = ("background", "pedestrian", "cyclist", "car")  # in the order of the masks
_OF_CLASS: dict[ClassName, int] = {"pedestrian": 1, "pedestrian_group": 1, "cyclist": 2, "motorcycle": 2,
                                   "car": 3, "van": 3, "truck": 3, "bus": 3}
_HALF_POWER = 0.5

# Azimuths of the columns of range-angle, left positive and ascending, hence from the last column to the first.
AZIMUTHS = (NUM_ANGLES // 2 - np.arange(NUM_ANGLES)[::-1]) * math.pi / NUM_ANGLES


class Levels(NamedTuple):
    """Fixed levels of a view in dB: that of the mean noise here, the mean of CARRADA, and the ends that networks scale from."""

    mean: float
    lowest: float
    highest: float


# Statistics of CARRADA by which networks that are trained on it scale their input (valeoai/MVRSS, config_files/*_stats_all.json).
LEVELS = {"range_doppler": Levels(58.47112418237332, 37.59535773996415, 119.08313902425246),
          "range_angle": Levels(56.00209075744544, 40.40928894952408, 103.80548746494114),
          "angle_doppler": Levels(59.62242439612116, 54.42604354196056, 105.79746676271202)}


class Instance(NamedTuple):
    """One object in one view: rows and columns of its cells, [C, 2], and of its strongest cell, [2]; label: index of CLASSES."""

    name: str
    label: int
    cells: NDArray[np.int64]
    peak: NDArray[np.int64]


def class_index(kind: ClassName) -> int:
    """Index of CLASSES of a class of ours; 0, the background, for what CARRADA does not annotate."""
    return _OF_CLASS.get(kind, 0)


def views_of(frame: Frame) -> dict[str, NDArray[np.float32]]:
    """{view: f32 dB} of a frame with noise: range_doppler [256, 64], range_angle [256, 256], angle_doppler [256, 64].

    A view is the mean power over what it does not show: channels, velocities or ranges. The mean thermal noise is put at the mean
    of CARRADA's view, and values end at its lowest and highest. Raises ValueError naming `dataset` for maps of another size.
    """
    spectrum: Any = frame.spectrum
    radar: Any = frame.radar
    if spectrum.values.shape[2:] != (NUM_VELOCITIES, NUM_RANGES):
        raise refused(ValueError, "dataset", f"of a radar with maps of {NUM_RANGES} ranges and {NUM_VELOCITIES} velocities",
                      f"{spectrum.values.shape[3]} and {spectrum.values.shape[2]}")
    beams = beamform(spectrum, radar, AZIMUTHS).power[0]  # [A, V, R]
    noise = _core.cell_noise_power(radar, frame.spectrum_settings["window"])
    in_beam = noise * _noise_of_beam(radar)
    return {"range_doppler": _in_db(_approaching(_core.mean_power(spectrum)), noise, LEVELS["range_doppler"]),
            "range_angle": _in_db(_range_angle(beams.mean(axis=1)), in_beam, LEVELS["range_angle"]),
            "angle_doppler": _in_db(_approaching(beams.mean(axis=2).T)[::-1], in_beam, LEVELS["angle_doppler"])}


def _noise_of_beam(radar: Any) -> float:
    """Noise of a beam over that of a channel: the mean over elements, each the mean of the channels at its position."""
    _, channels = np.unique(_core.virtual_array(radar).element_of_channel, return_counts=True)
    return float(np.mean(1.0 / channels) / len(channels))


def instances_of(frame: Frame, kinds: dict[str, ClassName], margins: LabelSettings) -> dict[str, list[Instance]]:
    """{"range_doppler" and "range_angle": objects of CARRADA's classes that have cells there}.

    kinds: {name of an object of the scene: class}; margins: of cells over the noise and below the peak. The objects are those of
    the scene in both views, whatever the labels of the frame report on.
    """
    bare = dataclasses.replace(frame, parts={}, selections={}, part_of_path={},
                               angle_settings={"azimuth": AZIMUTHS, "combine": "peak"})
    in_map = _only(annotate_frame(bare, settings=margins.replace(plane="range_doppler")))
    in_angles = _only(annotate_frame(bare, settings=margins.replace(plane="range_azimuth")))
    return {"range_doppler": _instances(in_map, kinds, _approaching(in_map.object_map), _approaching(in_map.whole)),
            "range_angle": _instances(in_angles, kinds, _range_angle(_within_beams(in_angles)), _range_angle(in_angles.whole))}


def one_hot(cells: list[tuple[int, NDArray[np.int64]]], shape: tuple[int, int]) -> NDArray[np.uint8]:
    """u8 [4, *shape]: 1 in the class that each cell has; cells: (label, [C, 2]) of each instance."""
    classes = np.zeros(shape, np.uint8)
    for label, places in cells:
        classes[tuple(places.T)] = label
    return (classes == np.arange(len(CLASSES), dtype=np.uint8)[:, None, None]).astype(np.uint8)


def _only(labels: dict[str, Labels]) -> Labels:
    return next(iter(labels.values()))


def _approaching(values: NDArray[Any]) -> NDArray[Any]:
    """[V, N], receding positive, as [N, V], approaching positive about column 32."""
    return np.roll(values[::-1], 1, axis=0).T


def _range_angle(values: NDArray[Any]) -> NDArray[Any]:
    """[A, R], left positive, with the farthest range first and right positive."""
    return values[::-1, ::-1].T


def _in_db(power: NDArray[Any], noise: float, levels: Levels) -> NDArray[np.float32]:
    with np.errstate(divide="ignore"):
        found = levels.mean + 10.0 * np.log10(power / noise)
    return np.clip(found, levels.lowest, levels.highest).astype(np.float32)


def _within_beams(labels: Labels) -> NDArray[np.int16]:
    """The map of objects [A, R] without the sidelobes of the array: at each range, cells down to half the object's strongest."""
    kept = np.full_like(labels.object_map, -1)
    for index in range(len(labels.objects)):
        own = labels.object_map == index
        strongest = np.max(np.where(own, labels.whole, 0.0), axis=0)
        kept[own & (labels.whole >= _HALF_POWER * strongest)] = index
    return kept


def _instances(labels: Labels, kinds: dict[str, ClassName], owners: NDArray[Any], power: NDArray[Any]) -> list[Instance]:
    found = []
    for index, one in enumerate(labels.objects):
        label, cells = class_index(kinds.get(one.name, "static")), np.argwhere(owners == index)
        if label and len(cells):
            found.append(Instance(one.name, label, cells, cells[np.argmax(power[tuple(cells.T)])]))
    return found
