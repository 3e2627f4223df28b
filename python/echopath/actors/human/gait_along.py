"""A gait that goes along a trajectory: its phase goes with the distance, and a foot that stands stays where it is.

The walker of gait.py goes straight ahead on a line. Here that line is laid along the path: a place x on it lies at the
distance s(x) along the path, and the sole that stands at x is put, as a whole, where the path is at s(x), turned as the path
is there. Between two steps the foot's place goes smoothly from one to the next, and the legs are bent to reach it. Steps are
as long as the model has them at the speed of that moment, shorter before and behind a stop, and a little stretched so that
a stop is reached with both feet on the floor.
"""
import numpy as np

from ...trajectories.profile import Profile, hermite_coefficients
from .gait import MIN_KNEE, Frames, bend_leg
from .rotations import about_y, about_z

STEP = 2.0**-8          # s, of the table of ways
SLOWEST = 0.2           # of the speed that the gait is made for: slower steps are not much shorter
END_WAY = 0.01          # m, over which the length of a step is taken at the ends
LEAST_ROOM = 0.3        # m, of a leg under a hip


class GaitAlong:
    """A Gait (gait.py) along a Track (trajectories/track.py)."""

    def __init__(self, gait, track):
        self._gait, self._track = gait, track
        self._body, self._length = gait.body, gait.cycle.length
        self._line, self._sources = self._laid()
        self._pelvis_height = gait.pelvis_height
        self._pelvis_height -= self._too_high()

    def frames(self, times):
        """Frames of every part, by name, at times [T], relative to the place and yaw of the track."""
        times = np.asarray(times, float)
        phase = self._line.at(times)[0] / self._length
        pelvis = self._pelvis(phase)
        parts = {"pelvis": pelvis, **self._gait._trunk(phase, pelvis)}
        for side, sign in (("left", 1.0), ("right", -1.0)):
            limbs = self._leg(times, phase, sign, pelvis)
            parts.update({f"leg_{side}/{name}": frames for name, frames in limbs.items()})
            limbs = self._gait._arm(phase, sign, parts["torso"])
            parts.update({f"arm_{side}/{name}": frames for name, frames in limbs.items()})
        return parts

    def _laid(self):
        """(Profile of the place on the gait's line in m over time, [2, N] places on the line and their distances)."""
        profile = self._track.profile
        count = int((profile.end - profile.begin) / STEP) + 2
        times = np.unique(np.concatenate([np.linspace(profile.begin, profile.end, count), profile.times]))
        distances, speeds, _ = profile.at(times)
        stretch = ((1.0 + SLOWEST**2) / ((speeds / self._gait.speed) ** 2 + SLOWEST**2)) ** 0.25
        steps = np.diff(times)
        way = np.concatenate([[0.0], np.cumsum(0.5 * (stretch[:-1] + stretch[1:]) * np.diff(distances))])
        stops = np.searchsorted(times, profile.stops()[0])
        line = self._whole_steps(way, stops)
        slopes = np.gradient(line, times) * (speeds > 0.0)
        moves = np.diff(distances) > 1e-12
        sources = np.stack([line, distances])[:, np.concatenate([[True], moves])]
        return Profile(times, hermite_coefficients(steps, line, slopes)), sources

    def _whole_steps(self, way, stops):
        """Places [N] on the line for ways [N], such that a whole number of steps lies between stops."""
        half = 0.5 * self._length
        counts = np.maximum(np.round(np.diff(way[stops]) / half), 1.0)
        both_down = 0.5 * (self._gait.steps.flat_begin + self._gait.cycle.support - 0.5)
        if self._gait.cycle.support < 0.5:      # of a run, whose feet are never down together: the middle of a stance
            both_down = 0.5 * self._gait.cycle.support
        at_stops = both_down * self._length + half * np.concatenate([[0.0], np.cumsum(counts)])
        return np.interp(way, way[stops], at_stops)

    def _distance_of(self, line):
        """Distances [...] along the path of places on the line; beyond its ends with steps as long as they are there."""
        places, distances = self._sources
        near = int(np.searchsorted(distances, min(distances[0] + END_WAY, distances[-1])))
        far = int(np.searchsorted(distances, max(distances[-1] - END_WAY, distances[0]), side="right")) - 1
        first = (distances[near] - distances[0]) / (places[near] - places[0])
        last = (distances[-1] - distances[far]) / (places[-1] - places[far])
        inside = np.clip(line, places[0], places[-1])
        return np.interp(inside, places, distances) + np.where(line < inside, first, last) * (line - inside)

    def _pelvis(self, phase):
        pelvis = self._gait._pelvis(phase, self._pelvis_height)
        return Frames(pelvis.origin - np.outer(phase * self._length, [1.0, 0.0, 0.0]), pelvis.rotation)

    def _foot(self, times, phase, sign):
        """Ankle [T, 3], pitch [T] and yaw [T] of a foot, relative to the place and yaw of the track."""
        own = phase - 0.5 if sign > 0 else phase
        ankle, pitch = self._gait.steps.at(own)
        cycle, support = np.floor(own), self._gait.cycle.support
        s = np.clip((own - cycle - support) / (1.0 - support), 0.0, 1.0)
        share = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        first = self._gait.lead + (cycle + (0.5 if sign > 0 else 0.0)) * self._length
        (place, yaw), (next_place, next_yaw) = (self._footprint(line) for line in (first, first + self._length))
        residual = np.stack([ankle[:, 0] - (cycle + share) * self._length,
                             sign * (ankle[:, 1] + 0.5 * self._body.step_width), ankle[:, 2]], axis=-1)
        yaw, place = yaw + share * (next_yaw - yaw), place + share[:, None] * (next_place - place)
        own_place, own_yaw = self._track.places(times)[0], self._track.yaws(times)[0]
        world = place - own_place + np.einsum("tij,tj->ti", about_z(yaw), residual)
        return np.einsum("tji,tj->ti", about_z(own_yaw), world), pitch, yaw - own_yaw

    def _footprint(self, line):
        """(points [T, 3], yaws [T]) of the path under places [T] on the line."""
        distances = self._distance_of(line)
        return self._track.path.points(distances), self._track.path.bearings(distances)[0]

    def _leg(self, times, phase, sign, pelvis):
        gait = self._gait
        hip = gait._hip(pelvis, sign)
        ankle, pitch, yaw = self._foot(times, phase, sign)
        yaw = yaw + sign * gait.steps.opening
        knee, thigh, shank = bend_leg(hip, ankle, self._body.thigh, self._body.shank, 0.5 * (gait.walk.torsion(phase) + yaw))
        return {"thigh": Frames(hip, thigh), "shank": Frames(knee, shank),
                "foot": Frames(ankle, about_z(yaw) @ about_y(-pitch))}

    def _too_high(self):
        """m by which the pelvis must be lower so that both feet can be reached at every time."""
        times = np.arange(self._track.profile.begin, self._track.profile.end + 0.005, 0.01)
        phase = self._line.at(times)[0] / self._length
        thigh, shank = self._body.thigh, self._body.shank
        reach = thigh**2 + shank**2 + 2.0 * thigh * shank * np.cos(MIN_KNEE)
        most = 0.0
        for sign in (1.0, -1.0):
            hip = self._gait._hip(self._pelvis(phase), sign)
            ankle = self._foot(times, phase, sign)[0]
            room = reach - (ankle[:, 0] - hip[:, 0]) ** 2 - (ankle[:, 1] - hip[:, 1]) ** 2
            allowed = ankle[:, 2] + np.sqrt(np.maximum(room, LEAST_ROOM**2))
            most = max(most, float(np.max(hip[:, 2] - allowed)))
        return most


def usual_speed(track) -> float:
    """m/s: the mean over the way, so that waiting does not count."""
    profile = track.profile
    times = np.linspace(profile.begin, profile.end, 2001)
    speeds = profile.at(times)[1]
    return float(np.sum(speeds**2) / max(np.sum(speeds), 1e-12))
