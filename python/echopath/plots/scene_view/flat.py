"""Views of a scene along an axis: from above and from the side."""
from __future__ import annotations

import numpy as np

from ..style import short_name
from .drawing import CUT, Drawing, on_grounds
from .looks import DASHES, MIRROR_COLOUR, TITLE_PAD, colour_of, counted, of_equal_length, ray_opacity, set_ticks
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

EDGE_ON = 1e-3                          # area over the square of the length, below which a polygon is drawn as a line
FLAT_TICKS = 30.0, 13.0                 # points, that numbers need across and up, on axes of flat views of the size FLAT_SIZE
FLAT_SIZE = 310.0, 160.0                # points, about


def draw_flat(axes, drawing: Drawing, plane: tuple, title: str) -> None:
    """The scene along an axis: mirrors below the rays, bodies above them."""
    from matplotlib.collections import LineCollection, PolyCollection

    columns = list(plane)
    depth = ({0, 1, 2} - set(plane)).pop()
    mirrors = [polygon[:, columns] for polygon in drawing.mirrors]
    axes.add_collection(PolyCollection(mirrors, facecolors=(*MIRROR_COLOUR, 0.15), edgecolors="none"), autolim=False)
    for edges, style in ((drawing.mirror_edges, "-"), (drawing.mirror_cuts, DASHES)):
        axes.add_collection(LineCollection([edge[:, columns] for edge in edges], colors=MIRROR_COLOUR, linewidths=0.8,
                                           linestyles=[style]), autolim=False)
    for count, segments in reversed(drawing.segments.items()):
        axes.add_collection(LineCollection(segments[:, :, columns], colors=colour_of(count), linewidths=0.5,
                                           alpha=ray_opacity(segments)), autolim=False)
    toward_viewer = 1.0 if depth == 2 else -1.0
    order = np.argsort(toward_viewer * _middles(drawing.bodies, depth), kind="stable")
    if depth == 2:  # the middle of a wide slope lies above what stands at its foot
        order = order[np.argsort(~np.isin(order, on_grounds(drawing)), kind="stable")]
    bodies = of_equal_length(drawing.bodies)[order][:, :, columns]
    axes.add_collection(PolyCollection(bodies, facecolors=np.reshape(drawing.body_colours, (-1, 4))[order], edgecolors="face",
                                       linewidths=np.where(_is_edge_on(bodies), 0.8, 0.0)), autolim=False)
    axes.plot(*drawing.radar[columns], marker="s", color="black", markersize=4)
    axes.set_xlim(drawing.low[plane[0]], drawing.high[plane[0]])
    axes.set_ylim(drawing.low[plane[1]], drawing.high[plane[1]])
    axes.set_aspect("equal")
    axes.apply_aspect()
    sides = (drawing.high - drawing.low)[columns]
    for axis, side, room in zip((axes.xaxis, axes.yaxis), sides * min(FLAT_SIZE / sides), FLAT_TICKS):
        set_ticks(axis, int(side / room))
    axes.set_title(title, pad=TITLE_PAD)
    axes.set_xlabel("xyz"[plane[0]] + " in m")
    axes.set_ylabel("xyz"[plane[1]] + " in m")


def name_flat(axes, drawing: Drawing, plane: tuple) -> float:
    """Names of the radar, of mirrors that are seen as lines and, from above, of objects; from the side these would stand on each
    other. Returns how many points of them may stand above the axes."""
    def write(name: str, place, offset: tuple, ha: str, **look) -> None:
        axes.annotate(short_name(name), place, xytext=offset, textcoords="offset points", ha=ha, path_effects=halo(), **look)

    axes.apply_aspect()
    room = ViewRoom(axes)
    top = drawing.high[plane[1]] - 2.0 * drawing.margin  # the title is right above
    above = 0.0
    radar, is_high = drawing.radar[list(plane)], drawing.radar[plane[1]] > top
    aside = (6, -9) if is_high else (0, 5)
    write(RADAR_LABEL, radar, aside, "left" if is_high else "center", **NAME_LOOK)
    room.line_of(RADAR_LABEL, radar, aside, 0.0 if is_high else 0.5)
    tops = {name: (0.5 * (low[0] + high[0]), high[1]) for name, (low, high) in drawing.names.items()} if plane == (0, 1) else {}
    for name, line in lines_of(room, tops, (0, 3)).items():
        write(name, tops[name], (0, 3 + line * LINE_HEIGHT), "center", **NAME_LOOK)
        above = max(above, 3 + (1 + line) * LINE_HEIGHT - room.below_top(tops[name]))
    for name, (low, high) in named_mirrors(drawing).items():
        place, is_line = (low[plane[0]], high[plane[1]]), high[plane[1]] - low[plane[1]] < CUT
        line = room.line_of(name, place, (4, 2), 0.0, range(MIRROR_LINES)) if is_line else None
        if line is not None:
            write(name, place, (4, 2 + line * LINE_HEIGHT), "left", **MIRROR_NAME_LOOK)
            above = max(above, 2 + (1 + line) * LINE_HEIGHT - room.below_top(place))
    return above


def _is_edge_on(polygons) -> np.ndarray:
    """Whether polygons [N, K, 2] are seen as lines [N], which fill nothing, as an upright wall from above."""
    x, y = np.moveaxis(polygons - polygons[:, :1], 2, 0)
    area = 0.5 * np.abs((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1))
    return area <= EDGE_ON * np.ptp(polygons, axis=1).max(axis=1) ** 2


def _middles(polygons, axis: int) -> np.ndarray:
    """Mean of the corners of each polygon along an axis [N]."""
    if not polygons:
        return np.empty(0)
    counts, starts = counted(polygons)
    return np.add.reduceat(np.concatenate(polygons)[:, axis], starts) / counts
