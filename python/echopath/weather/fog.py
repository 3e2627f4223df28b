"""What fog takes from a wave, and the permittivity of liquid water: Recommendation ITU-R P.840-8."""
from __future__ import annotations


def water_permittivity(frequency: float, temperature: float) -> complex:
    """Relative, eps' - j eps'', by two relaxations; frequency: Hz, up to 1e12; temperature: K."""
    f, excess = 1e-9 * frequency, 300.0 / temperature - 1.0
    static = 77.66 + 103.3 * excess
    between, infinite = 0.0671 * static, 3.52
    first = 20.20 - 146.0 * excess + 316.0 * excess**2
    return (static - between) / (1.0 + 1j * f / first) + (between - infinite) / (1.0 + 1j * f / (39.8 * first)) + infinite


def fog_attenuation(frequency: float, fog: float, temperature: float) -> float:
    """dB/km of droplets small beside the wavelength, up to 200 GHz; frequency: Hz; fog: g/m^3 of water; temperature: K."""
    permittivity = water_permittivity(frequency, temperature)
    loss = -permittivity.imag
    eta = (2.0 + permittivity.real) / loss
    return 0.819 * 1e-9 * frequency / (loss * (1.0 + eta**2)) * fog
