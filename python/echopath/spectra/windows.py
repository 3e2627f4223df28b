"""Windows of transforms, and the two of a map as `range_doppler` takes them."""
from __future__ import annotations

import numpy as np

from .. import _core

_STEPS_IN_BIN = 64


def is_pair(window) -> bool:
    """Whether a map has two windows, (of range, of velocity), instead of one for both axes."""
    return not isinstance(window, str) and not isinstance(window[1], (int, float))


def of_range(window):
    """The window over the samples of a chirp, of the windows of a map."""
    return window[0] if is_pair(window) else window


def of_velocity(window):
    """The window over the chirps of a frame, of the windows of a map."""
    return window[1] if is_pair(window) else window


def samples_of(window, count: int) -> np.ndarray:
    """Samples [count] of one window: a name, or ("chebyshev", sidelobe level in dB)."""
    return _core.window(window, count) if isinstance(window, str) else _core.window(window[0], count, window[1])


def main_lobe_half_width(samples) -> float:
    """Bins from a tone to the first null of its response under a window, to 1/64, as guard cells of `cfar` have it.

    samples: [N] of the window
    """
    level = np.abs(np.fft.rfft(samples, _STEPS_IN_BIN * len(samples)))
    rises = np.flatnonzero(level[1:] >= level[:-1])
    return (rises[0] if len(rises) else len(level) - 1) / _STEPS_IN_BIN
