"""Records that a function makes: who calls their class is told which."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any, TypeVar

Kind = TypeVar("Kind", bound=type)


def _refuse_misfit(name: str, signature: inspect.Signature, values: tuple[Any, ...], fields: dict[str, Any], maker: str) -> None:
    """Raises TypeError where a call does not fit a signature: who wrote it meant the maker."""
    try:
        signature.bind(*values, **fields)
    except TypeError as error:
        raise TypeError(f"{name}: {error}; it is made by {maker}") from None


def made_by(maker: str) -> Callable[[Kind], Kind]:
    """Decorator of a class: a call that does not fit its fields says what makes such records.

    maker: the function, as a user writes it, such as "ep.detect"
    """
    def decorate(kind: Kind) -> Kind:
        make = kind.__init__
        signature = inspect.signature(make)

        @functools.wraps(make)
        def init(self: object, *values: Any, **fields: Any) -> None:
            try:
                make(self, *values, **fields)
            except TypeError:
                _refuse_misfit(kind.__name__, signature, (self, *values), fields, maker)
                raise

        kind.__init__ = init  # type: ignore[misc]
        return kind

    return decorate
