"""How a tractor and its semitrailer follow a trajectory: the tractor's rear axle is on the path, the trailer follows its hitch.

A trailer whose wheels do not slip sideways turns by n . v / L, where v is the velocity of the hitch, n the left normal of the
trailer and L its length from the hitch to the middle of its axles. On a circle it comes to a constant angle: with the tractor's
rear axle R from the centre and the hitch a ahead of it, the trailer lags by asin(L / sqrt(R^2 + a^2)) - atan(a / R).
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ... import _core
from ...base.process.callers import warn_user
from ...trajectories.knots import curve_through
from ...trajectories.profile import SIDE, Profile, hermite_pieces, summed
from ...trajectories.track import shifted
from ...trajectories.trajectory import TOLERANCE
from ..following import WHEEL_TOLERANCE, Rolling, Wheels, turned

STEP = 2.0**-6         # s, of the trailer's angle
MOST_BEND = np.radians(90.0)


@dataclass(frozen=True)
class Coupling:
    """Along x of the vehicle that is in line, in m: drive_axle, hitch, trailer_axle (the middle of its axles)."""

    drive_axle: float
    hitch: float
    trailer_axle: float


class Towing:
    """Where tractor and trailer of a vehicle are that follows a Trajectory, relative to that."""

    def __init__(self, trajectory, coupling: Coupling):
        self.trajectory, self.coupling, self._track = trajectory, coupling, trajectory._track
        self.tractor, self.trailer = (Unit(self, moved) for moved in (self._tractor, self._trailer))

    def warn_of_folding(self) -> None:
        """Warns (RuntimeWarning) where the trailer would run into the cab."""
        times = self._steps()
        bends = np.abs(self._angle.at(times)[0] - self._tractor(times)[2])
        if bends.max() > MOST_BEND:
            first = float(times[int(np.argmax(bends > MOST_BEND))])
            warn_user(f"trajectory: folds the truck by {np.degrees(bends.max()):.0f} degrees, from {first:.4g} s on by more than "
                      f"{np.degrees(MOST_BEND):.0f}; no trailer follows curves as tight, nor is pushed far along a curve")

    @cached_property
    def junctions(self):
        """Times in s at which the units may not move smoothly: those of the path, under the origin and under the axle."""
        return self._track.junctions_with(self.coupling.drive_axle)

    def _tractor(self, times):
        """(place [N, 3] of the vehicle's origin as a point of the tractor, its velocity, yaw [N], its rate)."""
        return self._track.steered_by(times, self.coupling.drive_axle)

    def _trailer(self, times):
        """The same of the trailer."""
        hitch, velocity = self._hitch(times)
        yaw, rate, _ = self._angle.at(times)
        return *shifted(hitch, velocity, yaw, rate, -self.coupling.hitch), yaw, rate

    def _hitch(self, times):
        """(place [N, 3], velocity [N, 3]) of the hitch."""
        return shifted(*self._tractor(times), self.coupling.hitch)

    def _steps(self):
        """Times in s between which what rolls is summed up."""
        return np.unique(np.concatenate([self._track.fine_times(STEP), self.junctions]))

    @cached_property
    def _angle(self) -> Profile:
        """The trailer's yaw in rad over time, by the classical Runge-Kutta method.

        It is in line where the truck is farthest back on its way: on to the begin and on to the end, deviations then die out, as
        they do of any trailer that is pulled, and grow where it is pushed.
        """
        times = self._steps()
        steps = np.diff(times)
        velocities = [self._hitch(at)[1][:, :2] for at in
                      (times[:-1] + SIDE * steps, times[:-1] + 0.5 * steps, times[1:] - SIDE * steps)]
        length = self.coupling.hitch - self.coupling.trailer_axle
        farthest = int(np.argmin(self._track.rolled.at(times)[0]))
        yaw = float(self._tractor(times[farthest:farthest + 1])[2][0])
        after = _followed(yaw, [rows[farthest:] for rows in velocities], steps[farthest:], length)
        before = _followed(yaw, [rows[:farthest][::-1] for rows in velocities[::-1]], -steps[:farthest][::-1], length)
        yaws = np.array(before[:0:-1] + after)
        leaving, arriving = _turning(velocities[0].T, yaws[:-1], length), _turning(velocities[2].T, yaws[1:], length)
        return Profile(times, hermite_pieces(steps, yaws, leaving, arriving))


class Unit:
    """One of the two: what moves with it. moved: times [N] in s -> as of Towing._tractor; a Driving of its parts."""

    def __init__(self, towing: Towing, moved):
        self._towing, self._moved = towing, moved

    def carried(self, parts: list) -> list:
        """Parts at rest in the vehicle, with their motions."""
        return [replace(part, motion=self._motion(tuple(part.position))) for part in parts]

    def wheel(self, radius: float, *, center, wheelbase: float | None = None) -> Any:
        """The motion of a wheel of a `radius` at `center` [3] in m; wheelbase: m, of one that steers, or None."""
        return _core.CurveMotion(self._translation(center), self._wheels.curve(radius, center, wheelbase))

    @cached_property
    def _wheels(self) -> Wheels:
        _, turn = self._relative()
        has_headings = self._towing.trajectory._track.headings is not None
        ahead = 0.0 if has_headings else self._towing.coupling.drive_axle
        rolling = Rolling(self._rolled, self._moved, turn, ahead)
        return Wheels(self._towing.trajectory, rolling, self._towing.junctions)

    @cached_property
    def _rolled(self) -> Profile:
        """The way in m that its wheels roll: that of the point of its middle between axles that do not slip."""
        return summed(self._towing._steps(), lambda times: [self._speed(times)])[0]

    def _speed(self, times):
        """m/s ahead [N] over the ground, up and down its slopes: the same for all points along the middle."""
        _, velocity, yaw, _ = self._moved(times)
        level = velocity[:, 0] * np.cos(yaw) + velocity[:, 1] * np.sin(yaw)
        return np.copysign(np.hypot(level, velocity[:, 2]), level)

    def _motion(self, position: tuple):
        motions = self.__dict__.setdefault("_motions", {})
        if position not in motions:
            _, turn = self._relative()
            rotation = curve_through(lambda times: turned(*turn(times)), self._detailed_junctions, WHEEL_TOLERANCE)
            motions[position] = _core.CurveMotion(self._translation(position), rotation)
        return motions[position]

    def _translation(self, position):
        """The Curve by which a part at `position` [3] m is elsewhere than there, in the axes of the trajectory."""
        place, turn = self._relative()
        p = np.asarray(position, float)

        def moved(times):
            (shift, velocity), (angle, rate) = place(times), turn(times)
            offset, swing = _level(p, angle), _level(p, angle + 0.5 * np.pi)
            return shift + offset + [0.0, 0.0, p[2]] - p, velocity + rate[:, None] * swing
        return curve_through(moved, self._detailed_junctions, TOLERANCE)

    @cached_property
    def _detailed_junctions(self):
        return self._towing.trajectory._within_details(self._towing.junctions)

    def _relative(self):
        """(times -> (place [N, 3] of the vehicle's origin, velocity), times -> (turn [N], rate)) in the trajectory's axes."""
        trajectory = self._towing.trajectory
        return trajectory._track.relative(self._moved, trajectory._has_pitch)


def _followed(yaw: float, velocities, steps, length: float) -> list[float]:
    """The yaws [N + 1] in rad of a trailer from one of them on, over steps [N] in s.

    velocities: of its hitch at the begin, in the middle and at the end of each step, [N, 2] each in m/s
    """
    yaws = [yaw]
    for first, middle, last, step in zip(*(rows.tolist() for rows in velocities), steps.tolist()):
        slope = slopes = _turning(first, yaw, length)
        for share, weight, at in ((0.5, 2.0, middle), (0.5, 2.0, middle), (1.0, 1.0, last)):
            slope = _turning(at, yaw + share * step * slope, length)
            slopes += weight * slope
        yaw += step / 6.0 * slopes
        yaws.append(yaw)
    return yaws


def _turning(velocity, yaw, length: float):
    """rad/s, of a trailer whose hitch has a velocity (x, y) in m/s."""
    return (velocity[1] * np.cos(yaw) - velocity[0] * np.sin(yaw)) / length


def _level(point, angle):
    """The level part of a point [3], turned by angles [N] about z: [N, 3]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * point[0] - s * point[1], s * point[0] + c * point[1], 0.0 * angle], axis=-1)
