"""Rules of arguments that are numbers (see `checks`)."""
from __future__ import annotations

import math
import numbers
from collections.abc import Callable
from typing import Any

import numpy as np

from .._core import HIGHEST_FREQUENCY, LOWEST_FREQUENCY
from .shown import refused

Rule = Callable[[str, Any], Any]  # (argument, value) -> value as the work takes it

LARGEST_SEED = 2**64 - 1
LARGEST_COUNT = 2**31 - 1  # of what the core keeps in an int
LONGEST_TIME = 1e9         # s, from time 0: microseconds are still told apart


def _scalar(value):
    """The number in an array without axes, anything else as it is."""
    return value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value


def is_number(value) -> bool:
    """A real number of no unit: NumPy's spans of time are whole numbers to Python, of nanoseconds or whatever they count."""
    return isinstance(value, numbers.Real) and not isinstance(value, (bool, np.bool_, np.timedelta64))


def _range_words(low: float, high: float, unit: str = "") -> str:
    if math.isinf(low) and math.isinf(high):
        return f" in {unit}" if unit else ""
    unit = f" {unit}" if unit else ""
    if math.isinf(high):
        return f" of at least {_written(low)}{unit}"
    return f" from {_written(low)} to {_written(high)}{unit}" if math.isfinite(low) else f" of at most {_written(high)}{unit}"


def _written(limit: float) -> str:
    """All its digits, without the zeros of large powers of ten: 1000000, 1e+14."""
    short = f"{limit:.12g}"
    return short if float(short) == limit else f"{limit:.15g}"


def count(least: int = 0, most: int | None = None) -> Rule:
    """A whole number from `least` to `most`; 1e5, 128.0 and NumPy's integers are whole numbers too."""
    rule = f"a whole number of at least {least}" if most is None else f"a whole number from {least} to {most}"

    def check(argument: str, value) -> int:
        number = _scalar(value)
        if not is_number(number):
            raise refused(TypeError, argument, rule, value)
        is_whole = isinstance(number, numbers.Integral) or (math.isfinite(number) and number == int(number))
        if not is_whole or number < least or (most is not None and number > most):
            raise refused(ValueError, argument, rule, value)
        return int(number)

    return check


def real(low: float = -math.inf, high: float = math.inf, unit: str = "", *, above: float | None = None) -> Rule:
    """A finite number of [low, high], or one that is larger than `above`."""
    rule = "a finite number" + (_range_words(low, high, unit) if above is None else f" above {above:g} {unit}".rstrip())
    if above is not None and math.isfinite(high):
        rule += f", at most {_written(high)}"

    def check(argument: str, value) -> float:
        number = _scalar(value)
        if not is_number(number):
            raise refused(TypeError, argument, rule, value)
        try:
            number = float(number)
        except OverflowError:  # a whole number beyond 1e308
            number = math.inf
        if not math.isfinite(number) or not low <= number <= high or (above is not None and number <= above):
            raise refused(ValueError, argument, rule, value)
        return number

    return check


def positive(unit: str = "") -> Rule:
    """A finite number above 0."""
    return real(above=0.0, unit=unit)


carrier = real(LOWEST_FREQUENCY, HIGHEST_FREQUENCY, unit="Hz (77 GHz are 77e9)")


def seed(argument: str, value) -> int:
    """A whole number from 0 to 2^64 - 1."""
    return _seed(argument, value)


_seed = count(0, LARGEST_SEED)


unit_rule = real(1e-12, 1e9, "m")  # of a unit of a file
start_time_rule = real(-LONGEST_TIME, LONGEST_TIME, unit="s")
