"""How actors follow a trajectory: wheels that roll its way, parts that move as a function of time."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .. import _core
from ..arguments.checks import an, optional, refused
from ..base.rotations import quaternions
from ..trajectories.knots import curve_through
from ..trajectories.profile import Profile
from ..trajectories.trajectory import Trajectory

WHEEL_TOLERANCE = 5e-6      # of quaternions: a tread 0.33 m from the axle errs by 3 micrometres
STEERING_WAY = 1.5          # m before and behind, over which the curvature that a wheel steers by is averaged
MOST_STEERING = np.radians(45.0)
DIFFERENCE = 1e-4           # s, of differences that give rates
MOST_KEYS = 200_000         # of a part

trajectory_rule = optional(an(Trajectory))


def refuse_beside_trajectory(trajectory, **given) -> None:
    """Raises ValueError for arguments that differ from their defaults beside a trajectory. given: name=(value, default)"""
    for name, (value, default) in given.items():
        if trajectory is not None and value != default:
            raise refused(ValueError, name, "left out beside trajectory", value)


@dataclass(frozen=True)
class Rolling:
    """How what carries wheels goes: `rolled`, the Profile of its way ahead in m; `yaw`, times [N] in s -> its yaw in rad and the
    rate; `turn`, the same of its yaw relative to the trajectory, None: it has that of the trajectory; `ahead`: m, of the point
    that stays on the path before the one that follows the trajectory."""

    rolled: Profile
    yaw: Callable
    turn: Callable | None = None
    ahead: float = 0.0


def rolling_along(trajectory: Trajectory, radius: float, *, y: float = 0.0, wheelbase: float | None = None):
    """The CurveMotion of a wheel of a `radius` in m that rolls as the trajectory of its vehicle goes, about its own place.

    y: m, of the wheel to the left of the vehicle's middle, by which its way differs in curves; wheelbase: m, of a wheel that
    steers, None: it does not
    """
    track = trajectory._track
    rolling = Rolling(track.rolled(), track.yaws)
    return _core.CurveMotion(rotation=roll(trajectory, rolling, radius, y=y, wheelbase=wheelbase, junctions=track.junctions()))


def roll(trajectory: Trajectory, rolling: Rolling, radius: float, *, y: float, wheelbase: float | None, junctions):
    """The Curve of the rotations of a wheel; radius, y, wheelbase as of rolling_along; junctions: s, where all is not smooth."""
    track, rolled = trajectory._track, rolling.rolled
    yaw_at_begin = rolling.yaw(np.array([rolled.begin]))[0][0]

    def rotation(times):
        way, speed, _ = rolled.at(times)
        yaw, yaw_rate = rolling.yaw(times)
        angle, rate = (way - y * (yaw - yaw_at_begin)) / radius, (speed - y * yaw_rate) / radius
        steer, steer_rate = (0.0 * way, 0.0 * way) if wheelbase is None else _steering(track, times, wheelbase, rolling.ahead)
        if rolling.turn is not None:
            turn, turn_rate = rolling.turn(times)
            steer, steer_rate = steer + turn, steer_rate + turn_rate
        return turned(steer, steer_rate, angle, rate)

    if wheelbase is not None:
        near = np.concatenate([track.path.junctions - STEERING_WAY, track.path.junctions + STEERING_WAY]) - rolling.ahead
        ends = track.profile.at(np.array([track.profile.begin, track.profile.end]))[0]
        junctions = np.concatenate([junctions, track.time_at(near[(near > ends[0]) & (near < ends[1])])])
    return curve_through(rotation, junctions, WHEEL_TOLERANCE)


def turned(yaw, yaw_rate, angle=0.0, rate=0.0):
    """(unit quaternions [N, 4] (w, x, y, z), their rates [N, 4] per s): about y by `angle` in rad, then about z by `yaw`."""
    angle, rate = angle + 0.0 * yaw, rate + 0.0 * yaw
    c, s, n, m = np.cos(0.5 * yaw), np.sin(0.5 * yaw), np.cos(0.5 * angle), np.sin(0.5 * angle)
    values = np.stack([c * n, -s * m, c * m, s * n], axis=-1)
    by_yaw = np.stack([-s * n, -c * m, -s * m, c * n], axis=-1)
    by_angle = np.stack([-c * m, -s * n, c * n, -s * m], axis=-1)
    return values, 0.5 * (by_yaw * yaw_rate[:, None] + by_angle * rate[:, None])


def _steering(track, times, wheelbase: float, ahead: float = 0.0):
    """(angle [N] in rad of a wheel in the front, to the left; its rate in rad/s) by the curvature of the path.

    ahead: m, of the axle that does not steer before the point that follows the trajectory
    """
    distance, speed, _ = track.profile.at(times)
    behind, front = (track.path.bearings(distance + ahead + way) for way in (-STEERING_WAY, STEERING_WAY))
    slope = wheelbase * (front[0] - behind[0]) / (2.0 * STEERING_WAY)
    slope_rate = wheelbase * (front[1] - behind[1]) / (2.0 * STEERING_WAY) * speed
    angle = np.arctan(slope)
    is_free = np.abs(angle) < MOST_STEERING
    return np.clip(angle, -MOST_STEERING, MOST_STEERING), np.where(is_free, slope_rate / (1.0 + slope**2), 0.0)


def key_times(trajectory: Trajectory, rate: float):
    """Times [T] in s, multiples of a power of two of a second, at least `rate` a second while it moves."""
    step = 2.0 ** -np.ceil(np.log2(rate))
    if (trajectory.end - trajectory.begin) / step > MOST_KEYS:
        raise refused(ValueError, "trajectory", f"at most {MOST_KEYS * step:g} s long at such a keyframe_rate", trajectory)
    grid = np.arange(np.ceil(trajectory.begin / step), np.floor(trajectory.end / step) + 1.0) * step
    times = np.unique(np.concatenate([[trajectory.begin], grid, [trajectory.end]]))
    close = np.flatnonzero(np.diff(times) < 1e-3 * step)
    times = np.delete(times, np.where(close == 0, 1, close))
    moves = trajectory.speed(times) > 0.0
    near = moves.copy()
    near[1:] |= moves[:-1]
    near[:-1] |= moves[1:]
    near[[0, -1]] = True
    return times[near]


def with_rates(arrays, frames_at, times):
    """PartArrays whose keys at times [T] have rates, too: those of frames_at(times) -> {name: Frames}, by differences."""
    low, high = np.maximum(times - DIFFERENCE, times[0]), np.minimum(times + DIFFERENCE, times[-1])
    before, after, span = frames_at(low), frames_at(high), (high - low)[:, None]
    parts = []
    for part in arrays:
        first, second = before[part.name], after[part.name]
        turns = [_near(quaternions(frames.rotation), part.rotations) for frames in (first, second)]
        rates = (second.origin - first.origin) / span, (turns[1] - turns[0]) / span
        parts.append(replace(part, rates=rates))
    return parts


def _near(turns, reference):
    """Quaternions [T, 4] of the sign that is nearer to others."""
    return turns * np.where(np.sum(turns * reference, axis=-1) < 0.0, -1.0, 1.0)[:, None]
