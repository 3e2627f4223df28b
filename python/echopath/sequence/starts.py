"""When the frames of a sequence begin."""
from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import array, real, refused
from ..arguments.frame_times import has_room, require_room

LONGEST = 1_000_000  # frames that files may speak of: one look at each is taken in seconds
FROM_ZERO = 0.0      # s, the start of the first frame where nobody says another


class Starts(NamedTuple):
    """Starts of frames by their numbers: an interval apart, or where somebody gave each of them.

    first: s, of frame 0; interval: s, from frame to frame, None where each is given; given: s, of each frame, None where they
    are an interval apart
    """

    first: float
    interval: float | None
    given: tuple[float, ...] | None

    def of(self, number: int) -> float:
        """Start of a frame in s."""
        return self.first + number * self.interval if self.given is None else self.given[number]

    def of_all(self, numbers: range) -> NDArray[np.float64]:
        """[K] in s."""
        return np.array([self.of(number) for number in numbers], np.float64)

    def require(self, numbers: range) -> None:
        """Raises ValueError where frames of some numbers have no start."""
        if self.given is not None and len(numbers) and not 0 <= min(numbers[0], numbers[-1]) <= max(numbers) < len(self.given):
            raise ValueError(f"{len(self.given)} times for frames {numbers[0]} to {numbers[-1]}")


def starts_and_count(frames: int | None, interval: float | None, times: NDArray[np.float64] | None, start_time: float,
                     radar: _core.Radar) -> tuple[Starts, int]:
    """The starts of frames as `Sequence` takes them, and how many there are.

    Raises TypeError or ValueError naming the argument where they are given twice or not at all, or frames of the radar overlap.
    """
    if times is not None:
        _require_alone(frames=(frames, None), interval=(interval, None), start_time=(start_time, FROM_ZERO))
        _require_apart(times, radar)
        return Starts(float(times[0]), None, tuple(times.tolist())), len(times)
    for name, value, rule in (("frames", frames, "how many there are, with `interval`, or None with `times`"),
                              ("interval", interval, "in s from start to start, with `frames`, or None with `times`")):
        if value is None:
            raise refused(TypeError, name, rule, value)
    require_room("interval", radar, interval)
    starts = Starts(start_time, interval, None)
    if not math.isfinite(starts.of(frames - 1) + radar.frame_duration):
        raise refused(ValueError, "interval", f"a number of s that gives {frames} frames finite times", interval)
    return starts, frames


def starts_in(settings: dict[str, Any]) -> Starts:
    """The starts that the settings of a file tell. Raises KeyError, TypeError or ValueError for settings that are none."""
    first, times = real()("start_time", settings["start_time"]), settings.get("times")
    if times is None:
        return Starts(first, real()("interval", settings["interval"]), None)
    return Starts(first, None, tuple(array("[K]", finite=True)("times", times).tolist()))


def _require_alone(**others) -> None:
    """others: {name: (value, what it is where nobody gave it)} of arguments that `times` takes the place of."""
    for name, (value, untold) in others.items():
        if value != untold:
            raise refused(ValueError, name, f"{untold} with `times`, which tell the start of each frame", value)


def _require_apart(times: NDArray[np.float64], radar: _core.Radar) -> None:
    if not 1 <= len(times) <= LONGEST:
        raise ValueError(f"times: must be those of 1 to {LONGEST} frames, got {len(times)}")
    steps = np.diff(times)
    if len(steps) and not has_room(radar, float(steps.min())):
        at = int(np.argmin(steps))
        raise ValueError(f"times: must be at least {radar.frame_duration:.9g} s apart, the duration of a frame, and in order, "
                         f"got times[{at}] = {times[at]:.9g} s and times[{at + 1}] = {times[at + 1]:.9g} s")


def pace_words(times: NDArray[np.float64], interval: float | None) -> str:
    """How frames that start at some times in s follow each other, in words."""
    if interval is not None:
        return f"every {interval:.6g} s"
    steps = np.abs(np.diff(times))
    if not len(steps):
        return "alone"
    least, most = (f"{step:.6g}" for step in (steps.min(), steps.max()))
    return f"{least} s apart" if least == most else f"{least} to {most} s apart"
