"""Types of fields whose rule keeps another value than it was given, such as an array as a tuple.

They are descriptors to type checkers alone: `__set__` tells what a keyword takes, `__get__` what is read (PEP 681). At run time
nothing is made of them: their defaults are plain values, by `kept`.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..arguments.checks import ArrayLike

Row = tuple[float, ...]
Table = tuple[Row, ...]


class Numbers:
    """[N] numbers, kept as a tuple."""

    if TYPE_CHECKING:
        def __get__(self, instance: object, owner: type) -> Row: return ()
        def __set__(self, instance: object, value: ArrayLike) -> None: ...


class NumberTable:
    """[N, M] numbers, kept as a tuple of tuples."""

    if TYPE_CHECKING:
        def __get__(self, instance: object, owner: type) -> Table: return ()
        def __set__(self, instance: object, value: ArrayLike) -> None: ...


class NumberPair:
    """Two numbers, kept as a tuple."""

    if TYPE_CHECKING:
        def __get__(self, instance: object, owner: type) -> tuple[float, float]: return 0.0, 0.0
        def __set__(self, instance: object, value: ArrayLike) -> None: ...


def kept(default: object) -> Any:
    """The default of such a field. default: as it is kept."""
    return default
