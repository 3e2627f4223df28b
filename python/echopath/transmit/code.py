"""What each transmitter sends in each slot."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.numerics.analytic import as_samples, continued


def is_coded(radar: _core.Radar) -> bool:
    """Whether the transmitters send at once, by a code."""
    return radar.multiplexing != "tdm"


def num_frame_slots(radar: _core.Radar) -> int:
    """Chirps that the radar sends in a frame, of all transmitters."""
    return radar.num_slots * radar.waveform.num_chirps


def signal_shape(radar: _core.Radar) -> tuple[int, int, int, int]:
    """Of what arrives in a frame: [tx, rx, chirp, sample], or [1, rx, slots, sample] of transmitters that send at once."""
    transmitters, chirps = ((1, num_frame_slots(radar)) if is_coded(radar) else
                            (len(radar.transmitters), radar.waveform.num_chirps))
    return transmitters, len(radar.receivers), chirps, radar.waveform.num_samples


def num_shares(radar: _core.Radar) -> int:
    """Of "ddm": into how many shares the Doppler axis falls, with those that are empty; they divide the chirps of the frame."""
    return len(radar.transmitters) + radar.empty_slots


def hadamard(size: int) -> np.ndarray:
    """Sylvester's matrix of +-1 [size, size], size a power of 2: rows are orthogonal."""
    place = np.arange(size)
    common = place[:, None] & place
    odd = np.array([bin(value).count("1") & 1 for value in common.ravel()]).reshape(size, size)
    return 1.0 - 2.0 * odd


def code_of(radar: _core.Radar) -> np.ndarray:
    """The code of a frame: complex [tx, slots], 0 where a transmitter is silent."""
    num_tx, slots = len(radar.transmitters), np.arange(num_frame_slots(radar))
    if radar.multiplexing == "tdm":
        return (slots % num_tx == np.arange(num_tx)[:, None]).astype(np.complex128)
    if radar.multiplexing == "bpm":
        return hadamard(radar.num_slots)[:num_tx, slots % radar.num_slots].astype(np.complex128)
    if radar.multiplexing == "ddm":
        shares = num_shares(radar)
        turns = np.arange(num_tx)[:, None] * slots % shares / shares
        return np.exp(2j * np.pi * turns)
    phases = radar.code_phases
    return np.exp(1j * phases[:, slots % phases.shape[1]])


def slots_radar(radar: _core.Radar) -> _core.Radar:
    """The radar whose signals are those of each transmitter in every slot of the frame, [tx, rx, slots, sample]."""
    waveform = radar.waveform.replace(num_chirps=num_frame_slots(radar))
    return radar.replace(waveform=waveform, multiplexing="cdm", code_phases=np.zeros((len(radar.transmitters), 1)))


def code_signal(separate: np.ndarray, code: np.ndarray, waveform, whole: np.ndarray | None = None) -> np.ndarray:
    """What the receivers have of transmitters that send at once.

    separate: [tx, rx, slots, sample] in sqrt(W), each transmitter alone; code: complex [tx, slots]; waveform: of the
        samples; phases of the code turn real ones as `turned` says; whole: of which `separate` is a part, None: itself
    Returns [1, rx, slots, sample] in sqrt(W).
    """
    turns = waveform.real and np.any(code.imag)
    sent = _summed(continued(separate, waveform, whole) if turns else separate, code)[None]
    return as_samples(sent, waveform.real) if turns else sent


def _summed(separate: np.ndarray, code: np.ndarray) -> np.ndarray:
    """Adds up all transmitters, each times its code: [rx, slots, sample]. One at a time needs no copy of all of them."""
    sent = np.zeros(separate.shape[1:], np.complex128)
    turned = np.empty_like(sent)
    for alone, phases in zip(separate, code):
        sent += np.multiply(alone, phases[:, None], out=turned)
    return sent
