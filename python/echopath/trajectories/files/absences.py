"""Who leaves a file for some of its steps and comes back where no way leads, or jumps: somebody else from there on.

SUMO's vehicles leave where they are teleported out of a jam, or where only a part of the network is written; its persons jump
across junctions of networks without paths and crossings for them.
"""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...base.text.node_names import unique
from .doubts import LEAST_WAY, MOST_RATIO
from .samples import Samples

FASTEST_WALK, LEAST_JUMP = 3.0, 1.0    # m/s and m, of persons beyond their speeds: those jump who go farther


def parted(tracks: Mapping[str, Samples], speeds: Mapping[str, ArrayLike], steps: NDArray[np.float64]) -> dict[str, Samples]:
    """Samples {name: Samples} by ways: the first has the name, those after an absence or a jump are "name_2" and so on.

    speeds: {name: [P] m/s} of the rows, NaN where the file has none: who is gone for steps but goes on as fast as before and
    behind is one, and who goes as fast as that, or without speeds as usual, does not jump; steps: s, ascending, of all in the
    file
    """
    found: dict[str, Samples] = {}
    taken = dict.fromkeys(tracks, 1)
    for name, samples in tracks.items():
        first, *others = _ways_of(samples, np.asarray(speeds[name], float), steps)
        found[name] = first
        for other in others:
            found[unique(name, taken)] = other
    return found


def _ways_of(samples: Samples, speeds: NDArray[np.float64], steps: NDArray[np.float64]) -> list[Samples]:
    times = np.array(samples.times)
    num_steps, durations = np.diff(np.searchsorted(steps, times)), np.diff(times)
    has_legs = len(times) > 1 and bool(np.all(durations > 0.0))  # times that are not later are refused behind this
    if not has_legs or not (samples.is_person or np.any(num_steps > 1)):
        return [samples]
    by_place = np.linalg.norm(np.diff(samples.places[:, :2], axis=0), axis=1)
    by_speed = 0.5 * (speeds[:-1] + speeds[1:]) * durations
    differ = (by_place > MOST_RATIO * by_speed) | (by_speed > MOST_RATIO * by_place)
    goes = np.maximum(by_place, by_speed) > LEAST_WAY
    leaves = (num_steps > np.median(num_steps)) & differ & goes
    cuts = (1 + np.flatnonzero(leaves | (samples.is_person & _jumps(by_place, durations, speeds)))).tolist()
    return [_part(samples, begin, end) for begin, end in zip([0, *cuts], [*cuts, len(times)])]


def _jumps(ways: NDArray[np.float64], durations: NDArray[np.float64], speeds: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether no legs go ways [P - 1] in m from row to row, by speeds [P] in m/s or, where these are NaN, the usual one."""
    told = np.fmax(speeds[:-1], speeds[1:])
    usual = np.median(ways / durations)
    fastest = np.maximum(MOST_RATIO * np.where(np.isnan(told), usual, told), FASTEST_WALK)
    return ways > fastest * durations + LEAST_JUMP


def _part(samples: Samples, begin: int, end: int) -> Samples:
    """Rows from `begin` on, before `end`."""
    return replace(samples, lines=samples.lines[begin:end], times=samples.times[begin:end], yaws=samples.yaws[begin:end],
                   coordinates=samples.coordinates[3 * begin:3 * end], speeds=samples.speeds[begin:end])
