"""Maps over time: power by time and radial velocity, range or azimuth."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..arguments.checks import real
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..presentation.xarray_maps import time_map_array

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes, DataArray
    from .spectrogram_labels import SpectrogramLabels


@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class TimeMap:
    """What the maps over time have in common: arrays times [T] and power [T, X] over an axis whose name is AXIS."""

    times: np.ndarray
    power: np.ndarray
    noise_power: float
    window: str | tuple
    zero_pad: int
    part: str | None = None

    AXIS: ClassVar[str] = ""
    TITLE: ClassVar[str] = ""

    def plot(self, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None,
             title: str | None = None) -> Axes:
        """Draws the map: time in s across, its other axis up, colours in dBm.

        ax: Matplotlib axes to draw in, None: new ones; title: above the map, None: what it shows
        vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, as parts have no noise, to
            the peak
        Returns the axes: velocities in m/s (receding positive), ranges in m or azimuths in degrees up. Raises TypeError or
        ValueError naming the argument.
        """
        from ..plots import draw_time_map

        return draw_time_map(self, ax=ax, vmin=vmin, vmax=vmax, title=self._title() if title is None else title)

    def _title(self) -> str:
        return self.TITLE if self.part is None else f"{self.TITLE}: {self.part}"

    def to_xarray(self) -> DataArray:
        """The map as an xarray.DataArray, without a copy: W over time (s) and velocity (m/s), range (m) or azimuth (rad).

        Units stand in `attrs["units"]`. Needs xarray, raises ModuleNotFoundError without it.
        """
        return time_map_array(self)

    @property
    def axis(self) -> np.ndarray:
        """The axis beside time, [X]: velocity, range or azimuth."""
        return getattr(self, self.AXIS)

    @property
    def ridge(self) -> np.ndarray:
        """Where the strongest cell of each time is on the axis, [T]; NaN at times without power."""
        strongest = self.axis[np.argmax(self.power, axis=1)]
        return np.where(self.power.max(axis=1, initial=0.0) > 0.0, strongest, np.nan)

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if type(other) is type(self) else NotImplemented

    __hash__ = None

    def __repr__(self) -> str:
        span = f"{self.times[0]:.3f} to {self.times[-1]:.3f} s" if len(self.times) else "no times"
        return f"{type(self).__name__}({list(self.power.shape)}, {span}{self._more()})"

    def _more(self) -> str:
        return ""


@made_by("ep.spectrogram")
@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Spectrogram(TimeMap):
    """Received power by time and radial velocity; made by `spectrogram`.

    times: [T] s, middles of the windows; velocity: [V] m/s, ascending, receding positive
    power: [T, V] W, mean over the channels, summed over the ranges of the gate so that a point in it gives its received power
    noise_power: W, mean of the receiver's noise in a cell, whether the map has noise or not
    train: i32 [T], the train of chirps that each window lies in; trains: [N, 2] s, first and last end of each train: chirps
        that follow each other evenly, also from frame to frame; an end is where the next chirp would begin. No window spans
        the gap between two trains
    window_length, hop: chirps of one transmitter; window, zero_pad: as in `range_doppler`, padding of the velocities
    range_gate: (nearest, farthest) range that is summed, m
    part: what was asked for, as text, None: the whole; channel: (tx, rx), None: all
    labels: {view: SpectrogramLabels} where they were asked for, else None: a view for each partition of the frames, "objects"
        (objects by their own echoes, "ghosts", "other") and "families" (objects, each ghost, "other")
    """

    velocity: np.ndarray
    train: np.ndarray
    trains: np.ndarray
    window_length: int
    hop: int
    range_gate: tuple[float, float]
    channel: tuple[int, int] | None = None
    labels: dict[str, SpectrogramLabels] | Any = None  # None unless they were asked for

    AXIS, TITLE = "velocity", "Received power by time and radial velocity"

    def extent(self, below_peak_db: float = 30.0) -> tuple[np.ndarray, np.ndarray]:
        """How far the velocities of each time reach: those within so many dB of its strongest cell.

        below_peak_db: dB, 0 or more
        Returns (lowest, highest), [T] each in m/s, NaN at times without power. Raises ValueError.
        """
        below_peak_db = real(0.0, unit="dB")("below_peak_db", below_peak_db)
        peak = self.power.max(axis=1, keepdims=True)
        is_inside = self.power >= peak * 10.0 ** (-below_peak_db / 10.0)
        last = len(self.velocity) - 1
        lowest, highest = self.velocity[is_inside.argmax(axis=1)], self.velocity[last - is_inside[:, ::-1].argmax(axis=1)]
        is_empty = peak[:, 0] <= 0.0
        return np.where(is_empty, np.nan, lowest), np.where(is_empty, np.nan, highest)

    def _more(self) -> str:
        count = len(self.trains)
        gaps = "one train of chirps" if count == 1 else f"{count} trains of chirps: no window spans a gap between them"
        return f", {self.velocity[0]:.2f} to {self.velocity[-1]:.2f} m/s, {gaps}"


@made_by("ep.range_time")
@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class RangeTime(TimeMap):
    """Received power by time and range; made by `range_time`.

    times: [T] s, middles of the frames or windows; range: [R] m
    power: [T, R] W, mean over the channels; of all velocities the sum or the peak. A point gives its received power
    noise_power: W, mean of the receiver's noise in a cell; of peaks, and of coded transmitters, measured in one drawn map, up
        to 1 dB off where that has few cells; combine: "sum" or "peak"
    window, zero_pad: as in `range_doppler`
    velocity_gate: (lowest, highest) velocity that is taken, m/s
    part: what was asked for, as text, None: the whole; channel: (tx, rx), None: all
    """

    range: np.ndarray
    combine: str
    velocity_gate: tuple[float, float]
    channel: tuple[int, int] | None = None

    AXIS, TITLE = "range", "Received power by time and range"


@made_by("ep.angle_time")
@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class AngleTime(TimeMap):
    """Received power by time and azimuth; made by `angle_time`.

    times: [T] s, middles of the frames or windows; azimuth: [A] rad in the radar's frame, left positive
    power: [T, A] W; of all ranges of the gate the sum or the peak. A point gives its received power
    noise_power: W, mean of the receiver's noise in a cell, measured in one drawn map; combine: "sum" or "peak"
    window, zero_pad: as in `range_doppler`; range_gate: (nearest, farthest) range that is taken, m
    velocity_gate: (lowest, highest) velocity that was asked for, m/s, None: all
    part: what was asked for, as text, None: the whole
    """

    azimuth: np.ndarray
    combine: str
    range_gate: tuple[float, float]
    velocity_gate: tuple[float, float] | None = None

    AXIS, TITLE = "azimuth", "Received power by time and azimuth"
