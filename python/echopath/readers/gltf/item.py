"""Values of a JSON document that know their place, so that every fault is told with the file and the place."""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NoReturn

import numpy as np

from ... import _core
from ...arguments.checks import shown

_MISSING = object()


class Item:
    """A value, the file that it is from and its place there, "meshes[3].primitives[0]"."""

    __slots__ = ("value", "file", "place")

    def __init__(self, value: Any, file: str, place: str = ""):
        self.value, self.file, self.place = value, file, place

    def fail(self, what: str) -> NoReturn:
        raise _core.FileError(f"{self.file}: {self.place}: {what}" if self.place else f"{self.file}: {what}")

    def must_be(self, rule: str) -> NoReturn:
        self.fail(f"must be {rule}, is {'missing' if self.value is None else shown(self.value)}")

    def __getitem__(self, key: str) -> Item:
        """The value of a key, None where it is missing."""
        if not isinstance(self.value, dict):
            self.must_be("an object")
        return Item(self.value.get(key), self.file, f"{self.place}.{key}" if self.place else key)

    def __contains__(self, key: str) -> bool:
        return isinstance(self.value, dict) and key in self.value

    @property
    def is_given(self) -> bool:
        return self.value is not None

    def entries(self) -> list[Item]:
        """Of a list; none where it is missing."""
        if self.value is None:
            return []
        if not isinstance(self.value, list):
            self.must_be("a list")
        return [Item(value, self.file, f"{self.place}[{index}]") for index, value in enumerate(self.value)]

    def objects(self) -> list[Item]:
        """Of a list of objects."""
        found = self.entries()
        for entry in found:
            if not isinstance(entry.value, dict):
                entry.must_be("an object")
        return found

    def keys(self) -> Iterator[str]:
        """Of an object; none where it is missing."""
        if not isinstance(self.value, dict) and self.value is not None:
            self.must_be("an object")
        return iter(self.value or ())

    def whole(self, low: int, high: int, default: Any = _MISSING) -> Any:
        """A whole number from low to high."""
        if self.value is None and default is not _MISSING:
            return default
        number = self.value
        if isinstance(number, float) and number.is_integer():
            number = int(number)
        if not isinstance(number, int) or isinstance(number, bool) or not low <= number <= high:
            self.must_be(f"a whole number from {low} to {high}" if high >= low else "left out, as there is none")
        return number

    def index(self, count: int, default: Any = _MISSING) -> Any:
        """Of one of `count` entries."""
        return self.whole(0, count - 1, default)

    def flag(self, default: bool) -> bool:
        if self.value is None:
            return default
        if not isinstance(self.value, bool):
            self.must_be("true or false")
        return self.value

    def text(self, default: Any = _MISSING) -> Any:
        if self.value is None and default is not _MISSING:
            return default
        if not isinstance(self.value, str):
            self.must_be("text")
        return self.value

    def numbers(self, count: int | None, default: Any = _MISSING) -> Any:
        """Finite numbers [count] as an array."""
        if self.value is None and default is not _MISSING:
            return default
        rule = f"a list of {'' if count is None else f'{count} '}finite numbers"
        if not isinstance(self.value, list) or (count is not None and len(self.value) != count):
            self.must_be(rule)
        for entry in self.entries():
            if not _is_finite(entry.value):
                entry.must_be("a finite number")
        return np.array(self.value, np.float64)


def _is_finite(value) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False
