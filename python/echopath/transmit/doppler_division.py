"""Undoes Doppler division: transmitter m appears m shares of the Doppler axis above the velocity of the target.

With Q shares, M of them with a transmitter, a target in share b of the axis shows in shares b to b + M - 1 (modulo Q) and
leaves the others empty: cells d + j N / Q of one range, j = 0 .. Q - 1, have one target at most, and b is where the empty
shares have the least power, summed over the receivers and over the cells next to each. The value of transmitter m at that
velocity is then that of share b + m; at velocities of other shares stands what an empty one holds, the noise, for each
transmitter that of other cells nearby: detectors take the noise of channels for independent. Cells whose shares do not differ
more than noise does, or not much more and are no stronger than noise, are left as they are, so that noise keeps its level and its
distribution behind windows that fall towards the ends. Where filters leave far less noise at other ranges, targets must differ
by more, because what is put in the place of noise reaches there.

Both axes are tapered by Hamming's window meanwhile (sidelobes at -43 dB), so that a strong target does not decide for weak
ones beside it; the taper is taken out again. Velocities of two targets at one range that are a multiple of a share apart
cannot be told apart: the stronger one's share is taken for both.
"""
from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..base.process.callers import warn_user
from .code import num_shares

# Share of the cells of noise alone that seem to have a target.
FALSE_TARGET_RATE = 1e-2
# Share of them in which shares differ by enough for a target, were it strong enough.
DIFFERENT_RATE = 0.3
SURE_RATIO, SURE_LEVEL = 2.0, 1.5  # of targets beyond doubt, times the limits of noise in dB
STANDS_OUT = 0.03  # of the mean noise: what seems a target may be 15 dB above it
LESS = 3.0         # times as much noise as at another range: by less it may vary itself
LOBE = 4  # cells of a target behind the taper; the noise of cells so far apart is independent
# Chirps of a share below which the lobe of a target and its neighbours reach over the shares beside its own:
# maps of tones are off by 1.3 of their peak with 2, by 0.26 with 3, and by 0.02 with 4.
LEAST_CHIRPS = LOBE


