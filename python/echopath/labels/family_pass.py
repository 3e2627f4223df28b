"""Which family of paths owns each cell, without the signals of families that cannot own any.

The families that can are found in rounds. The first takes those that may reach the noise by the amplitudes of their paths; all
others are added to the whole as one, and what each of them can show at a range is bounded from its echoes
(cpp/echopath/sim/cells/cell_bounds.h). Once the whole and its mask are known, a family that was left out can own a cell of the
mask only where its bound is above the strongest rival so far, or of direct echoes above what a ghost leaves them: such families
follow, until there are none. So the owners are those that all families would give.
"""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..signals.part_pass import part_pass
from .cell_owners import SHARED, CellOwners
from .left_out import LeftOut
from .powers import ViewPowers, mean_square, parts_by_rival

SIGNALS_IN_MEMORY = 128 << 20  # bytes that the signals of families may take at a time, unless one needs more
STEP = 0.1                     # ratio of powers: how far each round goes below the last
MOST_SUMS = 1 << 23            # of amplitudes, by rival and pair of cells of range
SHOWN = 1e-3                   # of the noise floor: ranges where a family can show less are left out of its map at first
APART = 0.5                    # of the floor of the mask, as far as it is known: power with which cells are divided early


class _Apart(NamedTuple):
    """What each family of a rival shows by itself: powers [V, ranges] in W, at some of the ranges (bool [R]), and its mean
    power received in W."""

    ranges: np.ndarray
    own: list
    received: tuple

    def maps(self, shape: tuple) -> tuple:
        """(powers [V, R] in W, 0 at other ranges, mean powers received)."""
        maps = np.zeros((len(self.own), *shape))
        maps[:, :, self.ranges] = self.own
        return maps, self.received


