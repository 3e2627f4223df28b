"""Names of objects and mirrors in a view of a scene, of which none is written over another."""
from __future__ import annotations

import itertools

import numpy as np

from ..names import Room
from ..style import short_name
from .drawing import Drawing

RADAR_LABEL = "radar"
MOST_NAMES = 20                         # objects, and mirrors, that bear their names in a picture; more would hide each other
FEW_NAMES = 12                          # as many all find room
MOST_RAISED = 3                         # lines that one of more stands above its object at most: farther up it is of none
MIRROR_LINES = 3                        # where the name of a mirror may stand, one above the other
NAME_LOOK = {"fontsize": 7, "color": "0.25"}
MIRROR_NAME_LOOK = {"fontsize": 7, "color": "#33507a"}
LETTER, LINE_HEIGHT = 0.6 * NAME_LOOK["fontsize"], 1.2 * NAME_LOOK["fontsize"]  # points, of a name
POINTS_PER_INCH = 72.0


class ViewRoom:
    """Where the names of a view stand, of which none is written over another."""

    def __init__(self, axes):
        self._axes, self._room = axes, Room(LINE_HEIGHT)  # in points of the page
        self._scale = POINTS_PER_INCH / axes.figure.dpi

    def points(self, place) -> np.ndarray:
        """A place [2] in the coordinates of the axes, in points of the page."""
        return self._axes.transData.transform(place) * self._scale

    def line_of(self, name: str, place, offset, share: float = 0.5, lines=(0,)) -> int | None:
        """The first of `lines` by which a name may be raised, which then is taken; None where none is free.

        offset: [2] points from the place to the name; share: of its length that stands to the left of there
        """
        (across, height), length = self.points(place) + offset, LETTER * (len(short_name(name)) + 1)
        left, right = across - share * length, across + (1.0 - share) * length
        return next((k for k in lines if self._room.take(left, right, height + k * LINE_HEIGHT)), None)

    def below_top(self, place) -> float:
        """How far below the upper end of the axes a place [2] is, in points."""
        return (self._axes.transAxes.transform((0.0, 1.0)) - self._axes.transData.transform(place))[1] * self._scale


def lines_of(room: ViewRoom, places: dict, offset) -> dict:
    """{name: by how many lines it is raised}: all of few, from the lowest on; of many the first ones that find room.

    places: {name: place [2] of its object in the coordinates of the axes}; offset: as of `ViewRoom.line_of`
    """
    is_few, raised = len(places) <= FEW_NAMES, {}
    for name in sorted(places, key=lambda name: room.points(places[name])[1]) if is_few else places:
        line = room.line_of(name, places[name], offset, lines=itertools.count() if is_few else range(MOST_RAISED + 1))
        if line is not None:
            raised[name] = line
        if len(raised) == MOST_NAMES:
            break
    return raised


def halo() -> list:
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=2.0, foreground="white")]


def named_mirrors(drawing: Drawing) -> dict:
    """Those of the largest."""
    largest = sorted(drawing.mirror_names.items(), key=lambda one: -np.linalg.norm(np.subtract(*one[1])))
    return dict(largest[:MOST_NAMES])
