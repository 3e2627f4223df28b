"""One period of an animation's curve as polynomials, and the same curve played as fast as something goes along."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..trajectories.knots import curve_through

SPAN = 0.2            # rad, half angles between keys: the cubic with a great circle's tangents errs by SPAN^4 / 384
TOLERANCE = 1e-5      # m, and of quaternions, scales and weights: of the curves that are played
SMALLEST = 1e-12


class PlayedCurve:
    """Values [N, C] and rates over the phase 0 to 1 of a loop of a Curve with a `period` in s that closes.

    What is left between both ends is spread over the period: the way that an animation makes ahead, too.
    """

    def __init__(self, curve, period: float, is_rotation: bool):
        self.steps = curve.interpolation == "step" or len(curve.times) == 1
        times, values, leaving, arriving = _keys(curve, is_rotation)
        inside = (times > 0.0) & (times < period)
        ends = [_at(times, values, leaving, arriving, at, self.steps) for at in (0.0, period)]
        self._times = np.concatenate([[0.0], times[inside], [period]]) / period
        self._values = np.concatenate([ends[0][0][None], values[inside], ends[1][0][None]])
        self._leaving = period * np.concatenate([ends[0][1][None], leaving[inside]])
        self._arriving = period * np.concatenate([arriving[inside], ends[1][2][None]])
        last = self._values[-1]
        self.sign = -1.0 if is_rotation and np.dot(last, self._values[0]) < 0.0 else 1.0
        if not self.steps:
            gap = self.sign * self._values[0] - last
            self._values = self._values + self._times[:, None] * gap
            self._leaving, self._arriving = self._leaving + gap, self._arriving + gap
        self._is_rotation = is_rotation

    @property
    def phases(self):
        """Those [K] at which it is not smooth, from 0 on and before 1."""
        return self._times[:-1]

    def at(self, phases):
        """(values [N, C], rates [N, C] by the phase), in loops that follow each other."""
        loops = np.floor(phases)
        x = phases - loops
        k = np.clip(np.searchsorted(self._times, x, side="right") - 1, 0, len(self._times) - 2)
        values, rates = _hermite(self._values[k], self._values[k + 1], self._leaving[k], self._arriving[k],
                                 self._times[k], self._times[k + 1], x)
        if self.steps:
            values, rates = self._values[k], 0.0 * rates
        turned = np.where(np.mod(loops, 2.0) == 1.0, self.sign, 1.0)[:, None]
        values, rates = turned * values, turned * rates
        if not self._is_rotation:
            return values, rates
        length = np.maximum(np.linalg.norm(values, axis=-1, keepdims=True), SMALLEST)
        unit = values / length
        return unit, (rates - np.sum(rates * unit, axis=-1, keepdims=True) * unit) / length

    def along(self, trajectory, way: float):
        """The Curve over the details of a Trajectory by whose distance, `way` m a loop, it is played."""
        track = trajectory._track
        junctions = trajectory._within_details(track.profile.times)
        begin = junctions[0]
        first, last = track.profile.at(junctions[[0, -1]])[0] / way
        loops = np.arange(np.floor(first), np.ceil(last) + 1.0)
        passed = (loops[:, None] + self.phases).ravel()
        passed = passed[(passed > first) & (passed < last)]
        times = track.time_at(passed * way)
        if self.steps:
            keys = np.concatenate([[begin], times])
            phases = np.concatenate([[first], passed]) + SMALLEST
            return _core.Curve(*_ascending(keys, self.at(phases)[0]), "step")

        def played(at):
            distance, speed, _ = track.profile.at(at)
            values, rates = self.at(distance / way)
            return values, rates * (speed / way)[:, None]
        return curve_through(played, np.concatenate([junctions, times]), TOLERANCE)


def _keys(curve, is_rotation: bool):
    """(times [K], values [K, C], tangents [K, C] per s behind and before each key)."""
    times, values = curve.times, curve.values
    if curve.interpolation == "hermite":
        return times, values, curve.out_tangents, curve.in_tangents
    still = np.zeros_like(values)
    if curve.interpolation == "step" or len(times) == 1:
        return times, values, still, still
    if is_rotation:
        times, values = _finer(times, values)
    slopes = np.diff(values, axis=0) / np.diff(times)[:, None]
    leaving, arriving = (slopes, slopes) if not is_rotation else _circles(times, values)
    still = np.zeros((1, values.shape[1]))
    return times, values, np.concatenate([leaving, still]), np.concatenate([still, arriving])


def _finer(times, values):
    """Keys of rotations on the great circles between the given ones, close enough for cubics; of one sign all along."""
    flips = np.where(np.sum(values[1:] * values[:-1], axis=1) < 0.0, -1.0, 1.0)
    values = values * np.cumprod(np.concatenate([[1.0], flips]))[:, None]
    found_times, found = [times[:1]], [values[:1]]
    for begin, end, p, q in zip(times[:-1], times[1:], values[:-1], values[1:]):
        angle = np.arccos(np.clip(np.dot(p, q), -1.0, 1.0))
        share = np.linspace(0.0, 1.0, int(np.ceil(angle / SPAN)) + 1 if angle > SPAN else 2)[1:]
        between = (1 - share)[:, None] * p + share[:, None] * q if angle < 1e-6 else (
            np.sin((1 - share) * angle)[:, None] * p + np.sin(share * angle)[:, None] * q) / np.sin(angle)
        found_times.append(begin + share * (end - begin))
        found.append(between)
    return np.concatenate(found_times), np.concatenate(found)


def _circles(times, values):
    """Tangents [K-1, 4] of the great circles between unit quaternions, at the begin and at the end of each."""
    p, q = values[:-1], values[1:]
    cosine = np.clip(np.sum(p * q, axis=1, keepdims=True), -1.0, 1.0)
    angle = np.arccos(cosine)
    ratio = angle / np.maximum(np.sin(angle), SMALLEST)
    ratio = np.where(angle < 1e-6, 1.0, ratio) / np.diff(times)[:, None]
    return ratio * (q - cosine * p), ratio * (cosine * q - p)


def _at(times, values, leaving, arriving, at: float, steps: bool):
    """(value, slope behind, slope before) [C] at one time; beyond the ends the first and the last hold."""
    if at <= times[0] or at >= times[-1] or len(times) == 1:
        index = 0 if at <= times[0] else len(times) - 1
        is_key = times[index] == at
        return values[index], leaving[index] * is_key, arriving[index] * is_key
    k = int(np.searchsorted(times, at, side="right")) - 1
    if steps:
        return values[k], leaving[k], arriving[k]
    value, rate = _hermite(values[k:k + 1], values[k + 1:k + 2], leaving[k:k + 1], arriving[k + 1:k + 2], times[k:k + 1],
                           times[k + 1:k + 2], np.array([at]))
    return value[0], rate[0], rate[0]


def _hermite(y0, y1, m0, m1, begin, end, x):
    """(values [N, C], slopes [N, C]) of cubics between begin and end [N] at x [N]."""
    h = (end - begin)[:, None]
    b = (x - begin)[:, None] / h
    a = 1.0 - b
    values = (1 + 2 * b) * a**2 * y0 + b * a**2 * h * m0 + b**2 * (3 - 2 * b) * y1 - b**2 * a * h * m1
    slopes = 6 * a * b * (y1 - y0) / h + a * (1 - 3 * b) * m0 + b * (3 * b - 2) * m1
    return values, slopes


def _ascending(times, values):
    """(times, values) of keys, the last one of those at the same time."""
    kept = np.append(np.diff(times) > 1e-9, True)
    return times[kept], values[kept]
