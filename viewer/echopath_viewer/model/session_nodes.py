"""Maps of the paths over a mesh that is selected, and parts that are named in the viewer."""
from __future__ import annotations

import dataclasses

import echopath as ep
from echopath import _core

from .maps.part_set import MESH_GROUP, OWN_GROUP, WHOLE, Part
from .maps.signals import both


class SessionNodes:
    """Part of Session: what makes further maps, which takes synthesis."""

    def select_node(self, name: str | None, progress=None) -> None:
        """Selects a mesh or a group of meshes by its full name and makes the map of the visible paths that hit it; None
        takes that map away.

        A map of another mesh is left first: the part below it says which paths there are. Raises ValueError for what has no
        signal of its own; the mesh is selected then too.
        """
        self._make_node(name, self.node_base if self._is_node_shown else self.part_key, progress)

    def refresh_node(self, progress=None) -> None:
        """Makes the map of the selected mesh anew where the filters have changed since. Raises as `select_node`."""
        if self.node is None or not self.is_node_stale:
            return
        was_shown = self._is_node_shown
        try:
            self._make_node(self.node, self.node_base, progress)
        finally:
            if self.is_node_stale:  # stopped: rather no map than one of other filters
                self._replace_node(self.node, self.node_base, None)
        if was_shown:
            self.set_part((MESH_GROUP, self.node))

    @property
    def _is_node_shown(self) -> bool:
        return self.part_key[0] == MESH_GROUP

    def _make_node(self, name: str | None, base: tuple, progress) -> None:
        base = base if base in self.parts else (WHOLE, WHOLE)
        try:
            part = None if name is None else self._part_of_node(name, base, progress)
        except ValueError:
            self._replace_node(name, base, None)
            raise
        self._replace_node(name, base, part)

    def _replace_node(self, name: str | None, base: tuple, part: Part | None) -> None:
        self.node, self.node_base, self.is_node_stale = name, base, False
        was_shown = self._is_node_shown
        for old in self.parts.of_group(MESH_GROUP):
            self.parts.remove(old.key)
        if part is not None:
            self.parts.add(part)
        if was_shown:
            self.part_key = base
            self._refresh_visible()
            self._tell("rays", "selection")
        self._tell("maps", "meshes")

    def _part_of_node(self, name: str, base: tuple, progress) -> Part:
        """Its mask holds all paths of the part below, its map those that pass the filters."""
        below, hits = self.parts[base], ep.hits(name)
        mask = self.matches(hits) if below.paths is None else below.mask & self.matches(hits)
        selection = both(below.selection, hits)
        shown = mask & self.filters.mask(self.columns, self.matches)
        spectrum = self.signals.spectrum(shown, both(selection, self.filters.selection()), progress)
        return Part(MESH_GROUP, name, spectrum, mask, selection)

    def meshes_of_node(self) -> set:
        """IDs of the meshes that are selected."""
        return set() if self.node is None else self.meshes_below(self.node)

    def meshes_below(self, node: str) -> set:
        """IDs of the meshes of a node and of all nodes under it."""
        return {mesh for mesh, name in enumerate(self.mesh_names) if f"{name}/".startswith(f"{node}/")}

    def meshes_of_objects(self) -> list:
        """IDs of the meshes of what labels take for objects, which leaves out the ground and the walls around the radar; of all
        that is no mirror where there are none, as in a town that was read as one, or of everything."""
        objects = _core.meshes_of_usual_objects(self.scene, self.radar, self.time)
        meshes = sorted(mesh for ids in objects.values() for mesh in ids)
        return (meshes or [mesh.id for mesh in self.scene.meshes if not mesh.material.mirror]
                or list(range(len(self.mesh_names))))

    def add_part(self, name: str, progress=None) -> Part:
        """Names the visible paths, filters and part together, and adds their map.

        Raises ValueError for a name that is empty or taken.
        """
        name = name.strip()
        if not name:
            raise ValueError("name: must not be empty")
        if any(part.name == name for part in self.parts.shown_beside(self.partition)):
            raise ValueError(f"name: '{name}' is taken")
        mask, selection = self.visible.copy(), both(self.part.selection, self.filters.selection())
        spectrum = self.signals.spectrum(mask, selection, progress)
        part = Part(OWN_GROUP, name, spectrum, mask, selection, recipe=self._recipe())
        self.parts.add(part)
        self._tell("maps")
        return part

    def _recipe(self) -> dict:
        base, node = (self.node_base, self.node) if self._is_node_shown else (self.part_key, None)
        return {"part": list(base), "node": node,
                "filters": dataclasses.asdict(self.filters)}

    def remove_part(self, key: tuple) -> None:
        """Takes away a part that was named in the viewer. Raises ValueError for another one."""
        if key[0] != OWN_GROUP:
            raise ValueError("part: only parts that were named here can be removed")
        self.parts.remove(key)
        if self.part_key == key:
            self.set_part((WHOLE, WHOLE))
        self._tell("maps")
