"""Frames of which a file keeps maps and labels alone."""
from __future__ import annotations

import numpy as np

import echopath as ep
from echopath import _core
from echopath.frame_file.frame import without_lists
from echopath.scene.lifetimes import scene_in_frame

from ..maps.layers import Known, are_of_map
from ..maps.part_set import PartSet
from ..maps.signals import Signals
from .inputs import ViewInput, whole_part

NO_PATHS = "this file keeps maps and labels alone, no rays: made with keep=\"all\" it would have them"
NO_MAP = "this file keeps labels alone, no map and no rays: made with keep=\"maps\" or \"all\" it would have them"


def from_maps(maps, stored, title: str = "") -> ViewInput:
    """What small files keep of a frame: its map, labels, detections and truth, in the scene of its sequence, without a ray.

    maps: ep.FrameMaps; stored: ep.StoredSequence that it is of, for scene and radar
    """
    scene, radar, settings = stored.scene, stored.radar, stored.settings
    paths = no_paths(scene, radar, maps.start_time, maps.seed)
    spectrum_settings = {"window": without_lists(settings.get("window", "hann")), "zero_pad": int(settings.get("zero_pad", 1))}
    signals = Signals(paths, spectrum_settings)
    cube = signals.whole()
    parts = PartSet(whole_part(_with_power(signals.map_of(cube), maps)))
    known = Known(labels=lambda progress: _map_labels(maps),
                  detections=lambda progress: _there(maps.detections, "detections"),
                  truth=lambda progress: _there(maps.kept_truth, "truth"))
    return ViewInput(paths, parts, signals, cube, title, known, NO_PATHS if maps.power is not None else NO_MAP, maps)


def _map_labels(maps) -> dict:
    labels = _there(maps.labels, "labels")
    if not are_of_map(labels):
        raise ValueError("labels: this file keeps those of its range-azimuth map alone")
    return labels


def _with_power(spectrum, maps):
    """A map of the axes of the radar that shows the mean power of the file in each channel."""
    if maps.power is None:
        return spectrum
    return with_values(spectrum, np.sqrt(maps.power.astype(float)).astype(complex))


def with_values(spectrum, values, receivers=slice(None)):
    """A map with the axes of another one. Raises ep.FileError for values [..., velocity, range] that do not fit it.

    receivers: those of its receivers that the map has
    """
    shape = spectrum.values[:, receivers].shape
    if values.shape[-2:] != shape[2:]:
        cells = [list(one[-2:]) for one in (shape, values.shape)]
        raise ep.FileError("map: must have the cells {} of the radar, has {}".format(*cells))
    state = {"num_transmitters": shape[0], "num_receivers": shape[1], "velocity": spectrum.velocity,
             "range": spectrum.range, "values": np.broadcast_to(values, shape).ravel(), "window": spectrum.window,
             "zero_pad": spectrum.zero_pad, "is_tdm_compensated": spectrum.is_tdm_compensated}
    made = type(spectrum).__new__(type(spectrum))
    made.__setstate__(state)
    return made


def no_paths(scene, radar, start_time: float, seed: int):
    """Paths of a frame without one."""
    there = scene_in_frame(scene, radar, start_time)
    # The core's own: that one ray is too few need not be said.
    traced = _core.trace(there, radar, num_rays=1, max_bounces=1, start_time=start_time, seed=seed)
    return traced.select(np.zeros(traced.num_paths, bool))


def _there(kept, name: str):
    if kept is None or kept == {}:
        raise ValueError(f"{name}: this file keeps none")
    return kept
