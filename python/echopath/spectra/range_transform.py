"""The transform of chirps over their samples, as maps have it."""
from __future__ import annotations

import numpy as np

from ..arguments.checks import MapWindow
from ..arguments.settings import SignalSettings
from .windows import of_range, samples_of


def range_transform(chirps, waveform, size: int | None = None) -> np.ndarray:
    """Cell k of [..., size] is range k c / (2 |slope|) fs / size: the sum over chirps [..., sample] of what an echo there makes.

    size: cells, None: the samples of a chirp. Echoes of chirps that fall have negative beat frequencies.
    """
    return np.fft.ifft(chirps, size, norm="forward") if waveform.falls else np.fft.fft(chirps, size)


def range_taper(waveform, window) -> np.ndarray:
    """Weights [N] of the samples of a chirp, by which the transform of an echo has the echo's amplitude at its range.

    window: of a map of `range_doppler`. A real sample has half of its amplitude at positive frequencies, as real maps count it.
    """
    weights = samples_of(of_range(window), waveform.num_samples)
    return weights * ((np.sqrt(2.0) if waveform.real else 1.0) / weights.sum())


def range_profiles(cube, waveform, *, window: MapWindow = SignalSettings.window, zero_pad: int = 1) -> np.ndarray:
    """The range stage of `range_doppler`: chirps [..., sample] over cells of range [..., R], complex in sqrt(W).

    window, zero_pad: of the map. Of real samples the second half of the cells are those of negative frequencies.
    """
    return range_transform(np.asarray(cube) * range_taper(waveform, window), waveform, zero_pad * waveform.num_samples)
