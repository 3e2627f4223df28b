"""The weather of a frame in HDF5 groups (layout: data/README.md): that of its scene, and what `effects` made of it.

Records of paths keep their scene without weather, and what it took from them.
"""
from __future__ import annotations

import json

from ...arguments.effects import effects_rule
from ...scene.scene import Scene
from ...weather import Weather
from ...weather.weather import weather_of
from ..h5 import blames_group, read_attribute, write_attribute


def write_weather(group, frame) -> None:
    """Writes what differs from empty space, and from the effects that the scene asks for."""
    weather = weather_of(frame.scene)
    if weather is not None:
        write_attribute(group, "weather", json.dumps(weather.keywords()))
    if frame.effect_choices:
        write_attribute(group, "effects", json.dumps(frame.effect_choices))


@blames_group
def scene_in_weather(group, scene):
    """A copy of the scene of a record, in the weather of its frame."""
    settings = json.loads(read_attribute(group, "weather", str)) if "weather" in group.attrs else None
    return Scene(scene, weather=None if settings is None else Weather(**settings))


@blames_group
def read_effect_choices(group) -> tuple:
    """Of the effects of the weather, as `Frame.effect_choices`."""
    return effects_rule("effects", json.loads(read_attribute(group, "effects", str))) if "effects" in group.attrs else ()
