"""Lengths in sentences."""
from __future__ import annotations


def length_text(length: float) -> str:
    """A length in m to three digits: in mm below 0.1 m, in km from 1 km on."""
    scale, unit = (1e3, "mm") if length < 0.1 else (1e-3, "km") if length >= 1e3 else (1.0, "m")
    return f"{length * scale:.3g} {unit}"
