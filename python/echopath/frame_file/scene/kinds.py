"""Groups that hold one value of several classes: which it is stands in their attribute `kind` (layout: data/README.md)."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from ... import _core
from ..h5 import read_attribute, write_attribute


class Kind(NamedTuple):
    """A class whose values a group may hold, and how its contents are written (group, value) and read (group)."""

    made: type
    write: Callable[[Any, Any], None]
    read: Callable[[Any], Any]


def write_kind(group, value, kinds: dict[str, Kind], rule: str) -> None:
    """Writes a value as one of {kind: Kind}; rule: what the argument `motion` must be. Raises ValueError for other classes."""
    for name, kind in kinds.items():
        if isinstance(value, kind.made):
            write_attribute(group, "kind", name)
            kind.write(group, value)
            return
    raise ValueError(f"motion: must be {rule}, got {value!r}")


def read_kind(group, kinds: dict[str, Kind], what: str):
    """The value of a group; what: the kinds are kinds of, for errors. Raises ep.FileError."""
    name = read_attribute(group, "kind", str)
    if name not in kinds:
        raise _core.FileError(f"{group.name}: unknown kind of {what} '{name}'")
    return kinds[name].read(group)
