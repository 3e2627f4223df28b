"""Values of a template that follow what stands, or is drawn, elsewhere in it: {same_as = "trace.start_time", plus = 0.2}."""
from __future__ import annotations

import re
from typing import Any, NamedTuple

from ...arguments.shown import shown
from .distributions import REFERENCE, is_number

_BESIDE = {"times", "plus"}
_STEP = re.compile(r"(?:^|\.)([^.\[\]]+)|\[(\d+)\]")


def is_reference(value: Any) -> bool:
    """Whether a value of a template follows another."""
    return isinstance(value, dict) and isinstance(value.get(REFERENCE), str) and value.keys() <= {REFERENCE} | _BESIDE


def refuse_wrong_reference(table: dict[str, Any], place: str) -> None:
    """Raises ValueError naming the key of a table that was to be a reference; place: its dotted path."""
    if REFERENCE not in table or is_reference(table):
        return
    if not isinstance(table[REFERENCE], str):
        raise ValueError(f"{place}.{REFERENCE}: must be the dotted path of a key of the template, got {shown(table[REFERENCE])}")
    word = next(key for key in table if key not in {REFERENCE} | _BESIDE)
    raise ValueError(f"{place}.{word}: unknown key beside {REFERENCE}, which takes {', '.join(sorted(_BESIDE))}")


def changed(value: Any, table: dict[str, Any], place: str) -> Any:
    """The value that is followed, times and plus the numbers of a reference. Raises ValueError naming the dotted path."""
    given = {word: table[word] for word in sorted(_BESIDE & table.keys())}
    for word, number in given.items():
        if not is_number(number):
            raise ValueError(f"{place}.{word}: must be a number, got {shown(number)}")
    if not given:
        return value
    if not is_number(value):
        raise ValueError(f"{place}.{REFERENCE}: must be the dotted path of a number, beside {' and '.join(given)}, got that of "
                         f"{shown(value)}")
    return value * given.get("times", 1) + given.get("plus", 0)


class Step(NamedTuple):
    """One of the way to a value: its key or index, and the dotted path from the begin to there."""

    key: str | int
    path: str


def places_of(entries: list[Any]) -> list[str]:
    """The dotted path of each entry of a template's objects, "" of one without a name.

    It has the name of the entry. Where an entry at the root or an earlier one may have copies of that name, it is that of what
    carries it, too; or the number of the entry in its place, where that is drawn or has such copies as well.
    """
    named = [one if isinstance(one, dict) and isinstance(one.get("name"), str) else {} for one in entries]
    taken = [(f"objects.{one['name']}", one) for one in named if one and not one.get("parent")]
    found = []
    for index, one in enumerate(named):
        name, carrier = one.get("name", ""), one.get("parent")
        ways = [f"objects.{name}", f"objects.{carrier}/{name}" if isinstance(carrier, str) else "", f"objects[{index}]/{name}"]
        place = "" if not one else ways[0] if not carrier else next(
            way for way in ways if way and not any(_meet(way, one, *other) for other in taken))
        found.append(place)
        taken.append((place, one))
    return found


def copies_of(place: str, entry: dict[str, Any]) -> str:
    """A regular expression for the dotted paths of the objects of an entry."""
    return re.escape(place) + (r"_[1-9]\d*" if "count" in entry else "")


def _meet(place: str, entry: dict[str, Any], other_place: str, other: dict[str, Any]) -> bool:
    """Whether objects of two entries may have one path."""
    return bool(place == other_place or re.fullmatch(copies_of(place, entry), other_place)
                or re.fullmatch(copies_of(other_place, other), place))


class Source:
    """What a template says, by dotted paths. rest: all but its objects; objects: its entries, which go by `places_of`"""

    def __init__(self, rest: dict[str, Any], objects: Any):
        self._rest = rest
        entries = objects if isinstance(objects, list) else []
        self._entries = [(place, one) for place, one in zip(places_of(entries), entries) if place]

    def walk(self, path: str) -> tuple[Any, str, list[Step]]:
        """The way to the value at a path: (the table in which it begins, the path of that table, the steps from there on).
        Raises KeyError where it is no path of the template."""
        table, begin = self._begin(path)
        return table, begin, _steps(path[len(begin):].removeprefix("." if begin else ""), begin)

    def _begin(self, path: str) -> tuple[Any, str]:
        """The table in which a path begins, an object by its name or all the rest, and the path of that table."""
        for place, entry in self._entries:
            if found := re.match(copies_of(place, entry) + r"(?=\.)", path):
                return entry, found[0]
        if path.startswith("objects"):
            raise KeyError(path)
        return self._rest, ""


def _steps(path: str, begin: str) -> list[Step]:
    """Those of a dotted path that goes on from another. Raises KeyError where it is none."""
    found, end = [], 0
    for match in _STEP.finditer(path):
        if match.start() != end:
            raise KeyError(path)
        end = match.end()
        key: str | int = match[1] if match[1] is not None else int(match[2])
        begin += f"[{key}]" if isinstance(key, int) else f".{key}" if begin else key
        found.append(Step(key, begin))
    if end != len(path) or not found:
        raise KeyError(path)
    return found
