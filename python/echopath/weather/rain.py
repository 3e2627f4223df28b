"""What rain takes from a wave on its way: Recommendation ITU-R P.838-3."""
from __future__ import annotations

import math

# Of the logarithm of k and of alpha, by polarisation: terms (a, b, c), slope and constant (tables 1 to 4).
_K = {"h": (((-5.33980, -0.10008, 1.13098), (-0.35351, 1.26970, 0.45400), (-0.23789, 0.86036, 0.15354),
             (-0.94158, 0.64552, 0.16817)), -0.18961, 0.71147),
      "v": (((-3.80595, 0.56934, 0.81061), (-3.44965, -0.22911, 0.51059), (-0.39902, 0.73042, 0.11899),
             (0.50167, 1.07319, 0.27195)), -0.16398, 0.63297)}
_ALPHA = {"h": (((-0.14318, 1.82442, -0.55187), (0.29591, 0.77564, 0.19822), (0.32177, 0.63773, 0.13164),
                 (-5.37610, -0.96230, 1.47828), (16.1721, -3.29980, 3.43990)), 0.67849, -1.95537),
          "v": (((-0.07771, 2.33840, -0.76284), (0.56727, 0.95545, 0.54039), (-0.20238, 1.14520, 0.26809),
                 (-48.2991, 0.791669, 0.116226), (48.5833, 0.791459, 0.116479)), -0.053739, 0.83433)}


def coefficients(frequency: float, polarization: str) -> tuple[float, float]:
    """(k in dB/km for rain in mm/h, alpha) of horizontal ("h") or vertical ("v") waves on a horizontal path; frequency: Hz,
    1e9 to 1e12."""
    decade = math.log10(1e-9 * frequency)

    def fitted(terms, slope, constant):
        return sum(a * math.exp(-((decade - b) / c)**2) for a, b, c in terms) + slope * decade + constant

    return 10.0**fitted(*_K[polarization]), fitted(*_ALPHA[polarization])


def rain_attenuation(frequency: float, rain: float, tilt: float) -> float:
    """dB/km of a horizontal path; frequency: Hz; rain: mm/h; tilt: rad, of the polarisation from the horizontal."""
    if rain == 0.0:
        return 0.0
    (k_h, alpha_h), (k_v, alpha_v) = coefficients(frequency, "h"), coefficients(frequency, "v")
    k = 0.5 * (k_h + k_v + (k_h - k_v) * math.cos(2.0 * tilt))
    alpha = 0.5 * (k_h * alpha_h + k_v * alpha_v + (k_h * alpha_h - k_v * alpha_v) * math.cos(2.0 * tilt)) / k
    return k * rain**alpha
