"""Accessors: typed views into buffers, as NumPy arrays."""
from __future__ import annotations

import numpy as np

from .document import Document
from .item import Item
from .packed import MESHOPT, meshopt_view

# componentType -> (type, what a normalised number is divided by)
COMPONENTS = {5120: ("<i1", 127.0), 5121: ("<u1", 255.0), 5122: ("<i2", 32767.0), 5123: ("<u2", 65535.0),
              5125: ("<u4", 4294967295.0), 5126: ("<f4", 1.0)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
FLOAT, UNSIGNED = (5126,), (5121, 5123, 5125)
ANY = tuple(COMPONENTS)


class Accessors:
    """The accessors of a document; each is read once."""

    def __init__(self, document: Document):
        self._document = document
        self._items = document.json["accessors"].objects()
        self._views = document.json["bufferViews"].objects()
        self._read: dict[int, np.ndarray] = {}
        self._unpacked: dict[int, bytes] = {}

    def numbers(self, reference: Item, kind: str, components=ANY) -> np.ndarray:
        """Numbers [N] or [N, columns] in double precision of the accessor that `reference` names; normalised where it says so.

        kind: "VEC3" and the like; components: the types that may hold them. Raises FileError, also for what is not finite.
        """
        index, item = self._item_of(reference, kind, components)
        values = self._stored(index, item)
        self._document.spend(8 * values.size, reference)
        result = values.astype(np.float64)
        if item["normalized"].flag(False):
            result = np.maximum(result / COMPONENTS[item["componentType"].value][1], -1.0)
        bad = np.flatnonzero(~np.isfinite(result))
        if len(bad):
            width = WIDTHS[kind]
            reference.fail(f"must hold finite numbers, holds {result.flat[bad[0]]:g} at entry {bad[0] // width}")
        return result

    def indices(self, reference: Item, kind: str = "SCALAR") -> np.ndarray:
        """Whole numbers >= 0, [N] or [N, columns]."""
        index, item = self._item_of(reference, kind, UNSIGNED)
        values = self._stored(index, item)
        self._document.spend(8 * values.size, reference)
        return values.astype(np.int64)

    def spend(self, num_bytes: int, item: Item) -> None:
        """Counts what is made of entries as memory of the document, `Document.spend`."""
        self._document.spend(num_bytes, item)

    def count(self, reference: Item) -> int:
        """Entries of the accessor that `reference` names."""
        return self._items[reference.index(len(self._items))]["count"].whole(1, 2**31)

    def is_stored(self, reference: Item) -> bool:
        """Whether it has any bytes; one that has none is all zeros."""
        item = self._items[reference.index(len(self._items))]
        return "bufferView" in item or "sparse" in item

    def has_bytes(self, reference: Item) -> bool:
        """Whether its numbers have 8 bits."""
        return self._items[reference.index(len(self._items))]["componentType"].value in (5120, 5121)

    def _item_of(self, reference: Item, kind: str, components) -> tuple[int, Item]:
        index = reference.index(len(self._items))
        item = self._items[index]
        if item["type"].text() != kind:
            item["type"].fail(f"must be {kind} for {reference.place}, is {item['type'].value!r}"[:200])
        if item["componentType"].whole(0, 2**16) not in components:
            wanted = ", ".join(str(component) for component in components)
            item["componentType"].must_be(f"one of {wanted} for {reference.place}")
        return index, item

    def _stored(self, index: int, item: Item) -> np.ndarray:
        if index not in self._read:
            dtype = np.dtype(COMPONENTS[item["componentType"].value][0])
            width = WIDTHS[item["type"].value]
            shape = (item["count"].whole(1, 2**31),) + ((width,) if width > 1 else ())
            self._document.spend(int(np.prod(shape)) * dtype.itemsize, item["count"])
            if item["bufferView"].is_given:
                values = self._viewed(item, item["bufferView"], shape, dtype)
            else:
                values = np.zeros(shape, dtype)
            self._read[index] = self._with_exceptions(item["sparse"], values) if item["sparse"].is_given else values
        return self._read[index]

    def put(self, reference: Item, rows: np.ndarray) -> None:
        """Gives the accessor that `reference` names, which has no bytes, its entries [N] or [N, columns]."""
        index = reference.index(len(self._items))
        item = self._items[index]
        kind, component = item["type"].text(), item["componentType"].whole(0, 2**16)
        if kind not in WIDTHS or component not in COMPONENTS:
            item.fail("must have a type and componentType of glTF 2.0")
        shape = (item["count"].whole(1, 2**31),) + ((WIDTHS[kind],) if WIDTHS[kind] > 1 else ())
        if rows.size != np.prod(shape) or len(rows) != shape[0]:
            item["count"].fail(f"is {shape[0]} of {kind}, where {reference.place} has entries {list(rows.shape)}")
        self._document.spend(rows.nbytes, reference)
        self._read[index] = rows.reshape(shape).astype(COMPONENTS[component][0])

    def bytes_of(self, reference: Item) -> memoryview:
        """The bytes of the buffer view that `reference` names."""
        index = reference.index(len(self._views))
        view = self._views[index]
        if MESHOPT not in view["extensions"]:
            return self._part_of_buffer(view)
        if index not in self._unpacked:
            packed = view["extensions"][MESHOPT]
            self._document.spend(packed["count"].whole(1, 2**31) * packed["byteStride"].whole(1, 256), packed)
            self._unpacked[index] = meshopt_view(bytes(self._part_of_buffer(packed)), packed)
        return memoryview(self._unpacked[index])

    def _part_of_buffer(self, item: Item) -> memoryview:
        """What byteOffset and byteLength of an item cut out of its buffer."""
        content = self._document.buffer(item["buffer"].index(len(self._document.buffers)))
        begin, length = item["byteOffset"].whole(0, 2**53, 0), item["byteLength"].whole(1, 2**53)
        if begin + length > len(content):
            item["byteLength"].fail(f"ends at byte {begin + length} of a buffer of {len(content)} bytes")
        return memoryview(content)[begin:begin + length]

    def _viewed(self, item: Item, reference: Item, shape: tuple, dtype) -> np.ndarray:
        """Entries of a buffer view, without a copy."""
        content = self.bytes_of(reference)
        view = self._views[reference.index(len(self._views))]
        row = dtype.itemsize * (shape[1] if len(shape) > 1 else 1)
        stride = view["byteStride"].whole(1, 252, row)
        offset = item["byteOffset"].whole(0, 2**53, 0)
        end = offset + stride * (shape[0] - 1) + row
        if end > len(content):
            item.fail(f"ends at byte {end} of {view.place}, which has {len(content)} bytes")
        strides = (stride, dtype.itemsize) if len(shape) > 1 else (stride,)
        return np.ndarray(shape, dtype, content, offset, strides)

    def _with_exceptions(self, sparse: Item, values: np.ndarray) -> np.ndarray:
        """A copy of the values with those put in that the accessor names one by one."""
        count = sparse["count"].whole(1, len(values))
        indices, entries = sparse["indices"], sparse["values"]
        if indices["componentType"].whole(0, 2**16) not in UNSIGNED:
            indices["componentType"].must_be("5121, 5123 or 5125")
        dtype = np.dtype(COMPONENTS[indices["componentType"].value][0])
        where = self._viewed(indices, indices["bufferView"], (count,), dtype).astype(np.int64)
        if where.max() >= len(values):
            indices.fail(f"must be 0 to {len(values) - 1}, holds {where.max()}")
        changed = values.copy()
        changed[where] = self._viewed(entries, entries["bufferView"], (count, *values.shape[1:]), values.dtype)
        return changed
