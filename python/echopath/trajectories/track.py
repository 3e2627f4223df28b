"""Tracks: a path that is travelled by a profile, with the direction in which the traveller looks."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .path import Path
from .profile import Profile, hermite_coefficients, slopes_of

ROLL_STEP = 2.0**-7    # s, between samples of the way that a vehicle rolls which looks elsewhere than it goes
STEERING_STEP = 0.05   # m, between samples of the yaw that its wheels steer by


@dataclass(frozen=True)
class Track:
    """What a Trajectory is made of. headings: yaw in rad over time as a Profile, None: along the path."""

    path: Path
    profile: Profile
    headings: Profile | None = None

    def places(self, times):
        """(points [N, 3] in m, velocities [N, 3] in m/s)."""
        distance, speed, _ = self.profile.at(times)
        point, tangent, _ = self.path.at(distance)
        return point, speed[:, None] * tangent

    def accelerations(self, times):
        """[N, 3] in m/s^2."""
        distance, speed, rate = self.profile.at(times)
        _, tangent, bend = self.path.at(distance)
        return rate[:, None] * tangent + speed[:, None] ** 2 * bend

    def yaws(self, times):
        """(yaw in rad without jumps, its rate in rad/s), each [N]."""
        if self.headings is not None:
            return self.headings.at(times)[:2]
        distance, speed, _ = self.profile.at(times)
        yaw, turn = self.path.bearings(distance)
        return yaw, turn * speed

    def pitches(self, times):
        """(angle of the nose above the plane in rad, its rate in rad/s), each [N], on a ground that rises with the path and is
        level across it: that of the path, less where it looks aside, below the plane where it backs up a hill."""
        distance, speed, _ = self.profile.at(times)
        slope, bend = self.path.slopes(distance)
        if self.headings is None:
            return slope, bend * speed
        (yaw, yaw_rate), (bearing, turn) = self.yaws(times), self.path.bearings(distance)
        c, s, rise = np.cos(yaw - bearing), np.sin(yaw - bearing), np.tan(slope)
        rate = (1.0 + rise**2) * bend * speed * c - rise * s * (yaw_rate - turn * speed)
        return np.arctan(rise * c), rate / (1.0 + (rise * c) ** 2)

    def rotations(self, times, has_pitch: bool):
        """(unit quaternions [N, 4] (w, x, y, z), their rates [N, 4] per s): about z by the yaw, then nose up by the pitch."""
        yaw, yaw_rate = self.yaws(times)
        pitch, pitch_rate = self.pitches(times) if has_pitch else (np.zeros_like(yaw), np.zeros_like(yaw))
        c, s, n, m = np.cos(0.5 * yaw), np.sin(0.5 * yaw), np.cos(0.5 * pitch), np.sin(0.5 * pitch)
        values = np.stack([c * n, s * m, -c * m, s * n], axis=-1)
        by_yaw = np.stack([-s * n, c * m, s * m, c * n], axis=-1)
        by_pitch = np.stack([-c * m, s * n, -c * n, -s * m], axis=-1)
        return values, 0.5 * (by_yaw * yaw_rate[:, None] + by_pitch * pitch_rate[:, None])

    def axes(self, times, has_pitch: bool):
        """(axes [N, 3, 3] whose columns look ahead, left and up, their rates [N, 3, 3] per s)."""
        yaw, yaw_rate = self.yaws(times)
        pitch, pitch_rate = self.pitches(times) if has_pitch else (np.zeros_like(yaw), np.zeros_like(yaw))
        c, s, n, m, zero = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), np.zeros_like(yaw)
        values = np.stack([c * n, -s, -c * m, s * n, c, -s * m, m, zero, n], axis=-1)
        by_yaw = np.stack([-s * n, -c, s * m, c * n, -s, -c * m, zero, zero, zero], axis=-1)
        by_pitch = np.stack([-c * m, zero, -c * n, -s * m, zero, -s * n, n, zero, -m], axis=-1)
        rates = by_yaw * yaw_rate[:, None] + by_pitch * pitch_rate[:, None]
        return values.reshape(-1, 3, 3), rates.reshape(-1, 3, 3)

    def steered_by(self, times, ahead: float):
        """(place [N, 3] of the origin as a point of the body whose point so many m ahead stays on the path and looks along it, as
        the drive axle of a tractor does, its velocity, yaw [N], its rate); with headings, those of the track itself."""
        if self.headings is not None:
            return *self.places(times), *self.yaws(times)
        distance, speed, _ = self.profile.at(times)
        axle, tangent, _ = self.path.at(distance + ahead)
        yaw, turn = self.path.bearings(distance + ahead)
        return *shifted(axle, speed[:, None] * tangent, yaw, turn * speed, -ahead), yaw, turn * speed

    def relative(self, moved, has_pitch: bool):
        """(times -> (place [N, 3] of another body's origin, velocity), times -> (turn [N], rate)) in the axes of the track.

        moved: of that body, times -> as of steered_by
        """
        def place(times):
            (own, own_velocity), (yaw, yaw_rate) = self.places(times), self.yaws(times)
            found, velocity, _, _ = moved(times)
            away, speed = found - own, velocity - own_velocity
            c, s, w = np.cos(yaw), np.sin(yaw), yaw_rate
            x, y = c * away[:, 0] + s * away[:, 1], c * away[:, 1] - s * away[:, 0]
            vx, vy = c * speed[:, 0] + s * speed[:, 1], c * speed[:, 1] - s * speed[:, 0]
            level = 0.0 if has_pitch else 1.0
            return (np.stack([x, y, level * away[:, 2]], axis=-1),
                    np.stack([vx + w * y, vy - w * x, level * speed[:, 2]], axis=-1))

        def turn(times):
            (yaw, rate), (own, own_rate) = moved(times)[2:], self.yaws(times)
            return yaw - own, rate - own_rate
        return place, turn

    def junctions_with(self, ahead: float):
        """Those times, and when a point so many m ahead passes the junctions of the path."""
        ends = self.profile.at(np.array([self.profile.begin, self.profile.end]))[0]
        axle = self.path.junctions - ahead
        passed = self.time_at(axle[(axle > ends[0]) & (axle < ends[1])])
        return np.unique(np.concatenate([self.junctions(), passed]))

    def junctions(self):
        """Times in s at which it may not be smooth: those of the profile, and when it passes those of the path."""
        knots, at_knots = self.profile.times, self.profile.at(self.profile.times)[0]
        passed = self.path.junctions[(self.path.junctions > at_knots[0]) & (self.path.junctions < at_knots[-1])]
        times = [knots, self.time_at(passed)]
        return np.unique(np.concatenate(times if self.headings is None else [*times, self.headings.times]))

    def time_at(self, distances):
        """First times [N] in s at which distances [N] are reached, to a nanosecond or so, by bisection."""
        knots = self.profile.times
        at_knots = self.profile.at(knots)[0]
        k = np.clip(np.searchsorted(at_knots, distances, side="left"), 1, len(knots) - 1) - 1
        begin, low, high = knots[k], knots[k], knots[k + 1]
        c = np.ascontiguousarray(self.profile.coefficients[k].T)
        for _ in range(60):
            middle = 0.5 * (low + high)
            t = middle - begin
            is_before = c[0] + t * (c[1] + t * (c[2] + t * c[3])) < distances
            low, high = np.where(is_before, middle, low), np.where(is_before, high, middle)
        return high

    def fine_times(self, step: float):
        """Times [N] in s no farther apart than `step` s where it moves or turns, with the begin and the end."""
        begins, ends = self.profile.moving()
        if self.headings is not None:
            turning = self.headings.moving()
            begins, ends = np.sort(np.append(begins, turning[0])), np.sort(np.append(ends, turning[1]))
            is_apart = begins[1:] > ends[:-1]   # the k-th begin follows the k-th end: no span holds the time between
            begins, ends = begins[np.append(True, is_apart)[:len(begins)]], ends[np.append(is_apart, True)[:len(ends)]]
        inside = [np.linspace(begin, end, int((end - begin) / step) + 2) for begin, end in zip(begins, ends)]
        return np.unique(np.concatenate([*inside, [self.profile.begin, self.profile.end]]))

    def steered(self, distances):
        """(angle in rad that wheels in the front steer by over the distance travelled, its change in rad/m), each [N]: what it
        turns to the left while it goes ahead, and to the right while it goes back."""
        if self.headings is None:
            return self.path.bearings(distances)
        return self._steered.at(distances)[:2]

    @cached_property
    def _steered(self) -> Profile:
        times = self._rolling_times()
        senses, turns = np.sign(self._speed_ahead(0.5 * (times[:-1] + times[1:]))), np.diff(self.yaws(times)[0])
        angles, distances = np.concatenate([[0.0], np.cumsum(senses * turns)]), self.profile.at(times)[0]
        grid = np.arange(distances[0], distances[-1], STEERING_STEP)
        kept = np.unique(np.append(np.searchsorted(distances, grid), len(distances) - 1))
        kept = kept[np.diff(distances[kept], append=np.inf) > 1e-6]
        distances, angles = distances[kept], angles[kept]
        if len(kept) == 1:  # stands all the time
            distances, angles = distances[0] + np.array([0.0, STEERING_STEP]), np.repeat(angles, 2)
        return Profile(distances, hermite_coefficients(np.diff(distances), angles, slopes_of(distances, angles)))

    def _rolling_times(self):
        """Times [N] in s between which what rolls is summed up."""
        return np.unique(np.concatenate([self.fine_times(ROLL_STEP), self.profile.times]))

    @cached_property
    def rolled(self) -> Profile:
        """The way ahead in m over time, as wheels roll it: backwards where it goes against the direction it looks in."""
        if self.headings is None:
            return self.profile
        times = self._rolling_times()
        middles = 0.5 * (times[:-1] + times[1:])
        ahead = [self._speed_ahead(at) for at in (times, middles)]
        steps = np.diff(times)
        ways = steps / 6.0 * (ahead[0][:-1] + 4.0 * ahead[1] + ahead[0][1:])
        ways = np.concatenate([[0.0], np.cumsum(ways)])
        return Profile(times, hermite_coefficients(steps, ways, ahead[0]))

    def _speed_ahead(self, times):
        distance, speed, _ = self.profile.at(times)
        return speed * np.cos(self.yaws(times)[0] - self.path.bearings(distance)[0])


def shifted(place, velocity, yaw, rate, ahead: float):
    """(place [N, 3], velocity) of the point that is so many m ahead of a place, as the body turns."""
    c, s, zero = np.cos(yaw), np.sin(yaw), 0.0 * yaw
    return (place + ahead * np.stack([c, s, zero], axis=-1),
            velocity + ahead * rate[:, None] * np.stack([-s, c, zero], axis=-1))
