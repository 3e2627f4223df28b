"""Checks of arguments: what a caller may pass, and what is said of the rest.

A rule is a function (argument, value) -> value as the work takes it; it raises TypeError for the wrong kind of value and
ValueError for a wrong one, in one form: "num_samples: must be a whole number from 1 to 1048576, got 0.5". `checked` holds
the arguments of a function to their rules and leaves its signature as it is written.
"""
from __future__ import annotations

import functools
import inspect
import math
import numbers
import os
from collections.abc import Callable, Mapping
from typing import Any, Literal, ParamSpec, TypeVar, get_args

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .keywords import refuse_misplaced, refuse_unknown
from .shown import shown, writable

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")
Rule = Callable[[str, Any], Any]
Progress = Callable[[str, float], object] | bool | None            # (stage, fraction from 0 to 1); True: bars
WindowName = Literal["rect", "hann", "hamming", "blackman_harris"]
Window = WindowName | tuple[Literal["chebyshev"], float]           # a name, or with its sidelobe level in dB
MapWindow = Window | tuple[Window, Window]                         # of both axes of a map, or those of (range, velocity)

LARGEST_SEED = 2**64 - 1
LONGEST_NAME, LONGEST_PATH = 255, 4096  # bytes of the name of a file and of all folders with it
LARGEST_COUNT = 2**31 - 1  # of what the core keeps in an int
KINDS = {"real": "iuf", "complex": "iufc", "whole": "iu"}


def refused(kind: type[Exception], argument: str, rule: str, value) -> Exception:
    """The error to raise: "argument: must be rule, got value"."""
    return kind(f"{argument}: must be {rule}, got {shown(value)}")


# --- numbers ---

def _scalar(value):
    """The number in an array without axes, anything else as it is."""
    return value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value


def _is_number(value) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, (bool, np.bool_))


def _range_words(low: float, high: float, unit: str = "") -> str:
    if math.isinf(low) and math.isinf(high):
        return f" in {unit}" if unit else ""
    unit = f" {unit}" if unit else ""
    if math.isinf(high):
        return f" of at least {low:.15g}{unit}"
    return f" from {low:.15g} to {high:.15g}{unit}" if math.isfinite(low) else f" of at most {high:.15g}{unit}"


def count(least: int = 0, most: int | None = None) -> Rule:
    """A whole number from `least` to `most`; 1e5, 128.0 and NumPy's integers are whole numbers too."""
    rule = f"a whole number of at least {least}" if most is None else f"a whole number from {least} to {most}"

    def check(argument: str, value) -> int:
        number = _scalar(value)
        if not _is_number(number):
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
        rule += f", at most {high:.15g}"

    def check(argument: str, value) -> float:
        number = _scalar(value)
        if not _is_number(number):
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


def seed(argument: str, value) -> int:
    """A whole number from 0 to 2^64 - 1."""
    return _seed(argument, value)


_seed = count(0, LARGEST_SEED)


# --- words ---

def flag(argument: str, value) -> bool:
    """True or False, NumPy's too."""
    if not isinstance(value, (bool, np.bool_)):
        raise refused(TypeError, argument, "True or False", value)
    return bool(value)


def flag_or_auto(argument: str, value) -> bool | Literal["auto"]:
    """True or False, NumPy's too, or "auto"."""
    if isinstance(value, str) and value == "auto":
        return "auto"
    if not isinstance(value, (bool, np.bool_)):
        raise refused(ValueError if isinstance(value, str) else TypeError, argument, "True, False or 'auto'", value)
    return bool(value)


def choice(*names: str) -> Rule:
    """One of some words."""
    quoted = [f"'{name}'" for name in names]
    rule = " or ".join(filter(None, [", ".join(quoted[:-1]), quoted[-1]]))

    def check(argument: str, value) -> str:
        if not isinstance(value, str):
            raise refused(TypeError, argument, rule, value)
        if value not in names:
            raise refused(ValueError, argument, rule, value)
        return str(value)

    return check


def one_of(literal) -> Rule:
    """One of the words of a typing.Literal."""
    return choice(*get_args(literal))


