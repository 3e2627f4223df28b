"""What comes into the receivers beside the echoes of the scene's paths, each with a name of its own in labels and detections."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.part_names import INTERFERENCE, LEAKAGE, RAIN, RESIDUE
from ..receiver.channels import transmitter_factors
from ..receiver.leakage import leakage
from ..receiver.slots import SlotTimes
from ..transmit import demultiplex, signal_shape
from ..transmit.doppler_division import undo_doppler_division
from ..transmit.signals import has_steps


def cubes_beside(frame) -> dict:
    """{name: [tx, rx, chirp, sample]} in sqrt(W) of what a frame has of it, each transmitter alone, without faults of the
    receiver; what codes leave has the errors of the transmitters."""
    received = {INTERFERENCE: frame.interference_cube, RAIN: frame.rain_cube, LEAKAGE: _leaked(frame.radar)}
    apart = {name: demultiplex(cube, frame.radar) for name, cube in received.items() if cube is not None}
    return apart | ({RESIDUE: _residue(frame)} if _leaves_residue(frame) else {})


def leakage_map(radar, window, zero_pad: int):
    """Range-Doppler map of what the transmitters leak into the receivers alone, the same in all frames of a radar; None: nothing.

    window, zero_pad: as of `range_doppler`
    """
    leaked = _leaked(radar)
    return None if leaked is None else _core.range_doppler(demultiplex(leaked, radar), radar, window, zero_pad)


def _leaves_residue(frame) -> bool:
    """Whether echoes of other transmitters are left in the signal of each. The signs of "bpm" leave next to nothing, and so does
    "ddm" where all its chirps are alike."""
    radar = frame.radar
    leaves = radar.multiplexing == "cdm" or (radar.multiplexing == "ddm" and has_steps(radar))
    return leaves and len(radar.transmitters) > 1 and frame.coded_cube is not None


def _residue(frame):
    """What `demultiplex` leaves in the signal of each transmitter of the echoes of the others, [tx, rx, chirp, sample]."""
    factors = None if frame.radar.receiver is None else transmitter_factors(frame.radar.receiver, frame.radar)
    own = frame.cube if factors is None else factors[:, None, None, None] * frame.cube
    if frame.radar.multiplexing == "ddm":  # which transmitter a cell is given to depends on all that is there
        return undo_doppler_division(frame.coded_cube[0], frame.radar, frame.received.cube[0]) - own
    return demultiplex(frame.coded_cube, frame.radar) - own


def _leaked(radar):
    leaked = None if radar.receiver is None else leakage(radar, radar.receiver, SlotTimes(radar, 0.0))
    return None if leaked is None else np.array(np.broadcast_to(leaked, signal_shape(radar)))
