"""What moves in a map, and what a map cannot tell from what stands still."""
from __future__ import annotations

import numpy as np

from .. import _core
from .windows import of_velocity, samples_of

STATIC_SPEED = 0.25       # m/s, below it an echo counts as standing still, however narrow the cells of velocity are
EXTENT_BELOW_PEAK_DB = 30.0


def static_speed(velocity, window, zero_pad: int) -> float:
    """Speed in m/s up to which a map cannot tell an echo from one at rest: the window's main lobe, STATIC_SPEED at least.

    velocity: [V] m/s, axis of the map; window, zero_pad: of `range_doppler`
    """
    if len(velocity) < 2:
        return STATIC_SPEED
    bin_width = zero_pad * (velocity[-1] - velocity[0]) / (len(velocity) - 1)
    bins = _core.main_lobe_half_width(samples_of(of_velocity(window), len(velocity) // zero_pad))
    return max(STATIC_SPEED, float(bins * bin_width))


def velocity_extent(spectrum, below_peak_db: float = EXTENT_BELOW_PEAK_DB):
    """(lowest, highest) radial velocity in m/s in a map; None when nothing moves.

    Counted are velocities whose power over all ranges and channels is at most `below_peak_db` below that of the strongest
    moving one; a planted foot, which stands still, counts too.
    """
    profile = np.sum(np.abs(spectrum.values) ** 2, axis=(0, 1, 3))
    at_rest = static_speed(spectrum.velocity, spectrum.window, spectrum.zero_pad)
    peak = profile[np.abs(spectrum.velocity) > at_rest].max(initial=0.0)
    if peak == 0.0:
        return None
    velocities = spectrum.velocity[profile >= peak * 10.0 ** (-below_peak_db / 10.0)]
    return float(velocities.min()), float(velocities.max())
