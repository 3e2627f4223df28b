"""Permittivities of building materials and ground over frequency (Recommendation ITU-R P.2040-3, table 3)."""
from __future__ import annotations

import math

from .. import _core
from ..base.materials import materials
from .material_names import Meaning

LIBRARY_FREQUENCY, NEARLY = 77e9, 0.1  # Hz, of ep.materials; share by which another frequency is taken for that

# material -> (a, b, c, d, GHz from, GHz to): eps' = a f^b, conductivity = c f^d in S/m with f in GHz. Brick, plywood and marble,
# which the recommendation gives up to 40 and 60 GHz, are extrapolated, as in ep.materials
_TABLE: dict[str, tuple[float, float, float, float, float, float]] = {
    "concrete": (5.24, 0.0, 0.0462, 0.7822, 1, 100), "brick": (3.91, 0.0, 0.0238, 0.16, 1, 100),
    "plasterboard": (2.73, 0.0, 0.0085, 0.9395, 1, 100), "wood": (1.99, 0.0, 0.0047, 1.0718, 0.001, 100),
    "glass": (6.31, 0.0, 0.0036, 1.3394, 0.1, 100), "ceiling_board": (1.48, 0.0, 0.0011, 1.0750, 1, 100),
    "chipboard": (2.58, 0.0, 0.0217, 0.78, 1, 100), "plywood": (2.71, 0.0, 0.33, 0.0, 1, 100),
    "marble": (7.074, 0.0, 0.0055, 0.9262, 1, 100), "floorboard": (3.66, 0.0, 0.0044, 1.3515, 50, 100),
    "asphalt": (4.83, 0.0, 0.0108, 1.3969, 1, 40), "dry_soil": (3.0, 0.0, 0.00015, 2.52, 1, 10),
    "soil": (15.0, -0.1, 0.035, 1.63, 1, 10), "wet_soil": (30.0, -0.4, 0.15, 1.30, 1, 10),
}


def at_frequency(material: Meaning, frequency: float | None) -> tuple[Meaning, str | None]:
    """(a material of ep.materials at a frequency in Hz, the name of one whose values there nobody gives, else None).

    What is not given by name, and everything without a frequency, stays as it is.
    """
    if frequency is None or not isinstance(material, str):
        return material, None
    if material not in _TABLE or not _TABLE[material][4] <= frequency * 1e-9 <= _TABLE[material][5]:
        stays = materials[material].conductor or abs(frequency / LIBRARY_FREQUENCY - 1.0) < NEARLY
        return material, None if stays else material
    return materials[material].replace(permittivity=_permittivity(material, frequency)), None


def _permittivity(name: str, frequency: float) -> complex:
    """eps' - j eps''; the loss is the conductivity over 2 pi f eps0."""
    a, b, c, d = _TABLE[name][:4]
    gigahertz = frequency * 1e-9
    return complex(a * gigahertz**b, -c * gigahertz**d / (2.0 * math.pi * frequency * _core.vacuum_permittivity))


def note_of_library_values(names: list[str]) -> list[str]:
    """What to say of materials whose values at the frequency asked for nobody gives; nothing for none."""
    known = sorted(set(names))
    return [f"values at {LIBRARY_FREQUENCY * 1e-9:g} GHz are taken for {', '.join(known)}"] if known else []
