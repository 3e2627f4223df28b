"""Motions of radars that a call needs at certain times."""
from __future__ import annotations

from collections.abc import Iterable

from .. import _core


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
