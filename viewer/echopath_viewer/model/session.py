"""The state of a view: what is shown, chosen and selected, and what follows from it."""
from __future__ import annotations

import dataclasses
from collections import OrderedDict

import numpy as np

import echopath as ep
from echopath.path_subset import paths_on, strongest
from echopath.tables import edge_hits, event

from .antennas import world_from_antenna
from .cell_index import CellBox, CellIndex
from .colours import COLOUR_MODES, colour_rays
from .columns import read_columns
from .filters import Filters
from .layers import (
    DETECTIONS,
    LABELS,
    LAYERS,
    OBJECTS,
    TRUTH,
    detection_markers,
    label_image,
    label_markers,
    truth_markers,
)
from .palette import mesh_palette, objects_of
from .part_set import MESH_GROUP, OWN_GROUP, WHOLE, Part
from .ray_sample import SAMPLINGS, RaySampler
from .segments import RayBundle
from .signals import both
from .touch_groups import TouchGroups

MAX_RAYS = 2000          # drawn at most, unless asked otherwise: few enough to see between them
MAX_LISTED = 100_000     # rows of the table
DYNAMIC_RANGE_DB = 60.0
_EVENTS = {"S": "specular", "D": "diffuse", "E": "on an edge"}
MAX_KEPT_MATCHES = 16    # masks of expressions kept for the next time
MAX_KEPT_BUNDLES = 3     # of rays: those that are shown, lit and chosen


