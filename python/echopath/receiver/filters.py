"""Filters of the intermediate frequency, by their response to each tone."""
from __future__ import annotations

import numpy as np

from .past import past_of
from .settings import Receiver

# Beat frequencies from -1/16 of the sampling rate on: below 0 stand the sidelobes of what is near.
NEGATIVE_SHARE = 1 / 16
_TIME_CONSTANTS = 28  # of the lowest corner: the past fades in half of them, in the other half filters settle to 1e-6
_LEAST_PAST = 64      # samples
_CHIRPS_AT_ONCE = 256


def beat_frequencies(waveform, count: int | None = None) -> np.ndarray:
    """Hz of each cell of the transform of a chirp, [sample]; count: of the samples, None: those of the waveform."""
    count = waveform.num_samples if count is None else count
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


def has_filters(receiver: Receiver) -> bool:
    """Whether there is something to do."""
    return bool(receiver.high_pass) or receiver.low_pass is not None


def filtered(cube: np.ndarray, waveform, receiver: Receiver, models: np.ndarray) -> np.ndarray:
    """The cube behind the filters, which have settled: what comes before a chirp is foretold by a model of its samples.

    models: `models_of` the cube, or of that of which it is a part
    """
    chirps = cube.reshape(-1, cube.shape[-1])
    past = _length_of_past(waveform, receiver)
    gain = response(receiver, beat_frequencies(waveform, chirps.shape[1] + past))
    if waveform.real and len(gain) % 2 == 0:
        gain[len(gain) // 2] = abs(gain[len(gain) // 2])
    made = np.empty(chirps.shape, np.complex128)
    for begin in range(0, len(chirps), _CHIRPS_AT_ONCE):
        piece, model = (rows[begin:begin + _CHIRPS_AT_ONCE] for rows in (chirps, models))
        whole = np.concatenate([past_of(piece, model, past), piece], axis=1)
        made[begin:begin + len(piece)] = np.fft.ifft(np.fft.fft(whole) * gain)[:, past:]
    return made.reshape(cube.shape)


def _length_of_past(waveform, receiver: Receiver) -> int:
    """Samples in which the filters settle and the past fades, no more than a chirp has."""
    corners = [*receiver.high_pass, *([] if receiver.low_pass is None else [receiver.low_pass])]
    settled = _TIME_CONSTANTS * waveform.sampling_rate / (2.0 * np.pi * min(corners))
    return min(max(int(np.ceil(settled)), _LEAST_PAST), waveform.num_samples)
