"""Signals of echoes whose delays are known at times of one's own: rows for `_core.synthesize_echoes`."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..transmit import is_coded


def row_times(radar: _core.Radar, tx: int) -> NDArray[np.float64]:
    """s after the frame's start, at which `signal_of_rows` takes delays: the middles of the chirps of a transmitter, first.

    Behind them follow the first and the last samples of all these chirps where one chirp is not as far from the next as all are,
    or is alone: differences between chirps do not tell there how delays change within each of them.
    """
    middles = np.array([radar.chirp_time(tx, chirp) for chirp in range(radar.waveform.num_chirps)])
    half = _half(radar.waveform)
    return middles if _is_even(radar.waveform) else np.concatenate([middles, middles - half, middles + half])


def signal_of_rows(radar: _core.Radar, delays: NDArray[np.float64], fields: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """The signal [chirp, sample] in sqrt(W) of one channel of a radar whose chirps are alike.

    delays: [rows, N] s, at `row_times`; fields: [chirp, N] in sqrt(W), without the phase of the delay
    """
    waveform = radar.waveform.replace(chirp_interval=radar.waveform.mean_interval, extra_idle=())
    if _is_even(radar.waveform):
        return _core.synthesize_echoes(waveform, delays, fields, num_slots=1 if is_coded(radar) else radar.num_slots)
    middle, start, end = np.split(delays, 3)
    # Each chirp stands between two rows, one chirp before and behind it, that give it its own change.
    onward = (end - start) * (waveform.chirp_duration / (2.0 * _half(waveform)))
    rows = np.stack([middle + step * onward for step in (-1.0, 0.0, 1.0)], axis=1).reshape(3 * len(middle), -1)
    apart = waveform.replace(num_chirps=len(rows), chirp_interval=waveform.chirp_duration)
    return _core.synthesize_echoes(apart, np.maximum(rows, 0.0), np.repeat(fields, 3, axis=0))[1::3]


def _is_even(waveform: _core.ChirpSequence) -> bool:
    """Whether chirps follow each other evenly, and are not alone."""
    return waveform.num_chirps > 1 and len(set(waveform.extra_idle)) < 2


def _half(waveform: _core.ChirpSequence) -> float:
    """s, from the first sample of a chirp to its middle; of a single sample any time serves."""
    return waveform.window_centre or 0.5 * waveform.chirp_duration