class Session:
    """One view of one frame. Setters return nothing and tell the listeners what has changed.

    Topics: "rays" (which are shown), "colours", "selection" (cell or ray), "maps", "time", "meshes" (looks, choice), "layers".
    """

    def __init__(self, view_input):
        self.paths, self.parts = view_input.paths, view_input.parts
        self.scene, self.radar = self.paths.scene, self.paths.radar
        self.title, self.cube = view_input.title, view_input.cube
        self.signals = view_input.signals
        self.known, self.layers, self._known_data = view_input.known, set(), {}
        self.mesh_names = [mesh.name for mesh in self.scene.meshes]
        self.palette = mesh_palette(self.scene)
        self.hidden_meshes: set[int] = set()
        self.hides_rays = True  # those over hidden meshes, too
        self.filters = Filters()
        self.part_key = (WHOLE, WHOLE)
        self.partition = next(iter(self.parts.partitions), None)
        self.color_by, self.max_rays, self.sampling = "bounces", MAX_RAYS, SAMPLINGS[0]
        self.dynamic_range_db = DYNAMIC_RANGE_DB
        self.box: CellBox | None = None
        self.cell: tuple | None = None  # (range index, velocity index) whose contributions are told
        self.attribution = None         # Attribution of the frame, once somebody has made it
        self.lit_by, self._lit_mask = "", None  # the family or detection whose paths are lit, wherever they lie
        self.ray: int | None = None
        self.node: str | None = None
        self.node_base = WHOLE, WHOLE  # the part whose paths the map of the node is made of
        self.is_node_stale = False     # that map is of other filters
        self.chirp = self.radar.waveform.num_chirps // 2
        self._listeners, self._matches, self._bundles = [], OrderedDict(), []
        self._groups = None
        self._read_channel(0, 0)
        self._refresh_visible()

    # --- telling ---

    def listen(self, listener) -> None:
        """listener: callable (set of topics)."""
        self._listeners.append(listener)

    def _tell(self, *topics: str) -> None:
        for listener in self._listeners:
            listener(set(topics))

    # --- channel and time ---

    @property
    def channel(self) -> tuple:
        return self.columns.tx, self.columns.rx

    def set_channel(self, tx: int, rx: int) -> None:
        """Another pair of antennas: powers, ranges, cells and maps are its own."""
        self._read_channel(tx, rx)
        self.is_node_stale |= self.node is not None and self.filters.min_power_dbm is not None
        self._refresh_visible()
        self._tell("rays", "maps", "selection")

    def _read_channel(self, tx: int, rx: int) -> None:
        self.columns = read_columns(self.paths, self.parts.whole.spectrum, tx, rx)
        spectrum, cells = self.parts.whole.spectrum, self.columns.cells
        self.index = CellIndex(cells.range_index, cells.velocity_index, len(spectrum.range), len(spectrum.velocity))
        self._sampler = None

    def set_chirp(self, chirp: int) -> None:
        """Moves scene and rays to the middle of a chirp; kept within the frame."""
        self.chirp = int(np.clip(chirp, 0, self.radar.waveform.num_chirps - 1))
        self._tell("time")

    @property
    def time(self) -> float:
        """s, the middle of the chirp shown."""
        return self.paths.frame.start_time + self.radar.chirp_time(self.columns.tx, self.chirp)

    def antennas_at(self, time: float) -> tuple:
        """World positions [3] of transmitter and receiver of the channel at a time in s."""
        antennas = self.radar.transmitters[self.columns.tx], self.radar.receivers[self.columns.rx]
        return tuple(world_from_antenna(self.radar, antenna, time)[:3, 3] for antenna in antennas)

    # --- which paths are shown ---

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
        self.visible = mask if self.part.mask is None else mask & self.part.mask
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

    def shown_rays(self, limit: int | None = None):
        """The visible paths that are drawn: indices [N]; by `sampling` spread over the objects or the strongest.

        limit: the strongest of that number instead, strongest first
        """
        if limit is not None or self.sampling == "strongest":
            return strongest(self.columns.power, self.max_rays if limit is None else limit, self.drawable)
        if self._sample is None:
            parts = [part.mask for part in self.parts.of_group(self.partition) if part.mask is not None]
            self._sample = self.sampler.sample(self.drawable, self.max_rays, parts)
        return self._sample

    @property
    def groups(self) -> TouchGroups:
        """The paths by the meshes that they touch; made when they are first asked for."""
        if self._groups is None:
            columns = self.columns
            self._groups = TouchGroups(columns.offsets, columns.num_bounces, columns.mesh_id, len(self.mesh_names))
        return self._groups

    @property
    def sampler(self) -> RaySampler:
        """Made when it is first asked for."""
        if self._sampler is None:
            cells = self.columns.cells
            cell = cells.velocity_index.astype(np.int64) * len(self.parts.whole.spectrum.range) + cells.range_index
            self._sampler = RaySampler(self.groups, self.columns.amplitude, cell, len(self.mesh_names))
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

    def mesh_counts(self):
        """How many visible paths hit each mesh: [M]."""
        groups = self.groups
        counts = np.bincount(groups.group_of_path[self.visible], minlength=len(groups))
        return counts @ groups.touching(len(self.mesh_names)).astype(np.int64)

    def set_max_rays(self, count: int) -> None:
        self.max_rays, self._sample, self._lit_rays = int(count), None, None
        self._tell("rays")

    # --- colours ---

    def set_color_by(self, mode: str) -> None:
        if mode not in COLOUR_MODES:
            raise ValueError(f"color_by: must be one of {', '.join(COLOUR_MODES)}, got {mode!r}")
        self.color_by = mode
        self._tell("colours")

    def set_mesh_colour(self, mesh: int, rgb) -> None:
        self.palette[mesh] = rgb
        self._tell("meshes", "colours")

    def set_mesh_visible(self, meshes, is_visible: bool) -> None:
        """meshes: IDs; rays over meshes that are hidden are not drawn."""
        before = self.hidden_meshes
        self.hidden_meshes = before - set(meshes) if is_visible else before | set(meshes)
        if self.hidden_meshes != before and self.hides_rays:
            self._refresh_drawable()
            self._tell("meshes", "rays")
        else:
            self._tell("meshes")

    def segments(self, rays):
        """The segments of paths at the time shown; a step in time selects no paths anew."""
        return self._bundle_of(np.asarray(rays, np.int64)).at(self.time, *self.antennas_at(self.time))

    def _bundle_of(self, rays) -> RayBundle:
        """Made of the paths, or kept from the last times; the latest last."""
        kept = next((bundle for bundle in self._bundles if np.array_equal(bundle.rays, rays)), None)
        bundle = RayBundle(self.paths, rays) if kept is None else kept
        self._bundles = [other for other in self._bundles if other is not bundle][1 - MAX_KEPT_BUNDLES:] + [bundle]
        return bundle

    def colouring(self, segments, **scale):
        """The colours of segments; scale: cmap, clim."""
        return colour_rays(self.color_by, self.columns, segments, self.palette, self.mesh_names, **scale)

    # --- selection ---

    def select_cells(self, box: CellBox | None, cell: tuple | None = None) -> None:
        """Selects the rays in a rectangle of cells; None selects none.

        cell: (range index, velocity index) in it whose contributions are told, None: its highest
        """
        spectrum = self.parts.whole.spectrum
        self.box = None if box is None else box.within(len(spectrum.range), len(spectrum.velocity))
        self.cell = self._highest_cell() if cell is None and self.box is not None else cell
        self._light("", None)

    def _highest_cell(self) -> tuple | None:
        box, level = self.box, self.parts.whole.level(*self.channel)
        inside = level[box.first_velocity:box.last_velocity + 1, box.first_range:box.last_range + 1]
        if not inside.size:
            return None
        velocity, distance = np.unravel_index(inside.argmax(), inside.shape)
        return int(distance) + box.first_range, int(velocity) + box.first_velocity

    def set_layer(self, layer: str, is_shown: bool, progress=None) -> None:
        """Shows or hides a layer, a name of LAYERS; what it shows is made the first time.

        Raises ValueError for another name, and where the frame does not know that.
        """
        if layer not in LAYERS:
            raise ValueError(f"layer: must be one of {', '.join(LAYERS)}, got {layer!r}")
        if is_shown:
            self._make_known(layer, progress)
        self.layers = self.layers | {layer} if is_shown else self.layers - {layer}
        self._tell("layers")

    def _make_known(self, layer: str, progress) -> None:
        name = LABELS if layer == OBJECTS else layer
        if name in self._known_data:
            return
        if self.known is None:
            raise ValueError(f"{layer}: only frames have them, got paths alone")
        self._known_data[name] = getattr(self.known, name)(progress)

    def known_data(self, layer: str):
        """What a layer shows: ep.Labels of the partition on display, ep.Detections or ep.Truth."""
        if layer not in (LABELS, OBJECTS):
            return self._known_data[layer]
        labels = self._known_data[LABELS]
        return labels.get(self.partition, next(iter(labels.values())))

    def object_colours(self) -> dict:
        """{object: rgb}, the mean of the shades of its meshes."""
        names, object_of_mesh = objects_of(self.scene)
        return {name: tuple(int(value) for value in self.palette[object_of_mesh == number].mean(axis=0))
                for number, name in enumerate(names)}

    def map_layers(self) -> tuple:
        """(RGBA image u8 [V, R, 4] or None, legend rows, markers) over the maps, by the layers that are shown."""
        image, rows, markers, spectrum = None, (), [], self.parts.whole.spectrum
        for layer in LAYERS[:2]:  # objects and ghosts hide the parts below
            if layer in self.layers:
                image, rows = label_image(self.known_data(layer), layer)
        if OBJECTS in self.layers:
            markers += label_markers(self.known_data(OBJECTS))
        if TRUTH in self.layers:
            markers += truth_markers(self.known_data(TRUTH))
        if DETECTIONS in self.layers:
            markers += detection_markers(self.known_data(DETECTIONS), spectrum, self.object_colours())
        return image, rows, markers

    def select_detection(self, index: int, reach: int = 0) -> None:
        """Selects the cell of a detection; where its paths are known, those are lit, else all within `reach` cells."""
        detections = self.known_data(DETECTIONS)
        velocity, distance = (int(value) for value in detections.cells[index])
        self.select_cells(CellBox.around(distance, velocity, reach), (distance, velocity))
        if detections.echoes is not None and not detections.is_noise[index]:
            self._light(f"detection {index}", np.isin(np.arange(self.paths.num_paths), detections.paths(index)[0]))

    def _light(self, name: str, mask) -> None:
        self.lit_by, self._lit_mask = name, mask
        self._lit = self._lit_rays = self.ray = None
        self._tell("selection")

    def select_family(self, group) -> None:
        """Lights the paths of an EchoGroup of the attribution, wherever they lie; None: those of the selected cells again."""
        self._light("" if group is None else group.name, None if group is None else self.attribution.paths_of(group))

    def cell_attribution(self):
        """CellAttribution of the selected cell at the channel on display; None where there is no cell or no attribution."""
        if self.cell is None or self.attribution is None:
            return None
        spectrum = self.parts.whole.spectrum
        weights = np.zeros(spectrum.values.shape[:2])
        weights[self.channel] = 1.0
        return self.attribution.of_cell(spectrum, *self.cell, weights)

    def select_ray(self, path: int | None) -> None:
        """Selects one path: its hits and its cell."""
        self.ray = None if path is None else int(path)
        self._tell("selection")

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
        mask = self.matches(hits) if below.mask is None else below.mask & self.matches(hits)
        selection = both(below.selection, hits)
        shown = mask & self.filters.mask(self.columns, self.matches)
        spectrum = self.signals.spectrum(shown, both(selection, self.filters.selection()), progress)
        return Part(MESH_GROUP, name, spectrum, mask, selection)

    def meshes_of_node(self) -> set:
        """IDs of the meshes that are selected."""
        if self.node is None:
            return set()
        return {mesh for mesh, name in enumerate(self.mesh_names) if f"{name}/".startswith(f"{self.node}/")}

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

    def set_dynamic_range(self, decibels: float) -> None:
        self.dynamic_range_db = float(decibels)
        self._tell("maps")

    def map_limits(self, ranges=None, velocities=None) -> tuple:
        """(lowest, highest) level in dBm of the colour scale of all maps.

        ranges in m, velocities in m/s: (first, last) of what is seen of them, None: all; what lies outside sets no limits.
        """
        highest = self.parts.highest_level(*self.channel, ranges, velocities)
        return highest - self.dynamic_range_db, highest

    def why_no_rays(self) -> str:
        """Why no ray is lit in the selected cells; "" where some are or none are selected."""
        if self.lit is None or self.lit_rays(1).size:
            return ""
        if self.lit.any():
            return "the rays of these cells go over hidden meshes or have no power"
        num_there = int(np.count_nonzero(self.index.mask_of(self.box)))
        if num_there:
            return f"{num_there:,} rays lie there, but filters or the part on display leave them out"
        return "no ray lies there: the level is side lobes and Doppler spread of echoes in other cells, or noise"

    def cell_of(self, path: int) -> tuple | None:
        """(range index, velocity index) of a path; None for one outside the map."""
        cells = self.columns.cells
        if cells.range_index[path] < 0:
            return None
        return int(cells.range_index[path]), int(cells.velocity_index[path])

    def slow_time_power(self, progress=None):
        """Power by chirp in dBm, [chirps]: of the rays in the selected cells, or of the whole. Raises ValueError where those
        rays have no signal of their own."""
        cube = self.cube if self.box is None else self.signals.cube(self.lit, progress=progress)
        tx, rx = self.channel
        return ep.power_by_chirp(cube, tx=tx, rx=rx)

    def explain(self, path: int) -> list[tuple]:
        """What a path is, in (label, text) lines."""
        cells, columns = self.columns.cells, self.columns
        diffuse, edges = int(self.paths.diffuse[path]), int(edge_hits(self.paths)[path])
        events = [_EVENTS[event(diffuse, edges, hit)] for hit in range(int(columns.num_bounces[path]))]
        hits = [(f"hit {number + 1}", f"{self.mesh_names[mesh]} ({kind})")
                for number, (mesh, kind) in enumerate(zip(columns.meshes_of(path), events))]
        return [("path", f"{path:,}"), *hits, ("range", f"{cells.range[path]:.3f} m"),
                ("speed", f"{cells.velocity[path]:+.3f} m/s"), ("power", f"{columns.power_dbm[path]:.1f} dBm")]
