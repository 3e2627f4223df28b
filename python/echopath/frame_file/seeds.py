"""Seeds of random numbers in HDF5 groups."""
from __future__ import annotations

import numpy as np

from .. import _core
from .h5 import read_attribute, write_attribute


def write_seed(group, name: str, seed: int | None) -> None:
    """Writes a seed as an attribute; None, for what has no random numbers, as none."""
    if seed is not None:
        write_attribute(group, name, np.uint64(seed))


def read_seed(group, name: str) -> int:
    """The seed that a group has as an attribute."""
    seed = read_attribute(group, name, int)
    if seed < 0:
        raise _core.FileError(f"{group.name}: attribute '{name}' must not be negative, is {seed}")
    return seed


def read_optional_seed(group, name: str) -> int | None:
    """Likewise, None where a group has none."""
    return read_seed(group, name) if name in group.attrs else None
