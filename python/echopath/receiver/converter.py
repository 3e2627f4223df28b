"""The converter: clock jitter, gain, saturation, quantisation."""
from __future__ import annotations

import math

import numpy as np

from ..base.callers import warn_user
from .filters import beat_frequencies
from .settings import Adc

MOST_CLIPPED = 0.01  # of the samples, at full scale without a word
ADVICE_DB = 5.0      # steps in which changes of the gain are advised, so that frames in a row say the same


def converted(cube: np.ndarray, waveform, adc: Adc):
    """cube in sqrt(W) -> (what the codes stand for in sqrt(W), codes int16 [..., 2 or 1], gain in dB)"""
    branches = np.stack([cube.real] if waveform.real else [cube.real, cube.imag], axis=-1)
    gain_db = _automatic_gain(branches, waveform, adc) if adc.automatic_gain else adc.gain_db
    step = _full_scale(waveform, adc) * 10.0 ** (-gain_db / 20.0) / 2 ** (adc.bits - 1)
    steps = np.rint(branches / step)
    codes = np.clip(steps, -2 ** (adc.bits - 1), 2 ** (adc.bits - 1) - 1).astype(np.int16)
    _warn_of_codes(branches / step, np.mean(steps != codes), adc)
    values = codes * step
    cube = values[..., 0] + (0j if waveform.real else 1j * values[..., 1])
    return cube, codes, gain_db


def _warn_of_codes(in_steps, clipped: float, adc: Adc) -> None:
    """Warns (RuntimeWarning) where the converter clips a good part of the samples, or makes nothing of them.

    in_steps: what it converts, in its steps; clipped: share of that beyond its ends
    """
    largest = float(np.max(np.abs(in_steps), initial=0.0))
    if clipped > MOST_CLIPPED:
        less = _advised_db(largest / 2 ** (adc.bits - 1))
        warn_user(f"radar.receiver.adc: clips over {100.0 * MOST_CLIPPED:.0f} % of the samples at full scale; a gain_db lower by "
                  f"{less:.0f} dB, or automatic_gain, takes them in")
    elif 0.0 < largest <= 0.5:
        more = _advised_db(1.0 / np.sqrt(np.mean(np.square(in_steps))))
        warn_user("radar.receiver.adc: the signal and its noise stay below one step, so that all codes are 0; a gain_db higher "
                  f"by {more:.0f} dB, or automatic_gain, lifts them over it")


def _advised_db(ratio: float) -> float:
    """A ratio of amplitudes in dB, up to the next of the steps."""
    return ADVICE_DB * math.ceil(20.0 * math.log10(ratio) / ADVICE_DB)


def _full_scale(waveform, adc: Adc) -> float:
    """The largest value of a branch in sqrt(W), at the input of the converter: of real samples a tone of power P reaches
    sqrt(2 P), in the branches of complex ones sqrt(P)."""
    power = 1e-3 * 10.0 ** (adc.full_scale_dbm / 10.0)
    return math.sqrt(2.0 * power if waveform.real else power)


def _automatic_gain(branches, waveform, adc: Adc) -> float:
    largest = float(np.max(np.abs(branches), initial=0.0))
    if largest == 0.0:
        return adc.gain_db
    gain_db = 20.0 * math.log10(_full_scale(waveform, adc) / largest) - adc.headroom_db
    return gain_db if adc.gain_step_db == 0.0 else math.floor(gain_db / adc.gain_step_db) * adc.gain_step_db


def jittered(cube: np.ndarray, waveform, adc: Adc, generator: np.random.Generator | None) -> np.ndarray:
    """Each instant has its own deviation, in all channels alike: to first order the slope of the signal times it.

    generator: of the deviations, None: none
    """
    if adc.clock_jitter == 0.0 or generator is None:
        return cube
    slope = np.fft.ifft(np.fft.fft(cube, axis=-1) * 2j * np.pi * beat_frequencies(waveform), axis=-1)
    deviation = generator.normal(0.0, adc.clock_jitter, (cube.shape[0], 1, *cube.shape[2:]))
    return cube + deviation * (slope.real if waveform.real else slope)
