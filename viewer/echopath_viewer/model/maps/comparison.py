"""Two maps beside each other, and by how much they differ."""
from __future__ import annotations

import dataclasses

import numpy as np

OVER_NOISE_DB = 8.0


@dataclasses.dataclass(frozen=True)
class KeptMap:
    """A map that is kept to be compared with: level f32 [V, R] in dBm over range in m and velocity in m/s."""

    title: str
    level: np.ndarray
    range: np.ndarray
    velocity: np.ndarray


def kept_map(session, title: str) -> KeptMap:
    """The map of the part and channel on display."""
    part = session.part
    return KeptMap(title, part.level(*session.channel), np.asarray(part.spectrum.range), np.asarray(part.spectrum.velocity))


def difference(kept: KeptMap, now: KeptMap):
    """How much higher the map of now is, f32 [V, R] in dB on its axes; levels count as no lower than somewhat above the noise,
    the median of a map, so that noise does not differ.

    Cells of another radar are the nearest of its own; NaN where it has none.
    """
    floor = OVER_NOISE_DB + max(float(np.median(one.level)) for one in (kept, now))
    rows, columns = (_nearest(ours, theirs) for ours, theirs in ((now.velocity, kept.velocity), (now.range, kept.range)))
    before = kept.level[np.maximum(rows, 0)][:, np.maximum(columns, 0)]
    values = np.maximum(now.level, floor) - np.maximum(before, floor)
    values[rows < 0] = np.nan
    values[:, columns < 0] = np.nan
    return values


def _nearest(ours, theirs):
    """Index into `theirs` of the entry nearest to each of `ours`, -1 beyond its ends; evenly spaced, ascending."""
    step = theirs[1] - theirs[0] if len(theirs) > 1 else 1.0
    at = np.round((np.asarray(ours) - theirs[0]) / step).astype(np.int64)
    return np.where((at >= 0) & (at < len(theirs)), at, -1)
