"""Whether a small scene is a room with things in it, and where a radar stands in that."""
from __future__ import annotations

import numpy as np

from ..scene.boxes import box_of
from ..scene.scene import Scene
from .sight import Sight, best_sight, eroded

BAND = 1.2, 1.6    # m above the lowest point: what is there on all sides is a wall, tables and seats are below
CLEAR = 1.35       # m to all sides of a place that a room has, and the inside of a vehicle, of 2.6 m at most, has not
SPACE = 0.4        # m from the next obstacle that a radar needs
NEAR = 1.0         # m: nearer things are too near
PART = 0.6         # of the room along both axes: what is smaller along one of them stands in it


def sight_in_room(scene: Scene, low, high, step: float) -> Sight | None:
    """The place in a room from which most of what stands in it is in sight; None for what is no room, or an empty one.

    low, high: [3] m, box of the scene; step: m, of the cells in which the place is told
    """
    blocked = _in_band(scene, low, high, step)
    inside = _enclosed(blocked)
    if not inside.any() or not _shrunk(inside & ~blocked, CLEAR / step).any():
        return None
    boxes = _contents(scene, low, step, inside)
    if not len(boxes):
        return None
    return best_sight(blocked, np.argwhere(_shrunk(inside & ~blocked, SPACE / step)), step, boxes, near=NEAR)


def _in_band(scene: Scene, low, high, step: float):
    """Cells [n, m] in which there is a surface within the band; of a triangle all within the box about it."""
    shape = (np.ceil((high - low)[:2] / step) + 1).astype(int)
    steps = np.zeros(shape + 1, int)  # of how many triangles are over a cell, along both axes
    for mesh in scene.meshes:
        corners = scene.world_vertices(mesh.id, 0.0)[mesh.triangles] - low
        least, most = corners.min(axis=1), corners.max(axis=1)
        of_band = (least[:, 2] < BAND[1]) & (most[:, 2] > BAND[0])
        i, j = np.clip((least[of_band, :2] / step).astype(int), 0, shape - 1).T
        k, m = np.clip((most[of_band, :2] / step).astype(int), 0, shape - 1).T + 1
        for rows, columns, sign in ((i, j, 1), (k, m, 1), (i, m, -1), (k, j, -1)):
            np.add.at(steps, (rows, columns), sign)
    return steps.cumsum(axis=0).cumsum(axis=1)[:-1, :-1] > 0


def _enclosed(blocked):
    """Which cells, obstacles included, cannot be reached from beyond the border."""
    free = np.pad(~blocked, 1, constant_values=True)
    reached = np.zeros_like(free)
    reached[[0, -1]] = reached[:, [0, -1]] = True
    while True:
        grown = reached.copy()
        for ahead, behind in ((np.s_[1:], np.s_[:-1]), (np.s_[:-1], np.s_[1:])):
            grown[ahead] |= reached[behind]
            grown[:, ahead] |= reached[:, behind]
        grown &= free
        if (grown == reached).all():
            return ~reached[1:-1, 1:-1]
        reached = grown


def _shrunk(free, cells: float):
    """Cells from which so many steps from cell to cell lead to free ones alone."""
    for _ in range(int(np.ceil(cells))):
        free = eroded(free)
    return free


def _contents(scene: Scene, low, step: float, inside):
    """[N, 2, 2] (lowest, highest) cells of the meshes that stand within, no walls, floors and ceilings."""
    rows, columns = np.nonzero(inside)
    least = np.array([rows.min(), columns.min()])
    extent = np.array([rows.max(), columns.max()]) + 1 - least
    boxes = np.array([box_of(scene, 0.0, [mesh.id]) for mesh in scene.meshes])[..., :2]
    boxes = (boxes - low[:2]) / step
    is_within = ((boxes[:, 0] >= least) & (boxes[:, 1] <= least + extent)).all(axis=1)
    is_part = (boxes[:, 1] - boxes[:, 0] < PART * extent).all(axis=1)
    return boxes[is_within & is_part]
