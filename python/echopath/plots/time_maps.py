"""Maps over time: spectrograms, their labels, range and azimuth over time."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.decibels import SMALLEST_POWER, in_dbm
from .maps import (
    DYNAMIC_RANGE_DB, MARGIN_OVER_MEDIAN_DB, RANGE_LABEL, VELOCITY_LABEL, VELOCITY_MARGIN, chosen_limits, half_step,
    limits_above, margin_of,
)
from .style import AZIMUTH_LABEL, MAP_COLOURS, axes_or_new, cell_edges, colour_bar, part_colours

if TYPE_CHECKING:
    from ..base.foreign_types import Axes
    from ..in_time.maps import TimeMap
    from ..in_time.spectrogram_labels import SpectrogramLabels

TIME_LABEL = "Time in s"
AXIS_LABELS = {"velocity": VELOCITY_LABEL, "range": RANGE_LABEL, "azimuth": AZIMUTH_LABEL}
SIZE = 9.0, 4.4         # inches
LABEL_FILL = 0.6        # opacity of a label over the map
LEGEND_COLUMNS, LEGEND_LETTERS = 4, 90  # at most, of all columns together
LEGEND_ROW = 15.0       # points


def draw_time_map(map: TimeMap, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None,
                  title: str = "") -> Axes:
    """A Spectrogram, RangeTime or AngleTime in given axes, or in new ones (None): gaps between trains of chirps stay blank.

    map: as `ep.spectrogram` and its like give it; ax: axes to draw in; title: above them
    vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, as parts have no noise, to the
        peak
    Returns the axes: time in s across; radial velocity in m/s, range in m or azimuth in degrees up. Raises TypeError or
    ValueError naming the argument.
    """
    level = in_dbm(map.power, SMALLEST_POWER)
    noise = _noise_level(level, map.noise_power) if map.part is None else level.max() - DYNAMIC_RANGE_DB - MARGIN_OVER_MEDIAN_DB
    vmin, vmax = chosen_limits(limits_above(noise, level.max()), vmin, vmax)
    values = np.degrees(map.axis) if map.AXIS == "azimuth" else map.axis
    with axes_or_new(ax, *SIZE) as ax:
        for columns, ends in _trains(map):
            image = image_over_time(ax, map.times[columns], values, level[columns], ends, cmap=MAP_COLOURS, vmin=vmin, vmax=vmax)
        if map.AXIS == "velocity":
            _crop(ax, values, level, vmin)
        ax.set(xlabel=TIME_LABEL, ylabel=AXIS_LABELS[map.AXIS], title=title)
        colour_bar(ax.figure, image, ax)
    return ax


def draw_spectrogram_labels(labels: SpectrogramLabels, *, ax: Axes | None = None, title: str = "") -> Axes:
    """The whole in grey under the cells of the mask, coloured by the part that dominates, in given axes or new ones (None).

    labels: SpectrogramLabels; title: above the axes
    Returns the axes: time in s across, radial velocity in m/s up. Raises TypeError naming `ax`.
    """
    from matplotlib.colors import ListedColormap

    level = in_dbm(labels.whole, SMALLEST_POWER)
    vmin, vmax = limits_above(_noise_level(level, labels.noise_power), level.max())
    names = labels.part_names
    colours = part_colours(names)
    with axes_or_new(ax, *SIZE) as ax:
        owner = np.ma.masked_less(labels.dominant, 0)
        for columns, ends in _trains(labels):
            cells = labels.times[columns], labels.velocity
            grey = image_over_time(ax, *cells, level[columns], ends, cmap="gray", vmin=vmin, vmax=vmax)
            image_over_time(ax, *cells, owner[columns], ends, cmap=ListedColormap(colours), vmin=-0.5, vmax=len(names) - 0.5,
                            alpha=LABEL_FILL)
        seen = [number for number in range(len(names)) if np.any(labels.dominant == number)]
        for number in seen:
            ax.fill_between([], [], color=colours[number], label=names[number])
        _crop(ax, labels.velocity, level, vmin)
        ax.set(xlabel=TIME_LABEL, ylabel=VELOCITY_LABEL)
        columns = max(1, min(LEGEND_COLUMNS, LEGEND_LETTERS // max((len(names[number]) for number in seen), default=1)))
        ax.set_title(title, pad=8.0 + LEGEND_ROW * -(-len(seen) // columns))
        if seen:
            ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, frameon=False, borderaxespad=0.2)
        colour_bar(ax.figure, grey, ax)
    return ax


def _trains(map) -> list:
    """(indices of times, (begin, end) in s) of each stretch whose columns touch each other, its windows' ends included."""
    if not hasattr(map, "train"):
        return [(slice(None), None)]
    return [(map.train == number, map.trains[number]) for number in np.unique(map.train)]


def image_over_time(ax, times, values, level, ends=None, **look):
    """The cells [T, X] as an image; ends: (begin, end) in s of the outermost columns, None: as wide as the others."""
    edges = cell_edges(times)
    if ends is not None:
        edges[[0, -1]] = ends
    elif len(times) == 1:
        ax.set_xticks(times)  # its width means nothing
    return ax.pcolormesh(edges, cell_edges(values), np.transpose(level), shading="flat", rasterized=True, **look)


def _noise_level(level, noise_power: float) -> float:
    """dBm of the noise in levels in dBm, of which there need be no cell that holds it alone.

    noise_power: W, mean of the noise in a cell; 0: not known
    """
    return float(in_dbm(noise_power, SMALLEST_POWER) if noise_power > 0.0 else np.median(level))


def _crop(ax, velocity, level, floor: float) -> None:
    """To the velocities at which some cell stands out of the floor of the colour scale in dBm, which begins above the noise: a
    cell is a sum over ranges and a mean over channels, whose noise hardly varies."""
    shown = velocity[(level > floor + 3.0).any(axis=0)]
    if len(shown):
        margin = margin_of(velocity, VELOCITY_MARGIN)
        show_within(ax, velocity, shown.min() - margin, shown.max() + margin)


def show_within(ax, values, low: float, high: float) -> None:
    """Shows of the cells at values [X] up the axes those from low to high; the outermost stay whole."""
    ax.set_ylim(max(low, values[0] - half_step(values)), min(high, values[-1] + half_step(values)))
