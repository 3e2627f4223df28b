"""What a saved view must look like, key by key."""
from __future__ import annotations

import dataclasses
import math

from .colours import COLOUR_MODES
from .maps.layers import LAYERS
from .rays.filters import MAX_BOUNCES, Filters
from .rays.ray_sample import SAMPLINGS

FORMAT = "echopath view"
VERSION = 1
LARGEST = 2**31 - 1  # that a spin box takes


def check_state(state) -> None:
    """Raises ValueError naming the key of a saved view that is not as it must be; keys may be left out."""
    if not isinstance(state, dict) or state.get("format") != FORMAT:
        raise ValueError(f"its format is not '{FORMAT}'")
    if state.get("version") != VERSION:
        raise ValueError(f"it has version {state.get('version')}, this program reads {VERSION}")
    for key, (is_right, rule) in _RULES.items():
        if key in state and not is_right(state[key]):
            raise ValueError(f"{key}: must be {rule}, got {state[key]!r}")


def _is_text(value) -> bool:
    return isinstance(value, str)


def _is_flag(value) -> bool:
    return isinstance(value, bool)


def _is_index(value, lowest: int = 0, highest: int = LARGEST) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and lowest <= value <= highest


def _is_number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value) and abs(value) <= LARGEST


def _is_list(value, size: int | None, is_right) -> bool:
    return isinstance(value, (list, tuple)) and size in (None, len(value)) and all(map(is_right, value))


def _is_pair(value) -> bool:
    return _is_list(value, 2, _is_text)


def _or_none(is_right):
    return lambda value: value is None or is_right(value)


def _is_filters(value) -> bool:
    names = {field.name for field in dataclasses.fields(Filters)}
    if not isinstance(value, dict) or not set(value) <= names:
        return False
    filters = Filters(**value)
    bounces = all(_is_index(count, 0, MAX_BOUNCES) for count in (filters.min_bounces, filters.max_bounces))
    has_power = filters.min_power_dbm is None or _is_number(filters.min_power_dbm)
    return bounces and has_power and _is_text(filters.mesh) and _is_text(filters.expression)


def _is_recipe(value) -> bool:
    return (isinstance(value, dict) and _is_pair(value.get("part")) and _is_filters(value.get("filters"))
            and (value.get("node") is None or _is_text(value["node"])))


def _is_table_of(is_right):
    return lambda value: isinstance(value, dict) and all(map(is_right, value.values()))


def _is_rgb(value) -> bool:
    return _is_list(value, 3, lambda part: _is_index(part, 0, 255))


def _is_camera(value) -> bool:
    vectors = ("position", "focal_point", "up")
    return (isinstance(value, dict) and all(_is_list(value.get(name), 3, _is_number) for name in vectors)
            and _is_number(value.get("view_angle")) and 0.0 < value["view_angle"] < 180.0)


def _is_rectangle(value) -> bool:
    return _is_list(value, 4, _is_number) and value[2] > 0.0 and value[3] > 0.0


_RULES = {
    "frame": (_is_text, "a text"),
    "seed": (lambda value: isinstance(value, int) and not isinstance(value, bool), "an integer"),
    "filters": (_is_filters, f"a table of {', '.join(field.name for field in dataclasses.fields(Filters))}"),
    "own_parts": (_is_table_of(_is_recipe), "a table of parts with their part, node and filters"),
    "node": (_or_none(_is_text), "a name or null"),
    "node_base": (_is_pair, "[partition, part]"),
    "part": (_is_pair, "[partition, part]"),
    "partition": (_or_none(_is_text), "a name or null"),
    "channel": (lambda value: _is_list(value, 2, _is_index), "[transmitter, receiver]"),
    "color_by": (lambda value: _is_text(value) and value in COLOUR_MODES, f"one of {', '.join(COLOUR_MODES)}"),
    "max_rays": (lambda value: _is_index(value, 1), "a positive integer"),
    "sampling": (lambda value: _is_text(value) and value in SAMPLINGS, f"one of {', '.join(SAMPLINGS)}"),
    "dynamic_range_db": (lambda value: _is_number(value) and value > 0.0, "a positive number of dB"),
    "chirp": (_is_index, "an index"),
    "box": (_or_none(lambda value: _is_list(value, 4, _is_index)), "null or four indices of cells"),
    "cell": (_or_none(lambda value: _is_list(value, 2, _is_index)), "null or [range index, velocity index]"),
    "beam": (_or_none(lambda value: _is_list(value, 2, _is_number)), "null or [azimuth, elevation] in rad"),
    "ray": (_or_none(_is_index), "null or an index"),
    "hidden_meshes": (lambda value: _is_list(value, None, _is_text), "a list of names"),
    "layers": (lambda value: _is_list(value, None, lambda layer: layer in LAYERS), f"a list of {', '.join(LAYERS)}"),
    "mesh_colours": (_is_table_of(_is_rgb), "a table of [red, green, blue], 0 to 255"),
    "camera": (_is_camera, "position, focal_point and up of three numbers each, and view_angle in degrees"),
    "show_hits": (_is_flag, "true or false"),
    "one_map": (_is_flag, "true or false"),
    "map_view": (_is_rectangle, "range, velocity, width and height"),
}
