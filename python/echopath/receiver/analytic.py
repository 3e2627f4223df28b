"""Cubes of real samples as the complex ones that they are the real part of."""
from __future__ import annotations

import numpy as np


def analytic(cube: np.ndarray, real: bool) -> np.ndarray:
    """z with cube = sqrt(2) Re z, without negative frequencies; a cube of complex samples as it is."""
    if not real:
        return cube
    count = cube.shape[-1]
    spectrum = np.fft.fft(cube.real, axis=-1) * np.sqrt(2.0)
    spectrum[..., 0] *= 0.5
    spectrum[..., (count + 1) // 2:] = 0.0
    if count % 2 == 0:
        spectrum[..., count // 2] = np.fft.fft(cube.real, axis=-1)[..., count // 2] / np.sqrt(2.0)
    return np.fft.ifft(spectrum, axis=-1)


def as_samples(values: np.ndarray, real: bool) -> np.ndarray:
    """The samples of what `analytic` gave, complex128."""
    return (np.sqrt(2.0) * values.real).astype(np.complex128) if real else values
