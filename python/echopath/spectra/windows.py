"""Windows of transforms, and the two of a map as `range_doppler` takes them."""
from __future__ import annotations

import numpy as np

from .. import _core


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
    """Samples [count] of one window: a name, or ("chebyshev", "taylor" or "kaiser", sidelobe level in dB)."""
    return _core.window(window, count) if isinstance(window, str) else _core.window(window[0], count, window[1])
