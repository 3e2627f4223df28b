"""How actors follow a trajectory: wheels that roll its way and steer by its curves."""
from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .. import _core
from ..arguments.checks import an, optional, refused
from ..trajectories.knots import curve_through
from ..trajectories.profile import Profile, summed
from ..trajectories.trajectory import Trajectory

WHEEL_TOLERANCE = 5e-6      # of quaternions: a tread 0.33 m from the axle errs by 3 micrometres
STEERING_WAY = 1.5          # m before and behind, over which the curvature that a wheel steers by is averaged
WAY_STEP = 2.0**-6          # s, between times at which the way of a wheel that steers is summed up
MOST_STEERING = np.radians(45.0)

trajectory_rule = optional(an(Trajectory))


def refuse_beside_trajectory(trajectory, **given) -> None:
    """Raises ValueError for arguments that differ from their defaults beside a trajectory. given: name=(value, default)"""
    for name, (value, default) in given.items():
        if trajectory is not None and value != default:
            raise refused(ValueError, name, "left out beside trajectory", value)


@dataclass(frozen=True)
class Rolling:
    """How what carries wheels goes: `rolled`, the Profile of its way ahead in m; `moved`, times [N] in s -> (places of its
    origin, velocities [N, 3] in m/s, yaws in rad, their rates); `turn`, times -> its yaw relative to the trajectory and the rate,
    None: it has that of the trajectory; `ahead`: m, of the point that stays on the path before the one that follows the
    trajectory."""

    rolled: Profile
    moved: Callable
    turn: Callable | None = None
    ahead: float = 0.0

    def yaw(self, times):
        """(yaw [N] in rad, its rate in rad/s)."""
        return self.moved(times)[2:]


class Wheels:
    """The wheels of what goes along a trajectory: how it goes is worked out once for all that ask for nearly the same times.

    junctions: s, where the rolling is not smooth
    """

    def __init__(self, trajectory: Trajectory, rolling: Rolling, junctions):
        self._trajectory, self._track, self._rolling, self._junctions = trajectory, trajectory._track, rolling, junctions
        self._ways: dict[tuple | None, tuple] = {}
        self._yaw_at_begin = rolling.yaw(np.array([rolling.rolled.begin]))[0][0]

    def curve(self, radius: float, center=(0.0, 0.0, 0.0), wheelbase: float | None = None) -> _core.Curve:
        """The Curve of the rotations of a wheel of a `radius` in m that rolls about its own place.

        center: [3] m, of the wheel in the vehicle: what is to the left of its middle goes another way in curves; wheelbase: m, of
        a wheel that steers, None: it does not
        """
        x, y = float(center[0]), float(center[1])
        steers = None if wheelbase is None else (x, wheelbase)
        if steers not in self._ways:
            self._ways[steers] = Repeated(self._way_of(steers)), self._trajectory._within_details(self._junctions_of(wheelbase))
        repeated, junctions = self._ways[steers]
        ways = repeated.anew()

        def rotation(times):
            way, speed, swing, swing_rate, angle, angle_rate = ways(times)
            return turned(angle, angle_rate, (way - y * swing) / radius, (speed - y * swing_rate) / radius)
        return curve_through(rotation, junctions, WHEEL_TOLERANCE)

    def _way_of(self, steers: tuple | None) -> Callable:
        """times [N] in s -> [6, N]: the way in m that a wheel rolls in the middle of its axle, by how much less it does for each
        m to the left, its direction in rad in the axes of the trajectory, and the rate of each behind it.

        steers: (m, of its axle ahead of the vehicle's origin, wheelbase in m), None: it does not
        """
        rolling = self._rolling
        way, swing = (lambda times: rolling.rolled.at(times)[:2]), self._turned_since_begin
        if steers is not None:
            way, swing = self._steered_ways(*steers)

        def moved(times):
            angle, rate = np.zeros((2, len(times))) if steers is None else self._steering(times, steers[1])
            if rolling.turn is not None:
                turn, turn_rate = rolling.turn(times)
                angle, rate = angle + turn, rate + turn_rate
            return np.stack([*way(times), *swing(times), angle, rate])
        return moved

    def _turned_since_begin(self, times):
        yaw, rate = self._rolling.yaw(times)
        return yaw - self._yaw_at_begin, rate

    def _steering(self, times, wheelbase: float):
        return _steering(self._track, times, wheelbase, self._rolling.ahead)

    def _steered_ways(self, x: float, wheelbase: float):
        """(times -> (way [N] in m, its rate), times -> (by how much less for each m to the left, its rate)) of wheels that steer.

        Such a wheel rolls by what its velocity has along its own direction, which is not that of the vehicle.
        """
        rolling = self._rolling

        def rates(times):
            _, velocity, yaw, yaw_rate = rolling.moved(times)
            steer, _ = self._steering(times, wheelbase)
            aside = velocity[:, 1] * np.cos(yaw) - velocity[:, 0] * np.sin(yaw) + x * yaw_rate
            return rolling.rolled.at(times)[1] * np.cos(steer) + aside * np.sin(steer), yaw_rate * np.cos(steer)

        times = np.unique(np.concatenate([self._track.fine_times(WAY_STEP), self._junctions_of(wheelbase)]))
        return [lambda at, one=one: one.at(at)[:2] for one in summed(times, rates)]

    def _junctions_of(self, wheelbase: float | None):
        """Times in s at which wheels do not turn smoothly."""
        if wheelbase is None:
            return self._junctions
        track = self._track
        near = np.concatenate([track.path.junctions - STEERING_WAY, track.path.junctions + STEERING_WAY]) - self._rolling.ahead
        ends = track.profile.at(np.array([track.profile.begin, track.profile.end]))[0]
        return np.concatenate([self._junctions, track.time_at(near[(near > ends[0]) & (near < ends[1])])])


