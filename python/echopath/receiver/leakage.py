"""What transmitters leak into receivers: one more echo each, at rest."""
from __future__ import annotations

import numpy as np

from ..transmit import code_of, is_coded
from .channels import transmitter_factors
from .settings import Receiver


def leakage(radar, receiver: Receiver, slots, oscillator=None) -> np.ndarray | None:
    """The leakage after the mixers, in a shape that a cube before `demultiplex` takes, in sqrt(W); None: none. It is complex,
    for real samples (`as_samples`) of less than a period do not tell what a phase makes of them.

    slots: SlotTimes; oscillator: Oscillator with what it does in the meantime, None: an ideal one
    """
    if not receiver.leakage_db:
        return None
    if oscillator is None or oscillator.is_ideal:
        time = np.arange(radar.waveform.num_samples) / radar.waveform.sampling_rate
        tone = leaked_tone(radar.waveform, slots, receiver.leakage_delay, time)[:, None]
    else:
        tone = oscillator.leaked(receiver.leakage_delay)
    return _amplitudes(radar, receiver) * tone


def _amplitudes(radar, receiver: Receiver) -> np.ndarray:
    """Of the leakage in sqrt(W), complex [T, rx, C or 1, 1]."""
    amplitude = np.sqrt(radar.transmit_power) * 10.0 ** (np.array(receiver.leakage_db) / 20.0)
    factors = transmitter_factors(receiver, radar)
    amplitude = amplitude if factors is None else amplitude * factors[:, None]
    if not is_coded(radar):
        return amplitude[:, :, None, None]
    return np.einsum("tr,tk->rk", amplitude, code_of(radar))[None, ..., None]


def leaked_tone(waveform, slots, delay: float, time: np.ndarray) -> np.ndarray:
    """The echo of a delay d (s) of amplitude 1 at times [S] (s) after the first sample, complex [T, C, S], [1, 1, S] where all
    chirps are alike: exp(j 2 pi (f0 d + slope t d - slope d^2 / 2)), and 0 where its beat frequency lies beyond the band, as
    the filter before the converter leaves it. slots: SlotTimes"""
    start, slope = slots.start_frequency[..., None], slots.slope[..., None]
    passes = np.abs(slope) * delay < waveform.sampling_rate * (0.5 if waveform.real else 1.0)
    return passes * np.exp(2j * np.pi * (start * delay + slope * delay * (time - 0.5 * delay)))
