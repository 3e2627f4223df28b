"""Cubes of real samples as the complex ones that they are the real part of.

waveform: of the samples, which says whether they are real and whether their chirps fall
"""
from __future__ import annotations

import numpy as np

from .past import models_of, with_pasts

_SHORTEST_PAST = 256  # samples, over which ends of a chirp fade into each other


def analytic(cube: np.ndarray, waveform) -> np.ndarray:
    """z with cube = sqrt(2) Re z, of which all frequencies are those of beats: positive, or negative where chirps fall; a cube of
    complex samples as it is."""
    if not waveform.real:
        return cube
    count = cube.shape[-1]
    spectrum = np.fft.fft(cube.real, axis=-1) * np.sqrt(2.0)
    spectrum[..., 0] *= 0.5
    if count % 2 == 0:
        spectrum[..., count // 2] *= 0.5  # half of the highest frequency is negative
    spectrum[..., count // 2 + 1:] = 0.0
    signal = np.fft.ifft(spectrum, axis=-1)
    return np.conj(signal) if waveform.falls else signal


def as_samples(values: np.ndarray, real: bool) -> np.ndarray:
    """The samples of what `analytic` gave, complex128."""
    return (np.sqrt(2.0) * values.real).astype(np.complex128) if real else values


def turned(cube: np.ndarray, factors: np.ndarray, waveform, whole: np.ndarray | None = None) -> np.ndarray:
    """A cube [..., sample] times complex factors that broadcast to it. Of real samples that is what the signal becomes whose real
    part they are: a phase turns each tone, and is not lost with the imaginary part.

    whole: of which the cube is a part, None: itself; parts of one whole add up to what becomes of it
    """
    if not waveform.real or not np.any(np.imag(factors)):
        return cube * factors
    return as_samples(continued(cube, waveform, whole) * factors, waveform.real)


def continued(cube: np.ndarray, waveform, whole: np.ndarray | None = None) -> np.ndarray:
    """`analytic` of real samples that go on before and behind a chirp (`past_of`), so that tones between the cells of its
    transform are true up to its ends; whole: as in `turned`."""
    past = max(_SHORTEST_PAST, cube.shape[-1])
    return with_pasts(cube, models_of(cube if whole is None else whole), past, lambda chirps: analytic(chirps, waveform))
