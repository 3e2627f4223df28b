"""Detections of a frame that was simulated or read back from a file."""
from __future__ import annotations

import dataclasses

from .. import _core
from ..keywords import known_keywords
from .checks import CFAR_KEYWORDS
from .detect import detect
from .detections import Detections


@known_keywords(also=CFAR_KEYWORDS)
def detect_frame(frame, *, objects=None, max_peaks=1, progress=None, **keywords) -> Detections:
    """Detections in a frame's map with noise, labelled by its first partition, its objects and the paths behind them.

    frame: Frame of `simulate` or `load_frame`; objects: as in `families`
    max_peaks: directions of a cell at most, of radars whose antennas tell directions apart
    progress: callable (stage, fraction) or None
    keywords: method, false_alarm_rate, guard_velocity, guard_range, training_velocity, training_range and rank, as in `cfar`
    Returns Detections: range in m, velocity in m/s and the rest. Raises ValueError for bad input and for frames without
    signals, KeyboardInterrupt on Ctrl-C.
    """
    if frame.spectrum is None:
        raise ValueError("frame: must have signals to detect echoes in, got a record of paths alone")
    parts = next(iter(frame.part_spectra.values()), None)
    settings = {"max_peaks": max_peaks} if len(_core.virtual_array(frame.radar).elements) > 1 else None
    found = detect(frame.spectrum, frame.radar, paths=frame.paths, parts=parts, objects=objects, angles=settings,
                   progress=progress, **keywords)
    return dataclasses.replace(found, noise_seed=frame.noise_seed)
