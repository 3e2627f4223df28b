"""Effects that the scene asks for and no keyword of their own: how `effects=` forces them on or off."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from .checks import flag_or_auto, refused, shown

ATTENUATION, RAIN_ECHOES, INTERFERENCE = "attenuation by weather", "echoes of rain", "interference"
SWITCHED = (ATTENUATION, RAIN_ECHOES, INTERFERENCE)
Choice = bool | Literal["auto"]
Choices = Mapping[str, Choice] | tuple[tuple[str, Choice], ...]


def effects_rule(argument: str, value) -> tuple[tuple[str, Choice], ...]:
    """Pairs (name, True, False or "auto") in the order of SWITCHED, of a mapping or of pairs."""
    pairs = _pairs(argument, value)
    for name in pairs:
        if name not in SWITCHED:
            raise ValueError(f"{argument}: has no {shown(name)}, it takes {', '.join(map(repr, SWITCHED))}; other effects "
                             "have keywords of their own or follow from the scene")
    return tuple((name, flag_or_auto(f"{argument}[{name!r}]", pairs[name])) for name in SWITCHED if name in pairs)


def _pairs(argument: str, value) -> dict:
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, (list, tuple)):
        if all(isinstance(pair, (list, tuple)) and len(pair) == 2 and isinstance(pair[0], str) for pair in value):
            return dict(value)
    raise refused(TypeError, argument, 'a dict {name of an effect: True, False or "auto"}', value)


def is_on(effects: Choices, name: str, is_asked_for: bool, need: str) -> bool:
    """Whether an effect is modelled that the scene asks for or not; raises ValueError naming the `need` where it is forced on
    without."""
    choice = dict(effects).get(name, "auto")
    if choice is True and not is_asked_for:
        raise ValueError(f"effects[{name!r}]: needs {need}, got True")
    return is_asked_for and choice is not False
