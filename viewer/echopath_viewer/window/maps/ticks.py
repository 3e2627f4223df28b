"""Round numbers along an axis."""
from __future__ import annotations

import math

from echopath.signals.measures import for_pictures

_RAISED = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")


def nice_ticks(low: float, high: float, max_count: float) -> list[float]:
    """Multiples of 1, 2 or 5 times a power of ten in [low, high], about `max_count` at most."""
    span = high - low
    if not span > 0.0 or max_count < 1.0:
        return []
    rough = span / max_count
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [step * number for number in range(first, math.floor(high / step + 1e-9) + 1)]


def axis_ticks(axis, low: float, high: float, max_count: float) -> list[float]:
    """Of what is seen of an axis; a single cell, as the velocity of one chirp, tells nothing apart and has its value alone."""
    if len(axis) > 1:
        return nice_ticks(low, high, max_count)
    return [float(axis[0])] if low <= axis[0] <= high else []


def nice_below(value: float) -> float:
    """The largest of 1, 2 or 5 times a power of ten that is no larger than `value`, above 0."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(factor * power for factor in (5.0, 2.0, 1.0) if factor * power <= value * (1.0 + 1e-9))


def scientific_text(value: float) -> str:
    """Two digits times a power of ten, as print has it."""
    mantissa, exponent = f"{value:.1e}".split("e")
    return for_pictures(mantissa) + "\u00b710" + str(int(exponent)).translate(_RAISED)


def tick_text(value: float) -> str:
    """Without the noise of binary fractions."""
    return for_pictures(f"{round(value, 9) + 0.0:g}")


def place_text(spectrum, distance: float, velocity: float, *, is_rough: bool = False) -> str:
    """Range in m and velocity in m/s with the decimals that the cells of a map have; is_rough: one less."""
    ranges, velocities = (_decimals(axis) - is_rough for axis in (spectrum.range, spectrum.velocity))
    return f"{distance:.{ranges}f} m, {velocity:+z.{velocities}f} m/s"


def _decimals(axis) -> int:
    """So that rounding takes no more than a sixth of a cell, two at least."""
    return max(2, math.ceil(0.5 - math.log10(step_of(axis)) - 1e-9))


def step_of(axis) -> float:
    return float(axis[1] - axis[0]) if len(axis) > 1 else 1.0
