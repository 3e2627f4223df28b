"""Powers of the parts of the paths in the cells of a map, from one pass over the paths."""
from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

import echopath as ep

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


class ViewPowers:
    """Powers of the parts of one view, added up over sets of receivers.

    cells: {part: [V, R] W}; whole: [V, R] W, of the sum of the parts as fields
    received: {part: W}, mean over channels, chirps and samples
    """

    def __init__(self, plane):
        self._plane = plane
        self.cells, self.received, self.whole = {}, {}, 0.0

    def add(self, cubes: dict, cube_set: CubeSet) -> None:
        """cubes: {part: [tx, rx, chirp, sample]} of the set's receivers."""
        radar, weight = cube_set.radar, cube_set.weight
        for part, cube in cubes.items():
            self.cells[part] = self.cells.get(part, 0.0) + weight * self._plane.power(cube, radar)
            self.received[part] = self.received.get(part, 0.0) + weight * _mean_square(cube)
        self.whole = self.whole + weight * self._plane.power(sum(cubes.values()), radar)


def _mean_square(cube) -> float:
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


def decomposed(paths, radar, views: dict, num_parts: int, plane, settings: dict) -> Iterator[CubeSet]:
    """Cubes of all parts of some views, set by set of receivers: few enough at a time that the memory holds them.

    views: {view: what `decompose` takes}; num_parts: of all of them; settings: signal settings of `decompose`
    """
    for which in receiver_sets(radar, num_parts, plane.takes_receiver_sets):
        some = with_receivers(radar, which)
        cubes = ep.decompose(paths, some, views, **settings)
        yield CubeSet(some, len(some.receivers) / len(radar.receivers), cubes)


def receiver_sets(radar, num_parts: int, may_divide: bool = True) -> list[slice]:
    """Which receivers to take at a time."""
    waveform, count = radar.waveform, len(radar.receivers)
    per_receiver = 16 * _COPIES * num_parts * len(radar.transmitters) * waveform.num_chirps * waveform.num_samples
    size = max(1, min(count, CUBES_IN_MEMORY // max(per_receiver, 1))) if may_divide else count
    return [slice(begin, min(begin + size, count)) for begin in range(0, count, size)]
