"""Which paths are visible, drawn, lit and listed."""
from __future__ import annotations

import numpy as np

from echopath.paths.edge_hits import edge_hits
from echopath.paths.subset import paths_on, strongest
from echopath.presentation.tables import event

from .frames.kept_orders import KEPT_CHANNEL
from .maps.part_set import WHOLE, Part, level_text
from .rays.filters import Filters
from .rays.ray_sample import SAMPLINGS, RaySampler, coherent_powers
from .rays.touch_groups import TouchGroups

EVENTS = {"S": "specular", "D": "diffuse", "E": "on an edge"}
MAX_LISTED = 100_000     # rows of the table
MAX_KEPT_MATCHES = 16    # masks of expressions kept for the next time


class SessionPaths:
    """Part of Session: what filters, parts and hidden meshes leave of the paths."""

    def explain(self, path: int) -> list[tuple]:
        """What a path is, in (label, text) lines: its hits, and the sheets that it goes through on its way."""
        columns = self.columns
        diffuse, edges = int(self.paths.diffuse[path]), int(edge_hits(self.paths, slice(path, path + 1))[0])
        lines = self._passes_of(path, 0)
        for hit, mesh in enumerate(columns.meshes_of(path)):
            lines += [(f"hit {hit + 1}", f"{self.mesh_names[mesh]} ({EVENTS[event(diffuse, edges, hit)]})")]
            lines += self._passes_of(path, hit + 1)
        return [("path", f"{path:,}"), *lines, ("range", f"{columns.range[path]:.3f} m"),
                ("speed", f"{columns.velocity[path]:+z.3f} m/s"), ("power", level_text(columns.power_dbm(path)))]

    def _passes_of(self, path: int, leg: int) -> list[tuple]:
        """Lines of the sheets on a leg of a path."""
        if not len(self.paths.passes):
            return []
        first, last = self.paths.pass_offsets[path:path + 2]
        passes = self.paths.passes[first:last]
        return [("through", self.mesh_names[mesh]) for mesh in passes["mesh_id"][passes["leg"] == leg]]

    def matches(self, selection):
        """Which paths a selection takes, bool [P]; kept for the next time."""
        key = str(selection)
        if key not in self._matches:
            self._matches[key] = np.asarray(selection.matches(self.paths))
            while len(self._matches) > MAX_KEPT_MATCHES:
                self._matches.popitem(last=False)
        self._matches.move_to_end(key)
        return self._matches[key]

    def set_filters(self, filters: Filters) -> None:
        """Raises FilterError, and keeps the filters as they were, for a text that is not understood."""
        mask = filters.mask(self.columns, self.matches)
        self.is_node_stale |= self.node is not None and filters != self.filters
        self.filters = filters
        self._set_visible(mask)
        self._tell("rays", "selection")

    def set_part(self, key: tuple) -> None:
        """Shows one part: its map and its rays."""
        self.part_key = key
        self._refresh_visible()
        self._tell("rays", "maps", "selection")

    def set_partition(self, partition: str | None) -> None:
        """Which partition the small maps show."""
        self.partition = partition
        self._sample = None
        if self.part not in self.parts.shown_beside(partition):
            self.set_part((WHOLE, WHOLE))
        self._tell("maps", "rays")

    @property
    def part(self) -> Part:
        return self.parts[self.part_key]

    def _refresh_visible(self) -> None:
        self._set_visible(self.filters.mask(self.columns, self.matches))

    def _set_visible(self, mask) -> None:
        of_part = self.part.mask
        self.visible = mask if of_part is None else mask & of_part
        self._refresh_drawable()

    def _refresh_drawable(self) -> None:
        """Rays over meshes that are hidden are not drawn: they would end in the air."""
        hidden = np.isin(np.arange(len(self.mesh_names)), list(self.hidden_meshes))
        self.drawable = self.visible & ~paths_on(self.paths, hidden) if hidden.any() and self.hides_rays else self.visible
        if self.ray is not None and not self.visible[self.ray]:
            self.ray = None
        self._lit = self._lit_rays = None
        self._sample = None

    @property
    def lit(self):
        """The visible paths in the selected cells, bool [P]; None where no cell is selected."""
        if self.box is None:
            return None
        if self._lit is None:
            is_there = self.index.mask_of(self.box) if self._lit_mask is None else self._lit_mask
            self._lit = self.visible & is_there
        return self._lit

    def selection(self) -> tuple:
        """What is selected, to be brought back by `select_again`."""
        return self.box, self.cell, self.beam, self.lit_by, self._lit_mask, self.ray

    def select_again(self, selection: tuple) -> None:
        """selection: of `selection` of this session."""
        self.box, self.cell, self.beam, name, mask, ray = selection
        self._light(name, mask)
        self.select_ray(ray)

    def shown_rays(self, limit: int | None = None):
        """The visible paths that are drawn: indices [N]; by `sampling` spread over the objects or the strongest.

        limit: the strongest of that number instead, strongest first
        """
        if limit is not None or self.sampling == "strongest":
            return strongest(self.columns.power, self.max_rays if limit is None else limit, self.drawable)
        if self._sample is None:
            parts = [part.mask for part in self.parts.of_group(self.partition) if part.paths is not None]
            self._sample = self.sampler.sample(self.drawable, self.max_rays, parts)
        return self._sample

    @property
    def groups(self) -> TouchGroups:
        """The paths by the meshes that they touch; made when they are first asked for."""
        if self._groups is None:
            columns, kept = self.columns, self._kept
            self._groups = TouchGroups(columns.offsets, columns.num_bounces, columns.mesh_id, len(self.mesh_names),
                                       kept and kept.groups)
        return self._groups

    @property
    def sampler(self) -> RaySampler:
        """Made when it is first asked for."""
        if self._sampler is None:
            columns, kept = self.columns, self._kept if self.channel == KEPT_CHANNEL else None
            if kept is None:
                self.groups.sort_within(columns.power)
                coherent_power = coherent_powers(self.groups, self._amplitude, columns.cell)
            else:
                coherent_power = kept.coherent_power
            self._sampler = RaySampler(self.groups, columns.power, coherent_power, len(self.mesh_names))
            self._amplitude = None  # nothing else needs them
        return self._sampler

    def set_sampling(self, sampling: str) -> None:
        """Which rays are drawn where there are too many: a name of SAMPLINGS."""
        if sampling not in SAMPLINGS:
            raise ValueError(f"sampling: must be one of {', '.join(SAMPLINGS)}, got {sampling!r}")
        self.sampling, self._sample = sampling, None
        self._tell("rays")

    def lit_rays(self, limit: int | None = None):
        """The strongest paths in the selected cells, strongest first: indices [N]."""
        if self.lit is None:
            return np.zeros(0, np.int64)
        if self._lit_rays is None:
            self._lit_rays = strongest(self.columns.power, max(MAX_LISTED, self.max_rays), self.lit & self.drawable)
        return self._lit_rays[:self.max_rays if limit is None else limit]

    def listed_rays(self):
        """The rows of the table, strongest first: the rays of the selected cells, or where none are selected those that
        are drawn."""
        if self.box is not None:
            return self.lit_rays(MAX_LISTED)
        drawn = self.shown_rays()
        return drawn[np.argsort(-self.columns.power[drawn], kind="stable")]

    def node_counts(self):
        """How many visible paths hit each node of the scene or what is below it: [N]."""
        counts = np.bincount(self.groups.group_of_path[self.visible], minlength=len(self.groups))
        return self._touched_nodes @ counts

    @property
    def _touched_nodes(self):
        """Which nodes each group of paths touches: bool [N, G]."""
        if self._node_touches is None:
            touched = np.zeros((len(self.scene.nodes), len(self.groups)), bool)
            touched[[mesh.node for mesh in self.scene.meshes]] = self.groups.touching(len(self.mesh_names)).T
            for number, node in reversed(list(enumerate(self.scene.nodes))):  # parents come before their children
                if node.parent >= 0:
                    touched[node.parent] |= touched[number]
            self._node_touches = touched
        return self._node_touches

    def set_max_rays(self, count: int) -> None:
        self.max_rays, self._sample, self._lit_rays = int(count), None, None
        self._tell("rays")
