"""Frames that no memory holds are refused before the work."""
from __future__ import annotations

import subprocess
import sys

import pytest

import echopath as ep
from echopath.frame import memory

CHIRPS = {"start_frequency": 77e9, "bandwidth": 1e9, "sampling_rate": 1e9, "chirp_interval": 1e-3}


def radar_of(num_samples: int, num_chirps: int, num_receivers: int = 1) -> ep.Radar:
    return ep.Radar(ep.ChirpSequence(**CHIRPS, num_samples=num_samples, num_chirps=num_chirps), transmitters=[ep.Antenna()],
                    receivers=[ep.Antenna((0.0, 0.002 * index, 0.0)) for index in range(num_receivers)])


def test_a_frame_beyond_the_memory_is_refused_with_its_size():
    """16 bytes a sample, for the signal, that with noise, what the transform reads, what it has along range, and the map:
    5 x 16 x 2 x 1e6 x 1e6 bytes."""
    scene = ep.Scene()
    with pytest.raises(ValueError, match="^radar: must have a signal and a map that fit into the memory of this machine, .* got "
                                         "160,000 GB of 2 channels, 1,000,000 chirps and 1,000,000 samples$"):
        ep.simulate(scene, radar_of(1_000_000, 1_000_000, 2))


@pytest.mark.parametrize("zero_pad, fits", [(1, True), (2, False)])
def test_what_just_fits_is_taken(monkeypatch, zero_pad, fits):
    """A map of twice the cells along both axes has four times the cells."""
    monkeypatch.setattr(memory, "machine_memory", lambda: 16 * 64 * 8 * 5)
    if fits:
        memory.require_memory(radar_of(64, 8), zero_pad, True)
    else:
        with pytest.raises(ValueError, match="got 0 GB of 1 channel, 8 chirps and 64 samples$"):
            memory.require_memory(radar_of(64, 8), zero_pad, True)


MEASURED = """
import sys
import echopath as ep
from echopath.frame import memory
zero_pad, real, noise = int(sys.argv[1]), sys.argv[2] == "real", 1 if sys.argv[3] == "noise" else None
def radar_of(num_chirps):
    return ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, sampling_rate=1e9, chirp_interval=1e-4, real=real,
                                     num_samples=2048, num_chirps=num_chirps),
                    transmitters=[ep.Antenna()], receivers=[ep.Antenna(), ep.Antenna((0.0, 0.002, 0.0))])
scene = ep.Scene()
scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(10.0, 0.0, 0.0))
def most_memory(num_chirps):
    return max(stage.peak_memory for stage in ep.simulate(scene, radar_of(num_chirps), num_rays=500, zero_pad=zero_pad,
                                                           noise_seed=noise).stages)
before, most = most_memory(1), most_memory(256)
for share in (0.95, 1.05):
    memory.machine_memory = lambda: share * (most - before)
    try:
        memory.require_memory(radar_of(256), zero_pad, noise is not None)
        print("taken")
    except ValueError:
        print("refused")
"""


@pytest.mark.parametrize("zero_pad, real, noise", [(1, "complex", "none"), (2, "complex", "noise"), (3, "real", "noise")])
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells the peak memory of a stage")
def test_a_frame_is_refused_where_it_takes_more_memory_than_there_is(zero_pad, real, noise):
    """Of what it was seen to take in a process of its own, by the system's count: with a twentieth less there is not enough,
    with a twentieth more there is. Of what does not move: it takes the least."""
    told = subprocess.run([sys.executable, "-c", MEASURED, str(zero_pad), real, noise], capture_output=True, text=True,
                          check=True)
    assert told.stdout.split() == ["refused", "taken"]
