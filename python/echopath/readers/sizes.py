"""How large a model is, and whether its unit seems to be another one."""
from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ..scene.scene import Scene

# what a name tells: words of it, and how large such a thing is at its largest, m
_SIZES = {
    "a person": (("person", "people", "human", "pedestrian", "walker", "man", "woman", "boy", "girl", "child", "character",
                  "body", "soldier"), 0.5, 2.6),
    "a bicycle": (("bike", "bicycle", "cyclist", "motorcycle", "motorbike", "scooter"), 0.8, 3.5),
    "a vehicle": (("car", "vehicle", "sedan", "suv", "taxi", "van", "truck", "bus", "lorry", "jeep", "pickup"), 1.5, 25.0),
}
_UNITS = {"mm": 1e-3, "cm": 1e-2, "inches": 0.0254, "feet": 0.3048, "m": 1.0, "km": 1e3}  # m
SMALLEST, LARGEST = 0.02, 5e4  # m, of anything that a radar looks at


def box_of(scene: Scene, time: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest coordinates [3] in m of all meshes of a scene at `time` in s; zeros for a scene without meshes."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for mesh in scene.meshes:
        vertices = scene.world_vertices(mesh.id, time)
        low, high = np.minimum(low, vertices.min(axis=0)), np.maximum(high, vertices.max(axis=0))
    return (low, high) if np.isfinite(low).all() else (np.zeros(3), np.zeros(3))


def unit_doubt(extent: float, unit: float, names: list[str]) -> str | None:
    """What to say of a model of that greatest extent in m, None where nothing speaks against its unit.

    unit: m per unit of its file; names: of the file and of its topmost objects, which may say what it is
    """
    what, least, most = _expected(names)
    if extent == 0.0 or least <= extent <= most:
        return None
    fits = [f"unit={value:g} ({name})" for name, value in _UNITS.items() if least <= extent / unit * value <= most]
    advice = f"; with {' or '.join(fits)} it would be right" if fits else ""
    return f"{what} of {_length(extent)} is hardly right{advice}"


def _expected(names: list[str]) -> tuple[str, float, float]:
    """(what it is, least and greatest extent in m)."""
    for name in names:
        words = {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+", name)}
        for what, (known, least, most) in _SIZES.items():
            if words & set(known):
                return what, least, most
    return "a scene", SMALLEST, LARGEST


def _length(extent: float) -> str:
    """A length in words: mm below 0.1 m, km from 10 km on."""
    scale, unit = (1e3, "mm") if extent < 0.1 else (1e-3, "km") if extent >= 1e4 else (1.0, "m")
    return f"{extent * scale:.3g} {unit}"
