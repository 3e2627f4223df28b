"""Whether a map holds the noise that detections are held against."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.callers import warn_user

# A quarter of the cells of thermal noise alone has less than .29 of its mean power, of several channels more; clutter adds to
# it. Maps of the fewest cells keep far above this share.
_QUANTILE, _LEAST_SHARE = 0.25, 0.05


def warn_of_missing_noise(radar, power) -> None:
    """Warns (RuntimeWarning) where a map has far less power in its weak cells than the radar's noise alone.

    radar: of the map; power: [velocity, range] in W, mean over channels
    """
    noise = _core.noise_power_in_cell(radar)
    if np.quantile(power, _QUANTILE) < _LEAST_SHARE * noise:
        has_converter = radar.receiver is not None and radar.receiver.adc is not None
        remedy = "its converter (Adc.gain_db) or a map without ep.add_noise has lost it" if has_converter else \
            "make the map of ep.add_noise(cube, radar)"
        warn_user(f"spectrum: holds no noise of the radar ({10.0 * np.log10(noise) + 30.0:.0f} dBm in a cell), so that "
                  f"detections are sidelobes and rounding; {remedy}")
