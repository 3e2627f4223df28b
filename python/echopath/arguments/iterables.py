"""Arguments that hold one thing for each frame."""
from __future__ import annotations

from collections.abc import Mapping

from .checks import refused


def iterable(argument: str, value, rule: str):
    """The value, if it can be iterated and is neither text nor a table; raises TypeError with the rule otherwise."""
    if isinstance(value, (str, bytes, Mapping, set, frozenset, memoryview, type)):
        raise refused(TypeError, argument, rule, value)
    try:
        iter(value)
    except TypeError:
        raise refused(TypeError, argument, rule, value) from None
    return value
