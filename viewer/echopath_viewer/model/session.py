"""The state of a view: what is shown, chosen and selected, and what follows from it."""
from __future__ import annotations

from collections import OrderedDict
from functools import cached_property

import numpy as np

import echopath as ep
from echopath.arguments.part_names import LEAKAGE
from echopath.signals.beside import leakage_map
from echopath.transmit.signals import chirp_of

from .antennas import world_from_antenna
from .colours import COLOUR_MODES, colour_rays
from .frames.kept_orders import KEPT_CHANNEL
from .maps.beams import beam_values, beam_weights, paths_in_beam
from .maps.cell_index import CellBox, CellIndex
from .maps.part_set import WHOLE, Part
from .palette import mesh_palette
from .rays.columns import Columns, read_columns
from .rays.filters import Filters
from .rays.ray_sample import SAMPLINGS
from .rays.segments import RayBundle
from .session_layers import SessionLayers
from .session_nodes import SessionNodes
from .session_paths import SessionPaths

MAX_RAYS = 2000          # drawn at most, unless asked otherwise: few enough to see between them
DYNAMIC_RANGE_DB = 60.0
ALL_VELOCITIES = "the chirps of the transmitter differ: echoes are in cells of all velocities, and detections tell their rays"
NOT_DRAWN = "{} go over hidden meshes or have no power"
MAX_KEPT_BUNDLES = 3     # of rays: those that are shown, lit and chosen


