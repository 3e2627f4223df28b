"""Datasets of HDF5 files: written in blocks with check sums, read with their type, shape and check sum held against the file.

HDF5 itself checks what it writes about groups, types and attributes, in the layout of its version 1.10. Numbers and texts
have a CRC-32 here. Texts have a fixed length: the library runs in circles in damaged ones of variable length.
"""
from __future__ import annotations

import functools
import math
import os
import zlib
from contextlib import contextmanager

import numpy as np

from .. import _core
from ..base.process.interrupts import heed
from .h5_items import (
    BLOCK_BYTES,
    is_chunked,
    item_of,
    library,
    memory_type,
    name_of,
    new_dataset,
    read_blocks,
    scalar,
    shape_of,
    text_types,
    write_blocks,
)

CHUNK_BYTES = 1 << 20   # of compression
SMALL_BYTES = 1 << 12   # up to it a dataset is not compressed
SPARE_BYTES = 1 << 18   # kept free beyond each dataset, for what HDF5 writes about it and the groups that follow
MOST_COMPRESSION = 1100  # bytes that gzip can make of one
CHECK_SUM = "crc32"     # attribute of each dataset
LAYOUT = ("v110", "v110")  # the first whose headers all have check sums

# Letters of the NumPy types that an attribute of a kind may have.
_LETTERS = {int: "iu", float: "fiu", bool: "b", complex: "c", str: "S"}
# What reading a damaged file may raise, in this program, in h5py and in the core. A fault of this program looks the same: the
# error stays behind the FileError as its cause.
FAULTS = (OSError, ValueError, TypeError, KeyError, IndexError, AttributeError, ArithmeticError, RuntimeError, MemoryError)


@contextmanager
def writing(path):
    """A new HDF5 file at `path`, open for writing, which has its space before anything is written to it.

    HDF5 cannot give up a file that it fails to write: the process would end with a crash. So a full disk is told here, by
    an OSError, and the file is cut to its size at the end.
    """
    h5py = library()
    _take_space(path)
    with h5py.File(path, "w", libver=LAYOUT) as file:
        reserve(file, 0)
        yield file
        file.flush()
        size = file.id.get_filesize()
    os.truncate(path, size)


def _take_space(path) -> None:
    with open(path, "wb") as file:
        os.posix_fallocate(file.fileno(), 0, SPARE_BYTES)


