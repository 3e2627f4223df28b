"""Faults that act on each sample by itself: compression, imbalance of the branches, offsets."""
from __future__ import annotations

import numpy as np

from .analytic import analytic, as_samples
from .settings import Receiver

_ONE_DB = 10.0 ** 0.1 - 1.0  # power over saturation power where the gain is 1 dB lower


def compressed(cube: np.ndarray, radar, receiver: Receiver) -> np.ndarray:
    """Behind an amplifier whose gain falls with the power at its input as 1 / sqrt(1 + power / saturation)."""
    if receiver.compression_dbm is None:
        return cube
    saturation = 1e-3 * 10.0 ** (receiver.compression_dbm / 10.0) / _ONE_DB
    values = analytic(cube, radar.waveform.real)
    values = values / np.sqrt(1.0 + np.abs(values) ** 2 / saturation)
    return as_samples(values, radar.waveform.real)


def unbalanced(cube: np.ndarray, waveform, receiver: Receiver) -> np.ndarray:
    """I stays as it is, Q = g (Q cos p + I sin p): a x + b x* with a = (1 + g e^{jp}) / 2 and b = (1 - g e^{-jp}) / 2.
    Samples of real signals have one branch."""
    gain, offset = 10.0 ** (receiver.iq_gain_db / 20.0), complex(*receiver.dc_offset)
    if waveform.real:
        return cube if offset == 0.0 else cube + offset.real
    if gain != 1.0 or receiver.iq_phase != 0.0:
        turn = gain * np.exp(1j * receiver.iq_phase)
        cube = 0.5 * (1.0 + turn) * cube + 0.5 * (1.0 - np.conj(turn)) * np.conj(cube)
    return cube if offset == 0.0 else cube + offset
