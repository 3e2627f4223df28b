"""Lengths of the body's segments.

Fractions of the body height after R. Drillis and R. Contini, "Body segment parameters" (New York University, 1966), as
reprinted in D. A. Winter, "Biomechanics and Motor Control of Human Movement" (4th ed. 2009, figure 4.1).

Heads of children after R. G. Snyder and others, "Anthropometry of infants, children, and youths to age 18 for product safety
design" (UM-HSRI-77-17, 1977): medians of boys and girls of 2 to 13 years over the heights of their ages in the British reference
of 1990 (T. J. Cole, J. V. Freeman and M. A. Preece), on which these lines lie to 2 mm.
"""
from dataclasses import dataclass

HIP_HEIGHT = 0.530        # hip joint above the floor
KNEE_HEIGHT = 0.285
ANKLE_HEIGHT = 0.039
SHOULDER_HEIGHT = 0.818
CHIN_HEIGHT = 0.870
UPPER_ARM = 0.186
FOREARM = 0.146
FOOT_LENGTH = 0.152
FOOT_BREADTH = 0.055
SHOULDER_BREADTH = 0.259  # over the deltoids
HIP_BREADTH = 0.191       # over the skin
CHEST_BREADTH = 0.174
HEAD_JOINT = CHIN_HEIGHT + 0.015   # joint of neck and head
HEAD_SIZE = (0.1132, 0.0875, 1.0 - CHIN_HEIGHT)   # length, breadth and height of the head, as body.py has it

# m, length, breadth and height of a child's head, and how they grow with the body height
CHILD_HEAD, CHILD_HEAD_GROWTH = (0.1593, 0.1141, 0.1319), (0.0189, 0.0213, 0.0451)


@dataclass(frozen=True)
class Proportions:
    """Lengths in m of a body of `height` m that stands upright; x forward, y left, z up."""

    height: float

    def of(self, fraction):
        """A length below the head, given as a fraction of the body height of an adult of the same build."""
        return fraction * self.height

    @property
    def head(self):
        """(length, breadth, height) of the head over those of an adult of the same build below it."""
        return 1.0, 1.0, 1.0

    @property
    def thigh(self):
        return self.of(HIP_HEIGHT - KNEE_HEIGHT)

    @property
    def shank(self):
        return self.of(KNEE_HEIGHT - ANKLE_HEIGHT)

    @property
    def ankle_height(self):
        return self.of(ANKLE_HEIGHT)

    @property
    def hip_height(self):
        return self.of(HIP_HEIGHT)

    @property
    def upper_arm(self):
        return self.of(UPPER_ARM)

    @property
    def forearm(self):
        return self.of(FOREARM)

    @property
    def hip_offset(self):
        """Half the distance between the hip joints, which lie well inside the skin."""
        return self.of(0.26 * HIP_BREADTH)

    @property
    def shoulder_offset(self):
        """Half the distance between the shoulder joints: an upper arm's half breadth inside the skin."""
        return self.of(SHOULDER_BREADTH / 2 - 0.024)

    @property
    def spine_base(self):
        """Height of the joint of torso and pelvis above the hip joints."""
        return self.of(0.05)

    @property
    def shoulder_above_spine_base(self):
        return self.of(SHOULDER_HEIGHT - HIP_HEIGHT) - self.spine_base

    @property
    def neck_above_spine_base(self):
        """Height of the neck's lower joint above the spine base."""
        return self.shoulder_above_spine_base + self.of(0.005)

    @property
    def neck(self):
        """From the neck's lower joint to the joint of neck and head, a little above the chin."""
        return self.of(HEAD_JOINT - SHOULDER_HEIGHT - 0.005)

    @property
    def step_width(self):
        """Lateral distance of the ankles in walking."""
        return self.of(0.06)


@dataclass(frozen=True)
class ChildProportions(Proportions):
    """Of a child of `height` m, 0.8 to 1.5: the head is as large as measured, the rest is a smaller adult of what is left."""

    def of(self, fraction):
        top = (1.0 - HEAD_JOINT) / HEAD_SIZE[2] * self._head_size[2]   # of the head, above its joint
        return fraction * (self.height - top) / HEAD_JOINT

    @property
    def head(self):
        return tuple(size / self.of(share) for size, share in zip(self._head_size, HEAD_SIZE))

    @property
    def _head_size(self):
        return [size + growth * self.height for size, growth in zip(CHILD_HEAD, CHILD_HEAD_GROWTH)]
