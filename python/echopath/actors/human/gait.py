"""Joint positions and orientations of a walking body over time.

The pelvis, the trunk and the arms follow the walking model (boulic.py); the feet are planted (steps.py) and the legs
are bent so that they reach them. Two numbers are left to choose: the height of the pelvis is the greatest that no leg
needs to be straighter than MIN_KNEE for, and the feet are planted that far ahead of the hips that the pelvis can be
highest. Axes of the actor: x forward, y left, z up, floor at z = 0.
"""
import numpy as np

from ...base.numerics.rotations import about_x, about_y, about_z
from ..keyframes import Frames
from .boulic import LIMIT, Cycle, Walk
from .foot import Sole
from .posture import bend_leg, hanging_arm, trunk
from .steps import Steps

MIN_KNEE = np.radians(7.0)     # least bend of a knee: near a straight leg its rate has no bound
PELVIS_EARLIER = 0.03          # phase by which the pelvis rises earlier than in the model, as a planted leg allows
HAND_PITCH = np.radians(8.0)   # of the hands forward, against the forearms
SEARCH_PHASES = 400            # per cycle, in the search for the pelvis height
LEADS = np.linspace(0.10, 0.30, 81)   # tried distances from hips to the flat ankle at its strike, in cycle lengths


class Gait:
    """A walk at `speed` m/s of a body (anthropometry.Proportions). Phase 0 is the heel strike of the right foot."""

    def __init__(self, body, speed):
        self.body, self.speed = body, float(speed)
        self.cycle, self.walk, self.steps = self._model()
        self.lead, self.pelvis_height = self._fit_pelvis()

    def _model(self):
        """Cycle, trajectories and steps of walking."""
        cycle = Cycle.of(self.speed, self.body.hip_height)
        walk = Walk(self.speed / self.body.hip_height, cycle.support)
        return cycle, walk, Steps(Sole.of(self.body), walk, cycle)

    def frames(self, phase):
        """Frames of every part, by name, at phases [T].

        The pelvis is at x = phase * cycle length but for its oscillation.
        """
        phase = np.asarray(phase, dtype=float)
        pelvis = self._pelvis(phase, self.pelvis_height)
        parts = self._trunk(phase, pelvis)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            parts.update(_prefixed(f"leg_{side}/", self._leg(phase, sign, pelvis)))
            parts.update(_prefixed(f"arm_{side}/", self._arm(phase, sign, parts["torso"])))
        return parts

    def _pelvis(self, phase, height):
        scale, walk = self.body.hip_height, self.walk
        origin = np.stack([phase * self.cycle.length + scale * walk.forward(phase), scale * walk.lateral(phase),
                           height + scale * walk.vertical(phase + PELVIS_EARLIER)], axis=-1)
        return Frames(origin, about_z(walk.torsion(phase)) @ about_x(walk.tilt(phase)))

    def _hip(self, pelvis, sign):
        return pelvis.origin + pelvis.rotation @ np.array([0.0, sign * self.body.hip_offset, 0.0])

    def _foot(self, phase, sign, lead):
        """Ankle [T, 3] in actor axes and pitch [T] of a foot."""
        own = _own_phase(phase, sign)
        ankle, pitch = self.steps.at(own)
        ankle[:, 0] += lead + (phase - own)[0] * self.cycle.length
        ankle[:, 1] = sign * (ankle[:, 1] + self.body.step_width / 2)
        return ankle, pitch

    def _fit_pelvis(self):
        """Lead of the planted ankle over the pelvis at the strike, and height of the pelvis at its highest, in m."""
        phase = np.arange(SEARCH_PHASES) / SEARCH_PHASES
        hip = self._hip(self._pelvis(phase, 0.0), -1.0)
        ankle, _ = self._foot(phase, -1.0, 0.0)
        thigh, shank = self.body.thigh, self.body.shank
        reach = thigh**2 + shank**2 + 2 * thigh * shank * np.cos(MIN_KNEE)
        ahead = ankle[None, :, 0] + LEADS[:, None] * self.cycle.length - hip[:, 0]
        room = np.maximum(reach - ahead**2 - (ankle[:, 1] - hip[:, 1]) ** 2, 0.0)
        heights = np.min(ankle[:, 2] + np.sqrt(room) - hip[:, 2], axis=1)
        best = int(np.argmax(heights))
        return LEADS[best] * self.cycle.length, heights[best]

    def _leg(self, phase, sign, pelvis):
        hip = self._hip(pelvis, sign)
        ankle, pitch = self._foot(phase, sign, self.lead)
        opening = sign * self.steps.opening
        heading = (self.walk.torsion(phase) + opening) / 2
        knee, thigh, shank = bend_leg(hip, ankle, self.body.thigh, self.body.shank, heading)
        foot = about_z(np.full_like(phase, opening)) @ about_y(-pitch)
        return {"thigh": Frames(hip, thigh), "shank": Frames(knee, shank), "foot": Frames(ankle, foot)}

    def _trunk(self, phase, pelvis):
        return trunk(self.body, pelvis, self.walk.lean(phase), yaw=self.walk.thorax(phase))

    def _arm(self, phase, sign, torso):
        own = _own_phase(phase, sign)
        return hanging_arm(self.body, torso, sign, swing=self.walk.shoulder(own), elbow=self.walk.elbow(own),
                           hand_pitch=HAND_PITCH)


def relative_speed_limit(body):
    """Greatest walking speed in m/s that the model covers."""
    return LIMIT * body.hip_height


def _own_phase(phase, sign):
    """Phase of the limbs of one side: those on the left (sign 1) lag by half a cycle."""
    return phase - 0.5 if sign > 0 else phase


def _prefixed(prefix, frames):
    return {prefix + name: value for name, value in frames.items()}
