"""What each family of a frame whose records are renewed gives to a cell of its map."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .. import _core
from ..base.process.progress import with_progress
from ..labels.planes import with_receivers
from ..labels.powers import receiver_sets
from ..paths.families import Families
from .channels import by_channel

# Gives for families and a radar, which may have some of the receivers, {Family: cube [tx, rx, chirp, sample] in sqrt(W)} without
# noise of all these families.
Signals = Callable[[Families, _core.Radar], dict]


class FamilyFields:
    """The fields of the signals of whole families in cells, by the names that EchoFields has for those of paths.

    The paths of mid-frame do not tell what made a cell of a frame whose records are renewed: these may have further families.
    families: list [F] of Family; family_of_path: [F], each of them being one echo
    """

    def __init__(self, families: Families, signals: Signals, radar, spectrum, cells, beams=None, progress=None):
        """Makes the maps of all, one at a time and of as many receivers as memory holds the signals of, and keeps of each what it
        has in the cells. families: of mid-frame; radar, spectrum: of the map; cells, beams, progress: as of EchoFields"""
        num_channels = spectrum.values.shape[0] * spectrum.values.shape[1]
        self._weights = None if beams is None else by_channel(beams)
        self._shape = len(cells), num_channels if beams is None else 1
        self._fields, self._powers = {}, {}
        channels = np.arange(num_channels).reshape(spectrum.values.shape[:2])
        for which in receiver_sets(radar, len(families)):
            some, columns = with_receivers(radar, which), channels[:, which].ravel()
            cubes = signals(families, some)
            for family, cube in with_progress(cubes.items(), len(cubes), progress, "maps of families"):
                found = _core.range_doppler(cube, some, spectrum.window, spectrum.zero_pad)
                share = len(columns) / num_channels
                self._powers[family] = self._powers.get(family, 0.0) + share * _core.mean_power(found).astype(np.float32)
                self._add(family, columns, _values_in(found, cells))
        self.families, self.family_of_path = list(self._fields), np.arange(len(self._fields))

    def _add(self, family, columns, values) -> None:
        """Adds values [N, K] of some channels, which have columns [K], or their sums in beams."""
        of_family = self._fields.setdefault(family, np.zeros(self._shape, complex))
        if self._weights is None:
            of_family[:, columns] += values
        else:
            of_family[:, 0] += np.sum(self._weights[:, columns] * values, axis=1)

    def each(self):
        """Yields of each cell what EchoFields does, of families instead of paths; NaN in place of the power behind the receiver,
        which the signal of the frame tells better."""
        for i in range(self._shape[0]):
            yield self.family_of_path, np.array([field[i] for field in self._fields.values()]).T, np.nan

    def peak_of(self, keep) -> float:
        """Power in W of the strongest cell of the map of the one family where `keep` [F] is true, mean over all channels."""
        (number,) = np.flatnonzero(keep)
        return float(self._powers[self.families[number]].max(initial=0.0))

    def __len__(self) -> int:
        return len(self.families)


def _values_in(spectrum, cells):
    """[N, C] of a map in cells [N, 2]."""
    velocity, distance = cells.T
    num_channels = len(spectrum.values) * spectrum.values.shape[1]
    return spectrum.values[:, :, velocity, distance].reshape(num_channels, len(cells)).T
