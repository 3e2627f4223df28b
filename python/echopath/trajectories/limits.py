"""Speeds over the distance, held within limits: stops, and what acceleration, brakes and curves allow."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .path import ON_THE_SPOT, Path
from .profile import GRID, MOST_PLACES, Profile, of_phases


@dataclass(frozen=True)
class Limits:
    """stops: [N, 2] distances in m, ascending, and waiting times in s; the rest in m/s^2."""

    stops: np.ndarray
    acceleration: float
    deceleration: float
    lateral: float | None = None

    @property
    def are_any(self) -> bool:
        return self.lateral is not None or len(self.stops) > 0


def over_distance(start_time: float, table, path: Path, limits: Limits) -> Profile:
    """Speeds [[distance in m, m/s], ...] along a path, of constant acceleration between, within limits.

    At every place the square of the speed is the least of what the table, the curve, and the way from the last and to the next
    slower place allow, and 0 where a path whose curves are limited turns back on itself; between two places it is linear in the
    distance, so that the acceleration is constant.
    Raises ValueError where it would stand without a stop.
    """
    table = np.asarray(table, float)
    places = _places(table, path, limits)
    squares = np.interp(places, table[:, 0], table[:, 1] ** 2)
    if limits.lateral is not None:
        squares = np.minimum(squares, limits.lateral / np.maximum(_turns(path, places), 1e-12))
        squares[_nearest(places, _turning_places(path, limits.stops[:, 0]))] = 0.0
    if limits.are_any:
        squares[np.isin(places, limits.stops[:, 0])] = 0.0
        squares = _within(places, squares, limits)
        places, squares = _without_needless(places, squares, limits.stops[:, 0])
    if np.any(squares[:-1] + squares[1:] <= 0.0):
        place = places[int(np.argmin(squares[:-1] + squares[1:]))]
        raise ValueError(f"speed: must be above 0 but at single places, got 0 from {place:g} m on")
    speeds, ways = np.sqrt(squares), np.diff(places)
    durations = 2.0 * ways / (speeds[:-1] + speeds[1:])
    rates = np.diff(squares) / (2.0 * ways)
    return _with_waits(start_time, places, durations, speeds[:-1], rates, limits.stops)


def _places(table, path: Path, limits: Limits):
    """Distances at which limits change, and a grid where they cannot be told beforehand."""
    places = [np.array([0.0, path.length]), table[:, 0], limits.stops[:, 0]]
    is_even = np.ptp(table[:, 1]) == 0.0
    if limits.lateral is not None or (len(limits.stops) and not is_even):
        places.append(np.linspace(0.0, path.length, min(int(path.length / GRID) + 2, MOST_PLACES)))
        places.append(path.junctions)
    if limits.lateral is not None:
        places += [path.fine_places(MOST_PLACES), _turning_places(path, limits.stops[:, 0])]
    stops, speed = limits.stops[:, 0], table[0, 1]
    places += [stops - speed**2 / (2.0 * limits.deceleration), stops + speed**2 / (2.0 * limits.acceleration)]
    share = limits.acceleration + limits.deceleration
    places.append((limits.acceleration * stops[:-1] + limits.deceleration * stops[1:]) / share)
    found = np.unique(np.concatenate(places))
    found = found[(found >= 0.0) & (found <= path.length)]
    near = np.flatnonzero(np.diff(found) < 1e-9 * max(path.length, 1.0)) + 1     # of two that are one, a stop is kept
    kept = np.ones(len(found), bool)
    for k in near:
        kept[k - 1 if found[k] in stops or found[k] == path.length else k] = False
    return found[kept]


def _turning_places(path: Path, stops):
    """Distances [N] in m at which the path turns back, but where it stops anyhow."""
    found = path.turning_places()
    return found[np.all(np.abs(found[:, None] - stops) > ON_THE_SPOT, axis=1)]


def _nearest(places, wanted):
    """Indices [N] of the places that are nearest to those that are wanted."""
    return np.argmin(np.abs(places - wanted[:, None]), axis=1)


def _turns(path: Path, places):
    """Largest curvature [N] in 1/m on both sides of the places."""
    return np.max([np.abs(path.bearings(np.clip(places + side, 0.0, path.length))[1]) for side in (-1e-6, 0.0, 1e-6)], axis=0)


def _within(places, squares, limits: Limits):
    """Squares of the speed [N] that can be reached from the place before and left for the one behind."""
    squares, steps = squares.tolist(), np.diff(places).tolist()
    for k, step in enumerate(steps):
        squares[k + 1] = min(squares[k + 1], squares[k] + 2.0 * limits.acceleration * step)
    for k in range(len(steps) - 1, -1, -1):
        squares[k] = min(squares[k], squares[k + 1] + 2.0 * limits.deceleration * steps[k])
    return np.array(squares)


def _without_needless(places, squares, stops):
    """(places, squares) without those of the places at which the acceleration goes on unchanged."""
    slopes = np.diff(squares) / np.diff(places)
    is_needed = np.abs(np.diff(slopes)) > 1e-9 * (np.abs(slopes[:-1]) + np.abs(slopes[1:]))
    kept = np.concatenate([[True], is_needed, [True]]) | np.isin(places, stops)
    return places[kept], squares[kept]


def _with_waits(start_time, places, durations, speeds, rates, stops) -> Profile:
    """The Profile of phases between places, with the waiting times at the stops among them."""
    waits = stops[stops[:, 1] > 0.0]
    at = np.searchsorted(places, waits[:, 0] - 1e-9 * max(places[-1], 1.0))
    durations, speeds, rates = (np.insert(values, at, new) for values, new in
                                ((durations, waits[:, 1]), (speeds, 0.0), (rates, 0.0)))
    return of_phases(start_time, durations, speeds, rates)
