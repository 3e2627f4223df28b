"""What came before a chirp's first sample, foretold from its samples, so that filters have settled when it begins.

A chirp is modelled as autoregressive (Burg 1975), which follows tones exactly. Foretold from its end and back from its begin, the
two are faded into each other, so that the chirp can repeat without a step. The past is linear in the samples where the model is
given: parts of a signal have pasts that add up, by the model of the whole.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

_ORDER = 8  # of the model
_STEP = 64  # samples that are foretold at once
CHIRPS_AT_ONCE = 256
_LEAST_REST = 1e-12  # of the power, that a model leaves unexplained: below it roundings would make it grow without bound


def models_of(cube: np.ndarray) -> np.ndarray:
    """The model of each chirp of a cube [tx, rx, chirp, sample], [R, order], for `past_of`."""
    chirps = cube.reshape(-1, cube.shape[-1])
    order = min(_ORDER, chirps.shape[1] - 1)
    return np.concatenate([_burg(chirps[begin:begin + CHIRPS_AT_ONCE], order)
                           for begin in range(0, len(chirps), CHIRPS_AT_ONCE)])


def with_pasts(cube: np.ndarray, models: np.ndarray, past: int, made_of: Callable[[np.ndarray], np.ndarray],
               at_once: int = CHIRPS_AT_ONCE) -> np.ndarray:
    """What is made of chirps that go on before their begins: a cube of the same shape, complex128.

    models: `models_of` the cube, or of that of which it is a part; past: samples; made_of: takes and returns
    [R, past + N], of which the last N are kept; at_once: chirps, the most that R is
    """
    chirps = cube.reshape(-1, cube.shape[-1])
    made = np.empty(chirps.shape, np.complex128)
    for begin in range(0, len(chirps), at_once):
        piece, model = (rows[begin:begin + at_once] for rows in (chirps, models))
        made[begin:begin + len(piece)] = made_of(np.concatenate([past_of(piece, model, past), piece], axis=1))[:, past:]
    return made.reshape(cube.shape)


def past_of(chirps: np.ndarray, model: np.ndarray, count: int) -> np.ndarray:
    """Samples [R, count] that lead from the ends of chirps [R, N] to their begins; model: [R, order] of the chirps.

    In the first half the end goes over into the past of the begin, which the second half has alone.
    """
    order = model.shape[1]
    if order == 0:
        return np.zeros((len(chirps), count), np.complex128)
    half = count // 2
    after = _foretold(chirps[:, -order:], model, half)
    before = _foretold(chirps[:, :order][:, ::-1], np.conj(model), count)[:, ::-1]
    place = np.arange(1, half + 1) / (half + 1)
    fade = place ** 3 * (10.0 - 15.0 * place + 6.0 * place ** 2)
    return np.concatenate([after * (1.0 - fade) + before[:, :half] * fade, before[:, half:]], axis=1)


def _burg(chirps, order: int) -> np.ndarray:
    """Coefficients a [R, order] with x[n] = -(a_1 x[n-1] + a_2 x[n-2] + ...)."""
    forward, backward = chirps, chirps
    model = np.zeros((len(chirps), order + 1), np.complex128)
    model[:, 0] = 1.0
    rest = 2.0 * _LEAST_REST * np.sum(np.abs(chirps) ** 2, axis=1)
    for step in range(order):
        ahead, behind = forward[:, 1:], backward[:, :-1]
        power = np.sum(np.abs(ahead) ** 2 + np.abs(behind) ** 2, axis=1) + rest
        turn = -2.0 * np.sum(ahead * np.conj(behind), axis=1) / np.maximum(power, np.finfo(float).tiny)
        turn = turn[:, None]
        forward, backward = ahead + turn * behind, behind + np.conj(turn) * ahead
        model[:, 1:step + 2] += turn * np.conj(model[:, step::-1] if step else model[:, :1])
    return model[:, 1:]


def _foretold(last, model, count: int) -> np.ndarray:
    """The next samples [R, count] behind the last ones [R, order], _STEP at a time."""
    order = last.shape[1]
    steps = -(-count // _STEP)
    weights = _weights(model)
    samples = np.concatenate([last, np.zeros((len(last), steps * _STEP), np.complex128)], axis=1)
    for begin in range(order, order + steps * _STEP, _STEP):
        samples[:, begin:begin + _STEP] = np.einsum("rso,ro->rs", weights, samples[:, begin - order:begin])
    return samples[:, order:order + count]


def _weights(model) -> np.ndarray:
    """What each of the next samples has of each of the last ones, [R, _STEP, order]."""
    rows, order = model.shape
    samples = np.zeros((rows, order + _STEP, order), np.complex128)
    samples[:, :order] = np.eye(order)
    for place in range(order, order + _STEP):
        samples[:, place] = -np.einsum("ro,roc->rc", model, samples[:, place - order:place][:, ::-1])
    return samples[:, order:]
