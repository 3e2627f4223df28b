"""From range-Doppler cells to the paths that lie in them."""
from __future__ import annotations

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class CellBox:
    """A rectangle of cells: first and last index along range and velocity, both included."""

    first_range: int
    last_range: int
    first_velocity: int
    last_velocity: int

    @classmethod
    def around(cls, range_index: int, velocity_index: int, reach: int = 0) -> CellBox:
        """The cells at most `reach` from one."""
        return cls(range_index - reach, range_index + reach, velocity_index - reach, velocity_index + reach)

    def within(self, num_ranges: int, num_velocities: int) -> CellBox:
        """The part of it on a map of that size."""
        return CellBox(max(self.first_range, 0), min(self.last_range, num_ranges - 1),
                       max(self.first_velocity, 0), min(self.last_velocity, num_velocities - 1))


class CellIndex:
    """Paths sorted by cell, so that a rectangle costs one search for each velocity, however many paths there are."""

    def __init__(self, range_index, velocity_index, num_ranges: int, num_velocities: int):
        """range_index, velocity_index: [P] cell of each path, -1 for paths outside the map."""
        self._shape = num_ranges, num_velocities
        self._num_paths = len(range_index)
        inside = np.flatnonzero(np.asarray(range_index) >= 0)
        cell = np.asarray(velocity_index, np.int64)[inside] * num_ranges + np.asarray(range_index)[inside]
        order = np.argsort(cell.astype(np.uint32))
        self._cell, self._path = cell[order], inside[order]

    def mask_of(self, box: CellBox):
        """Which paths lie in the rectangle: bool [P]."""
        mask = np.zeros(self._num_paths, bool)
        box = box.within(*self._shape)
        rows = np.arange(box.first_velocity, box.last_velocity + 1) * self._shape[0]
        begins = np.searchsorted(self._cell, rows + box.first_range, "left")
        ends = np.searchsorted(self._cell, rows + box.last_range, "right")
        for begin, end in zip(begins, ends):
            mask[self._path[begin:end]] = True
        return mask
