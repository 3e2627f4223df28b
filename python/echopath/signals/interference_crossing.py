"""One chirp of another radar, as it comes over many ways, mixed with one chirp of a radar."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _core

FINE = 4       # times the sampling rate, at which crossings are made before the filter
_MARGIN = 1.9  # of the sampling rate: differences of frequency beyond which nothing of a crossing is left in the band
_BLOCK = 64    # fine samples within which ways differ by a tone
_FEW_WAYS = 4  # that are made sample by sample


class Chirps(NamedTuple):
    """A chirp of this radar and one of the other: frequencies of their first samples in Hz, slopes in Hz/s.

    waveform: of this radar; sent_duration: s; late: s, by which the chirp of this radar begins later
    """

    waveform: _core.ChirpSequence
    start: float
    slope: float
    sent_start: float
    sent_slope: float
    sent_duration: float
    late: float


def add_crossing(fine: np.ndarray, chirps: Chirps, delay: np.ndarray, amplitude: np.ndarray) -> None:
    """Adds one chirp of the other radar, over all ways, to one chirp of this one.

    Of more than a few ways each has its phase in the middle of each block of samples, exactly; within a block it differs from the
    first one by the tone of the block in the middle of the chirp (to 1e-3 rad where ways differ by 100 m/s). So a block is a
    product of matrices. Blocks in which a way begins or ends are summed sample by sample.
    fine: [FINE x sample] in sqrt(W), added to; delay: [3, P] s at the first sample, in the middle and at the last one
    amplitude: [P] sqrt(W)
    """
    first, last = _heard(chirps, delay[1], len(fine))
    ways = (amplitude != 0.0) & (last > first)
    if not ways.any():
        return
    first, last, delay, amplitude = first[ways], last[ways], delay[:, ways], np.conj(amplitude[ways])
    if len(first) <= _FEW_WAYS:
        for begin, end, of_way, strength in zip(first, last, delay.T, amplitude):
            fine[begin:end] += strength * _turned(_cycles(chirps, np.arange(begin, end), of_way))
        return
    place = np.arange(-(-len(fine) // _BLOCK) * _BLOCK).reshape(-1, _BLOCK)
    blocks = _whole_blocks(chirps, place, first, last, delay, amplitude)
    begins, ends = first // _BLOCK, (last - 1) // _BLOCK
    for block, which in ((begins, first % _BLOCK > 0), (ends, (last % _BLOCK > 0) & ((ends > begins) | (first % _BLOCK == 0)))):
        at = place[block[which]]
        heard = (at >= first[which, None]) & (at < last[which, None])
        values = amplitude[which, None] * _turned(_cycles(chirps, at, delay[:, which, None]))
        np.add.at(blocks, block[which], np.where(heard, values, 0.0))
    fine += blocks.ravel()[:len(fine)]


def _whole_blocks(chirps: Chirps, place, first, last, delay, amplitude) -> np.ndarray:
    """The sum over all ways in the blocks that they fill, [blocks, _BLOCK]."""
    middle = place[:, :1] + 0.5 * (_BLOCK - 1)
    reference = delay[:, :1]
    apart = _cycles(chirps, middle, delay[:, None]) - _cycles(chirps, middle, reference[:, None])
    ends = place[len(place) // 2, [0, -1], None]
    of_ends = _cycles(chirps, ends, delay[:, None]) - _cycles(chirps, ends, reference[:, None])
    tone = (of_ends[1] - of_ends[0]) / (_BLOCK - 1)  # cycles per sample, of the block in the middle
    fills = (place[:, :1] >= first) & (place[:, -1:] < last)
    in_middles = np.where(fills, amplitude * _turned(apart), 0.0)
    within = _turned(np.outer(place[0] - middle[0], tone))
    # By einsum, whose sums one thread makes: products as small as these wait longer for the threads of a BLAS than they take.
    return np.einsum("bp,kp->bk", in_middles, within) * _turned(_cycles(chirps, place, reference[:, :, None]))


def _turned(cycles) -> np.ndarray:
    return np.exp(2j * np.pi * np.mod(cycles, 1.0))


def _cycles(chirps: Chirps, place, delay) -> np.ndarray:
    """Of the phase of the mixed signal at fine samples; delay: [3, ...] s, whose shape behind the first axis goes with that of
    the samples."""
    waveform, start, slope, sent_start, sent_slope, _, late = chirps
    time = place / (FINE * waveform.sampling_rate)
    share = time * waveform.sampling_rate / max(waveform.num_samples - 1, 1)
    # The parabola through the delays at the first sample, in the middle and at the last one.
    curve = (1.0 - share) * (1.0 - 2.0 * share), 4.0 * share * (1.0 - share), share * (2.0 * share - 1.0)
    sent_time = late + time - sum(weight * one for weight, one in zip(curve, delay))
    return (start - sent_start) * time + sent_start * (time - sent_time) + 0.5 * slope * time ** 2 \
        - 0.5 * sent_slope * sent_time ** 2


def _heard(chirps: Chirps, delay, count: int) -> tuple:
    """First and last + 1 of the samples [count] in which each way of a delay [P] in s is heard: while the other radar sends, and
    the difference of both frequencies is no more than the margin."""
    waveform, start, slope, sent_start, sent_slope, sent_duration, late = chirps
    begin, end = delay - late, delay - late + sent_duration
    margin, difference, rate = _MARGIN * waveform.sampling_rate, start - sent_start + sent_slope * begin, slope - sent_slope
    if rate == 0.0:
        end = np.where(np.abs(difference) < margin, end, begin)
    else:
        ends = np.sort([(-margin - difference) / rate, (margin - difference) / rate], axis=0)
        begin, end = np.maximum(begin, ends[0]), np.minimum(end, ends[1])
    samples = FINE * waveform.sampling_rate
    return tuple(np.clip(np.ceil(edge * samples), 0, count).astype(int) for edge in (begin, end))
