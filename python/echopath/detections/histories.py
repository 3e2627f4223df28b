"""Echoes that flash, or whose phase is no parabola over the frame, as of blades and wheels: followed from chirp to chirp."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..paths.cells import chirp_times
from ..paths.subset import subset

CHECKED = (0.137, 0.311, 0.618, 0.843)  # of the frame: at no simple fraction, as what turns comes back after whole turns
UNSTEADY = 0.05       # turns of the phase, by which a parabola may be wrong
FLASHING = 0.25       # of the largest field, by which one changes that is followed
BYTES = 28            # of an echo in a chirp, while it is evaluated
MAX_MEMORY = 2 ** 28  # bytes, of all echoes that are followed


def off_parabola(paths, middle) -> tuple:
    """(turns, m), [P] each: by how much the phase of each path leaves the parabola through its lengths in the first, the middle
    (`middle` [P] in m) and the last chirp, and how far its length goes from that in the middle, at the checked times."""
    first, centre, last = chirp_times(paths)
    if last == first:
        return np.zeros(len(middle)), np.zeros(len(middle))
    before, after = paths.lengths([first, last], 0, 0)
    off, away = np.zeros(len(middle)), np.maximum(np.abs(before - middle), np.abs(after - middle))
    for fraction in CHECKED:
        place = 2.0 * fraction - 1.0
        length = paths.lengths([centre + 0.5 * place * (last - first)], 0, 0)[0]
        parabola = middle + 0.5 * place * (after - before) + place ** 2 * (0.5 * (after + before) - middle)
        off, away = np.maximum(off, np.abs(length - parabola)), np.maximum(away, np.abs(length - middle))
    return off / paths.radar.waveform.wavelength, away


def swing_of(paths) -> tuple:
    """(share, sqrt(W)), [P] each: by how much of its largest the field of each path changes among the first, the middle and the
    last chirp and the checked times, and that largest."""
    first, centre, last = chirp_times(paths)
    fields = np.abs(paths.amplitudes([first, centre, last, *(first + np.array(CHECKED) * (last - first))], 0, 0))
    largest = fields.max(axis=0)
    return (largest - fields.min(axis=0)) / np.maximum(largest, np.finfo(float).tiny), largest


class Histories:
    """Of single paths of a record, between the first antennas: field in each of C chirps, beside the largest of them, and length
    beside that in the middle of the frame.

    times: [C] s, of the chirps. As many paths are followed as MAX_MEMORY holds.
    """

    def __init__(self, paths, times):
        self._paths, self._times = paths, times
        self._row_of_path = np.full(paths.num_paths, -1, np.int32)
        self._fields = np.zeros((0, len(times)), np.complex64)
        self._farther = np.zeros((0, len(times)), np.float32)
        self._largest = np.zeros(0)

    def follow(self, index) -> None:
        """Follows the paths of an index [N], those that stand first where there is not room for all."""
        room = MAX_MEMORY // (BYTES * len(self._times)) - len(self._fields)
        new = np.sort(index[self._row_of_path[index] < 0][:max(room, 0)])
        if not len(new):
            return
        self._row_of_path[new] = len(self._fields) + np.arange(len(new))
        fields, farther, largest = self._evaluated(subset(self._paths, new))
        self._largest = np.concatenate([self._largest, largest])
        self._fields = np.concatenate([self._fields, fields])
        self._farther = np.concatenate([self._farther, farther])

    def rows(self, index) -> np.ndarray:
        """Rows [N] in `fields` and `farther` of the paths of an index [N], -1: not followed."""
        return self._row_of_path[index]

    def largest(self, rows) -> np.ndarray:
        """[N] sqrt(W), the largest field of all chirps."""
        return self._largest[rows]

    def fields(self, rows) -> np.ndarray:
        """complex64 [N, C], over the largest of each, with their own phases."""
        return self._fields[rows]

    def farther(self, rows) -> np.ndarray:
        """f32 [N, C], m, by which the length is larger than that in the middle of the frame."""
        return self._farther[rows]

    def _evaluated(self, paths) -> tuple:
        middle = paths.lengths([chirp_times(paths)[1]], 0, 0)[0]
        shape = (paths.num_paths, len(self._times))
        fields, farther = np.zeros(shape, np.complex128), np.zeros(shape, np.float32)
        for chirp, time in enumerate(self._times):
            length, field = length_and_field(paths, time, 0, [0])
            fields[:, chirp], farther[:, chirp] = field[0], length[0] - middle
        largest = np.abs(fields).max(axis=1)
        return (fields / np.maximum(largest, np.finfo(float).tiny)[:, None]).astype(np.complex64), farther, largest


def length_and_field(paths, time: float, tx: int, receivers: list) -> tuple:
    """Length [R, P] in m and signal, complex [R, P] in sqrt(W), of each path at a time in s, in the middle of a chirp."""
    length, amplitude = paths._echoes_at_receivers(time, tx, receivers)
    return length, np.conj(amplitude) * phase_of(length, paths.radar.waveform)


def phase_of(length, waveform) -> np.ndarray:
    """Phase factor of the signal of echoes of some length in m, in the middle of a chirp."""
    delay = length / _core.speed_of_light
    cycles = (waveform.start_frequency + waveform.slope * waveform.window_centre) * delay - 0.5 * waveform.slope * delay ** 2
    return np.exp(2j * np.pi * np.mod(cycles, 1.0))
