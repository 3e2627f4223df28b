"""What moves in the world, as a radar that moves itself sees it."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.numerics.rates import step_within
from ..base.radar.antennas import ahead_of, middle_of_antennas
from ..base.text.mesh_names import object_of
from ..spectra.moving import STATIC_SPEED
from ..truth.boxes import boxes_at

BESIDE = 0.5  # m, from the box of an object: an antenna that is as near stands in or on it,
AHEAD = 0.05  # m, but for one that begins farther before it, as a hand or a person does


class _Instant(NamedTuple):
    """Of a scene and its radar: the middle of the antennas [3] in m and how it moves, [3] in m/s, at a time, and a step in s."""

    antenna: NDArray[np.float64]
    velocity: NDArray[np.float64]
    time: float
    step: float


class _Mover(NamedTuple):
    """A mesh that moves: where its vertices are that do, and its row of `movers_at`.

    low, high: [3] m, corners of the box along the axes of the world
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    row: tuple


def own_speed(radar, time: float) -> float:
    """How fast the middle of a radar's antennas nears what stands straight ahead of them at a time in s, m/s; negative where they
    look back. Of antennas that look all around: how fast it moves in the world."""
    velocity, ahead = _instant(radar, time).velocity, ahead_of(radar, time)
    return float(velocity @ ahead if ahead.any() else np.linalg.norm(velocity))


def movers_at(scene, radar, time: float) -> NDArray[np.float64]:
    """Where the map of a radar has what moves in the world at a time in s, whether the radar moves or not.

    Returns, for each mesh that moves faster than STATIC_SPEED, nearest and farthest range in m and lowest and highest radial
    velocity in m/s as the radar sees it (receding positive, not folded), [N, 4]. The velocities are those of the mesh as a whole:
    wheels that roll have points that stand. The object that the radar stands in or on, such as the car that carries it, is left
    out.
    """
    now, found = _instant(radar, time), {}
    for mesh in scene.meshes:
        if scene.is_moving(mesh.id) and (mover := _mover(scene, mesh.id, now)) is not None:
            found.setdefault(object_of(mesh.name), []).append(mover)
    rows = [mover.row for name, parts in found.items() if not _carries(scene, radar, name, parts, now) for mover in parts]
    return np.array(rows, float).reshape(-1, 4)


def _instant(radar, time: float) -> _Instant:
    step = step_within(radar.frame_duration)
    before, antenna, after = (middle_of_antennas(radar, time + late) for late in (-step, 0.0, step))
    return _Instant(antenna, (after - before) / (2.0 * step), time, step)


def _mover(scene, mesh_id: int, now: _Instant) -> _Mover | None:
    """None for a mesh that stands. Large triangles may be nearer than their corners: the nearest point of the box counts."""
    before, after = (scene.world_vertices(mesh_id, now.time + late) for late in (-now.step, now.step))
    velocity = (after - before) / (2.0 * now.step)
    moves = np.linalg.norm(velocity, axis=1) > STATIC_SPEED
    if not moves.any():
        return None
    corners = 0.5 * (before + after)[moves]
    low, high = corners.min(axis=0), corners.max(axis=0)
    way = np.vstack([corners, np.clip(now.antenna, low, high)]) - now.antenna
    distance = np.linalg.norm(way, axis=1)
    rate = way @ (velocity[moves].mean(axis=0) - now.velocity) / np.maximum(distance, 1e-9)  # of an antenna on a corner: 0
    return _Mover(low, high, (distance.min(), distance.max(), rate.min(), rate.max()))


def _carries(scene, radar, name: str, parts: list[_Mover], now: _Instant) -> bool:
    """Whether the antennas are in or on an object of these parts, by its box along its own axes."""
    low, high = np.min([part.low for part in parts], axis=0), np.max([part.high for part in parts], axis=0)
    if np.any(now.antenna < low - BESIDE) or np.any(now.antenna > high + BESIDE):
        return False
    ahead = ahead_of(radar, now.time)
    if np.minimum(ahead * (low - now.antenna), ahead * (high - now.antenna)).sum() > AHEAD:
        return False
    box = boxes_at(scene, [[name]], now.time, radar.frame_duration)
    own = (now.antenna - box.centre[0]) @ box.rotation[0]
    return bool(np.all(np.abs(own) <= 0.5 * box.size[0] + BESIDE))
