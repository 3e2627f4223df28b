"""Power and phase of the transmitters by the profiles of a mmWave configuration."""
from __future__ import annotations

import math

from .cfg import Command
from .slots import SlotTable, TransmitCode

PHASE_STEP = math.tau / 64  # rad, of the six bits of a phase shifter


def chain_settings(slots: SlotTable, code: TransmitCode) -> dict:
    """Keywords of Receiver for transmitters in the order of the code: back-off in dB, a byte for each, and phase, the upper six
    bits of a byte for each, of the profile of the first chirp in which it sends. {} where both are 0."""
    back_off, phase = [], []
    for transmitter in code.order:
        profile = slots.profile_of(transmitter)
        back_off.append(float(_byte(profile, "power_backoff", transmitter)))
        phase.append(_byte(profile, "phase_shifter", transmitter) // 4 * PHASE_STEP)
    gain = {"transmitter_gain_db": [-one for one in back_off]} if any(back_off) else {}
    return gain | ({"transmitter_phase": phase} if any(phase) else {})


def _byte(profile: Command, name: str, transmitter: int) -> int:
    """That of a transmitter, one of three on its chip."""
    if profile[name] < 0:
        raise profile.error(f"{name}: must not be negative, got {profile[name]}")
    return profile[name] >> 8 * (transmitter % 3) & 0xFF
