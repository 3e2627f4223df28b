"""Filters of the intermediate frequency, by their response to each tone."""
from __future__ import annotations

import numpy as np

from .settings import Receiver

# Beat frequencies from -1/16 of the sampling rate on: below 0 stand the sidelobes of what is near.
NEGATIVE_SHARE = 1 / 16


def beat_frequencies(waveform) -> np.ndarray:
    """Hz of each cell of the transform of a chirp, [sample]."""
    count = waveform.num_samples
    cells = np.arange(count)
    if waveform.real:
        return np.fft.fftfreq(count, 1.0 / waveform.sampling_rate)
    return np.where(cells < count - int(count * NEGATIVE_SHARE), cells, cells - count) * waveform.sampling_rate / count


def response(receiver: Receiver, frequency) -> np.ndarray:
    """The complex gain of the filters at frequencies in Hz; the filters are real, so that at -f it is the conjugate."""
    gain = np.ones(np.shape(frequency), np.complex128)
    for corner in receiver.high_pass:
        gain *= 1j * frequency / (1j * frequency + corner)
    if receiver.low_pass is not None:
        poles = receiver.low_pass_poles
        for k in range(poles):
            pole = np.exp(1j * np.pi * (2 * k + poles + 1) / (2 * poles))
            gain *= -pole / (1j * frequency / receiver.low_pass - pole)
    return gain


def filtered(cube: np.ndarray, waveform, receiver: Receiver) -> np.ndarray:
    """The cube behind the filters, in the steady state: a chirp goes on as it begins. Transients, some samples at both ends
    of a chirp, are those of a signal that repeats: windowed levels from 2.5 cells on are right to 0.02 dB, and what is nearer to
    0 Hz is left too strong by high-pass filters."""
    if not receiver.high_pass and receiver.low_pass is None:
        return cube
    gain = response(receiver, beat_frequencies(waveform))
    if waveform.real and waveform.num_samples % 2 == 0:
        middle = waveform.num_samples // 2
        gain[middle] = abs(gain[middle])
    return np.fft.ifft(np.fft.fft(cube, axis=-1) * gain, axis=-1)
