"""Datasets of HDF5 files: written in blocks with check sums, read with their type and shape checked."""
from __future__ import annotations

import math
import os
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np

from .. import _core
from ..interrupts import heed, interrupts_are_kept

BLOCK_BYTES = 1 << 23   # written or read at a time: between two blocks Ctrl-C is answered
CHUNK_BYTES = 1 << 20   # of compression and of check sums
SMALL_BYTES = 1 << 12   # below it a dataset is one piece without compression
SPARE_BYTES = 1 << 18   # kept free beyond each dataset, for what HDF5 writes about it and the groups that follow

_TEXT = h5py.string_dtype("utf-8")


@contextmanager
def writing(path):
    """A new HDF5 file at `path`, open for writing, which has its space before anything is written to it.

    HDF5 cannot give up a file that it fails to write: the process would end with a crash. So a full disk is told here, by
    an OSError, and the file is cut to its size at the end.
    """
    _take_space(path)
    with h5py.File(path, "w") as file:
        _reserve(file, 0)
        yield file
        file.flush()
        size = file.id.get_filesize()
    os.truncate(path, size)


def _take_space(path) -> None:
    with open(path, "wb") as file:
        os.posix_fallocate(file.fileno(), 0, SPARE_BYTES)


def _reserve(group, num_bytes: int) -> None:
    """Space on the disk for a dataset of `num_bytes` at the end of the file; raises OSError where there is none."""
    file = group.file.id
    os.posix_fallocate(file.get_vfd_handle(), file.get_filesize(), num_bytes + num_bytes // 64 + SPARE_BYTES)


def write_array(group, name: str, values, *, unit: str = "", compress: bool = False) -> None:
    """Writes an array with a check sum.

    compress: shuffle and gzip level 1, for data with repetition (noise-like data grow no smaller and take longer).
    """
    values = np.asarray(values)
    options = {}
    if values.nbytes > SMALL_BYTES:
        options = {"chunks": _chunks(values.shape, values.itemsize), "fletcher32": True}
        if compress:
            options |= {"compression": "gzip", "compression_opts": 1, "shuffle": True}
    _reserve(group, values.nbytes)
    dataset = group.create_dataset(name, shape=values.shape, dtype=values.dtype, **options)
    dataset.attrs["unit"] = unit
    for rows in _row_blocks(values.shape, values.itemsize):
        dataset[rows] = values[rows]
        heed()


def write_stack(group, name: str, arrays: list, *, unit: str = "") -> None:
    """Writes arrays of one shape as one array [N, ...], one after the other."""
    shape = (len(arrays), *arrays[0].shape)
    dtype = arrays[0].dtype
    _reserve(group, sum(values.nbytes for values in arrays))
    dataset = group.create_dataset(name, shape=shape, dtype=dtype, fletcher32=True,
                                   chunks=_chunks(shape, dtype.itemsize))
    dataset.attrs["unit"] = unit
    for index, values in enumerate(arrays):
        dataset[index] = values
        heed()


def _row_blocks(shape: tuple, itemsize: int):
    """Slices of rows of at most BLOCK_BYTES, at least one row each."""
    step = max(1, BLOCK_BYTES // max(1, itemsize * math.prod(shape[1:])))
    return (slice(begin, begin + step) for begin in range(0, shape[0], step))


def _chunks(shape: tuple, itemsize: int) -> tuple:
    """The longest runs of rows of at most CHUNK_BYTES."""
    row_bytes = itemsize * math.prod(shape[1:])
    if row_bytes <= CHUNK_BYTES:
        return (min(shape[0], max(1, CHUNK_BYTES // max(1, row_bytes))), *shape[1:])
    return (1, *_chunks(shape[1:], itemsize))


def write_texts(group, name: str, texts) -> None:
    """Writes a list of texts as a [N] array of UTF-8."""
    group.create_dataset(name, data=np.array(list(texts), dtype=object), dtype=_TEXT, shape=(len(texts),))


def read_array(group, name: str, dtype, shape: tuple):
    """The array `name` of a group; raises ep.FileError when its type or shape is another one.

    shape: numbers, or None where any length will do.
    """
    dataset = _item(group, name, h5py.Dataset)
    if dataset.dtype != np.dtype(dtype):
        raise _core.FileError(f"{dataset.name} must hold {np.dtype(dtype)}, holds {dataset.dtype}")
    if len(dataset.shape) != len(shape) or any(want not in (None, got) for want, got in zip(shape, dataset.shape)):
        wanted = ", ".join("any" if want is None else str(want) for want in shape)
        raise _core.FileError(f"{dataset.name} must have the shape [{wanted}], has {list(dataset.shape)}")
    values = np.empty(dataset.shape, dataset.dtype)
    for rows in _row_blocks(dataset.shape, dataset.dtype.itemsize):
        values[rows] = dataset[rows]
        heed()
    return values


def read_texts(group, name: str, length: int | None = None) -> list[str]:
    """The [N] texts `name` of a group."""
    dataset = _item(group, name, h5py.Dataset)
    if len(dataset.shape) != 1 or (length is not None and len(dataset) != length):
        raise _core.FileError(f"{dataset.name} must have {length} texts, has the shape {list(dataset.shape)}")
    return [text.decode("utf-8") for text in dataset[...]]


def read_attribute(group, name: str, kind):
    """The attribute `name` as a `kind` (int, float, bool, str)."""
    if name not in group.attrs:
        raise _core.FileError(f"{group.name} has no attribute '{name}'")
    try:
        return kind(group.attrs[name])
    except (TypeError, ValueError):
        raise _core.FileError(f"{group.name}: attribute '{name}' must be a {kind.__name__}") from None


def read_group(group, name: str):
    """The group `name` of a group."""
    return _item(group, name, h5py.Group)


def _item(group, name: str, kind):
    item = group.get(name)
    if not isinstance(item, kind):
        raise _core.FileError(f"{group.name.rstrip('/')}/{name}: no such {kind.__name__.lower()}")
    return item


@contextmanager
def reading(path):
    """Opens an HDF5 file; whatever is wrong with it becomes an ep.FileError that names the file and the reason."""
    try:
        with interrupts_are_kept(), h5py.File(path, "r") as file:
            yield file
    except _core.FileError as error:
        raise _core.FileError(f"{path}: {error}") from None
    except FileNotFoundError:
        raise _core.FileError(f"{path}: no such file") from None
    except (OSError, KeyError, RuntimeError, ValueError, IndexError) as error:
        if Path(path).suffix.lower() == ".toml":
            raise _core.FileError(f"{path}: a scene file, where a frame file (.h5) is asked for; `echopath run {path} --out "
                                  "DIR` makes DIR/frame.h5 of it") from None
        raise _core.FileError(f"{path}: damaged or not an HDF5 file ({_first_line(error)})") from None


def _first_line(error) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
