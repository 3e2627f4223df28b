"""Ready-made objects that scene files name, with their parameters."""
from __future__ import annotations

import functools
import typing
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import create_model

from .. import actors
from ..base.storage.files import named_file
from .errors import blamed, validated
from .models import material_of
from .tables.actor_keywords import actor_names, material_keywords, parameters_of
from .tables.object_tables import MaterialValue
from .tables.table import Table, nearest_key


def named_actor(name: str, parameters: dict, folder: Path, key: str, **own):
    """An actor with the parameters of a table; key: of that table; own: further keywords of the actor."""
    make = actor_maker(name, parameters, folder, key)
    with blamed(f"{key}.parameters", file="path" if "path" in parameters else ""):
        return make(**own)


def actor_maker(name: str, parameters: dict, folder: Path, key: str) -> Callable[..., Any]:
    """What makes that actor of further keywords. Raises ValueError for parameters that it does not have."""
    factory = _actor_factory(name, f"{key}.actor")
    table = validated(_parameter_table(name), parameters, (key, "parameters"))
    known = table.model_dump(exclude_unset=True)
    for keyword in material_keywords(name) & known.keys():
        value = getattr(table, keyword)
        material = material_of(value, f"{key}.parameters.{keyword}")
        known[keyword] = value if isinstance(value, str) else material  # a name is told in what is made of it
    if "path" in known:
        known["path"] = named_file(folder, known["path"])  # of a motion capture, relative to the scene file
    return functools.partial(factory, **known)


def actor_keywords(name: str, key: str) -> dict:
    """{keyword: inspect.Parameter} of an actor; key: that names it. Raises ValueError for an unknown one."""
    _actor_factory(name, key)
    return parameters_of(name)


def _actor_factory(name: str, key: str):
    if name not in actor_names():
        raise ValueError(f"{key}: unknown actor '{name}'; {nearest_key(name, actor_names()).replace('keys', 'actors')}")
    return getattr(actors, name)


@functools.cache
def _parameter_table(name: str) -> type[Table]:
    """The keywords of an actor as a table: its signature is their only home, their values it checks itself."""
    fields = {parameter.name: (MaterialValue if parameter.name in material_keywords(name) else typing.Any,
                               ... if parameter.default is parameter.empty else parameter.default)
              for parameter in parameters_of(name).values() if parameter.name not in ("material", "trajectory")}
    return create_model(f"{name}_parameters", __base__=Table, **fields)
