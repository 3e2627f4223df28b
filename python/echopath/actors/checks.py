"""Checks of arguments at the rim: messages name the argument, the rule and the value."""
import difflib
import functools
import inspect
import math
import numbers


def number(name, value, low=-math.inf, high=math.inf, unit=""):
    """`value` as a float, which must be a finite number of [low, high]."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or not math.isfinite(value):
        raise ValueError(f"{name} must be a finite number, got {value!r}")
    if not low <= value <= high:
        raise ValueError(f"{name} must be {_range(low, high, unit)}, got {value!r}")
    return float(value)


def positive(name, value, unit="m"):
    """`value` as a float, which must be a finite number above 0."""
    value = number(name, value)
    if value <= 0:
        raise ValueError(f"{name} must be greater than 0 {unit}".rstrip() + f", got {value!r}")
    return value


def edge_length(value, size, triangles_per_square=4.0):
    """Tessellation length in m for a surface `size` m wide; None means as few triangles as the shape needs."""
    if value is None:
        return math.inf
    value = positive("edge", value)
    if triangles_per_square * (size / value) ** 2 > MAX_TRIANGLES:
        raise ValueError(f"edge must be long enough for less than {MAX_TRIANGLES} triangles, got {value!r} m")
    return value


def nearest_keywords(function):
    """Decorator: an unknown keyword argument raises TypeError that names the nearest right one."""
    names = list(inspect.signature(function).parameters)

    @functools.wraps(function)
    def checked(*args, **kwargs):
        for key in kwargs:
            if key not in names:
                near = difflib.get_close_matches(key, names, n=1, cutoff=0.5)
                hint = f"; did you mean '{near[0]}'?" if near else f"; known are {', '.join(names)}"
                raise TypeError(f"{function.__name__}() has no argument '{key}'{hint}")
        return function(*args, **kwargs)

    return checked


MAX_TRIANGLES = 20_000_000


def _range(low, high, unit):
    unit = f" {unit}" if unit else ""
    if math.isinf(high):
        return f"at least {low:g}{unit}"
    if math.isinf(low):
        return f"at most {high:g}{unit}"
    return f"from {low:g} to {high:g}{unit}"
