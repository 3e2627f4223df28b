"""The view of a scene in perspective."""
from __future__ import annotations

import numpy as np

from ..style import short_name
from .drawing import CUT, Drawing, above_ground, grounds
from .looks import DASHES, MIRROR_COLOUR, colour_of, of_equal_length, ray_opacity, set_ticks
from .view_names import (
    LINE_HEIGHT,
    MIRROR_LINES,
    MIRROR_NAME_LOOK,
    NAME_LOOK,
    RADAR_LABEL,
    ViewRoom,
    halo,
    lines_of,
    named_mirrors,
)

ELEVATION, AZIMUTH = 22.0, -118.0       # degrees, of the eye
WIDE = 2.2                              # width of the view in perspective over its height
FILLED, MOST_ZOOM = 0.72, 1.75          # share of the height that a scene fills; the rest is for the labels of the axes
NEARER = 0.35                           # how much larger the perspective draws the near end of a scene that is all depth
RADAR_ASIDE = -10.0, 0.0                # points, in perspective, from the radar to its name
NAME_PLACE = 0.93                       # along x of a mirror, where its name stands
TICK_SPACE = 0.06                       # of the longest axis that perspective draws: room that a number on an axis needs
SHORTEST_AXIS = 0.03                    # likewise: shorter axes bear no numbers, which flat views tell
LABEL_SPACE, OWN_PAD = 34.0, 21.0       # points from an axis of a cube to its label, of which Matplotlib adds the second itself
NUMBER_SPACE, OWN_NUMBER_PAD = 11.5, 8.0  # likewise to its numbers
THIN = 0.16                             # of the longest side: beside thinner ones labels and numbers stay as far from an axis


def draw_perspective(axes, drawing: Drawing) -> None:
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    def add(kind, items, order: int, **look) -> None:
        if len(items):  # matplotlib fails on empty 3-D collections
            axes.add_collection3d(kind(items, zorder=order, clip_on=False, **look))

    def add_bodies(order: int, chosen) -> None:
        add(Poly3DCollection, of_equal_length([drawing.bodies[k] for k in chosen]), order,
            facecolors=np.array([drawing.body_colours[k] for k in chosen]), edgecolors="none")

    add(Poly3DCollection, drawing.mirrors, 1, facecolors=(*MIRROR_COLOUR, 0.25), edgecolors="none")
    add(Line3DCollection, drawing.mirror_edges, 1, colors=(*MIRROR_COLOUR, 0.9), linewidths=0.7)
    add(Line3DCollection, drawing.mirror_cuts, 1, colors=(*MIRROR_COLOUR, 0.9), linewidths=0.7, linestyles=[DASHES])
    # Matplotlib sorts polygons by their middles, by which a wide ground would hide what stands on its farther half.
    for ground in grounds(drawing):
        add_bodies(1, ground)
    for count, segments in reversed(drawing.segments.items()):
        add(Line3DCollection, segments, 2, colors=colour_of(count), linewidths=0.6, alpha=ray_opacity(segments))
    add_bodies(3, above_ground(drawing))
    # Matplotlib lays figures out before it projects: it would take the coordinates in m for a place on the page.
    axes.plot(*drawing.radar[:, None], marker="s", color="black", markersize=5, zorder=4, clip_on=False, in_layout=False)
    axes.text(*drawing.radar, f"{RADAR_LABEL}   ", zorder=5, horizontalalignment="right")
    _frame_box(axes, drawing)


def name_in_perspective(axes, drawing: Drawing) -> None:
    """Names right above objects, lines higher where others stand, and on mirrors that have room. axes: as large as drawn"""
    from mpl_toolkits.mplot3d.proj3d import proj_transform

    axes.apply_aspect()
    room = ViewRoom(axes)

    def seen(place):
        return proj_transform(*place, axes.get_proj())[:2]

    room.line_of(RADAR_LABEL, seen(drawing.radar), RADAR_ASIDE, 1.0)
    tops = {name: (*0.5 * (low + high)[:2], high[2]) for name, (low, high) in drawing.names.items()}
    for name, line in lines_of(room, {name: seen(top) for name, top in tops.items()}, (0.0, LINE_HEIGHT)).items():
        axes.text(*tops[name], short_name(name) + "\n" * (1 + line), zorder=5, horizontalalignment="center",
                  verticalalignment="baseline", path_effects=halo(), **NAME_LOOK)
    for name, (low, high) in named_mirrors(drawing).items():
        is_floor = high[2] - low[2] < CUT
        place = low[0] + NAME_PLACE * (high[0] - low[0]), low[1] if is_floor else 0.5 * (low + high)[1], high[2]
        line = room.line_of(name, seen(place), (0.0, 0.0), lines=range(MIRROR_LINES))
        if line is not None:
            axes.text(*place, short_name(name) + "\n" * line, zorder=5, horizontalalignment="center",
                      verticalalignment="baseline", path_effects=halo(), **MIRROR_NAME_LOOK)


def _zoom(sides) -> float:
    """How large a box of those sides [3] may be drawn: flat ones larger than high ones, whose labels would leave the axes.

    Matplotlib draws all boxes of one diagonal alike at zoom 1, so that each fits from everywhere.
    """
    elevation, azimuth = np.radians((ELEVATION, AZIMUTH))
    across = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    upward = np.array([-np.sin(elevation) * np.cos(azimuth), -np.sin(elevation) * np.sin(azimuth), np.cos(elevation)])
    diagonal, width, height = np.linalg.norm(sides), np.abs(across) @ sides, np.abs(upward) @ sides
    depth = np.abs(np.cross(across, upward)) @ sides
    filled = FILLED / (1.0 + NEARER * depth / diagonal)
    return float(min(MOST_ZOOM, filled * diagonal / height, filled * WIDE * diagonal / width))


def _frame_box(axes, drawing: Drawing) -> None:
    axes.set_xlim(drawing.low[0], drawing.high[0])
    axes.set_ylim(drawing.low[1], drawing.high[1])
    axes.set_zlim(drawing.low[2], drawing.high[2])
    sides = drawing.high - drawing.low
    zoom = _zoom(sides)
    axes.set_box_aspect(sides, zoom=zoom)
    axes.view_init(elev=ELEVATION, azim=AZIMUTH)
    axes.set_xlabel("x in m")
    axes.set_ylabel("y in m")
    axes.set_zlabel("z in m")
    shares, drawn = sides / sides.max(), sides / np.linalg.norm(sides) * zoom / MOST_ZOOM
    for k, (axis, length) in enumerate(zip((axes.xaxis, axes.yaxis, axes.zaxis), drawn)):
        beside = np.delete(shares, k).max()  # pads count along the other two sides
        axis.labelpad = LABEL_SPACE * max(1.0 / np.sqrt(max(beside, THIN)), np.sqrt(THIN) / beside) - OWN_PAD
        axis.set_tick_params(pad=NUMBER_SPACE * max(1.0, THIN / beside) - OWN_NUMBER_PAD)
        set_ticks(axis, int(length / TICK_SPACE))
        if length < SHORTEST_AXIS:
            axis.set_ticks([])
            axis.label.set_visible(False)
        axis.pane.set_visible(False)
        axis._axinfo["grid"].update(color=(0.85, 0.85, 0.85), linewidth=0.4)
