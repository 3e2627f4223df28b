"""Labels of maps: cells by part, object and ghost."""
from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import choice
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..base.text.counts import counted
from ..paths.visibility import occluder_words
from ..signals.measures import for_pictures
from .maps import RANGE_MARGIN, VELOCITY_MARGIN, tick_single_cells
from .part_powers import draw_part_powers, require_powers
from .style import (
    AZIMUTH_LABEL,
    RANGE_LABEL,
    VELOCITY_LABEL,
    axes_or_new,
    cell_edges,
    new_figure,
    part_colours,
    require_drawable,
    short_name,
)

if TYPE_CHECKING:
    from .. import _core
    from ..base.classes.foreign_types import Axes, Figure
    from ..labels.labels import Labels

AZIMUTH_MARGIN = 4.0        # degrees
FILL = 0.45                  # opacity of a label over the map
MAX_UNSEEN, MAX_GHOSTS = 4, 14  # told one by one
FEWEST_ROWS = 8              # that there is room for, so that few bars stay thin
NAME_ASIDE, NAME_DEPTH = 14.0, 22.0  # points, from the peak of an object to its name
NAME_LETTER, NAME_LINE = 5.0, 14.0   # points, about, of the names
PEAK_LOOK = {"marker": "o", "linestyle": "none", "markerfacecolor": "none", "markeredgecolor": "white", "markersize": 7}
LEGEND_LINE = 13.0           # points, of the legend above the map
LEGEND_LETTERS = 72          # of a line of the legend
# Okabe and Ito: told apart with any colour vision.
CLASSES = {"real": ("the object itself", "#009e73"), 1: ("ghost, type 1: last bounce on the object", "#e69f00"),
           2: ("ghost, type 2: last bounce on a mirror", "#cc79a7")}


def plot_labels(labels: Labels, *, title: str = "Which part made each cell",
                powers: Mapping[str, _core.ReceivedPower] | None = None) -> Figure:
    """The map in grey, its cells coloured and outlined by the part that dominates, and the power of each part.

    labels: Labels; title: above the map; powers: {part: ep.ReceivedPower}, None: none are drawn
    Returns a matplotlib figure: range in m across, radial velocity in m/s (receding positive) or azimuth in degrees up.
    Raises TypeError naming labels or powers.
    """
    _require_labels(labels)
    if powers is not None:
        require_powers(powers)
    with new_figure(13.0 if powers else 9.0, 4.8) as figure:
        panels = figure.subfigures(1, 2 if powers else 1, squeeze=False, width_ratios=(2.3, 1.0) if powers else None)[0]
        _draw_map(panels[0], labels, _part_areas(labels), title)
        if powers:
            draw_part_powers(panels[1].subplots(), powers)
    return figure


def plot_ghosts(labels: Labels, *, title: str = "Objects and their ghosts") -> Figure:
    """Cells of objects and of their ghosts in the map, and the extent of each ghost with its class and its mirrors.

    labels: Labels; title: above the map. Returns a matplotlib figure; left as `plot_labels`, right a row for each object and
    each of the strongest ghosts: range in m, radial velocity in m/s or azimuth in degrees, power in dBm. Where none of them has
    a cell there is the map alone, which says so. Raises TypeError naming labels.
    """
    _require_labels(labels)
    rows = [label for label in labels.objects if label.peak is not None] + _strongest_ghosts(labels)
    if not rows:
        return _map_without_cells(labels, title)
    with new_figure(14.5, max(4.8, 1.6 + 0.27 * len(rows))) as figure:
        left, right = figure.subfigures(1, 2, width_ratios=(1.0, 1.35))
        _draw_map(left, labels, _class_areas(labels), title)
        _draw_extents(right.subplots(1, 2, sharey=True, width_ratios=(1.0, 1.0)), labels, rows)
    return figure


def _map_without_cells(labels, title: str) -> Figure:
    """The map of `plot_ghosts` of labels that give no cell to an object or a ghost."""
    with new_figure(9.0, 4.8) as figure:
        _draw_map(figure, labels, [], f"{title}: none has a cell of its own")
    return figure


def _require_labels(labels) -> None:
    """Raises unless they are labels of one partition, not those of a frame by partitions."""
    require_drawable("labels", "Labels, as frame.labels['parts'] is", labels, "part_names", "ghosts")


