"""Curves of the core that follow a function of time to a tolerance.

Keys stand where the function is not smooth and, between these, at whole multiples of powers of two of a second, closer where
the cubic through values and rates of two keys errs by more than the tolerance. Different objects of a scene thus share
their keys, at which replay cuts a frame.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .. import _core

LONGEST = 1.0          # s between keys, of functions that last no longer than MOST_EVEN of these
MOST_EVEN = 2**16      # intervals to begin with: of longer functions those are longer by a power of two
SHORTEST = 2.0**-14    # s: a function that asks for more is not smooth
CHECKS = 0.5, 0.23, 0.77               # of the way between keys, where the cubic is held against the function
INSIDE = 1e-6          # of the way between keys: where rates are those of this side of a key
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
        is_good = _are_good(function, begins, ends, tolerance) | (ends - begins < SHORTEST)
        done.append(np.stack([begins[is_good], ends[is_good]]))
        begins, ends = begins[~is_good], ends[~is_good]
        cuts = _cuts(begins, ends)
        begins, ends = np.concatenate([begins, cuts]), np.concatenate([cuts, ends])
        if len(begins) > MOST_KEYS:
            raise _too_many_keys()
    begins, ends = np.concatenate(done, axis=1)
    order = np.argsort(begins)
    return _curve(function, begins[order], ends[order])


def _intervals(junctions):
    if len(junctions) == 1:
        return np.zeros(0), np.zeros(0)
    begin, end = junctions[0], junctions[-1]
    if end - begin > MOST_KEYS * LONGEST:
        raise _too_many_keys()
    longest = LONGEST * 2.0 ** np.ceil(np.log2(max(1.0, (end - begin) / (MOST_EVEN * LONGEST))))
    grid = np.arange(np.ceil(begin / longest), np.ceil(end / longest)) * longest
    knots = np.unique(np.concatenate([junctions, grid]))
    apart = np.concatenate([[True], np.diff(knots) > 1e-9])      # of two that are one, the earlier
    apart[-1] = True
    knots = knots[apart]
    return knots[:-1], knots[1:]


def _too_many_keys() -> ValueError:
    return ValueError(f"trajectory: must be followed by at most {MOST_KEYS} keys; it is too long or too wild")


def _cuts(begins, ends):
    """A multiple of a power of two within each interval."""
    steps = 2.0 ** np.floor(np.log2(0.75 * (ends - begins)))
    return (np.floor(begins / steps) + 1.0) * steps


def _are_good(function: Function, begins, ends, tolerance: float):
    """Whether the cubic of each interval is within the tolerance at all CHECKS; those that fail one are not asked again."""
    values, rates = _inner_ends(function, begins, ends)
    span = (ends - begins)[:, None]
    values = values[0] - INSIDE * span * rates[0], values[1] + INSIDE * span * rates[1]
    left = np.arange(len(begins))
    for s in CHECKS:
        (y0, y1), (m0, m1), h = ([one[left] for one in values], [one[left] for one in rates], span[left])
        cubic = ((1 + 2 * s) * (1 - s) ** 2 * y0 + s * (1 - s) ** 2 * h * m0 + s**2 * (3 - 2 * s) * y1 + s**2 * (s - 1) * h * m1)
        exact = function(begins[left] + s * h[:, 0])[0]
        left = left[np.max(np.abs(cubic - exact), axis=1) < tolerance]
    return np.isin(np.arange(len(begins)), left)


def _inner_ends(function: Function, begins, ends):
    """(values, rates), each of both ends of intervals, just within these."""
    inside = INSIDE * (ends - begins)
    return zip(function(begins + inside), function(ends - inside))


def _curve(function: Function, begins, ends) -> _core.Curve:
    first, last = function(begins)[0], function(ends)[0]
    _, (leaving, arriving) = _inner_ends(function, begins, ends)
    still = np.zeros((1, first.shape[1]))
    return _core.Curve(np.append(begins, ends[-1]), np.concatenate([first, last[-1:]]), "hermite",
                       in_tangents=np.concatenate([still, arriving]), out_tangents=np.concatenate([leaving, still]))
