"""Angle spectra: received power by direction in one cell of the map."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from .style import (
    AZIMUTH_ALONE_LABEL,
    AZIMUTH_LABEL,
    ELEVATION_LABEL,
    MAP_COLOURS,
    POWER_LABEL,
    axes_or_new,
    require_drawable,
)

if TYPE_CHECKING:
    from .. import _core
    from ..base.classes.foreign_types import Axes

SHOWN_DB = 50.0  # below the peak


def draw_angle_spectrum(spectrum: _core.AngleSpectrum, range: float | None = None, velocity: float | None = None, *,
                        ax: Axes | None = None, title: str = "") -> Axes:
    """Power by direction in one cell: a curve, or a map where the array is a plane.

    spectrum: AngleSpectrum; range: m, velocity: m/s, of the cell, the nearest is taken; None: those of the strongest cell
    ax: axes to draw in, None: new ones; title: above the place of the cell
    Returns the axes: angles in degrees, power in dBm. Raises TypeError naming `spectrum` or `ax`.
    """
    require_drawable("spectrum", "an AngleSpectrum, as ep.angle_fft makes it of a spectrum", spectrum, "values", "azimuth")
    row, column = _cell(spectrum, range, velocity)
    level = in_dbm(np.abs(spectrum.values[:, :, row, column]) ** 2, SMALLEST_POWER)
    with axes_or_new(ax, 7.0, 4.4, _labels(spectrum)) as ax:
        _draw(ax, spectrum, level)
        place = f"at {spectrum.range[column]:.2f} m, {spectrum.velocity[row]:+z.2f} m/s"
        ax.set_title(f"{title}\n{place}" if title else place)
    return ax


def _cell(spectrum, distance, velocity) -> tuple:
    """(velocity, range) indices of the cell nearest to what is given, the strongest of those that are left open."""
    power = np.sum(np.abs(spectrum.values) ** 2, axis=(0, 1))
    rows = np.arange(len(power)) if velocity is None else [_nearest("velocity", spectrum.velocity, velocity, "m/s")]
    columns = np.arange(power.shape[1]) if distance is None else [_nearest("range", spectrum.range, distance, "m")]
    among = power[np.ix_(rows, columns)]
    row, column = np.unravel_index(int(among.argmax()), among.shape)
    return int(rows[row]), int(columns[column])


def _nearest(name: str, axis, value, unit: str) -> int:
    half = 0.5 * (axis[1] - axis[0]) if len(axis) > 1 else np.inf
    if not axis[0] - half <= value <= axis[-1] + half:
        raise ValueError(f"{name}: must lie in {axis[0]:.6g} to {axis[-1]:.6g} {unit}, got {value}")
    return int(np.argmin(np.abs(np.asarray(axis) - value)))


def _labels(spectrum) -> tuple[str, str]:
    """Of the axes across and up: a map of both angles, or the curve of the one that the array tells apart."""
    across, up = (np.count_nonzero(np.isfinite(angles)) > 1 for angles in (spectrum.azimuth, spectrum.elevation))
    if across and up:
        return AZIMUTH_ALONE_LABEL, ELEVATION_LABEL
    return ELEVATION_LABEL if up else AZIMUTH_LABEL, POWER_LABEL


def _draw(ax, spectrum, level) -> None:
    """level: [elevation, azimuth] dBm; directions beyond +-90 degrees, from where no wave comes, are left out."""
    azimuth, elevation = np.degrees(spectrum.azimuth), np.degrees(spectrum.elevation)
    across, up = np.flatnonzero(np.isfinite(azimuth)), np.flatnonzero(np.isfinite(elevation))
    level = level[np.ix_(up, across)]
    highest = float(level.max())
    ax.set(**dict(zip(("xlabel", "ylabel"), _labels(spectrum))))
    if len(across) > 1 and len(up) > 1:
        image = ax.pcolormesh(azimuth[across], elevation[up], level, cmap=MAP_COLOURS, vmin=highest - SHOWN_DB, vmax=highest,
                              shading="nearest", rasterized=True)
        ax.set_xlim(max(ax.get_xlim()[0], -90.0), min(ax.get_xlim()[1], 90.0))
        ax.set_ylim(max(ax.get_ylim()[0], -90.0), min(ax.get_ylim()[1], 90.0))
        ax.xaxis.set_inverted(True)  # left is left, as seen from the radar
        ax.figure.colorbar(image, ax=ax, label=POWER_LABEL, extend="min", pad=0.02, aspect=30)
        return
    is_upright = len(up) > 1
    angles = elevation[up] if is_upright else azimuth[across]
    ax.plot(angles, level.ravel(), color="#0072b2", linewidth=1.4, marker="o" if len(angles) == 1 else None)
    peaks = [np.max(line.get_ydata()) for line in ax.lines if line.get_transform() is ax.transData]
    ax.set_ylim(min(peaks) - SHOWN_DB, max(peaks) + 3.0)  # of all curves in these axes
    if not is_upright and len(angles) > 1:
        ax.xaxis.set_inverted(True)  # left is left, as seen from the radar
    ax.grid(alpha=0.25)
