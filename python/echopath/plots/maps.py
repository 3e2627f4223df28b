"""Range-Doppler maps."""
from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import optional, real, refused
from ..arguments.part_names import REST
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..signals.measures import for_pictures, with_error
from ..spectra.moving import static_speed
from .part_powers import require_powers
from .style import (
    MAP_COLOURS,
    RANGE_LABEL,
    VELOCITY_LABEL,
    axes_or_new,
    colour_bar,
    is_drawable,
    new_figure,
    require_drawable,
    set_title,
)

if TYPE_CHECKING:
    from .. import _core
    from ..base.classes.foreign_types import Axes, Figure

DYNAMIC_RANGE_DB = 70.0      # below the peak that a map shows at most
LEAKED_DB = 10.0             # below a cell: where leakage alone comes so near to it, the cell tells nothing of the scene
MARGIN_OVER_MEDIAN_DB = 6.0  # the median of a map is its noise: the scale begins above it
NOISE_CELLS = 1e7            # of maps: the highest of as many cells of noise is taken for noise
RANGE_MARGIN = 0.8           # m, shown around the signal at least
VELOCITY_MARGIN = 0.5        # m/s, likewise
CELLS_OF_MARGIN = 1.5        # likewise: the cell of the signal whole, and one beyond it
MAP_SIZE = 9.0, 4.4          # inches, of one map
LEVEL = optional(real(-1e4, 1e4, "dBm"))
_DRAWN = "values", "velocity"  # attributes that tell a map


@functools.cache
def noise_peak_db(num_channels: int) -> float:
    """dB from the median of noise, which is a mean over so many channels, to the highest of NOISE_CELLS cells."""
    return 10.0 * math.log10(_noise_above(1.0 / NOISE_CELLS, num_channels) / _noise_above(0.5, num_channels))


def _noise_above(share: float, num_channels: int) -> float:
    """What a share of cells exceeds: sums of so many powers of mean 1, whose distribution is Erlang's."""
    from scipy.special import gammainccinv

    return float(gammainccinv(num_channels, share))


def _require_map(argument: str, value) -> None:
    """Raises TypeError naming the argument unless it is a range-Doppler map."""
    require_drawable(argument, "a RangeDoppler, as ep.range_doppler makes it of a cube", value, *_DRAWN)


def power_dbm(spectrum: _core.RangeDoppler) -> np.ndarray:
    """Mean power of the channels, [velocity, range] in dB re 1 mW.

    spectrum: RangeDoppler. Raises TypeError naming it.
    """
    _require_map("spectrum", spectrum)
    power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
    return in_dbm(power, SMALLEST_POWER)


def colour_limits(spectrum: _core.RangeDoppler, leaked: _core.RangeDoppler | None = None) -> tuple[float, float]:
    """(lowest, highest) level in dBm of the colour scale of a map, multiples of 5.

    spectrum: RangeDoppler; leaked: that of the leakage in it, which sets no scale, or None
    Raises TypeError naming `spectrum`.
    """
    return limits_of_level(power_dbm(spectrum), None if leaked is None else power_dbm(leaked))


def limits_of_level(level, leaked=None) -> tuple[float, float]:
    """The same of levels in dBm, an array of any shape. leaked: as of `cells_of_scene`"""
    cells = cells_of_scene(level, leaked)
    return limits_above(np.median(cells), cells.max())


def cells_of_scene(level, leaked=None):
    """Those of levels in dBm that set the scale of colours: all but the cells of leakage, or all where there are no others.

    leaked: levels of the leakage alone, of that shape, None: there is none
    """
    of_scene = level if leaked is None else level[leaked < level - LEAKED_DB]
    return of_scene if of_scene.size else level


def limits_above(median: float, peak: float) -> tuple[float, float]:
    """The same of levels in dBm with that median and that peak."""
    highest = 5.0 * math.ceil(peak / 5.0)
    above_noise = 5.0 * math.floor((median + MARGIN_OVER_MEDIAN_DB) / 5.0)
    return min(max(highest - DYNAMIC_RANGE_DB, above_noise), highest - 10.0), highest


