"""One picture of a session in a plotter."""
from __future__ import annotations

import numpy as np
import pyvista as pv

from ..model.antennas import world_from_antenna
from .antenna_layer import AntennaLayer
from .camera import look
from .known_layer import KnownLayer
from .legend import LegendLayer
from .mesh_layer import MeshLayer
from .name_layer import NameLayer
from .ray_layer import RayLayer
from .track_layer import TrackLayer
from .twin_layer import TwinLayer

BACKGROUND = "white"
RAY_WIDTH, LIT_WIDTH, CHOSEN_WIDTH = 1.0, 2.0, 4.0  # pixels
RAY_OPACITY = 0.5
QUICK_OPACITY = 0.7      # share of a ray's own colour where it is mixed with the background
COARSE_PIXELS = 2.0      # that triangles of meshes which move may fill without being drawn each
MAX_UNLIT_RAYS = 400     # around lit ones: they only show where those are
# Of rays that are not lit and of the chosen one, before a light and a dark background.
UNLIT_COLOURS, CHOSEN_COLOURS = ((208, 208, 208), (72, 74, 78)), ((20, 20, 20), (245, 245, 245))
CHOSEN_HIT_COLOUR = (230, 159, 0)
ANTENNA_SIZE = 0.02  # length of the axes, of the size of the picture
MARGIN = 0.1         # m, around what the picture must hold; less around what is smaller than 2 m


