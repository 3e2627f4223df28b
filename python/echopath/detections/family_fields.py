"""What each family of a frame whose records are renewed gives to a cell of its map."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.process.progress import with_progress
from .channels import by_channel


class FamilyFields:
    """The fields of the signals of whole families, by the names that EchoFields has for those of paths.

    The paths of mid-frame do not tell what made a cell of a frame whose records are renewed.

    families: list [F] of Family; family_of_path: [F], each of them being one echo
    """

    def __init__(self, signals: dict, radar, spectrum):
        """signals: {Family: cube [tx, rx, chirp, sample] in sqrt(W)} without noise; radar, spectrum: of the map"""
        self.families, self.family_of_path = list(signals), np.arange(len(signals))
        self._signals, self._radar, self._spectrum = signals, radar, spectrum
        self._peaks = np.zeros(len(signals))

    def each(self, cells, gains, beams=None, progress=None):
        """Yields of each of cells [N, 2] what EchoFields does, of families instead of paths: makes the maps of all, one at a
        time, and keeps of each what it has in the cells."""
        indices = np.argwhere(np.ones(self._spectrum.values.shape[:2], bool))
        of_channels = gains.of("", *indices.T[:, :, None], cells[:, 1]).T
        weights = None if beams is None else by_channel(beams)
        fields = np.zeros((len(cells), len(indices) if beams is None else 1, len(self)), complex)
        behind = np.zeros((len(cells), fields.shape[1]), complex)
        families = with_progress(self._signals.values(), len(self), progress, "maps of families")
        for number, cube in enumerate(families):
            found = _core.range_doppler(cube, self._radar, self._spectrum.window, self._spectrum.zero_pad)
            values = _in_cells(found.values, cells)
            fields[:, :, number] = _summed(values, weights)
            behind += _summed(of_channels * values, weights)
            self._peaks[number] = _core.mean_power(found).max(initial=0.0)
        for field, whole in zip(fields, behind):
            yield self.family_of_path, field, np.mean(np.abs(whole) ** 2)

    def measured(self, cells) -> np.ndarray:
        """Power [N] in W of the map in cells [N, 2], mean over the channels."""
        return np.mean(np.abs(_in_cells(self._spectrum.values, cells)) ** 2, axis=1)

    def peak_of(self, keep) -> float:
        """Power in W of the strongest cell of the map of the one family where `keep` [F] is true, mean over all channels."""
        return float(self._peaks[keep].max(initial=0.0))

    def __len__(self) -> int:
        return len(self.families)


def _in_cells(values, cells):
    """[N, C] of values [tx, rx, velocity, range] in cells [N, 2]."""
    velocity, distance = cells.T
    return values[:, :, velocity, distance].reshape(values.shape[0] * values.shape[1], len(cells)).T


def _summed(values, weights):
    """Values [N, C] in channels as they are, or, with weights [N, C], their weighted sums [N, 1]."""
    return values if weights is None else np.sum(weights * values, axis=1, keepdims=True)
