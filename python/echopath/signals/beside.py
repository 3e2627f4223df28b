"""What comes into the receivers beside the echoes of the scene's paths, each with a name of its own in labels and detections."""
from __future__ import annotations

import numpy as np

from ..arguments.part_names import INTERFERENCE, LEAKAGE, RAIN
from ..receiver.leakage import leakage_amplitudes, leaked_tone
from ..receiver.slots import SlotTimes
from ..transmit import demultiplex, signal_shape


def cubes_beside(frame) -> dict:
    """{name: [tx, rx, chirp, sample]} in sqrt(W) of what a frame has of it, each transmitter alone, without faults of the
    receiver."""
    received = {INTERFERENCE: frame.interference_cube, RAIN: frame.rain_cube, LEAKAGE: _leaked(frame.radar)}
    return {name: demultiplex(cube, frame.radar) for name, cube in received.items() if cube is not None}


def _leaked(radar):
    if radar.receiver is None:
        return None
    amplitudes = leakage_amplitudes(radar, radar.receiver)
    if amplitudes is None:
        return None
    waveform = radar.waveform
    time = np.arange(waveform.num_samples) / waveform.sampling_rate
    tone = leaked_tone(SlotTimes(radar, 0.0), radar.receiver.leakage_delay, time)[:, None]
    cube = np.broadcast_to(amplitudes * tone, signal_shape(radar))
    return np.sqrt(2.0) * cube.real + 0j if waveform.real else np.array(cube)
