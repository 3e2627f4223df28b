"""Parts of actors that move as a function of time: where they are, and the keys at which that is told."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..arguments.checks import refused
from ..base.numerics.rotations import quaternions
from ..trajectories.trajectory import Trajectory
from .actor import PartArrays

DIFFERENCE = 1e-4    # s, of differences that give rates
STANDING = 0.05      # s, between keys, from which on nothing moves between them: keys on the move are closer
MOST_KEYS = 200_000  # of a part


@dataclass(frozen=True)
class Frames:
    """A body part over time: its proximal joint and its axes (part to actor)."""

    origin: np.ndarray     # [T, 3] m
    rotation: np.ndarray   # [T, 3, 3]


def keyframe_times(start_time: float, duration: float, rate: float) -> np.ndarray:
    """Times [T] in s, evenly from start_time over `duration`, at least `rate` a second and at least 4.

    Raises ValueError naming duration where these are more than MOST_KEYS.
    """
    if duration * rate > MOST_KEYS:
        raise refused(ValueError, "duration", f"at most {MOST_KEYS / rate:g} s at a keyframe_rate of {rate:g}", duration)
    count = max(4, int(np.ceil(duration * rate - 1e-9)) + 1)
    return start_time + duration * np.linspace(0.0, 1.0, count)


def key_times(trajectory: Trajectory, rate: float) -> np.ndarray:
    """Times [T] in s, multiples of a power of two of a second, at least `rate` a second while it moves."""
    step = 2.0 ** -np.ceil(np.log2(rate))
    begin, *_, end = trajectory._within_details([])
    begins, ends = (np.clip(edges, begin, end) for edges in trajectory._track.profile.moving())
    if np.sum(ends - begins) / step > MOST_KEYS:
        raise refused(ValueError, "trajectory", f"at most {MOST_KEYS * step:g} s on the move at such a keyframe_rate", trajectory)
    first = np.maximum(np.floor(begins / step) - 2.0, np.ceil(begin / step))    # with neighbours, at which it stands
    last = np.minimum(np.ceil(ends / step) + 2.0, np.floor(end / step))
    grid = np.concatenate([np.arange(one, other + 1.0) for one, other in zip(first, last)] or [[]]) * step
    times = np.unique(np.concatenate([[begin], grid, [end]]))
    close = np.flatnonzero(np.diff(times) < 1e-3 * step)
    times = np.delete(times, np.where(close == 0, 1, close))
    moves = trajectory.speed(times) > 0.0
    near = moves.copy()
    near[1:] |= moves[:-1]
    near[:-1] |= moves[1:]
    near[[0, -1]] = True
    return times[near]


def with_rates(arrays: list[PartArrays], frames_at: Callable, times) -> list[PartArrays]:
    """PartArrays whose keys at times [T] have rates, too: those of frames_at(times) -> {name: Frames}, by differences."""
    low, high = np.maximum(times - DIFFERENCE, times[0]), np.minimum(times + DIFFERENCE, times[-1])
    before, after, span = frames_at(low), frames_at(high), (high - low)[:, None]
    stands = np.diff(times, prepend=-np.inf, append=np.inf) > STANDING
    stands[[0, -1]] = False
    span[stands[:-1] | stands[1:]] = np.inf     # else what is at rest to rounding would drift in an hour
    parts = []
    for part in arrays:
        first, second = before[part.name], after[part.name]
        turns = [_near(quaternions(frames.rotation), part.rotations) for frames in (first, second)]
        rates = (second.origin - first.origin) / span, (turns[1] - turns[0]) / span
        parts.append(replace(part, rates=rates))
    return parts


def _near(turns, reference):
    """Quaternions [T, 4] of the sign that is nearer to others."""
    return turns * np.where(np.sum(turns * reference, axis=-1) < 0.0, -1.0, 1.0)[:, None]
