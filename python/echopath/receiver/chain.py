"""From the ideal signal to what the converter gives: the stages in their order."""
from __future__ import annotations

import dataclasses

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, checked, optional, real, refused, seed as seed_rule
from ..transmit import code_of, is_coded, radar_of_noise
from .analytic import as_samples
from .channels import coupled, receiver_factors, require_channels, transmitter_factors
from .converter import converted
from .filters import filtered
from .imbalance import compressed, unbalanced
from .leakage import leakage_amplitudes, leaked_tone
from .oscillator import Oscillator
from .settings import Receiver
from .slots import SlotTimes


@dataclasses.dataclass(eq=False)
class Reception:
    """What a receiver gives.

    cube: [tx, rx, chirp, sample], or [1, rx, slots, sample] of transmitters that send at once, in sqrt(W) at the antenna
    codes: int16 [..., 2], I and Q of each sample of the cube as the converter gives them, [..., 1] of real samples; None
        without a converter
    gain_db: dB from the antenna to the converter, None without one
    """

    cube: np.ndarray
    codes: np.ndarray | None = None
    gain_db: float | None = None


@checked(start_time=real(unit="s"), seed=optional(seed_rule))
def receive(cube: ArrayLike, radar: _core.Radar, *, seed: int | None, start_time: float = 0.0) -> Reception:
    """What the receiver of a radar makes of the ideal signal: noise, and the faults of `radar.receiver` in their order.

    cube: of `synthesize` for that radar: [tx, rx, chirp, sample] in sqrt(W), or [1, rx, slots, sample] of transmitters that
        send at once, which have the errors of their chains already
    seed: of thermal noise, phase noise and jitter, drawn from it and start_time; None: none of them
    start_time: s, first sample of the frame
    Returns Reception. Raises TypeError or ValueError naming the argument, also where the receiver has tables of other
    antennas.
    """
    return reception(np.asarray(cube, np.complex128), radar, seed, start_time)


def reception(cube: np.ndarray, radar: _core.Radar, seed: int | None, start_time: float) -> Reception:
    """`receive` of complex128 that nobody needs to check: the signal of a frame, over which a check would go once more."""
    noisy_radar, receiver = radar_of_noise(radar), radar.receiver
    waveform = noisy_radar.waveform
    shape = (len(noisy_radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples)
    if cube.shape != shape:
        raise refused(ValueError, "cube", f"of the shape {shape}", cube)
    if receiver is None:
        return Reception(cube if seed is None else _noise(cube, noisy_radar, seed, start_time))
    require_channels(receiver, radar)
    return _received(cube, radar, receiver, seed, start_time)


def _received(cube, radar, receiver: Receiver, seed: int | None, start_time: float) -> Reception:
    slots = SlotTimes(radar, start_time)
    if not is_coded(radar):
        factors = transmitter_factors(receiver, radar)
        cube = cube if factors is None else cube * factors[:, None, None, None]
    cube = _mixed(cube, radar, receiver, slots, seed)
    cube = coupled(cube, radar, receiver)
    factors = receiver_factors(receiver, radar, slots)
    cube = cube if factors is None else cube * factors
    if seed is not None:
        cube = _noise(cube, radar_of_noise(radar), seed, start_time)
    cube = compressed(cube, radar, receiver)
    cube = filtered(cube, radar.waveform, receiver)
    cube = unbalanced(cube, radar.waveform, receiver)
    if receiver.adc is None:
        return Reception(cube)
    return Reception(*converted(cube, radar.waveform, receiver.adc, slots.generator(seed, "jitter")))


def _mixed(cube, radar, receiver: Receiver, slots: SlotTimes, seed):
    """After the mixers: echoes and leakage with what the oscillator does in the meantime of each delay."""
    waveform = radar.waveform
    oscillator = Oscillator(radar, receiver, slots, slots.generator(seed, "phase noise"))
    if not oscillator.is_ideal:
        cube = oscillator.mixed(cube)
    amplitudes = leakage_amplitudes(radar, receiver)
    if amplitudes is None:
        return cube
    if oscillator.is_ideal:
        tone = leaked_tone(waveform, receiver.leakage_delay, np.arange(waveform.num_samples) / waveform.sampling_rate)
    else:
        tone = oscillator.leaked(receiver.leakage_delay)
    return cube + as_samples(amplitudes * tone, waveform.real)


def _noise(cube, radar, seed: int, start_time: float):
    return _core.add_noise(cube, radar, seed=seed, start_time=start_time)


def transmitted_code(radar) -> np.ndarray:
    """The code of the frame with the errors of the transmitters, complex [tx, slots]."""
    code = code_of(radar)
    factors = None if radar.receiver is None else transmitter_factors(radar.receiver, radar)
    return code if factors is None else code * factors[:, None]
