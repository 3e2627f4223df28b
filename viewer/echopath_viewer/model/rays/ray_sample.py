"""Which rays are drawn: some of every object and of every part, not only the strongest, which may all touch the ground."""
from __future__ import annotations

import numpy as np

from .touch_groups import TouchGroups

SAMPLINGS = ("over objects", "strongest")  # which rays are drawn where there are too many
SPAN_DB = 40.0     # below the strongest group: weaker ones have a ray only for meshes that have none otherwise
MESH_SHARE = 0.25  # of the rays, that meshes are sure of together


class RaySampler:
    """Samples of the paths of a record at one channel, stratified by the meshes that they touch."""

    def __init__(self, groups: TouchGroups, power, coherent_power, num_meshes: int):
        """groups: each of them strongest first, so that filters need no sorting; power: [P] W

        coherent_power: [G] W, as of `coherent_powers`
        """
        self._groups, self._touches = groups, groups.touching(num_meshes)
        self._order, self._power, self.coherent_power = groups.order, power, coherent_power
        self._has_power = power[self._order] > 0.0

    def sample(self, mask, count: int, parts=()):
        """At most `count` of the paths where `mask` [P] is true, as indices; every prefix is spread over the groups.

        parts: bool [P] each, of which the sample holds some, too. Paths of no power are never drawn.
        """
        if count <= 0:
            return np.zeros(0, np.int64)
        found = np.flatnonzero(mask[self._order] & self._has_power)  # group by group, each strongest first
        ends = np.searchsorted(found, self._groups.begins)
        begins, sizes = ends[:-1], np.diff(ends)
        quotas = self._quotas(sizes, count, self._strongest(found, begins, sizes))
        rank = np.arange(int(quotas.sum())) - np.repeat(np.cumsum(quotas) - quotas, quotas)
        chosen = self._order[found[np.repeat(begins, quotas) + rank]]
        chosen = chosen[np.lexsort((-self._power[chosen], rank))].astype(np.int64)
        return self._with_parts(chosen, mask, count, parts)

    def _strongest(self, found, begins, sizes):
        """W, of each group, 0 where it has none: [G]."""
        power = np.zeros(len(sizes))
        power[sizes > 0] = self._power[self._order[found[begins[sizes > 0]]]]
        return power

    def _quotas(self, sizes, count: int, strongest):
        """How many paths of each group: by decibels over the weakest that counts, and a few for every mesh."""
        with np.errstate(divide="ignore"):
            level = 10.0 * np.log10(np.where(sizes > 0, self.coherent_power, 0.0))
        highest = level.max(initial=-np.inf)
        weight = np.clip(level - (highest - SPAN_DB), 0.0, SPAN_DB) if np.isfinite(highest) else 0.0 * sizes
        sure = self._sure_of_meshes(sizes, count, strongest)
        return sure + _shared(np.nan_to_num(weight), sizes - sure, count - int(sure.sum()))

    def _sure_of_meshes(self, sizes, count: int, strongest):
        """Paths that meshes are sure of: of each mesh those of the group that shows it best."""
        sure = np.zeros(len(sizes), np.int64)
        meshes = np.flatnonzero(self._touches[sizes > 0].any(axis=0))
        each = max(1, int(MESH_SHARE * count / max(len(meshes), 1)))
        for mesh in meshes:
            group = int(np.argmax(np.where(self._touches[:, mesh], strongest, -1.0)))
            room = count - int(sure.sum())
            sure[group] = max(sure[group], min(each, sizes[group], sure[group] + room))
        return sure

    def _with_parts(self, chosen, mask, count: int, parts):
        """Parts that have no ray among the chosen take the places of the last ones."""
        firsts = []
        for part in parts:
            if len(chosen) and not part[chosen].any():
                own = np.flatnonzero(part & mask)
                firsts += [int(path) for path in own[self._power[own].argsort()[-1:]] if self._power[path] > 0.0]
        return np.concatenate([np.array(firsts, np.int64), chosen])[:count]


def coherent_powers(groups: TouchGroups, amplitude, cell):
    """W, the largest power of a cell of each group, its paths added with their phases: [G].

    amplitude: complex [P] in sqrt(W); cell: [P] any number of the cell where a path is seen
    """
    amplitude, cell = amplitude[groups.order], cell[groups.order]
    peaks = np.zeros(len(groups))
    for group, rows in enumerate(groups.slices()):
        _, at = np.unique(cell[rows], return_inverse=True)
        sums = np.bincount(at, amplitude[rows].real) + 1j * np.bincount(at, amplitude[rows].imag)
        peaks[group] = (np.abs(sums) ** 2).max(initial=0.0)
    return peaks


def _shared(weight, room, count: int):
    """At most `count` shared out by weight, none more than its room: i64."""
    given = np.zeros(len(room), np.int64)
    while count > 0 and (weight * (room > given)).any():
        open_weight = weight * (room > given)
        more = np.minimum(np.floor(count * open_weight / open_weight.sum()).astype(np.int64), room - given)
        if not more.any():  # the last few, one each, by weight
            heaviest = np.argsort(-open_weight, kind="stable")[:min(count, np.count_nonzero(open_weight))]
            more[heaviest] = 1
        given, count = given + more, count - int(more.sum())
    if count > 0 and (room > given).any():  # weights are used up: whatever is left
        for group in np.argsort(-(room - given), kind="stable"):
            more = min(count, int(room[group] - given[group]))
            given[group] += more
            count -= more
    return given
