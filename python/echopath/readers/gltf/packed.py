"""Packed surfaces, unpacked by the libraries that packed them: Draco meshes and buffer views of meshoptimizer.

Extensions KHR_draco_mesh_compression and EXT_meshopt_compression of glTF (Khronos Group).
"""
from __future__ import annotations

from types import ModuleType

import numpy as np

from ...base.process.libraries import needed_module
from .item import Item

DRACO, MESHOPT = "KHR_draco_mesh_compression", "EXT_meshopt_compression"
FILTERS = {"OCTAHEDRAL": ("decode_filter_oct", (4, 8)), "QUATERNION": ("decode_filter_quat", (8,)),
           "EXPONENTIAL": ("decode_filter_exp", tuple(range(4, 257, 4)))}   # -> function, bytes of a row
EXTRAS = {"DracoPy": "gltf", "meshoptimizer": "meshopt"}  # library -> extra of echopath that brings it


def _library(name: str, extension: str) -> ModuleType:
    """An optional library. Raises ModuleNotFoundError that says what to install."""
    return needed_module(name, f"a glTF file packed by {extension}", extra=EXTRAS[name])


def draco_mesh(content: bytes, item: Item) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """(corners [3 F], {id of an attribute: rows [V, columns]}) of a Draco mesh; item: where it stands, for errors."""
    library = _library("DracoPy", DRACO)
    try:
        mesh = library.decode(content)
        faces, attributes = mesh.faces, {one["unique_id"]: np.asarray(one["data"]) for one in mesh.attributes}
    except Exception as error:  # of this library alone, which has no class of its own for them
        item.fail(f"is no Draco mesh ({str(error)[:100]})")
    return np.asarray(faces, np.int64).ravel(), attributes


def meshopt_view(content: bytes, packed: Item) -> bytes:
    """The bytes that a packed buffer view stands for; packed: what its extension says."""
    count, stride = packed["count"].whole(1, 2**31), packed["byteStride"].whole(1, 256)
    mode, how = packed["mode"].text(), packed["filter"].text("NONE")
    library = _library("meshoptimizer", MESHOPT)
    if mode == "ATTRIBUTES":
        return _attributes(library, content, packed, count, stride, how)
    if mode not in ("TRIANGLES", "INDICES"):
        packed["mode"].must_be("ATTRIBUTES, TRIANGLES or INDICES")
    if stride not in (2, 4) or (mode == "TRIANGLES" and count % 3) or how != "NONE":
        packed.fail("must have indices of 2 or 4 bytes, three for each triangle, and no filter")
    decode = library.decode_index_buffer if mode == "TRIANGLES" else library.decode_index_sequence
    corners = _decoded(packed, lambda: decode(count, 4, content))
    return np.asarray(corners, np.uint32).astype(f"<u{stride}").tobytes()


def _attributes(library: ModuleType, content: bytes, packed: Item, count: int, stride: int, how: str) -> bytes:
    """Rows of vertices, with their filter undone."""
    if stride % 4:
        packed["byteStride"].must_be("a multiple of 4")
    if how != "NONE" and (how not in FILTERS or stride not in FILTERS[how][1]):
        packed["filter"].must_be(f"NONE, or {', '.join(FILTERS)} for rows that it takes")
    rows = _decoded(packed, lambda: library.decode_vertex_buffer(count, stride, content))
    if how in FILTERS:
        rows = getattr(library, FILTERS[how][0])(rows, count, stride)
    return rows.tobytes()


def _decoded(packed: Item, decode) -> np.ndarray:
    try:
        return decode()
    except (ValueError, RuntimeError, MemoryError) as error:
        packed.fail(f"cannot be unpacked ({str(error)[:100]})")
