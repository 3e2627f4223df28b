"""What the paths of one target tell: their fields, and the cross section that a power stands for."""
from __future__ import annotations

import numpy as np

from . import closed_forms as exact


def field(paths) -> np.ndarray:
    """[P] complex amplitudes with the phase of their lengths, sqrt(W)."""
    lengths = np.asarray(paths.lengths([paths.frame.trace_time]))[0]
    return np.asarray(paths.amplitude) * np.exp(-2j * np.pi * np.mod(lengths / exact.WAVELENGTH, 1.0))


def rcs_of_power(paths, power: float, distance: float) -> float:
    """In m^2, of a power in W at the port of an isotropic antenna, which another sends to a target at `distance` m."""
    return float(power * (4.0 * np.pi) ** 3 * distance ** 4 / (paths.radar.transmit_power * exact.WAVELENGTH ** 2))


def rcs_of(paths, distance: float, keep=slice(None)) -> float:
    """In m^2, of the coherent sum of some paths of a target at `distance` m."""
    return rcs_of_power(paths, abs(np.sum(field(paths)[keep])) ** 2, distance)
