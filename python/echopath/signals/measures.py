"""Figures of cubes and maps: power, velocities, how far parts are from adding up."""
from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import ArrayLike, checked
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..spectra.windows import of_velocity, samples_of

STATIC_SPEED = 0.25       # m/s, below it an echo counts as standing still, however narrow the cells of velocity are
EXTENT_BELOW_PEAK_DB = 30.0


def power_dbm(cube) -> float:
    """Mean power of a cube [tx, rx, chirp, sample] in dBm; -inf for zeros.

    Of this one realisation of the random phases; `ep.received_power` has the mean over them and its standard error.
    """
    return in_dbm(float(np.mean(cube.real**2 + cube.imag**2)))


@checked()
def power_by_chirp(cube: ArrayLike, *, tx: int = 0, rx: int = 0) -> NDArray[np.float64]:
    """Mean power over the samples of each chirp: the slow-time signal of a channel.

    cube: [tx, rx, chirp, sample] in sqrt(W); tx, rx: indices of the channel's antennas
    Returns the powers in dBm, [chirps], -2970 dBm for zeros. Raises IndexError for antennas that are not there.
    """
    for argument, index, size in (("tx", tx, len(cube)), ("rx", rx, cube.shape[1])):
        if index >= size:
            raise IndexError(f"{argument}: must be below {size}, the number of its antennas, got {index}")
    channel = cube[tx, rx]
    return in_dbm(np.mean(channel.real ** 2 + channel.imag ** 2, axis=-1), SMALLEST_POWER)


def with_error(power) -> str:
    """An ep.ReceivedPower in dBm +- dB, half its 95 % interval; the ends of the interval where it is not resolved."""
    if power.resolved:
        return f"{in_dbm(power.power):.2f} dBm +- {power.interval_db:.2f} dB"
    if not power.high > 0.0:
        return "nothing"
    high = f"{in_dbm(power.high):.2f} dBm"
    ends = f"{in_dbm(power.low):.2f} to {high}" if power.low > 0.0 else f"below {high}"
    return f"not resolved, {ends}"


def for_pictures(text: str) -> str:
    """Numbers as print has them: minus signs instead of hyphens, and ±."""
    return re.sub(r"(?<![\w.])-(?=\d)", "\u2212", text.replace("+-", "\u00b1"))


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


def residual(whole, parts: dict) -> float:
    """How far the parts are from adding up: |whole - sum of parts| / |whole|, 0 when both are zero."""
    difference = float(np.linalg.norm(whole - sum(parts.values())))
    return difference / float(np.linalg.norm(whole)) if difference > 0.0 else 0.0