class Repeated:
    """A function of times that one after the other asks for, call by call at nearly the same times: the first one's are kept.

    function: times [N] -> values [C, N], each of its own time alone
    """

    def __init__(self, function: Callable):
        self._function = function
        self._kept: list[tuple] = []       # of each call: times, ascending, and values

    def anew(self) -> Callable:
        """The function for the next one that asks."""
        calls = itertools.count()
        return lambda times: self._at(next(calls), times)

    def _at(self, call: int, times):
        if call == len(self._kept):
            values = self._function(times)
            order = np.argsort(times)
            self._kept.append((times[order], values[:, order]))
            return values
        known, values = self._kept[call]
        if len(known) == 0:
            return self._function(times)
        place = np.minimum(np.searchsorted(known, times), len(known) - 1)
        found, is_new = values[:, place], known[place] != times
        if is_new.any():
            found[:, is_new] = self._function(times[is_new])
        return found


def wheels_along(trajectory: Trajectory) -> Wheels:
    """The Wheels of a vehicle that is carried by its trajectory."""
    track = trajectory._track
    return Wheels(trajectory, Rolling(track.rolled, lambda times: (*track.places(times), *track.yaws(times))), track.junctions())


def turned(yaw, yaw_rate, angle=0.0, rate=0.0):
    """(unit quaternions [N, 4] (w, x, y, z), their rates [N, 4] per s): about y by `angle` in rad, then about z by `yaw`."""
    angle, rate = angle + 0.0 * yaw, rate + 0.0 * yaw
    c, s, n, m = np.cos(0.5 * yaw), np.sin(0.5 * yaw), np.cos(0.5 * angle), np.sin(0.5 * angle)
    cn, sm, cm, sn = c * n, s * m, c * m, s * n
    values, by_yaw, by_angle = (np.stack(one, axis=-1) for one in (
        [cn, -sm, cm, sn], [-sn, -cm, -sm, cn], [-cm, -sn, cn, -sm]))
    return values, 0.5 * (by_yaw * yaw_rate[:, None] + by_angle * rate[:, None])


def _steering(track, times, wheelbase: float, ahead: float = 0.0):
    """(angle [N] in rad of a wheel in the front, to the left; its rate in rad/s) by what the vehicle turns over its way ahead.

    ahead: m, of the axle that does not steer before the point that follows the trajectory
    """
    distance, speed, _ = track.profile.at(times)
    behind, front = (track.steered(distance + ahead + way) for way in (-STEERING_WAY, STEERING_WAY))
    slope = wheelbase * (front[0] - behind[0]) / (2.0 * STEERING_WAY)
    slope_rate = wheelbase * (front[1] - behind[1]) / (2.0 * STEERING_WAY) * speed
    angle = np.arctan(slope)
    is_free = np.abs(angle) < MOST_STEERING
    return np.clip(angle, -MOST_STEERING, MOST_STEERING), np.where(is_free, slope_rate / (1.0 + slope**2), 0.0)
