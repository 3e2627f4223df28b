"""Curves of the core that follow a function of time to a tolerance.

Keys stand where the function is not smooth and, between these, at whole multiples of powers of two of a second, closer where
the cubic through values and rates of two keys errs by more than the tolerance. Different objects of a scene thus share
their keys, at which replay cuts a frame.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .. import _core

LONGEST = 1.0          # s between keys
SHORTEST = 2.0**-14    # s: a function that asks for more is not smooth
CHECKS = np.array([0.23, 0.5, 0.77])   # of the way between keys, where the cubic is held against the function
MOST_KEYS = 2_000_000

Function = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def curve_through(function: Function, junctions, tolerance: float) -> _core.Curve:
    """A Hermite Curve that errs by less than `tolerance` in any column.

    function: times [N] in s -> (values [N, C], rates [N, C] per s); junctions: times in s, at least the first and the last, at
    which it need not be smooth
    """
    begins, ends = _intervals(np.unique(np.asarray(junctions, float)))
    done: list[np.ndarray] = []
    while len(begins):
        is_good = _errors(function, begins, ends) < tolerance
        is_good |= ends - begins < SHORTEST
        done.append(np.stack([begins[is_good], ends[is_good]]))
        begins, ends = begins[~is_good], ends[~is_good]
        cuts = _cuts(begins, ends)
        begins, ends = np.concatenate([begins, cuts]), np.concatenate([cuts, ends])
        if len(begins) > MOST_KEYS:
            raise ValueError(f"trajectory: must be followed by at most {MOST_KEYS} keys; it is too long or too wild")
    begins, ends = np.concatenate(done, axis=1)
    order = np.argsort(begins)
    return _curve(function, begins[order], ends[order])


def _intervals(junctions):
    if len(junctions) == 1:
        return np.zeros(0), np.zeros(0)
    begin, end = junctions[0], junctions[-1]
    grid = np.arange(np.ceil(begin / LONGEST), np.ceil(end / LONGEST)) * LONGEST
    knots = np.unique(np.concatenate([junctions, grid]))
    apart = np.concatenate([[True], np.diff(knots) > 1e-9])      # of two that are one, the earlier
    apart[-1] = True
    knots = knots[apart]
    return knots[:-1], knots[1:]


def _cuts(begins, ends):
    """A multiple of a power of two within each interval."""
    steps = 2.0 ** np.floor(np.log2(0.75 * (ends - begins)))
    return (np.floor(begins / steps) + 1.0) * steps


def _errors(function: Function, begins, ends):
    values, leaving, arriving = _ends(function, begins, ends)
    span = (ends - begins)[:, None]
    worst = np.zeros(len(begins))
    for s in CHECKS:
        cubic = ((1 + 2 * s) * (1 - s) ** 2 * values[0] + s * (1 - s) ** 2 * span * leaving
                 + s**2 * (3 - 2 * s) * values[1] + s**2 * (s - 1) * span * arriving)
        exact = function(begins + s * (ends - begins))[0]
        worst = np.maximum(worst, np.max(np.abs(cubic - exact), axis=1))
    return worst


def _ends(function: Function, begins, ends):
    """Values at both ends of intervals, rates behind the first and before the second."""
    inside = 1e-6 * (ends - begins)
    values = function(begins)[0], function(ends)[0]
    return values, function(begins + inside)[1], function(ends - inside)[1]


def _curve(function: Function, begins, ends) -> _core.Curve:
    (first, last), leaving, arriving = _ends(function, begins, ends)
    still = np.zeros((1, first.shape[1]))
    return _core.Curve(np.append(begins, ends[-1]), np.concatenate([first, last[-1:]]), "hermite",
                       in_tangents=np.concatenate([still, arriving]), out_tangents=np.concatenate([leaving, still]))
