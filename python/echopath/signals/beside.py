"""What comes into the receivers beside the echoes of the scene's paths, each with a name of its own in labels and detections."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.part_names import INTERFERENCE, LEAKAGE, RAIN, RESIDUE
from ..base.numerics.analytic import as_samples
from ..receiver.channels import receiver_factors, transmitter_factors
from ..receiver.filters import response
from ..receiver.leakage import leakage
from ..receiver.slots import SlotTimes
from ..transmit import demultiplex, signal_shape
from ..transmit.doppler_division import undo_doppler_division
from ..transmit.signals import has_steps


def cubes_beside(frame) -> dict:
    """{name: [tx, rx, chirp, sample]} in sqrt(W) of what a frame has of it, each transmitter alone, without faults of the
    receiver, but that real samples of leakage have the phase in which it leaves the receivers' chains and filters; what codes
    leave has the errors of the transmitters."""
    leaked = _leaked(frame.radar, frame.paths.frame.start_time)
    received = {INTERFERENCE: frame.interference_cube, RAIN: frame.rain_cube, LEAKAGE: leaked}
    received = {name: cube for name, cube in received.items() if cube is not None}
    leaves_residue = _leaves_residue(frame)
    if not received and not leaves_residue:
        return {}
    apart = _as_the_whole(frame)
    cubes = {name: apart(cube) for name, cube in received.items()}
    if RAIN in cubes and frame.coded_cube is not None:  # which was added up behind the transmitters, as echoes are
        cubes[RAIN] = cubes[RAIN] / _transmitter_factors(frame.radar)
    return cubes | ({RESIDUE: apart(frame.coded_cube) - _own(frame)} if leaves_residue else {})


def leakage_map(radar, window, zero_pad: int):
    """Range-Doppler map of what the transmitters leak into the receivers alone, in a frame that starts at 0 s; None: nothing. It
    is the same in all frames of a radar, but for real samples behind chains whose phases drift.

    window, zero_pad: as of `range_doppler`
    """
    leaked = _leaked(radar)
    return None if leaked is None else _core.range_doppler(demultiplex(leaked, radar), radar, window, zero_pad)


def _leaves_residue(frame) -> bool:
    """Whether echoes of other transmitters are left in the signal of each. "bpm" and "ddm" leave next to nothing where all chirps
    are alike."""
    radar = frame.radar
    leaves = radar.multiplexing == "cdm" or has_steps(radar)
    return leaves and len(radar.transmitters) > 1 and frame.coded_cube is not None


def _as_the_whole(frame):
    """Function that takes a cube of the frame apart as `demultiplex` does all that the receivers have. With "ddm" it depends on
    all that is there which transmitter a cell is given to."""
    radar = frame.radar
    if radar.multiplexing != "ddm" or frame.coded_cube is None:
        return lambda cube: demultiplex(cube, radar)
    whole = frame.received.cube[0]
    return lambda cube: undo_doppler_division(cube[0], radar, whole)


def _own(frame):
    """The echoes of each transmitter behind its errors, [tx, rx, chirp, sample]."""
    return _transmitter_factors(frame.radar) * frame.cube


def _transmitter_factors(radar):
    """Of the errors of the transmitters, as a cube [tx, rx, chirp, sample] takes them; 1: none."""
    factors = transmitter_factors(radar.receiver, radar)
    return 1.0 if factors is None else factors[:, None, None, None]


def _leaked(radar, start_time: float = 0.0):
    if radar.receiver is None:
        return None
    slots, real = SlotTimes(radar, start_time), radar.waveform.real
    leaked = leakage(radar, radar.receiver, slots)
    if leaked is None:
        return None
    if real:
        leaked = leaked * _turn_of_leakage(radar, slots)
    return np.array(np.broadcast_to(as_samples(leaked, real), signal_shape(radar)))


def _turn_of_leakage(radar, slots):
    """What the receivers' chains and the filters turn leakage by, of size 1, as a cube takes it: [T, rx, C, 1]. Real samples of
    less than a period have another level for each phase: in the first cells by 15 dB and more."""
    behind = response(radar.receiver, slots.slope[:, None, :, None] * radar.receiver.leakage_delay)
    factors = receiver_factors(radar.receiver, radar, slots)
    return np.exp(1j * np.angle(behind if factors is None else behind * factors))
