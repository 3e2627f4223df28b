"""What of a scene is there in a frame, and at a time."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.names import first_names
from ..base.process.callers import warn_user
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


def warn_of_absence(scene: _core.Scene, radar: _core.Radar, begin: float, end: float) -> bool:
    """Warns (RuntimeWarning) where visible objects have lifetimes and none of these lasts as long as a frame within a run, from
    begin to end in s. Returns whether it did."""
    lifetimes = _lifetimes(scene)
    if not lifetimes:
        return False
    shortest = radar.frame_duration * (1.0 - _ROUNDING)
    if any(min(end, last) - max(begin, first) >= shortest for first, last in lifetimes.values()):
        return False
    firsts, lasts = zip(*lifetimes.values())
    are = "is" if len(lifetimes) == 1 else "are"
    warn_user(f"{first_names(list(lifetimes))} {are} absent from {begin:g} to {end:g} s: what comes and goes in the scene is "
              f"there from {min(firsts):g} to {max(lasts):g} s alone")
    return True


def warn_of_the_unseen(scene: _core.Scene, radar: _core.Radar, starts: NDArray[np.float64]) -> None:
    """Warns (RuntimeWarning) of visible objects that come and go within a run and are in none of its frames.

    starts: [K] s, of the frames, in order
    """
    duration = radar.frame_duration
    slack = _ROUNDING * duration
    unseen = []
    for name, (first, last) in _lifetimes(scene).items():
        if starts[0] <= first < last <= starts[-1] + duration:
            later = starts[np.searchsorted(starts, first - slack):]
            if not len(later) or later[0] + duration > last + slack:
                unseen.append(name)
    if unseen:
        come, are, their = ("comes and goes", "is", "its") if len(unseen) == 1 else ("come and go", "are", "their")
        warn_user(f"{first_names(unseen)} {come} between the starts of frames and {are} in none of them: {their} lifetime must "
                  f"cover a whole frame of {duration:.3g} s")


def _lifetimes(scene: _core.Scene) -> dict[str, tuple[float, float]]:
    """{"'name'": (begin, end) in s} of the visible nodes that have a lifetime of their own, as far as what is above them is
    there, too."""
    if not scene._has_lifetimes:
        return {}
    return {f"'{node.name}'": scene._lifetime(index) for index, node in enumerate(scene.nodes)
            if node.lifetime is not None and scene._takes_part(index)}
