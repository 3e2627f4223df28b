"""Keywords of calls: what is not known is refused by name."""
from __future__ import annotations

import functools
import inspect

from . import _core


def refuse_unknown(callee: str, words, known) -> None:
    """Raises TypeError naming the first of `words` that is not in `known`, and the nearest that is.

    callee: name of the function, as its caller sees it; words, known: names of keywords
    """
    known = list(known)
    for word in words:
        if word not in known:
            nearest = _core.nearest_names(word, known, 1)[0]
            raise TypeError(f"{callee}: unknown keyword '{word}', the nearest right one is '{nearest}'")


def parameters_of(function) -> tuple:
    """Names of a function's own keywords; not those that **keywords passes on."""
    return tuple(name for name, parameter in inspect.signature(function).parameters.items()
                 if parameter.kind in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY))


def known_keywords(function=None, *, also=()):
    """Decorator: the call refuses keywords that are neither parameters of the function nor in `also`."""
    if function is None:
        return functools.partial(known_keywords, also=also)
    known = (*parameters_of(function), *also)

    @functools.wraps(function)
    def checked(*values, **keywords):
        refuse_unknown(function.__name__, keywords, known)
        return function(*values, **keywords)

    return checked