def chosen_limits(limits: tuple[float, float], vmin, vmax) -> tuple[float, float]:
    """Ends of a colour scale in dBm: those given, and of `limits` those left out (None). Raises naming vmin or vmax."""
    lowest, highest = LEVEL("vmin", vmin), LEVEL("vmax", vmax)
    return (limits[0] if lowest is None else lowest), (limits[1] if highest is None else highest)


def plot_range_doppler(spectrum: _core.RangeDoppler, *, title: str = "Received power by range and radial velocity",
                       vmin: float | None = None, vmax: float | None = None, note: str = "") -> Figure:
    """One range-Doppler map, cropped to where there is signal, at rest or moving.

    spectrum: of `range_doppler`; title: above the map; vmin, vmax: ends of the colour scale in dBm, None: `colour_limits`
    note: small print below the map
    Returns a matplotlib figure: range in m across, radial velocity in m/s up (receding positive). Raises TypeError or
    ValueError naming spectrum, vmin or vmax.
    """
    with new_figure(*MAP_SIZE) as figure:
        draw_range_doppler(spectrum, ax=figure.subplots(), vmin=vmin, vmax=vmax, title=title)
        _small_print(figure, note)
    return figure


def draw_range_doppler(spectrum: _core.RangeDoppler, *, ax: Axes | None = None, vmin: float | None = None,
                       vmax: float | None = None, title: str = "") -> Axes:
    """One range-Doppler map in given axes, or in new ones.

    spectrum: of `range_doppler`; ax: axes to draw in, None: new ones; title: above them
    vmin, vmax: ends of the colour scale in dBm, None: `colour_limits`
    Returns the axes, as of `plot_range_doppler`. Raises TypeError or ValueError naming spectrum, ax, vmin or vmax.
    """
    vmin, vmax = _limits(spectrum, vmin, vmax)
    with axes_or_new(ax, *MAP_SIZE, (RANGE_LABEL, VELOCITY_LABEL)) as ax:
        image = _draw_whole(ax, spectrum, vmin, vmax, title)
        ax.set_ylabel(VELOCITY_LABEL)
        colour_bar(ax.figure, image, [ax])
    return ax


def plot_partition(spectra: Mapping[str, _core.RangeDoppler], *, title: str = "", vmin: float | None = None,
                   vmax: float | None = None, whole: _core.RangeDoppler | None = None,
                   powers: Mapping[str, _core.ReceivedPower] | None = None, note: str = "", radar_moves: bool = False) -> Figure:
    """The maps of the parts of a partition side by side, cropped together to what moves in any part, and to all of a part
    in which nothing does, with one colour scale for all; to all of each part where the radar itself moves.

    spectra: {part: map of `range_doppler`}; vmin, vmax: ends of the colour scale in dBm, None: those of `whole` (of
    the strongest part when there is no `whole`); powers: {part: ep.ReceivedPower} to stand above the maps, or None;
    note: small print; title: above the maps; radar_moves: to it what stands has velocities, too
    Returns a matplotlib figure with the axes of `plot_range_doppler`. Raises TypeError or ValueError naming spectra, whole,
    powers, vmin or vmax.
    """
    _require_maps(spectra)
    if whole is not None:
        _require_map("whole", whole)
    if powers is not None:
        require_powers(powers)
    strongest = max(spectra.values(), key=lambda spectrum: np.abs(spectrum.values).max())
    vmin, vmax = _limits(whole if whole is not None else strongest, vmin, vmax)
    columns = len(spectra) if len(spectra) <= 3 else 2
    rows = -(-len(spectra) // columns)
    with new_figure(3.4 * columns + 1.2, 3.4 * rows + 0.5) as figure:
        panels = list(figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).flat)
        image = _draw_parts(panels, spectra, vmin, vmax, powers, radar_moves)
        for number, axes in enumerate(panels[:len(spectra)]):  # the small print is the figure's own label
            if number + columns >= len(spectra):
                axes.set_xlabel(RANGE_LABEL)
                axes.tick_params(labelbottom=True)
        figure.supylabel(VELOCITY_LABEL, fontsize=9)
        set_title(figure, title, 11)
        colour_bar(figure, image, panels[:len(spectra)])
        _small_print(figure, note)
    return figure


