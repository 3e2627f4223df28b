"""Undoes the code of transmitters: from what receivers have to the signal of each transmitter."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import ArrayLike, checked, refused
from ..base.radar.chirps import chirp_period
from .code import code_of, hadamard, is_coded, num_frame_slots
from .doppler_division import undo_doppler_division

_LEAST_TAPERED = 16  # chirps, of which fewer are all near the ends of the frame


@checked()
def demultiplex(cube: ArrayLike, radar: _core.Radar) -> NDArray[np.complex128]:
    """The signal of each transmitter from what the receivers have of all of them.

    "tdm": the slots in a row become the chirps of their transmitters. "bpm": the sum of the slots of a chirp by their signs,
    each slot turned back to the time of the first by the velocity of its Doppler cell; exact for what stands still, and but for
    the ends of the frame for velocities within +-`max_velocity(num_slots)`. "ddm": each cell of range and velocity is one
    transmitter's, by the empty shares of the Doppler axis, so that velocities are known within +-`max_velocity()`; of two
    targets at one range whose velocities are a share apart the stronger one is right (see `transmit/doppler_division.py`), and
    a transmitter that is too weak to be heard is taken for an empty share, which gives an echo another velocity. With
    fewer than four chirps to a share transmitters do not come apart, and RuntimeWarning says so.
    "cdm": compressed by the conjugate code, which leaves what the codes correlate.
    Maps of "ddm" and "bpm" need windows that fall towards the ends, as "hann" does: the ends have more noise, with "rect" 2.8 dB
    in the mean of "ddm".
    cube: [1, rx, slots, sample] in sqrt(W) as `synthesize` and `receive` give it, or one that is apart already,
        [tx, rx, chirp, sample], which is returned as it is
    radar: that of the cube
    Returns [tx, rx, chirp, sample] in sqrt(W). Raises TypeError or ValueError naming the argument.
    """
    cube = np.asarray(cube, np.complex128)
    num_tx, num_rx, waveform = len(radar.transmitters), len(radar.receivers), radar.waveform
    apart = (num_tx, num_rx, waveform.num_chirps, waveform.num_samples)
    received = (1, num_rx, num_frame_slots(radar), waveform.num_samples)
    if cube.shape == apart and (num_tx > 1 or not is_coded(radar) or radar.num_slots > 1):
        return cube
    if cube.shape != received:
        raise refused(ValueError, "cube", f"of the shape {received}, or {apart} where it is apart already", cube)
    return _UNDO[radar.multiplexing](cube[0], radar)


def _undo_turns(signal, radar):
    """[rx, slots, S] -> [tx, rx, chirp, S]"""
    num_rx, _, num_samples = signal.shape
    by_slot = signal.reshape(num_rx, radar.waveform.num_chirps, len(radar.transmitters), num_samples)
    return np.ascontiguousarray(np.moveaxis(by_slot, 2, 0))


def _undo_signs(signal, radar):
    """Slots turned back to the first of their chirp make a circle of the frame, in which a step between its ends rings at the
    highest velocity. Away from the ends, signals are those of slots behind a taper without a step, which is taken out again."""
    num_rx, _, num_samples = signal.shape
    num_chirps = radar.waveform.num_chirps
    slots = signal.reshape(num_rx, num_chirps, radar.num_slots, num_samples)
    plain = _without_signs(slots, radar)
    if num_chirps < _LEAST_TAPERED:
        return plain
    chirps = np.arange(num_chirps)[:, None]
    taper = _hann(chirps / num_chirps)
    tapered = _without_signs(slots * _hann((chirps + _lateness(radar)) / num_chirps)[..., None], radar)
    # Where the taper is less than some 8 / num_chirps its removal would raise the noise.
    inner = (1.0 - (1.0 - taper) ** (num_chirps // 8)) ** 2
    return (1.0 - inner) * plain + np.divide(inner, taper, out=np.zeros_like(taper), where=taper > 0.0) * tapered


def _without_signs(slots, radar):
    """Slot i of a chirp is i / length of the chirp's interval late: e^{-j 2 pi f i} takes that out of cell f of the chirps.

    slots: [rx, chirp, slot, S] -> [tx, rx, chirp, S]
    """
    _, num_chirps, length, _ = slots.shape
    by_slot = np.fft.fft(slots, axis=1)
    by_slot *= np.exp(-2j * np.pi * np.fft.fftfreq(num_chirps)[:, None] * _lateness(radar))[:, :, None]
    signs = hadamard(length)[:len(radar.transmitters)] / length
    return np.fft.ifft(np.einsum("tl,rcls->trcs", signs, by_slot, optimize=True), axis=2)


def mixes_of_turns(radar) -> NDArray[np.complex128]:
    """What the place of each transmitter has of each one, [turns, place, tx], of echoes whose velocities are so many times the
    whole axis of the map beyond it: signs of "bpm" come apart as those of others then. Of other codes one turn of none."""
    num_tx, length = len(radar.transmitters), radar.num_slots
    if radar.multiplexing != "bpm" or num_tx == 1:
        return np.eye(num_tx, dtype=complex)[None]
    turns = np.arange(length) - length // 2
    signs = hadamard(length)[:num_tx]
    return np.einsum("al,bl,kl->kab", signs, signs, np.exp(2j * np.pi * np.outer(turns, _lateness(radar)))) / length


def _lateness(radar):
    """Of the slots [slot] of a chirp, in intervals of chirps."""
    return np.array([radar.waveform.slot_start(slot) for slot in range(radar.num_slots)]) / chirp_period(radar)


def _hann(place):
    return 0.5 - 0.5 * np.cos(2.0 * np.pi * place)


def _undo_phases(signal, radar):
    return np.conj(code_of(radar))[:, None, :, None] * signal


_UNDO = {"tdm": _undo_turns, "bpm": _undo_signs, "ddm": undo_doppler_division, "cdm": _undo_phases}
