"""Objects as they truly are, seen from above: their boxes, their names and their ways."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import choice, text
from ..base.text.counts import counted
from .names import write_names
from .style import (
    AHEAD_LABEL,
    LEFT_LABEL,
    X_LABEL,
    Y_LABEL,
    axes_or_new,
    require_drawable,
    short_name,
    to_one_scale,
)

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes
    from ..truth import Truth

VIEWS = ("radar", "world")
SIZE = 6.6, 5.4      # inches
COLOUR = "0.25"      # of all: their names tell them apart, also over the colours of detections
RIM = 2.5            # points, white around what is dark: maps from above are dark themselves
RIMS, LINES = 2.0, 2.1  # orders of drawing: all rims lie below all lines, which they would cut into dashes where boxes overlap
HEAD = 10.0          # points, of arrows
WAY = 1.0            # s, whose way an arrow shows
SHORTEST = 0.1       # m, of arrows: what stands has none
MOST_NAMES = 30      # beside boxes, of those that the radar sees most of; more would hide one another
FACES = [0, 4, 6, 2, 0], [1, 5, 7, 3, 1]  # corners around the lower and the upper face: the last axis of a box runs fastest
LABELS = {"radar": (LEFT_LABEL, AHEAD_LABEL), "world": (Y_LABEL, X_LABEL)}


def draw_truth(truth: Truth, *, view: str = "radar", ax: Axes | None = None, title: str = "") -> Axes:
    """The box of each object from above, dashed where the radar sees nothing of it, and an arrow along its way of a second.

    Rows of several frames stand beside one another with a line through their centres, the last with the name of the object: of
    many objects those names that find room, the first ones of what the radar sees most of.
    truth: Truth; title: above the axes, "": that of axes with a title, else how many objects
    view: in the axes of the "radar", as `plot("above")` of detections is, or of the "world"; ax: axes to draw in, None: new ones
    Returns the axes: metres to the left across, left positive, and ahead up, of the radar or of the world. Raises TypeError
    naming truth or ax, ValueError for another view and for axes that hold a picture which is none from above.
    """
    require_drawable("truth", "a Truth, as frame.truth is", truth, "corners_in_radar", "visible_share")
    choice(*VIEWS)("view", view)
    names = list(dict.fromkeys(truth.name.tolist()))
    with axes_or_new(ax, *SIZE, LABELS[view]) as ax:
        for name in names:
            _draw_object(ax, truth.of_object(name), view)
        ax.autoscale_view()
        across, up = LABELS[view]
        ax.set(xlabel=across, ylabel=up, title=text("title", title) or ax.get_title() or _title(truth, names, view))
        to_one_scale(ax)
        write_names(ax, [(short_name(name), _centres(truth.of_object(name), view)[-1, 1::-1]) for name in _named(truth, names)])
        ax.grid(alpha=0.25)
    return ax


def _named(truth, names) -> list:
    """The names that may be written: those of which the radar sees most, in this order."""
    share = [truth.visible_share[truth.name == name].max() for name in names]
    return sorted(names, key=dict(zip(names, share)).get, reverse=True)[:MOST_NAMES]


def _centres(rows, view: str) -> np.ndarray:
    return rows.position_in_radar if view == "radar" else rows.position


def _draw_object(ax, rows, view: str) -> None:
    corners, centre = rows.corners_in_radar if view == "radar" else rows.corners, _centres(rows, view)
    way = _ways(rows, view)
    faces = [(box[face, 1::-1], "-" if share > 0.0 else "--", 1.0)
             for box, share in zip(corners, rows.visible_share) for face in FACES]
    _draw_lines(ax, [(centre[:, 1::-1], "-", 0.6), *faces])
    for middle, along in zip(centre, way):
        if np.hypot(*along[:2]) > SHORTEST:
            _draw_arrow(ax, middle[1::-1], (middle + along)[1::-1])
    ax.update_datalim(np.stack([centre + way, centre])[..., 1::-1].reshape(-1, 2))


def _draw_lines(ax, lines: list) -> None:
    """Lines of points [N, 2], each with its style and its width in points, above white ones."""
    from matplotlib.collections import LineCollection

    rims = LineCollection([points for points, *_ in lines], colors="white", linewidths=RIM, zorder=RIMS)
    ax.add_collection(rims, autolim=False)
    for points, style, width in lines:
        ax.plot(*points.T, style, linewidth=width, color=COLOUR, zorder=LINES)


def _draw_arrow(ax, begin, end) -> None:
    from matplotlib.patches import FancyArrowPatch

    shape = {"arrowstyle": "->", "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": HEAD}
    ax.add_artist(FancyArrowPatch(begin, end, color="white", linewidth=RIM, zorder=RIMS, **shape))
    ax.annotate("", end, begin, annotation_clip=False, arrowprops={"color": COLOUR, **shape})


def _title(truth, names, view: str) -> str:
    arrows = np.any(np.hypot(*_ways(truth, view)[:, :2].T) > SHORTEST)
    dashes = np.any(truth.visible_share == 0.0)
    return "; ".join([counted(len(names), "object"), *["arrows: ways of a second"] * bool(arrows),
                      *["dashed: the radar sees nothing of it"] * bool(dashes)])


def _ways(rows, view: str) -> np.ndarray:
    """Ways [N, 3] in m over ground, 0 where they are not known."""
    if view == "world":
        return WAY * rows.velocity
    return WAY * np.nan_to_num(np.linalg.norm(rows.velocity, axis=1, keepdims=True) * rows.direction_in_radar)
