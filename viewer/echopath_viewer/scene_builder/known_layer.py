"""Detections and true boxes in the scene."""
from __future__ import annotations

import numpy as np

from ..model.maps.layers import BOX_EDGES, DETECTIONS, TRUTH, detection_rgb
from .polydata import coloured_actor, lines_of, set_point_colours, vertices_of

POINT_SIZE, BOX_WIDTH = 9.0, 1.8  # pixels
BOX_RGB = (0, 158, 115)


class KnownLayer:
    """Points where detections are, by object, and the oriented boxes of objects with their names."""

    def __init__(self, plotter, set_names):
        """set_names: callable (layer, points [N, 3] m, texts)"""
        self._set_names = set_names
        self._points, self._boxes = (coloured_actor(in_front=True) for _ in range(2))
        self._points.GetProperty().SetPointSize(POINT_SIZE)
        self._points.GetProperty().RenderPointsAsSpheresOn()
        self._boxes.GetProperty().SetLineWidth(BOX_WIDTH)
        for actor, kind in ((self._points, "detections"), (self._boxes, "boxes")):
            actor.VisibilityOff()
            plotter.add_actor(actor, name=f"known {kind}", reset_camera=False, pickable=False, render=False)

    def show(self, session) -> None:
        """What the session has switched on; detections without directions have no place in the scene."""
        self._show_points(session if DETECTIONS in session.layers else None)
        self._show_boxes(session.known_data(TRUTH) if TRUTH in session.layers else None)

    def _show_points(self, session) -> None:
        self._points.VisibilityOff()
        if session is None:
            return
        detections = session.known_data(DETECTIONS)
        points = np.asarray(detections.points)
        known = np.flatnonzero(np.isfinite(points).all(axis=1))
        if not len(known):
            return
        world = np.asarray(session.radar.world_from_radar(session.paths.frame.trace_time))
        poly = vertices_of(points[known] @ world[:3, :3].T + world[:3, 3])
        colours = session.object_colours()
        set_point_colours(poly, [detection_rgb(detections, index, colours) for index in known])
        self._points.GetMapper().SetInputDataObject(poly)
        self._points.VisibilityOn()

    def _show_boxes(self, truth) -> None:
        self._boxes.VisibilityOff()
        if truth is None or not len(truth.name):
            self._set_names("boxes", [], [])
            return
        corners = truth.corners
        self._set_names("boxes", corners.max(axis=1), [str(name) for name in truth.name])
        edges = (BOX_EDGES[None] + 8 * np.arange(len(corners))[:, None, None]).reshape(-1, 2)
        poly = lines_of(corners.reshape(-1, 3), edges)
        set_point_colours(poly, np.broadcast_to(np.uint8(BOX_RGB), (poly.n_points, 3)))
        self._boxes.GetMapper().SetInputDataObject(poly)
        self._boxes.VisibilityOn()
