"""How fast what moves goes, by differences over time."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

STEP = 5e-5  # s, of the differences; their error for a point 0.3 m from an axis of 50 turns/s is below 1e-5 m/s
JUMP = 1e-5  # m, or 1 for entries of rotations: twice the difference over one step is off that over two by more at a jump
ALONE = 4.0  # a difference is taken for a jump where it is so many times farther from the median than any other


def step_within(duration: float) -> float:
    """The step in s with which `rate_of` stays within a frame of `duration` in s about its time."""
    return min(STEP, 0.25 * duration) if duration > 0.0 else STEP


def rate_of(value: Callable, time: float, step: float):
    """Derivative at `time` in s of value(time), an array, by differences of fourth order; 0 of what stays.

    Where the value jumps within these differences, as that of a loop which begins anew, it is the derivative on the side of the
    jump on which `time` is.
    """
    near, far = (value(time + reach) - value(time - reach) for reach in (step, 2.0 * step))
    if np.abs(far - 2.0 * near).max(initial=0.0) > JUMP:
        pieces = np.diff([value(time + reach * step) for reach in (-2.0, -1.0, 0.0, 1.0, 2.0)], axis=0) / step
        off = np.abs(pieces - np.median(pieces, axis=0)).reshape(len(pieces), -1).max(axis=1)
        jump = int(off.argmax())
        if off[jump] > ALONE * np.delete(off, jump).max():
            return pieces[jump + 1:].mean(axis=0) if jump < 2 else pieces[:jump].mean(axis=0)
    return (8.0 * near - far) / (12.0 * step)


def radar_rate(radar, time: float) -> np.ndarray:
    """Rate of `radar.world_from_radar` at `time` in s: [4, 4] per s, whose last column is the radar's velocity in m/s.

    Where its motion begins or ends there, the rate is that of the nearest time around which the motion has all differences.
    """
    step = step_within(radar.frame_duration)
    if radar.motion is not None:
        begin, end = radar.motion.span
        step = min(step, 0.25 * (end - begin))
        time = min(max(time, begin + 2.0 * step), end - 2.0 * step)
    return rate_of(radar.world_from_radar, time, step)
