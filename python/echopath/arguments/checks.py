"""Checks of arguments: what a caller may pass, and what is said of the rest.

A rule is a function (argument, value) -> value as the work takes it; it raises TypeError for the wrong kind of value and
ValueError for a wrong one, in one form: "num_samples: must be a whole number from 1 to 1048576, got 0.5". `checked` holds
the arguments of a function to their rules and leaves its signature as it is written.
"""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .keywords import refuse_misplaced, refuse_unknown
from .number_rules import LARGEST_COUNT, Rule, carrier, count, positive, real, seed
from .shown import refused, shown
from .word_rules import (
    MapWindow,
    Window,
    choice,
    file,
    flag,
    flag_or_auto,
    is_writable,
    map_window,
    number_or_auto,
    one_of,
    path,
    text,
    window,
)

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")
Progress = Callable[[str, float], object] | bool | None            # (stage, fraction from 0 to 1); True: bars

KINDS = {"real": "iuf", "complex": "iufc", "whole": "iu"}


# --- objects ---

def an(*kinds: type, called: str = "") -> Rule:
    """An object of one of some classes."""
    names = called or " or ".join(f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}" for kind in kinds)

    def check(argument: str, value):
        if not isinstance(value, kinds):
            raise refused(TypeError, argument, names + _where_else(argument, value, kinds), value)
        return value

    return check


def _where_else(argument: str, value, kinds: tuple) -> str:
    """A hint at what was meant where a Frame, or another record of the package, stands in the place of what it holds."""
    is_own = type(value).__module__.startswith("echopath") and hasattr(type(value), "__dataclass_fields__")
    return f" (its .{argument} is one)" if is_own and isinstance(getattr(value, argument, None), kinds) else ""


def optional(rule: Rule) -> Rule:
    """None, or what a rule takes."""
    def check(argument: str, value):
        return None if value is None else rule(argument, value)

    return check


def anything(argument: str, value):
    """No rule: the function looks at the value itself."""
    return value


def progress(argument: str, value):
    """None, a callable (stage, fraction), or True for bars."""
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, type) or not callable(value) or not takes(value, "stage", 0.0):
        raise refused(TypeError, argument, "a callable (stage, fraction), True or None", value)
    return value


def takes(function: Callable[..., object], *values: object) -> bool:
    """Whether a function may be called with these values, as far as its signature is known."""
    try:
        inspect.signature(function).bind(*values)
    except ValueError:  # no signature
        return True
    except TypeError:
        return False
    return True


def keywords(of: str, known: tuple) -> Rule:
    """A dict of keywords of a function."""
    def check(argument: str, value) -> dict:
        if not isinstance(value, Mapping):
            raise refused(TypeError, argument, f"a dict of keywords of {of}", value)
        refuse_unknown(argument, value, known)
        return dict(value)

    return check


# --- arrays ---

def array(*shapes: str, kind: str = "real", finite: bool = False) -> Rule:
    """Numbers in one of some shapes, such as "[3]", "[N, 3]" or "[]" for a single one; not copied.

    kind: "real", "complex" or "whole"; finite: whether NaN and infinities are refused
    """
    words = {"real": "real numbers", "complex": "complex numbers", "whole": "whole numbers"}[kind]
    sizes = [[int(size) if size.strip().isdigit() else None for size in shape.strip("[]").split(",") if size.strip()]
             for shape in shapes]
    rule = f"an array {' or '.join(shapes)} of {'finite ' if finite else ''}{words}"

    def fits(found: np.ndarray) -> bool:
        return any(found.ndim == len(shape) and all(want in (None, got) for want, got in zip(shape, found.shape))
                   for shape in sizes)

    def check(argument: str, value) -> np.ndarray:
        if isinstance(value, (str, bytes, Mapping, set, frozenset)) or value is None:
            raise refused(TypeError, argument, rule, value)
        if hint := _where_else(argument, value, (np.ndarray,)):
            raise refused(TypeError, argument, rule + hint, value)
        if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
            raise refused(ValueError, argument, f"{rule}, none of them masked", value)
        try:
            found = np.asarray(value)
        except (TypeError, ValueError, OverflowError):  # ragged rows
            raise refused(ValueError, argument, rule, value) from None
        if kind == "whole" and found.dtype.kind == "f" and np.all(np.isfinite(found)) and np.all(found == np.rint(found)):
            found = found.astype(np.int64)
        if found.size and found.dtype.kind not in KINDS[kind]:
            raise refused(TypeError, argument, rule, value)
        if not fits(found):
            raise refused(ValueError, argument, rule, found)
        if finite and not np.isfinite(found).all():
            raise refused(ValueError, argument, rule, value)
        return found

    return check


