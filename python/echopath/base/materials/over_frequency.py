"""Laws of materials over frequency, as the files in data/materials give them in the table `over_frequency`.

between: [Hz, Hz], where its source gives the law. Beside it one of
itu: [a, b, c, d] of Recommendation ITU-R P.2040: eps' = a f^b, conductivity c f^d in S/m, f in GHz
relaxation: the law of Cole and Cole 1941, eps_inf + sum of delta / (1 + (j w tau)^(1 - alpha)) - j conductivity / (w eps0), as
    {at_infinity =, conductivity = S/m, terms = [[delta, tau in s, alpha], ...]}; with alpha = 0 a term is Debye's
exponents: {field of the material or "loss", of its layers = p}: what is in the file goes with (f / 77 GHz)^p, the rest stays
"""
from __future__ import annotations

import math

from ... import _core

LIBRARY_FREQUENCY = 77e9  # Hz, of what the files give without a law
NEARLY = 0.1  # share by which another frequency is taken for that


def holds_at(law: dict | None, frequency: float) -> bool:
    """Whether the source of a law, None: there is none, gives it at a frequency in Hz."""
    return law is not None and law["between"][0] <= frequency <= law["between"][1]


def is_near_library(frequency: float) -> bool:
    """Whether values at 77 GHz are taken for those at a frequency in Hz where no law holds."""
    return abs(frequency / LIBRARY_FREQUENCY - 1.0) < NEARLY


def values_at(values: dict, law: dict, frequency: float) -> dict:
    """What a material file would hold for a frequency in Hz, of what it holds, at 77 GHz, and its law."""
    if "itu" in law:
        return {**values, "permittivity": _by_itu(law["itu"], frequency)}
    if "relaxation" in law:
        return {**values, "permittivity": _by_relaxation(frequency=frequency, **law["relaxation"])}
    return {**values, **_by_exponents(values, dict(law["exponents"]), frequency / LIBRARY_FREQUENCY)}


def _by_itu(coefficients: list[float], frequency: float) -> list[float]:
    a, b, c, d = coefficients
    gigahertz = frequency * 1e-9
    return [a * gigahertz**b, _loss(c * gigahertz**d, frequency)]


def _by_relaxation(*, at_infinity: float, conductivity: float, terms: list[list[float]], frequency: float) -> list[float]:
    omega = 2.0 * math.pi * frequency
    polar = sum(delta / (1.0 + (1j * omega * tau)**(1.0 - alpha)) for delta, tau, alpha in terms)
    return [at_infinity + polar.real, _loss(conductivity, frequency) - polar.imag]


def _loss(conductivity: float, frequency: float) -> float:
    """The eps'' of a conductivity in S/m."""
    return conductivity / (2.0 * math.pi * frequency * _core.vacuum_permittivity)


def _by_exponents(values: dict, exponents: dict[str, float], ratio: float) -> dict:
    changed = {}
    if "loss" in exponents:
        factor = ratio**exponents.pop("loss")
        changed["layers"] = [{**layer, "permittivity": [layer["permittivity"][0], layer["permittivity"][1] * factor]}
                             for layer in values["layers"]]
    return changed | {name: values[name] * ratio**exponent for name, exponent in exponents.items()}
