"""The converter: clock jitter, gain, saturation, quantisation."""
from __future__ import annotations

import math

import numpy as np

from ..base.callers import warn_user
from ..base.counts import at_least
from .filters import beat_frequencies
from .settings import Adc

CLIPPED = 0.01    # share of the codes: a converter that meets more than peaks beyond its range is set wrongly
ROUNDING = 1e-9   # of an amplitude


def converted(cube: np.ndarray, waveform, adc: Adc):
    """cube in sqrt(W) -> (what the codes stand for in sqrt(W), codes int16 [..., 2 or 1], gain in dB)"""
    branches = np.stack([cube.real] if waveform.real else [cube.real, cube.imag], axis=-1)
    gain_db = _automatic_gain(branches, waveform, adc) if adc.automatic_gain else adc.gain_db
    step = _full_scale(waveform, adc) * 10.0 ** (-gain_db / 20.0) / 2 ** (adc.bits - 1)
    codes = np.clip(np.rint(branches / step), -2 ** (adc.bits - 1), 2 ** (adc.bits - 1) - 1).astype(np.int16)
    values = codes * step
    cube = values[..., 0] + (0j if waveform.real else 1j * values[..., 1])
    return cube, codes, gain_db


def warn_of_levels(cube: np.ndarray, codes: np.ndarray, waveform, adc: Adc, gain_db: float) -> None:
    """Warns (RuntimeWarning) where the converter clips more than CLIPPED of the codes, or gives the same code for all.

    cube: before the converter, in sqrt(W); codes, gain_db: of `converted`
    """
    branches = (cube.real,) if waveform.real else (cube.real, cube.imag)
    largest = max(float(np.max(np.abs(branch), initial=0.0)) for branch in branches)
    full_scale = _full_scale(waveform, adc) * 10.0 ** (-gain_db / 20.0)
    if largest == 0.0:
        return
    clipped = sum(np.count_nonzero(np.abs(branch) > full_scale * (1.0 + ROUNDING)) for branch in branches) / codes.size
    if clipped > CLIPPED:
        warn_user(f"receiver.adc: {at_least(int(100.0 * clipped))} % of the codes are clipped at full scale: lower gain_db by "
                  f"{_in_steps(largest / full_scale)} dB, or let automatic_gain choose it")
    if np.all(codes == codes[:1, :1, :1, :1]):
        rms = math.sqrt(sum(np.var(branch) for branch in branches) / len(branches))
        missing = _in_steps(full_scale / 2 ** (adc.bits - 1) / max(rms, ROUNDING * largest))
        setting = "lower headroom_db" if adc.automatic_gain else "raise gain_db"
        warn_user(f"receiver.adc: the signal with its noise stays below one step, and all codes are alike: {setting} by "
                  f"{missing} dB, or take more bits")


def _in_steps(ratio: float) -> int:
    """A ratio of amplitudes in dB, up to the next multiple of 5: frames in a row need alike changes."""
    return 5 * math.ceil(4.0 * math.log10(ratio) - ROUNDING)


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
