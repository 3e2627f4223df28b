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
CHECKS = (0.5,), (0.23, 0.77)          # of the way between keys, where the cubic is held against the function
INSIDE = 1e-6          # of the way between keys: where rates are those of this side of a key
JUMP = 1e-3            # of values at a junction from one side to the other, from which on there is a key on both sides
MOST_KEYS = 2_000_000

Function = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def curve_through(function: Function, junctions, tolerance: float) -> _core.Curve:
    """A Hermite Curve that errs by less than `tolerance` in any column.

    function: times [N] in s -> (values [N, C], rates [N, C] per s); junctions: times in s, at least the first and the last, at
    which it need not be smooth, nor continuous
    """
    begins, ends = _intervals(np.unique(np.asarray(junctions, float)))
    done: list[list[np.ndarray]] = []
    while len(begins):
        cubics, is_good = _tried(function, begins, ends, tolerance)
        is_good |= ends - begins < SHORTEST
        done.append([one[is_good] for one in (begins, ends, *cubics)])
        begins, ends = begins[~is_good], ends[~is_good]
        cuts = _cuts(begins, ends)
        begins, ends = np.concatenate([begins, cuts]), np.concatenate([cuts, ends])
        if len(begins) > MOST_KEYS:
            raise _too_many_keys()
    return _curve(*(np.concatenate(column) for column in zip(*done)))


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


def _tried(function: Function, begins, ends, tolerance: float):
    """((values, rates at the begin, values, rates at the end) of the cubic of each interval, whether it is within the tolerance
    at all CHECKS); those that fail the first are not asked again. Few calls of the function: it is mostly asked for few times."""
    number, span = len(begins), (ends - begins)[:, None]
    inside = INSIDE * span[:, 0]
    values, rates = function(np.concatenate([begins + inside, ends - inside]))
    leaving, arriving = rates[:number], rates[number:]
    cubics = values[:number] - INSIDE * span * leaving, leaving, values[number:] + INSIDE * span * arriving, arriving
    left = np.arange(number)
    for some in CHECKS:
        y0, m0, y1, m1, h = (one[left] for one in (*cubics, span))
        exact = function(np.concatenate([begins[left] + s * h[:, 0] for s in some]))[0]
        is_near = np.ones(len(left), bool)
        for s, of_one in zip(some, np.split(exact, len(some))):
            cubic = ((1 + 2 * s) * (1 - s) ** 2 * y0 + s * (1 - s) ** 2 * h * m0 + s**2 * (3 - 2 * s) * y1
                     + s**2 * (s - 1) * h * m1)
            is_near &= np.max(np.abs(cubic - of_one), axis=1) < tolerance
        left = left[is_near]
    is_good = np.zeros(number, bool)
    is_good[left] = True
    return cubics, is_good


def _curve(begins, ends, first, leaving, last, arriving) -> _core.Curve:
    order = np.argsort(begins)
    begins, ends, first, leaving, last, arriving = (column[order] for column in (begins, ends, first, leaving, last, arriving))
    jumps = 1 + np.flatnonzero(np.abs(last[:-1] - first[1:]).max(axis=1) > JUMP)   # what turns back looks elsewhere at once
    before = ends[jumps - 1] - INSIDE * (ends - begins)[jumps - 1]
    still = np.zeros((1, first.shape[1]))
    to, of = np.concatenate([still, arriving]), np.concatenate([leaving, still])
    moved = to[jumps]
    to[jumps] = 0.0
    return _core.Curve(np.insert(np.append(begins, ends[-1]), jumps, before),
                       np.insert(np.concatenate([first, last[-1:]]), jumps, last[jumps - 1], axis=0), "hermite",
                       in_tangents=np.insert(to, jumps, moved, axis=0), out_tangents=np.insert(of, jumps, 0.0, axis=0))
