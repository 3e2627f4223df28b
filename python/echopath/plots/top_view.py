"""Range-azimuth maps as seen from above: the radar below, ahead is up, left is left."""
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import refused
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..signals.measures import for_pictures
from .maps import chosen_limits, limits_of_level, noise_peak_db
from .names import Room
from .style import (
    AHEAD_LABEL,
    LEFT_LABEL,
    MAP_COLOURS,
    axes_or_new,
    cell_edges,
    colour_bar,
    new_figure,
    require_drawable,
    set_title,
    short_name,
)

if TYPE_CHECKING:
    from .. import _core
    from ..arguments.checks import ArrayLike
    from ..base.classes.foreign_types import Axes, Figure

FARTHER = 1.1                  # of the farthest signal: what is shown
LEAST_RANGES = 8               # cells shown at least
RINGS = 5                      # about so many
LARGE, SMALL = 4.6, 3.2         # inches, height of a sector alone and of one of several
WIDE = 1.4                     # width over height, from which three sectors do not stand in a row
SPOKE_STEP = math.pi / 6.0     # rad
MARGIN = 0.1                   # of the reach, around the sector: room for the angles
GRID_LOOK = {"color": "white", "linewidth": 0.5, "alpha": 0.35}
TRUE_LABEL = "where the object truly is (its middle)"
TRUE_LOOK = {"marker": "o", "linestyle": "none", "markerfacecolor": "none", "markeredgecolor": "#56d4ff", "markersize": 9}
NAME_ASIDE, NAME_LINE, NAME_LETTER = 0.035, 0.065, 0.024  # of the reach: beside a place, a line, a letter
MOST_NAMES = 12                 # true places that bear their names, the nearest ones; more would hide each other
LEGEND_LOOK = {"facecolor": "black", "labelcolor": "white", "framealpha": 1.0}
LABEL_LOOK = {"color": "0.35", "fontsize": 7, "ha": "center", "va": "center"}


_MAP_RULE = "a RangeAzimuth, as ep.range_azimuth makes it of a spectrum"


def plot_range_azimuth(maps: _core.RangeAzimuth | dict[str, _core.RangeAzimuth], *,
                       title: str = "Received power by range and azimuth, seen from above", vmin: float | None = None,
                       vmax: float | None = None, places: Mapping[str, ArrayLike] | None = None,
                       leaked: _core.RangeAzimuth | None = None) -> Figure:
    """Range-azimuth maps as sectors seen from above, cropped to where there is signal, with one colour scale.

    maps: of `range_azimuth`, one or {title of its panel: map}; of several the first sets the scale; title: above them
    vmin, vmax: ends of the colour scale in dBm, None: the peak, and the noise or 70 dB less
    places: {object: (range in m, azimuth in rad)} that get a ring, in the first map the 12 nearest with names that find room;
        None: none
    leaked: map of the leakage in the first map, which sets no scale, or None
    Returns a matplotlib figure: metres to the left across (right negative), metres ahead up, in the radar's frame. Raises
    TypeError or ValueError naming maps, vmin or vmax.
    """
    if maps is None:
        raise refused(TypeError, "maps", "a RangeAzimuth, which frames have whose antennas tell azimuths apart", maps)
    maps = maps if isinstance(maps, dict) else {"": maps}
    if not maps:
        raise refused(ValueError, "maps", _MAP_RULE, maps)
    for one in maps.values():
        require_drawable("maps", _MAP_RULE, one, "azimuth", "power")
    first = next(iter(maps.values()))
    vmin, vmax = chosen_limits(_colour_limits(first, leaked), vmin, vmax)
    reach = max(_reach(one, vmin) for one in maps.values())
    aspect = _aspect(first)
    columns = min(len(maps), 3 if len(maps) % 2 and aspect < WIDE else 2)
    rows = -(-len(maps) // columns)
    height = LARGE if len(maps) == 1 else SMALL
    with new_figure(columns * height * aspect + 1.6, rows * (height + 0.2) + 0.6) as figure:
        panels = list(figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).flat)
        for number, (axes, (name, one)) in enumerate(zip(panels, maps.items())):
            image = _draw(axes, one, reach, vmin, vmax)
            ring = _draw_places(axes, one, places or {}, reach, is_named=number == 0)
            axes.set_title(name)
        for axes in panels[len(maps) - columns:len(maps)]:
            axes.tick_params(labelbottom=True)  # the lowest of its column, perhaps above an empty place
        for axes in panels[len(maps):]:
            axes.remove()
        if len(maps) == 1:  # labels of axes stand right beside these, and above the legend of a narrow sector
            panels[0].set_xlabel(LEFT_LABEL, fontsize=9)
            panels[0].set_ylabel(AHEAD_LABEL, fontsize=9)
        else:
            figure.supxlabel(LEFT_LABEL, fontsize=9)
            figure.supylabel(AHEAD_LABEL, fontsize=9)
        set_title(figure, title, 11)
        colour_bar(figure, image, panels[:len(maps)])
        if ring:
            figure.legend(handles=ring, loc="outside lower right", **LEGEND_LOOK)
    return figure


