"""Whether results hold the same values, array by array."""
from __future__ import annotations

import dataclasses

import numpy as np


def is_same(a, b) -> bool:
    """Whether two values are equal all through: arrays by dtype, shape and values, NaN as NaN; containers item by item."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return _is_same_array(a, b)
    if isinstance(a, dict) and isinstance(b, dict):
        return list(a) == list(b) and all(is_same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)) and type(a) is type(b):
        return len(a) == len(b) and all(map(is_same, a, b))
    if isinstance(a, float) and isinstance(b, float):
        return a == b or (a != a and b != b)
    return a is b or a == b


def has_same_fields(a, b, leave_out=()) -> bool:
    """Whether two objects of one dataclass have the same values in all fields but those named in `leave_out`."""
    names = [field.name for field in dataclasses.fields(a) if field.name not in leave_out]
    return all(is_same(getattr(a, name), getattr(b, name)) for name in names)


def _is_same_array(a, b) -> bool:
    if not (isinstance(a, np.ndarray) and isinstance(b, np.ndarray)) or a.dtype.kind != b.dtype.kind or a.shape != b.shape:
        return False
    return np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
