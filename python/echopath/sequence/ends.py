"""Ways that begin or end while frames in time go on, and what moves in itself for a part of them."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import _core
from ..arguments.names import first_names
from ..base.process.callers import warn_user
from ..scene.interferers import interferers_of
from ..scene.node import ALWAYS

SLOWEST = 0.1   # m/s, at an end of a way: what is slower has come to rest
SLOWEST_TURN = 0.2  # rad/s, likewise
STEP = 1e-3     # s, within which speeds at the ends are told


def warn_of_ends(scene: _core.Scene, radar: _core.Radar, begin: float, end: float) -> None:
    """Warns (RuntimeWarning) of what stands, before or behind its way, in some of the frames and moves in others without a stop;
    and of objects on their way whose wheels, trailers or limbs do so. Radars are told, too, and those of interferers.

    begin, end: s, of the first and the last frame
    """
    tops, nodes = _tops_of(scene), scene.nodes
    ways = [] if radar.motion is None else [("the radar", radar.motion, ALWAYS)]
    ways += [(f"interferers[{index}]", one.radar.motion, one.lifetime or ALWAYS)
             for index, one in enumerate(interferers_of(scene)) if one.radar.motion is not None]
    ways += [(f"'{nodes[top].name}'", nodes[top].motion, scene._lifetime(top)) for top in dict.fromkeys(tops.values())]
    names = [name for name, motion, alive in ways
             if _ends_early(_curves_of(motion, "translation"), motion, _within(alive, begin, end))]
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
    for top, motion in _inner_motions(scene, tops):
        if top in told:
            continue
        span = _within(scene._lifetime(top), begin, end)
        if _ends_early(_curves_of(motion, "translation", "rotation"), motion, span):
            told.add(top)
            yield f"'{nodes[top].name}'"


def _inner_motions(scene: _core.Scene, tops: dict[int, int]) -> Iterator[tuple[int, _core.Motion | None]]:
    """(topmost node that moves, motion of a node below it or of a joint of its skins) of all meshes."""
    nodes = scene.nodes
    yield from ((top, nodes[index].motion) for index, top in tops.items() if index != top)
    for mesh in scene.meshes:
        top = _top_of(mesh.node, nodes, tops)
        skin = nodes[mesh.node].deformation
        if top is not None and isinstance(skin, _core.Skin):
            yield from ((top, joint.motion) for joint in skin.joints)


def _top_of(index: int, nodes: list[_core.Node], tops: dict[int, int]) -> int | None:
    """The topmost node that moves at or above one; None: nothing there moves."""
    while index >= 0 and index not in tops:
        index = nodes[index].parent
    return tops[index] if index >= 0 else None


def _within(lifetime: tuple[float, float], begin: float, end: float) -> tuple[float, float]:
    return max(begin, lifetime[0]), min(end, lifetime[1])


def _curves_of(motion: _core.Motion | None, *kinds: str) -> list[_core.Curve]:
    """Those of what may follow a trajectory: Hermite curves, of no loop. Linear ways, as of doors in files, end anyhow."""
    if not isinstance(motion, _core.CurveMotion) or motion.period is not None:
        return []
    curves = [getattr(motion, kind) for kind in kinds]
    return [curve for curve in curves if curve is not None and curve.interpolation == "hermite"]


def _ends_early(curves: list[_core.Curve], motion: _core.Motion, span: tuple[float, float]) -> bool:
    """Whether a motion is held for a part of a span in s, at an end of one of these curves of it at which it moves."""
    for curve in curves:
        first, last = float(curve.times[0]) - motion.offset, float(curve.times[-1]) - motion.offset
        step = min(STEP, 0.5 * (last - first))
        if step > 0.0 and ((span[0] < first and _moves(motion, first, step))
                           or (last < span[1] and _moves(motion, last - step, step))):
            return True
    return False


def _moves(motion: _core.Motion, time: float, step: float) -> bool:
    """Whether it is on its way, or turns, from a time in s on for a step."""
    change = (motion.at(time + step) - motion.at(time)) / step
    return float(np.linalg.norm(change[:3, 3])) > SLOWEST or float(np.linalg.norm(change[:3, :3])) > np.sqrt(2.0) * SLOWEST_TURN
