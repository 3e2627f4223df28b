"""Faults of a scene file in the words of the file: dotted path, rule, value."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from .. import _core
from ..arguments.shown import shown
from .tables.homes import headers, homes_of
from .tables.table import Table, nearest_key

Model = TypeVar("Model", bound=BaseModel)

_RULES = {
    "missing": "is missing",
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge}",
    "less_than_equal": "must be at most {le}",
    "finite_number": "must be finite",
    "int_type": "must be an integer",
    "float_type": "must be a number",
    "bool_type": "must be true or false",
    "string_type": "must be text",
    "list_type": "must be an array",
    "dict_type": "must be a table",
    "model_type": "must be a table",
    "too_short": "must have at least {min_length} entries",
    "too_long": "must have at most {max_length} entries",
    "string_too_short": "must not be empty",
    "literal_error": "must be {expected}",
    "union_tag_invalid": "has an unknown kind; known: {expected_tags}",
    "union_tag_not_found": "must be a table with a known kind",
}


# Kinds of values whose header has too few or too many brackets, [objects] in the place of [[objects]].
_BRACKETS = {("list_type", dict), ("dict_type", list), ("model_type", list)}


def _header(location: tuple) -> str:
    """What to say of the header of the table at a place, "" where it has none."""
    name = ".".join(item for item in location if isinstance(item, str))
    return next((f", under {header}" for header in (f"[[{name}]]", f"[{name}]") if header in headers()), "")


def _advice(key: str, table: type[Table], advice: str) -> str:
    """What to say about an unknown key of a table: what the table itself advises, or tables that have it, or keys of this one."""
    homes = homes_of(key, table)
    return advice or (f"it belongs to {homes}" if homes else nearest_key(key, table.model_fields))


def dotted(location) -> str:
    """('objects', 0, 'material', '<table>', 'scattering') -> 'objects[0].material.scattering'."""
    text = ""
    for item in location:
        if isinstance(item, int):
            text += f"[{item}]"
        elif not item.startswith("<"):
            text += f".{item}" if text else item
    return text


def one_line(error: dict, prefix: tuple = ()) -> str:
    """One fault of pydantic as 'dotted path: rule, got value'."""
    context = error.get("ctx", {})
    location = prefix + error["loc"]
    if error["type"] == "unknown_key":
        return f"{dotted(location + (context['key'],))}: unknown key; {_advice(**context)}"
    if error["type"] == "broken_rule":
        return f"{dotted(location + (context['key'],))}: {context['rule']}, got {shown(context['value'])}"
    if error["type"] == "refused":
        return f"{dotted(location)}{context['told']}"
    if error["type"] == "value_error":
        return f"{dotted(location)}: {context['error']}, got {shown(error['input'])}"
    rule = _RULES.get(error["type"], error["msg"]).format(**context).replace("'<", "'").replace(">'", "'")
    if error["type"] == "missing":
        return f"{dotted(location)}: {rule}"
    if (error["type"], type(error["input"])) in _BRACKETS:
        rule += _header(location)
    return f"{dotted(location)}: {rule}, got {shown(error['input'])}"


def describe(error: ValidationError, prefix: tuple = ()) -> str:
    """All faults, one line each, each line once."""
    lines = [one_line(fault, prefix) for fault in error.errors(include_url=False)]
    return "\n".join(dict.fromkeys(lines))


class ToldValueError(ValueError):
    """A fault whose message begins with the dotted path of its key."""


class ToldFileError(_core.FileError):
    """A fault of a file whose message begins with the dotted path of the key that names it."""


def validated(model: type[Model], data: Mapping[str, Any], prefix: tuple[str, ...] = ()) -> Model:
    """`data` as a `model`; raises ValueError with one line per fault, paths beginning with `prefix`."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise ToldValueError(describe(error, prefix)) from None


@contextmanager
def blamed(key: str, file: str = "") -> Iterator[None]:
    """Prefixes what the core refuses with the dotted path of the key it came from, unless one within has done so.

    file: dotted path below `key` of the key that names a file, for faults of that; "": the same key
    """
    try:
        yield
    except (ToldValueError, ToldFileError):
        raise
    except _core.FileError as error:
        raise ToldFileError(f"{key}{'.' if file else ''}{file}: {error}") from None
    except (ValueError, TypeError, KeyError) as error:
        text = str(error.args[0]) if error.args else str(error)
        raise ToldValueError(f"{key}: {text}") from None
