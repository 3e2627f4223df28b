"""Names of things in pictures from above."""
from __future__ import annotations

import numpy as np

NAME_ASIDE, NAME_SIZE = 5.0, 7.0  # points, from a place to its name, and of its letters
NAME_LETTER, NAME_LINE = 4.5, 9.0  # points, about, of the names
CORNERS = (1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)  # to the right of a place and up, where its name may stand
NAME_RIM = 2.5       # points, white around names


def write_names(ax, places) -> None:
    """Names beside their places, on the other side or below where they would be over another name.

    ax: of one scale for both directions, left on the left, whose limits are set; places: pairs of a name and (left, ahead) in m
    """
    from matplotlib.patheffects import withStroke

    scale, taken = _points_per_metre(ax), []  # (leftmost, rightmost, height) of the names so far, points
    for name, (left, ahead) in places:
        for side, height in CORNERS:
            begin, end = sorted(-left * scale + side * np.array([NAME_ASIDE, NAME_ASIDE + NAME_LETTER * len(name)]))
            level = ahead * scale + height * (NAME_ASIDE + 0.5 * NAME_SIZE)
            if all(right <= begin or end <= first or abs(other - level) >= NAME_LINE for first, right, other in taken):
                break
        taken.append((begin, end, level))
        ax.annotate(name, (left, ahead), xytext=(side * NAME_ASIDE, height * NAME_ASIDE), textcoords="offset points",
                    color="0.1", fontsize=NAME_SIZE, horizontalalignment="left" if side > 0.0 else "right",
                    verticalalignment="bottom" if height > 0.0 else "top",
                    path_effects=[withStroke(linewidth=NAME_RIM, foreground="white")])


def _points_per_metre(ax) -> float:
    """Of axes that show as many on both, once they are drawn."""
    extent = ax.get_window_extent()
    return 72.0 / ax.figure.dpi * min(extent.width / np.ptp(ax.get_xlim()), extent.height / np.ptp(ax.get_ylim()))
