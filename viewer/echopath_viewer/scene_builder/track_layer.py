"""Tracks of detections in the scene."""
from __future__ import annotations

import numpy as np

from ..model.palette import rgb_of, track_colour
from .polydata import coloured_actor, loose_lines_of, set_segment_colours

WIDTH = 3.0  # pixels


class TrackLayer:
    """Lines along which tracks went, each as high as its places are on the mean: between the head and the feet of who is tracked.
    Their colours are those of the strip."""

    def __init__(self, plotter):
        self._actor = coloured_actor(in_front=True)
        self._actor.GetProperty().SetLineWidth(WIDTH)
        self._actor.VisibilityOff()
        plotter.add_actor(self._actor, name="tracks", reset_camera=False, pickable=False, render=False)

    def show(self, tracks, places) -> None:
        """tracks: ep.Tracks in the world, or None; places: [N, 3] m, of its rows."""
        ends, colours = [], []
        points = None if tracks is None else np.array(places, float)
        for number in np.unique(tracks.track) if tracks is not None else []:
            rows = np.flatnonzero(tracks.track == number)
            points[rows, 2] = points[rows, 2].mean()
            ends += list(zip(rows[:-1], rows[1:]))
            colours += [rgb_of(track_colour(number))] * (len(rows) - 1)
        self._actor.SetVisibility(bool(ends))
        if ends:
            lines = loose_lines_of(points, np.array(ends))
            set_segment_colours(lines, np.array(colours, np.uint8))
            self._actor.GetMapper().SetInputDataObject(lines)
