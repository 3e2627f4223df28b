"""The antennas of a radar with their axes."""
from __future__ import annotations

import numpy as np

from ..model.antennas import world_from_antenna
from .polydata import coloured_actor, loose_lines_of, set_point_colours, set_segment_colours, vertices_of

AXIS_COLOURS = np.array([[204, 51, 17], [0, 136, 85], [0, 102, 204]], np.uint8)  # x (boresight), y, z
TRANSMITTER_COLOUR, RECEIVER_COLOUR, IDLE_COLOUR = (204, 51, 17), (0, 102, 204), (120, 120, 120)
DOT_SIZE, AXIS_WIDTH = 10.0, 2.5  # pixels


class AntennaLayer:
    """A dot and three axes for each antenna: x, the boresight, red; y green; z blue. Those of the channel are coloured."""

    def __init__(self, plotter, radar, size: float):
        """size: length of the axes in m."""
        self._radar, self._size = radar, size
        self._axes, self._dots = (coloured_actor(in_front=True) for _ in range(2))
        self._axes.GetProperty().SetLineWidth(AXIS_WIDTH)
        self._dots.GetProperty().SetPointSize(DOT_SIZE)
        self._dots.GetProperty().RenderPointsAsSpheresOn()
        for actor, kind in ((self._axes, "axes"), (self._dots, "dots")):
            plotter.add_actor(actor, name=f"antenna {kind}", reset_camera=False, pickable=False, render=False)

    def set_radar(self, radar) -> None:
        """Another one from now on."""
        self._radar = radar

    def show(self, time: float, tx: int, rx: int) -> None:
        """Puts the antennas where they are at a time in s."""
        frames = [world_from_antenna(self._radar, antenna, time) for antenna in self._antennas()]
        corners = [frame[:3, 3] + self._size * direction for frame in frames for direction in frame[:3, :3].T]
        origins = np.repeat([frame[:3, 3] for frame in frames], 3, axis=0)
        points = np.stack([origins, corners], axis=1).reshape(-1, 3)
        lines = loose_lines_of(points, np.arange(len(points)).reshape(-1, 2))
        set_segment_colours(lines, np.tile(AXIS_COLOURS, (len(frames), 1)))
        dots = vertices_of(origins[::3])
        set_point_colours(dots, self._dot_colours(tx, rx))
        self._axes.GetMapper().SetInputDataObject(lines)
        self._dots.GetMapper().SetInputDataObject(dots)

    def _antennas(self) -> list:
        return [*self._radar.transmitters, *self._radar.receivers]

    def _dot_colours(self, tx: int, rx: int):
        transmitters = [TRANSMITTER_COLOUR if index == tx else IDLE_COLOUR for index in range(len(self._radar.transmitters))]
        receivers = [RECEIVER_COLOUR if index == rx else IDLE_COLOUR for index in range(len(self._radar.receivers))]
        return np.array(transmitters + receivers, np.uint8)
