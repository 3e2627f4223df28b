"""What the guard of a run compared, in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from ..guard import Check
from .h5 import blames_group, read_array, read_texts, write_array, write_texts

NUMBERS = {"error": np.float64, "promise": np.float64, "count": np.int64}


def write_checks(group, checks) -> None:
    """Writes a list of Check."""
    for field in ("name", "unit"):
        write_texts(group, field, [getattr(check, field) for check in checks])
    for field, dtype in NUMBERS.items():
        write_array(group, field, np.array([getattr(check, field) for check in checks], dtype))


@blames_group
def read_checks(group) -> list[Check]:
    """The list of Check of a group."""
    names = read_texts(group, "name")
    columns = {"name": names, "unit": read_texts(group, "unit", len(names))}
    columns |= {field: read_array(group, field, dtype, (len(names),)).tolist() for field, dtype in NUMBERS.items()}
    return [Check(**dict(zip(columns, row))) for row in zip(*columns.values())]
