"""Transforms of a Mitsuba file: steps in their order, each applied behind those before it."""
from __future__ import annotations

import numpy as np

from .elements import Element


def to_world(element: Element) -> np.ndarray:
    """The matrix [4, 4] of the child <transform name="to_world">, in the unit of the file; the identity without one."""
    transform = element.named("to_world", "transform")
    matrix = np.eye(4)
    for step in transform.children if transform is not None else ():
        if step.tag not in _STEPS:
            step.refuse(f"unknown transform; known are {', '.join(_STEPS)}")
        matrix = _STEPS[step.tag](step) @ matrix
    if not np.isfinite(matrix).all() or np.abs(matrix).max() > 1e70:
        element.refuse("its transform is not finite")
    return matrix


def _translate(step: Element) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = step.vector()
    return matrix


def _scale(step: Element) -> np.ndarray:
    return np.diag([*step.vector(1.0), 1.0])


def _rotate(step: Element) -> np.ndarray:
    """About an axis by an angle in degrees (Rodrigues)."""
    axis = _unit(step, step.vector())
    angle = np.radians(step.numbers("angle", 1)[0])
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return matrix


def _matrix(step: Element) -> np.ndarray:
    """Sixteen numbers row by row, or nine of the turn alone."""
    values = np.array(step.numbers("value", 9, 16))
    if len(values) == 9:
        matrix = np.eye(4)
        matrix[:3, :3] = values.reshape(3, 3)
        return matrix
    matrix = values.reshape(4, 4)
    if not np.array_equal(matrix[3], [0.0, 0.0, 0.0, 1.0]):
        step.refuse(f"the last row must be 0 0 0 1, got {matrix[3].tolist()}")
    return matrix


def _look_at(step: Element) -> np.ndarray:
    """From `origin` to `target`: +z looks there, +y is up, +x to the left."""
    origin, target = (np.array(step.numbers(name, 3)) for name in ("origin", "target"))
    up = step.numbers("up", 3) if "up" in step.attributes else [0.0, 1.0, 0.0]
    ahead = _unit(step, target - origin)
    left = _unit(step, np.cross(up, ahead))
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([left, np.cross(ahead, left), ahead, origin])
    return matrix


def _unit(step: Element, vector) -> np.ndarray:
    length = float(np.linalg.norm(vector))
    if not 1e-30 < length < 1e60:
        step.refuse("its direction must not vanish")
    return np.asarray(vector) / length


_STEPS = {"translate": _translate, "scale": _scale, "rotate": _rotate, "matrix": _matrix, "lookat": _look_at, "look_at": _look_at}
