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
        raise ValueError(f"{argument}: must hold a cell of the axis from {axis[0]:.4g} to {axis[-1]:.4g} {unit} in steps of "
                         f"{(axis[-1] - axis[0]) / max(len(axis) - 1, 1):.3g} {unit}, got {gate[0]:g} to {gate[1]:g}")
    return inside
