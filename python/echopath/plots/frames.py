"""A frame in one picture: its map, and what was detected in it."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from ..arguments.part_names import LEAKAGE
from ..base.radar.velocities import ambiguity_of, folded
from .maps import MAP_SIZE, chosen_limits, colour_limits, draw_range_doppler, hold_points
from .points import draw_points
from .style import axes_or_new, require_drawable

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes
    from ..detections import Detections
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
    """The range-Doppler map of a frame with its noise, and all of its detections, where it has some, as points at their cells.

    frame: with its signals; ax: axes to draw in, None: new ones; title: above them, None: what the map shows
    vmin, vmax: ends of the colour scale in dBm, None: `colour_limits` of the map and of the leakage in it
    Returns the axes, as `draw_range_doppler`. Raises TypeError naming `frame`, ValueError for a record of paths alone.
    """
    require_drawable("frame", "a Frame", frame, "spectrum", "detections")
    if frame.spectrum is None:
        raise ValueError("frame: must have signals to draw, got a record of paths alone")
    vmin, vmax = chosen_limits(limits_of_frame(frame), vmin, vmax)
    has_room = ax is None
    with axes_or_new(ax, *MAP_SIZE) as ax:
        draw_range_doppler(frame.spectrum, ax=ax, vmin=vmin, vmax=vmax, title=title_of(frame) if title is None else title)
        if frame.detections is not None and len(frame.detections):
            found = _on_the_map(frame.detections, frame.spectrum, ambiguity_of(frame.radar))
            draw_points(ax, found, has_room=has_room, edgecolors="white")
            hold_points(ax, found.range, found.velocity)
    return ax


def _on_the_map(detections: Detections, spectrum: _core.RangeDoppler, ambiguity: float) -> Detections:
    """Detections with the velocities at which the map has their cells, for whatever turn of it they were resolved."""
    beside = folded(detections.velocity - np.asarray(spectrum.velocity)[detections.cells[:, 0]], ambiguity)
    return dataclasses.replace(detections, velocity=np.asarray(spectrum.velocity)[detections.cells[:, 0]] + beside)
