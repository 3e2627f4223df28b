"""Who leaves a file for some of its steps and comes back where no way leads: somebody else from there on.

SUMO's vehicles do so where they are teleported out of a jam, or where only a part of the network is written.
"""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .doubts import LEAST_WAY, MOST_RATIO
from .samples import Samples


def parted(tracks: Mapping[str, Samples], speeds: Mapping[str, ArrayLike], steps: NDArray[np.float64]) -> dict[str, Samples]:
    """Samples {name: Samples} by ways: the first has the name, those after an absence are "name_2" and so on.

    speeds: {name: [P] m/s} of the rows, NaN where the file has none: who is gone for steps but goes on as fast as before and
    behind is one; steps: s, ascending, of all in the file
    """
    found: dict[str, Samples] = {}
    for name, samples in tracks.items():
        first, *others = _ways_of(samples, np.asarray(speeds[name], float), steps)
        found[name], number = first, 2
        for other in others:
            while f"{name}_{number}" in tracks or f"{name}_{number}" in found:
                number += 1
            found[f"{name}_{number}"] = other
    return found


def _ways_of(samples: Samples, speeds: NDArray[np.float64], steps: NDArray[np.float64]) -> list[Samples]:
    times = np.array(samples.times)
    num_steps = np.diff(np.searchsorted(steps, times))
    if not np.any(num_steps > 1):
        return [samples]
    by_place = np.linalg.norm(np.diff(samples.places[:, :2], axis=0), axis=1)
    by_speed = 0.5 * (speeds[:-1] + speeds[1:]) * np.diff(times)
    differ = (by_place > MOST_RATIO * by_speed) | (by_speed > MOST_RATIO * by_place)
    goes = np.maximum(by_place, by_speed) > LEAST_WAY
    cuts = (1 + np.flatnonzero((num_steps > np.median(num_steps)) & differ & goes)).tolist()
    return [_part(samples, begin, end) for begin, end in zip([0, *cuts], [*cuts, len(times)])]


def _part(samples: Samples, begin: int, end: int) -> Samples:
    """Rows from `begin` on, before `end`."""
    return replace(samples, lines=samples.lines[begin:end], times=samples.times[begin:end], yaws=samples.yaws[begin:end],
                   coordinates=samples.coordinates[3 * begin:3 * end], speeds=samples.speeds[begin:end])
