"""The noise that detections are held against, and whether a map holds it."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.numerics.decibels import in_dbm
from ..base.process.callers import warn_user

# A quarter of the cells of thermal noise alone has less than .29 of its mean power, of several channels more; clutter adds to
# it. Maps of the fewest cells keep far above this share.
_QUANTILE, _LEAST_SHARE = 0.25, 0.05


def warn_of_missing_noise(radar, power, of_filters) -> None:
    """Warns (RuntimeWarning) where a map has far less power in its weak cells than the radar's noise alone.

    radar: of the map; power: [velocity, range] in W, mean over channels; of_filters: gains [range] of amplitudes
    """
    noise = _core.noise_power_in_cell(radar)
    if np.mean(power < _LEAST_SHARE * noise * of_filters ** 2) > _QUANTILE:
        warn_user(f"spectrum: holds no noise of the radar ({in_dbm(noise):.0f} dBm in a cell), so that "
                  f"detections are sidelobes and rounding; {_way_out(radar.receiver)}")


def mean_noise(radar, window, cells, of_filters, beams=None) -> np.ndarray:
    """Mean power [N] of thermal noise in W in cells [N, 2] of a map, of a channel or in a beam.

    window: of the map; of_filters: gains [range] of amplitudes; beams: weights [N, tx, rx] of the beams of the cells, None: none
    """
    of_channel = _core.cell_noise_power(radar, window) * of_filters[cells[:, 1]] ** 2
    return of_channel if beams is None else of_channel * np.sum(np.abs(beams) ** 2, axis=(1, 2))


def _way_out(receiver) -> str:
    """What brings the noise into the map; receiver: of the radar, None: an ideal one."""
    if receiver is None:
        return "make the map of ep.add_noise(cube, radar)"
    if receiver.adc is None:
        return "make the map of ep.receive(cube, radar, seed=1).cube"
    setting = "lower headroom_db" if receiver.adc.automatic_gain else "raise gain_db"
    return (f"if it came through the converter, the noise lies below a step of it: {setting} of receiver.adc or take more "
            "bits; if not, make the map of ep.receive(cube, radar, seed=1).cube")
