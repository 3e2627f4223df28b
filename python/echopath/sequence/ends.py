"""Ways that begin or end while frames in time go on, and what moves in itself for a part of them."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import _core
from ..arguments.names import first_names
from ..base.callers import warn_user
from ..scene.lifetimes import ALWAYS

SLOWEST = 0.1   # m/s, at an end of a way: what is slower has come to rest
SLOWEST_TURN = 0.2  # rad/s, likewise
STEP = 1e-3     # s, within which speeds at the ends are told


def warn_of_ends(scene: _core.Scene, radar: _core.Radar, begin: float, end: float) -> None:
    """Warns (RuntimeWarning) of what stands, before or behind its way, in some of the frames and moves in others without a stop;
    and of objects on their way whose wheels, trailers or limbs do so.

    begin, end: s, of the first and the last frame
    """
    tops, nodes = _tops_of(scene), scene.nodes
    ways = [] if radar.motion is None else [("the radar", radar.motion, ALWAYS)]
    ways += [(f"'{nodes[top].name}'", nodes[top].motion, scene._lifetime(top)) for top in dict.fromkeys(tops.values())]
    names = [name for name, motion, alive in ways if _ends_early(_translation_of(motion), motion, _within(alive, begin, end))]
    if names:
        stand = "stands" if len(names) == 1 else "stand"
        warn_user(f"{first_names(names)} {stand} still in some of the frames, for want of a way that lasts from their first to "
                  "their last: a trajectory with goes_on goes straight on, and one with outside='absent' leaves out what is not "
                  "there")
    held = [name for name in _held_in_themselves(scene, tops, begin, end) if name not in names]
    if held:
        warn_user(f"{first_names(held)}: what moves in it, such as wheels and limbs, stands still in some of the frames, in "
                  "which `during` of traffic, Trajectory.detailed, or an animation that is no loop, has not begun or has ended")


def _tops_of(scene: _core.Scene) -> dict[int, int]:
    """{node that moves: the topmost node above it that does, itself where nothing above moves}, of all meshes."""
    nodes = scene.nodes
    found: dict[int, int] = {}
    for mesh in scene.meshes:
        moved, index = [], mesh.node
        while index >= 0:
            if nodes[index].motion is not None:
                moved.append(index)
            index = nodes[index].parent
        found |= dict.fromkeys(moved, moved[-1]) if moved else {}
    return found


def _held_in_themselves(scene: _core.Scene, tops: dict[int, int], begin: float, end: float) -> Iterator[str]:
    """Names of what moves of which a part, or a joint, does so for a time alone; each once."""
    nodes = scene.nodes
    told: set[int] = set()
    for index, top in tops.items():
        if top in told or index == top:
            continue
        span = _within(scene._lifetime(top), begin, end)
        motion = nodes[index].motion
        if any(_ends_early(curve, motion, span) for curve in (_translation_of(motion), _rotation_of(motion))):
            told.add(top)
            yield f"'{nodes[top].name}'"


def _within(lifetime: tuple[float, float], begin: float, end: float) -> tuple[float, float]:
    return max(begin, lifetime[0]), min(end, lifetime[1])


def _translation_of(motion: _core.Motion | None) -> _core.Curve | None:
    """That of what follows a trajectory: of a Hermite curve that is no loop. Linear ways, as of doors in files, end anyhow."""
    return _followed(motion.translation) if isinstance(motion, _core.CurveMotion) and motion.period is None else None


def _rotation_of(motion: _core.Motion | None) -> _core.Curve | None:
    return _followed(motion.rotation) if isinstance(motion, _core.CurveMotion) and motion.period is None else None


def _followed(curve: _core.Curve | None) -> _core.Curve | None:
    return curve if curve is not None and curve.interpolation == "hermite" else None


def _ends_early(curve: _core.Curve | None, motion: _core.Motion, span: tuple[float, float]) -> bool:
    """Whether a motion is held for a part of a span in s, at an end of one of its curves at which it moves."""
    if curve is None:
        return False
    first, last = float(curve.times[0]) - motion.offset, float(curve.times[-1]) - motion.offset
    step = min(STEP, 0.5 * (last - first))
    if not step > 0.0:
        return False
    return (span[0] < first and _moves(motion, first, step)) or (last < span[1] and _moves(motion, last - step, step))


def _moves(motion: _core.Motion, time: float, step: float) -> bool:
    """Whether it is on its way, or turns, from a time in s on for a step."""
    change = (motion.at(time + step) - motion.at(time)) / step
    return float(np.linalg.norm(change[:3, 3])) > SLOWEST or float(np.linalg.norm(change[:3, :3])) > np.sqrt(2.0) * SLOWEST_TURN
