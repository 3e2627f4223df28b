"""One bundle of rays."""
from __future__ import annotations

import numpy as np

from ..model.rays.distinct import first_of_each
from .polydata import coloured_actor, loose_lines_of, set_point_colours, set_segment_colours, vertices_of

HIT_SIZE = 5.0  # pixels


class RayLayer:
    """Rays as coloured segments, with their hit points on demand; while the camera moves only the first ones.

    Opaque segments that lie on each other are drawn once, as the first ray with them has them.
    """

    def __init__(self, plotter, name: str, *, width: float, in_front: bool = False, opacity: float = 1.0):
        self.segments, self._is_opaque = None, opacity == 1.0
        self._rays = coloured_actor(in_front=in_front, is_opaque=self._is_opaque and not in_front)
        self._rays.GetProperty().SetLineWidth(width)
        self._hits = coloured_actor(in_front=in_front)
        self._hits.GetProperty().SetPointSize(HIT_SIZE)
        self._hits.GetProperty().RenderPointsAsSpheresOn()
        for actor, kind in ((self._rays, "rays"), (self._hits, "hits")):
            actor.GetProperty().SetOpacity(opacity)
            actor.VisibilityOff()
            plotter.add_actor(actor, name=f"{name} {kind}", reset_camera=False, pickable=False, render=False)

    def show(self, segments, rgb, *, hit_rgb=None) -> None:
        """Replaces the rays; rgb: u8 [S, 3] of segments, hit_rgb: u8 [K, 3] of hits, None: hits are not shown."""
        if segments is not self.segments:
            self.segments = segments
            self._kept = self._drawn(segments.num_segments, 0.0)
            self._lines = loose_lines_of(segments.points, segments.ends[self._kept])
        self.recolour(rgb)
        self._rays.GetMapper().SetInputDataObject(self._lines)
        self._rays.SetVisibility(segments.num_segments > 0)
        self._show_hits(segments, hit_rgb)

    def recolour(self, rgb) -> None:
        """Other colours for the same rays."""
        self._rgb = np.asarray(rgb)
        set_segment_colours(self._lines, self._rgb[self._kept])

    def show_first(self, num_rays: int | None, cell: float = 0.0) -> None:
        """Draws only the first rays, None: all; for as long as the camera moves.

        cell: m, segments whose ends are no farther apart along any axis may be drawn once
        """
        lines = self._lines
        if num_rays is not None:
            kept = self._drawn(self.segments.num_segments_of(num_rays), cell)
            lines = loose_lines_of(self.segments.points, self.segments.ends[kept])
            set_segment_colours(lines, self._rgb[kept])
        self._rays.GetMapper().SetInputDataObject(lines)

    def nearest(self, origin, ahead) -> float:
        """Smallest distance in m of any point of the rays from the plane through an origin [3], along its normal [3]: less than 0
        where some lie behind it, inf without rays."""
        if self.segments is None or not self._rays.GetVisibility():
            return np.inf
        points = self.segments.points
        return float(np.fmin.reduce(points @ np.asarray(ahead, points.dtype), initial=np.inf)) - float(np.dot(origin, ahead))

    def _drawn(self, count: int, cell: float):
        """Which of the first segments."""
        if not self._is_opaque:
            return np.arange(count)
        return first_of_each(self.segments.points, self.segments.ends[:count], cell)

    def _show_hits(self, segments, hit_rgb) -> None:
        is_shown = hit_rgb is not None and len(segments.hits) > 0
        self._hits.SetVisibility(is_shown)
        if is_shown:
            points = vertices_of(segments.points[segments.hits])
            set_point_colours(points, np.broadcast_to(hit_rgb, (len(segments.hits), 3)))
            self._hits.GetMapper().SetInputDataObject(points)
