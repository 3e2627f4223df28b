"""How fast the surfaces of a scene come nearer to a radar or go away from it."""
from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.antennas import middle_of_antennas
from ..base.rates import step_within

Speeds = dict[str, NDArray[np.float64]]


class FastBody(NamedTuple):
    """An object, or a part of one, that comes or goes faster than a limit.

    name: in the scene; speed: m/s, receding positive: that of most of it, or of its fastest point; as_whole: of most of it
    """

    name: str
    speed: float
    as_whole: bool


def closing_speeds(scene, radar, time: float) -> Speeds:
    """{mesh: how fast the distance of each vertex changes, [V] m/s, receding positive} of those that move towards the radar or
    from it.

    time: s, of the scene; the distance is that from the middle of the antennas. Differences of second order meet the
        speed of a wheel of 0.3 m and 50 turns/s to 0.01 m/s.
    """
    step = step_within(radar.frame_duration)
    antennas = [middle_of_antennas(radar, instant) for instant in (time - step, time + step)]
    found = {}
    for mesh in scene.meshes:
        if radar.motion is None and not scene.is_moving(mesh.id):
            continue
        before, after = (np.linalg.norm(scene.world_vertices(mesh.id, instant) - antenna, axis=1)
                         for instant, antenna in zip((time - step, time + step), antennas))
        found[mesh.name] = (after - before) / (2.0 * step)
    return found


def bodies_faster_than(limit: float, scene, radar, time: float) -> list[FastBody]:
    """What comes or goes faster than `limit` in m/s at a time in s, fastest first: objects where most of them does, else their
    parts, such as the wheels of a car whose body is slower."""
    speeds = closing_speeds(scene, radar, time)
    names = [mesh.name for mesh in scene.meshes]
    return sorted(_faster(limit, speeds, names, depth=1), key=lambda body: -abs(body.speed))


def _faster(limit: float, speeds: Speeds, names: list[str], depth: int) -> Iterator[FastBody]:
    """Of meshes, by the nodes of a depth above them; a node all of whose parts have fast points is one line."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault("/".join(name.split("/")[:depth]), []).append(name)
    for node, inside in groups.items():
        moving = [speeds[name] for name in inside if name in speeds]
        fast = [name for name in inside if name in speeds and np.abs(speeds[name]).max() > limit]
        if not fast:
            continue
        middle = float(np.median(np.concatenate(moving)))
        if abs(middle) > limit and len(moving) == len(inside):
            yield FastBody(node, middle, as_whole=True)
        elif len(fast) == len(inside):
            every = np.concatenate(moving)
            yield FastBody(node, float(every[np.abs(every).argmax()]), as_whole=False)
        else:
            yield from _faster(limit, speeds, inside, depth + 1)
