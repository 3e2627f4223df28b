"""The signal from chirp to chirp."""
from __future__ import annotations

import numpy as np

from echopath.plots.maps import SMALLEST_POWER


def power_by_chirp(cube, tx: int, rx: int):
    """Mean power over the samples of each chirp of a cube [tx, rx, chirp, sample], in dBm: [chirps]."""
    channel = np.asarray(cube[tx, rx])
    power = np.mean(channel.real ** 2 + channel.imag ** 2, axis=-1)
    return 10.0 * np.log10(np.maximum(power, SMALLEST_POWER) * 1e3)
