"""Objects that take no attribute which they do not have: a misspelt one would change nothing, in silence."""
from __future__ import annotations

import dataclasses
from functools import cached_property
from typing import Any, TypeVar

from .. import _core

Kind = TypeVar("Kind", bound=type)


def known_attributes(kind: Kind) -> Kind:
    """Decorator of a class: setting what its objects do not have raises AttributeError, which names what may be meant.

    Names that begin with an underscore are taken, as classes have them for themselves. Objects of derived classes, which may
    have attributes of their own, take all unless their class is decorated, too.
    """
    set_attribute = kind.__setattr__

    def checked(self: object, name: str, value: Any) -> None:
        if type(self) is kind and not name.startswith("_"):
            _refuse_unknown(kind, name)
        set_attribute(self, name, value)

    kind.__setattr__ = checked  # type: ignore[method-assign,assignment]
    return kind


def _refuse_unknown(kind: type, name: str) -> None:
    """Raises AttributeError unless objects of a class have an attribute of that name."""
    fields = {field.name for field in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else set()
    if name in fields or hasattr(kind, name):
        return
    meant = _core.meant_name(name, sorted(fields | _settable(kind)))
    raise AttributeError(f"{name}: no attribute of {kind.__name__}"
                         + (f", the nearest right one is '{meant}'" if meant else ""))


def _settable(kind: type) -> set[str]:
    """Names of the public properties of a class that can be set."""
    members = {name: getattr(kind, name, None) for name in dir(kind) if not name.startswith("_")}
    return {name for name, member in members.items()
            if isinstance(member, cached_property) or isinstance(member, property) and member.fset is not None}