class Session(SessionPaths, SessionLayers, SessionNodes):
    """One view of one frame. Setters return nothing and tell the listeners what has changed.

    Topics: "rays" (which are shown), "colours", "selection" (cell or ray), "maps", "time", "meshes" (looks, choice), "layers".
    """

    def __init__(self, view_input):
        self.paths, self.parts = view_input.paths, view_input.parts
        self.scene, self.radar = self.paths.scene, self.paths.radar
        self.title, self.cube, self.note = view_input.title, view_input.cube, view_input.note
        self.kept_maps, self.angles, self.weather = view_input.kept_maps, view_input.angles, view_input.weather
        self.signals, self.file_state = view_input.signals, view_input.file_state
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
        self.beam: tuple | None = None  # (azimuth, elevation) in rad of the cell, None: it is that of the channel
        self.attribution = None         # Attribution of the frame, once somebody has made it
        self.lit_by, self._lit_mask = "", None  # the family or detection whose paths are lit, wherever they lie
        self.ray: int | None = None
        self.node: str | None = None
        self.node_base = WHOLE, WHOLE  # the part whose paths the map of the node is made of
        self.is_node_stale = False     # that map is of other filters
        self.chirp = self.radar.waveform.num_chirps // 2
        self._listeners, self._matches, self._bundles = [], OrderedDict(), []
        self._kept, self._groups, self._node_touches, self._amplitude = view_input.kept, None, None, None
        self._read_channel(0, 0)
        self._refresh_visible()

    # --- telling ---

    def listen(self, listener) -> None:
        """listener: callable (set of topics)."""
        self._listeners.append(listener)

    def _tell(self, *topics: str) -> None:
        for listener in self._listeners:
            listener(set(topics))

    @property
    def has_map(self) -> bool:
        """Whether there are levels to show: files of labels alone keep none."""
        return self.kept_maps is None or self.kept_maps.power is not None

    # --- channel and time ---

    @property
    def is_kept(self) -> bool:
        """Whether the file has columns and orders of an earlier view, which were read."""
        return self._kept is not None

    @property
    def channel(self) -> tuple:
        return self.columns.tx, self.columns.rx

    @property
    def channels(self) -> dict:
        """{words: (tx, rx)} of those that maps may be of; a file that keeps maps alone has the mean power of all."""
        num_sending, num_hearing = len(self.radar.transmitters), len(self.radar.receivers)
        if self.kept_maps is not None and num_sending * num_hearing > 1:
            return {f"mean of {num_sending * num_hearing} channels": self.channel}
        return {f"TX {tx}, RX {rx}": (tx, rx) for tx in range(num_sending) for rx in range(num_hearing)}

    @property
    def channel_name(self) -> str:
        """What the maps are of, in words."""
        return next(words for words, channel in self.channels.items() if channel == self.channel)

    def set_channel(self, tx: int, rx: int) -> None:
        """Another pair of antennas: powers, ranges, cells and maps are its own."""
        self._read_channel(tx, rx)
        self.is_node_stale |= self.node is not None and self.filters.min_power_dbm is not None
        self._refresh_visible()
        self._tell("rays", "maps", "selection")

    def _read_channel(self, tx: int, rx: int) -> None:
        spectrum, kept = self.parts.whole.spectrum, self._kept if (tx, rx) == KEPT_CHANNEL else None
        if kept is None:
            self.columns, self._amplitude = read_columns(self.paths, spectrum, tx, rx)
        else:
            self.columns = Columns(paths=self.paths, tx=tx, rx=rx, num_ranges=len(spectrum.range), **kept.columns)
        self.index = CellIndex(self.columns.cell, len(spectrum.range), len(spectrum.velocity), kept and kept.cell_order)
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

    # --- colours ---

    def set_color_by(self, mode: str) -> None:
        if mode not in COLOUR_MODES:
            raise ValueError(f"color_by: must be one of {', '.join(COLOUR_MODES)}, got {mode!r}")
        self.color_by = mode
        self._tell("colours")

    def set_mesh_colour(self, mesh: int, rgb) -> None:
        self.set_mesh_colours({mesh: rgb})

    def set_mesh_colours(self, rgb_of_mesh: dict) -> None:
        """Of some meshes {ID: (r, g, b)}, told once."""
        others = {mesh: rgb for mesh, rgb in rgb_of_mesh.items() if tuple(self.palette[mesh]) != tuple(rgb)}
        for mesh, rgb in others.items():
            self.palette[mesh] = rgb
        if others:
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
        spectrum, self.beam = self.parts.whole.spectrum, None
        self.box = None if box is None else box.within(len(spectrum.range), len(spectrum.velocity))
        self.cell = self._highest_cell() if cell is None and self.box is not None else cell
        self._light("", None)

    @property
    def tells_highest_cell(self) -> bool:
        """Whether the cell whose contributions are told is the highest of those that are selected."""
        return self.box is not None and self.cell == self._highest_cell()

    def _highest_cell(self) -> tuple | None:
        box, level = self.box, self.parts.whole.level(*self.channel)
        inside = level[box.first_velocity:box.last_velocity + 1, box.first_range:box.last_range + 1]
        if not inside.size:
            return None
        velocity, distance = np.unravel_index(inside.argmax(), inside.shape)
        return int(distance) + box.first_range, int(velocity) + box.first_velocity

    def _light(self, name: str, mask) -> None:
        self.lit_by, self._lit_mask = name, mask
        self._lit = self._lit_rays = self.ray = None
        self._tell("selection")

    def select_beam(self, range_index: int, azimuth: float, elevations, reach: int = 0, rows=None) -> None:
        """Selects the strongest velocity of a beam at a range, and lights the paths of its cells that lie in the beam.

        azimuth: rad; elevations: rad, [E] or one, of which the strongest is taken; reach: cells around it; rows: bool [V], the
        velocities that come into question, None: all
        """
        elevations = np.atleast_1d(elevations)
        levels = self._beam_levels(range_index, azimuth, elevations)
        if rows is not None:
            levels[:, ~rows] = -1.0
        strongest, velocity_index = (int(index) for index in np.unravel_index(levels.argmax(), levels.shape))
        elevation = float(elevations[strongest])
        self.select_cells(CellBox.around(range_index, velocity_index, reach), (range_index, velocity_index))
        self.light_beam(azimuth, elevation)

    def light_beam(self, azimuth: float, elevation: float) -> None:
        """Lights the paths of the selected cells that lie in a beam, whose contributions are told. azimuth, elevation: rad"""
        self.beam = azimuth, elevation
        inside = paths_in_beam(self.paths, self.index.mask_of(self.box), self.paths.frame.trace_time, azimuth, elevation)
        self._light(f"the beam at {np.degrees(azimuth):+z.1f}°, {np.degrees(elevation):+z.1f}°", inside)

    def _beam_levels(self, range_index: int, azimuth: float, elevations):
        """Amplitudes at a range in the beams of an azimuth, [E, V] in sqrt(W), or [1, V] of all directions where a file keeps the
        mean over the channels."""
        spectrum = self.part.spectrum
        if self.kept_maps is not None:
            return np.abs(spectrum.values[0, :1, :, range_index])
        return np.abs([beam_values(spectrum, self.radar, range_index, azimuth, one) for one in elevations])

    def select_family(self, group) -> None:
        """Lights the paths of an EchoGroup of the attribution, wherever they lie; None: those of the selected cells again."""
        self._light("" if group is None else group.name, None if group is None else self.attribution.paths_of(group))

    def cell_attribution(self):
        """CellAttribution of the selected cell at the channel on display; None where there is no cell or no attribution."""
        if self.cell is None or self.attribution is None:
            return None
        spectrum = self.parts.whole.spectrum
        if self.beam is None:
            weights = np.zeros(spectrum.values.shape[:2])
            weights[self.channel] = 1.0
        else:
            weights = beam_weights(spectrum, self.radar, self.cell[0], *self.beam)[:, :, self.cell[1]]
        return self.attribution.of_cell(spectrum, *self.cell, weights)

    def select_ray(self, path: int | None) -> None:
        """Selects one path: its hits and its cell."""
        self.ray = None if path is None else int(path)
        self._tell("selection")

    def set_dynamic_range(self, decibels: float) -> None:
        self.dynamic_range_db = float(decibels)
        self._tell("maps")

    def map_limits(self, ranges=None, velocities=None) -> tuple:
        """(lowest, highest) level in dBm of the colour scale of all maps.

        ranges in m, velocities in m/s: (first, last) of what is seen of them, None: all; what lies outside sets no limits.
        """
        highest = self.parts.highest_level(*self.channel, ranges, velocities, self._leaked)
        return highest - self.dynamic_range_db, highest

    @cached_property
    def _leaked(self) -> Part | None:
        """What the transmitters leak into the receivers, as the map of the whole has it; None: nothing."""
        spectrum = self.parts.whole.spectrum
        found = leakage_map(self.radar, spectrum.window, spectrum.zero_pad)
        return None if found is None else Part(WHOLE, LEAKAGE, found, is_known=False)

    def where_lit(self) -> str:
        """Where the rays are that are lit, in words."""
        return f"of {self.lit_by}" if self.lit_by else "in the selected cells"

    def why_no_rays(self) -> str:
        """Why no ray is drawn, or lit where cells are selected; "" where some are, or where filters take none."""
        if self.lit is None:
            return NOT_DRAWN.format("these rays") if self.visible.any() and not self.shown_rays().size else ""
        if self.lit_rays(1).size:
            return ""
        if self.lit.any():
            return NOT_DRAWN.format("the rays of these cells")
        if self.note:
            return self.note
        if self.lit_by:
            return f"no visible ray of {self.lit_by}"
        num_there = int(np.count_nonzero(self.index.mask_of(self.box)))
        if num_there:
            return f"{num_there:,} rays lie there, but filters or the part on display leave them out"
        if self.has_echoes_at_all_velocities():
            return ALL_VELOCITIES
        return "no ray lies there: the level is side lobes and Doppler spread of echoes in other cells, or noise"

    def has_echoes_at_all_velocities(self) -> bool:
        """Whether the chirps of the transmitter differ, as of a radar that hops: cells then tell no rays by their velocity."""
        return chirp_of(self.radar, self.columns.tx) is None

    def cell_of(self, path: int) -> tuple | None:
        """(range index, velocity index) of a path; None for one outside the map."""
        return self.columns.cell_of(path)

    def slow_time_power(self, progress=None):
        """Power by chirp in dBm, [chirps]: of the rays in the selected cells, or of the whole. Raises ValueError where those
        rays have no signal of their own."""
        if self.lit is not None and not self.lit.any():
            raise ValueError("no ray is selected")
        if self.note and not self.cube.any():
            raise ValueError(self.note)
        cube = self.cube if self.box is None else self.signals.cube(self.lit, progress=progress)
        tx, rx = self.channel
        return ep.power_by_chirp(cube, tx=tx, rx=rx)
