"""A glTF file -> Model."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ...base.text.node_names import fit_name
from ..axes import Axes
from ..model import Model
from ..options import ReadOptions
from ..tree import MAX_NODES, Tree
from .accessors import Accessors
from .animations import animation_names, read_animation
from .document import Document
from .extensions import check_extensions
from .instances import INSTANCING, instances_of
from .motions import Motions
from .nodes import Nodes
from .primitives import Primitives
from .surfaces import Surface, Surfaces

UP = "y"
VRM_0 = "VRM"        # extension of figures that look the other way, toward -z (VRM Consortium, "VRM 0.0", 2018)
ROOT = -1
NAME_BYTES = 65      # of a level in the full name of a node
NODE_BYTES = 2000    # of a node of a scene, about


def read(path: Path, options: ReadOptions) -> Model:
    """The scene that a .gltf or .glb file shows. Raises FileError naming the file and the place; ValueError for a name of an
    animation that is not there."""
    tree, axes = Tree(options), Axes(options, up=UP)
    document = Document(path, tree.note)
    check_extensions(document)
    accessors = Accessors(document)
    names = animation_names(document)
    animation = read_animation(document, accessors, names, options)
    nodes = Nodes(document, axes)
    motions = Motions(nodes, animation)
    surfaces = Surfaces(document, accessors, nodes, motions, Primitives(document, accessors, axes), animation)
    _Content(document, accessors, nodes, motions, surfaces, tree).add_all()
    model = tree.model(format="glTF 2.0", unit=axes.unit, up=axes.up, animations=names, animation=animation.name,
                       duration=animation.duration)
    return model.placed(yaw=np.pi) if VRM_0 in document.json["extensions"] else model


class _Content:
    """Puts into a tree the nodes of the file that have surfaces, and those above them."""

    def __init__(self, document: Document, accessors: Accessors, nodes: Nodes, motions: Motions, surfaces: Surfaces,
                 tree: Tree):
        self._document, self._accessors, self._nodes, self._motions = document, accessors, nodes, motions
        self._surfaces, self._tree = surfaces, tree
        self._level: list[int] = []                      # of each node of the tree
        self._place: dict[int, int] = {ROOT: ROOT}       # node of the file -> node of the tree

    def add_all(self) -> None:
        plain, moved = self._with_surfaces()
        needed = {above for node in plain for above in self._nodes.chain(node)}
        needed |= {above for _, carrier in moved for above in self._nodes.chain(carrier)}
        for node in self._nodes.order:
            if node in needed:
                self._place[node] = self._add_plain(node, plain.get(node, []))
        for (node, carrier), found in moved.items():
            if INSTANCING in self._nodes.item(node)["extensions"]:
                self._document.note(f"of the copies of nodes[{node}], which joints move, only one is read")
            world = self._still_world(carrier)
            self._add_with(node, carrier, np.linalg.inv(world) if carrier != ROOT else np.eye(4), None, found)

    def _with_surfaces(self) -> tuple[dict, dict]:
        """{node: surfaces that its place and motion move}, {(node, carrier): surfaces that joints move}.

        Joints begin at the root of the scene, so what they move hangs on a node that stands still, turned back by its place.
        """
        plain, moved = {}, {}
        for node in self._shown():
            chain = self._nodes.chain(node)
            stretched = any(self._motions.stretches(above) for above in chain)
            if stretched and not self._surfaces.is_skinned(node) and not any(map(self._motions.moves, chain)):
                self._document.note(f"nodes[{node}] is scaled to nothing and left out")
                continue
            jointed = stretched or self._surfaces.is_skinned(node)
            found = self._surfaces.of(node, chain if jointed else [])
            if found and jointed:
                moved[node, self._carrier(node)] = found
            elif found:
                plain[node] = found
        return plain, moved

    def _shown(self) -> list[int]:
        """Nodes with meshes that the file does not hide."""
        hidden: set[int] = set()
        for node in self._nodes.order:
            if self._nodes.parent[node] in hidden or self._nodes.is_hidden(node):
                hidden.add(node)
        if hidden:
            self._document.note(f"{len(hidden)} nodes that the file hides are left out")
        return [node for node in self._nodes.order if node not in hidden and self._nodes.item(node)["mesh"].is_given]

    def _carrier(self, node: int) -> int:
        """The lowest node above that stands still, as do all above it."""
        carrier = ROOT
        for above in self._nodes.chain(node)[:-1]:
            if self._motions.of(above)[1] is not None:
                break
            carrier = above
        return carrier

    def _still_world(self, node: int) -> np.ndarray:
        world = np.eye(4)
        for above in self._nodes.chain(node):
            world = world @ self._motions.of(above)[0]
        return world

    def _add_plain(self, node: int, found: list[Surface]) -> int:
        """A node, with its surfaces, or with a node for each copy of these below it. Returns its index."""
        (placement, motion), above = self._motions.of(node), self._nodes.parent[node]
        copies = instances_of(self._nodes.item(node), self._accessors, self._nodes.axes) if found else None
        if copies is None:
            return self._add_with(node, above, placement, motion, found)
        index = self._add(self._nodes.name[node], self._place[above], placement, motion)
        for number, copy in enumerate(copies):
            if np.linalg.det(copy[:3, :3]) == 0.0:
                self._tree.count("a copy that is scaled to nothing is left out")
                continue
            self._add_found(f"{self._nodes.name[node]}_{number}", index, copy, None, found)
        return index

    def _add_with(self, node: int, parent: int, placement, motion, found: list[Surface]) -> int:
        return self._add_found(self._nodes.name[node], self._place[parent], placement, motion, found)

    def _add_found(self, name: str, parent: int, placement, motion, found: list[Surface]) -> int:
        """A node, with its mesh if it has one alone that does not deform while the node moves, otherwise with nodes below."""
        if len(found) == 1 and (motion is None or found[0].deformation is None):
            return self._add_surface(name, parent, placement, motion, found[0])
        index = self._add(name, parent, placement, motion)
        for number, surface in enumerate(found):
            part = fit_name(surface.primitive.material, f"primitive_{number}")
            self._add_surface(part, index, None, None, surface)
        return index

    def _add_surface(self, name: str, parent: int, placement, motion, surface: Surface) -> int:
        if not surface.regions:
            return self._add(name, parent, placement, motion, surface.mesh, surface)
        index = self._add(name, parent, placement, motion)
        for joint, part in surface.regions:
            self._add(joint, index, None, None, part, surface)
        return index

    def _add(self, name: str, parent: int, placement, motion, mesh=None, surface: Surface | None = None) -> int:
        if len(self._tree.nodes) >= MAX_NODES:
            self._document.json["nodes"].fail(f"must make {MAX_NODES} nodes of a scene at most, with all copies")
        self._level.append(1 if parent < 0 else self._level[parent] + 1)
        self._document.spend(NODE_BYTES + NAME_BYTES * self._level[-1], self._document.json["nodes"])
        fields = {}
        if surface is not None:
            fields = {"mesh": mesh, "deformation": surface.deformation, "foreign_material": surface.primitive.material,
                      "smooth": surface.primitive.smooth}
        return self._tree.add(name, parent, placement=placement, motion=motion, **fields)