def reserve(group, num_bytes: int) -> None:
    """Space on the disk for a dataset of `num_bytes` at the end of the file; raises OSError where there is none."""
    file = library().h5i.get_file_id(group.id)
    os.posix_fallocate(file.get_vfd_handle(), file.get_filesize(), num_bytes + num_bytes // 64 + SPARE_BYTES)


def write_array(group, name: str, values, *, unit: str = "", compress: bool = False) -> None:
    """Writes an array with a check sum.

    compress: shuffle and gzip level 1, for data with repetition (noise-like data grow no smaller and take longer).
    """
    values = np.asarray(values)
    is_compressed = compress and values.nbytes > SMALL_BYTES
    reserve(group, values.nbytes)
    dataset = new_dataset(group, name, values, _chunks(values.shape, values.itemsize) if is_compressed else None)
    _describe(dataset, write_blocks(dataset, values), unit)


def write_stack(group, name: str, arrays: list, *, unit: str = "") -> None:
    """Writes arrays of one shape as one array [N, ...], large ones one after the other."""
    num_bytes = sum(values.nbytes for values in arrays)
    if num_bytes <= BLOCK_BYTES:
        write_array(group, name, np.stack(arrays), unit=unit)
        return
    reserve(group, num_bytes)
    dataset = group.create_dataset(name, shape=(len(arrays), *arrays[0].shape), dtype=arrays[0].dtype)
    _describe(dataset.id, _written_one_by_one(dataset, arrays), unit)


def _written_one_by_one(dataset, arrays):
    for place, values in enumerate(arrays):
        dataset[place] = values = np.ascontiguousarray(values)
        yield values


def _describe(dataset, blocks, unit: str) -> None:
    """Writes what is known of a whole dataset, whose values are those of blocks that come in turn."""
    check_sum = 0
    for values in blocks:
        check_sum = zlib.crc32(values, check_sum)
        heed()
    write_attribute(dataset, "unit", unit)
    write_attribute(dataset, CHECK_SUM, np.uint32(check_sum))


def _chunks(shape: tuple, itemsize: int) -> tuple:
    """The longest runs of rows of at most CHUNK_BYTES."""
    row_bytes = itemsize * math.prod(shape[1:])
    if row_bytes <= CHUNK_BYTES:
        return (min(shape[0], max(1, CHUNK_BYTES // max(1, row_bytes))), *shape[1:])
    return (1, *_chunks(shape[1:], itemsize))


def write_texts(group, name: str, texts) -> None:
    """Writes a list of texts as a [N] array of UTF-8; raises ValueError for one that holds NUL, which would end it."""
    encoded = [_encoded(name, text) for text in texts]
    length = max((len(text) for text in encoded), default=1)
    write_array(group, name, np.array(encoded, dtype=text_types(length)[0]), compress=True)


def write_attribute(item, name: str, value) -> None:
    """Writes an attribute, in the place of one of that name: a number, or a text in UTF-8 of fixed length."""
    h5py = library()
    place, key = item.id if isinstance(item, h5py.HLObject) else item, name.encode()
    if h5py.h5a.exists(place, key):
        h5py.h5a.delete(place, key)
    if isinstance(value, str):
        text = _encoded(name, value)
        dtype, kind = text_types(len(text))
        value = np.array(text, dtype=dtype)
    else:
        value = np.asarray(value)
        kind = memory_type(value.dtype)
    h5py.h5a.create(place, key, kind, scalar()).write(value, kind)


def _encoded(name: str, text: str) -> bytes:
    if "\0" in text:
        raise ValueError(f"{name}: must not hold a NUL character, got {text!r}")
    return text.encode("utf-8")


class blaming:
    """Context that makes an ep.FileError that names a group or dataset of whatever its content makes go wrong.

    A class, since there are hundreds in the reading of a file: as a generator it takes three times as long.
    """

    __slots__ = ("_item",)

    def __init__(self, item):
        self._item = item

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind, error, traceback) -> None:
        if isinstance(error, FAULTS) and not isinstance(error, _core.FileError):
            raise _core.FileError(f"{name_of(self._item)}: {first_line(error)}") from error


def blames_group(function):
    """For functions whose first argument is the group that they read."""
    @functools.wraps(function)
    def read(group, *arguments, **keywords):
        with blaming(group):
            return function(group, *arguments, **keywords)
    return read


def read_array(group, name: str, dtype, shape: tuple):
    """The array `name` of a group; raises ep.FileError when its type, its shape or its check sum is another one.

    shape: numbers, or None where any length will do.
    """
    dataset = _dataset(group, name)
    with blaming(dataset):
        held, sizes = dataset.dtype, shape_of(dataset)
        if held != np.dtype(dtype):
            raise _core.FileError(f"{name_of(dataset)} must hold {np.dtype(dtype)}, holds {held}")
        if not _fits(sizes, shape):
            wanted = ", ".join("any" if want is None else str(want) for want in shape)
            raise _core.FileError(f"{name_of(dataset)} must have the shape [{wanted}], has {_shape_text(sizes)}")
        return _values(dataset, sizes, held)


def read_texts(group, name: str, length: int | None = None) -> list[str]:
    """The [N] texts `name` of a group."""
    dataset = _dataset(group, name)
    with blaming(dataset):
        held, sizes = dataset.dtype, shape_of(dataset)
        if held.kind != "S":
            raise _core.FileError(f"{name_of(dataset)} must hold texts of fixed length, holds {held}")
        if not _fits(sizes, (length,)):
            wanted = "any" if length is None else length
            raise _core.FileError(f"{name_of(dataset)} must have {wanted} texts, has the shape {_shape_text(sizes)}")
        return [text.decode("utf-8") for text in _values(dataset, sizes, held)]


def length_of(group, name: str) -> int:
    """Number of rows of the dataset `name` of a group."""
    shape = shape_of(_dataset(group, name))
    if not shape:
        raise _core.FileError(f"{group.name}/{name} must have rows, has none")
    return shape[0]


def _fits(sizes: tuple | None, shape: tuple) -> bool:
    return sizes is not None and len(sizes) == len(shape) and all(want in (None, got) for want, got in zip(shape, sizes))


def _shape_text(sizes: tuple | None) -> str:
    return "none" if sizes is None else str(list(sizes))


def _values(dataset, shape: tuple | None, dtype):
    """All values of a dataset of a shape and type, when they are those that its check sum was made of."""
    if shape is None or dtype.hasobject:
        raise _core.FileError(f"{name_of(dataset)} must hold numbers or texts of fixed length")
    num_bytes, stored = math.prod(shape) * dtype.itemsize, dataset.get_storage_size()
    if num_bytes > stored and num_bytes > stored * (MOST_COMPRESSION if is_chunked(dataset) else 1):
        raise _core.FileError(f"{name_of(dataset)}: damaged, {stored} bytes cannot hold its {math.prod(shape)} values")
    values, check_sum = np.empty(shape, dtype), 0
    for rows in read_blocks(dataset, values):
        check_sum = zlib.crc32(rows, check_sum)
        heed()
    if check_sum != _check_sum_of(dataset):
        raise _core.FileError(f"{name_of(dataset)}: damaged, its values do not have its check sum")
    return values


def _check_sum_of(dataset) -> int:
    """The check sum that a dataset has as an attribute: there are hundreds in a file, and their types say nothing more."""
    h5py = library()
    if not h5py.h5a.exists(dataset, CHECK_SUM.encode()):
        raise _core.FileError(f"{name_of(dataset)} has no attribute '{CHECK_SUM}'")
    value = np.full((), -1, np.int64)
    h5py.h5a.open(dataset, CHECK_SUM.encode()).read(value, memory_type(value.dtype))
    return int(value)


def check_sums(group) -> None:
    """Raises ep.FileError for the first dataset below a group whose values do not have its check sum."""
    h5py = library()
    for item in group.values():
        with blaming(item):
            if isinstance(item, h5py.Group):
                check_sums(item)
            else:
                _values(item.id, shape_of(item.id), item.dtype)


def read_attribute(item, name: str, kind):
    """The attribute `name` of a group or dataset as a `kind` (int, float, bool, complex, str)."""
    h5py = library()
    place = item.id if isinstance(item, h5py.Group) else item
    if not h5py.h5a.exists(place, name.encode()):
        raise _core.FileError(f"{name_of(item)} has no attribute '{name}'")
    with blaming(item):
        attribute = h5py.h5a.open(place, name.encode())
        if attribute.shape != () or attribute.dtype.kind not in _LETTERS[kind]:
            raise _core.FileError(f"{name_of(item)}: attribute '{name}' must be a {kind.__name__}")
        value = np.empty((), attribute.dtype)
        attribute.read(value, memory_type(value.dtype))
        return bytes(value[()]).decode("utf-8") if kind is str else kind(value[()])


def read_group(group, name: str):
    """The group `name` of a group."""
    h5py = library()
    return h5py.Group(_checked_item(group, name, "group", h5py.h5g.GroupID))


def _dataset(group, name: str):
    h5py = library()
    return _checked_item(group, name, "dataset", h5py.h5d.DatasetID)


def _checked_item(group, name: str, kind: str, identifier):
    """kind: of the item, for messages; identifier: its class in h5py"""
    with blaming(group):
        item = item_of(group, name)
    if not isinstance(item, identifier):
        raise _core.FileError(f"{group.name.rstrip('/')}/{name}: no such {kind}")
    return item


def copy_items(source, target, but: str = "") -> None:
    """Copies all items and attributes of a group into another one; but: name of an item that is left out."""
    for name in source:
        if name != but:
            source.copy(source[name], target, name)
    for key, value in source.attrs.items():
        target.attrs.create(key, value, dtype=source.attrs.get_id(key).dtype)


def first_line(error) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
