"""Powers of the parts of the paths in the cells of a map, from one pass over the paths."""
from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .. import _core
from ..signals.parts import decompose
from .planes import with_receivers

CUBES_IN_MEMORY = 1 << 30  # bytes that the cubes of one set of receivers may take, as far as one receiver does not need more
_COPIES = 4                # of a cube: what decompose returns, and up to three times that for each combination while it runs


class CubeSet(NamedTuple):
    """Cubes of the parts of some views at some of the receivers: {view: {part: cube [tx, rx, chirp, sample]}}.

    weight: of these receivers in the mean over all of them.
    """

    radar: object
    weight: float
    views: dict


def rival_of(part):
    """What a part competes for cells as: itself, or of ghosts (Family) all that go over the same mirrors as often.

    Among them are the same ways there and back, which no map tells apart: their fields add up.
    """
    is_ghost = isinstance(part, _core.Family) and part.is_ghost
    return (part.object, part.order, frozenset(part.via)) if is_ghost else part


def parts_by_rival(parts) -> dict:
    """{rival: [part, ...]} of parts."""
    found = {}
    for part in parts:
        found.setdefault(rival_of(part), []).append(part)
    return found


class ViewPowers:
    """Powers of the parts of one view, added up over sets of receivers.

    cells: {part: [V, R] W}; whole: [V, R] W, of the sum of the parts as fields
    rivals: {rival_of(part): [V, R] W, of the sum of their fields}, in the order of their first parts
    received: {part: W}, mean over channels, chirps and samples
    strongest: W in the strongest cell of what paths make, None: that of the whole
    """

    def __init__(self, plane):
        self._plane = plane
        self.cells, self.rivals, self.received, self.whole, self.strongest = {}, {}, {}, 0.0, None

    def add(self, cubes: dict, cube_set: CubeSet) -> None:
        """cubes: {part: [tx, rx, chirp, sample]} of the set's receivers."""
        radar, weight = cube_set.radar, cube_set.weight
        powers = {part: self._plane.power(cube, radar) for part, cube in cubes.items()}
        for part, cube in cubes.items():
            self.cells[part] = self.cells.get(part, 0.0) + weight * powers[part]
            self.received[part] = self.received.get(part, 0.0) + weight * mean_square(cube)
        for rival, parts in parts_by_rival(cubes).items():
            joint = powers[parts[0]] if len(parts) == 1 else self._plane.power(sum(cubes[part] for part in parts), radar)
            self.rivals[rival] = self.rivals.get(rival, 0.0) + weight * joint
        whole = next(iter(powers.values())) if len(cubes) == 1 else self._plane.power(sum(cubes.values()), radar)
        self.whole = self.whole + weight * whole


def mean_square(cube) -> float:
    """Mean of |sample|^2 in W, added in one order."""
    samples = np.ascontiguousarray(cube, np.complex128).ravel().view(np.float64)
    return float(np.einsum("i,i->", samples, samples)) / max(cube.size, 1)


def add_powers(cube_sets, plane) -> dict:
    """{view: ViewPowers} of all sets of receivers."""
    powers = {}
    for cube_set in cube_sets:
        for view, cubes in cube_set.views.items():
            powers.setdefault(view, ViewPowers(plane)).add(cubes, cube_set)
    return powers


def join(views, beside: dict, whole, radar, plane) -> None:
    """Gives ViewPowers what no path makes as further parts: {part: cube}; whole: cube of all paths, likewise."""
    cells = {part: plane.power(cube, radar) for part, cube in beside.items()}
    received = {part: mean_square(cube) for part, cube in beside.items()}
    power = plane.power(whole + sum(beside.values()), radar)
    for view in views:
        view.strongest = float(np.max(view.whole, initial=0.0))
        view.cells |= cells
        view.received |= received
        view.whole = power


def decomposed(paths, radar, views: dict, num_parts: int, plane, settings: dict) -> Iterator[CubeSet]:
    """Cubes of all parts of some views, set by set of receivers: few enough at a time that the memory holds them.

    views: {view: what `decompose` takes}; num_parts: of all of them; settings: signal settings of `decompose`
    """
    for which in receiver_sets(radar, num_parts, plane.takes_receiver_sets):
        some = with_receivers(radar, which)
        cubes = decompose(paths, some, views, **settings)
        yield CubeSet(some, len(some.receivers) / len(radar.receivers), cubes)


def receiver_sets(radar, num_parts: int, may_divide: bool = True) -> list[slice]:
    """Which receivers to take at a time."""
    waveform, count = radar.waveform, len(radar.receivers)
    per_receiver = 16 * _COPIES * num_parts * len(radar.transmitters) * waveform.num_chirps * waveform.num_samples
    size = max(1, min(count, CUBES_IN_MEMORY // max(per_receiver, 1))) if may_divide else count
    return [slice(begin, min(begin + size, count)) for begin in range(0, count, size)]
