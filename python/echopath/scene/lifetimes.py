"""What of a scene is there in a frame, and at a time."""
from __future__ import annotations

import math
from collections.abc import Sequence

from .. import _core
from ..arguments.names import first_names
from ..base.callers import warn_user
from .scene import Scene

ALWAYS = -math.inf, math.inf  # s, the lifetime of what has none
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


def lifetime_in_tree(nodes: Sequence[_core.Node], index: int) -> tuple[float, float]:
    """When a node and all above it are there, (begin, end) in s."""
    begin, end = ALWAYS
    while index >= 0:
        first, last = nodes[index].lifetime or ALWAYS
        begin, end, index = max(begin, first), min(end, last), nodes[index].parent
    return begin, end


def warn_of_absence(scene: _core.Scene, radar: _core.Radar, begin: float, end: float) -> None:
    """Warns (RuntimeWarning) where visible objects have lifetimes and none of these lasts as long as a frame within a run, from
    begin to end in s."""
    if not scene._has_lifetimes:
        return
    nodes = scene.nodes
    lifetimes = {f"'{node.name}'": lifetime_in_tree(nodes, index) for index, node in enumerate(nodes)
                 if node.lifetime is not None and scene._takes_part(index)}
    if not lifetimes:
        return
    shortest = radar.frame_duration * (1.0 - _ROUNDING)
    if any(min(end, last) - max(begin, first) >= shortest for first, last in lifetimes.values()):
        return
    firsts, lasts = zip(*lifetimes.values())
    are = "is" if len(lifetimes) == 1 else "are"
    warn_user(f"{first_names(list(lifetimes))} {are} absent from {begin:g} to {end:g} s: what comes and goes in the scene is "
              f"there from {min(firsts):g} to {max(lasts):g} s alone")
