"""Maps over time: spectrograms, their labels, range and azimuth over time."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from .maps import (
    DYNAMIC_RANGE_DB,
    MARGIN_OVER_MEDIAN_DB,
    VELOCITY_MARGIN,
    chosen_limits,
    half_step,
    limits_above,
    margin_of,
)
from .style import (
    AZIMUTH_LABEL,
    MAP_COLOURS,
    RANGE_LABEL,
    TIME_LABEL,
    VELOCITY_LABEL,
    axes_or_new,
    cell_edges,
    colour_bar,
    part_colours,
    require_drawable,
)

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes
    from ..in_time.maps import TimeMap
    from ..in_time.spectrogram_labels import SpectrogramLabels

AXIS_LABELS = {"velocity": VELOCITY_LABEL, "range": RANGE_LABEL, "azimuth": AZIMUTH_LABEL}
SIZE = 9.0, 4.4         # inches
LABEL_FILL = 0.6        # opacity of a label over the map
LEGEND_COLUMNS, LEGEND_LETTERS = 4, 90  # at most, of all columns together
LEGEND_ROW = 15.0       # points
LARGEST_STEP = 1.5      # of the usual one from column to column, beyond which there is a gap
NARROWEST_TRAIN = 1.0 / 250.0  # of the time shown: about three pixels of a picture, below which gaps beside it are not drawn


def draw_time_map(map: TimeMap, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None,
                  title: str = "") -> Axes:
    """A Spectrogram, RangeTime or AngleTime in given axes, or in new ones (None).

    Gaps between trains of chirps stay blank, except behind trains that would be too narrow to be seen, as frames of 10 ms are in
    a film of a minute: these are drawn until the next one begins, as far as trains usually lie apart. Where a map has columns
    alone, those form a train that follow each other within one and a half of their usual steps.

    map: as `ep.spectrogram` and its like give it; ax: axes to draw in; title: above them
    vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, as parts have no noise, to the
        peak
    Returns the axes: time in s across; radial velocity in m/s, range in m or azimuth in degrees up. Raises TypeError or
    ValueError naming the argument.
    """
    require_drawable("map", "a Spectrogram, RangeTime or AngleTime, as ep.spectrogram makes it of frames", map, "AXIS", "power")
    level = in_dbm(map.power, SMALLEST_POWER)
    noise = _noise_level(level, map.noise_power) if map.part is None else level.max() - DYNAMIC_RANGE_DB - MARGIN_OVER_MEDIAN_DB
    vmin, vmax = chosen_limits(limits_above(noise, level.max()), vmin, vmax)
    values = np.degrees(map.axis) if map.AXIS == "azimuth" else map.axis
    with axes_or_new(ax, *SIZE, (TIME_LABEL, AXIS_LABELS[map.AXIS])) as ax:
        look = {"cmap": MAP_COLOURS, "vmin": vmin, "vmax": vmax}
        if map.AXIS == "velocity":
            edges, columns = _columns_and_gaps(map.times, map.train, map.trains)
            image = _image(ax, edges, values, _with_gaps(level, columns), **look)
            _crop(ax, values, level, vmin)
        else:
            image = image_over_time(ax, map.times, values, level, **look)
        ax.set(xlabel=TIME_LABEL, ylabel=AXIS_LABELS[map.AXIS], title=title)
        colour_bar(ax.figure, image, ax)
    return ax


def draw_spectrogram_labels(labels: SpectrogramLabels, *, ax: Axes | None = None, title: str = "") -> Axes:
    """The whole in grey under the cells of the mask, coloured by the part that dominates, in given axes or new ones (None).

    labels: SpectrogramLabels; title: above the axes
    Returns the axes: time in s across, radial velocity in m/s up. Raises TypeError naming `labels` or `ax`.
    """
    require_drawable("labels", "SpectrogramLabels, as ep.spectrogram_labels makes them", labels, "whole", "trains")
    from matplotlib.colors import ListedColormap

    level = in_dbm(labels.whole, SMALLEST_POWER)
    vmin, vmax = limits_above(_noise_level(level, labels.noise_power), level.max())
    names = labels.part_names
    colours = part_colours(names)
    with axes_or_new(ax, *SIZE, (TIME_LABEL, VELOCITY_LABEL)) as ax:
        owner = np.ma.masked_less(labels.dominant, 0)
        edges, columns = _columns_and_gaps(labels.times, labels.train, labels.trains)
        grey = _image(ax, edges, labels.velocity, _with_gaps(level, columns), cmap="gray", vmin=vmin, vmax=vmax)
        _image(ax, edges, labels.velocity, _with_gaps(owner, columns), cmap=ListedColormap(colours), vmin=-0.5,
               vmax=len(names) - 0.5, alpha=LABEL_FILL)
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


def _columns_and_gaps(times, train, trains) -> tuple[np.ndarray, np.ndarray]:
    """(edges [E + 1] in s, indices [E] of the times between them, -1 in a gap between trains).

    times: [T] s, of columns; train: [T], the train of each; trains: [N, 2] s, their first and last ends
    """
    begins = trains[:, 0]
    ends = _ends_as_drawn(trains)
    edges, columns = [], []
    for number in np.unique(train):
        inside = np.flatnonzero(train == number)
        if edges and edges[-1] < begins[number]:
            columns.append(-1)
        elif edges:
            edges.pop()
        edges += [begins[number], *cell_edges(times[inside])[1:-1], ends[number]]
        columns += list(inside)
    return np.array(edges), np.array(columns)


def _trains_of_columns(times) -> tuple[np.ndarray, np.ndarray]:
    """(train [T] of each of at least two columns, ends [N, 2] of the trains in s, half a usual step beyond their columns)."""
    steps = np.diff(times)
    usual = np.median(steps)
    is_gap = steps > LARGEST_STEP * usual
    is_first, is_last = np.append(True, is_gap), np.append(is_gap, True)
    return np.cumsum(is_first) - 1, np.stack([times[is_first] - 0.5 * usual, times[is_last] + 0.5 * usual], axis=1)


def _ends_as_drawn(trains) -> np.ndarray:
    """Ends of trains [N, 2] in s; of those that are too narrow to be seen, where the next one begins."""
    begins, ends = trains.T
    if len(trains) < 2:
        return ends
    usual = np.median(np.diff(begins))
    reach = np.minimum(begins + usual, np.append(begins[1:], np.inf))
    is_narrow = ends - begins < NARROWEST_TRAIN * (ends[-1] - begins[0])
    return np.where(is_narrow, np.maximum(ends, reach), ends)


def _with_gaps(cells, columns):
    """The cells [T, X] of each column, without any in gaps."""
    chosen = np.ma.masked_array(cells[columns])
    chosen[columns < 0] = np.ma.masked
    return chosen


def columns_over_time(times) -> tuple[np.ndarray, np.ndarray]:
    """(edges [E + 1] in s, indices [E] of the times [T] in s between them, -1 in a gap), as `image_over_time` draws them."""
    if len(times) == 1:
        return cell_edges(times), np.zeros(1, int)
    order = np.argsort(times)
    edges, columns = _columns_and_gaps(times[order], *_trains_of_columns(times[order]))
    return edges, np.where(columns < 0, -1, order[columns])


def image_over_time(ax, times, values, level, **look):
    """The cells [T, X] as an image, blank in gaps between the times [T] in s, which run backwards in `sequence[::-1]`."""
    if len(times) == 1:
        ax.set_xticks(times)  # its width means nothing
    edges, columns = columns_over_time(times)
    return _image(ax, edges, values, _with_gaps(level, columns), **look)


def _image(ax, edges, values, level, **look):
    """The cells [T, X] between the edges [T + 1] in s as an image."""
    if len(values) == 1:
        ax.set_yticks(values)  # nor does its height
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
