"""Which tables of a scene file have a key: for keys that stand in another one."""
from __future__ import annotations

import functools
import typing
from collections.abc import Iterator

from pydantic import BaseModel

from .schema import SceneTable

_TOP = "the top of the file, above all tables"
MOST_HOMES = 3  # a key that more tables have, such as position, tells nothing of the one that was meant


def homes_of(key: str, asking: type[BaseModel]) -> str:
    """The headers of the tables that have a key, "[trace] or [noise]"; "" where none or too many have it.

    asking: the table that has it not; of kinds of tables that stand in several places, such as motions, those below it are meant
    """
    found: dict[type[BaseModel], str] = {}
    if (top := SceneTable.model_fields.get(key)) is not None and not any(_named_in(top.annotation)):
        found[SceneTable] = _TOP
    for header, owner, table in _tables():
        if key in table.model_fields:
            kind = next((other for other in found if issubclass(table, other)), table)
            if kind not in found or owner is asking:
                found[kind] = header
    return " or ".join(found.values()) if len(found) <= MOST_HOMES else ""


def headers() -> set[str]:
    """The headers of all tables of a scene file: "[radar]", "[[objects]]"."""
    return {header for header, _, _ in _tables()}


@functools.cache
def _tables() -> tuple[tuple[str, type[BaseModel], type[BaseModel]], ...]:
    """(header, owner, table) of all tables of a scene file that have a header of their own."""
    return tuple(_below(SceneTable, ""))


def _below(owner: type[BaseModel], path: str) -> Iterator[tuple[str, type[BaseModel], type[BaseModel]]]:
    for name, field in owner.model_fields.items():
        for table, is_array in _named_in(field.annotation):
            yield (f"[[{path}{name}]]" if is_array else f"[{path}{name}]"), owner, table
            yield from _below(table, f"{path}{name}.")


def _named_in(kind, is_array: bool = False) -> Iterator[tuple[type[BaseModel], bool]]:
    """(table, whether an array of it) of the tables that an annotation names, but for those under names that the user gives."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield kind, is_array
    if typing.get_origin(kind) is not dict:
        for part in typing.get_args(kind):
            yield from _named_in(part, is_array or typing.get_origin(kind) is list)
