"""Raindrops of all sizes as spheres of water: what a volume of rain scatters back and takes from a wave.

Sizes are those of Marshall and Palmer 1948, N(D) = 8000 exp(-4.1 R^-0.21 D) per m^3 and mm of diameter D for R mm/h; each drop
scatters as Mie's series says (Bohren and Huffman 1983, chapter 4). Sizes vary by some decibels between showers of one rate.
"""
from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .._core import speed_of_light
from .fog import water_permittivity

LARGEST = 6.0  # mm, larger drops break up
DIAMETERS = (np.arange(240) + 0.5) * LARGEST / 240  # mm


def mie_sums(size: float, index: complex) -> tuple[float, float]:
    """Efficiencies (backscatter, extinction), cross sections over the area of the disc, of a sphere.

    size: 2 pi radius/wavelength; index: of refraction, n - j k
    """
    last = int(size + 4.0 * size**(1.0 / 3.0) + 2.0)
    inside = index.conjugate() * size  # the series is written for exp(-j w t)
    ratio = np.zeros(max(last, int(abs(inside))) + 17, complex)  # psi'/psi, downward from where it is 0
    for n in range(len(ratio) - 1, 0, -1):
        ratio[n - 1] = n / inside - 1.0 / (ratio[n] + n / inside)
    back, extinction = 0j, 0.0
    psi, before, chi, chi_before = math.sin(size), math.cos(size), math.cos(size), -math.sin(size)
    for n in range(1, last + 1):
        psi, before = (2 * n - 1) / size * psi - before, psi
        chi, chi_before = (2 * n - 1) / size * chi - chi_before, chi
        xi, xi_before = psi - 1j * chi, before - 1j * chi_before
        electric = ratio[n] / index.conjugate() + n / size
        magnetic = ratio[n] * index.conjugate() + n / size
        a = (electric * psi - before) / (electric * xi - xi_before)
        b = (magnetic * psi - before) / (magnetic * xi - xi_before)
        back += (2 * n + 1) * (-1) ** n * (a - b)
        extinction += (2 * n + 1) * (a + b).real
    return abs(back)**2 / size**2, 2.0 * extinction / size**2


def fall_speeds(diameters=DIAMETERS) -> NDArray[np.float64]:
    """m/s [N] in still air at the ground, of drops of these diameters in mm (Atlas, Srivastava, Sekhon 1973)."""
    return np.maximum(0.0, 9.65 - 10.3 * np.exp(-0.6 * np.asarray(diameters)))


def reflectivities(frequency: float, rain: float, temperature: float) -> NDArray[np.float64]:
    """Cross section per volume in 1/m of the drops about each of DIAMETERS; their sum is that of the rain.

    frequency: Hz; rain: mm/h; temperature: K
    """
    return per_volume(frequency, rain, temperature)[0]


def per_volume(frequency: float, rain: float, temperature: float) -> NDArray[np.float64]:
    """Cross sections per volume in 1/m [2, N] of the drops about each of DIAMETERS: backscatter, extinction.

    frequency: Hz; rain: mm/h; temperature: K
    """
    if rain == 0.0:
        return np.zeros((2, len(DIAMETERS)))
    index = np.sqrt(water_permittivity(frequency, temperature))
    per_mm = math.pi * frequency / speed_of_light * 1e-3
    efficiencies = np.array([mie_sums(per_mm * diameter, complex(index)) for diameter in DIAMETERS]).T
    count = 8000.0 * np.exp(-4.1 * rain**-0.21 * DIAMETERS) * (DIAMETERS[1] - DIAMETERS[0])  # 1/m^3
    return efficiencies * math.pi * (0.5e-3 * DIAMETERS)**2 * count
