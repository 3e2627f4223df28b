"""Radial velocities that look the same to a radar."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

_ALIKE = 0.05  # turns of phase of an antenna: smaller differences leave the beams of two directions alike to 0.2 dB


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


def turns_look_like_directions(radar: Any) -> bool:
    """Whether transmitters in turns have the phases of one fold of velocity for another direction, too, at the same receivers.

    So those have that stand in even steps, in the order of their turns, where the receivers have no extent, or so little of it
    beside the transmitters' that the phases of a fold, one beam of the array aside, differ by less than _ALIKE along it.
    """
    ends = radar.transmitters, radar.receivers
    sending, hearing = (np.array([antenna.position for antenna in antennas]) for antennas in ends)
    slots = np.arange(len(sending)) / len(sending)
    places = np.concatenate([sending - sending.mean(axis=0), hearing - hearing.mean(axis=0)])
    phases = np.concatenate([slots - slots.mean(), np.zeros(len(hearing))])  # in turns
    gradient = np.linalg.lstsq(places, phases, rcond=1e-3)[0]  # turns per metre
    is_direction = np.linalg.norm(gradient) * radar.waveform.wavelength < 1.0
    return bool(is_direction and np.abs(places @ gradient - phases).max() < _ALIKE)