class FamilyPass:
    """Makes the signals of families, some at a time, and keeps of each cell only who owns it.

    work: Labelling, of settings with retrace "never"; adds_up: whether `whole` is wanted; probe: SignalProbe of that whole
    """

    def __init__(self, work, *, adds_up: bool, probe=None):
        families, request, settings, radar = work.families, work.request, work.settings, work.request.radar
        self._pass = part_pass(work.paths, radar, families.family_of_path, len(families), settings, probe)
        self._pass.set_adds_up(adds_up)
        self._radar, self._request, self._progress = radar, request, settings.get("progress")
        plane = request.plane
        self._owners = CellOwners((len(plane.rows), len(plane.range)), families.families, request.noise_floor)
        self._is_made = np.zeros(len(self._owners.rivals), bool)
        self._bound_of_rival = np.zeros((len(self._owners.rivals), len(plane.range)))  # W, the most it can show at a range
        self._is_direct = np.array([_is_direct(families.families[members[0]]) for members in self._owners.rivals], bool)
        self._least = SHOWN * request.noise_floor
        self._apart = {}  # {rival: _Apart}
        self._make_likely(families, work.mean)
        if adds_up and probe is not None:
            self._pass.finish_probe()

    def whole(self):
        """Sum of all signals, [tx, rx, chirp, sample] in sqrt(W)."""
        return self._pass.whole()

    def assign_cells(self, mask, intervals: dict) -> CellOwners:
        """Makes the families that may own a cell after all, and gives the cells to their families.

        mask: bool [V, R], the cells that have an owner; intervals: {Family: Interval} of mean powers in W
        """
        self._pass.set_adds_up(False)
        owners = self._owners
        self._make_open(mask)
        if self._least > 0.0 and np.any(mask & (SHARED * owners.best <= self._least)):
            self._least = 0.0  # what maps leave out may own these cells
            self._make(np.flatnonzero(self._is_made).tolist())
            self._make_open(mask)
        self._note_left_out(intervals)
        shared = owners.give(mask)
        self._see_apart([(rival, ranges) for rival in shared
                         if not self._is_known_apart(rival, ranges := owners.ranges_of(rival))])
        for rival in shared:
            owners.divide(rival, *self._apart.pop(rival).maps(owners.best.shape))
        return owners

    def _make_likely(self, families, mean) -> None:
        """Makes those that may reach the noise, or the dynamic range below the strongest path, and bounds all others."""
        floor, rivals = self._request.noise_floor, self._owners.rivals
        powers, strongest = self._likely_powers(families, mean)
        mask_floor = max(floor, self._request.dynamic_range * strongest)
        likely = [rival for rival in np.argsort(-powers, kind="stable").tolist()
                  if powers[rival] > 0.0 and powers[rival] >= (floor if self._is_direct[rival] else mask_floor)]
        rest = np.setdiff1d(np.arange(len(rivals)), likely)
        if len(rest) > 0:
            sets = [rivals[rival] for rival in rest]
            self._bound_of_rival[rest] = self._pass.bounds(sets, *self._request.plane.window_and_padding, self._progress)
        self._make(likely)

    def _likely_powers(self, families, mean) -> tuple:
        """Power [rivals] in W where the paths of a rival in two neighbouring cells of range add up in phase, at the time of the
        trace and for the first antennas, and the power of the strongest path in W. Pairs of cells too many to count are counted
        with nearer ones, which makes powers larger."""
        amplitude, waveform = np.sqrt(mean.of_paths), self._radar.waveform
        cell = mean.lengths / (2.0 * waveform.range_resolution)
        num_rivals = len(self._owners.rivals)
        most_pairs = max(1, MOST_SUMS // max(1, num_rivals))
        num_pairs = int(min(0.5 * cell.max(initial=0.0) + 1.5, most_pairs))
        first = (num_pairs * self._owners.rival_of_family)[families.family_of_path]
        powers = np.zeros(num_rivals)
        for shift in (0.0, 0.5):
            pair = (0.5 * cell + shift).astype(np.int64) % num_pairs
            sums = np.bincount(first + pair, amplitude, num_rivals * num_pairs)
            powers = np.maximum(powers, sums.reshape(num_rivals, num_pairs).max(axis=1) ** 2)
        return powers, float(amplitude.max(initial=0.0)) ** 2

    def _open_rivals(self, mask) -> list:
        """[(largest bound in W, rival), ...] of those not made that may own a cell, or tell of an object above the noise."""
        least = np.where(mask, np.maximum(self._owners.best, self._least), np.inf).min(axis=0)
        bounds = self._bound_of_rival
        largest = bounds.max(axis=1, initial=0.0)
        least = np.where(self._is_direct[:, None], SHARED, 1.0) * least
        may_own = np.any(bounds >= np.maximum(least, np.finfo(float).tiny), axis=1)
        tells = (largest > self._request.noise_floor) & self._is_direct
        return [(float(largest[rival]), rival) for rival in np.flatnonzero(~self._is_made & (may_own | tells)).tolist()]

    def _make_open(self, mask) -> None:
        """Makes those that may own a cell, strongest first, until there are none."""
        level = np.inf
        while (open_rivals := self._open_rivals(mask)):
            level = STEP * min(level, max(bound for bound, _ in open_rivals))
            self._make([rival for bound, rival in open_rivals if bound >= level])

    def _make(self, rivals: list) -> None:
        """Those of several families come apart from others: their signals are kept, for the families by themselves."""
        members = self._owners.rivals
        for shares in (False, True):
            some = [rival for rival in rivals if (len(members[rival]) > 1) == shares]
            for first, powers in self._powers([members[rival] for rival in some], self._least):
                made = some[first:first + len(powers)]
                for rival, (power, received) in zip(made, powers):
                    self._owners.add(rival, power, received, self._least)
                    self._is_made[rival] = True
                if shares and self._request.plane.takes_receiver_sets:
                    self._see_winners(made)

    def _see_winners(self, rivals: list) -> None:
        """Looks at the families of rivals that may keep the cells they win, while their signals are there."""
        owners, request = self._owners, self._request
        least = APART * max(request.noise_floor, request.dynamic_range * owners.best.max())
        found = [(rival, owners.wins(rival, least)) for rival in rivals]
        self._see_apart([(rival, ranges) for rival, ranges in found if ranges.any()])

    def _is_known_apart(self, rival: int, ranges) -> bool:
        return rival in self._apart and not np.any(ranges & ~self._apart[rival].ranges)

    def _see_apart(self, some: list) -> None:
        """Keeps what each family of some rivals shows by itself. some: [(rival, ranges bool [R]), ...]"""
        members = self._owners.rivals
        alone = [([number], ranges) for rival, ranges in some for number in members[rival]]
        asked = [ranges.astype(np.uint8).tolist() for _, ranges in alone]
        powers = (found for _, batch in self._powers([one for one, _ in alone], 0.0, asked) for found in batch)
        for rival, ranges in some:
            own, received = zip(*(next(powers) for _ in members[rival]))
            self._apart[rival] = _Apart(ranges, [power[:, ranges] for power in own], received)

    def _powers(self, sets: list, least: float, ranges: list | None = None):
        """(index of the first, [(power [V, R], mean square), ...] in W) of the signals of some sets of families after others.

        least: W; cells at ranges where a set can show no more may be 0
        ranges: of each set, [R] 1 where its power is asked for, else 0: there it may be 0; None: everywhere
        """
        plane, shape = self._request.plane, self._owners.best.shape
        most = max(1, SIGNALS_IN_MEMORY // self._pass.group_bytes)
        for first in range(0, len(sets), most):
            some = sets[first:first + most]
            if plane.takes_receiver_sets:
                asked = [] if ranges is None else ranges[first:first + most]
                powers = self._pass.powers(some, *plane.window_and_padding, least, self._progress, asked)
                yield first, [(power.reshape(shape), received) for power, received in powers]
            else:
                yield first, [(plane.power(cube, self._radar), mean_square(cube))
                              for cube in self._pass.cubes(some, self._progress)]

    def _note_left_out(self, intervals: dict) -> None:
        """Tells which families with some power were left out; powers of families that were not made by themselves are means over
        the random phases."""
        owners = self._owners
        mean = np.array([intervals[family].power for family in owners.families])
        rest = np.flatnonzero(~self._is_made).tolist()
        numbers = [number for rival in rest for number in owners.rivals[rival] if mean[number] > 0.0]
        owners.left_out = LeftOut(len(numbers), float(mean[numbers].sum()),
                                  float(self._bound_of_rival[rest].max(initial=0.0)))
        alone = [members[0] for members, made in zip(owners.rivals, self._is_made) if made and len(members) == 1]
        mean[alone] = owners.received[alone]
        owners.received = mean


def _is_direct(family) -> bool:
    """Whether it holds the direct echoes of an object."""
    return bool(family.object) and not family.is_ghost


def owners_of_views(powers: ViewPowers, mask, floor: float = 0.0) -> CellOwners:
    """The owners of cells where the powers of all families are known. mask: bool [V, R], what counts; floor: of CellOwners, W"""
    families = list(powers.cells)
    owners = CellOwners(np.shape(powers.whole), families, floor)
    owners.received = np.array([powers.received[family] for family in families])
    for number, (rival, members) in enumerate(parts_by_rival(families).items()):
        owners.add(number, powers.rivals[rival], powers.received[members[0]])
    for rival in owners.give(mask):
        members = [families[number] for number in owners.rivals[rival]]
        owners.divide(rival, [powers.cells[family] for family in members], [powers.received[family] for family in members])
    return owners
