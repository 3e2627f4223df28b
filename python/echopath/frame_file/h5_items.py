"""The items of an HDF5 file by the lower level of h5py: the upper one takes three times as long for the small ones of a frame.

Its datasets are `h5py.h5d.DatasetID`, and groups `h5py.Group`. h5py is imported late, for files alone.
"""
from __future__ import annotations

import functools
import math

import numpy as np

BLOCK_BYTES = 1 << 23   # written or read at a time: between two blocks Ctrl-C is answered


def item_of(group, name: str):
    """The identifier of the item `name` of a group; None where there is none."""
    import h5py

    try:
        return h5py.h5o.open(group.id, name.encode())
    except KeyError:  # for what is damaged, too
        if name.encode() in group.id:
            raise
        return None


def integers_of(group, attributes) -> list | None:
    """The integers that are attributes of items below a group; None where there is not each of them.

    attributes: [(name of the item, name of its attribute)]
    """
    import h5py

    value, found = np.empty((), np.int64), []
    kind = memory_type(value.dtype)
    try:
        for item, name in attributes:
            h5py.h5a.open(group.id, name.encode(), obj_name=item.encode()).read(value, kind)
            found.append(int(value))
    except (KeyError, OSError, TypeError, ValueError, RuntimeError):  # for what is damaged, too
        return None
    return found


def name_of(item) -> str:
    """The name in its file of a group or of a dataset."""
    import h5py

    return item.name if isinstance(item, h5py.HLObject) else h5py.h5i.get_name(item).decode("utf-8", "replace")


def shape_of(dataset) -> tuple | None:
    """Sizes of a dataset; None where it has no place for values."""
    return dataset.get_space().shape


def is_chunked(dataset) -> bool:
    """Whether a dataset lies in blocks, which may be compressed."""
    import h5py

    return dataset.get_create_plist().get_layout() == h5py.h5d.CHUNKED


@functools.lru_cache
def _number_type(dtype):
    import h5py

    return h5py.h5t.py_create(dtype)


def memory_type(dtype):
    """The HDF5 type of values in memory; h5py's own, None, for texts, whose NumPy type does not say their encoding."""
    return None if dtype.kind in "SO" else _number_type(dtype)


def read_blocks(dataset, values):
    """Fills an array with the values of a dataset, and yields what is read at a time."""
    import h5py

    if 0 < values.nbytes <= BLOCK_BYTES:
        dataset.read(h5py.h5s.ALL, h5py.h5s.ALL, values, memory_type(values.dtype))
        yield values
        return
    source = h5py.Dataset(dataset, readonly=True)
    for rows in row_blocks(values.shape, values.itemsize):
        values[rows] = source[rows]
        yield values[rows]


def row_blocks(shape: tuple, itemsize: int):
    """Slices of rows of at most BLOCK_BYTES, at least one row each."""
    step = max(1, BLOCK_BYTES // max(1, itemsize * math.prod(shape[1:])))
    return (slice(begin, begin + step) for begin in range(0, shape[0], step))
