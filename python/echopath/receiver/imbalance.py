"""Faults that act on each sample by itself: compression, imbalance of the branches, offsets."""
from __future__ import annotations

import numpy as np

from ..base.numerics.analytic import analytic, as_samples
from .settings import Receiver

_ONE_DB = 10.0 ** 0.1 - 1.0  # power over saturation power where the gain is 1 dB lower


def compression(cube: np.ndarray, radar, receiver: Receiver, leaked: np.ndarray | None) -> np.ndarray | None:
    """The gain of the amplifier for each sample of a cube, which falls with the power at its input as
    1 / sqrt(1 + power / saturation); None: it does not.

    leaked: the leakage in that cube, complex (`Chain.leaked`), or None. The power of a signal of less than a period does not show
    in real samples, which may all be near 0.
    """
    if receiver.compression_dbm is None:
        return None
    saturation = 1e-3 * 10.0 ** (receiver.compression_dbm / 10.0) / _ONE_DB
    waveform = radar.waveform
    shows_all = leaked is None or not waveform.real
    signal = analytic(cube, waveform) if shows_all else analytic(cube - as_samples(leaked, True), waveform) + leaked
    return 1.0 / np.sqrt(1.0 + np.abs(signal) ** 2 / saturation)


def compressed(cube: np.ndarray, gain: np.ndarray, radar) -> np.ndarray:
    """A cube, or a part of one, behind an amplifier of a gain for each sample (`compression`)."""
    return as_samples(analytic(cube, radar.waveform) * gain, radar.waveform.real)


def weights_of_imbalance(receiver: Receiver) -> tuple[complex, complex]:
    """(a, b) of a x + b x*, what the branches make of a signal x: I stays as it is, Q = g (Q cos p + I sin p), so that
    a = (1 + g e^{jp}) / 2 and b = (1 - g e^{-jp}) / 2."""
    turn = 10.0 ** (receiver.iq_gain_db / 20.0) * np.exp(1j * receiver.iq_phase)
    return 0.5 * (1.0 + turn), 0.5 * (1.0 - np.conj(turn))


def unbalanced(cube: np.ndarray, waveform, receiver: Receiver) -> np.ndarray:
    """A cube with the imbalance of the branches. Samples of real signals have one branch."""
    own, image = weights_of_imbalance(receiver)
    if waveform.real or image == 0.0:
        return cube
    return own * cube + image * np.conj(cube)


def with_offset(cube: np.ndarray, waveform, receiver: Receiver) -> np.ndarray:
    """With the offsets of the branches, of I alone where samples are real."""
    offset = complex(*receiver.dc_offset)
    return cube if offset == 0.0 else cube + (offset.real if waveform.real else offset)
