"""What a call needs of the times of frames: motions of radars that cover them, room for each, and when objects are there."""
from __future__ import annotations

from collections.abc import Iterable

from .. import _core
from .checks import array, refused

_ROUNDING = 1e-9  # relative, of an interval that is the duration of a frame by another sum


def lifetime_rule(argument: str, value) -> tuple[float, float]:
    """When something is there: (begin, end) in s, either of which may be infinite."""
    begin, end = (float(time) for time in array("[2]")(argument, value))
    if not begin < end:
        raise refused(ValueError, argument, "a begin and an end in s, ascending", value)
    return begin, end


def require_motion(argument: str, radar: _core.Radar, times: Iterable[float]) -> None:
    """Raises ValueError naming the argument where the motion of a radar does not cover all of some times in s."""
    try:
        for time in times:
            radar.world_from_radar(time)
    except ValueError as error:
        raise ValueError(f"{argument}: must have a motion that covers all frames: {error}") from None


def require_frame(argument: str, radar: _core.Radar, start_time: float) -> None:
    """Likewise for its frame that begins at start_time in s."""
    require_motion(argument, radar, (start_time, start_time + radar.frame_duration))


def has_room(radar: _core.Radar, interval: float) -> bool:
    """Whether frames of a radar may begin `interval` s after each other."""
    return interval >= radar.frame_duration * (1.0 - _ROUNDING)


def require_room(argument: str, radar: _core.Radar, interval: float) -> None:
    """Raises ValueError naming the argument where frames of a radar, one begun each `interval` in s, overlap."""
    if not has_room(radar, interval):
        raise refused(ValueError, argument, f"at least {radar.frame_duration:.9g} s, the duration of a frame", interval)
