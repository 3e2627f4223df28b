"""What each family of a frame whose records are renewed gives to a cell of its map."""
from __future__ import annotations

import numpy as np

from .. import _core


class FamilyFields:
    """The fields of the signals of whole families in all channels, by the names that EchoFields has for those of paths.

    The paths of mid-frame do not tell what made a cell of a frame whose records are renewed.

    families: list [F] of Family; family_of_path: [F], each of them being one echo; channels: (transmitter, receiver), [C, 2]
    """

    def __init__(self, signals: dict, radar, spectrum):
        """signals: {Family: cube [tx, rx, chirp, sample] in sqrt(W)} without noise; radar, spectrum: of the map"""
        self.families, self.family_of_path = list(signals), np.arange(len(signals))
        self.channels = np.argwhere(np.ones(spectrum.values.shape[:2], bool))
        self._signals, self._radar, self._spectrum = signals, radar, spectrum
        self._fields, self._peaks = {}, np.zeros(len(signals))

    def evaluate(self, cells, progress=None) -> None:
        """Makes the maps of all families, one at a time, and keeps of each what it has in cells [N, 2]."""
        fields = np.zeros((len(cells), len(self.channels), len(self)), complex)
        for number, cube in enumerate(self._signals.values()):
            found = _core.range_doppler(cube, self._radar, self._spectrum.window, self._spectrum.zero_pad)
            fields[:, :, number] = _in_cells(found.values, cells)
            self._peaks[number] = _core.mean_power(found).max(initial=0.0)
        self._fields = {tuple(cell): of_cell for cell, of_cell in zip(cells.tolist(), fields)}

    def fields(self, cell) -> tuple:
        """(indices [F], fields complex [C, F] in sqrt(W)) of the families in one of the cells."""
        return self.family_of_path, self._fields[tuple(cell.tolist())]

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
    return values[:, :, velocity, distance].reshape(-1, len(cells)).T
