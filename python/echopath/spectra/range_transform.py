"""The transform of chirps over their samples, as maps have it."""
from __future__ import annotations

import numpy as np


def range_transform(chirps, waveform, size: int | None = None) -> np.ndarray:
    """Cell k of [..., size] is range k c / (2 |slope|) fs / size: the sum over chirps [..., sample] of what an echo there makes.

    size: cells, None: the samples of a chirp. Echoes of chirps that fall have negative beat frequencies.
    """
    return np.fft.ifft(chirps, size, norm="forward") if waveform.falls else np.fft.fft(chirps, size)
