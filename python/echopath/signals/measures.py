"""Figures of cubes and powers: in dBm, with their errors, and how far parts are from adding up."""
from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ..arguments.checks import ArrayLike, checked
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm


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


def residual(whole, parts: dict) -> float:
    """How far the parts are from adding up: |whole - sum of parts| / |whole|, 0 when both are zero."""
    difference = float(np.linalg.norm(whole - sum(parts.values())))
    return difference / float(np.linalg.norm(whole)) if difference > 0.0 else 0.0
