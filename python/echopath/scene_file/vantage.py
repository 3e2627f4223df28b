"""Where a radar stands well in a scene that has none: before an object, or in a town or a room, in sight of what is there."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arguments.checks import refused
from ..scene.boxes import box_of
from ..scene.found_objects import Things
from ..scene.scene import Scene
from .room import sight_in_room
from .sight import SPACE, Sight, best_sight, eroded

TOWN = 30.0          # m, extent from which on the radar stands within the scene
HEIGHT = 1.5         # m above the ground
HEADROOM = 0.8       # m above the ground, up to which a surface is no obstacle
CELLS = 200          # along each side of the map of obstacles
DIRECTIONS = 144     # that are tried
CLEARANCE = 12.0     # m to the next obstacle that is enough
FARTHEST = 300.0     # m that the radar looks


class Vantage(NamedTuple):
    """position: m; yaw: degrees; reach: m, up to which there is something to see; is_within: not before an object."""

    position: list[float]
    yaw: float
    reach: float
    is_within: bool


def vantage(scene: Scene, things: Things | None = None) -> Vantage:
    """Where a radar stands well in a scene.

    Objects of less than 30 m are seen from behind, along +x; but what is closed to all sides at the height of a head, with things
    and a free place in it, is a room, and seen from within. In larger scenes it is the place with most things in sight; where
    there are none, that nearest to the middle where nothing higher than a kerb is near, and the direction of the longest open
    way.
    things: of `things_of`, None: there are none
    Raises ValueError for a scene without meshes.
    """
    if not scene.meshes:
        raise refused(ValueError, "scene", "a Scene with meshes to look at", scene)
    low, high = box_of(scene)
    middle, size = 0.5 * (low + high), float((high - low).max())
    if (high - low)[:2].max() < TOWN:
        step = float((high - low)[:2].max()) / CELLS
        if sight := sight_in_room(scene, low, high, step):
            place = [low[0] + step * (sight.row + 0.5), low[1] + step * (sight.column + 0.5), low[2] + HEIGHT]
            return Vantage(_rounded(place), float(np.degrees(sight.yaw)), 2.0 * float(np.linalg.norm(high - low)), True)
        distance = max(3.0, 2.0 * size)
        height = min(middle[2], low[2] + HEIGHT)
        return Vantage(_rounded([low[0] - distance, middle[1], height]), 0.0, 2.0 * distance + size, False)
    blocked, step, ground = _obstacles(scene, low, high)
    if blocked.all():
        return Vantage(_rounded([low[0] - 10.0, middle[1], low[2] + HEIGHT]), 0.0, min(size + 20.0, FARTHEST), False)
    if sight := _sight_of(scene, things or {}, blocked, step, low):
        row, column, yaw, reach = sight.row, sight.column, float(np.degrees(sight.yaw)), sight.reach
    else:
        row, column = _open_place(blocked, step)
        yaw, cells = _open_way(blocked, row, column)
        reach = cells * step
    place = [low[0] + step * (row + 0.5), low[1] + step * (column + 0.5), ground[row, column] + HEIGHT]
    return Vantage(_rounded(place), yaw, float(np.clip(1.5 * reach, 50.0, FARTHEST)), True)


def _sight_of(scene: Scene, things: Things, blocked, step: float, low) -> Sight | None:
    """The place from which most things are in sight, if one is."""
    if not things:
        return None
    space = int(np.ceil(SPACE / step))
    boxes = np.array([box_of(scene, 0.0, meshes) for meshes in things.values()])[..., :2]
    return best_sight(blocked, np.argwhere(_clearance(blocked, space) >= space), step, (boxes - low[:2]) / step)


def _rounded(place) -> list[float]:
    return [round(float(value), 3) for value in place]


def _obstacles(scene: Scene, low, high):
    """Cells [n, m] with something higher than HEADROOM above their ground, their size in m, and the ground's height."""
    step = float((high - low)[:2].max()) / CELLS
    shape = tuple(int((high - low)[axis] / step) + 1 for axis in (0, 1))
    bottom, top = np.full(shape, np.inf), np.full(shape, -np.inf)
    for mesh in scene.meshes:
        corners = scene.world_vertices(mesh.id, 0.0)[mesh.triangles]
        least, most = corners.min(axis=1), corners.max(axis=1)
        first = np.clip(((least - low)[:, :2] / step).astype(int), 0, np.array(shape) - 1)
        last = np.clip(((most - low)[:, :2] / step).astype(int), 0, np.array(shape) - 1) + 1
        for (i, j), (k, m), z0, z1 in zip(first, last, least[:, 2], most[:, 2]):
            bottom[i:k, j:m] = np.minimum(bottom[i:k, j:m], z0)
            top[i:k, j:m] = np.maximum(top[i:k, j:m], z1)
    return ~(top < bottom + HEADROOM), step, np.where(np.isfinite(bottom), bottom, low[2])


def _open_place(blocked, step: float) -> tuple[int, int]:
    """The cell that is CLEARANCE away from obstacles, or as far as can be, and then nearest to the middle."""
    clear = _clearance(blocked, max(1, int(CLEARANCE / step)))
    rows, columns = np.nonzero(clear == clear.max())
    middle = 0.5 * np.array(blocked.shape)
    best = int(((rows - middle[0]) ** 2 + (columns - middle[1]) ** 2).argmin())
    return int(rows[best]), int(columns[best])


def _clearance(blocked, most: int):
    """How many cells each is away from obstacles and from the border, [n, m] up to `most`."""
    clear, free = np.zeros(blocked.shape, int), ~blocked
    for _ in range(most):
        clear += free
        free = eroded(free)
    return clear


def _open_way(blocked, row: int, column: int) -> tuple[float, int]:
    """The direction in degrees of the longest way without obstacles that ends at one, and its length in cells; where no way
    does, that of the middle of all obstacles."""
    best = (0.0, 0)
    if blocked.any():
        away = np.argwhere(blocked).mean(axis=0) - [row, column]
        best = (float(np.degrees(np.arctan2(away[1], away[0]))), 0)
    for yaw in np.arange(DIRECTIONS) * 360.0 / DIRECTIONS - 180.0:
        ahead = np.array([np.cos(np.radians(yaw)), np.sin(np.radians(yaw))])
        for distance in range(1, 2 * CELLS):
            cell = np.floor(np.array([row, column]) + 0.5 + distance * ahead).astype(int)
            if (cell < 0).any() or (cell >= blocked.shape).any():
                break
            if blocked[tuple(cell)]:
                best = max(best, (float(yaw), distance), key=lambda one: one[1])
                break
    return best