def draw_range_azimuth(map: _core.RangeAzimuth, *, ax: Axes | None = None, vmin: float | None = None,
                       vmax: float | None = None, title: str = "") -> Axes:
    """One map in given axes, or in new ones, otherwise as `plot_range_azimuth`.

    map: of `range_azimuth`; ax: axes to draw in, None: new ones; vmin, vmax: ends of the colour scale in dBm; title: above them
    Returns the axes. Raises TypeError or ValueError naming map, ax, vmin or vmax.
    """
    require_drawable("map", _MAP_RULE, map, "azimuth", "power")
    vmin, vmax = chosen_limits(_colour_limits(map), vmin, vmax)
    with axes_or_new(ax, LARGE * _aspect(map) + 1.6, LARGE + 0.8, (LEFT_LABEL, AHEAD_LABEL)) as ax:
        image = _draw(ax, map, _reach(map, vmin), vmin, vmax)
        ax.set_xlabel(LEFT_LABEL)
        ax.set_ylabel(AHEAD_LABEL)
        ax.set_title(title)
        colour_bar(ax.figure, image, [ax])
    return ax


def _draw_places(axes, one, places: dict, reach: float, *, is_named: bool) -> list:
    """A ring at each place that the map shows; returns the rings."""
    shown = {name: (distance * math.sin(azimuth), distance * math.cos(azimuth)) for name, (distance, azimuth) in places.items()
             if distance <= reach and _covers(one, azimuth)}
    if is_named:
        _name_places(axes, shown, reach)
    return axes.plot(*zip(*shown.values()), label=TRUE_LABEL, zorder=4, **TRUE_LOOK) if shown else []


def _covers(one, azimuth: float) -> bool:
    """Whether the azimuths of a map, which may go on beyond pi, hold one in rad."""
    middle = 0.5 * (one.azimuth[0] + one.azimuth[-1])
    return abs(math.remainder(azimuth - middle, 2.0 * math.pi)) <= 0.5 * (one.azimuth[-1] - one.azimuth[0])


def _name_places(axes, shown: dict, reach: float) -> None:
    """Names right below their places, left or lower where a ring or another name is, with lines between both. One that finds no
    room within the axes is left out."""
    from matplotlib.patheffects import withStroke

    lowest = axes.get_ylim()[0]
    length_of_letter, aside, line = NAME_LETTER * reach, NAME_ASIDE * reach, NAME_LINE * reach  # m
    room = Room(0.99 * line)
    for left, ahead in shown.values():
        room.take(left, left, ahead)  # rings
    nearest = sorted(shown.items(), key=lambda one: math.hypot(*one[1]))[:MOST_NAMES]
    for name, (left, ahead) in sorted(nearest, key=lambda one: -one[1][1]):
        name = short_name(name)
        length = length_of_letter * len(name)
        num_rows = int((ahead - lowest) / line - 0.5)
        tried = ((left + side * aside, side, ahead - row * line) for row in range(1, num_rows + 1) for side in (-1.0, 1.0))
        for begin, side, height in tried:
            if room.take(*sorted((begin, begin + side * length)), height):
                break
        else:
            continue
        axes.annotate(name, (left, ahead), xytext=(begin, height), textcoords="data", color="white", fontsize=7,
                      verticalalignment="center", horizontalalignment="left" if side < 0.0 else "right",
                      path_effects=[withStroke(linewidth=2.0, foreground="black")],
                      arrowprops={"arrowstyle": "-", "color": "white", "linewidth": 0.7, "shrinkA": 0.0,
                                  "shrinkB": 0.5 * TRUE_LOOK["markersize"]})


