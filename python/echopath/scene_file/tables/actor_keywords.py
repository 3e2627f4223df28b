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


@functools.cache
def material_keywords(name: str) -> frozenset[str]:
    """Those keywords of a ready-made object that are materials of its parts, such as "clothing"."""
    return frozenset(keyword for keyword, parameter in parameters_of(name).items() if "Material" in str(parameter.annotation))


def has_parameter(name: object, keyword: str) -> bool:
    """Whether an actor of that name is known and has that keyword."""
    return isinstance(name, str) and name in actor_names() and keyword in parameters_of(name)