def text(argument: str, value) -> str:
    """Text that can be written as UTF-8, without NUL."""
    if not isinstance(value, str):
        raise refused(TypeError, argument, "text", value)
    if not is_writable(value):
        raise refused(ValueError, argument, "text without lone surrogates and NUL", value)
    return str(value)


def is_writable(value: str) -> bool:
    """Whether text can be written as UTF-8 and read back from C."""
    return "\0" not in value and not any("\ud800" <= letter <= "\udfff" for letter in value)


def path(argument: str, value) -> str:
    """The name of a file or folder: text or an os.PathLike."""
    try:
        name = os.fspath(value)
    except Exception:  # an object may raise anything when it is asked for its name
        raise refused(TypeError, argument, "the name of a file", value) from None
    if not isinstance(name, str):
        raise refused(TypeError, argument, "the name of a file as text", value)
    if not name or not is_writable(name):
        raise refused(ValueError, argument, "the name of a file, without lone surrogates and NUL", value)
    if len(os.fsencode(name)) >= LONGEST_PATH or max(map(len, os.fsencode(name).split(b"/"))) > LONGEST_NAME:
        raise refused(_core.FileError, argument, "the name of a file that can be", name)
    return name


def file(argument: str, value) -> str:
    """The name of a file, which is no folder."""
    name = path(argument, value)
    if os.path.isdir(name):
        raise refused(_core.FileError, argument, "the name of a file, not of a folder", value)
    return name


def window(argument: str, value):
    """A window by its name, or ("chebyshev", sidelobe level in dB)."""
    names = get_args(WindowName)
    rule = ", ".join(f"'{name}'" for name in names) + " or ('chebyshev', sidelobe level in dB)"
    if isinstance(value, str):
        if value not in (*names, "chebyshev"):
            known = (*names, "chebyshev")
            nearest = _core.meant_name(writable(value), known) or _core.nearest_names(writable(value), known, 1)[0]
            raise refused(ValueError, argument, f"{rule} (nearest: {nearest})", value)
        return str(value)
    if not (isinstance(value, (tuple, list)) and len(value) == 2 and isinstance(value[0], str) and _is_number(value[1])):
        raise refused(TypeError, argument, rule, value)
    if value[0] != "chebyshev" or not (math.isfinite(value[1]) and value[1] > 0.0):
        raise refused(ValueError, argument, rule, value)
    return str(value[0]), float(value[1])


def map_window(argument: str, value):
    """The windows of a map: one for both of its axes, or a pair of them, (of range, of velocity)."""
    if not (isinstance(value, (tuple, list)) and len(value) == 2 and not _is_number(value[1])):
        return window(argument, value)
    of_range, of_velocity = (window(f"{argument}[{axis}]", one) for axis, one in enumerate(value))
    return of_range if of_range == of_velocity else (of_range, of_velocity)


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
    if isinstance(value, type) or not callable(value) or not _takes(value, "stage", 0.0):
        raise refused(TypeError, argument, "a callable (stage, fraction), True or None", value)
    return value


def _takes(function: Callable[..., object], *values: object) -> bool:
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

# Rules of arguments that are the same wherever they are asked for.
COMMON: dict[str, Rule] = {
    "radar": an(_core.Radar), "paths": an(_core.Paths), "scene": an(_core.Scene), "spectrum": an(_core.RangeDoppler),
    "cube": array("[T, R, C, S]", kind="complex"), "window": map_window, "zero_pad": count(1, 64), "progress": progress,
    "seed": seed, "tx": count(0, LARGEST_COUNT), "rx": count(0, LARGEST_COUNT), "path": file,
}


def checked(settings: Mapping[str, type] | None = None, **rules: Rule) -> Callable[
        [Callable[Parameters, Result]], Callable[Parameters, Result]]:
    """Decorator: the arguments of a call pass their rules; unknown keywords are refused with the nearest right one.

    rules: of the function's arguments; those that it shares with others may be left to COMMON
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
            refuse_unknown(callee, given, order)
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


__all__ = ["ArrayLike", "COMMON", "MapWindow", "Progress", "Rule", "Window", "an", "anything", "array", "checked", "choice",
           "count", "file", "flag", "is_writable", "keywords", "map_window", "one_of", "optional", "path", "positive",
           "progress", "real", "refused", "row_of_channel", "seed", "shown", "text", "vector", "window"]
