"""The human walking model of Boulic, Thalmann and Thalmann.

R. Boulic, N. Magnenat-Thalmann, D. Thalmann, "A global human walking model with real-time kinematic personification",
The Visual Computer 6 (1990) 344-358. Everything depends on the relative speed v_R = speed / hip height and on the
phase of the cycle. Phase 0 is the heel strike of the leg concerned; the other leg lags by half a cycle. Below v_R =
0.5 and above 1.3 the amplitudes change with the speed; the model ends at v_R = 3, where walking turns into running.

Angles are in radians once they leave this file, lengths in units of the hip height.
"""
from dataclasses import dataclass

import numpy as np

from ..curves import PeriodicCurve

SLOW, FAST, LIMIT = 0.5, 1.3, 3.0   # bounds of the three gaits in relative speed


@dataclass(frozen=True)
class Cycle:
    """Durations and length of a cycle (two steps) at a relative speed and a hip height in m."""

    length: float     # m
    duration: float   # s
    support: float    # share of the cycle that a foot is on the floor

    @classmethod
    def of(cls, speed, hip_height):
        relative_length = 1.346 * np.sqrt(speed / hip_height)
        length = float(relative_length * hip_height)
        duration = length / speed
        return cls(length, duration, support_share(duration))


def support_share(duration):
    """Share of a cycle of `duration` s for which a foot stays on the floor."""
    return (0.752 * duration - 0.143) / duration


class Walk:
    """The trajectories of the model at one relative speed, each a smooth function of the phase (any shape).

    Limb angles (hip, knee, ankle, shoulder, elbow) are those of the limb whose heel strikes at phase 0, positive for
    flexion (thigh or arm forward, knee and elbow bent, toes up). Pelvis and thorax angles and lateral are those of a
    body whose right heel strikes at phase 0, with x forward, y left, z up: lean about y (forward positive), tilt
    about x (left side down negative), torsion and thorax about z.
    """

    def __init__(self, relative_speed, support):
        v = float(relative_speed)
        self._v = v
        self._gentle = min(v, SLOW)                                    # stops to grow at the end of the slow gait
        self._hurry = max(v - FAST, 0.0) / (LIMIT - FAST)              # 0 to 1 over the fast gait
        self._support = support
        self.hip, self.knee, self.ankle = (_radians(*points) for points in (self._hip(), self._knee(), self._ankle()))
        self.elbow = _radians(*self._elbow())
        self.thorax = _radians([0.1, 0.4, 0.6, 0.9], [-4 / 3 * v, 1.5 * v, 4 / 3 * v, -1.5 * v])
        self.tilt = PeriodicCurve.from_function(lambda phase: np.radians(1.66 * v) * _tilt_shape(phase))

    def vertical(self, phase):
        """Height of the pelvis relative to its highest point."""
        return 0.015 * self._v * (np.sin(2 * np.pi * (2 * phase - 0.35)) - 1.0)

    def lateral(self, phase):
        return -self._parabola(0.128) * np.sin(2 * np.pi * (phase - 0.1))

    def forward(self, phase):
        """Lead of the pelvis over its mean motion."""
        return -self._parabola(0.084) * np.sin(4 * np.pi * (phase + 0.625 - self._support))

    def lean(self, phase):
        return np.radians(self._parabola(8.0)) * (1.0 - np.sin(2 * np.pi * (2 * phase - 0.1)))

    def torsion(self, phase):
        return np.radians(4.0 * self._v) * np.cos(2 * np.pi * phase)

    def shoulder(self, phase):
        swing = 9.88 * self._v
        return np.radians(3.0 - swing / 2 - swing * np.cos(2 * np.pi * phase))

    def foot_opening(self):
        """Angle of a foot's axis to the walking direction, toes outwards."""
        return np.radians(8.5 - 1.4 * self._v)

    def _parabola(self, factor):
        return factor * self._gentle * (1.0 - self._gentle)

    def _hip(self):
        g, u = self._gentle, self._hurry
        return [-0.1 + 0.2 * u, 0.5, 0.9], [50 * g + 5 * u, -30 * g, 50 * g + 6 * u]

    def _knee(self):
        g, u = self._gentle, self._hurry
        return ([0.17 - 0.05 * u, 0.4, 0.75 - 0.05 * u, 1.0 - 0.03 * u],
                [3 + 22 * u, 3.0, 140 * g - 5 * u, 3 + 3 * u])

    def _ankle(self):
        g, u = self._gentle, self._hurry
        return ([0.0, 0.08, 0.5 - 0.1 * u, self._support, 0.85],
                [-3 + 5 * u, -30 * g - 3 + 4 * u, 22 * g - 3 - 3 * u, -34 * g - 3 - 8 * u, -3 + 5 * u])

    def _elbow(self):
        v, g, u = self._v, self._gentle, self._hurry
        middle = (min(max(v, SLOW), FAST) - SLOW) / (FAST - SLOW)
        return ([0.05, 0.5 + 0.01 * middle + 0.04 * u, 0.9 - 0.1 * u],
                [6 * g + 3 + 8 * middle - 6 * u, 34 * g + 3 + 24 * middle + 26 * u, 10 * g + 3 + 9 * middle - 6 * u])


def _radians(phases, degrees):
    order = np.argsort(phases)
    phases, degrees = np.asarray(phases, dtype=float)[order], np.asarray(degrees, dtype=float)[order]
    if phases[-1] - phases[0] > 1.0 - 1e-9:   # the first control point again, one period later
        phases, degrees = phases[:-1], degrees[:-1]
    return PeriodicCurve.through(phases, np.radians(degrees))


def _tilt_shape(phase):
    """Down to -2 and back on the side of the swinging leg: quick at the strike (0.15 of a cycle), slow afterwards."""
    half = np.mod(phase, 0.5)
    sign = np.where(np.mod(phase, 1.0) < 0.5, 1.0, -1.0)
    quick = np.cos(2 * np.pi * half / 0.3) - 1.0
    slow = -np.cos(2 * np.pi * (half - 0.15) / 0.7) - 1.0
    return sign * np.where(half < 0.15, quick, slow)
