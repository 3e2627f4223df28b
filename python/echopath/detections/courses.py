"""How the echo of each path goes on over the frame, as a few times tell."""
from __future__ import annotations

import dataclasses

import numpy as np

from .. import _core
from ..paths.cells import around, chirp_times, echoes_at, turning_of

CHECKED = (0.137, 0.311, 0.618, 0.843)  # of the frame: at no simple fraction, as what turns comes back after whole turns
UNSTEADY = 0.05                         # turns of the phase, by which a parabola may be wrong


@dataclasses.dataclass(frozen=True, eq=False)
class Courses:
    """Of P paths between the first antennas, [P] each.

    field: complex, sqrt(W), signal in the middle of the frame; strongest: sqrt(W), its largest size among the times looked at;
    swing: by which share of that it changes; away: m, how far the length goes from that in the middle; is_parabola: bool, of the
    phase over the frame; speed_change: m/s, by which the velocity rises over all chirps: with half the rate of the length, and
    with the phase of the amplitude
    """

    field: np.ndarray
    strongest: np.ndarray
    swing: np.ndarray
    away: np.ndarray
    is_parabola: np.ndarray
    speed_change: np.ndarray

    def take(self, index) -> Courses:
        """Those of the paths of an index [N]."""
        return Courses(**{name: values[index] for name, values in vars(self).items()})


def courses_of(paths) -> Courses:
    """The Courses of all paths of a record."""
    first, _, last = chirp_times(paths)
    waveform = paths.radar.waveform
    fractions = np.array([0.0, 0.5, 1.0, *CHECKED])
    inside = 0.0 if waveform.num_samples > 1 else waveform.chirp_duration  # of single samples the frame begins and ends at these
    times = [*(first + fractions * (last - first)), *around(first + inside, waveform), *around(last - inside, waveform)]
    kinds = (complex, float, float, float, bool, float)
    courses = Courses(*(np.zeros(paths.num_paths, kind) for kind in kinds))
    for some, lengths, amplitudes in echoes_at(paths, times):
        count = len(fractions)
        fields, around_first, around_last = amplitudes[:count], amplitudes[count:count + 2], amplitudes[count + 2:]
        size = np.abs(fields)
        courses.field[some] = np.conj(fields[1]) * _core.middle_phases(lengths[1], waveform)
        courses.strongest[some] = size.max(axis=0)
        courses.swing[some] = np.ptp(size, axis=0) / np.maximum(courses.strongest[some], np.finfo(float).tiny)
        courses.away[some] = np.abs(lengths[:count] - lengths[1]).max(axis=0)
        off = _off_parabola(lengths[:count], fractions) / waveform.wavelength
        if waveform.num_chirps > 2:
            turning = np.array([turning_of(*pair, waveform) for pair in (around_first, around_last)])
            courses.speed_change[some] = _speed_change(lengths, turning[1] - turning[0], last - first, waveform)
            off += _amplitudes_off_parabola(fields, turning * (last - first), fractions)
        courses.is_parabola[some] = off <= UNSTEADY
    return courses


def _off_parabola(lengths, fractions) -> np.ndarray:
    """m, [N]: by how much lengths [T, N] at fractions [T] of the frame leave the parabola through the first three."""
    before, middle, after = lengths[:3]
    place = (2.0 * fractions - 1.0)[:, None]
    parabola = middle + 0.5 * place * (after - before) + place ** 2 * (0.5 * (after + before) - middle)
    return np.abs(lengths - parabola).max(axis=0)


def _amplitudes_off_parabola(fields, turning, fractions) -> np.ndarray:
    """Turns, [N]: by how much the phases of amplitudes [T, N] at fractions [T] of the frame leave the parabola through that in
    the middle which turns as they do at the ends, [2, N] turns a frame; of weak amplitudes less."""
    place = fractions[:, None] - 0.5
    parabola = 0.5 * place * turning.sum(axis=0) + 0.5 * place ** 2 * (turning[1] - turning[0])
    turned = fields * np.conj(fields[1]) * np.exp(2j * np.pi * parabola)
    size = np.abs(fields)
    share = size / np.maximum(size.max(axis=0), np.finfo(float).tiny)
    return np.max(share * np.abs(np.angle(turned)), axis=0) / (2.0 * np.pi)


def _speed_change(lengths, turning, duration: float, waveform) -> np.ndarray:
    """m/s, [N], of lengths [T, N] that begin with those at the first chirp, the middle and the last one; turning: [N] Hz, by
    which the rate of the amplitude's phase grows from the first to the last chirp, `duration` s apart."""
    before, middle, after = lengths[:3]
    of_length = 2.0 * (before + after - 2.0 * middle) / duration
    return (of_length + 0.5 * waveform.wavelength * turning) * waveform.num_chirps / (waveform.num_chirps - 1)