def undo_doppler_division(signal: np.ndarray, radar, whole: np.ndarray | None = None) -> np.ndarray:
    """[rx, chirp, S] -> [tx, rx, chirp, S], in sqrt(W).

    whole: [rx, chirp, S], the signal of which this one is a part, whose cells tell which are of which transmitter; None: itself
    """
    num_tx, shares = len(radar.transmitters), num_shares(radar)
    num_rx, num_chirps, num_samples = signal.shape
    if num_chirps // shares < LEAST_CHIRPS:
        warn_user(f"radar.waveform.num_chirps: should be {LEAST_CHIRPS * shares} or more, {LEAST_CHIRPS} for each of {shares} "
                  f"shares of the Doppler axis, so that the transmitters of \"ddm\" come apart, got {num_chirps}")
    taper = _hamming(num_chirps)[:, None] * _hamming(num_samples)
    cells = np.fft.fft2(signal * taper)
    deciding = cells if whole is None else np.fft.fft2(whole * taper)
    found = _found(_smoothed_power(deciding), num_tx, shares)
    share, is_target = found.share, found.is_target(_limits_of_noise(num_tx, shares, num_rx), _is_beside_less(deciding))
    cells = cells.reshape(num_rx, shares, num_chirps // shares, num_samples)
    empty = np.where(is_target, (share + num_tx) % shares, 0)
    noise = np.take_along_axis(cells, empty[None, None], axis=1)[:, 0]
    apart = np.empty((num_tx, *cells.shape), np.complex128)
    for tx in range(num_tx):
        of_tx = _from_nearby(noise, tx)
        for b in range(shares):
            apart[tx, :, b] = cells[:, (b + tx) % shares]
            np.copyto(apart[tx, :, b], of_tx, where=is_target & (share != b))
    values = np.fft.ifft2(apart.reshape(num_tx, num_rx, num_chirps, num_samples))
    values /= taper
    return values


def _from_nearby(noise, index: int):
    """Noise [rx, D, S] of cells a number of lobes away, along the velocities of a share first: it varies with range behind
    filters. Of other indices it is independent, as long as the cells last."""
    along_range, along_velocity = divmod(index, max(1, noise.shape[1] // LOBE))
    return np.roll(noise, (LOBE * along_velocity, LOBE * along_range), axis=(1, 2))


def _smoothed_power(cells):
    """Power [chirp, S] of cells [rx, chirp, S], summed over receivers and weighted by 1 2 1 with neighbours on each axis."""
    power = np.sum(np.abs(cells) ** 2, axis=0)
    for axis in (0, 1):
        power = 2.0 * power + np.roll(power, 1, axis) + np.roll(power, -1, axis)
    return power


class _Limits(NamedTuple):
    """What noise seldom exceeds. alone: of the ratio by itself; ratio, level: of both together"""

    alone: float
    ratio: float
    level: float


class _Found(NamedTuple):
    """Of a target in each cell of a share, [D, S]. share: where it is; ratio: of the mean power of full shares to that of empty
    ones; level: of that of full shares to the median over the velocities at its range, which clutter raises"""

    share: np.ndarray
    ratio: np.ndarray
    level: np.ndarray

    def is_target(self, limits: _Limits, is_beside_less=False) -> np.ndarray:
        """Whether there is one. The empty shares are few and the median is sure of the noise: it finds the weak ones.

        is_beside_less: [S], where what seems one and is none would stand out of the noise: there one must be sure
        """
        is_one = (self.ratio > limits.alone) | ((self.ratio > limits.ratio) & (self.level > limits.level))
        is_sure = (self.ratio > limits.alone ** SURE_RATIO) | (self.level > limits.level ** SURE_LEVEL)
        return is_one & np.where(is_beside_less, is_sure, True)


def _found(power, num_tx: int, shares: int) -> _Found:
    """Of power [chirp, S]."""
    tiny = np.finfo(float).tiny
    noise = np.maximum(np.median(power, axis=0), tiny)
    power = power.reshape(shares, -1, power.shape[-1])
    empty = np.stack([sum(power[(b + e) % shares] for e in range(num_tx, shares)) for b in range(shares)])
    share, rest = np.argmin(empty, axis=0), np.min(empty, axis=0)
    full = (np.sum(power, axis=0) - rest) / num_tx
    return _Found(share, full * (shares - num_tx) / np.maximum(rest, tiny), full / noise)


def _is_beside_less(cells) -> np.ndarray:
    """Whether what is put in the place of a cell [rx, chirp, S] at a range would stand out of the noise there or elsewhere, [S]:
    filters may leave far less than the sidelobes that cells have of other ranges, and the changes, as the taper is taken out
    again, reach over cells with 5 dB less from each to the next."""
    count = cells.shape[-1]
    if count == 1:
        return np.zeros(1, bool)
    put = np.median(sum(np.abs(one) ** 2 for one in cells), axis=0) / np.sum(_hamming(count) ** 2)
    noise = np.median(sum(np.abs(_smooth(one)) ** 2 for one in cells), axis=0) / np.sum((_hann(count) * _hamming(count)) ** 2)
    reach = np.minimum(np.abs(np.fft.fft(_hann(count) / _hamming(count)) / count) ** 2 / STANDS_OUT, 1.0 / LESS)
    is_beside = np.zeros(count, bool)
    for away in np.flatnonzero(reach * put.max() > noise.min()):
        is_beside |= reach[away] * put > np.roll(noise, -away)
    return is_beside


def _smooth(cells):
    """Cells [chirp, S] behind Hann's taper, too, which leaves no sidelobes of other ranges."""
    return 0.5 * cells - 0.25 * (np.roll(cells, 1, axis=-1) + np.roll(cells, -1, axis=-1))


@lru_cache
def _limits_of_noise(num_tx: int, shares: int, num_rx: int) -> _Limits:
    """Those of FALSE_TARGET_RATE, half of it for each way to find a target; noise is drawn once from a fixed seed."""
    num_chirps, num_samples, drawn = 32 * shares, 64, []
    generator, taper = np.random.default_rng(1), _hamming(num_chirps)[:, None] * _hamming(num_samples)
    for _ in range(16):
        noise = generator.standard_normal((2, num_rx, num_chirps, num_samples))
        cells = np.fft.fft2((noise[0] + 1j * noise[1]) * taper)
        drawn.append(_found(_smoothed_power(cells), num_tx, shares))
    ratio, level = (np.stack([getattr(one, name) for one in drawn]) for name in ("ratio", "level"))
    alone, different = np.quantile(ratio, [1.0 - 0.5 * FALSE_TARGET_RATE, 1.0 - DIFFERENT_RATE])
    together = np.quantile(np.where(ratio > different, level, 0.0), 1.0 - 0.5 * FALSE_TARGET_RATE)
    return _Limits(float(alone), float(different), float(together))


def _hann(count: int) -> np.ndarray:
    return 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(count) / count)


def _hamming(count: int) -> np.ndarray:
    return 0.54 - 0.46 * np.cos(2.0 * np.pi * np.arange(count) / count)
