"""What transmitters leak into receivers: one more echo each, at rest."""
from __future__ import annotations

import numpy as np

from ..transmit import code_of, is_coded
from .channels import transmitter_factors
from .settings import Receiver


def leakage_amplitudes(radar, receiver: Receiver) -> np.ndarray | None:
    """Of the leakage in sqrt(W), as a cube before `demultiplex` takes it: complex [T, rx, C or 1, 1]; None: none."""
    if not receiver.leakage_db:
        return None
    amplitude = np.sqrt(radar.transmit_power) * 10.0 ** (np.array(receiver.leakage_db) / 20.0)
    factors = transmitter_factors(receiver, radar)
    amplitude = amplitude if factors is None else amplitude * factors[:, None]
    if not is_coded(radar):
        return amplitude[:, :, None, None]
    return np.einsum("tr,tk->rk", amplitude, code_of(radar))[None, ..., None]


def leaked_tone(slots, delay: float, time: np.ndarray) -> np.ndarray:
    """The echo of a delay d (s) of amplitude 1 at times [S] (s) after the first sample, complex [T, C, S], [1, 1, S] where all
    chirps are alike: exp(j 2 pi (f0 d + slope t d - slope d^2 / 2)). slots: SlotTimes"""
    start, slope = slots.start_frequency[..., None], slots.slope[..., None]
    return np.exp(2j * np.pi * (start * delay + slope * delay * (time - 0.5 * delay)))
