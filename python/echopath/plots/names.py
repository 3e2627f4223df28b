"""Names of things in pictures from above."""
from __future__ import annotations

import itertools

import numpy as np

NAME_ASIDE, NAME_SIZE = 5.0, 7.0  # points, from a place to its name, and of its letters
NAME_LETTER, NAME_LINE = 4.5, 9.0  # points, about, of the names
FEW = 12             # names, of which one may stand lines away from its place; among more it could be taken for that of another
LINES_AWAY, UP, RIGHT = (1.0, 2.0, 3.0), (1.0, -1.0), (1.0, -1.0)  # where a name may stand, in this order
NAME_RIM = 2.5       # points, white around names


class Room:
    """Which spans of a picture names have taken, so that none is written over another."""

    def __init__(self, line: float):
        """line: height of names, in the unit of all places"""
        self._line, self._taken = line, []  # taken: (leftmost, rightmost, height)

    def take(self, left: float, right: float, height: float) -> bool:
        """Whether nothing stands there yet; it is taken from then on."""
        is_free = all(right <= first or last <= left or abs(height - other) >= self._line for first, last, other in self._taken)
        if is_free:
            self._taken.append((left, right, height))
        return is_free


def write_names(ax, places) -> None:
    """Names beside their places, on the other side or below where they would be over another name; few also some lines away. One
    that finds no room is left out.

    ax: of one scale for both directions, left on the left, whose limits are set; places: pairs of a name and (left, ahead) in m,
        those first that are to find room
    """
    from matplotlib.patheffects import withStroke

    places = list(places)
    tried = list(itertools.product(LINES_AWAY if len(places) <= FEW else LINES_AWAY[:1], UP, RIGHT))
    scale, room = _points_per_metre(ax), Room(NAME_LINE)
    for name, (left, ahead) in places:
        for line, up, side in tried:
            begin, end = sorted(-left * scale + side * np.array([NAME_ASIDE, NAME_ASIDE + NAME_LETTER * len(name)]))
            away = up * (NAME_ASIDE + (line - 1.0) * NAME_LINE)
            if room.take(begin, end, ahead * scale + away + 0.5 * up * NAME_SIZE):
                break
        else:
            continue
        ax.annotate(name, (left, ahead), xytext=(side * NAME_ASIDE, away), textcoords="offset points",
                    color="0.1", fontsize=NAME_SIZE, horizontalalignment="left" if side > 0.0 else "right",
                    verticalalignment="bottom" if up > 0.0 else "top",
                    path_effects=[withStroke(linewidth=NAME_RIM, foreground="white")])


def _points_per_metre(ax) -> float:
    """Of axes that show as many on both, once they are drawn."""
    extent = ax.get_window_extent()
    return 72.0 / ax.figure.dpi * min(extent.width / np.ptp(ax.get_xlim()), extent.height / np.ptp(ax.get_ylim()))
