"""Frames that no memory holds are refused before the work."""
from __future__ import annotations

import pytest

import echopath as ep
from echopath.frame import memory

CHIRPS = {"start_frequency": 77e9, "bandwidth": 1e9, "sampling_rate": 1e9, "chirp_interval": 1e-3}


def radar_of(num_samples: int, num_chirps: int, num_receivers: int = 1) -> ep.Radar:
    return ep.Radar(ep.ChirpSequence(**CHIRPS, num_samples=num_samples, num_chirps=num_chirps), transmitters=[ep.Antenna()],
                    receivers=[ep.Antenna((0.0, 0.002 * index, 0.0)) for index in range(num_receivers)])


def test_a_frame_beyond_the_memory_is_refused_with_its_size():
    """16 bytes a sample, for the signal and for its map: 2 x 16 x 2 x 1e6 x 1e6 bytes."""
    scene = ep.Scene()
    with pytest.raises(ValueError, match="^radar: must have a signal and a map that fit into the memory of this machine, .* got "
                                         "64,000 GB of 2 channels, 1,000,000 chirps and 1,000,000 samples$"):
        ep.simulate(scene, radar_of(1_000_000, 1_000_000, 2))


@pytest.mark.parametrize("zero_pad, fits", [(1, True), (2, False)])
def test_what_just_fits_is_taken(monkeypatch, zero_pad, fits):
    """A map of twice the cells along both axes has four times the cells."""
    monkeypatch.setattr(memory, "machine_memory", lambda: 16 * 64 * 8 * 4)
    if fits:
        memory.require_memory(radar_of(64, 8), zero_pad)
    else:
        with pytest.raises(ValueError, match="got 0 GB of 1 channel, 8 chirps and 64 samples$"):
            memory.require_memory(radar_of(64, 8), zero_pad)
