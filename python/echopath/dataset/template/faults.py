"""Faults of a template in the words of its file: the line, the scene, the key by the name of its object, the rule."""
from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ... import _core
from ...scene_file.lines import key_lines, line_of, with_table
from .distributions import with_kinds
from .references import copies_of, places_of

_PLACE = re.compile(r"objects\[(\d+)\]")  # of an object among those that were drawn


class Faults:
    """Says the faults of a template; path: of its file; table: that is written there."""

    def __init__(self, path: Path, table: dict[str, Any]):
        self._path = path
        objects = table.get("objects") if isinstance(table.get("objects"), list) else []
        self._copies = [copies_of(place, entry) if place else "" for place, entry in zip(places_of(objects), objects)]
        self._lines = key_lines(path.read_text(encoding="utf-8-sig"))

    @contextmanager
    def of(self, number: int, drawn: dict[str, Any]) -> Iterator[None]:
        """Tells what the block raises of scene `number`, whose table is drawn."""
        try:
            yield
        except ValueError as error:
            raise self.told(error, number, drawn) from None
        except _core.FileError as error:  # of a file that the scene names
            raise _core.FileError(str(self.told(ValueError(str(error)), number, drawn))) from None

    def told(self, error: ValueError, number: int | None = None, drawn: dict[str, Any] | None = None) -> ValueError:
        """The error with file, line and scene before each fault; objects of one entry that have the same fault say it once.

        number: of the scene, None: of no scene; drawn: table of the scene, whose objects give their names, None: they have them
        """
        scene = "" if number is None else f"scene {number}: "
        lines: dict[tuple[int | None, str], str] = {}
        for text in str(error).splitlines():
            if text.startswith("  "):  # goes on from the line before
                lines[len(lines), text] = text
                continue
            key, colon, rule = with_table(self._named(text.removeprefix(f"{self._path}: "), drawn), self._lines).partition(": ")
            line = line_of(f"{self._written(key)}: {rule}", self._lines)
            where = f"{self._path}: " if line is None else f"{self._path}: line {line}: "
            lines.setdefault((line, rule or key), where + scene + with_kinds(key + colon + rule))
        return ValueError("\n".join(lines.values()))

    def _named(self, text: str, drawn: dict[str, Any] | None) -> str:
        """A fault whose object has its name in the place of its number."""
        place = _PLACE.match(text)
        if drawn is None or place is None:
            return text
        one = next(iter(drawn["objects"][int(place[1]):]), None)
        if not isinstance(one, dict) or not isinstance(one.get("name"), str):
            return text
        full, own = f"objects.{one.get('parent')}/{one['name']}", f"objects.{one['name']}"
        return (own if self._written(full) == full else full) + text[place.end():]

    def _written(self, key: str) -> str:
        """The key as the template has it: objects.car_2.yaw stands at objects[1].yaw, if the second entry is that of cars."""
        for index, copies in enumerate(self._copies):
            if copies and (found := re.match(rf"{copies}(?=\.|$)", key)):
                return f"objects[{index}]{key[found.end():]}"
        return f"dataset.{key}" if key in ("frames", "interval") else key
