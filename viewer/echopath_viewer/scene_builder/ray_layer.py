"""One bundle of rays."""
from __future__ import annotations

import numpy as np

from .polydata import (actor_in_cell_colours, actor_in_segment_colours, loose_lines_of, set_cell_colours, set_segment_colours,
                       vertices_of)

HIT_SIZE = 5.0  # pixels


class RayLayer:
    """Rays as coloured segments, with their hit points on demand; while the camera moves only the first ones."""

    def __init__(self, plotter, name: str, *, width: float, in_front: bool = False, opacity: float = 1.0):
        self.segments = None
        self._rays = actor_in_segment_colours(in_front=in_front, is_opaque=opacity == 1.0 and not in_front)
        self._rays.GetProperty().SetLineWidth(width)
        self._hits = actor_in_cell_colours(in_front=in_front)
        self._hits.GetProperty().SetPointSize(HIT_SIZE)
        self._hits.GetProperty().RenderPointsAsSpheresOn()
        for actor, kind in ((self._rays, "rays"), (self._hits, "hits")):
            actor.GetProperty().SetOpacity(opacity)
            actor.VisibilityOff()
            plotter.add_actor(actor, name=f"{name} {kind}", reset_camera=False, pickable=False, render=False)

    def show(self, segments, rgb, *, hit_rgb=None) -> None:
        """Replaces the rays; rgb: u8 [S, 3] of segments, hit_rgb: u8 [K, 3] of hits, None: hits are not shown."""
        if segments is not self.segments:
            self.segments, self._lines = segments, loose_lines_of(segments.points, segments.ends)
        self.recolour(rgb)
        self._rays.GetMapper().SetInputDataObject(self._lines)
        self._rays.SetVisibility(segments.num_segments > 0)
        self._show_hits(segments, hit_rgb)

    def recolour(self, rgb) -> None:
        """Other colours for the same rays."""
        self._rgb = rgb
        set_segment_colours(self._lines, rgb)

    def show_first(self, num_rays: int | None) -> None:
        """Draws only the first rays, None: all; for as long as the camera moves."""
        lines = self._lines
        if num_rays is not None:
            count = self.segments.num_segments_of(num_rays)
            lines = loose_lines_of(self.segments.points, self.segments.ends[:count])
            set_segment_colours(lines, self._rgb[:count])
        self._rays.GetMapper().SetInputDataObject(lines)

    def _show_hits(self, segments, hit_rgb) -> None:
        is_shown = hit_rgb is not None and len(segments.hits) > 0
        self._hits.SetVisibility(is_shown)
        if is_shown:
            points = vertices_of(segments.points[segments.hits])
            set_cell_colours(points, np.broadcast_to(hit_rgb, (len(segments.hits), 3)))
            self._hits.GetMapper().SetInputDataObject(points)
