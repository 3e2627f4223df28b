"""What a receiver makes of each part of a signal, so that the parts add up to what it gives."""
from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .. import _core
from ..arguments.checks import COMMON, ArrayLike, anything, checked, optional, real, refused, seed as seed_rule, text
from ..arguments.part_names import CONVERTER, INTERFERENCE, LEAKAGE, NOISE, OF_RECEIVER, OFFSET, require_free
from ..base.numerics.analytic import as_samples
from ..transmit import radar_of_noise, signal_shape
from .chain import Chain, apart_from
from .channels import require_channels
from .converter import converted
from .imbalance import compressed, compression, with_offset
from .settings import Receiver

_CUBE = COMMON["cube"]


@checked(parts=anything, seed=optional(seed_rule), start_time=real(unit="s"), interference=optional(_CUBE))
def receive_parts(parts: Mapping[str, ArrayLike], radar: _core.Radar, *, seed: int | None, start_time: float = 0.0,
                  interference: ArrayLike | None = None) -> dict[str, np.ndarray]:
    """The parts of what `receive` gives of a signal, which add up to it.

    Linear faults act on each part alike, and so does the gain of the amplifiers, which each sample of the whole sets. What no
    part of the signal makes stands beside them, where there is some of it: "interference", "leakage" (of the transmitters),
    "noise" (thermal), "offset" (of the branches) and "converter" (rounding and saturation).
    parts: {name: cube} of `decompose`, each as `receive` takes it, in sqrt(W)
    radar, seed, start_time (s), interference: as in `receive`
    Returns {name: cube} complex128 of the same shapes, none of which is one of those given. Raises TypeError or ValueError
    naming the argument, also for parts of one of those names.
    """
    shape = signal_shape(radar)
    cubes = {name: _checked_cube(f"parts.{text('parts', name)}", cube, shape) for name, cube in _checked_table(parts).items()}
    other = None if interference is None else _checked_cube("interference", interference, shape)
    receiver = Receiver() if radar.receiver is None else radar.receiver
    require_channels(receiver, radar)
    found = _before_the_converter(cubes, radar, receiver, seed, start_time, other)
    found = {name: apart_from([*cubes.values(), other], cube) for name, cube in found.items()}
    if receiver.adc is not None:
        before = sum(found.values())
        found[CONVERTER] = converted(before, radar.waveform, receiver.adc)[0] - before
    return found


def _before_the_converter(cubes, radar, receiver: Receiver, seed, start_time: float, interference) -> dict:
    chain, shape = Chain(radar, receiver, seed, start_time), signal_shape(radar)
    found = {name: chain.mixed(cube) for name, cube in _through(chain.sent, cubes, radar).items()}
    if interference is not None:
        found[INTERFERENCE] = chain.mixed_alone(interference)
    found = _through(chain.amplified, _through(chain.coupled, found, radar), radar)
    if (leaked := chain.leaked()) is not None:
        found[LEAKAGE] = np.array(np.broadcast_to(as_samples(leaked, radar.waveform.real), shape))
    if seed is not None:
        found[NOISE] = _core.add_noise(np.zeros(shape, np.complex128), radar_of_noise(radar), seed=seed, start_time=start_time)
    gain = compression(sum(found.values()), radar, receiver, leaked)
    found = {name: cube if gain is None else compressed(cube, gain, radar) for name, cube in found.items()}
    models = chain.models_of(sum(found.values()))
    found = {name: chain.unbalanced(chain.filtered(cube, models)) for name, cube in found.items()}
    if receiver.dc_offset != (0.0, 0.0):
        found[OFFSET] = with_offset(np.zeros(shape, np.complex128), radar.waveform, receiver)
    return {name: chain.sampled(cube) for name, cube in found.items()}


def _through(stage, parts: dict, radar) -> dict:
    """Parts behind a stage that is linear, of real samples where it knows the whole of them (`base.numerics.analytic.turned`)."""
    whole = sum(parts.values()) if radar.waveform.real else None
    return {name: stage(cube, whole) for name, cube in parts.items()}


def _checked_table(parts) -> Mapping:
    if not isinstance(parts, Mapping) or not parts:
        raise refused(TypeError, "parts", "a dict of cubes by name, one at least", parts)
    require_free((text("parts", name) for name in parts), OF_RECEIVER)
    return parts


def _checked_cube(argument: str, cube, shape: tuple) -> np.ndarray:
    cube = _CUBE(argument, cube).astype(np.complex128, copy=False)
    if cube.shape != shape:
        raise refused(ValueError, argument, f"of the shape {shape}", cube)
    return cube