def plot_overview(whole: _core.RangeDoppler, spectra: Mapping[str, _core.RangeDoppler], *,
                  title: str = "Everything that the radar receives", parts_title: str = "", vmin: float | None = None,
                  vmax: float | None = None, powers: Mapping[str, _core.ReceivedPower] | None = None, note: str = "",
                  radar_moves: bool = False) -> Figure:
    """The whole map above the maps of its parts, on one colour scale.

    whole, spectra, powers, note, vmin, vmax (dBm), radar_moves: as of `plot_partition`; title: above the whole; parts_title:
        above the parts
    Returns a matplotlib figure with the axes of `plot_range_doppler`. Raises TypeError or ValueError naming whole, spectra,
    powers, vmin or vmax.
    """
    _require_map("whole", whole)
    _require_maps(spectra)
    if powers is not None:
        require_powers(powers)
    vmin, vmax = _limits(whole, vmin, vmax)
    with new_figure(3.2 * max(2, len(spectra)) + 0.8, 6.8) as figure:
        upper, lower = figure.subfigures(2, 1, height_ratios=(1.0, 1.05))
        axes = upper.subplots()
        image = _draw_whole(axes, whole, vmin, vmax, "")
        set_title(upper, title, 10)
        panels = list(lower.subplots(1, len(spectra), sharex=True, sharey=True, squeeze=False).flat)
        _draw_parts(panels, spectra, vmin, vmax, powers, radar_moves)
        set_title(lower, parts_title, 10)
        (near, far), (nearest, farthest) = panels[0].get_xlim(), axes.get_xlim()
        is_cut = near > nearest + RANGE_MARGIN or far < farthest - RANGE_MARGIN
        where = f", where the parts {'are' if radar_moves else 'move'}"
        lower.supxlabel(f"{RANGE_LABEL}{where if is_cut else ''}", fontsize=9)
        for first in (axes, panels[0]):
            first.set_ylabel(VELOCITY_LABEL)
        colour_bar(upper, image, [axes])
        colour_bar(lower, image, panels)
        _small_print(figure, note)
    return figure


def _require_maps(spectra) -> None:
    """Raises unless they are maps by the names of parts: those of one partition, not the partitions of a frame."""
    rule = "one map at least by the names of parts, as frame.part_spectra['parts'] has them"
    if not isinstance(spectra, Mapping) or not all(is_drawable(one, *_DRAWN) for one in spectra.values()):
        raise refused(TypeError, "spectra", rule, spectra)
    if not spectra:
        raise refused(ValueError, "spectra", rule, spectra)


def _draw_whole(axes, spectrum, vmin: float, vmax: float, title: str):
    image = _draw(axes, spectrum, vmin, vmax)
    _crop([axes], signal_extent([spectrum], vmin))
    axes.set_title(title)
    axes.set_xlabel(RANGE_LABEL)
    return image


def _draw_parts(panels: list, spectra: dict, vmin: float, vmax: float, powers, radar_moves: bool):
    """The parts in as many panels, the panels left over removed; returns the last image."""
    for axes, (name, spectrum) in zip(panels, spectra.items()):
        image = _draw(axes, spectrum, vmin, vmax)
        axes.set_title(part_title(name) + (f"\n{for_pictures(with_error(powers[name]))}" if powers else ""))
    for axes in panels[len(spectra):]:
        axes.remove()
    _crop(panels[:len(spectra)], extent_of_parts(spectra, vmin, radar_moves))
    return image


def part_title(name: str) -> str:
    """What stands above the map of a part. name: of the part. Raises nothing."""
    return name if name != REST else "other: all the rest"


def _limits(spectrum, vmin, vmax):
    return chosen_limits(colour_limits(spectrum), vmin, vmax)


def _draw(axes, spectrum, vmin: float, vmax: float):
    return draw_level(axes, power_dbm(spectrum), spectrum.range, spectrum.velocity, vmin, vmax)


def draw_level(axes, level, distance, velocity, vmin: float, vmax: float):
    """Levels [V, R] in dBm at [R] m and [V] m/s as an image whose pixels are centred on their cells."""
    half_range, half_velocity = half_step(distance), half_step(velocity)
    extent = (distance[0] - half_range, distance[-1] + half_range, velocity[0] - half_velocity, velocity[-1] + half_velocity)
    tick_single_cells(axes, distance, velocity)
    return axes.imshow(level, origin="lower", aspect="auto", extent=extent, cmap=MAP_COLOURS, vmin=vmin, vmax=vmax,
                       interpolation="nearest")


