"""Keywords of calls: what is not known is refused by name."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from typing import Any, ParamSpec, TypeVar

from . import _core

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


def refuse_unknown(callee: str, words: Iterable[object], known: Iterable[str]) -> None:
    """Raises TypeError naming the first of `words` that is not in `known`, and the nearest that is.

    callee: name of the function, as its caller sees it; words, known: names of keywords
    """
    known, words = list(known), list(words)
    for word in words:
        if word not in known:
            readable = str(word).encode("utf-8", "backslashreplace").decode("utf-8")
            left = [name for name in known if name not in words and name != "self"]
            nearest = _core.nearest_names(readable, left, 1)
            hint = f", the nearest right one is '{nearest[0]}'" if nearest else ""
            raise TypeError(f"{callee}: unknown keyword '{readable}'{hint}")


def known_keywords(function: Callable[Parameters, Result], callee: str = "") -> Callable[Parameters, Result]:
    """Decorator: the call refuses keywords that are no parameters of the function; its signature stays as it is written.

    callee: what errors call it, "": by its name
    """
    known = parameters_of(function)
    name = callee or function.__name__

    @functools.wraps(function)
    def checked(*values: Any, **keywords: Any) -> Result:
        refuse_unknown(name, keywords, known)
        return function(*values, **keywords)

    return checked


def parameters_of(function: Callable[..., object]) -> tuple[str, ...]:
    """Names of a function's parameters, in their order."""
    return tuple(inspect.signature(function).parameters)
