"""A gait that goes along a trajectory: its phase goes with the distance, and a foot that stands stays where it is.

The walker of gait.py goes straight ahead on a line, which is laid along the path (laid_line.py). The sole that stands at a
place of it is put, as a whole, where the path is there, turned as the path is. Between two steps the foot's place goes smoothly
from one to the next, and the legs are bent to reach it. A stop is reached with both feet on the floor.
"""
import numpy as np

from ...arguments.checks import refused
from ...base.numerics.rotations import about_y, about_z
from ..keyframes import Frames
from ..laid_line import LaidLine
from .gait import MIN_KNEE
from .posture import bend_leg

LEAST_ROOM = 0.3        # m, of a leg under a hip


class GaitAlong:
    """A Gait (gait.py) along a Track (trajectories/track.py); has_pitch: whether the person leans with the slope of the path."""

    def __init__(self, gait, track, has_pitch=False):
        self._gait, self._track, self._has_pitch = gait, track, has_pitch
        self._body, self._length = gait.body, gait.cycle.length
        self._laid = LaidLine(track, gait.speed, 0.5 * self._length, self._both_down() * self._length)
        self._line = self._laid.line
        self._pelvis_height = gait.pelvis_height
        self._pelvis_height -= self._too_high()

    def frames(self, times):
        """Frames of every part, by name, at times [T], relative to the place and axes of the track."""
        times = np.asarray(times, float)
        phase = self._line.at(times)[0] / self._length
        pelvis = self._pelvis(phase)
        parts = self._gait._trunk(phase, pelvis)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            limbs = self._leg(times, phase, sign, pelvis)
            parts.update({f"leg_{side}/{name}": frames for name, frames in limbs.items()})
            limbs = self._gait._arm(phase, sign, parts["torso"])
            parts.update({f"arm_{side}/{name}": frames for name, frames in limbs.items()})
        return parts

    def _both_down(self):
        """Phase at which both feet are on the floor; of a run, whose feet are never down together: the middle of a stance."""
        support = self._gait.cycle.support
        return 0.5 * support if support < 0.5 else 0.5 * (self._gait.steps.flat_begin + support - 0.5)

    def _pelvis(self, phase):
        pelvis = self._gait._pelvis(phase, self._pelvis_height)
        return Frames(pelvis.origin - np.outer(phase * self._length, [1.0, 0.0, 0.0]), pelvis.rotation)

    def _foot(self, times, phase, sign):
        """Ankle [T, 3], pitch [T] and yaw [T] of a foot, relative to the place and axes of the track."""
        own = phase - 0.5 if sign > 0 else phase
        ankle, pitch = self._gait.steps.at(own)
        cycle, support = np.floor(own), self._gait.cycle.support
        s = np.clip((own - cycle - support) / (1.0 - support), 0.0, 1.0)
        share = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        first = self._gait.lead + (cycle + (0.5 if sign > 0 else 0.0)) * self._length
        (place, yaw), (next_place, next_yaw) = (self._laid.footprints(line) for line in (first, first + self._length))
        residual = np.stack([ankle[:, 0] - (cycle + share) * self._length,
                             sign * (ankle[:, 1] + 0.5 * self._body.step_width), ankle[:, 2]], axis=-1)
        yaw = yaw + share * (next_yaw - yaw) - self._track.yaws(times)[0]
        away = place + share[:, None] * (next_place - place) - self._track.places(times)[0]
        ankle = np.einsum("tji,tj->ti", self._track.axes(times, self._has_pitch)[0], away)
        return ankle + np.einsum("tij,tj->ti", about_z(yaw), residual), pitch, yaw

    def _leg(self, times, phase, sign, pelvis):
        gait = self._gait
        hip = gait._hip(pelvis, sign)
        ankle, pitch, yaw = self._foot(times, phase, sign)
        self._require_reach(times, hip - ankle)
        opening = sign * gait.steps.opening
        # Half-way from the pelvis to the foot, but ahead for those who look aside or back; yaws may be whole turns apart.
        heading = 0.5 * (gait.walk.torsion(phase) + opening + np.sin(yaw))
        knee, thigh, shank = bend_leg(hip, ankle, self._body.thigh, self._body.shank, heading)
        return {"thigh": Frames(hip, thigh), "shank": Frames(knee, shank),
                "foot": Frames(ankle, about_z(yaw + opening) @ about_y(-pitch))}

    def _too_high(self):
        """m by which the pelvis must be lower so that both feet can be reached at every time."""
        times = np.arange(self._track.profile.begin, self._track.profile.end + 0.005, 0.01)
        moves = self._track.profile.at(times)[1] > 0.0
        moves[1:] |= moves[:-1]             # with the first time of each standing, at which nothing changes any more
        moves[0] = True
        times = times[moves]
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

    def _require_reach(self, times, legs):
        """Raises ValueError naming trajectory where the ways [T, 3] in m from hips to ankles are longer than legs."""
        lengths = np.linalg.norm(legs, axis=-1)
        time = times[np.argmax(lengths)]
        if lengths.max() <= self._body.thigh + self._body.shank:
            return
        speed = float(self._track.profile.at(np.array([time]))[1][0])
        rule = (f"one along which the legs of a person of {self._body.height:g} m, who mostly goes at "
                f"{self._gait.speed:.3g} m/s, reach the ground")
        raise refused(ValueError, "trajectory", rule, f"{speed:.3g} m/s at {time:.4g} s")
