"""The converter: clock jitter, gain, saturation, quantisation."""
from __future__ import annotations

import math

import numpy as np

from .. import _core
from ..base.numerics.decibels import in_dbm
from ..base.process.callers import warn_user
from ..base.text.counts import at_least, counted
from ..transmit import radar_of_noise
from .filters import beat_frequencies, has_filters, response
from .settings import Adc

CLIPPED = 0.01    # share of the codes: a converter that meets more than peaks beyond its range is set wrongly
ROUNDING = 1e-9   # of an amplitude
FEW_CODES = 10    # are told one by one
BIT_DB = 20.0 * math.log10(2.0)


def converted(cube: np.ndarray, waveform, adc: Adc):
    """cube in sqrt(W) -> (what the codes stand for in sqrt(W), codes int16 [..., 2 or 1], gain in dB)"""
    branches = np.stack([cube.real] if waveform.real else [cube.real, cube.imag], axis=-1)
    gain_db = _automatic_gain(branches, waveform, adc) if adc.automatic_gain else adc.gain_db
    step = step_of(waveform, adc, gain_db)
    codes = np.clip(np.rint(branches / step), -2 ** (adc.bits - 1), 2 ** (adc.bits - 1) - 1).astype(np.int16)
    return cube_of(codes, step), codes, gain_db


def cube_of(codes: np.ndarray, step: float) -> np.ndarray:
    """What codes [..., 2 or 1] stand for in sqrt(W); step: of `step_of`"""
    values = codes * step
    return values[..., 0] + (0j if values.shape[-1] == 1 else 1j * values[..., 1])


def step_of(waveform, adc: Adc, gain_db: float) -> float:
    """The step from code to code, in sqrt(W) at the antenna."""
    return _full_scale(waveform, adc) * 10.0 ** (-gain_db / 20.0) / 2 ** (adc.bits - 1)


def noise_of_branch(radar) -> float:
    """The rms of the thermal noise in a branch where the converter meets it, in sqrt(W) at the antenna."""
    power = _core.noise_power(radar_of_noise(radar)) * (1.0 if radar.waveform.real else 0.5)
    if has_filters(radar.receiver):
        power *= float(np.mean(np.abs(response(radar.receiver, beat_frequencies(radar.waveform))) ** 2))
    return math.sqrt(power)


def is_swamped(noise: float, step: float) -> bool:
    """Whether rounding to steps adds more to noise of that rms in a branch than it has: step^2 / 12, evenly within a step."""
    return 0.0 < noise < step / math.sqrt(12.0)


def step_text(radar) -> str:
    """Steps and noise of a converter whose gain is fixed, and how many codes noise alone uses; of another its bits."""
    adc, samples = radar.receiver.adc, radar.waveform.num_samples * radar.waveform.num_chirps
    if adc.automatic_gain:
        return f"{adc.bits} bits, gain chosen for each frame"
    step, noise = step_of(radar.waveform, adc, adc.gain_db), noise_of_branch(radar)
    text = f"{adc.bits} bits, steps of {_dbm(step)}, noise of {_dbm(noise)} in a branch"
    if not is_swamped(noise, step):
        return text
    largest = noise * math.sqrt(2.0 * math.log(max(2, samples)))  # of as many normal numbers
    used = counted(2 * round(largest / step) + 1, "code")
    return (f"{text}: the steps swamp the noise, which uses {used} of {2 ** adc.bits:,}: "
            f"raise gain_db by {_in_steps(step / noise)} dB, or take more bits")


def warn_of_levels(cube: np.ndarray, codes: np.ndarray, waveform, adc: Adc, gain_db: float, noise: float) -> None:
    """Warns (RuntimeWarning) where the converter clips more than CLIPPED of the codes, gives the same code for all, or rounds to
    steps that swamp the noise.

    cube: before the converter, in sqrt(W); codes, gain_db: of `converted`; noise: of `noise_of_branch`, 0: none was added
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
    elif is_swamped(noise, step := step_of(waveform, adc, gain_db)):
        warn_user(f"receiver.adc: its steps of {_dbm(step)} swamp the noise of {_dbm(noise)} in a branch, and {_used(codes)} of "
                  f"{2 ** adc.bits:,} codes are used: {_mended(step / noise, full_scale / largest, adc)}")


def _used(codes: np.ndarray) -> str:
    """How many codes there are, coarse where there are many: frames in a row differ little."""
    number = len(np.unique(codes))
    return str(number) if number <= FEW_CODES else at_least(number)


def _mended(missing: float, room: float, adc: Adc) -> str:
    """What to change where steps are larger than the noise by a ratio; room: full scale over the largest sample."""
    more = _in_steps(missing)
    if more <= 20.0 * math.log10(room):
        return f"{'lower headroom_db' if adc.automatic_gain else 'raise gain_db'} by {more} dB, or take more bits"
    bits = counted(math.ceil(20.0 * math.log10(missing) / BIT_DB), "bit")
    return f"take {bits} more, as more gain would clip what is strongest"


def _dbm(amplitude: float) -> str:
    """Of a branch, in sqrt(W)."""
    return f"{in_dbm(amplitude ** 2):.1f} dBm"


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
