"""Keywords of calls: what is not known, missing or out of place is refused by name."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, ParamSpec, TypeVar

from .. import _core
from .shown import shown, writable

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


def refuse_unknown(callee: str, words: Iterable[object], known: Iterable[str],
                   within: Mapping[str, Iterable[str]] | None = None) -> None:
    """Raises TypeError naming the first of `words` that is not in `known`, and the one that was meant, or all that are not given.

    callee: name of the function, as its caller sees it; words, known: names of keywords
    within: {one of `known`: the keys of the dict that it may be}, of which the word may be one
    """
    known, words = list(known), list(words)
    for word in words:
        if word not in known:
            readable = writable(str(word))
            if homes := [f"{name}={{'{word}': ...}}" for name, keys in (within or {}).items() if word in keys]:
                raise TypeError(f"{callee}: unknown keyword '{readable}', it belongs to {' or '.join(homes)}")
            left = [name for name in known if name not in words and name != "self"]
            meant = _core.meant_name(readable, left)
            other = "other " if any(one in known for one in words) else ""
            hint = (f", the nearest right one is '{meant}'" if meant else
                    f"; its {other}arguments are {', '.join(left)}" if left else "")
            raise TypeError(f"{callee}: unknown keyword '{readable}'{hint}")


def refuse_misplaced(callee: str, signature: inspect.Signature, values: Sequence[object], given: Iterable[str]) -> None:
    """Raises TypeError where a call has too many values without names, one twice, or lacks one, and says what to write.

    callee: name of the function, as its caller sees it; values: those without names; given: names of the others
    """
    given = set(given)
    by_place = [one.name for one in signature.parameters.values() if one.kind is not one.KEYWORD_ONLY]
    by_name = [one.name for one in signature.parameters.values() if one.kind is one.KEYWORD_ONLY]
    surplus = values[len(by_place):]
    if surplus:
        said = [name for name in by_place if name != "self"]
        if _is_one_of_several_numbers(signature, said, values):
            written = f"{said[0]}={shown(tuple(values))}"
        else:
            written = ", ".join(f"{name}={shown(value)}" for name, value in
                                zip([name for name in by_name if name not in given], surplus))
        may_be_guessed = written and all(isinstance(value, str | bool | int | float | None) for value in surplus)
        takes = f"{', '.join(said)} alone" if said else "nothing"
        guess = f"; write {written} if that is meant" if may_be_guessed else ""
        raise TypeError(f"{callee}: takes {takes} without a name{guess}, got {shown(surplus[0])}")
    placed = set(by_place[:len(values)])
    for one in signature.parameters.values():
        if one.name in placed and one.name in given:
            raise TypeError(f"{callee}: argument '{one.name}' is given twice, by its place and by its name")
        if one.default is one.empty and one.name not in placed | given:
            raise TypeError(f"{callee}: argument '{one.name}' is missing")


def _is_one_of_several_numbers(signature: inspect.Signature, said: Sequence[str], values: Sequence[object]) -> bool:
    """Whether the values are numbers that the one parameter without a name takes together, as the sides of a box."""
    return (len(said) == 1 and "Sequence[float]" in str(signature.parameters[said[0]].annotation)
            and all(isinstance(value, int | float) and not isinstance(value, bool) for value in values))


def known_keywords(function: Callable[Parameters, Result], callee: str = "") -> Callable[Parameters, Result]:
    """Decorator: the call refuses keywords that are no parameters of the function; its signature stays as it is written.

    callee: what errors call it, "": by its name
    """
    signature = inspect.signature(function)
    name = callee or function.__name__

    @functools.wraps(function)
    def checked(*values: Any, **keywords: Any) -> Result:
        refuse_unknown(name, keywords, signature.parameters)
        refuse_misplaced(name, signature, values, keywords)
        return function(*values, **keywords)

    return checked


def parameters_of(function: Callable[..., object]) -> tuple[str, ...]:
    """Names of a function's parameters, in their order."""
    return tuple(inspect.signature(function).parameters)


def default_of(function: Callable[..., object], parameter: str) -> Any:
    """What a parameter of a function is unless it is given."""
    return inspect.signature(function).parameters[parameter].default
