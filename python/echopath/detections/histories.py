"""Echoes that are followed from chirp to chirp."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..paths.cells import chirp_times

BYTES = 12            # of an echo in a chirp
MAX_MEMORY = 2 ** 28  # bytes, of all echoes that are followed


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
        fields, farther, largest = _core.echo_histories(self._paths, new, self._times, chirp_times(self._paths)[1])
        self._row_of_path[new] = len(self._fields) + np.arange(len(new))
        self._largest = _joined(self._largest, largest)
        self._fields = _joined(self._fields, fields)
        self._farther = _joined(self._farther, farther)

    def rows(self, index) -> np.ndarray:
        """Rows [N] in `fields` and `farther` of the paths of an index [N], -1: not followed."""
        return self._row_of_path[index]

    def largest(self, rows) -> np.ndarray:
        """[N] sqrt(W), the largest field of all chirps."""
        return self._largest[rows]

    def fields(self, rows) -> np.ndarray:
        """complex64 [N, C], over the largest of each, with their own phases."""
        return self._fields[rows]

    def farther(self, rows, chirps=slice(None)) -> np.ndarray:
        """f32 [N, C], m, by which the length is larger than that in the middle of the frame; chirps: which of them."""
        return self._farther[rows[:, None], chirps] if np.ndim(chirps) else self._farther[rows]

    def sums(self, rows, weights) -> np.ndarray:
        """Sums of `fields` with weights [W, C] of the chirps, complex64 [W, N]."""
        return _core.weighted_row_sums(self._fields, rows, weights)


def _joined(first, second) -> np.ndarray:
    """One after the other; nothing is copied where there is no first."""
    return np.concatenate([first, second]) if len(first) else second


def length_and_field(paths, time: float, tx: int, receivers: list) -> tuple:
    """Length [R, P] in m and signal, complex [R, P] in sqrt(W), of each path at a time in s, in the middle of a chirp."""
    length, amplitude = paths._echoes_at_receivers(time, tx, receivers)
    return length, np.conj(amplitude) * _core.middle_phases(length, paths.radar.waveform)
