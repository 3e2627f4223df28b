"""From which place of a town most of its things are in sight."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

SPACE = 3.0           # m from the next obstacle that a radar needs
MOST_PLACES = 400     # that are tried, spread evenly over those that are free
AROUND = 30.0         # m about the things, in which places are looked for
NEAR, HALF = 3.0, 20.0  # m: nearer things are too near; at this distance one counts half
POINTS = 128          # of a line of sight
DIRECTIONS = 72       # that are tried
SECTOR = np.radians(50.0)  # to either side of the radar's axis


def eroded(free):
    """Which cells [n, m] are free with all four neighbours; beyond the border nothing is."""
    grown = np.pad(free, 1, constant_values=False)
    return free & grown[:-2, 1:-1] & grown[2:, 1:-1] & grown[1:-1, :-2] & grown[1:-1, 2:]


class Sight(NamedTuple):
    """row, column: of the cell where the radar stands; yaw: rad; reach: m to the farthest of the things that it looks at."""

    row: int
    column: int
    yaw: float
    reach: float


def best_sight(blocked, free_cells, step: float, boxes, near: float = NEAR) -> Sight | None:
    """Where most things are in sight ahead of a radar, near ones counting most; None where none is.

    blocked: [n, m], whether a cell has an obstacle; free_cells: [F, 2] cells with room for a radar; step: m, of a cell
    boxes: [N, 2, 2] (lowest, highest) cells of the things, fractions of cells count; near: m, nearer things do not count
    """
    middles = boxes.mean(axis=1)
    margin = AROUND / step
    is_about = np.all((free_cells >= middles.min(axis=0) - margin) & (free_cells <= middles.max(axis=0) + margin), axis=1)
    places = free_cells[is_about]
    places = places[::max(1, -(-len(places) // MOST_PLACES))]
    if not len(places):
        return None
    ways = middles - (places[:, None] + 0.5)  # [places, things, 2]
    distance = step * np.linalg.norm(ways, axis=2)
    weight = np.where(_is_seen(blocked, places, boxes) & (distance > near), 1.0 / (1.0 + distance / HALF), 0.0)
    yaws = np.arange(DIRECTIONS) * 2.0 * np.pi / DIRECTIONS - np.pi
    off_axis = np.angle(np.exp(1j * (np.arctan2(ways[..., 1], ways[..., 0])[..., None] - yaws)))  # [places, things, yaws]
    ahead = np.abs(off_axis) <= SECTOR
    score = np.einsum("pt,pty->py", weight, np.cos(off_axis) * ahead)
    place, yaw = np.unravel_index(int(score.argmax()), score.shape)
    if score[place, yaw] <= 0.0:
        return None
    looked_at = ahead[place, :, yaw] & (weight[place] > 0.0)
    return Sight(int(places[place, 0]), int(places[place, 1]), float(yaws[yaw]), float(distance[place, looked_at].max()))


def _is_seen(blocked, places, boxes):
    """Whether nothing but the thing itself stands on the line from each place [P] to the middle of each thing [N]: [P, N]."""
    seen = np.empty((len(places), len(boxes)), bool)
    along, middles = np.linspace(0.0, 1.0, POINTS)[:, None, None], boxes.mean(axis=1)
    for row, place in enumerate(places + 0.5):
        points = place + along * (middles - place)  # [points, things, 2]
        own = np.all((points >= boxes[:, 0] - 1.0) & (points <= boxes[:, 1] + 1.0), axis=2)
        cells = np.clip(points.astype(int), 0, np.array(blocked.shape) - 1)
        seen[row] = ~np.any(blocked[cells[..., 0], cells[..., 1]] & ~own, axis=0)
    return seen
