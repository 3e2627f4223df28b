"""A frame in one picture: its map, and what was detected in it."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from ..arguments.part_names import LEAKAGE
from ..arguments.shown import refused
from ..base.radar.velocities import folded
from .maps import MAP_SIZE, chosen_limits, colour_limits, draw_range_doppler, half_step, hold_points
from .points import draw_points
from .style import RANGE_LABEL, VELOCITY_LABEL, axes_or_new, require_drawable

if TYPE_CHECKING:
    from .. import _core
    from ..base.classes.foreign_types import Axes
    from ..detections import Detections
    from ..frame.frame import Frame
    from ..frame.maps import FrameMaps


def noise_words(frame) -> str:
    """What the titles of maps of a whole frame say of its noise."""
    return "" if frame.noise_seed is None else ", with its noise"


def title_of(frame) -> str:
    """The title of the map of a whole frame."""
    return "Everything that the radar receives" + noise_words(frame)


def limits_of_frame(frame) -> tuple[float, float]:
    """(lowest, highest) level in dBm of the colour scale of the map of a whole frame."""
    return colour_limits(frame.spectrum, frame.beside_spectra.get(LEAKAGE))


class _KeptMap(NamedTuple):
    """The map of a small file, drawn as the RangeDoppler of one channel that has its mean power."""

    values: NDArray[np.float64]
    velocity: NDArray[np.float64]
    range: NDArray[np.float64]


def draw_frame(frame: Frame | FrameMaps, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None,
               title: str | None = None) -> Axes:
    """The range-Doppler map of a frame with its noise, and all of its detections, where it has some, as points at their cells.

    frame: with its signals, or of a small file with its map; ax: axes to draw in, None: new ones; title: above them, None: what
        the map shows
    vmin, vmax: ends of the colour scale in dBm, None: `colour_limits` of the map and of the leakage in it, which small files
        do not tell
    Returns the axes, as `draw_range_doppler`. Raises TypeError naming `frame`, ValueError for a frame without a map.
    """
    require_drawable("frame", "a Frame or a FrameMaps", frame, "start_time", "velocity", "detections")
    spectrum, limits = _map_and_limits(frame)
    vmin, vmax = chosen_limits(limits, vmin, vmax)
    has_room = ax is None
    with axes_or_new(ax, *MAP_SIZE, (RANGE_LABEL, VELOCITY_LABEL)) as ax:
        draw_range_doppler(spectrum, ax=ax, vmin=vmin, vmax=vmax, title=title_of(frame) if title is None else title)
        if frame.detections is not None and len(frame.detections):
            found = _on_the_map(frame.detections, np.asarray(spectrum.velocity))
            draw_points(ax, found, has_room=has_room, edgecolors="white")
            hold_points(ax, found.range, found.velocity)
    return ax


def _map_and_limits(frame):
    """The map of a frame and the ends of its colour scale in dBm. Raises ValueError for a frame without a map."""
    if hasattr(frame, "spectrum"):
        if frame.spectrum is None:
            raise ValueError("frame: must have signals to draw, got a record of paths alone")
        return frame.spectrum, limits_of_frame(frame)
    if frame.power is None:
        raise refused(ValueError, "frame", "one with a map to draw, as files of keep='maps' and 'all' have", frame)
    kept = _KeptMap(np.sqrt(frame.power.astype(float))[None, None], frame.velocity, frame.range)
    return kept, colour_limits(cast("_core.RangeDoppler", kept))


def _on_the_map(detections: Detections, velocity: NDArray[np.float64]) -> Detections:
    """Detections with the velocities at which a map has their cells, for whatever turn of it they were resolved.

    velocity: axis of the map [V] in m/s
    """
    ambiguity = len(velocity) * 2.0 * half_step(velocity) if len(velocity) > 1 else 0.0
    beside = folded(detections.velocity - velocity[detections.cells[:, 0]], ambiguity)
    return dataclasses.replace(detections, velocity=velocity[detections.cells[:, 0]] + beside)
