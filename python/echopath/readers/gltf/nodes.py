"""The tree of nodes of a scene, and how each of them rests and moves."""
from __future__ import annotations

import numpy as np

from ...base.numerics.rotations import matrices, quaternions
from ...base.text.node_names import fit_name
from ..axes import Axes
from .document import Document
from .item import Item

DEEPEST = 512           # levels of a tree; a scene keeps the names of all of them for each node
ORTHOGONAL = 1e-3       # how far the axes of a matrix may be off a rotation that is animated
PLACEMENT_BYTES = 1000  # of a node in memory, about
LEVEL_BYTES = 65        # of its full name, for each level, and of the time to go up its chain


class Nodes:
    """The nodes of the scene that a document shows, in an order with parents first.

    order: [N] indices of nodes; parent: {node: parent or -1}; name: {node: own name, fit for a scene}; axes: of the file
    """

    def __init__(self, document: Document, axes: Axes):
        self._document, self.axes = document, axes
        self._items = document.json["nodes"].objects()
        self._meshes = document.json["meshes"].objects()
        self.parent: dict[int, int] = {}
        self.order: list[int] = []
        self._walk(self._roots())
        self.name = {node: self._fit_name(node) for node in self.order}
        self._rest: dict[int, tuple] = {}

    def item(self, node: int) -> Item:
        return self._items[node]

    def __len__(self) -> int:
        return len(self._items)

    def chain(self, node: int) -> list[int]:
        """The node and those above it, from the root on."""
        found = []
        while node >= 0:
            found.append(node)
            node = self.parent[node]
        return found[::-1]

    def _roots(self) -> list[Item]:
        scenes = self._document.json["scenes"].objects()
        if scenes:
            index = self._document.json["scene"].index(len(scenes), 0)
            if len(scenes) > 1:
                self._document.note(f"of {len(scenes)} scenes only number {index} is read")
            return scenes[index]["nodes"].entries()
        below = {child.index(len(self._items)) for item in self._items for child in item["children"].entries()}
        return [Item(node, self._document.file, f"nodes[{node}]") for node in range(len(self._items)) if node not in below]

    def _walk(self, roots: list[Item]) -> None:
        """Finds the nodes below the roots; each may be below one other alone."""
        left = [(root, -1, 1) for root in reversed(roots)]
        while left:
            reference, parent, level = left.pop()
            node = reference.index(len(self._items))
            if node in self.parent:
                reference.fail(f"nodes[{node}] has its place in the tree already")
            if level > DEEPEST:
                reference.fail(f"lies deeper than {DEEPEST} levels")
            self._document.spend(PLACEMENT_BYTES + LEVEL_BYTES * level, reference)
            self.parent[node] = parent
            self.order.append(node)
            left += [(child, node, level + 1) for child in reversed(self._items[node]["children"].entries())]

    def _fit_name(self, node: int) -> str:
        given = self._items[node]["name"].text("")
        mesh = self._items[node]["mesh"].index(len(self._meshes), None)
        if not given and mesh is not None:
            given = self._meshes[mesh]["name"].text("")
        fitted = fit_name(given, f"node_{node}")
        if given and fitted != given:
            self._document.note(f"names that a scene does not take are changed, such as {given[:40]!r} to '{fitted[:40]}'")
        return fitted

    def is_hidden(self, node: int) -> bool:
        """Whether the file says that the node and those below it are not to be seen."""
        extensions = self._items[node]["extensions"]
        return "KHR_node_visibility" in extensions and not extensions["KHR_node_visibility"]["visible"].flag(True)

    def rest(self, node: int) -> np.ndarray:
        """[4, 4] parent_from_node at rest, in axes and units of a scene."""
        item = self._items[node]
        if item["matrix"].is_given:
            matrix = item["matrix"].numbers(16).reshape(4, 4).T
            if np.abs(matrix[3] - (0.0, 0.0, 0.0, 1.0)).max() > 1e-6:
                item["matrix"].fail("must end its columns with 0, 0, 0 and 1")
            return self.axes.matrices(matrix)
        translation, rotation, scale = self.parts(node)
        made = np.eye(4)
        made[:3, :3] = matrices(rotation) * scale
        made[:3, 3] = translation
        return made

    def parts(self, node: int) -> tuple:
        """(translation [3] in m, rotation [4] (w, x, y, z), scale [3]) at rest, in axes of a scene."""
        if node not in self._rest:
            self._rest[node] = self._parts_of(self._items[node])
        return self._rest[node]

    def _parts_of(self, item: Item) -> tuple:
        if item["matrix"].is_given:
            return self._taken_apart(item["matrix"])
        translation = item["translation"].numbers(3, np.zeros(3))
        rotation = item["rotation"].numbers(4, np.array([0.0, 0.0, 0.0, 1.0]))
        scale = item["scale"].numbers(3, np.ones(3))
        length = np.linalg.norm(rotation)
        if not 0.5 < length < 2.0:
            item["rotation"].must_be("a unit quaternion (x, y, z, w)")
        return self.axes.points(translation), self.axes.quaternions(rotation / length), self.axes.turned(scale)

    def _taken_apart(self, item: Item) -> tuple:
        """The parts of a matrix; needed only where some of them are animated."""
        matrix = self.axes.matrices(item.numbers(16).reshape(4, 4).T)
        scale = np.linalg.norm(matrix[:3, :3], axis=0)
        if np.linalg.det(matrix[:3, :3]) < 0.0:
            scale[0] = -scale[0]
        axes = matrix[:3, :3] / np.where(scale == 0.0, 1.0, scale)
        if np.abs(axes.T @ axes - np.eye(3)).max() > ORTHOGONAL:
            item.fail("must be a translation, a rotation and a scale, as the node is animated")
        return matrix[:3, 3], quaternions(axes[None])[0], scale

    def inverse_bind(self, columns: np.ndarray, item: Item) -> np.ndarray:
        """[J, 4, 4] of matrices [J, 16] of the file."""
        matrices = columns.reshape(-1, 4, 4).transpose(0, 2, 1)
        if np.abs(matrices[:, 3] - (0.0, 0.0, 0.0, 1.0)).max() > 1e-4:
            item.fail("must hold matrices whose columns end with 0, 0, 0 and 1")
        return self.axes.matrices(matrices)