def draw_labels(labels: Labels, *, what: str = "parts", ax: Axes | None = None, title: str = "") -> Axes:
    """The map of `plot_labels` (what="parts") or of `plot_ghosts` ("objects") in given axes, or in new ones (None).

    labels: Labels; ax: axes to draw in; title: above them
    Returns the axes: range in m across, radial velocity in m/s or azimuth in degrees up. Raises ValueError for other words,
    TypeError naming `labels` or `ax`.
    """
    _require_labels(labels)
    areas_of = {"parts": _part_areas, "objects": _class_areas}
    choice(*areas_of)("what", what)
    with axes_or_new(ax, 9.0, 4.8, (RANGE_LABEL, _row_label(labels))) as ax:
        _draw_cells(ax, labels, areas_of[what](labels))
        ax.set_title(title, pad=_legend_height(ax))
    return ax


# --- maps ---

def _draw_map(figure, labels, areas: list, title: str) -> None:
    """The power of the whole in grey under areas (name, colour, bool [V, R]) of the mask; figure: for the map alone."""
    _draw_cells(figure.subplots(), labels, areas)
    figure.suptitle(title, fontsize=10)


def _draw_cells(axes, labels, areas: list) -> None:
    across, up = cell_edges(labels.range), cell_edges(_rows(labels))
    (bottom, top), (near, far) = _shown(labels)
    shown = labels.whole[bottom:top, near:far]
    level = in_dbm(shown, SMALLEST_POWER)
    image = axes.pcolormesh(across[near:far + 1], up[bottom:top + 1], level, cmap="gray", rasterized=True,
                            **_grey_limits(labels, shown))
    for name, colour, is_inside in areas:
        if is_inside.any():
            _draw_area(axes, across, up, is_inside, colour)
            words = f"{name}: {_cells(np.count_nonzero(is_inside))}"
            axes.fill_between([], [], color=colour, alpha=FILL + 0.2, label=words)
    axes.set(xlim=(across[near], across[far]), ylim=(up[bottom], up[top]))  # whole cells, be it one
    tick_single_cells(axes, labels.range, _rows(labels))
    axes.set_xlabel(f"{RANGE_LABEL}{_unseen(labels)}")
    axes.set_ylabel(_row_label(labels))
    if any(label.peak is not None for label in labels.objects):
        axes.plot([], [], **PEAK_LOOK | {"markeredgecolor": "0.25", "label": "strongest cell of an object"})
    words = axes.get_legend_handles_labels()[1]
    if words:
        columns = max(1, LEGEND_LETTERS // max(map(len, words)))
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, frameon=False, borderaxespad=0.2)
    axes.figure.colorbar(image, ax=axes, label="Power without noise in dBm", pad=0.01, aspect=30, extend="min")
    _name_objects(axes, labels)  # last: by the size of the axes, of which colour bars take some


def _draw_area(axes, across, up, is_inside, colour) -> None:
    """Fills and outlines the cells [V, R] where `is_inside`, along their edges: across [R + 1], up [V + 1]."""
    from matplotlib.collections import LineCollection, PolyCollection

    v, r = np.nonzero(is_inside)
    left, right, low, high = across[r], across[r + 1], up[v], up[v + 1]
    corners = np.stack([[left, low], [right, low], [right, high], [left, high]], -1)  # [2, N, 4]
    axes.add_collection(PolyCollection(corners.transpose(1, 2, 0), facecolors=[colour], edgecolors="none", alpha=FILL,
                                       rasterized=True), autolim=False)
    padded = np.pad(is_inside, 1)
    edges = []
    for side, (up, across) in enumerate(((-1, 0), (0, 1), (1, 0), (0, -1))):  # below, right, above, left: as the corners
        is_edge = ~padded[v + 1 + up, r + 1 + across]
        edges.append(corners[:, is_edge][:, :, [side, (side + 1) % 4]].transpose(1, 2, 0))
    axes.add_collection(LineCollection(np.concatenate(edges), colors=[colour], linewidths=0.7), autolim=False)


