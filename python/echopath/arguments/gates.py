"""Gates: which stretch of an axis counts."""
from __future__ import annotations

import numpy as np

from .checks import array, refused


def gate(argument: str, value) -> tuple[float, float] | None:
    """Rule: None, or a pair (low, high)."""
    if value is None:
        return None
    low, high = array("[2]", finite=True)(argument, value)
    if not low <= high:
        raise refused(ValueError, argument, "a pair (low, high), the lower first", value)
    return float(low), float(high)


def in_gate(argument: str, axis, gate, unit: str):
    """Which entries of an axis a gate takes, bool [X]; all for None. Raises ValueError where there are none."""
    if gate is None:
        return np.ones(len(axis), bool)
    inside = (axis >= gate[0]) & (axis <= gate[1])
    if not inside.any():
        raise _without_cell(argument, axis[0], axis[-1], len(axis), gate, unit)
    return inside


def require_cell(argument: str, step: float, count: int, gate, unit: str) -> None:
    """Raises ValueError unless a gate holds a cell of an axis of `count` cells of `step` with 0 in its middle, as of velocities,
    which is not made: it may have any length. None holds all."""
    if gate is None:
        return
    lowest, highest = -(count // 2), (count - 1) // 2
    near = step * np.clip(np.round(np.array(gate)[:, None] / step) + (-1, 0, 1), lowest, highest)
    if not ((near >= gate[0]) & (near <= gate[1])).any():
        raise _without_cell(argument, step * lowest, step * highest, count, gate, unit)


def _without_cell(argument: str, first: float, last: float, count: int, gate, unit: str) -> ValueError:
    return ValueError(f"{argument}: must hold a cell of the axis from {first:.4g} to {last:.4g} {unit} in steps of "
                      f"{(last - first) / max(count - 1, 1):.3g} {unit}, got {gate[0]:g} to {gate[1]:g}")
