"""Radars of tests: what a test does not name is as here."""
from __future__ import annotations

import numpy as np

import echopath as ep

FREQUENCY = 77e9  # Hz
WAVEFORM = {"start_frequency": FREQUENCY, "bandwidth": 1e9, "num_samples": 64, "sampling_rate": 20e6, "num_chirps": 1,
            "chirp_interval": 60e-6, "real": False, "extra_idle": (), "frequency_steps": (), "bandwidth_steps": ()}


def build_radar(transmitters=((0, 0, 0),), receivers=((0, 0, 0),), **settings) -> ep.Radar:
    """A radar of isotropic antennas at positions [3] in m, or of the antennas given.

    settings: of ep.ChirpSequence, instead of those of WAVEFORM, and of ep.Radar
    """
    waveform = ep.ChirpSequence(**{name: settings.pop(name, value) for name, value in WAVEFORM.items()})
    return ep.Radar(waveform, transmitters=list(map(_antenna, transmitters)), receivers=list(map(_antenna, receivers)),
                    **settings)


def with_waveform(radar, **changes):
    """The radar with other values of its waveform."""
    return radar.replace(waveform=radar.waveform.replace(**changes))


def chirp_times(radar):
    """[chirps] in s: the middle of each chirp of a single transmitter, from the start of the frame."""
    waveform = radar.waveform
    middle = 0.5 * (waveform.num_samples - 1) / waveform.sampling_rate
    return np.arange(waveform.num_chirps) * waveform.chirp_interval + middle


def _antenna(place) -> ep.Antenna:
    return place if isinstance(place, ep.Antenna) else ep.Antenna(place)
