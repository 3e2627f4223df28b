"""What of a scene is there in a frame, and at a time."""
from __future__ import annotations

from .. import _core
from ..arguments.names import first_names
from ..base.callers import warn_user
from .scene import Scene

_ROUNDING = 1e-9  # relative, of a lifetime that is the duration of a frame by another sum


def scene_in_frame(scene: _core.Scene, radar: _core.Radar, start_time: float) -> _core.Scene:
    """The scene of a frame that starts at a time in s: a copy in which objects are not visible whose lifetimes do not cover the
    frame wholly; the scene itself where none has a lifetime."""
    return _scene_within(scene, start_time, start_time + radar.frame_duration)


def scene_at(scene: _core.Scene, time: float) -> _core.Scene:
    """Likewise the scene at a time in s, without objects whose lifetimes do not hold it."""
    return _scene_within(scene, time, time)


def _scene_within(scene, begin: float, end: float):
    if not scene._has_lifetimes:
        return scene
    there = Scene(scene)
    there._hide_absent(begin, end)
    return there


def warn_of_absence(scene: _core.Scene, radar: _core.Radar, begin: float, end: float) -> None:
    """Warns (RuntimeWarning) where objects have lifetimes and none of these covers a frame of a run, from begin to end in s."""
    if not scene._has_lifetimes:
        return
    lifetimes = {f"'{node.name}'": node.lifetime for node in scene.nodes if node.lifetime is not None}
    shortest = radar.frame_duration * (1.0 - _ROUNDING)
    if any(min(end, last) - max(begin, first) >= shortest for first, last in lifetimes.values()):
        return
    firsts, lasts = zip(*lifetimes.values())
    are = "is" if len(lifetimes) == 1 else "are"
    warn_user(f"{first_names(list(lifetimes))} {are} absent from {begin:g} to {end:g} s: what comes and goes in the scene is "
              f"there from {min(firsts):g} to {max(lasts):g} s alone")