def _legend_height(axes) -> float:
    """Points that the title must stand higher, so that the legend above the map has its place."""
    legend = axes.get_legend()
    return 6.0 if legend is None else 8.0 + LEGEND_LINE * -(-len(legend.get_texts()) // legend._ncols)


def _part_areas(labels) -> list:
    """Cells of each part where it dominates."""
    colours = part_colours(labels.part_names)
    return [(name, colours[index], labels.dominant == index) for index, name in enumerate(labels.part_names)]


def _class_areas(labels) -> list:
    """Cells of all objects, and of their ghosts by type."""
    types = np.array([*(ghost.ghost_type for ghost in labels.ghosts), 0])  # the last one for cells of no ghost
    of_cell = types[labels.ghost_map]
    return [(*CLASSES["real"], labels.object_map >= 0), *((*CLASSES[kind], of_cell == kind) for kind in (1, 2))]


def _grey_limits(labels, shown) -> dict:
    """From the noise, or what the mask goes down to, up to the peak of what is shown, which may be far below that of leakage."""
    highest = float(in_dbm(shown.max(), SMALLEST_POWER))
    noise, weakest = (float(in_dbm(power, SMALLEST_POWER))
                      for power in (labels.noise_power, labels.whole[labels.mask].min(initial=np.inf)))
    if not shown.any():  # as of files that keep nothing outside of the mask: black, not white
        return {"vmin": noise, "vmax": noise + 10.0}
    lowest = max(noise, min(highest - min(labels.dynamic_range_db, 90.0), max(weakest, highest - 90.0)))
    return {"vmin": min(lowest, highest - 10.0), "vmax": highest}


def _name_objects(axes, labels) -> None:
    """A ring at the peak of each object, and its name aside of it where no other name stands."""
    extent, per_dot = axes.get_window_extent(), 72.0 / axes.figure.dpi
    width, height = extent.width * per_dot, extent.height * per_dot  # points
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    places = [(short_name(label.name), label.peak[0], _in_plot_units(labels, label.peak[1])) for label in labels.objects
              if label.peak is not None]
    places = [(name, distance, row, (distance - left) / (right - left) * width, (row - bottom) / (top - bottom) * height)
              for name, distance, row in places]
    taken = []  # (left, right, height) of the names so far, points
    for name, distance, row, across, level in sorted(places, key=lambda place: _outward(place[3], width)):
        length = NAME_LETTER * len(name)
        for side, depth in _asides(across, level, length, width):
            begin = across + (NAME_ASIDE if side > 0.0 else -NAME_ASIDE - length)
            if all(end <= begin or begin + length <= start or abs(other - (level - depth)) >= NAME_LINE
                   for start, end, other in taken):
                break
        taken.append((begin, begin + length, level - depth))
        _name_object(axes, name, distance, row, side, depth)


def _is_far(across: float, width: float) -> bool:
    """Whether a name stands on the near side of its peak, to be within the map."""
    return across > 0.7 * width


def _outward(across: float, width: float) -> tuple[bool, float]:
    """The order of names: of neighbours, the one toward whose side names go comes first, so that no line crosses a name."""
    is_far = _is_far(across, width)
    return is_far, across if is_far else -across


def _asides(across: float, level: float, length: float, width: float):
    """(side, depth in points below the peak) that a name may take, the best first: on the other side before a line farther."""
    down = 1.0 if level > NAME_DEPTH + NAME_LINE else -1.0  # near the lower edge names stand above
    best = -1.0 if _is_far(across, width) else 1.0
    sides = [side for side in (best, -best) if side == best or 0.0 <= across + side * (NAME_ASIDE + length) <= width]
    return ((side, down * (NAME_DEPTH + line * NAME_LINE)) for line in itertools.count() for side in sides)


def _name_object(axes, name: str, distance: float, row: float, side: float, depth: float) -> None:
    axes.plot(distance, row, **PEAK_LOOK)
    axes.annotate(name, (distance, row), xytext=(side * NAME_ASIDE, -depth), textcoords="offset points",
                  color="white",
                  fontsize=8, horizontalalignment="left" if side > 0.0 else "right",
                  arrowprops={"arrowstyle": "-", "color": "white", "linewidth": 0.7},
                  bbox={"boxstyle": "round,pad=0.15", "facecolor": "black", "alpha": 0.6, "edgecolor": "none"})


def _unseen(labels) -> str:
    """Lines on the objects that the map does not show, and why; "" where it shows all."""
    unseen = [label for label in labels.objects if label.status != "seen"]
    lines = []
    for label in unseen[:MAX_UNSEEN]:
        by = occluder_words(label.occluders)
        lines.append(f"\n{label.name}: {label.status}" + (f" (hidden by {by})" if by else ""))
    return "".join(lines) + (f"\nand {len(unseen) - MAX_UNSEEN} more without cells" if len(unseen) > MAX_UNSEEN else "")


def _shown(labels):
    """(first, beyond the last) row and column: about the cells of objects and ghosts, about the mask where there are
    none."""
    is_meant = (labels.object_map >= 0) | (labels.ghost_map >= 0)
    margins = VELOCITY_MARGIN if labels.azimuth is None else AZIMUTH_MARGIN, RANGE_MARGIN
    return [_with_margin(axis, np.flatnonzero((is_meant if is_meant.any() else labels.mask).any(axis=1 - side)), margin)
            for side, (axis, margin) in enumerate(zip((_rows(labels), labels.range), margins))]


def _with_margin(axis, indices, margin: float):
    if len(indices) == 0:
        return 0, len(axis)
    return (int(np.searchsorted(axis, axis[indices[0]] - margin)), int(np.searchsorted(axis, axis[indices[-1]] + margin)))


# --- extents ---

def _strongest_ghosts(labels) -> list:
    ghosts = [ghost for ghost in labels.ghosts if ghost.peak is not None]
    return sorted(ghosts, key=lambda ghost: -ghost.peak.power)[:MAX_GHOSTS]


def _draw_extents(panels, labels, rows: list) -> None:
    """A bar for the box of each label along range and along velocity or azimuth, a mark at its peak."""
    across, up = panels
    for place, label in enumerate(rows):
        colour = CLASSES[getattr(label, "ghost_type", "real")][1]
        _draw_span(across, place, [(label.box[0], label.box[1])], labels.range, label.peak[0], colour)
        _draw_span(up, place, _row_spans(labels, label), _rows(labels), _in_plot_units(labels, label.peak[1]), colour)
        words = for_pictures(f" {float(in_dbm(label.peak.power)):.0f} dBm, {_cells(label.cells)}")
        up.annotate(words, (1.0, place), xycoords=("axes fraction", "data"), va="center", fontsize=7.5)
    across.set_yticks(range(len(rows)), [_row_name(label) for label in rows], fontsize=7.5)
    across.set_ylim(max(len(rows), FEWEST_ROWS) - 0.5, -0.5)
    for axes, values, label in ((across, labels.range, RANGE_LABEL), (up, _rows(labels), _row_label(labels))):
        axes.set_xlabel(label)
        tick_single_cells(axes, values, ())
    up.tick_params(left=False)
    num_hidden = max(0, sum(ghost.peak is not None for ghost in labels.ghosts) - MAX_GHOSTS)
    words = "Where each echo appears: from its first to its last cell, line at its strongest, whose level is told"
    hidden = f"\n{num_hidden} weaker ghosts are not shown" if num_hidden else ""
    across.figure.suptitle(words + hidden, fontsize=10)
    for axes in panels:
        axes.grid(axis="x", alpha=0.25)
        axes.use_sticky_edges = False
        axes.autoscale_view(scaley=False)


def _draw_span(axes, place: int, spans: list, values, peak: float, colour) -> None:
    """Bars from the first to the last cell of each span, whole cells of an axis with these values [N]."""
    edges = cell_edges(values)
    for ends in spans:
        first, last = (int(np.abs(values - end).argmin()) for end in ends)
        left, right = edges[first], edges[last + 1]
        axes.barh(place, right - left, left=left, height=0.6, color=colour, alpha=FILL + 0.2)
    axes.plot([peak, peak], [place - 0.3, place + 0.3], color="black", linewidth=1.2)


def _row_spans(labels, label) -> list:
    """One, or two where the box goes over the end of the velocities."""
    low, high = (_in_plot_units(labels, value) for value in label.box[2:])
    rows = _rows(labels)
    return [(low, high)] if low <= high else [(low, rows[-1]), (rows[0], high)]


def _row_name(label) -> str:
    if not hasattr(label, "ghost_type"):
        return f"{short_name(label.name)} itself"
    way = " + ".join(map(short_name, label.via))
    return f"{short_name(label.object)} via {way} (type {label.ghost_type}, {counted(label.order, 'bounce')})"


# --- what they share ---

def _cells(count: int) -> str:
    return counted(count, "cell")


def _rows(labels):
    return labels.velocity if labels.azimuth is None else np.degrees(labels.azimuth)


def _row_label(labels) -> str:
    return VELOCITY_LABEL if labels.azimuth is None else AZIMUTH_LABEL


def _in_plot_units(labels, row: float) -> float:
    return row if labels.azimuth is None else float(np.degrees(row))
