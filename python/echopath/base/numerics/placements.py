"""Placements: how an object stands in the axes of its parent while it is at rest, [4, 4] parent_from_node in m."""
from __future__ import annotations

import math

import numpy as np

from ... import _core
from ...arguments.checks import array, refused

ORIGIN = (0.0, 0.0, 0.0)
_ROUNDING = 1e-12  # of the squared length of a column that is meant to be a unit vector


def placement(position, yaw: float, transform) -> np.ndarray:
    """The matrix of a position [3] in m and a yaw in rad, or the transform [4, 4] given instead of them."""
    if transform is not None:
        if tuple(position) != ORIGIN or yaw != 0.0:
            raise refused(ValueError, "transform", "given without position and yaw", transform)
        return matrix4(transform)
    matrix = np.eye(4)
    matrix[:3, 3] = position
    matrix[:3, :3] = _about_z(yaw)
    return matrix


def matrix4(value) -> np.ndarray:
    """A transform [4, 4]; raises ValueError or TypeError naming it."""
    matrix = np.array(array("[4, 4]", finite=True)("transform", value), np.float64)
    if tuple(matrix[3]) != (0.0, 0.0, 0.0, 1.0):
        raise refused(ValueError, "transform", "a matrix [4, 4] whose last row is 0 0 0 1", matrix[3].tolist())
    if np.linalg.det(matrix[:3, :3]) == 0.0:
        raise refused(ValueError, "transform", "a matrix that does not flatten space", matrix.tolist())
    return matrix


def yaw_of(matrix: np.ndarray) -> float:
    """The direction of the object's own +x in the plane of the parent's x and y, rad, left positive."""
    return math.atan2(matrix[1, 0], matrix[0, 0])


def moved_to(matrix: np.ndarray, position: np.ndarray) -> np.ndarray:
    """The placement with another position [3] in m."""
    moved = matrix.copy()
    moved[:3, 3] = position
    return moved


def turned_to(matrix: np.ndarray, yaw: float) -> np.ndarray:
    """The placement with another yaw in rad, turned about the parent's z; one that is a yaw alone as if made with it."""
    turned = matrix.copy()
    turned[:3, :3] = _about_z(yaw) if _is_yaw(matrix) else _about_z(yaw - yaw_of(matrix)) @ matrix[:3, :3]
    return turned


def ahead(matrix: np.ndarray) -> np.ndarray:
    """Unit vector [3] along the object's own +x in the parent's axes."""
    return matrix[:3, 0] / np.linalg.norm(matrix[:3, 0])


def motion_ahead(matrix: np.ndarray, speed: float) -> _core.LinearMotion:
    """The LinearMotion along the object's own +x at a speed in m/s."""
    return _core.LinearMotion(velocity=speed * ahead(matrix))


def parent_from_node(node: _core.Node, time: float) -> np.ndarray:
    """[4, 4] at a time in s: what a motion does to a placement, as `Scene.add` says."""
    if node.motion is None:
        return node.placement
    step, placed = node.motion.at(time), np.eye(4)
    placed[:3, :3] = step[:3, :3] @ node.placement[:3, :3]
    placed[:3, 3] = node.placement[:3, 3] + step[:3, 3]
    return placed


def _about_z(yaw: float) -> np.ndarray:
    cos, sin = math.cos(yaw), math.sin(yaw)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


def _is_yaw(matrix: np.ndarray) -> bool:
    """Whether it turns about z and does nothing else but move."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = matrix[:3, :3]
    return (xz, yz, zx, zy, zz) == (0.0, 0.0, 0.0, 0.0, 1.0) and (xx, xy) == (yy, -yx) and \
        abs(xx * xx + yx * yx - 1.0) < _ROUNDING
