"""What stands still is taken out of a cube before its map."""
from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..arguments.checks import ArrayLike, checked, count, one_of, refused

ClutterMethod = Literal["mean", "mti"]


@checked(method=one_of(ClutterMethod), order=count(1, 8))
def remove_clutter(cube: ArrayLike, *, method: ClutterMethod = "mean", order: int = 1) -> NDArray[np.complex128]:
    """A cube without the echoes of what stands still.

    cube: [tx, rx, chirp, sample] in sqrt(W), of each transmitter alone, with 2 chirps or more: of frames of a chirp each those of
        several frames, joined along that axis
    method: "mean": the mean over the chirps of each channel is taken away, which leaves every other Doppler cell of a map
        without a window as it is; "mti": each chirp less the one before it, `order` times over (a canceller of order + 1
        pulses): a velocity v keeps |2 sin(2 pi v T / wavelength)|^(2 order) of its power, T from chirp to chirp
    order: of "mti", 1 to 8
    Returns a cube of the same shape in sqrt(W); of "mti" the first `order` chirps, which lack those before them, are 0. Raises
    TypeError or ValueError naming the argument.
    """
    cube = np.array(cube, np.complex128)
    if cube.shape[2] < 2:
        raise ValueError(f"cube: must hold 2 chirps or more, which alone tell what stands still, got {cube.shape[2]}")
    if method == "mean":
        return cube - cube.mean(axis=2, keepdims=True)
    if order >= cube.shape[2]:
        raise refused(ValueError, "order", f"below {cube.shape[2]}, the number of chirps", order)
    weights = [(-1) ** k * math.comb(order, k) for k in range(order + 1)]
    kept = sum(weight * cube[:, :, order - k:cube.shape[2] - k] for k, weight in enumerate(weights))
    cube[:, :, :order], cube[:, :, order:] = 0.0, kept
    return cube
