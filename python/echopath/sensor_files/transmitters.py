"""Power and phase of the transmitters by the profiles of a mmWave configuration."""
from __future__ import annotations

import math

from .cfg import Command
from .slots import SlotTable, TransmitCode

PHASE_STEP = math.tau / 64  # rad, of the six bits of a phase shifter


def chain_settings(slots: SlotTable, code: TransmitCode) -> dict:
    """Keywords of Receiver for transmitters in the order of the code: back-off in dB, a byte for each, and phase, the upper six
    bits of a byte for each. {} where both are 0. Raises ep.FileError naming the line where those of one change from chirp to
    chirp."""
    back_off, phase = [], []
    for transmitter in code.order:
        profiles = slots.profiles_of(transmitter)
        back_off.append(float(_steady(profiles, "power_backoff", transmitter)))
        phase.append(_steady(profiles, "phase_shifter", transmitter, step=4) * PHASE_STEP)
    gain = {"transmitter_gain_db": [-one for one in back_off]} if any(back_off) else {}
    return gain | ({"transmitter_phase": phase} if any(phase) else {})


def _steady(profiles: list[Command], name: str, transmitter: int, step: int = 1) -> int:
    """What a transmitter's byte counts in steps, the same in all of its profiles."""
    first, *others = profiles
    value = _byte(first, name, transmitter) // step
    for other in others:
        if (found := _byte(other, name, transmitter)) // step != value:
            raise other.error(f"{name}: must be that of line {first.line} for transmitter {transmitter + 1}, "
                              f"{_byte(first, name, transmitter)}, as it must not change from chirp to chirp, got {found}")
    return value


def _byte(profile: Command, name: str, transmitter: int) -> int:
    """That of a transmitter, one of three on its chip."""
    if profile[name] < 0:
        raise profile.error(f"{name}: must not be negative, got {profile[name]}")
    return profile[name] >> 8 * (transmitter % 3) & 0xFF
