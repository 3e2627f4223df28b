"""Detections of a frame that was simulated or read back from a file."""
from __future__ import annotations

import dataclasses

from .. import _core
from ..arguments.checks import Progress, an, checked
from ..arguments.objects import Objects
from ..arguments.settings import FRAME_KEYWORDS, LEAST_MARGIN_DB
from ..detections import Detections, detected
from ..detections.checks import RULES, require_folds
from ..detections.family_fields import Signals
from ..signals.parts import decompose
from ..spectra.range_doppler import FALSE_ALARM_RATE, RANK, CfarMethod
from .frame import Frame


@checked(**RULES, frame=an(Frame))
def detect_frame(frame: Frame, *, method: CfarMethod = "ca", false_alarm_rate: float = FALSE_ALARM_RATE,
                 guard_velocity: int | None = None, guard_range: int | None = None, training_velocity: int | None = None,
                 training_range: int | None = None, rank: float = RANK, beams: bool = False,
                 objects: Objects = None, max_peaks: int = 1, folds: int = 0, progress: Progress = None) -> Detections:
    """Detections in a frame's map with noise, labelled by its first partition, its objects and the paths behind them.

    frame: Frame of `simulate` or `load_frame`
    method, false_alarm_rate, guard_velocity, guard_range, training_velocity, training_range, rank, beams: as in `cfar`, in cells
    objects: as in `families`
    max_peaks: directions of a cell at most, of radars whose antennas tell directions apart
    folds: velocities beyond those of the map that transmitters in turns ("tdm") tell apart, as in `estimate_angles`: with 3 or 4
        transmitters 1 tries those a turn of the map faster and slower, too. Without it, what is too fast for the map has a
        wrong azimuth as well
    progress: callable (stage, fraction), True for bars, or None
    Noise is a cell of which, above the mean of thermal noise, the signal without noise holds less than half. Objects and ghosts
    are told apart above the noise margin of the frame's labels, 10 dB where it has none, by paths that hold the cell; sidelobes
    more than 60 dB below an echo are of none. Of frames whose records are renewed (`retrace`) they are those of all records,
    which takes a synthesis of its own, and the paths behind them those of mid-frame.
    Returns Detections: range in m, velocity in m/s and the rest. Raises ValueError for bad input and for frames without
    signals, KeyboardInterrupt on Ctrl-C.
    """
    if frame.spectrum is None:
        raise ValueError("frame: must have signals to detect echoes in, got a record of paths alone")
    parts = next(iter(frame.part_spectra.values()), None)
    whole = None if parts else _core.range_doppler(frame.cube, frame.radar, **frame.spectrum_settings)
    require_folds(frame.radar, folds)
    settings = {"max_peaks": max_peaks, "folds": folds} if len(_core.virtual_array(frame.radar).elements) > 1 else None
    rules = {"method": method, "false_alarm_rate": false_alarm_rate, "guard_velocity": guard_velocity, "guard_range": guard_range,
             "training_velocity": training_velocity, "training_range": training_range, "rank": rank, "beams": beams}
    found = detected(frame.spectrum, frame.radar, rules, paths=frame.paths, parts=parts, beside=frame.beside_spectra or None,
                     angles=settings, known=frame._powers_of(objects, progress), without_noise=whole,
                     noise_margin_db=_noise_margin_db(frame), signals=_signals_of_families(frame, progress), progress=progress)
    return dataclasses.replace(found, noise_seed=frame.noise_seed)


def _signals_of_families(frame: Frame, progress) -> Signals | None:
    """Of a frame whose records are renewed, None of others: their paths tell."""
    if frame.retrace == "never":
        return None
    settings = {name: getattr(frame, name) for name in FRAME_KEYWORDS}
    return lambda found, radar: decompose(frame.paths, radar, found, **settings, progress=progress)


def _noise_margin_db(frame: Frame) -> float | None:
    """dB, of the frame's labels; None: it has none."""
    margin_db = next((labels.noise_margin_db for labels in (frame.labels or {}).values()), None)
    return None if margin_db is None else max(margin_db, LEAST_MARGIN_DB)
