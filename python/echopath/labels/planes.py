"""The maps whose cells are labelled: how power, noise and axes of each come from cubes."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import shown
from ..spectra.angles import range_azimuth
from ..spectra.azimuth_map import checked_settings, sees_azimuth
from ..transmit import noise_apart
from .labels import AzimuthBox, AzimuthPeak, Box, Peak

_NOISE_SEED = 1  # of the noise whose mean in a range-azimuth map is measured


class RangeDopplerPlane:
    """Range-Doppler maps, power as mean over the channels; receivers may come one set at a time."""

    name = "range_doppler"
    rows_wrap = True  # velocities fold
    takes_receiver_sets = True

    def __init__(self, radar, window, zero_pad):
        """window, zero_pad: as in `range_doppler`"""
        self._settings, self.window_and_padding = {"window": window, "zero_pad": zero_pad}, (window, zero_pad)
        with_one = with_receivers(radar, slice(0, 1))
        empty = _core.range_doppler(_no_signal(with_one), with_one, **self._settings)
        self.velocity, self.azimuth, self.range = empty.velocity.copy(), None, empty.range.copy()
        self.noise_power = _core.cell_noise_power(radar, window)

    def power(self, cube, radar):
        """Power [V, R] in W of a cube [tx, rx, chirp, sample] of a radar with any of the receivers."""
        return _core.mean_power(_core.range_doppler(cube, radar, **self._settings))

    def require_errors(self) -> None:
        """Powers are means of |field|^2: standard errors can be had."""

    @property
    def rows(self):
        """Velocities [V] in m/s."""
        return self.velocity

    make_peak, make_box = Peak, Box


class RangeAzimuthPlane:
    """Range-azimuth maps by Bartlett beams, which are linear, so that the beams of parts are those of the whole."""

    name = "range_azimuth"
    rows_wrap = False
    takes_receiver_sets = False  # beams need all of them

    def __init__(self, radar, window, zero_pad, angles):
        """window, zero_pad: as in `range_doppler`; angles: keywords of `range_azimuth`, None: {"combine": "peak"}"""
        self._angles = checked_settings(radar, angles)
        if not sees_azimuth(radar, self._angles):
            raise ValueError("plane: 'range_azimuth' needs antennas side by side, and angles with an azimuth where they stand "
                             "tens of metres apart, got a radar that sees no azimuth")
        if self._angles.get("method", "bartlett") != "bartlett":
            raise ValueError("angles: method must be 'bartlett' for labels (Capon beams adapt to what they receive: those "
                             f"of a part are not those of the whole), got {self._angles['method']!r}")
        self._settings, self.window_and_padding = {"window": window, "zero_pad": zero_pad}, (window, zero_pad)
        noise = self._map(noise_apart(radar, _NOISE_SEED), radar)
        self.velocity, self.azimuth, self.range = None, noise.azimuth.copy(), noise.range.copy()
        self.noise_power = float(np.mean(noise.power))
        self._num_elevations = len(noise.elevation)

    def power(self, cube, radar):
        """Power [A, R] in W of a cube [tx, rx, chirp, sample]."""
        return self._map(cube, radar).power

    def require_errors(self) -> None:
        """Raises ValueError where the power of a cell is the largest of several: its error is not that of a mean."""
        is_peak = self._angles.get("velocity") is None and self._angles.get("combine", "sum") == "peak"
        if is_peak or self._num_elevations > 1:
            raise ValueError("errors: in the plane 'range_azimuth' need angles with combine='sum' or a velocity, and one "
                             f"elevation, got {self._angles} and {self._num_elevations} elevations")

    @property
    def rows(self):
        """Azimuths [A] in rad."""
        return self.azimuth

    make_peak, make_box = AzimuthPeak, AzimuthBox

    def _map(self, cube, radar):
        return range_azimuth(_core.range_doppler(cube, radar, **self._settings), radar, **self._angles)


def make_plane(name: str, radar, window, zero_pad, angles):
    """The plane of a name. Raises ValueError for other names, and for angles where there are none."""
    if name == RangeAzimuthPlane.name:
        return RangeAzimuthPlane(radar, window, zero_pad, angles)
    if name != RangeDopplerPlane.name:
        raise ValueError(f"plane: must be 'range_doppler' or 'range_azimuth', got {name!r}")
    if angles is not None:
        raise ValueError(f"angles: are for the plane 'range_azimuth', got {shown(angles)} for 'range_doppler'")
    return RangeDopplerPlane(radar, window, zero_pad)


def with_receivers(radar, which: slice):
    """The radar with some of its receivers."""
    return radar.replace(receivers=radar.receivers[which])


def _no_signal(radar):
    waveform = radar.waveform
    return np.zeros((len(radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples))
