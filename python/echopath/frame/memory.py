"""Whether the signal of a frame fits into the memory of this machine: one that does not would end other programs, too."""
from __future__ import annotations

import os

from .. import _core
from ..base.text.counts import counted

_BYTES = 16  # of a complex sample
_CUBES = 2   # in memory while the map is made: the signal and what the transform reads


def require_memory(radar: _core.Radar, zero_pad: int, has_noise: bool) -> None:
    """Raises ValueError where making the map of a frame takes more than the memory of this machine."""
    waveform, channels = radar.waveform, len(radar.transmitters) * len(radar.receivers)
    cubes = _CUBES + has_noise  # the signal stays beside that with noise
    needed = _BYTES * channels * waveform.num_chirps * (cubes * waveform.num_samples + _cells_of_a_chirp(waveform, zero_pad))
    there = machine_memory()
    if needed > there:
        size = (f"{counted(channels, 'channel')}, {counted(waveform.num_chirps, 'chirp')} and "
                f"{counted(waveform.num_samples, 'sample')}")
        raise ValueError(f"radar: must have a signal and a map that fit into the memory of this machine, {there / 1e9:,.0f} GB, "
                         f"got {needed / 1e9:,.0f} GB of {size}")


def _cells_of_a_chirp(waveform: _core.ChirpSequence, zero_pad: int) -> int:
    """Values for each chirp of a channel: those along range, from which the map is made, and the map itself."""
    padded = waveform.num_samples * zero_pad
    num_ranges = (padded + 1) // 2 if waveform.real else padded
    return num_ranges * (1 + zero_pad)


def machine_memory() -> float:
    """In bytes; infinite where the system does not tell."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return float("inf")