class SceneBuilder:
    """Draws meshes, antennas, rays, lit rays and the chosen ray of a session, and follows its changes."""

    def __init__(self, plotter, session, *, show_hits: bool = False, show_legend: bool = True, legend=None, names=None,
                 background=BACKGROUND, cmap=None, clim=None, is_quick: bool = False):
        """plotter: any pyvista.Plotter; cmap, clim: of the colour scale of rays, None: by what is shown.

        background: colour behind everything; legend: what shows legends in place of a layer in the picture, an object with
            show(model.Legend) and place(); names: what shows names in the scene, with set_names(layer, points [N, 3] m, texts);
            None: nothing does
        is_quick: rays are drawn opaque, in colours mixed with the background: blending takes software half of a picture's time
        """
        self.plotter, self.session = plotter, session
        self.show_hits = show_hits
        self._scale = {"cmap": cmap, "clim": clim}
        self.set_background(background)
        self.meshes = MeshLayer(plotter, session.scene, session.palette, session.time)
        self._is_quick = is_quick
        self.rays = RayLayer(plotter, "all", width=RAY_WIDTH, opacity=1.0 if is_quick else RAY_OPACITY)
        self.lit = RayLayer(plotter, "lit", width=LIT_WIDTH, in_front=True)
        self.chosen = RayLayer(plotter, "chosen", width=CHOSEN_WIDTH, in_front=True)
        self._set_names = names.set_names if names is not None else lambda *_: None
        self.names = NameLayer(self._set_names, lambda: self.meshes)
        self.known, self.twins = KnownLayer(plotter, self._set_names), TwinLayer(plotter, self._set_names)
        self.tracks = TrackLayer(plotter)
        self.legend = legend if legend is not None else LegendLayer(plotter) if show_legend else None
        self.update({"meshes"})
        self._draw_rays()
        corners = self.corners()
        size = float(np.linalg.norm(corners.max(axis=0) - corners.min(axis=0)))
        self.antennas = AntennaLayer(plotter, session.radar, max(ANTENNA_SIZE * size, 1e-3))
        self._draw_antennas()

    def update(self, topics: set) -> None:
        """Follows a change of the session; topics as it tells them."""
        if topics & {"time"}:
            self.meshes.move(self.session.time)
            self._draw_antennas()
        if topics & {"rays", "time", "selection"}:
            self._draw_rays()
        elif "colours" in topics:
            self._colour_rays()
        if "layers" in topics:
            self.known.show(self.session)
            self.twins.show(self.session)
        if topics & {"layers", "time", "meshes", "rays"}:
            self.names.show(self.session)
        if "meshes" in topics:
            self.meshes.colour(self.session.palette)
            self.meshes.show(self.session.hidden_meshes, self.session.meshes_of_node())

    def show_session(self, session) -> None:
        """Another frame in the same picture: meshes that it shares with the one before are moved, the camera stays."""
        self.session = session
        if self.meshes.fits(session.scene):
            self.meshes.take(session.scene, session.palette, session.time)
        else:
            self.meshes.remove()
            self.meshes = MeshLayer(self.plotter, session.scene, session.palette, session.time)
        self.antennas.set_radar(session.radar)
        self.update({"meshes", "rays", "layers"})
        self._draw_antennas()

    def show_tracks(self, tracks, places) -> None:
        """tracks: ep.Tracks of the frames of a time line, or None; places: [N, 3] m, of its rows in the world."""
        self.tracks.show(tracks, places)

    def set_background(self, colour) -> None:
        """Behind everything; rays that are not lit and the chosen one stand out of it, dark or light."""
        self.plotter.set_background(colour)
        self._behind = pv.Color(colour).int_rgb
        self._is_dark = sum(self._behind) < 3 * 128

    def set_show_hits(self, is_shown: bool) -> None:
        self.show_hits = is_shown
        self._draw_rays()

    def show_quick_meshes(self, pixels_per_radian: float | None) -> None:
        """Draws no more of the meshes than pixels show, as many to a radian; None: all of them again."""
        if pixels_per_radian is None:
            self.meshes.show_each()
            return
        position, ahead = (np.array(vector) for vector in (self.plotter.camera.position, self.plotter.camera.direction))

        def cells(low, high):
            nearest = np.minimum(low * ahead, high * ahead).sum(axis=1) - position @ ahead
            return COARSE_PIXELS * np.maximum(nearest, 0.0) / pixels_per_radian

        self.meshes.show_quick(cells)

    def show_first_rays(self, count: int | None, cell: float = 0.0) -> None:
        """Draws the first rays alone, None: all again; cell: m, those no farther apart may be drawn once."""
        for layer in (self.rays, self.lit):
            layer.show_first(count, cell)

    def nearest_ray(self) -> float:
        """Distance in m in front of the camera of the nearest end of a leg: less than 0 where one lies behind it."""
        camera = self.plotter.camera
        return min(layer.nearest(camera.position, camera.direction) for layer in (self.rays, self.lit))

    def look(self, view: str) -> None:
        """Turns the camera: a name of VIEWS."""
        radar, time = self.session.radar, self.session.time
        antenna = radar.transmitters[self.session.columns.tx]
        look(self.plotter, view, self.corners(), world_from_antenna(radar, antenna, time))

    def corners(self):
        """[2, 3] m: the ends of what the picture must hold: rays, antennas and objects, not the ground and the walls around."""
        session = self.session
        rays = self.rays.segments.points
        around_rays = [rays.min(axis=0), rays.max(axis=0)] if len(rays) else []
        boxes = [*self.meshes.bounds_of(session.meshes_of_objects()), around_rays, session.antennas_at(session.time)]
        corners = np.concatenate([np.reshape(box, (-1, 3)) for box in boxes])
        low, high = corners.min(axis=0), corners.max(axis=0)
        margin = min(MARGIN, 0.05 * float(np.linalg.norm(high - low))) or MARGIN
        return np.stack([low - margin, high + margin])

    def drawn_layers(self) -> list:
        """The layers that a click may pick a ray of, foremost first."""
        return [self.lit] if self.session.box is not None else [self.rays]

    # --- drawing ---

    def _draw_antennas(self) -> None:
        if hasattr(self, "antennas"):
            self.antennas.show(self.session.time, *self.session.channel)

    def _draw_rays(self) -> None:
        session = self.session
        is_selected = session.box is not None
        drawn = session.shown_rays()
        if is_selected and self._is_quick:
            drawn = drawn[:MAX_UNLIT_RAYS]
        shown, lit = session.segments(drawn), session.segments(session.lit_rays())
        main = session.colouring(lit if is_selected else shown, **self._scale)
        unlit = np.broadcast_to(np.uint8(UNLIT_COLOURS[self._is_dark]), (shown.num_segments, 3))
        hit_rgb = session.palette[shown.hit_mesh] if self.show_hits and not is_selected else None
        self.rays.show(shown, unlit if is_selected else self._mixed(main.rgb), hit_rgb=hit_rgb)
        lit_hits = session.palette[lit.hit_mesh] if self.show_hits else None
        self.lit.show(lit, main.rgb if is_selected else np.zeros((0, 3)), hit_rgb=lit_hits)
        self._draw_chosen()
        self._draw_legend(main.legend)

    def _colour_rays(self) -> None:
        layer = self.lit if self.session.box is not None else self.rays
        colouring = self.session.colouring(layer.segments, **self._scale)
        layer.recolour(self._mixed(colouring.rgb) if layer is self.rays else colouring.rgb)
        self._draw_legend(colouring.legend)

    def _mixed(self, rgb):
        """Colours of rays as they look over the background, where they are drawn opaque."""
        if not self._is_quick:
            return rgb
        own = QUICK_OPACITY * np.asarray(rgb, np.float32)
        return (own + (1.0 - QUICK_OPACITY) * np.float32(self._behind)).astype(np.uint8)

    def _draw_chosen(self) -> None:
        session = self.session
        segments = session.segments([] if session.ray is None else [session.ray])
        rgb = np.broadcast_to(np.uint8(CHOSEN_COLOURS[self._is_dark]), (segments.num_segments, 3))
        self.chosen.show(segments, rgb, hit_rgb=np.uint8(CHOSEN_HIT_COLOUR))
        names = [f"{number + 1} {session.mesh_names[mesh]}" for number, mesh in enumerate(segments.hit_mesh)]
        self._set_names("chosen", segments.points[segments.hits], names)

    def resized(self) -> None:
        """The picture has got another size."""
        if self.legend is not None:
            self.legend.place()

    def _draw_legend(self, legend) -> None:
        if self.legend is not None:
            self.legend.show(legend)
