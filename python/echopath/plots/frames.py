"""A frame in one picture: its map, and what was detected in it."""
from __future__ import annotations

from typing import TYPE_CHECKING

from ..arguments.part_names import LEAKAGE
from .maps import MAP_SIZE, chosen_limits, colour_limits, draw_range_doppler, hold_points
from .points import draw_points
from .style import axes_or_new

if TYPE_CHECKING:
    from ..base.foreign_types import Axes
    from ..frame.frame import Frame


def noise_words(frame) -> str:
    """What the titles of maps of a whole frame say of its noise."""
    return "" if frame.noise_seed is None else ", with its noise"


def title_of(frame) -> str:
    """The title of the map of a whole frame."""
    return "Everything that the radar receives" + noise_words(frame)


def limits_of_frame(frame) -> tuple[float, float]:
    """(lowest, highest) level in dBm of the colour scale of the map of a whole frame."""
    return colour_limits(frame.spectrum, frame.beside_spectra.get(LEAKAGE))


def draw_frame(frame: Frame, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None,
               title: str | None = None) -> Axes:
    """The range-Doppler map of a frame with its noise, and all of its detections, where it has some, as points.

    ax: axes to draw in, None: new ones; vmin, vmax: ends of the colour scale in dBm, None: `limits_of_frame`
    title: None: what it shows
    Returns the axes, as `draw_range_doppler`. Raises ValueError for a record of paths alone.
    """
    if frame.spectrum is None:
        raise ValueError("frame: must have signals to draw, got a record of paths alone")
    vmin, vmax = chosen_limits(limits_of_frame(frame), vmin, vmax)
    has_room = ax is None
    with axes_or_new(ax, *MAP_SIZE) as ax:
        draw_range_doppler(frame.spectrum, ax=ax, vmin=vmin, vmax=vmax, title=title_of(frame) if title is None else title)
        if frame.detections is not None and len(frame.detections):
            draw_points(ax, frame.detections, has_room=has_room, edgecolors="white")
            hold_points(ax, frame.detections.range, frame.detections.velocity)
    return ax
