"""Short Fourier transforms over the chirps of range profiles."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _core
from ..spectra.windows import of_velocity, samples_of

_VALUES_AT_A_TIME = 1 << 17  # complex, of the transforms of some windows: 2 MiB, which stay in the processor's cache


class Axes(NamedTuple):
    """velocity: [V] m/s; range: [R] m, of a map of `range_doppler` of some chirps."""

    velocity: np.ndarray
    range: np.ndarray


def with_chirps(radar, num_chirps: int):
    """The radar with frames of so many chirps, whose maps have the axes of its own: shares of "ddm" need not divide them."""
    code = {"multiplexing": "cdm", "code_phases": np.zeros((len(radar.transmitters), 1))} if radar.multiplexing == "ddm" else {}
    return radar.replace(waveform=radar.waveform.replace(num_chirps=num_chirps), **code)


def axes_of(radar, num_chirps: int, zero_pad: int = 1) -> Axes:
    """Axes of the maps of `num_chirps` chirps: velocities padded to `zero_pad` times as many, ranges not padded."""
    one = with_chirps(radar, num_chirps).replace(receivers=radar.receivers[:1])
    shape = (len(radar.transmitters), 1, num_chirps, radar.waveform.num_samples)
    velocity = _core.range_doppler(np.zeros(shape), one, "rect", zero_pad).velocity
    return Axes(velocity.copy(), _core.range_doppler(np.zeros(shape), one, "rect", 1).range.copy())


def noise_bandwidth(window, count: int) -> float:
    """Equivalent noise bandwidth of one window in cells (Harris 1978, eq. 11): a point's power over all cells by its peak."""
    weights = samples_of(window, count)
    return count * float(np.sum(weights**2)) / float(np.sum(weights)) ** 2


def velocity_powers(profiles, starts, window_length: int, window, zero_pad: int):
    """Powers [T, V] in W over the chirps of profiles [tx, rx, chirp, N]: mean over channels, summed over the N ranges.

    starts: [T] indices of the first chirps of the windows
    """
    weights, size = samples_of(of_velocity(window), window_length), window_length * zero_pad
    weights = weights / np.sum(weights)
    channels = profiles.reshape(-1, *profiles.shape[2:])
    power = np.zeros((len(starts), size))
    at_a_time = max(1, _VALUES_AT_A_TIME // max(size * channels.shape[-1], 1))
    for channel in channels:
        windows = np.lib.stride_tricks.sliding_window_view(channel, window_length, axis=0).swapaxes(1, 2)  # [chirp, L, N]
        for first in range(0, len(starts), at_a_time):
            bins = np.fft.fft(windows[starts[first:first + at_a_time]] * weights[:, None], size, axis=1)
            power[first:first + at_a_time] += sum(np.einsum("tvn,tvn->tv", part, part) for part in (bins.real, bins.imag))
    return np.fft.fftshift(power, axes=1) / len(channels)
