"""The ready-made objects that scene files may name, and their keywords."""
from __future__ import annotations

import functools
import inspect

from ... import actors


def actor_names() -> list[str]:
    """Names of the ready-made objects: the public functions of echopath.actors."""
    return [name for name in actors.__all__ if inspect.isfunction(getattr(actors, name))]


@functools.cache
def parameters_of(name: str) -> dict[str, inspect.Parameter]:
    """{keyword: inspect.Parameter} of a ready-made object."""
    return dict(inspect.signature(getattr(actors, name)).parameters)


def has_parameter(name: object, keyword: str) -> bool:
    """Whether an actor of that name is known and has that keyword."""
    return isinstance(name, str) and name in actor_names() and keyword in parameters_of(name)
