"""Builds the tree of a Model: names that a scene takes, materials by their foreign names, notes that count."""
from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np

from ..base.materials import LIBRARY_FREQUENCY, materials
from ..base.text.node_names import fit_name, unique
from .material_names import Meaning, material_of, note_of_unknown
from .model import Model, ModelNode
from .options import ReadOptions

MAX_NODES = 2_000_000  # of one model, with all copies and instances


class Tree:
    """Nodes of a model in the order in which they are added, parents first."""

    def __init__(self, options: ReadOptions):
        self.options = options
        self.nodes: list[ModelNode] = []
        self._taken: dict[int, dict[str, int]] = {}  # node -> names of its children
        self._meaning: dict[tuple[str, str], tuple] = {}
        self._unknown: list[str] = []
        self._at_library_frequency: set[str] = set()
        self._notes: dict[str, None] = {}
        self._counted: Counter[str] = Counter()

    def add(self, name: str, parent: int = -1, *, kind: str = "", **fields) -> int:
        """A node with a free name of its own; `fields` as of ModelNode, material None: by foreign_material. Returns its index.

        kind: name of ours for what the file says of the material where its foreign name is not known, "" for nothing
        """
        if fields.get("mesh") is not None and fields.get("material") is None:
            fields["material"] = self._material(fields.get("foreign_material", ""), kind)
        if fields.get("placement") is not None and np.array_equal(fields["placement"], np.eye(4)):
            fields["placement"] = None
        if self.options.smooth is not None:
            fields["smooth"] = self.options.smooth and fields.get("mesh") is not None
        own_name = unique(fit_name(name), self._taken.setdefault(parent, {}))
        self.nodes.append(ModelNode(own_name, parent, **fields))
        return len(self.nodes) - 1

    def note(self, sentence: str) -> None:
        """Adds a sentence, once."""
        self._notes[sentence] = None

    @property
    def notes(self) -> tuple[str, ...]:
        """The sentences so far."""
        return tuple(self._notes)

    def count(self, what: str) -> None:
        """Counts something that was left out or mended, told as "3 x what"."""
        self._counted[what] += 1

    def model(self, **fields) -> Model:
        """The Model; its notes are those of this tree."""
        counted = [f"{what} ({count} times)" if count > 1 else what for what, count in self._counted.items()]
        notes = (*self._notes, *counted, *note_of_unknown(self._unknown),
                 *self._note_of_library_values())
        return Model(tuple(_with_meshes(self.nodes)), notes=notes, **fields)

    def _material(self, name: str, kind: str):
        if (name, kind) not in self._meaning:
            meant, note = material_of(name, self.options.materials)
            if note is not None and kind:
                self.note(f"the material '{name}' is not known: {kind} is taken, as its type in the file says")
                meant, note = kind, None
            self._meaning[name, kind] = self._at_frequency(meant), note
        material, note = self._meaning[name, kind]
        if note is not None:
            self._unknown.append(name)
        return material

    def _at_frequency(self, meant: Meaning) -> Meaning:
        """A material by name with its values at the frequency asked for; a Material, and all without a frequency, as it is."""
        if self.options.frequency is None or not isinstance(meant, str):
            return meant
        library = materials.at(self.options.frequency)
        if meant in library.not_given:
            self._at_library_frequency.add(meant)
        return meant if library[meant] == materials[meant] else library[meant]

    def _note_of_library_values(self) -> list[str]:
        """What to say of materials that have no values at the frequency asked for; nothing for none."""
        known = ", ".join(sorted(self._at_library_frequency))
        return [f"values at {LIBRARY_FREQUENCY * 1e-9:g} GHz are taken for {known}"] if known else []


def _with_meshes(nodes: list[ModelNode]) -> list[ModelNode]:
    """The nodes that have a mesh or carry one."""
    needed = [node.mesh is not None for node in nodes]
    for index in range(len(nodes) - 1, -1, -1):
        if needed[index] and nodes[index].parent >= 0:
            needed[nodes[index].parent] = True
    if all(needed):
        return nodes
    number = np.cumsum(needed) - 1
    return [replace(node, parent=int(number[node.parent]) if node.parent >= 0 else -1)
            for node, keep in zip(nodes, needed) if keep]
