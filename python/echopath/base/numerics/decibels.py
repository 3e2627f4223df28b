"""Powers in decibels."""
from __future__ import annotations

import numpy as np

SMALLEST_POWER = 1e-300  # W, stands for zero on a logarithmic scale


def in_dbm(power, least: float = 0.0):
    """A power in W, or an array of them, in dB re 1 mW; -inf for none unless `least` W stand for all that is smaller."""
    with np.errstate(divide="ignore"):
        return 10.0 * np.log10(np.maximum(power, least) * 1e3)
