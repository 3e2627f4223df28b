"""What dry air and water vapour take from a wave, line by line: Recommendation ITU-R P.676-12, annex 1."""
from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from ..base.storage.data_folder import data_folder


@functools.cache
def _lines(name: str) -> NDArray[np.float64]:
    """[N, 7]: frequency in GHz and six coefficients of each line."""
    text = (data_folder("weather") / f"{name}_lines.csv").read_text(encoding="utf-8")
    return np.array([[float(value) for value in row.split(",")] for row in text.splitlines()[2:]])


def saturation_pressure(temperature: float, pressure: float) -> float:
    """hPa, of water vapour over water (Recommendation ITU-R P.453-14); temperature: K; pressure: hPa."""
    celsius = temperature - 273.15
    enhancement = 1.0 + 1e-4 * (7.2 + pressure * (0.0320 + 5.9e-6 * celsius**2))
    return enhancement * 6.1121 * float(np.exp((18.678 - celsius / 234.5) * celsius / (celsius + 257.14)))


def gas_attenuation(frequency: float, temperature: float, dry_pressure: float, vapour_pressure: float) -> float:
    """dB/km; frequency: Hz, 1e9 to 1e12; temperature: K; pressures of dry air and of water vapour: hPa."""
    f, theta = 1e-9 * frequency, 300.0 / temperature
    imaginary = (_oxygen(f, theta, dry_pressure, vapour_pressure) + _vapour(f, theta, dry_pressure, vapour_pressure)
                 + _dry_continuum(f, theta, dry_pressure, vapour_pressure))
    return 0.1820 * f * imaginary


def _oxygen(f, theta, p, e) -> float:
    line, a1, a2, a3, a4, a5, a6 = _lines("oxygen").T
    strength = a1 * 1e-7 * p * theta**3 * np.exp(a2 * (1.0 - theta))
    width = a3 * 1e-4 * (p * theta**(0.8 - a4) + 1.1 * e * theta)
    interference = (a5 + a6 * theta) * 1e-4 * (p + e) * theta**0.8
    return float(np.sum(strength * _shape(f, line, np.sqrt(width**2 + 2.25e-6), interference)))


def _vapour(f, theta, p, e) -> float:
    line, b1, b2, b3, b4, b5, b6 = _lines("water_vapour").T
    strength = b1 * 1e-1 * e * theta**3.5 * np.exp(b2 * (1.0 - theta))
    width = b3 * 1e-4 * (p * theta**b4 + b5 * e * theta**b6)
    width = 0.535 * width + np.sqrt(0.217 * width**2 + 2.1316e-12 * line**2 / theta)
    return float(np.sum(strength * _shape(f, line, width, 0.0)))


def _shape(f, line, width, interference):
    """Of absorption about lines, 1/GHz."""
    below, above = line - f, line + f
    return f / line * ((width - interference * below) / (below**2 + width**2)
                       + (width - interference * above) / (above**2 + width**2))


def _dry_continuum(f, theta, p, e) -> float:
    width = 5.6e-4 * (p + e) * theta**0.8
    debye = 6.14e-5 / (width * (1.0 + (f / width)**2))
    return f * p * theta**2 * (debye + 1.4e-12 * p * theta**1.5 / (1.0 + 1.9e-5 * f**1.5))
