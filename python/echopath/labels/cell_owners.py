"""Which family of paths owns each cell of a map, kept up to date while families come one after the other."""
from __future__ import annotations

import numpy as np

from .labels import NONE
from .left_out import LeftOut
from .powers import rival_of

ALIKE = 10.0 ** -0.01  # ratio of powers: 0.1 dB do not tell one way from the same one back
SHARED = 0.1           # of a ghost's power, or of the object's strongest cell: where its direct echoes have so much, it is there


class CellOwners:
    """The strongest rival in each cell so far, and at the end the family of it that has the cell.

    Ghosts of an object in its own resolution cells, such as those over the ground below it, are told from it by no receiver: a
    cell that a ghost wins is the object's where its direct echoes are at most 10 dB weaker than the ghost, or than in their own
    strongest cell as far as that is above the floor: they fade apart from ghosts, and are in that place all the same.
    families: list [F] of Family; rivals: list of lists of indices of families that compete as one, ascending
    best: [V, R] W, the largest power of a rival; family: i32 [V, R], index of the family that has the cell, -1: none
    own: [V, R] W, of that family by itself; received: [F] W, mean over channels, chirps and samples
    peak: [F] W, power in the strongest cell, of families that compete alone
    floor: W, which tells echoes from noise
    left_out: LeftOut, None where all families had their signals made
    The result does not depend on the order in which rivals come.
    """

    left_out: LeftOut | None = None

    def __init__(self, shape: tuple, families, floor: float):
        self.families, self.floor = list(families), floor
        rivals = {}
        for number, family in enumerate(self.families):
            rivals.setdefault(rival_of(family), []).append(number)
        self.rivals = list(rivals.values())
        self.best, self.own = np.zeros(shape), np.zeros(shape)
        self._rival, self.family = np.full(shape, NONE, np.int32), np.full(shape, NONE, np.int32)
        self.received, self.peak = np.zeros(len(self.families)), np.zeros(len(self.families))
        self._ghosts = self._ghosts_of_objects()
        self._direct = {}  # {rival of direct echoes: (places [N] of cells, powers [N] in W)}

    def add(self, rival: int, power, received: float, least: float = 0.0) -> None:
        """rival: index; power: [V, R] W, of the sum of the fields of its families; received: W, of that of one family; least: W,
        up to which a power may be 0 instead."""
        if rival in self._ghosts:
            places = np.flatnonzero(power > least)
            self._direct[rival] = places, power.ravel()[places]
        wins = (power > self.best) | ((power == self.best) & (power > 0.0) & (rival < self._rival))
        self.best[wins], self._rival[wins] = power[wins], rival
        if len(self.rivals[rival]) == 1:
            self.received[self.rivals[rival]], self.peak[self.rivals[rival]] = received, power.max(initial=0.0)

    @property
    def rival_of_family(self):
        """Index of the rival that each family belongs to, i64 [F]."""
        found = np.zeros(len(self.families), np.int64)
        for rival, members in enumerate(self.rivals):
            found[members] = rival
        return found

    def faded(self) -> list:
        """The rivals of direct echoes that may be too weak beside a ghost of the object, but not beside their own strongest
        cell: those that need `peak` of the whole map before `give`."""
        def is_faded(rival: int) -> bool:
            places, power = self._direct[rival]
            return bool(np.any(self._is_lost(rival) & (power < SHARED * self.best.ravel()[places])
                               & (power > SHARED * self.floor)))

        return [rival for rival in self._direct if is_faded(rival)]

    def wins(self, rival: int, least: float):
        """bool [R], the ranges where a rival is the strongest so far, with more than `least` W."""
        return np.any((self._rival == rival) & (self.best > least), axis=0)

    def give(self, mask) -> list:
        """Gives the cells of rivals of one family to it. mask: bool [V, R], what counts. Returns the rivals of several that
        have cells."""
        self._mask = mask
        taken = self._take_from_ghosts()
        first = np.array([members[0] for members in self.rivals] + [NONE], np.int32)
        self.family, self.own = np.where(mask, first[self._rival], NONE), np.where(mask, self.best, 0.0)
        for places, power in taken:
            self.own.flat[places] = power
        return [rival for rival in np.unique(self._rival[mask]).tolist() if rival != NONE and len(self.rivals[rival]) > 1]

    def _ghosts_of_objects(self) -> dict:
        """{rival of the direct echoes of an object: [rivals of its ghosts]} of objects that have some."""
        firsts = [self.families[members[0]] for members in self.rivals]
        direct = {family.object: rival for rival, family in enumerate(firsts) if family.object and not family.is_ghost}
        found = {}
        for rival, family in enumerate(firsts):
            if family.is_ghost and family.object in direct:
                found.setdefault(direct[family.object], []).append(rival)
        return found

    def _take_from_ghosts(self) -> list:
        """Gives objects the cells that they share with ghosts of theirs. Returns [(places [N], own powers [N] in W), ...]."""
        taken = []
        for rival, (places, power) in self._direct.items():
            peak = self.peak[self.rivals[rival]]
            least = SHARED * np.minimum(self.best.ravel()[places], peak if peak > self.floor else np.inf)
            is_shared = self._mask.ravel()[places] & (power >= least) & self._is_lost(rival)
            taken.append((places[is_shared], power[is_shared]))
            self._rival.flat[taken[-1][0]] = rival
        return taken

    def _is_lost(self, rival: int):
        """bool [N], of the cells that are kept of direct echoes, those that a ghost of the object wins."""
        return np.isin(self._rival.ravel()[self._direct[rival][0]], self._ghosts[rival])

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
