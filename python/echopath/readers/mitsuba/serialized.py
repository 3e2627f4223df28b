"""Mitsuba's own mesh files (.serialized): several meshes in a file, each compressed by zlib.

A mesh is the numbers 0x041C and 3 or 4 (u16), then a stream of deflate: flags (u32), of version 4 a name that ends with a zero,
numbers of vertices and triangles (u64), positions, then normals, texture coordinates (2) and colours, where the flags say so,
and three indices a triangle. The file ends with where the meshes begin (u64, u32 of version 3) and their number (u32)
(Mitsuba 0.6 documentation, "Serialized mesh loader"). Little-endian throughout.
"""
from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...base.storage.files import bytes_of

MAGIC, VERSIONS = 0x041C, (3, 4)
NORMALS, TEXTURE, COLOURS, FACETED, SINGLE, DOUBLE = 0x0001, 0x0002, 0x0008, 0x0010, 0x1000, 0x2000
EXPANSION = 1100    # more than deflate makes of a byte at most, 1032
LONGEST_NAME = 4096


class SerializedMesh(NamedTuple):
    """vertices: f64 [V, 3]; triangles: i64 [F, 3]; normals: f64 [V, 3] of the vertices, None where it has none or is faceted."""

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    normals: NDArray[np.float64] | None


def read_serialized(path: Path, index: int) -> SerializedMesh:
    """A mesh of a file, counted from 0. Raises ep.FileError naming the file."""
    content = bytes_of(path)
    try:
        return _mesh(content, _begin_of(content, index))
    except (ValueError, zlib.error, struct.error, UnicodeDecodeError) as error:
        raise _core.FileError(f"{path}: {error}") from None


def _begin_of(content: bytes, index: int) -> int:
    """Where a mesh begins in a file."""
    version = _version_at(content, 0)
    count, = struct.unpack_from("<I", content, len(content) - 4)
    size = 8 if version == 4 else 4
    table = len(content) - 4 - size * count
    if count < 1 or table < 4:
        raise ValueError(f"must end with where its meshes begin and their number, got {count} meshes in {len(content)} bytes")
    if not 0 <= index < count:
        raise ValueError(f"shape_index must be 0 to {count - 1}, the meshes that it has, got {index}")
    begin, = struct.unpack_from("<Q" if version == 4 else "<I", content, table + size * index)
    if not begin < table:
        raise ValueError(f"mesh {index} must begin within the file, begins at byte {begin} of {len(content)}")
    return begin


def _version_at(content: bytes, begin: int) -> int:
    if len(content) < begin + 8:
        raise ValueError("is cut off")
    magic, version = struct.unpack_from("<HH", content, begin)
    if magic != MAGIC:
        raise ValueError(f"is no serialized mesh of Mitsuba: has {magic:#06x} at byte {begin} in the place of {MAGIC:#06x}")
    if version not in VERSIONS:
        raise ValueError(f"must be of version 3 or 4, is of version {version}")
    return version


def _mesh(content: bytes, begin: int) -> SerializedMesh:
    version = _version_at(content, begin)
    stream = _Stream(memoryview(content)[begin + 4:])
    flags, = struct.unpack("<I", stream.take(4))
    name = stream.text() if version == 4 else ""
    num_vertices, num_triangles = struct.unpack("<QQ", stream.take(16))
    if bool(flags & SINGLE) == bool(flags & DOUBLE):
        raise ValueError(f"must have numbers of single or of double precision, has the flags {flags:#x}")
    number = np.dtype("<f8" if flags & DOUBLE else "<f4")
    vertices = stream.rows(number, num_vertices, 3)
    normals = stream.rows(number, num_vertices, 3) if flags & NORMALS else None
    for flag, columns in ((TEXTURE, 2), (COLOURS, 3)):
        if flags & flag:
            stream.rows(number, num_vertices, columns)
    triangles = stream.rows(np.dtype("<u8" if num_vertices > 0xFFFFFFFF else "<u4"), num_triangles, 3)
    if num_triangles and triangles.max() >= num_vertices:
        raise ValueError(f"must have indices below {num_vertices}, the number of its vertices, has {triangles.max()}")
    return SerializedMesh(name, vertices.astype(np.float64), triangles.astype(np.int64),
                          None if normals is None or flags & FACETED else normals.astype(np.float64))


class _Stream:
    """What a stream of deflate holds, piece by piece: no more of it is made than is asked for and can be there."""

    def __init__(self, compressed):
        self._inflate, self._rest = zlib.decompressobj(), compressed
        self._room = EXPANSION * len(compressed)

    def take(self, count: int) -> bytes:
        """The next bytes. Raises ValueError where there are not so many."""
        if count > self._room:
            raise ValueError(f"is cut off: {count} bytes are not in what is left of it")
        self._room -= count
        taken = bytearray()
        while len(taken) < count:
            piece = self._inflate.decompress(self._rest, count - len(taken))
            self._rest = self._inflate.unconsumed_tail
            if not piece:
                raise ValueError("is cut off")
            taken += piece
        return bytes(taken)

    def text(self) -> str:
        """The text up to the next zero."""
        found = bytearray()
        while (byte := self.take(1)) != b"\0":
            found += byte
            if len(found) > LONGEST_NAME:
                raise ValueError(f"must have a name of at most {LONGEST_NAME} bytes")
        return found.decode()

    def rows(self, dtype: np.dtype, count: int, columns: int) -> NDArray:
        """The next array [count, columns]."""
        return np.frombuffer(self.take(count * columns * dtype.itemsize), dtype).reshape(count, columns)
