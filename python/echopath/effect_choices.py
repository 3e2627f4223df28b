"""Effects that the scene asks for and no keyword of their own: how `effects=` forces them on or off."""
from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Literal

from . import _core
from .checks import refused

ATTENUATION, RAIN_ECHOES = "attenuation by weather", "echoes of rain"
SWITCHED = (ATTENUATION, RAIN_ECHOES)
Choice = bool | Literal["auto"]
Choices = Mapping[str, Choice] | tuple[tuple[str, Choice], ...]


def effects_rule(argument: str, value) -> tuple[tuple[str, Choice], ...]:
    """Pairs (name, True, False or "auto") in the order of SWITCHED, of a mapping or of pairs."""
    pairs = _pairs(argument, value)
    for name, choice in pairs.items():
        if name not in SWITCHED:
            nearest = _core.nearest_names(str(name), list(SWITCHED))[0]
            raise ValueError(f"{argument}: has no {name!r}, did you mean {nearest!r}? It takes {', '.join(SWITCHED)}; other "
                             "effects have keywords of their own or follow from the scene")
        if not (choice is True or choice is False or choice == "auto"):
            raise refused(ValueError, f"{argument}[{name!r}]", 'True, False or "auto"', choice)
    return tuple((name, pairs[name]) for name in SWITCHED if name in pairs)


def _pairs(argument: str, value) -> dict:
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, Iterable) and not isinstance(value, str):
        pairs = list(value)
        if all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs):
            return dict(pairs)
    raise refused(TypeError, argument, 'a dict {name of an effect: True, False or "auto"}', value)


def is_on(effects: Choices, name: str, is_asked_for: bool, need: str) -> bool:
    """Whether an effect is modelled that the scene asks for or not; raises ValueError naming the `need` where it is forced on
    without."""
    choice = dict(effects).get(name, "auto")
    if choice is True and not is_asked_for:
        raise ValueError(f"effects[{name!r}]: needs {need}, got True")
    return is_asked_for and choice is not False
