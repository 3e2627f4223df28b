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
    rows = _rows_of_names(truth)
    centres, ways = _centres(truth, view), _ways(truth, view)
    with axes_or_new(ax, *SIZE, LABELS[view]) as ax:
        _draw_lines(ax, [centres[own, 1::-1] for own in rows.values()], "-", 0.6)
        _draw_boxes(ax, truth, view)
        for begin, along in zip(centres, ways):
            if np.hypot(*along[:2]) > SHORTEST:
                _draw_arrow(ax, begin[1::-1], (begin + along)[1::-1])
        ax.update_datalim(np.stack([centres + ways, centres])[..., 1::-1].reshape(-1, 2))
        ax.autoscale_view()
        across, up = LABELS[view]
        ax.set(xlabel=across, ylabel=up, title=text("title", title) or ax.get_title() or _title(truth, len(rows), view))
        to_one_scale(ax)
        write_names(ax, [(short_name(name), centres[rows[name][-1], 1::-1]) for name in _named(truth, rows)])
        ax.grid(alpha=0.25)
    return ax


def _rows_of_names(truth) -> dict:
    """{name: its rows}, in the order in which names come first."""
    found: dict = {}
    for row, name in enumerate(truth.name.tolist()):
        found.setdefault(name, []).append(row)
    return found


def _named(truth, rows: dict) -> list:
    """The names that may be written: those of which the radar sees most, in this order."""
    share = {name: truth.visible_share[own].max() for name, own in rows.items()}
    return sorted(rows, key=share.get, reverse=True)[:MOST_NAMES]


def _centres(truth, view: str) -> np.ndarray:
    return truth.position_in_radar if view == "radar" else truth.position


def _draw_boxes(ax, truth, view: str) -> None:
    """Lower and upper faces, dashed of what nothing is seen of."""
    corners = truth.corners_in_radar if view == "radar" else truth.corners
    for style, is_drawn in (("-", truth.visible_share > 0.0), ("--", ~(truth.visible_share > 0.0))):
        _draw_lines(ax, corners[is_drawn][:, FACES, 1::-1].reshape(-1, len(FACES[0]), 2), style, 1.0)


def _draw_lines(ax, lines, style: str, width: float) -> None:
    """Lines of points [N, 2] of a style and a width in points, above white ones."""
    from matplotlib.collections import LineCollection

    ax.add_collection(LineCollection(lines, colors="white", linewidths=RIM, zorder=RIMS), autolim=False)
    ax.add_collection(LineCollection(lines, colors=COLOUR, linewidths=width, linestyles=style, zorder=LINES))


def _draw_arrow(ax, begin, end) -> None:
    from matplotlib.patches import FancyArrowPatch

    shape = {"arrowstyle": "->", "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": HEAD}
    ax.add_artist(FancyArrowPatch(begin, end, color="white", linewidth=RIM, zorder=RIMS, **shape))
    ax.annotate("", end, begin, annotation_clip=False, arrowprops={"color": COLOUR, **shape})


def _title(truth, num_objects: int, view: str) -> str:
    arrows = np.any(np.hypot(*_ways(truth, view)[:, :2].T) > SHORTEST)
    dashes = np.any(truth.visible_share == 0.0)
    return "; ".join([counted(num_objects, "object"), *["arrows: ways of a second"] * bool(arrows),
                      *["dashed: the radar sees nothing of it"] * bool(dashes)])


def _ways(truth, view: str) -> np.ndarray:
    """Ways [N, 3] in m over ground, 0 where they are not known."""
    if view == "world":
        return WAY * truth.velocity
    return WAY * np.nan_to_num(np.linalg.norm(truth.velocity, axis=1, keepdims=True) * truth.direction_in_radar)
