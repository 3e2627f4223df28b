"""From the ideal signal to what the converter gives: the stages in their order."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import Any

import numpy as np

from .. import _core
from ..arguments.checks import COMMON, ArrayLike, checked, optional, real, refused, seed as seed_rule
from ..base.numerics.analytic import as_samples, turned
from ..base.numerics.past import models_of
from ..transmit import code_of, is_coded, radar_of_noise, signal_shape
from .channels import coupled, coupled_leakage, receiver_factors, require_channels, transmitter_factors
from .converter import converted, jittered, noise_of_branch, warn_of_levels
from .filters import filtered, has_filters
from .imbalance import compressed, compression, unbalanced, with_offset
from .leakage import leakage
from .oscillator import Oscillator
from .settings import Receiver
from .slots import SlotTimes


@dataclasses.dataclass(eq=False, repr=False)
class Reception:
    """What a receiver gives.

    cube: [tx, rx, chirp, sample], or [1, rx, slots, sample] of transmitters that send at once, in sqrt(W) at the antenna
    codes: int16 [..., 2], I and Q of each sample of the cube as the converter gives them, [..., 1] of real samples; None
        without a converter
    gain_db: dB from the antenna to the converter, None without one
    """

    cube: np.ndarray
    codes: np.ndarray | Any = None  # None without a converter
    gain_db: float | None = None

    def __repr__(self) -> str:
        codes = "none" if self.codes is None else f"{self.codes.dtype} {list(self.codes.shape)}"
        gain = "" if self.gain_db is None else f", gain {self.gain_db:.6g} dB"
        return f"Reception(cube {list(self.cube.shape)}, codes: {codes}{gain})"


@checked(start_time=real(unit="s"), seed=optional(seed_rule), interference=optional(COMMON["cube"]))
def receive(cube: ArrayLike, radar: _core.Radar, *, seed: int | None, start_time: float = 0.0,
            interference: ArrayLike | None = None) -> Reception:
    """What the receiver of a radar makes of the ideal signal: noise, and the faults of `radar.receiver` in their order.

    cube: of `synthesize` for that radar: [tx, rx, chirp, sample] in sqrt(W), or [1, rx, slots, sample] of transmitters that
        send at once, which have the errors of their chains already
    seed: of thermal noise, phase noise and jitter, drawn from it and start_time; None: none of them
    start_time: s, first sample of the frame
    interference: what other radars send (`interference`), of the shape of the cube in sqrt(W), or None: the errors of the
        radar's transmitters are not in it, and its own oscillator turns it by its phase of now, whatever the delay
    Returns Reception, whose cube is never the one that was given. Raises TypeError or ValueError naming the argument, also
    where the receiver has tables of other antennas. Warns (RuntimeWarning) where the converter clips more than 1 % of the
    codes, gives the same one for all, or has steps that add more to the noise than it has itself.
    """
    other = None if interference is None else np.asarray(interference, np.complex128)
    if other is not None and other.shape != np.shape(cube):
        raise refused(ValueError, "interference", f"of the shape of the cube, {np.shape(cube)}", other)
    found = reception(np.asarray(cube, np.complex128), radar, seed, start_time, other)
    return dataclasses.replace(found, cube=apart_from([cube, other], found.cube))


def apart_from(given: Iterable, made: np.ndarray) -> np.ndarray:
    """What was made of given cubes; a copy where one of them is left as it was, so that neither changes with the other."""
    return made.copy() if any(one is not None and np.may_share_memory(one, made) for one in given) else made


def reception(cube: np.ndarray, radar: _core.Radar, seed: int | None, start_time: float,
              interference: np.ndarray | None = None) -> Reception:
    """`receive` of complex128 that nobody needs to check: the signal of a frame, over which a check would go once more."""
    receiver = radar.receiver
    if cube.shape != (shape := signal_shape(radar)):
        raise refused(ValueError, "cube", f"of the shape {shape}", cube)
    if receiver is None:
        cube = cube if interference is None else cube + interference
        return Reception(cube if seed is None else _noise(cube, radar, seed, start_time))
    require_channels(receiver, radar)
    return _received(cube, radar, receiver, seed, start_time, interference)


def _received(cube, radar, receiver: Receiver, seed: int | None, start_time: float, interference) -> Reception:
    chain = Chain(radar, receiver, seed, start_time)
    cube = chain.mixed(chain.sent(cube))
    cube = cube if interference is None else cube + chain.mixed_alone(interference)
    cube, leaked = chain.amplified(chain.coupled(cube)), chain.leaked()
    cube = cube if leaked is None else cube + as_samples(leaked, radar.waveform.real)
    if seed is not None:
        cube = _noise(cube, radar, seed, start_time)
    gain = compression(cube, radar, receiver, leaked)
    cube = cube if gain is None else compressed(cube, gain, radar)
    cube = chain.unbalanced(chain.filtered(cube, chain.models_of(cube)))
    cube = with_offset(cube, radar.waveform, receiver)
    if receiver.adc is None:
        return Reception(cube)
    cube = chain.sampled(cube)
    out, codes, gain_db = converted(cube, radar.waveform, receiver.adc)
    warn_of_levels(cube, codes, radar.waveform, receiver.adc, gain_db, 0.0 if seed is None else noise_of_branch(radar))
    return Reception(out, codes, gain_db)


class Chain:
    """The linear stages of a receiver for the slots of one frame: what comes out of a sum is the sum of what comes out.

    radar: that has the antennas; receiver: Receiver; seed: of phase noise and jitter, None: neither; start_time: s, of the frame
    Cubes are [tx, rx, chirp, sample], or [1, rx, slots, sample] of transmitters that send at once, in sqrt(W).
    """

    def __init__(self, radar, receiver: Receiver, seed: int | None, start_time: float):
        self._radar, self._receiver, self._seed = radar, receiver, seed
        self._slots = SlotTimes(radar, start_time)
        self._oscillator = Oscillator(radar, receiver, self._slots, self._slots.generator(seed, "phase noise"))

    def sent(self, cube, whole=None):
        """Echoes with the errors of the transmitters, those of simultaneous codes have them already; whole: as in `turned`."""
        factors = None if is_coded(self._radar) else transmitter_factors(self._receiver, self._radar)
        return cube if factors is None else self._turned(cube, factors[:, None, None, None], whole)

    def mixed(self, cube):
        """Echoes after the mixers: with what the oscillator does in the meantime of each delay."""
        return cube if self._oscillator.is_ideal else self._oscillator.mixed(cube)

    def mixed_alone(self, cube):
        """What other radars send, after the mixers."""
        return cube if self._oscillator.is_ideal else self._oscillator.alone(cube)

    def leaked(self):
        """The leakage with what couples from receiver to receiver and with their errors, complex in a shape that a cube takes
        (`as_samples` makes its samples); None: none."""
        leaked = leakage(self._radar, self._receiver, self._slots, self._oscillator)
        if leaked is None:
            return None
        leaked = coupled_leakage(leaked, self._radar, self._receiver, self._slots)
        factors = self._receiver_factors()
        return leaked if factors is None else leaked * factors

    def coupled(self, cube, whole=None):
        """With what couples from receiver to receiver; whole: as in `turned`."""
        return coupled(cube, self._radar, self._receiver, self._slots, whole)

    def amplified(self, cube, whole=None):
        """With the errors of the receivers; whole: as in `turned`."""
        factors = self._receiver_factors()
        return cube if factors is None else self._turned(cube, factors, whole)

    def models_of(self, cube):
        """What `filtered` needs to know of the whole; None: nothing."""
        return models_of(cube) if has_filters(self._receiver) else None

    def filtered(self, cube, models):
        """After the filters; models: `models_of` the whole of which the cube is a part."""
        return cube if models is None else filtered(cube, self._radar.waveform, self._receiver, models)

    def unbalanced(self, cube):
        """With the imbalance of the branches."""
        return unbalanced(cube, self._radar.waveform, self._receiver)

    def sampled(self, cube):
        """At the instants of the converter's clock."""
        adc = self._receiver.adc
        return cube if adc is None else jittered(cube, self._radar.waveform, adc, self._slots.generator(self._seed, "jitter"))

    def _receiver_factors(self):
        return receiver_factors(self._receiver, self._radar, self._slots)

    def _turned(self, cube, factors, whole):
        return turned(cube, factors, self._radar.waveform, whole)


def _noise(cube, radar, seed: int, start_time: float):
    return _core.add_noise(cube, radar_of_noise(radar), seed=seed, start_time=start_time)


def transmitted_code(radar) -> np.ndarray:
    """The code of the frame with the errors of the transmitters, complex [tx, slots]."""
    code = code_of(radar)
    factors = transmitter_factors(radar.receiver, radar)
    return code if factors is None else code * factors[:, None]