vector = array("[3]", finite=True)


def row_of_channel(paths_or_radar, tx: int, rx: int) -> None:
    """Raises IndexError where a radar, or that of Paths, has no antenna of an index."""
    radar = getattr(paths_or_radar, "radar", paths_or_radar)
    for argument, value, antennas in (("tx", tx, radar.transmitters), ("rx", rx, radar.receivers)):
        if not value < len(antennas):
            raise IndexError(f"{argument}: must be below {len(antennas)}, the number of its antennas, got {value}")


# --- functions ---

MOST_NEIGHBOURS = 64  # cells on each side of one whose channels make a covariance

# Rules of arguments that are the same wherever they are asked for.
COMMON: dict[str, Rule] = {
    "radar": an(_core.Radar), "paths": an(_core.Paths), "scene": an(_core.Scene), "spectrum": an(_core.RangeDoppler),
    "cube": array("[T, R, C, S]", kind="complex"), "window": map_window, "zero_pad": count(1, 64), "progress": progress,
    "seed": seed, "tx": count(0, LARGEST_COUNT), "rx": count(0, LARGEST_COUNT), "path": file,
    "velocity_neighbours": count(0, MOST_NEIGHBOURS), "range_neighbours": count(0, MOST_NEIGHBOURS), "max_peaks": count(1, 64),
}


def checked(settings: Mapping[str, type] | None = None, within: Mapping[str, Iterable[str]] | None = None,
            **rules: Rule) -> Callable[
        [Callable[Parameters, Result]], Callable[Parameters, Result]]:
    """Decorator: the arguments of a call pass their rules; unknown keywords are refused with the nearest right one.

    rules: of the function's arguments; those that it shares with others may be left to COMMON
    within: {argument: the keys of the dict that it may be}, to which unknown keywords may belong
    settings: {argument: class of settings}: an argument that holds a settings object gives the keywords that the call
        leaves out
    """
    def decorate(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
        signature = inspect.signature(function)
        callee = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]
        order = tuple(signature.parameters)
        ruled = {name: rules[name] if name in rules else COMMON[name] for name in order if name not in (settings or {})}

        @functools.wraps(function)
        def call(*values: Any, **given: Any) -> Result:
            refuse_unknown(callee, given, order, within)
            for argument, kind in (settings or {}).items():
                given = _spread(argument, kind, given, order)
            refuse_misplaced(callee, signature, values, given)
            passed = [ruled[name](name, value) for name, value in zip(order, values)]
            return function(*passed, **{name: ruled[name](name, value) for name, value in given.items()})

        return call

    return decorate


def _spread(argument: str, kind: type, given: dict, known: tuple) -> dict:
    """Keywords of a call, with those of the settings object among them in its place."""
    holder = given.pop(argument, None)
    if holder is None:
        return given
    an(kind)(argument, holder)
    return {name: getattr(holder, name) for name in holder.__dataclass_fields__ if name in known} | given


__all__ = ["ArrayLike", "COMMON", "LARGEST_COUNT", "MOST_NEIGHBOURS", "MapWindow", "Progress", "Rule", "Window", "an",
           "anything", "array", "carrier", "checked", "choice", "count", "file", "flag", "flag_or_auto", "is_writable",
           "keywords", "map_window", "number_or_auto", "one_of", "optional", "path", "positive", "progress", "real", "refused",
           "row_of_channel", "seed", "shown", "text", "vector", "window"]
