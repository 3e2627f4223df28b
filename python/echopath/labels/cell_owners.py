"""Which family of paths owns each cell of a map, kept up to date while families come one after the other."""
from __future__ import annotations

import numpy as np

from .labels import NONE
from .left_out import LeftOut
from .powers import rival_of

ALIKE = 10.0 ** -0.01  # ratio of powers: 0.1 dB do not tell one way from the same one back


class CellOwners:
    """The strongest rival in each cell so far, and at the end the family of it that has the cell.

    families: list [F] of Family; rivals: list of lists of indices of families that compete as one, ascending
    best: [V, R] W, the largest power of a rival; family: i32 [V, R], index of the family that has the cell, -1: none
    own: [V, R] W, of that family by itself; received: [F] W, mean over channels, chirps and samples
    peak: [F] W, power in the strongest cell, of families that compete alone
    left_out: LeftOut, None where all families had their signals made
    The result does not depend on the order in which rivals come.
    """

    left_out: LeftOut | None = None

    def __init__(self, shape: tuple, families):
        self.families = list(families)
        rivals = {}
        for number, family in enumerate(self.families):
            rivals.setdefault(rival_of(family), []).append(number)
        self.rivals = list(rivals.values())
        self.best, self.own = np.zeros(shape), np.zeros(shape)
        self._rival, self.family = np.full(shape, NONE, np.int32), np.full(shape, NONE, np.int32)
        self.received, self.peak = np.zeros(len(self.families)), np.zeros(len(self.families))

    def add(self, rival: int, power, received: float) -> None:
        """rival: index; power: [V, R] W, of the sum of the fields of its families; received: W, of that of one family."""
        wins = (power > self.best) | ((power == self.best) & (power > 0.0) & (rival < self._rival))
        self.best[wins], self._rival[wins] = power[wins], rival
        if len(self.rivals[rival]) == 1:
            self.received[self.rivals[rival]], self.peak[self.rivals[rival]] = received, power.max(initial=0.0)

    def wins(self, rival: int, least: float):
        """bool [R], the ranges where a rival is the strongest so far, with more than `least` W."""
        return np.any((self._rival == rival) & (self.best > least), axis=0)

    def give(self, mask) -> list:
        """Gives the cells of rivals of one family to it. mask: bool [V, R], what counts. Returns the rivals of several that
        have cells."""
        self._mask = mask
        first = np.array([members[0] for members in self.rivals] + [NONE], np.int32)
        self.family, self.own = np.where(mask, first[self._rival], NONE), np.where(mask, self.best, 0.0)
        return [rival for rival in np.unique(self._rival[mask]).tolist() if rival != NONE and len(self.rivals[rival]) > 1]

    def leave(self, power) -> None:
        """Takes the cells from their families where what no path makes has more power, [V, R] W; last of all."""
        stronger = power > self.best
        self.family[stronger], self.own[stronger] = NONE, 0.0

    def ranges_of(self, rival: int):
        """bool [R], the ranges where a rival has cells; after `give`."""
        return np.any(self._mask & (self._rival == rival), axis=0)

    def divide(self, rival: int, own, received) -> None:
        """Gives the cells of a rival to its strongest family by itself, the first of those that are alike.

        own: [V, R] W of each of its families, at the ranges of its cells; received: W of each
        """
        numbers, at = np.array(self.rivals[rival], np.int32), self._mask & (self._rival == rival)
        here = np.stack([power[at] for power in own])
        chosen = np.argmax(here >= ALIKE * here.max(axis=0), axis=0)
        self.family[at], self.own[at] = numbers[chosen], np.take_along_axis(here, chosen[None], axis=0)[0]
        self.received[numbers] = received
