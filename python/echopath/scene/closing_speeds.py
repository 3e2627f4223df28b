"""How fast the surfaces of a scene come nearer to a radar or go away from it."""
from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.numerics.golden import golden_place
from ..base.numerics.rates import step_within
from ..base.radar.antennas import middle_of_antennas
from ..base.text.mesh_names import object_of

NUM_TIMES = 8  # within a frame, at which what turns is looked at beside its ends: no fractions of it, which turns might repeat

NEAR = 0.5     # of a limit: what is slower in the middle and at the ends of a frame does not pass it between

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
    moving = [mesh for mesh in scene.meshes if radar.is_moving or scene.is_moving(mesh.id)]
    return _speeds_of(moving, scene, radar, time)


def speeds_of_objects(scene, radar, time: float) -> Speeds:
    """{object: `closing_speeds` of its first mesh, which speaks for its body} of those of which that moves."""
    first = {}
    for mesh in scene.meshes:
        first.setdefault(object_of(mesh.name), mesh)
    moving = {name: mesh for name, mesh in first.items() if radar.is_moving or scene.is_moving(mesh.id)}
    speeds = _speeds_of(moving.values(), scene, radar, time)
    return {name: speeds[mesh.name] for name, mesh in moving.items()}


def _speeds_of(meshes, scene, radar, time: float) -> Speeds:
    """`closing_speeds` of some meshes."""
    step = step_within(radar.frame_duration)
    found = {}
    for mesh, before, after in _ways(meshes, scene, radar, time, step):
        found[mesh.name] = (np.linalg.norm(after, axis=1) - np.linalg.norm(before, axis=1)) / (2.0 * step)
    return found


def _ways(meshes, scene, radar, time: float, step: float) -> Iterator[tuple]:
    """(mesh, its vertices [V, 3] in m from the antennas, a step in s before a time and after it) of some meshes."""
    instants = time - step, time + step
    antennas = [middle_of_antennas(radar, instant) for instant in instants]
    for mesh in meshes:
        yield mesh, *(scene.world_vertices(mesh.id, instant) - antenna for instant, antenna in zip(instants, antennas))


def bodies_faster_than(limit: float, scene, radar, time: float) -> list[FastBody]:
    """What comes or goes faster than `limit` in m/s in a frame whose middle is at `time` in s, fastest first: objects where
    most of them does in the middle, else their parts, such as the wheels of a car whose body is slower, at their fastest."""
    speeds = closing_speeds(scene, radar, time)
    names = [mesh.name for mesh in scene.meshes]
    fastest = _fastest(limit, speeds, scene, radar, time)
    return sorted(_faster(limit, speeds, fastest, names, depth=1), key=lambda body: -abs(body.speed))


def _fastest(limit: float, speeds: Speeds, scene, radar, time: float) -> dict[str, float]:
    """{mesh: m/s of its fastest point} in the frame: a blade that points at the radar in its middle comes and goes at other
    times. Of meshes that are far slower than `limit` in m/s it is that in the middle."""
    fastest = {name: float(of_mesh[np.abs(of_mesh).argmax()]) for name, of_mesh in speeds.items()}
    extent = max(radar.frame_duration - 2.0 * step_within(radar.frame_duration), 0.0)
    moving = [mesh for mesh in scene.meshes if scene.is_moving(mesh.id)]
    near = [mesh for mesh in moving if _may_pass(NEAR * limit, mesh, scene, radar, time, extent)]
    for place in (-0.5, *(golden_place(number) - 0.5 for number in range(1, NUM_TIMES + 1)), 0.5):
        for name, of_mesh in _speeds_of(near, scene, radar, time + place * extent).items():
            fastest[name] = max(fastest[name], float(of_mesh.max()), float(of_mesh.min()), key=abs)
    return fastest


def _may_pass(limit: float, mesh, scene, radar, time: float, extent: float) -> bool:
    """Whether some point of a mesh goes faster than `limit` in m/s, whichever way, in the middle of a frame or at an end.

    time: s, of the middle; extent: s, from end to end
    """
    step = step_within(radar.frame_duration)
    return any(np.linalg.norm(after - before, axis=1).max() > 2.0 * step * limit
               for instant in (time, time - 0.5 * extent, time + 0.5 * extent)
               for _, before, after in _ways([mesh], scene, radar, instant, step))


def _faster(limit: float, speeds: Speeds, fastest: dict[str, float], names: list[str], depth: int) -> Iterator[FastBody]:
    """Of meshes, by the nodes of a depth above them; a node all of whose parts have fast points is one line."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault("/".join(name.split("/")[:depth]), []).append(name)
    for node, inside in groups.items():
        moving = [speeds[name] for name in inside if name in speeds]
        fast = [name for name in inside if name in fastest and abs(fastest[name]) > limit]
        if not fast:
            continue
        middle = float(np.median(np.concatenate(moving)))
        if abs(middle) > limit and len(moving) == len(inside):
            yield FastBody(node, middle, as_whole=True)
        elif len(fast) == len(inside):
            yield FastBody(node, max((fastest[name] for name in fast), key=abs), as_whole=False)
        else:
            yield from _faster(limit, speeds, fastest, inside, depth + 1)
