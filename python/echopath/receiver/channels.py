"""Errors of channels: of their chains, their drift, and what couples from one receiver into another."""
from __future__ import annotations

import numpy as np

from ..arguments.checks import refused
from ..base.numerics.analytic import turned
from .settings import LARGEST_DB, Receiver


def require_channels(receiver: Receiver | None, radar) -> None:
    """Raises ValueError naming the table that is not of the radar's antennas; an ideal receiver, None, has none."""
    if receiver is None:
        return
    num_tx, num_rx = len(radar.transmitters), len(radar.receivers)
    sizes = {"transmitter_gain_db": (num_tx,), "transmitter_phase": (num_tx,), "receiver_gain_db": (num_rx,),
             "receiver_phase": (num_rx,), "gain_drift_db": (num_rx,), "phase_drift": (num_rx,),
             "leakage_db": (num_tx, num_rx), "coupling_db": (num_rx, num_rx)}
    for name, size in sizes.items():
        value = getattr(receiver, name)
        if value and np.shape(value) != size:
            raise refused(ValueError, f"receiver.{name}", f"of the shape {size} for this radar", np.array(value))


def require_drift(receiver: Receiver | None, begin: float, end: float) -> None:
    """Raises ValueError for gains that drift, from time 0 on, to where nothing is left of a signal, or no number tells it.

    receiver: None: ideal; begin, end: s, of what is received
    """
    time = max(abs(begin), abs(end))
    if receiver is not None and max(map(abs, receiver.gain_drift_db), default=0.0) * time > LARGEST_DB:
        rate = LARGEST_DB / time
        raise refused(ValueError, "receiver.gain_drift_db", f"from {-rate:.4g} to {rate:.4g} dB/s, by which gains "
                      f"drift by {LARGEST_DB:g} dB from time 0 to {time:.6g} s", receiver.gain_drift_db)


def transmitter_factors(receiver: Receiver | None, radar) -> np.ndarray | None:
    """What the transmitters' chains multiply their signals by, complex [tx], with the phase that samples have of it; None:
    nothing."""
    require_channels(receiver, radar)
    return None if receiver is None else _factors(receiver.transmitter_gain_db, receiver.transmitter_phase,
                                                  len(radar.transmitters))


def receiver_factors(receiver: Receiver, radar, slots) -> np.ndarray | None:
    """Likewise of the receivers' chains, complex, as a cube takes it: [T, rx, C, 1]; None: nothing."""
    num_rx = len(radar.receivers)
    fixed = _factors(receiver.receiver_gain_db, receiver.receiver_phase, num_rx)
    if not receiver.gain_drift_db and not receiver.phase_drift:
        return None if fixed is None else fixed[None, :, None, None]
    time = (slots.start_time + slots.begin)[:, None, :]
    require_drift(receiver, time.min(), time.max())
    rate = _log_factors(receiver.gain_drift_db, receiver.phase_drift, num_rx)[:, None]
    return np.exp(time * rate)[..., None] * (1.0 if fixed is None else fixed[:, None, None])


def _log_factors(gain_db, phase, count: int) -> np.ndarray:
    gain = np.array(gain_db) if gain_db else np.zeros(count)
    turn = np.array(phase) if phase else np.zeros(count)
    return gain * np.log(10.0) / 20.0 + 1j * turn


def _factors(gain_db, phase, count: int) -> np.ndarray | None:
    return np.exp(_log_factors(gain_db, phase, count)) if gain_db or phase else None


def coupled(cube: np.ndarray, radar, receiver: Receiver, slots, whole: np.ndarray | None = None) -> np.ndarray:
    """What each receiver has with what couples in from the others: later by the delay, so that every echo turns by
    2 pi (f0 + slope t) delay. slots: SlotTimes; whole: as in `turned`"""
    if not receiver.coupling_db:
        return cube
    others, of_whole = (None if one is None else _of_others(one, receiver) for one in (cube, whole))
    return cube + turned(others, _late(radar, receiver, slots), radar.waveform, of_whole)


def coupled_leakage(leaked: np.ndarray, radar, receiver: Receiver, slots) -> np.ndarray:
    """Likewise of leakage, which is complex even where samples are real."""
    if not receiver.coupling_db:
        return leaked
    return leaked + _of_others(leaked, receiver) * _late(radar, receiver, slots)


def _of_others(cube, receiver: Receiver):
    """The sum of what couples into each receiver, without its delay."""
    share = 10.0 ** (np.array(receiver.coupling_db) / 20.0)
    np.fill_diagonal(share, 0.0)
    return np.einsum("ab,tacs->tbcs", share, cube, optimize=True)


def _late(radar, receiver: Receiver, slots):
    """What the delay of the coupling turns each sample by, as a cube takes it."""
    waveform = radar.waveform
    time = np.arange(waveform.num_samples) / waveform.sampling_rate
    frequency = slots.start_frequency[..., None] + slots.slope[..., None] * time
    return np.exp(2j * np.pi * frequency * receiver.coupling_delay)[:, None]
