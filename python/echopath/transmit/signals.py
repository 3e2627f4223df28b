"""Signals of radars whose transmitters send at once, or whose chirps differ from slot to slot."""
from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from .. import _core
from ..arguments.frame_times import require_frame
from .code import code_of, code_signal, is_coded, num_frame_slots, slots_radar

STEPS = "frequency_steps", "bandwidth_steps"


def has_steps(radar: _core.Radar) -> bool:
    """Whether slots differ in start frequency or bandwidth."""
    return bool(step_names(radar))


def step_names(radar: _core.Radar) -> list[str]:
    """Names of what of the waveform makes slots differ in start frequency or bandwidth."""
    return [name for name in STEPS if np.any(getattr(radar.waveform, name))]


def chirp_of(radar: _core.Radar, tx: int) -> _core.ChirpSequence | None:
    """The waveform of all chirps of a transmitter, without steps; None where these differ in start frequency or bandwidth."""
    kinds = [plain.waveform for plain, senders, _ in _kinds_of_chirp(radar) if tx in senders]
    return kinds[0] if len(kinds) == 1 else None


def synthesize_slots(paths: _core.Paths, radar: _core.Radar, **settings) -> np.ndarray:
    """The signal of each transmitter alone, [tx, rx, chirp, sample] in sqrt(W).

    settings: keywords of `_core.synthesize`. Slots that differ cost one synthesis for each kind of chirp. Memory: 16 bytes a
    sample, and as much again while chirps of several kinds are put together.
    """
    require_frame("radar", radar, paths.frame.start_time)
    if not has_steps(radar):
        return _core.synthesize(paths, radar, **settings)
    return by_kind_of_chirp(radar, lambda one: [{0: _core.synthesize(paths, one, **_without_probe(settings))}])[0][0]


def decompose_slots(paths: _core.Paths, radar: _core.Radar, groupings: list[_core.Grouping], **settings) -> list[dict]:
    """Likewise the signals of parts of the paths, {part: cube} of each grouping; settings: keywords of `_core.decompose`."""
    require_frame("radar", radar, paths.frame.start_time)
    if not has_steps(radar):
        return _core.decompose(paths, radar, groupings, **settings)
    return by_kind_of_chirp(radar, lambda one: _core.decompose(paths, one, groupings, **_without_probe(settings)))


def _without_probe(settings: dict) -> dict:
    return {name: value for name, value in settings.items() if name != "probe"}


def by_kind_of_chirp(radar: _core.Radar, cubes_of: Callable[[_core.Radar], list[dict]]) -> list[dict]:
    """Tables of cubes, of which each chirp is that of a radar all of whose chirps are of its kind."""
    made = []
    for plain, tx, chirp in _kinds_of_chirp(radar):
        cubes = cubes_of(plain)
        made = made or [{name: np.empty_like(cube) for name, cube in table.items()} for table in cubes]
        for whole, table in zip(made, cubes):
            for name, cube in table.items():
                whole[name][tx, :, chirp] = cube[tx, :, chirp]
    return made


def _kinds_of_chirp(radar: _core.Radar) -> Iterator[tuple]:
    """(radar without steps, indices of the transmitters and chirps that are of its kind) of each kind of chirp."""
    waveform, num_tx = radar.waveform, len(radar.transmitters)
    chirps = np.arange(waveform.num_chirps) * radar.num_slots
    slots = chirps + (0 if is_coded(radar) else np.arange(num_tx)[:, None]) + np.zeros((num_tx, 1), int)
    kinds = np.stack([repeated(getattr(waveform, steps), slots) for steps in STEPS], axis=-1)
    for kind in np.unique(kinds.reshape(-1, 2), axis=0):
        plain = waveform.replace(start_frequency=waveform.start_frequency + kind[0],
                                 bandwidth=waveform.bandwidth + kind[1], frequency_steps=(), bandwidth_steps=())
        yield (radar.replace(waveform=plain), *np.nonzero(np.all(kinds == kind, axis=-1)))


def repeated(steps, slots) -> np.ndarray:
    """The steps of slots, an array of their shape; 0 without steps."""
    return np.take(steps, slots % len(steps)) if len(steps) else np.zeros(slots.shape)


def coded_cube(paths: _core.Paths, radar: _core.Radar, separate: np.ndarray | None = None, *,
               code: np.ndarray | None = None, **settings) -> np.ndarray:
    """What the receivers have before `demultiplex`, [1, rx, slots, sample] in sqrt(W), without noise.

    separate: [tx, rx, chirp, sample] of `synthesize_slots`, which is made anew where it is None or has not every slot
    code: complex [tx, slots], None: `code_of` the radar; settings: keywords of `_core.synthesize`
    """
    code = code_of(radar) if code is None else code
    if separate is None or separate.shape[2] != num_frame_slots(radar):
        separate = synthesize_slots(paths, slots_radar(radar), **settings)
    return code_signal(separate, code, radar.waveform)
