"""How much longer this machine takes than the one that limits in seconds are stated for, by a program of others: FINUFFT.

Rented and shared machines differ by a factor of three, and one of them by a half from hour to hour. The transform is one of
those that `echopath bench speed` sets beside our synthesis, and its time on the reference machine is the one in
python/docs/measurements.md.
"""
from __future__ import annotations

import statistics

from .alone import alone
from .speed.synthesis import PATHS, Echoes, Finufft, finufft_version, tones

REFERENCE_MACHINE = "an AMD EPYC (Zen 5, AVX-512)"
REFERENCE_NS, TOLERANCE = 14.8, 1e-6  # of a point there, FINUFFT 2.5.1, its quickest settings, one thread
REPEATS = 16


def pace() -> float | None:
    """Processor time of one thread for the transform over that on the reference machine; None where FINUFFT is not installed.

    Measured in a process of its own: its memory is not that of what the benchmark measures.
    """
    return alone(measured_pace)


def measured_pace() -> float | None:
    """`pace`, measured in this process."""
    if finufft_version() is None:
        return None
    echoes = Echoes(PATHS, 1)
    points, strengths = tones(echoes.delays[0], echoes.amplitudes[0], echoes.waveform)
    transform = Finufft(points, strengths, echoes.waveform.num_samples, TOLERANCE)
    return 1e9 * statistics.median(transform.seconds() for _ in range(REPEATS)) / PATHS / REFERENCE_NS


def verdict(measured: float, limit: float, paces: list[float] | None = None) -> str:
    """Whether a figure keeps its limit: "holds", "MISSED", or "undecided" where paces disagree.

    paces: of a time, [least, most] of the machine when it was measured, over which it is held against the limit
    """
    least, most = _at_reference(measured, paces or [1.0, 1.0])
    return "holds" if most <= limit else "MISSED" if least > limit else "undecided"


def told_at_reference(seconds: float, paces: list[float] | None) -> str:
    """What a time would be on the reference machine, as an end of a line; "" where nobody knows."""
    return ", {:.3g} to {:.3g} at the reference's pace".format(*_at_reference(seconds, paces)) if paces else ""


def _at_reference(seconds: float, paces: list[float]) -> tuple[float, float]:
    return seconds / paces[1], seconds / paces[0]
