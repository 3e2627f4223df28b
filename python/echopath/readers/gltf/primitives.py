"""Primitives: the vertices and triangles of one mesh, with what may move them."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..axes import Axes
from ..normals import as_smooth, welded
from .accessors import FLOAT, UNSIGNED, Accessors
from .document import Document
from .item import Item
from .packed import DRACO, draco_mesh

TRIANGLES, FAN = 4, 6  # modes; 5 is a strip
POINTS_OR_LINES = (0, 1, 2, 3)


@dataclass(frozen=True)
class Primitive:
    """The surface of one primitive, in axes and units of a scene.

    vertices [V, 3] in m; triangles [F, 3]; targets: {number of the morph target: displacements [V, 3] in m}
    joints [V, K], weights [V, K]: as the file has them, each row of weights scaled to a sum of 1; None without
    smooth: whether it stands for a curved surface; material: its name in the file, "" without
    item: where it stands in the file
    """

    vertices: np.ndarray
    triangles: np.ndarray
    targets: dict
    joints: np.ndarray | None
    weights: np.ndarray | None
    smooth: bool
    material: str
    item: Item


class Primitives:
    """Reads the primitives of a document, each once."""

    def __init__(self, document: Document, accessors: Accessors, axes: Axes):
        self._document, self._accessors = document, accessors
        self._axes = axes
        self._meshes = document.json["meshes"].objects()
        self._materials = document.json["materials"].objects()
        self._read: dict[int, list[Primitive]] = {}

    def mesh(self, index: int) -> Item:
        return self._meshes[index]

    @property
    def num_meshes(self) -> int:
        return len(self._meshes)

    def of_mesh(self, index: int) -> list[Primitive]:
        """Those that have triangles."""
        if index not in self._read:
            items = self._meshes[index]["primitives"].objects()
            if not items:
                self._meshes[index]["primitives"].fail("must hold at least one primitive")
            self._read[index] = [made for made in map(self._primitive, items) if made is not None]
        return self._read[index]

    def _primitive(self, item: Item) -> Primitive | None:
        mode = item["mode"].whole(0, 6, TRIANGLES)
        if mode in POINTS_OR_LINES:
            self._document.note("points and lines are left out")
            return None
        position = item["attributes"]["POSITION"]
        if not position.is_given:
            self._document.note(f"{item.place} has no positions and is left out")
            return None
        self._unpack(item, mode, position)
        vertices = self._points(position)
        triangles = self._triangles(item, mode, len(vertices))
        if not len(triangles):
            self._document.note(f"{item.place} has no triangles and is left out")
            return None
        joints, weights = self._influences(item["attributes"], len(vertices))
        targets = self._targets(item, len(vertices))
        normals = self._normals(item["attributes"]["NORMAL"], len(vertices))
        coarse = normals is not None and (DRACO in item["extensions"] or self._accessors.has_bytes(item["attributes"]["NORMAL"]))
        smooth = normals is not None and as_smooth(vertices, triangles, normals[triangles], coarse)
        moved_by = [*targets.values()] + ([joints, weights] if joints is not None else [])
        kept, triangles = welded(vertices, triangles, moved_by, normals if smooth else None)
        return Primitive(vertices[kept], triangles, {k: target[kept] for k, target in targets.items()},
                         None if joints is None else joints[kept], None if weights is None else weights[kept],
                         smooth, self._material(item["material"]), item)

    def _unpack(self, item: Item, mode: int, position: Item) -> None:
        """Gives the accessors of a packed primitive their entries, unless the file has them unpacked, too."""
        for name in item["extensions"].keys():
            if "compression" not in name or self._accessors.is_stored(position):
                continue
            if name != DRACO or mode != TRIANGLES:  # without its decoder it would be all zeros
                item.fail(f"is packed by {name}, which is not read" + (" but for triangles" if name == DRACO else ""))
            packed = item["extensions"][name]
            corners, attributes = draco_mesh(bytes(self._accessors.bytes_of(packed["bufferView"])), packed)
            self._accessors.put(item["indices"], corners)
            for attribute in packed["attributes"].keys():
                number = packed["attributes"][attribute].whole(0, 2**32)
                if number not in attributes:
                    packed["attributes"][attribute].fail(f"names the attribute {number}, which the Draco mesh has not")
                if item["attributes"][attribute].is_given:
                    self._accessors.put(item["attributes"][attribute], attributes[number])

    def _points(self, reference: Item) -> np.ndarray:
        """[V, 3] in m."""
        return self._axes.points(self._accessors.numbers(reference, "VEC3"))

    def _triangles(self, item: Item, mode: int, num_vertices: int) -> np.ndarray:
        """[F, 3] whatever the mode."""
        if item["indices"].is_given:
            corners = self._accessors.indices(item["indices"])
            if corners.max() >= num_vertices:
                item["indices"].fail(f"must be 0 to {num_vertices - 1}, the vertices, holds {corners.max()}")
        else:
            corners = np.arange(num_vertices)
        if mode == TRIANGLES:
            if len(corners) % 3:
                self._document.note(f"{item.place} has {len(corners)} corners, which make no whole triangles: the last ones"
                                    " are left out")
            return corners[:len(corners) // 3 * 3].reshape(-1, 3)
        i = np.arange(max(0, len(corners) - 2))
        if mode == FAN:
            return np.stack([corners[i + 1], corners[i + 2], np.full_like(i, corners[0])], axis=1)
        return np.stack([corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]], axis=1)

    def _normals(self, reference: Item, num_vertices: int) -> np.ndarray | None:
        if not reference.is_given:
            return None
        normals = self._axes.turned(self._accessors.numbers(reference, "VEC3"))
        self._require_rows(reference, normals, num_vertices)
        return normals

    def _targets(self, item: Item, num_vertices: int) -> dict:
        targets = {}
        for number, target in enumerate(item["targets"].objects()):
            position = target["POSITION"]
            if position.is_given and self._accessors.is_stored(position):
                targets[number] = self._points(position)
                self._require_rows(position, targets[number], num_vertices)
        return targets

    def _influences(self, attributes: Item, num_vertices: int) -> tuple:
        """(joints [V, K], weights [V, K]) of all sets, or twice None."""
        joints, weights = [], []
        while f"JOINTS_{len(joints)}" in attributes or f"WEIGHTS_{len(joints)}" in attributes:
            reference, shares = attributes[f"JOINTS_{len(joints)}"], attributes[f"WEIGHTS_{len(joints)}"]
            joints.append(self._accessors.indices(reference, "VEC4"))
            weights.append(self._accessors.numbers(shares, "VEC4", FLOAT + UNSIGNED[:2]))
            for item, rows in ((reference, joints[-1]), (shares, weights[-1])):
                self._require_rows(item, rows, num_vertices)
            if weights[-1].min() < 0.0:
                shares.fail(f"must be >= 0, holds {weights[-1].min():g}")
        if not joints:
            return None, None
        return np.concatenate(joints, axis=1), self._scaled(np.concatenate(weights, axis=1))

    def _scaled(self, weights: np.ndarray) -> np.ndarray:
        """Rows with a sum of 1, which few bits do not give; a vertex without any weight follows its first joint."""
        sums = weights.sum(axis=1)
        if (sums <= 0.0).any():
            self._document.note("vertices without weights follow their first joint")
            weights = weights.copy()
            weights[sums <= 0.0, 0] = 1.0
            sums = weights.sum(axis=1)
        return weights / sums[:, None]

    def _require_rows(self, item: Item, rows: np.ndarray, num_vertices: int) -> None:
        if len(rows) != num_vertices:
            item.fail(f"must have an entry for each of the {num_vertices} vertices, has {len(rows)}")

    def _material(self, reference: Item) -> str:
        index = reference.index(len(self._materials), None)
        return "" if index is None else self._materials[index]["name"].text("")
