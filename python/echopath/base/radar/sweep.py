"""What the chirps of a radar sweep, in words."""
from __future__ import annotations


def sweep_text(waveform) -> str:
    """Where chirps begin, and by how much they rise or fall: "77 GHz + 1 GHz"."""
    return f"{1e-9 * waveform.start_frequency:.6g} GHz {'-' if waveform.falls else '+'} {1e-9 * abs(waveform.bandwidth):.6g} GHz"
