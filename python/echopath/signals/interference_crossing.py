"""One chirp of another radar, as it comes over many ways, mixed with one chirp of a radar."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _core

FINE = 4       # times the sampling rate, at which crossings are made before the filter
EDGE = 32      # samples before and behind those of a chirp, which its filter has met, too
_FADE = 8      # samples, the longest in which a crossing fades in and out beyond the band
_BEYOND = 0.25  # of the sampling rate: difference of frequency beyond the band from which it may fade
_MARGIN = 1.9  # of the sampling rate: differences of frequency beyond which nothing of a crossing is left in the band
_BLOCK = 64    # fine samples within which ways differ by a tone
_FEW_WAYS = 4  # that are made sample by sample


class Chirps(NamedTuple):
    """A chirp of this radar and one of the other: frequencies of their first samples in Hz, slopes in Hz/s.

    waveform: of this radar; sent_duration: s; late: s, by which the chirp of this radar begins later
    sent_bends: (Hz/s^2, Hz/s^3, ...), by which the other frequency is off its slope: times t^2, t^3, ..., t in s after its first
        sample
    """

    waveform: _core.ChirpSequence
    start: float
    slope: float
    sent_start: float
    sent_slope: float
    sent_duration: float
    late: float
    sent_bends: tuple = ()


def add_crossing(fine: np.ndarray, chirps: Chirps, delay: np.ndarray, amplitude: np.ndarray) -> None:
    """Adds one chirp of the other radar, over all ways, to one chirp of this one.

    Of more than a few ways each has its phase in the middle of each block of samples, exactly; within a block it differs from the
    first one by the tone of the block in the middle of the chirp (to 1e-3 rad where ways differ by 100 m/s). So a block is a
    product of matrices. Blocks in which a way begins, ends or fades are summed sample by sample.
    fine: [FINE x (sample + 2 EDGE)] in sqrt(W), added to; delay: [3, P] s at the first sample, in the middle and at the last one
    amplitude: [P] sqrt(W)
    """
    heard = _heard(chirps, delay[1])
    ways = (amplitude != 0.0) & (heard.end > np.maximum(heard.begin, 0.0)) & (heard.begin < len(fine))
    if not ways.any():
        return
    heard, delay, amplitude = _Heard(*(one[ways] for one in heard)), delay[:, ways], np.conj(amplitude[ways])
    if np.count_nonzero(ways) <= _FEW_WAYS:
        for way, strength in enumerate(amplitude):
            of_way = _Heard(*(one[way] for one in heard))
            at = np.arange(*np.clip(np.ceil((of_way.begin, of_way.end)), 0, len(fine)).astype(int))
            fine[at] += strength * _weights(of_way, at) * _turned(_cycles(chirps, at, delay[:, way]))
        return
    place = np.arange(-(-len(fine) // _BLOCK) * _BLOCK).reshape(-1, _BLOCK)
    fills = (place[:, :1] >= heard.full) & (place[:, -1:] < heard.fading)
    blocks = _whole_blocks(chirps, place, fills, delay, amplitude)
    block, way = np.nonzero(~fills & (place[:, -1:] >= heard.begin) & (place[:, :1] < heard.end))
    at = place[block]
    weights = _weights(_Heard(*(one[way, None] for one in heard)), at)
    np.add.at(blocks, block, amplitude[way, None] * weights * _turned(_cycles(chirps, at, delay[:, way, None])))
    fine += blocks.ravel()[:len(fine)]


def _whole_blocks(chirps: Chirps, place, fills, delay, amplitude) -> np.ndarray:
    """The sum over all ways in the blocks that they fill, [blocks, _BLOCK]; fills: [blocks, P]."""
    middle = place[:, :1] + 0.5 * (_BLOCK - 1)
    reference = delay[:, :1]
    apart = _cycles(chirps, middle, delay[:, None]) - _cycles(chirps, middle, reference[:, None])
    ends = place[len(place) // 2, [0, -1], None]
    of_ends = _cycles(chirps, ends, delay[:, None]) - _cycles(chirps, ends, reference[:, None])
    tone = (of_ends[1] - of_ends[0]) / (_BLOCK - 1)  # cycles per sample, of the block in the middle
    in_middles = np.where(fills, amplitude * _turned(apart), 0.0)
    within = _turned(np.outer(place[0] - middle[0], tone))
    # By einsum, whose sums one thread makes: products as small as these wait longer for the threads of a BLAS than they take.
    return np.einsum("bp,kp->bk", in_middles, within) * _turned(_cycles(chirps, place, reference[:, :, None]))


def _turned(cycles) -> np.ndarray:
    return np.exp(2j * np.pi * np.mod(cycles, 1.0))


def _cycles(chirps: Chirps, place, delay) -> np.ndarray:
    """Of the phase of the mixed signal at fine samples; delay: [3, ...] s, whose shape behind the first axis goes with that of
    the samples."""
    waveform, start, slope, sent_start, sent_slope, _, late, bends = chirps
    time = (place / FINE - EDGE) / waveform.sampling_rate
    share = time * waveform.sampling_rate / max(waveform.num_samples - 1, 1)
    # The parabola through the delays at the first sample, in the middle and at the last one.
    curve = (1.0 - share) * (1.0 - 2.0 * share), 4.0 * share * (1.0 - share), share * (2.0 * share - 1.0)
    sent_time = late + time - sum(weight * one for weight, one in zip(curve, delay))
    cycles = (start - sent_start) * time + sent_start * (time - sent_time) + 0.5 * slope * time ** 2 \
        - 0.5 * sent_slope * sent_time ** 2
    return cycles - sum(bend * sent_time ** power / power for power, bend in enumerate(bends, 3))


class _Heard(NamedTuple):
    """Between which fine samples ways are heard [P]: from `begin` to `end`, wholly from `full` to `fading`. These are the same
    where the other radar begins or ceases to send; where the difference of both frequencies leaves the margin it fades, since an
    abrupt end would be heard in the band."""

    begin: np.ndarray
    full: np.ndarray
    fading: np.ndarray
    end: np.ndarray


def _heard(chirps: Chirps, delay) -> _Heard:
    """Of ways with a delay [P] in s."""
    waveform, start, slope, sent_start, sent_slope, sent_duration, late, _ = chirps
    begin, end, fade = delay - late, delay - late + sent_duration, np.zeros((2, len(delay)))
    margin, difference, rate = _MARGIN * waveform.sampling_rate, start - sent_start + sent_slope * begin, slope - sent_slope
    if rate == 0.0:
        end = np.where(np.abs(difference) < margin, end, begin)
    else:
        ends = np.sort([(-margin - difference) / rate, (margin - difference) / rate], axis=0)
        beyond = (_MARGIN - 1.0 - _BEYOND) * waveform.sampling_rate / abs(rate)
        fade = np.where([ends[0] > begin, ends[1] < end], min(_FADE / waveform.sampling_rate, beyond), 0.0)
        begin, end = np.maximum(begin, ends[0]), np.minimum(end, ends[1])
    return _Heard(*(FINE * (EDGE + waveform.sampling_rate * time) for time in (begin, begin + fade[0], end - fade[1], end)))


def _weights(heard: _Heard, place):
    """How much of a way is left at fine samples: between 0 and 1 where it fades."""
    weights = ((place >= heard.begin) & (place < heard.end)).astype(float)
    for inside, length in ((place - heard.begin, heard.full - heard.begin), (heard.end - place, heard.end - heard.fading)):
        if np.any(length > 0.0):
            share = np.clip(np.divide(inside, length, out=np.ones(inside.shape), where=length > 0.0), 0.0, 1.0)
            weights *= share * share * (3.0 - 2.0 * share)
    return weights