def _in_dbm(power):
    return in_dbm(power, SMALLEST_POWER)


def _colour_limits(one, leaked=None) -> tuple[float, float]:
    """(lowest, highest) level in dBm, multiples of 5. leaked: as of `plot_range_azimuth`"""
    return limits_of_level(_in_dbm(one.power), None if leaked is None else _in_dbm(leaked.power))


def _reach(one, floor: float) -> float:
    """Range in m up to which the map is worth showing; all of it where nothing stands out."""
    level = _in_dbm(one.power.max(axis=0))
    has_signal = np.flatnonzero(level > max(floor + 3.0, np.median(_in_dbm(one.power)) + noise_peak_db(1)))
    if len(has_signal) == 0:
        return float(one.range[-1]) or 1.0
    last = max(has_signal.max(), LEAST_RANGES)
    return float(min(FARTHER * one.range[min(last, len(one.range) - 1)], one.range[-1])) or 1.0


def _aspect(one) -> float:
    """Width over height of what a sector covers, within reason."""
    left, right, back, front = _box(one, 1.0)
    return min(max((left - right) / (front - back), 0.35), 2.5)


def _box(one, reach: float) -> tuple[float, float, float, float]:
    """(leftmost, rightmost, hindmost, foremost) coordinate in m of a sector up to `reach`."""
    azimuth = np.linspace(one.azimuth[0], one.azimuth[-1], 181)
    across, ahead = np.append(np.sin(azimuth), 0.0), np.append(np.cos(azimuth), 0.0)
    margin = MARGIN * reach
    return (reach * across.max() + margin, reach * across.min() - margin, reach * ahead.min() - margin,
            reach * ahead.max() + margin)


def _draw(axes, one, reach: float, vmin: float, vmax: float):
    """One sector; returns the image."""
    shown = max(2, int(np.count_nonzero(one.range <= reach)))
    edge_azimuth, edge_range = cell_edges(one.azimuth), np.maximum(cell_edges(one.range[:shown]), 0.0)
    across = np.sin(edge_azimuth)[:, None] * edge_range
    ahead = np.cos(edge_azimuth)[:, None] * edge_range
    image = axes.pcolormesh(across, ahead, _in_dbm(one.power[:, :shown]), cmap=MAP_COLOURS, vmin=vmin, vmax=vmax,
                            rasterized=True)
    _draw_grid(axes, one, reach)
    left, right, back, front = _box(one, reach)
    axes.set_xlim(left, right)
    axes.set_ylim(back, front)
    axes.set_aspect("equal")
    return image


def _draw_grid(axes, one, reach: float) -> None:
    """Arcs of equal range and rays of equal azimuth with their angles in degrees."""
    azimuth = np.linspace(one.azimuth[0], one.azimuth[-1], 181)
    step = _round_step(reach / RINGS)
    for ring in np.arange(step, reach, step):
        axes.plot(ring * np.sin(azimuth), ring * np.cos(azimuth), **GRID_LOOK)
    first, last = math.ceil(one.azimuth[0] / SPOKE_STEP), math.floor(one.azimuth[-1] / SPOKE_STEP)
    for spoke in SPOKE_STEP * np.arange(first, last + 1):
        axes.plot([0.0, reach * np.sin(spoke)], [0.0, reach * np.cos(spoke)], **GRID_LOOK)
        rim = (1.0 + 0.55 * MARGIN) * reach
        axes.text(rim * np.sin(spoke), rim * np.cos(spoke), for_pictures(f"{np.degrees(spoke):.0f}\N{DEGREE SIGN}"), **LABEL_LOOK)


def _round_step(step: float) -> float:
    """The nearest of 1, 2, 5, 10, ... times a power of ten that is no smaller."""
    unit = 10.0 ** math.floor(math.log10(step))
    return next(unit * factor for factor in (1.0, 2.0, 5.0, 10.0) if unit * factor >= step * (1.0 - 1e-9))
