"""What a tracker takes in: points in the plane with their covariances."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arguments.checks import array, refused
from ..arguments.iterables import iterable
from ..detections import Detections

_POINTS = array("[D, 2]", "[D, 3]", finite=True)


class Points(NamedTuple):
    """points: [M, 2] m; covariances: [M, 2, 2] m^2"""

    points: np.ndarray
    covariances: np.ndarray


def points_of(detections, world_from_radar, range_std: float, azimuth_std: float, merge_distance: float) -> Points:
    """Points of one frame, those nearer than `merge_distance` in m to each other made one.

    detections: Detections, or points [D, 2] or [D, 3] in m in the radar's frame; world_from_radar: [4, 4] or None, to leave
        them there
    range_std: m, azimuth_std: rad, of each
    """
    own, weights, centre = _own_points(detections)
    own, weights = _merged(own, weights, merge_distance)
    sight = own - centre
    distance = np.linalg.norm(sight, axis=1)
    along = sight[:, :2] / np.maximum(np.linalg.norm(sight[:, :2], axis=1), 1e-12)[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    covariances = range_std**2 * _outer(along) + (distance * azimuth_std)[:, None, None] ** 2 * _outer(across)
    if world_from_radar is None:
        return Points(own[:, :2], covariances)
    turn = world_from_radar[:3, :3]
    return Points((own @ turn.T + world_from_radar[:3, 3])[:, :2], turn[:2, :2] @ covariances @ turn[:2, :2].T)


def _own_points(detections) -> tuple:
    """Points [D, 3], weights [D] and the place [3] that they are counted from, in the radar's frame."""
    if isinstance(detections, Detections):
        points, weights = detections.points, detections.power
        is_known = np.isfinite(points).all(axis=1)
        if len(points) and not is_known.any():
            raise ValueError("detections: must have azimuths, which the radar's antennas cannot tell")
        return points[is_known], weights[is_known], detections.centre
    if isinstance(detections, np.ndarray) and detections.dtype.kind in "fiu" and detections.size == 0:
        return np.zeros((0, 3)), np.zeros(0), np.zeros(3)
    if isinstance(detections, (list, tuple)) and not len(detections):
        return np.zeros((0, 3)), np.zeros(0), np.zeros(3)
    points = _POINTS("detections", detections)
    flat = np.zeros((len(points), 3))
    flat[:, :points.shape[1]] = points
    return flat, np.ones(len(points)), np.zeros(3)


def _merged(points, weights, merge_distance: float) -> tuple:
    """Means of the points that chains of steps shorter than `merge_distance` join, by weight, and their weights."""
    if merge_distance == 0.0 or len(points) < 2:
        return points, weights
    group = np.arange(len(points))
    is_near = np.linalg.norm(points[:, None] - points, axis=2) < merge_distance
    while True:
        lowest = np.where(is_near, group, len(points)).min(axis=1)
        if np.array_equal(lowest, group):
            break
        group = lowest
    members = group == np.unique(group)[:, None]
    total = members @ weights
    return (members * weights) @ points / total[:, None], total


def _outer(vectors):
    return vectors[:, :, None] * vectors[:, None, :]


def detections_rule(argument: str, value) -> list:
    """A list with the detections of each frame."""
    rule = "a list with the Detections or points [D, 2] of each frame"
    if isinstance(value, Detections):
        raise refused(TypeError, argument, f"{rule}, not those of one", value)
    return list(iterable(argument, value, rule))
