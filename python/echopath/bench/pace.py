"""How long this machine takes, over the one that limits in seconds are stated for, by a program of others: FINUFFT.

Machines that are lent differ by a factor of three, and by a half from hour to hour. A limit in seconds means little there, but
seconds over those of a fixed transform in the same run do.
"""
from __future__ import annotations

import statistics

import numpy as np

from .speed.synthesis import Finufft, finufft_version

REFERENCE = "two cores of an AMD Zen 5"
REFERENCE_NS = {1e-6: 16.4, 1e-9: 22.7, 1e-12: 28.6}  # a point there, one thread, double precision, by tolerance
POINTS, SAMPLES = 102_400, 512
REPEATS = 9


def pace_of_machine() -> float | None:
    """Time of a type-1 transform of POINTS at random to SAMPLES over that of the reference; None without FINUFFT.

    The least over the tolerances, of medians of processor time of one thread: a machine is never taken for slower than one of
    them says. FINUFFT has its quickest settings; the reference had those that it takes by itself.
    """
    if finufft_version() is None:
        return None
    draw = np.random.default_rng(1)
    points = draw.uniform(-np.pi, np.pi, POINTS)
    strengths = draw.standard_normal(POINTS) + 1j * draw.standard_normal(POINTS)
    return min(_ns(Finufft(points, strengths, SAMPLES, tolerance)) / reference for tolerance, reference in REFERENCE_NS.items())


def _ns(transform: Finufft) -> float:
    return 1e9 * statistics.median(transform.seconds() for _ in range(REPEATS)) / POINTS
