"""Objects that take no attribute which they do not have: a misspelt one would change nothing, in silence."""
from __future__ import annotations

import dataclasses
from functools import cached_property
from typing import Any, TypeVar

from ... import _core

Kind = TypeVar("Kind", bound=type)


def known_attributes(kind: Kind) -> Kind:
    """Decorator of a class: setting what its objects do not have raises AttributeError, which names what may be meant; setting
    what can be read alone raises one that names what can be set.

    Names that begin with an underscore are taken, as classes have them for themselves. Objects of derived classes, which may
    have attributes of their own, take all unless their class is decorated, too.
    """
    set_attribute = kind.__setattr__
    fields = {field.name for field in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else set()

    def checked(self: object, name: str, value: Any) -> None:
        if type(self) is kind and not (name.startswith("_") or name in fields or hasattr(kind, name)):
            raise _unknown(kind, name, fields)
        if isinstance(member := getattr(kind, name, None), property) and member.fset is None:
            raise AttributeError(f"{name}: cannot be set; of {kind.__name__} {', '.join(sorted(fields | _settable(kind)))} can")
        set_attribute(self, name, value)

    kind.__setattr__ = checked  # type: ignore[method-assign,assignment]
    return kind


def _unknown(kind: type, name: str, fields: set[str]) -> AttributeError:
    """What says that objects of a class have no attribute of that name. fields: names of those of a dataclass"""
    meant = _core.meant_name(name, sorted(fields | _settable(kind)))
    return AttributeError(f"{name}: no attribute of {kind.__name__}" + (f", the nearest right one is '{meant}'" if meant else ""))


def _settable(kind: type) -> set[str]:
    """Names of the public properties of a class that can be set."""
    members = {name: getattr(kind, name, None) for name in dir(kind) if not name.startswith("_")}
    return {name for name, member in members.items()
            if isinstance(member, cached_property) or isinstance(member, property) and member.fset is not None}
