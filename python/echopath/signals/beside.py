"""What comes into the receivers beside the echoes of the scene's paths, each with a name of its own in labels and detections."""
from __future__ import annotations

import numpy as np

from ..arguments.part_names import INTERFERENCE, LEAKAGE, RAIN
from ..receiver.leakage import leakage
from ..receiver.slots import SlotTimes
from ..transmit import demultiplex, signal_shape


def cubes_beside(frame) -> dict:
    """{name: [tx, rx, chirp, sample]} in sqrt(W) of what a frame has of it, each transmitter alone, without faults of the
    receiver."""
    received = {INTERFERENCE: frame.interference_cube, RAIN: frame.rain_cube, LEAKAGE: _leaked(frame.radar)}
    return {name: demultiplex(cube, frame.radar) for name, cube in received.items() if cube is not None}


def _leaked(radar):
    leaked = None if radar.receiver is None else leakage(radar, radar.receiver, SlotTimes(radar, 0.0))
    return None if leaked is None else np.array(np.broadcast_to(leaked, signal_shape(radar)))
