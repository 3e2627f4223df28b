"""Radial velocities that look the same to a radar."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def velocity_span_of(radar: Any, folds: int = 0) -> float:
    """The width in m/s of the axis of radial velocities of a frame.

    folds: as of `estimate_angles`; where some were tried, transmitters in turns tell velocities apart from slot to slot
    """
    return 2.0 * float(radar.waveform.max_velocity(1 if folds else radar.num_slots))


def ambiguity_of(radar: Any, folds: int = 0) -> float:
    """By how many m/s radial velocities differ that look the same; 0 of a single chirp, to which all of them do."""
    return 0.0 if radar.waveform.num_chirps == 1 else velocity_span_of(radar, folds)


def folded(velocities: NDArray[np.float64], ambiguity: float) -> NDArray[np.float64]:
    """The smallest of the velocities in m/s that look the same as each: themselves where none or all do (inf, 0)."""
    if not 0.0 < ambiguity < np.inf:
        return velocities
    return np.asarray(velocities - ambiguity * np.rint(velocities / ambiguity))
