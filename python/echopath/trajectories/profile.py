"""Profiles: the distance travelled over time, piecewise cubic, mostly of constant acceleration."""
from __future__ import annotations

import numpy as np

GRID = 0.25            # m, between places at which limits of the speed are held against each other
MOST_PLACES = 200_000
SIDE = 1e-6            # of a step: rates on this side of its ends


class Profile:
    """Distance over time, by polynomials between `times` [K] in s; it stands before the first and after the last.

    coefficients: [K-1, 4] of the powers of the time since times[k], in m, m/s and so on
    """

    def __init__(self, times, coefficients):
        self.times, self.coefficients = np.asarray(times, float), np.asarray(coefficients, float)
        self._columns = np.ascontiguousarray(self.coefficients.T)
        self.begin, self.end = float(self.times[0]), float(self.times[-1])

    def at(self, times):
        """(distance in m, speed in m/s, acceleration in m/s^2) at times [N], each [N]."""
        inside = np.minimum(np.maximum(times, self.begin), self.end)
        k = np.minimum(np.searchsorted(self.times, inside, side="right") - 1, len(self.times) - 2)
        c, t = self._columns[:, k], inside - self.times[k]
        moves = np.asarray(times) == inside
        distance = c[0] + t * (c[1] + t * (c[2] + t * c[3]))
        speed = c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])
        return distance, np.where(moves, speed, 0.0), np.where(moves, 2.0 * c[2] + 6.0 * t * c[3], 0.0)

    def moving(self):
        """(begins [N], ends [N]) in s of the spans in which it moves, apart from each other."""
        moves = np.any(self.coefficients[:, 1:] != 0.0, axis=1)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], moves, [False]]).astype(int)))
        return self.times[edges[::2]], self.times[edges[1::2]]

    def shifted(self, seconds: float) -> Profile:
        """The same, so much later."""
        return Profile(self.times + seconds, self.coefficients)

    def going_on(self, seconds: float) -> Profile:
        """The same, at its first and last speed for so long before its begin and after its end."""
        if seconds == 0.0:
            return self
        (first, last), (near, far) = self.at(np.array([self.begin, self.end]))[:2]
        times = np.concatenate([[self.begin - seconds], self.times, [self.end + seconds]])
        rows = [[first - near * seconds, near, 0.0, 0.0], *self.coefficients, [last, far, 0.0, 0.0]]
        return Profile(times, rows)

    def stops(self):
        """(times [N], distances [N]) of its first and last instant and of every standing between them."""
        still = np.flatnonzero(np.all(self.coefficients[:, 1:] == 0.0, axis=1))
        zero = np.flatnonzero(self.at(self.times)[1] == 0.0)
        times = np.unique(np.concatenate([[self.begin, self.end], self.times[still], self.times[zero]]))
        distances = self.at(times)[0]
        apart = np.concatenate([[True], np.diff(distances) > 1e-9])
        return times[apart], distances[apart]


def of_phases(start_time: float, durations, speeds, accelerations) -> Profile:
    """Phases [N] of constant acceleration, one after the other: durations in s, speeds at their begin in m/s, m/s^2."""
    durations, speeds, accelerations = (np.asarray(values, float) for values in (durations, speeds, accelerations))
    ways = durations * (speeds + 0.5 * accelerations * durations)
    distances = np.concatenate([[0.0], np.cumsum(ways)[:-1]])
    times = start_time + np.concatenate([[0.0], np.cumsum(durations)])
    return Profile(times, np.stack([distances, speeds, 0.5 * accelerations, np.zeros(len(ways))], axis=-1))


def over_time(start_time: float, table, length: float) -> Profile:
    """Speeds [[time since its begin in s, m/s], ...], linear between, until the path of `length` m ends or it stands."""
    times, speeds = np.asarray(table, float).T
    times = times - times[0]
    durations, rates = np.diff(times), np.diff(speeds) / np.diff(times)
    ways = np.cumsum(durations * 0.5 * (speeds[:-1] + speeds[1:]))
    if not len(ways) or ways[-1] < length:
        if speeds[-1] > 0.0:
            rest = length - (ways[-1] if len(ways) else 0.0)
            durations, rates = np.append(durations, rest / speeds[-1]), np.append(rates, 0.0)
        return of_phases(start_time, durations, speeds[:len(durations)], rates)
    k = int(np.searchsorted(ways, length))
    rest = length - (ways[k - 1] if k else 0.0)
    last = 2.0 * rest / (speeds[k] + np.sqrt(max(speeds[k] ** 2 + 2.0 * rates[k] * rest, 0.0)))
    return of_phases(start_time, np.append(durations[:k], last), speeds[:k + 1], rates[:k + 1])


def through(times, distances, speeds=None) -> Profile:
    """Distances [N] in m at times [N] in s by monotone cubics, whose speeds at the times may be given (Fritsch and Carlson)."""
    times, distances = np.asarray(times, float), np.asarray(distances, float)
    rates = slopes_of(times, distances) if speeds is None else np.array(speeds, float)
    steps = np.diff(times)
    secants = np.diff(distances) / steps
    most = 3.0 * np.minimum(np.append(secants, np.inf), np.insert(secants, 0, np.inf))
    rates = np.clip(rates, 0.0, most)        # within three secants a cubic does not turn back
    return Profile(times, hermite_coefficients(steps, distances, rates))


def summed(times, rates) -> list[Profile]:
    """What each of C rates adds up to from times[0] on, by Simpson's rule between times [K] in s, where they may jump.

    rates: times [N] in s -> C rates [N] in 1/s
    """
    steps = np.diff(times)
    sides = times[:-1] + SIDE * steps, times[:-1] + 0.5 * steps, times[1:] - SIDE * steps
    return [_summed(times, steps, *of_one) for of_one in zip(*(rates(at) for at in sides))]


def _summed(times, steps, first, middle, last) -> Profile:
    values = np.concatenate([[0.0], np.cumsum(steps / 6.0 * (first + 4.0 * middle + last))])
    return Profile(times, hermite_pieces(steps, values, first, last))


def slopes_of(knots, values):
    """Slopes [N] of the monotone cubic through values [N]: those of parabolas, 0 at extremes."""
    steps = np.diff(knots)
    secants = np.diff(values) / steps
    if len(secants) == 1:
        return np.repeat(secants, 2)
    inner = (steps[1:] * secants[:-1] + steps[:-1] * secants[1:]) / (steps[:-1] + steps[1:])
    first = secants[0] - steps[0] * (secants[1] - secants[0]) / (steps[0] + steps[1])
    last = secants[-1] + steps[-1] * (secants[-1] - secants[-2]) / (steps[-1] + steps[-2])
    slopes = np.concatenate([[first], inner, [last]])
    before, after = np.insert(secants, 0, secants[0]), np.append(secants, secants[-1])
    bound = 3.0 * np.minimum(np.abs(before), np.abs(after))
    slopes = np.where(before * after > 0.0, np.clip(slopes, -bound, bound), 0.0)
    return np.where(slopes * before < 0.0, 0.0, slopes)


def hermite_coefficients(steps, values, slopes):
    """[N-1, 4] of the powers within each step, through values [N] with slopes [N]."""
    return hermite_pieces(steps, values, slopes[:-1], slopes[1:])


def hermite_pieces(steps, values, leaving, arriving):
    """[N-1, 4] of the powers within each step, whose slopes [N-1] at its begin and at its end are its own."""
    rise = np.diff(values) / steps
    square = (3.0 * rise - 2.0 * leaving - arriving) / steps
    return np.stack([values[:-1], leaving, square, (leaving + arriving - 2.0 * rise) / steps**2], axis=-1)
