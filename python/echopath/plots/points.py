"""Detections as points, in the plane of the map or seen from above."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import choice, text
from ..base.text.counts import counted
from .style import (
    AHEAD_LABEL,
    LEFT_LABEL,
    RANGE_LABEL,
    VELOCITY_LABEL,
    axes_or_new,
    part_colours,
    require_drawable,
    to_one_scale,
)

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes
    from ..detections.detections import Detections

VIEWS = ("range_doppler", "above")
LABELS = {"range_doppler": (RANGE_LABEL, VELOCITY_LABEL), "above": (LEFT_LABEL, AHEAD_LABEL)}
MOST_NAMES, FEW_NAMES = 14, 5  # in the legend beside the axes and within them; the rest are "other objects"
SIZES = 10.0, 70.0      # points^2, of the weakest and the strongest
SPAN_DB = 40.0          # of the sizes, below the strongest
NOISE_LOOK = {"marker": "x", "color": "0.55", "linewidths": 0.8}
RING, RIM = 1.3, 0.4    # points, width of the ring of a ghost, and on either side of what sets it off from the colours of a map
SURROUNDINGS = "surroundings"
REST_COLOURS = {SURROUNDINGS: "0.45", "other objects": "0.75", "other": "0.45", "noise": "0.55"}
BESIDE = {"loc": "center left", "bbox_to_anchor": (1.01, 0.5), "frameon": False}


def draw_detections(detections: Detections, *, view: str = "range_doppler", ax: Axes | None = None, title: str = "") -> Axes:
    """A point for each detection, coloured by the object whose echo it is, larger where it is stronger, hollow for ghosts.

    detections: Detections; title: above the axes, "": that of axes with a title, else how many there are
    view: "range_doppler", or "above" (needs azimuths); ax: axes to draw in, None: new ones
    Returns the axes: range in m and radial velocity in m/s, or metres to the left and ahead in the radar's frame.
    Raises TypeError naming detections, ValueError for other views, for a view from above without azimuths, and for axes
    that hold another picture than that of the view.
    """
    require_drawable("detections", "Detections, as frame.detections are", detections, "points", "ghost_type")
    choice(*VIEWS)("view", view)
    if view == "above" and len(detections) and not np.isfinite(detections.azimuth).any():
        raise ValueError("view: 'above' needs azimuths, which the antennas of these detections cannot tell")
    is_given = ax is not None
    with axes_or_new(ax, *((7.6, 4.6) if view == "range_doppler" else (6.6, 5.4)), LABELS[view]) as ax:
        draw_points(ax, detections, view, has_room=not is_given)
        across, up = LABELS[view]
        ax.set(xlabel=across, ylabel=up, title=text("title", title) or ax.get_title() or counted(len(detections), "detection"))
        if view == "above":
            to_one_scale(ax)
        ax.grid(alpha=0.25)
    return ax


def draw_points(ax, detections, view="range_doppler", *, has_room: bool, **look) -> None:
    """The points and their legend; has_room: beside the axes, for a long one; look: keywords of Axes.scatter."""
    from matplotlib.patheffects import withStroke

    rim = [withStroke(linewidth=RING + 2.0 * RIM, foreground="white")]
    x, y = (detections.points[:, 1], detections.points[:, 0]) if view == "above" else (detections.range, detections.velocity)
    names, sizes = _names(detections, MOST_NAMES if has_room else FEW_NAMES), _sizes(detections.power)
    is_shown = np.isfinite(x) & np.isfinite(y)
    for name, colour in _colours(names).items():
        of_name = (names == name) & is_shown
        filled = {"color": colour, "edgecolors": "white", "linewidths": RIM} | look
        ring = {"facecolors": "none", "edgecolors": [colour], "linewidths": RING, "path_effects": rim}
        label = f"{name}: {np.count_nonzero(of_name)}"
        for is_ghost, shown in ((False, NOISE_LOOK if name == "noise" else filled), (True, ring)):
            taken = of_name & ((detections.ghost_type > 0) == is_ghost)
            if taken.any():
                ax.scatter(x[taken], y[taken], s=sizes[taken], label=label, zorder=3, **shown)
                label = None  # once
    if is_shown.any():
        rings = "\n(rings: ghosts)" if (detections.ghost_type[is_shown] > 0).any() else ""
        ax.legend(title=f"Whose echo: how many{rings}", alignment="left", **(BESIDE if has_room else {}))


def _names(detections, most: int):
    """Whose echo each detection is: the object, else the part, else the surroundings; the rare ones are other objects."""
    named = np.where(detections.object != "", detections.object, detections.part).astype(object)
    named[named == ""] = SURROUNDINGS if (detections.object != "").any() else "detections"
    named[detections.is_noise] = "noise"
    found, counts = np.unique(named[~detections.is_noise & (named != SURROUNDINGS)].astype(str), return_counts=True)
    rare = found[np.argsort(-counts, kind="stable")[most:]]
    named[np.isin(named.astype(str), rare) & ~detections.is_noise] = "other objects"
    return named


def _colours(names) -> dict:
    """{name: colour}; objects in the order of their names, then what is none."""
    rest = {name: colour for name, colour in REST_COLOURS.items() if name in names}
    own = sorted(set(names) - set(rest))
    return dict(zip(own, part_colours(own))) | rest


def _sizes(power):
    level = 10.0 * np.log10(np.maximum(power, 1e-300))
    share = np.clip(1.0 + (level - level.max(initial=-np.inf)) / SPAN_DB, 0.0, 1.0) if len(level) else level
    return SIZES[0] + (SIZES[1] - SIZES[0]) * share
