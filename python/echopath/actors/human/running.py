"""Running: a gait with flight between the steps, on feet that do not slide while they stand.

Step frequency, contact and flight, joint angles at characteristic instants follow what T. F. Novacheck, "The biomechanics of
running", Gait and Posture 7 (1998) 77-95, and G. A. Cavagna et al., J. Physiol. 399 (1988) 81-92, tell of adults on level
ground (figures quoted from memory): 2.7 steps a second at 3 m/s, feet on the floor for 0.39 of a cycle at 3.2 m/s and less
at higher speeds, the knee bent by about 45 deg at midstance and by 90 to 110 deg in swing, elbows at right angles. Between
these the trajectories are sines.
"""
import numpy as np

from .anthropometry import ANKLE_HEIGHT
from .boulic import Cycle
from .foot import Sole
from .gait import Gait
from .steps import Steps

SPEEDS = (1.8, 5.0)                      # m/s, of an adult of 1.78 m; others by the root of their height
STEP_FREQUENCY = (2.35, 0.13)            # 1/s at rest, and how it grows with the speed, 1/m
SUPPORT = (0.505, -0.044, 0.20)          # share of a cycle on the floor at rest, its change with the speed, its least
REFERENCE_HIP_HEIGHT = 0.530 * 1.78      # m, of the adults concerned
BOUNCE = 0.038                           # m, amplitude of the pelvis's height over a step
TOE_LIFT, HEEL_LIFT = 0.155, 0.035       # rise of the foot early and late in swing, in body heights


class Run:
    """The trajectories of running at a speed in m/s of an adult; the interface is that of boulic.Walk."""

    def __init__(self, speed, support):
        self._speed, self._support = speed, support
        self._bounce = BOUNCE / REFERENCE_HIP_HEIGHT

    def vertical(self, phase):
        """Lowest at midstance, highest in flight, twice a cycle."""
        return -self._bounce * (1.0 + np.cos(4.0 * np.pi * (phase - 0.5 * self._support)))

    def lateral(self, phase):
        return 0.008 * np.cos(2.0 * np.pi * (phase - 0.5 * self._support)) * -1.0

    def forward(self, phase):
        """Brakes in the first half of stance, drives in the second."""
        return 0.010 * np.sin(4.0 * np.pi * (phase - 0.5 * self._support))

    def lean(self, phase):
        return np.radians(5.0 + self._speed) + np.radians(2.0) * np.cos(4.0 * np.pi * (phase - 0.5 * self._support))

    def torsion(self, phase):
        return np.radians(7.0) * np.cos(2.0 * np.pi * (phase - 0.1))

    def tilt(self, phase):
        """The pelvis drops on the side of the swinging leg: right leg on the floor, left side down."""
        return -np.radians(4.0) * np.cos(2.0 * np.pi * (phase - 0.5 * self._support))

    def thorax(self, phase):
        return -np.radians(12.0) * np.cos(2.0 * np.pi * (phase - 0.1))

    def shoulder(self, phase):
        """The right arm is back at the strike of the right foot."""
        return np.radians(-8.0 - (25.0 + 2.5 * self._speed) * np.cos(2.0 * np.pi * (phase - 0.02)))

    def elbow(self, phase):
        return np.radians(95.0 - 14.0 * np.cos(2.0 * np.pi * (phase - 0.05)))

    def foot_opening(self):
        return np.radians(5.0)


class RunningSteps(Steps):
    """Feet that land nearly flat, roll over their toes, and are drawn up behind the body in swing."""

    flat_begin = 0.05
    detour = (-0.06, -0.28)
    pitch_detour = (0.35, -0.5)
    strike = np.radians(8.0)
    toe_off = np.radians(-55.0)

    def __init__(self, sole, run, cycle):
        self.heel_off = 0.42 * cycle.support
        share = sole.ankle_height / ANKLE_HEIGHT / cycle.length    # the body's height in cycle lengths
        self.toe_lift, self.heel_lift = (TOE_LIFT * share, 3.0, 4.5), (HEEL_LIFT * share, 5.0, 3.0)
        super().__init__(sole, run, cycle)

    def _bounds(self, walk):
        return self.strike, self.toe_off


class RunningGait(Gait):
    """A run at `speed` m/s of a body (anthropometry.Proportions). Phase 0 is the strike of the right foot."""

    def _model(self):
        scale = np.sqrt(self.body.hip_height / REFERENCE_HIP_HEIGHT)
        speed = self.speed / scale
        frequency = (STEP_FREQUENCY[0] + STEP_FREQUENCY[1] * speed) / scale
        support = max(SUPPORT[0] + SUPPORT[1] * speed, SUPPORT[2])
        cycle = Cycle(length=2.0 * self.speed / frequency, duration=2.0 / frequency, support=support)
        run = Run(speed, support)
        return cycle, run, RunningSteps(Sole.of(self.body), run, cycle)


def running_speeds(body):
    """Least and greatest speed in m/s."""
    scale = float(np.sqrt(body.hip_height / REFERENCE_HIP_HEIGHT))
    return round(SPEEDS[0] * scale, 3), round(SPEEDS[1] * scale, 3)