def tick_single_cells(axes, across, up) -> None:
    """A single cell of an axis [1], as the velocity of one chirp, tells nothing apart and has its value alone on it."""
    for axis, set_ticks in ((across, axes.set_xticks), (up, axes.set_yticks)):
        if len(axis) == 1:
            set_ticks(axis)


def half_step(axis) -> float:
    """Half a cell of an axis [N]; 0.5 where there is only one."""
    return 0.5 * (axis[1] - axis[0]) if len(axis) > 1 else 0.5


def extent_of_parts(spectra: dict, floor: float, radar_moves: bool = False):
    """Box (range, velocity) around the signal of parts {name: spectrum} above `floor` in dBm, or None where there is none.

    By range around what moves in each part, around all of a part in which nothing does, and not around all the rest. To a radar
    that moves itself what stands has a velocity, and none tells what moves: around all of each part.
    """
    asked = [name for name in spectra if name != REST] or list(spectra)
    boxes = {name: signal_extent([spectrum], floor, is_moving_meant=name in asked and not radar_moves)
             for name, spectrum in spectra.items()}
    found = {name: box for name, box in boxes.items() if box is not None}
    if not found:
        return None
    near, far, _, _ = zip(*([found[name] for name in asked if name in found] or found.values()))
    _, _, low, high = zip(*found.values())
    return min(near), max(far), min(low), max(high)


def signal_extent(spectra, floor: float, is_moving_meant: bool = False):
    """Box (range, velocity) around the cells above `floor` in dBm, or None when there are none.

    is_moving_meant: by range only around the cells that move, where some do. The spectra have one axis of velocity.
    """
    cells = [_cells(spectrum, floor) for spectrum in spectra]
    margins = [margin_of(spectra[0].range, RANGE_MARGIN), margin_of(spectra[0].velocity, VELOCITY_MARGIN)]
    distance, velocity = (np.concatenate(values) for values in zip(*cells))
    if is_moving_meant:
        is_moving = np.abs(velocity) > static_speed(spectra[0].velocity, spectra[0].window, spectra[0].zero_pad)
        distance = distance[is_moving] if is_moving.any() else distance
    if not len(distance):
        return None
    return (distance.min() - margins[0], distance.max() + margins[0],
            velocity.min() - margins[1], velocity.max() + margins[1])


def margin_of(axis, least: float) -> float:
    """What is shown beyond the signal along an axis of cells [N], in its unit; least: however narrow the cells are."""
    return max(least, CELLS_OF_MARGIN * 2.0 * half_step(axis))


def _cells(spectrum, floor: float):
    """Range and velocity of the cells that stand out of the noise and of the floor of the colour scale, [N] each."""
    level = power_dbm(spectrum)
    noise_peak = np.median(level) + noise_peak_db(math.prod(spectrum.values.shape[:2]))
    velocity, distance = np.nonzero(level > max(floor + 3.0, noise_peak))
    return spectrum.range[distance], spectrum.velocity[velocity]


def _crop(panels, extent) -> None:
    if extent is None:
        return
    for axes in panels:
        left, right, bottom, top = axes.get_images()[0].get_extent()
        axes.set_xlim(max(left, extent[0]), min(right, extent[1]))
        axes.set_ylim(max(bottom, extent[2]), min(top, extent[3]))


def hold_points(axes, distance, velocity) -> None:
    """Widens the axes of a map by what points at [N] m and [N] m/s need, weak ones among them, to the ends of the map at most."""
    left, right, bottom, top = axes.get_images()[0].get_extent()
    for limits, limit, values, margin, ends in ((axes.get_xlim, axes.set_xlim, distance, RANGE_MARGIN, (left, right)),
                                                (axes.get_ylim, axes.set_ylim, velocity, VELOCITY_MARGIN, (bottom, top))):
        lowest, highest = limits()
        limit(min(lowest, max(ends[0], values.min() - margin), values.min()),
              max(highest, min(ends[1], values.max() + margin), values.max()))


def _small_print(figure, note: str) -> None:
    if note:
        figure.supxlabel(note, x=0.995, fontsize=6.5, color="0.4", horizontalalignment="right")  # the layout leaves it room
