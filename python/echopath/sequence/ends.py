"""Ways that begin or end while frames in time go on."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import _core
from ..arguments.names import first_names
from ..base.callers import warn_user
from ..scene.lifetimes import ALWAYS

SLOWEST = 0.1   # m/s, at an end of a way: what is slower has come to rest
STEP = 1e-3     # s, within which speeds at the ends are told


def warn_of_ends(scene: _core.Scene, radar: _core.Radar, begin: float, end: float) -> None:
    """Warns (RuntimeWarning) of what stands, before or behind its way, in some of the frames and moves in others without a stop.

    begin, end: s, of the first and the last frame
    """
    names = [name for name, motion, (first, last) in _ways(scene, radar)
             if _breaks_off(motion, max(begin, first), min(end, last))]
    if names:
        stand = "stands" if len(names) == 1 else "stand"
        warn_user(f"{first_names(names)} {stand} still in some of the frames, for want of a way that lasts from their first to "
                  "their last: a trajectory with goes_on goes straight on, and one with outside='absent' leaves out what is not "
                  "there")


def _ways(scene: _core.Scene, radar: _core.Radar) -> Iterator[tuple[str, _core.Motion, tuple[float, float]]]:
    """(name, motion, lifetime) of the radar, and of the nodes that move and that nothing above moves, as far as they take
    part."""
    if radar.motion is not None:
        yield "the radar", radar.motion, ALWAYS
    nodes = scene.nodes
    told: set[int] = set()
    for index in sorted({mesh.node for mesh in scene.meshes}):
        moved = -1
        while index >= 0:
            moved = index if nodes[index].motion is not None else moved
            index = nodes[index].parent
        if moved >= 0 and moved not in told:
            told.add(moved)
            yield f"'{nodes[moved].name}'", nodes[moved].motion, scene._lifetime(moved)


def _breaks_off(motion: _core.Motion, begin: float, end: float) -> bool:
    """Whether it is held for a part of the time from begin to end in s, at an end of its way at which it moves."""
    curve = motion.translation if isinstance(motion, _core.CurveMotion) and motion.period is None else None
    if curve is None or curve.interpolation != "hermite":  # as trajectories are; linear ways of doors in files end at some speed
        return False
    first, last = float(curve.times[0]) - motion.offset, float(curve.times[-1]) - motion.offset
    step = min(STEP, 0.5 * (last - first))
    if not step > 0.0:
        return False
    speeds = [float(np.linalg.norm(motion.at(time + step)[:3, 3] - motion.at(time)[:3, 3])) / step
              for time in (first, last - step)]
    return (begin < first and speeds[0] > SLOWEST) or (last < end and speeds[1] > SLOWEST)
