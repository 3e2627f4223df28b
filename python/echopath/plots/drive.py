"""Frames in time in one picture, and as a film."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..spectra.moving import STATIC_SPEED
from .maps import (
    CELLS_OF_MARGIN,
    MAP_SIZE,
    RANGE_MARGIN,
    VELOCITY_MARGIN,
    cells_of_scene,
    chosen_limits,
    draw_level,
    half_step,
    limits_above,
    margin_of,
    noise_peak_db,
)
from .style import MAP_COLOURS, RANGE_LABEL, TIME_LABEL, VELOCITY_LABEL, colour_bar, new_figure, set_title
from .time_maps import columns_over_time, image_over_time, show_within

SHEET_WIDTH, ROW_HEIGHT = 2.9, 3.0  # inches, of a map of the sheet, and of each row
LEAST_WIDTH = 8.0                   # inches, of the sheet
MOST_TIMES = 5                      # steps between ticks of a time axis, whose numbers are as long as -0.050
FILM_DPI = 110


class Driving(NamedTuple):
    """Of a radar that moves, in whose maps standing echoes have velocities, too, those of its own motion.

    own_speed: [T] m/s, by which the radar nears what stands straight ahead of it; movers: list [T] of arrays [N, 4], where what
        moves in the world is seen: nearest and farthest range in m, lowest and highest radial velocity in m/s, not folded
    """

    own_speed: np.ndarray
    movers: list


class Drive(NamedTuple):
    """Maps of frames in time.

    times: [T] s, starts of the frames; level: f16 [T, V, R] dBm, mean over channels, with noise
    velocity: [V] m/s, receding positive; range: [R] m; static_speed: m/s, up to which echoes count as standing still
    leaked: [V, R] dBm, what leaks into the receivers in each map, None: nothing; num_channels: of which the levels are means
    driving: of a radar that moves, None: it stands
    """

    times: np.ndarray
    level: np.ndarray
    velocity: np.ndarray
    range: np.ndarray
    static_speed: float = STATIC_SPEED
    leaked: np.ndarray | None = None
    num_channels: int = 1
    driving: Driving | None = None


def plot_drive(drive: Drive, *, num_frames=4, vmin=None, vmax=None, title=""):
    """Some of the maps in a row, evenly over time, and below them range and velocity over time, on one colour scale.

    Range over time is that of what moves, where something does: to a radar that stands, what has a velocity; to one that moves,
    what moves in the world. Where the radar moves, a dashed line marks the velocity of what stands straight ahead.
    drive: Drive; num_frames: maps in the row; title: above all
    vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, to the peak
    Returns a matplotlib figure: range in m across and radial velocity in m/s up (receding positive), below them time in s across.
    Raises TypeError or ValueError naming vmin or vmax.
    """
    vmin, vmax = chosen_limits(_limits(drive), vmin, vmax)
    places = np.unique(np.linspace(0, len(drive.times) - 1, min(num_frames, len(drive.times))).round().astype(int))
    with new_figure(max(SHEET_WIDTH * len(places) + 1.2, LEAST_WIDTH), 2.0 * ROW_HEIGHT) as figure:
        upper, lower = figure.subfigures(2, 1)
        panels = list(upper.subplots(1, len(places), sharex=True, sharey=True, squeeze=False).flat)
        for axes, place in zip(panels, places):
            image = _draw(axes, drive, place, vmin, vmax)
            axes.set_title(f"{drive.times[place]:.3f} s")
        _crop(panels, drive, vmin)
        panels[0].set_ylabel(VELOCITY_LABEL)
        upper.supxlabel(RANGE_LABEL, fontsize=9)
        below = list(lower.subplots(1, 2))
        for axes, column in zip(below, _columns(drive, vmin)):
            image_over_time(axes, drive.times, column.values, column.level, cmap=MAP_COLOURS, vmin=vmin, vmax=vmax)
            low, high = column.extent
            axes.set(xlabel=TIME_LABEL, ylabel=column.label)
            show_within(axes, column.values, low, high)
            axes.set_title(column.title)
            axes.locator_params(axis="x", nbins=MOST_TIMES)
        if drive.driving is not None:
            _draw_own_speed(below[1], drive)
        for part, shown in ((upper, panels), (lower, below)):
            colour_bar(part, image, shown, aspect=25)
        set_title(figure, title, 11)
    return figure


class _Column(NamedTuple):
    """Of an axis over time: its values and label, level [T, X] in dBm, ends that are shown, title."""

    values: np.ndarray
    label: str
    level: np.ndarray
    extent: tuple
    title: str


def _columns(drive: Drive, floor: float) -> tuple[_Column, _Column]:
    """Range over time of what moves, where something does, and velocity over time."""
    ranges, velocities = _extent(drive, floor)
    moving = _moving(drive, floor)
    words, by_range = moving or ("all velocities", np.stack([level.max(axis=0) for level in drive.level]))
    by_velocity = drive.level.max(axis=2).astype(np.float32)
    return (_Column(drive.range, RANGE_LABEL, by_range.astype(np.float32), ranges, f"strongest of {words}"),
            _Column(drive.velocity, VELOCITY_LABEL, by_velocity, velocities, "strongest of all ranges"))


def _moving(drive: Drive, floor: float) -> tuple[str, np.ndarray] | None:
    """(what it is, [T, R] dBm its strongest) of what moves, None where nothing does that stands out.

    To a radar that stands that is what has a velocity. One that moves sees velocities of all: there the cells count that the
    moving meshes of the scene are in, and all others are as dark as `floor`.
    """
    if drive.driving is None:
        is_moving = np.abs(drive.velocity) > drive.static_speed
        if not _stands_out(drive, floor)[is_moving].any():
            return None
        return "what moves", np.stack([level[is_moving].max(axis=0) for level in drive.level])
    shown, least, is_there = [], _least_signal(drive, floor), False
    for level, moves in zip(drive.level, _cells_of_movers(drive)):
        shown.append(np.where(moves, level, floor).max(axis=0))
        is_there |= bool((level[moves] > least).any())
    return ("what moves in the world", np.stack(shown)) if is_there else None


def _cells_of_movers(drive: Drive) -> Iterator[np.ndarray]:
    """Of each frame the cells [V, R] that what moves in the world is in, with the main lobe about it; velocities are folded."""
    step = 2.0 * half_step(drive.velocity)
    margin, period = max(drive.static_speed, step), step * len(drive.velocity)
    beside = CELLS_OF_MARGIN * 2.0 * half_step(drive.range)
    for boxes in drive.driving.movers:
        near, far, slow, fast = boxes.T[..., None]
        in_range = (drive.range >= near - beside) & (drive.range <= far + beside)
        in_velocity = (drive.velocity - (slow - margin)) % period <= fast - slow + 2.0 * margin
        yield in_velocity.T.astype(np.float32) @ in_range.astype(np.float32) > 0.0


def _draw_own_speed(axes, drive: Drive) -> None:
    """Where what stands straight ahead of a radar that moves is seen, folded as the axis is."""
    step = 2.0 * half_step(drive.velocity)
    low, period = drive.velocity[0] - 0.5 * step, step * len(drive.velocity)
    seen = (-drive.driving.own_speed - low) % period + low
    edges, columns = columns_over_time(drive.times)
    axes.stairs(np.where(columns < 0, np.nan, seen[columns]), edges, baseline=None, color="white", linestyle="--", linewidth=1.2)
    axes.set_title(f"{axes.get_title()}; dashed: what stands straight ahead")


def film_pictures(drive: Drive, *, vmin=None, vmax=None, title="") -> Iterator[np.ndarray]:
    """The maps one after the other as pictures u8 [height, width, 3], with the time; arguments as of `plot_drive`."""
    vmin, vmax = chosen_limits(_limits(drive), vmin, vmax)
    with new_figure(*MAP_SIZE) as figure:
        figure.set_dpi(FILM_DPI)
        axes = figure.subplots()
        image = _draw(axes, drive, 0, vmin, vmax)
        _crop([axes], drive, vmin)
        axes.set(xlabel=RANGE_LABEL, ylabel=VELOCITY_LABEL)
        colour_bar(figure, image, axes)
        for place, time in enumerate(drive.times):
            image.set_data(drive.level[place].astype(np.float32))
            axes.set_title(f"{title}{', ' if title else ''}{time:.3f} s")
            figure.canvas.draw()
            yield np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()


def _limits(drive: Drive) -> tuple[float, float]:
    """`limits_of_level` of all maps, taken one after the other: half precision has so few values that each is counted."""
    counts = np.zeros(2**16, np.int64)
    for level in drive.level:
        cells = np.ascontiguousarray(cells_of_scene(level, drive.leaked))
        counts += np.bincount(cells.view(np.uint16).ravel(), minlength=len(counts))
    found = np.flatnonzero(counts)
    levels = found.astype(np.uint16).view(np.float16).astype(float)
    order = np.argsort(levels)
    levels, up_to = levels[order], np.cumsum(counts[found][order])
    middle = levels[np.searchsorted(up_to, [(up_to[-1] - 1) // 2, up_to[-1] // 2], side="right")]
    return limits_above(middle.mean(), levels[-1])


def _draw(axes, drive: Drive, place: int, vmin: float, vmax: float):
    return draw_level(axes, drive.level[place].astype(np.float32), drive.range, drive.velocity, vmin, vmax)


def _extent(drive: Drive, floor: float) -> tuple:
    """((nearest, farthest) in m, (lowest, highest) in m/s) about the cells that stand out of the noise in some frame."""
    stands_out, found = _stands_out(drive, floor), []
    for values, margin, is_there in ((drive.range, RANGE_MARGIN, stands_out.any(axis=0)),
                                     (drive.velocity, VELOCITY_MARGIN, stands_out.any(axis=1))):
        shown, wide = values[is_there] if is_there.any() else values, margin_of(values, margin)
        found.append((shown.min() - wide, shown.max() + wide))
    return tuple(found)


def _stands_out(drive: Drive, floor: float) -> np.ndarray:
    """Cells [V, R] that stand out of the noise and of the floor of the colour scale in some frame."""
    return drive.level.max(axis=0) > _least_signal(drive, floor)


def _least_signal(drive: Drive, floor: float) -> float:
    """dBm, above which a cell is more than noise and stands out of the colour scale."""
    noise = np.median(drive.level[0].astype(np.float32))
    return max(floor + 3.0, noise + noise_peak_db(drive.num_channels))


def _crop(panels, drive: Drive, floor: float) -> None:
    (left, right), (bottom, top) = _extent(drive, floor)
    for axes in panels:
        ends = axes.get_images()[0].get_extent()
        axes.set(xlim=(max(left, ends[0]), min(right, ends[1])), ylim=(max(bottom, ends[2]), min(top, ends[3])))
