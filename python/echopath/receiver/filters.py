"""Filters of the intermediate frequency, by their response to each tone."""
from __future__ import annotations

import numpy as np

from ..arguments.checks import refused
from ..base.numerics.past import CHIRPS_AT_ONCE, with_pasts
from .settings import Receiver

# Beat frequencies from -1/16 of the sampling rate on, or up to 1/16 where chirps fall: there stand the sidelobes of what is near.
NEGATIVE_SHARE = 1 / 16
_TIME_CONSTANTS = 28   # of the slowest pole: the past fades in half of them, in the other half filters settle to 1e-6
_PAST_STEP = 128       # samples, the shortest past, of which all are multiples
_MOST_SAMPLES = 1 << 20  # of chirps and their pasts that are worked on at once


def beat_frequencies(waveform, count: int | None = None) -> np.ndarray:
    """Hz of each cell of the transform of a chirp, [sample]; count: of the samples, None: those of the waveform."""
    count = waveform.num_samples if count is None else count
    cells = np.arange(count)
    if waveform.real:
        return np.fft.fftfreq(count, 1.0 / waveform.sampling_rate)
    signed = np.where(cells < count - int(count * NEGATIVE_SHARE), cells, cells - count)
    if waveform.falls:
        signed = -signed[-cells]
    return signed * waveform.sampling_rate / count


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
    past = length_of_past(waveform, receiver)
    gain = response(receiver, beat_frequencies(waveform, cube.shape[-1] + past))
    if waveform.real and len(gain) % 2 == 0:
        gain[len(gain) // 2] = abs(gain[len(gain) // 2])
    at_once = min(CHIRPS_AT_ONCE, max(1, _MOST_SAMPLES // len(gain)))
    return with_pasts(cube, models, past, lambda chirps: np.fft.ifft(np.fft.fft(chirps) * gain), at_once)


def length_of_past(waveform, receiver: Receiver) -> int:
    """Samples in which the past fades and the filters settle, more than a chirp has where corners are low.

    Raises ValueError for corners that are so low that it would be millions: next to a chirp they let all pass, or nothing.
    """
    constants = _TIME_CONSTANTS * waveform.sampling_rate / (2.0 * np.pi)  # Hz, over the poles' corner
    share = np.sin(0.5 * np.pi / receiver.low_pass_poles)  # of the corner of a low-pass, that of its slowest pole
    slowest = [*receiver.high_pass]
    if receiver.low_pass is not None:
        slowest.append(receiver.low_pass * share)
    least = constants / _MOST_SAMPLES
    if min(slowest) < least:
        name, corner = ("high_pass", least) if min(slowest) in receiver.high_pass else ("low_pass", least / share)
        raise refused(ValueError, f"receiver.{name}", f"at least {corner:.4g} Hz at this sampling rate", getattr(receiver, name))
    return max(1, int(np.ceil(constants / min(slowest) / _PAST_STEP))) * _PAST_STEP
