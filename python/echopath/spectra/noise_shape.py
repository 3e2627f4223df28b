"""How the noise behind a receiver's filters lies over the ranges of a map."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from .. import _core
from ..receiver.filters import beat_frequencies, has_filters, length_of_past, response
from ..receiver.imbalance import weights_of_imbalance
from .windows import of_range, samples_of

_BLOCKS = 16       # of ranges; of the quarter of which filters leave least, the quietest tells the noise behind them
_ROUNDING = 1e-12  # of the largest power, below which there is nothing but rounding
_SHORT = 128       # squared samples of a chirp over those of its past, up to which it is cheapest to go through them
_MOST_SAMPLES = 1 << 20  # of responses that are transformed at once
_LOST = 1e-14      # of the largest power, of what the past sends
_ROUNDS = 8  # that more would change by 1e-4, of white noise down to 70 dB below what filters let pass
_ROWS_AT_ONCE = 16  # that are looked for in what the past sends


def noise_shape(spectrum, radar) -> np.ndarray:
    """Mean power [R] of the noise at each range of a map over that without filters; [0] where it is alike at all.

    Model: thermal noise behind filters and imbalance, seen through the window; and white noise behind the filters, as of
    quantisation, by which cells exceed it where filters leave little. That level is taken from the map, as automatic gain
    changes it from frame to frame; it is all of the noise where that has not passed the filters.
    spectrum: RangeDoppler as the receiver gives it; radar: that of the spectrum
    """
    if radar.receiver is None or not has_filters(radar.receiver):
        return np.zeros(0)
    circle = _filtered_power(radar.receiver, radar.waveform, of_range(spectrum.window), spectrum.zero_pad)
    if not radar.waveform.real:
        own, image = np.abs(weights_of_imbalance(radar.receiver)) ** 2
        circle = own * circle + image * np.roll(circle[::-1], 1)
    thermal = circle[:len(spectrum.range)]
    share, white = _shares(spectrum, radar, thermal)
    return share * thermal + white


@lru_cache(maxsize=8)
def _filtered_power(receiver, waveform, window, zero_pad: int) -> np.ndarray:
    """Mean power [zero_pad S] that the filters leave of white noise of unit power in each cell of the transform of a chirp.

    Model: the samples of a chirp are independent, and `past_of` foretells next to nothing from them, so that the powers of the
    filters' responses to each of them add up. They are transformed to twice the samples, whose transform back is the correlation
    of the noise behind the window, at most a chirp long: padding only looks at it more closely.
    """
    count = waveform.num_samples
    gain = response(receiver, beat_frequencies(waveform, count + length_of_past(waveform, receiver)))
    taper = samples_of(window, count)
    is_short = count ** 2 <= _SHORT * (len(gain) - count)
    power = _power_of_each(gain, taper) if is_short else _power_without_past(gain, taper)
    correlation = np.fft.ifft(power) / np.sum(taper ** 2)
    lags = np.arange(1 - count, count)
    folded = np.zeros(count * zero_pad, complex)
    np.add.at(folded, lags % len(folded), correlation[lags])
    shape = np.fft.fft(folded).real
    if waveform.falls:
        shape = shape[-np.arange(len(shape))]  # ranges stand in cells of negative frequencies
    return np.maximum(shape, _ROUNDING * shape.max())


def _power_of_each(gain: np.ndarray, taper: np.ndarray) -> np.ndarray:
    """Power [2 S] of the responses to each sample of a chirp, one by one.

    gain: of the filters, [S + past]; taper: the window, [S]
    """
    count = len(taper)
    impulse = np.fft.ifft(gain)
    power = np.zeros(2 * count)
    at_once = max(1, _MOST_SAMPLES // (2 * count))
    for first in range(0, count, at_once):
        late = np.arange(count) - np.arange(first, min(first + at_once, count))[:, None]  # of each sample after that of the noise
        power += np.sum(np.abs(np.fft.fft(taper * impulse[late % len(impulse)], 2 * count)) ** 2, axis=0)
    return power


def _power_without_past(gain: np.ndarray, taper: np.ndarray) -> np.ndarray:
    """Likewise, without going through the samples of a long chirp.

    Model: were there noise in the past as well, that behind the filters would be stationary, and its correlation behind the
    window that of the filters times that of the window. Of this goes what noise of the past would send into the chirp.
    """
    count = len(taper)
    lags = np.arange(1 - count, count)
    correlation = np.fft.ifft(np.abs(np.fft.fft(taper, 2 * count)) ** 2)
    correlation[lags] *= np.fft.ifft(np.abs(gain) ** 2)[lags]
    power = np.fft.fft(correlation).real
    for echo in _echoes_of_past(gain, count):
        power -= np.abs(np.fft.fft(taper * echo, 2 * count)) ** 2
    return power


def _echoes_of_past(gain: np.ndarray, count: int) -> np.ndarray:
    """A few rows [row, count], whose powers add up to those of the responses, in a chirp, to all samples before it.

    Model: those responses [count, past] have next to no rank, as each pole of a filter decays in one way only, and jumps of the
    gain add some rows for each decade of samples. An orthonormal basis of the past that holds all but 1e-14 of them is found by
    sending random mixtures of the chirp back to it (Halko, Martinsson, Tropp 2011, 4.4); the rows are the responses to it.
    gain: of the filters, [count + past]
    """
    past = len(gain) - count
    lags = np.arange(1, len(gain))
    times_met = np.minimum(np.minimum(lags, len(gain) - lags), min(count, past))  # by pairs of a sample and one of the past
    left = np.sum(np.abs(np.fft.ifft(gain)[lags]) ** 2 * times_met)
    enough = _LOST * np.max(np.abs(gain)) ** 2
    draws = np.random.default_rng(0)
    basis, rows = np.zeros((0, past), complex), np.zeros((0, count), complex)
    while left > enough and len(rows) < min(count, past):
        mixtures = draws.standard_normal((min(_ROWS_AT_ONCE, min(count, past) - len(rows)), count))
        sent_back = np.fft.ifft(np.fft.fft(mixtures, len(gain)) * gain.conj())[:, count:]
        for _ in range(2):  # once leaves rounding of what is large
            sent_back = sent_back - (sent_back @ basis.conj().T) @ basis
        found = np.linalg.qr(sent_back.T)[0].T
        basis = np.concatenate([basis, found])
        found = np.pad(found, ((0, 0), (count, 0)))
        rows = np.concatenate([rows, np.fft.ifft(np.fft.fft(found) * gain)[:, :count]])
        left -= np.sum(np.abs(rows[-len(found):]) ** 2)
    return rows


def _shares(spectrum, radar, thermal) -> tuple[float, float]:
    """(share, white): the noise is `share` times what filters leave of thermal noise and `white`, both over thermal noise before
    them. The share is 1 but for noise that has not passed the filters.

    thermal: [R], what the filters leave. Levels are medians over velocities, which echoes in fewer than half of the cells leave.
    """
    power = np.asarray(_core.mean_power(spectrum)) / _core.cell_noise_power(radar, spectrum.window)
    level = np.median(power, axis=0) / _median_over_mean(spectrum.values.shape[0] * spectrum.values.shape[1])
    blocks = np.array_split(np.arange(len(level)), min(_BLOCKS, len(level)))
    faint = sorted(blocks, key=lambda block: np.median(thermal[block]))[:max(1, len(blocks) // 4)]
    quietest = min(faint, key=lambda block: np.median(level[block]))
    white = _white(level[quietest], thermal[quietest])
    is_passed = thermal >= 0.5 * thermal.max()
    share = float(np.median((level[is_passed] - white) / thermal[is_passed]))
    return (min(max(share, 0.0), 1.0) if white > 0.0 else 1.0), white


def _white(level: np.ndarray, thermal: np.ndarray) -> float:
    """What levels have beside thermal noise. Their errors grow with what is expected of them: next to where a high-pass lets
    nothing pass, ranges that it lets pass would drown the white noise, unless each counts by its variance."""
    white = float(np.median(level))
    for _ in range(_ROUNDS):
        white = max(0.0, _weighted_median(level - thermal, (thermal + white) ** -2.0))
    return white


def _weighted_median(values: np.ndarray, weights: np.ndarray) -> float:
    """That of which the smaller and the larger values have half of the weights each."""
    order = np.argsort(values)
    return float(np.interp(0.5 * weights.sum(), np.cumsum(weights[order]) - 0.5 * weights[order], values[order]))


def _median_over_mean(num_channels: int) -> float:
    """Of the mean power over channels of independent noise: its gamma law by the cube of a normal one (Wilson, Hilferty 1931),
    to 1.4 % of one channel, better of more."""
    return (1.0 - 1.0 / (9.0 * num_channels)) ** 3
