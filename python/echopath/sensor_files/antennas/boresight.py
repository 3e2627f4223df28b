"""Patterns over theta and phi of a file's own axes, brought to the antenna's frame."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...base.process.callers import warn_user
from .grids import Grid

AXES = {"x": (0, 1, 2), "y": (1, 2, 0), "z": (2, 0, 1)}  # of the file: those along the antenna's x, y and z
FINEST = np.radians(0.5)  # rad: steps of the new table, which has 259,920 samples then
COARSEST = np.radians(2.0)
OFF = np.radians(45.0)    # a beam farther from the boresight is taken for a mistaken axis
DIRECTED = 0.3            # of the length of the mean direction of the power: below it an antenna has no beam


def turned(grid: Grid, axes: tuple[int, int, int], normalize: bool) -> _core.AntennaPattern:
    """The pattern of a grid over theta and phi, sampled anew over azimuth and elevation.

    axes: those of the file along the antenna's x, y and z
    """
    in_file = grid.table(normalize)
    if axes == AXES["x"]:
        _warn_of_mean(in_file.azimuth, in_file.elevation, in_file.table_gain)
        return in_file
    step = np.clip(0.5 * _smallest_step(in_file), FINEST, COARSEST)
    azimuth = np.linspace(-np.pi, np.pi, round(2.0 * np.pi / step), endpoint=False)
    elevation = np.linspace(-0.5 * np.pi, 0.5 * np.pi, round(np.pi / step) + 1)
    ahead = _directions(azimuth, elevation)
    toward = np.empty_like(ahead)
    toward[..., list(axes)] = ahead
    field = in_file.field(toward.reshape(-1, 3)).reshape(toward.shape[:-1])
    gain, phase = np.abs(field) ** 2, None if in_file.table_phase is None else np.angle(field)
    _warn_of_mean(azimuth, elevation, gain)
    return _core.GainTable(azimuth=azimuth, elevation=elevation, gain=gain, phase=phase, normalize=normalize)


def _smallest_step(pattern: _core.AntennaPattern) -> float:
    return float(min(np.diff(pattern.azimuth).min(), np.diff(pattern.elevation).min()))


def _directions(azimuth: NDArray[np.float64], elevation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit vectors [E, A, 3]."""
    across = np.cos(elevation)[:, None]
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth),
                     np.broadcast_to(np.sin(elevation)[:, None], across.shape[:1] + azimuth.shape)], axis=-1)


def _warn_of_mean(azimuth, elevation, gain) -> None:
    """Warns where the power goes far off the boresight in the mean."""
    power = gain * np.cos(elevation)[:, None]
    mean = np.tensordot(power, _directions(azimuth, elevation), axes=2) / power.sum()
    if (length := np.linalg.norm(mean)) > DIRECTED and (off := np.arccos(np.clip(mean[0] / length, -1, 1))) > OFF:
        warn_user(f"load_antenna: the power of the pattern goes {np.degrees(off):.0f} degrees off the boresight in the mean; "
                  "boresight= names the axis of the file along which the antenna looks")
