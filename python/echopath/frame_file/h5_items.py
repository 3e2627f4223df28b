"""The items of an HDF5 file by the lower level of h5py: the upper one takes three times as long for the small ones of a frame.

Its datasets are `h5py.h5d.DatasetID`, and groups `h5py.Group`.
"""
from __future__ import annotations

import functools
import math

import numpy as np

from ..base.process.libraries import load_whole

BLOCK_BYTES = 1 << 23   # written or read at a time: between two blocks Ctrl-C is answered


@functools.cache
def library():
    """h5py, with files alone: it takes a fifth of the time to import the package."""
    return load_whole("h5py")


def item_of(group, name: str):
    """The identifier of the item `name` of a group; None where there is none."""
    h5py = library()
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
    h5py = library()
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
    h5py = library()
    return item.name if isinstance(item, h5py.HLObject) else h5py.h5i.get_name(item).decode("utf-8", "replace")


def shape_of(dataset) -> tuple | None:
    """Sizes of a dataset; None where it has no place for values."""
    return dataset.get_space().shape


def is_chunked(dataset) -> bool:
    """Whether a dataset lies in blocks, which may be compressed."""
    h5py = library()
    return dataset.get_create_plist().get_layout() == h5py.h5d.CHUNKED


@functools.lru_cache
def _number_type(dtype):
    h5py = library()
    return h5py.h5t.py_create(dtype)


def memory_type(dtype):
    """The HDF5 type of values in memory; h5py's own, None, for texts, whose NumPy type does not say their encoding."""
    return None if dtype.kind in "SO" else _number_type(dtype)


@functools.cache
def text_types(length: int):
    """(NumPy's type, HDF5's type) of texts in UTF-8 of a fixed length in bytes; there are none of length 0."""
    h5py = library()
    dtype = h5py.string_dtype("utf-8", max(1, length))
    return dtype, h5py.h5t.py_create(dtype, logical=True)


def new_dataset(group, name: str, values, chunks: tuple | None = None):
    """A new dataset `name` of a group for values of a shape and type, an array or what says both.

    chunks: shape of the blocks that are shuffled and compressed, gzip of level 1; None: it lies in one piece, as it is
    """
    h5py = library()
    kind = h5py.h5t.py_create(values.dtype, logical=True) if values.dtype.kind in "SO" else _number_type(values.dtype)
    return h5py.h5d.create(group.id, name.encode(), kind, h5py.h5s.create_simple(values.shape), _creation(chunks),
                           _linking(name.isascii()))


@functools.lru_cache
def _creation(chunks: tuple | None):
    h5py = library()
    settings = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    settings.set_obj_track_times(False)
    if chunks is not None:
        settings.set_chunk(chunks)
        settings.set_shuffle()
        settings.set_deflate(1)
    return settings


@functools.cache
def _linking(is_ascii: bool):
    h5py = library()
    settings = h5py.h5p.create(h5py.h5p.LINK_CREATE)
    settings.set_create_intermediate_group(True)
    settings.set_char_encoding(h5py.h5t.CSET_ASCII if is_ascii else h5py.h5t.CSET_UTF8)
    return settings


@functools.cache
def scalar():
    """The place of a single value."""
    h5py = library()
    return h5py.h5s.create(h5py.h5s.SCALAR)


def write_blocks(dataset, values):
    """Writes an array to a dataset, and yields what is written at a time."""
    h5py = library()
    if 0 < values.nbytes <= BLOCK_BYTES:
        values = np.ascontiguousarray(values)
        dataset.write(h5py.h5s.ALL, h5py.h5s.ALL, values, memory_type(values.dtype))
        yield values
        return
    target = h5py.Dataset(dataset)
    for rows in row_blocks(values.shape, values.itemsize):
        target[rows] = block = np.ascontiguousarray(values[rows])
        yield block


def read_blocks(dataset, values):
    """Fills an array with the values of a dataset, and yields what is read at a time."""
    h5py = library()
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
