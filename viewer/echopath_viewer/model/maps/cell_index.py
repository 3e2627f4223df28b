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

    def holds(self, range_index: int, velocity_index: int) -> bool:
        """Whether a cell is one of them."""
        return (self.first_range <= range_index <= self.last_range
                and self.first_velocity <= velocity_index <= self.last_velocity)

    def within(self, num_ranges: int, num_velocities: int) -> CellBox:
        """The part of it on a map of that size."""
        return CellBox(max(self.first_range, 0), min(self.last_range, num_ranges - 1),
                       max(self.first_velocity, 0), min(self.last_velocity, num_velocities - 1))


class CellIndex:
    """Paths sorted by cell, so that a rectangle costs one look for each velocity, however many paths there are.

    order: u32 [P], the paths cell by cell, those outside the map last
    """

    def __init__(self, cell, num_ranges: int, num_velocities: int, order=None):
        """cell: i32 [P], velocity index * num_ranges + range index, -1 for paths outside the map; order: where it is known."""
        self._shape = num_ranges, num_velocities
        cell = np.asarray(cell, np.int32)
        self.order = np.argsort(cell.view(np.uint32)).astype(np.uint32) if order is None else order
        counts = np.bincount(cell[cell >= 0], minlength=num_ranges * num_velocities)
        self._begins = np.concatenate([[0], np.cumsum(counts)])

    def mask_of(self, box: CellBox):
        """Which paths lie in the rectangle: bool [P]."""
        mask = np.zeros(len(self.order), bool)
        box = box.within(*self._shape)
        if box.first_range > box.last_range:
            return mask
        rows = np.arange(box.first_velocity, box.last_velocity + 1) * self._shape[0]
        for begin, end in zip(self._begins[rows + box.first_range], self._begins[rows + box.last_range + 1]):
            mask[self.order[begin:end]] = True
        return mask
