"""Rules of arguments that are words, names of files and windows (see `checks`)."""
from __future__ import annotations

import os
from typing import Literal, get_args

import numpy as np

from .. import _core
from .folder_kinds import folder_hint
from .number_rules import Rule, is_number
from .shown import refused, writable

WindowName = Literal["rect", "hann", "hamming", "blackman", "blackman_harris", "chebyshev", "taylor", "kaiser"]
LevelWindow = Literal["chebyshev", "taylor", "kaiser"]             # of 80, 35 and 60 dB where nothing is said
Window = WindowName | tuple[LevelWindow, float]                    # a name, or with its sidelobe level in dB
MapWindow = Window | tuple[Window, Window]                         # of both axes of a map, or those of (range, velocity)

LONGEST_NAME, LONGEST_PATH = 255, 4096  # bytes of the name of a file and of all folders with it


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


def number_or_auto(rule: Rule) -> Rule:
    """A number that a rule takes, or "auto"."""
    def check(argument: str, value) -> float | Literal["auto"]:
        if isinstance(value, str) and value == "auto":
            return "auto"
        if isinstance(value, str):
            raise refused(ValueError, argument, "a number or 'auto'", value)
        return rule(argument, value)

    return check


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
        raise refused(_core.FileError, argument, f"the name of a file, not of a folder{folder_hint(name)}", value)
    return name


def window(argument: str, value, or_else: str = ""):
    """A window by its name, or ("chebyshev", "taylor" or "kaiser", sidelobe level in dB).

    or_else: what refusals of anything but a name tell that it may be, too
    """
    names, with_level = get_args(WindowName), get_args(LevelWindow)
    rule = (", ".join(f"'{name}'" for name in names)
            + f" or ({', '.join(map(repr, with_level[:-1]))} or {with_level[-1]!r}, sidelobe level in dB, 20 to 300)")
    if isinstance(value, str):
        if value not in names:
            nearest = _core.meant_name(writable(value), names) or _core.nearest_names(writable(value), names, 1)[0]
            raise refused(ValueError, argument, f"{rule} (nearest: {nearest})", value)
        return str(value)
    if not (isinstance(value, (tuple, list)) and len(value) == 2 and isinstance(value[0], str) and is_number(value[1])):
        raise refused(TypeError, argument, rule + or_else, value)
    if value[0] not in with_level or not 20.0 <= value[1] <= 300.0:
        raise refused(ValueError, argument, rule + or_else, value)
    return str(value[0]), float(value[1])


def map_window(argument: str, value):
    """The windows of a map: one for both of its axes, or a pair of them, (of range, of velocity)."""
    if not (isinstance(value, (tuple, list)) and len(value) == 2 and not is_number(value[1])):
        return window(argument, value, ", or a pair of these, of range and of velocity")
    of_range, of_velocity = (window(f"{argument}[{axis}]", one) for axis, one in enumerate(value))
    return of_range if of_range == of_velocity else (of_range, of_velocity)
