"""The sole: a convex profile (heel arc, flat, toe arc) that rolls over the floor without sliding.

The profile lies in the foot's vertical plane: origin at the ankle joint, x towards the toes, z up. With the foot flat
the floor is at z = -ankle_height. Pitch is positive with the toes up; positive pitch rests on the heel arc, negative
on the toe arc.
"""
from dataclasses import dataclass

import numpy as np

from ..curves import quintic
from .anthropometry import FOOT_LENGTH

HEEL_SHARE = 0.27                    # of the foot's length lies behind the ankle
MAX_TOE_PITCH = np.radians(75.0)     # angle of the toe arc, which ends at the tip of the foot


@dataclass(frozen=True)
class Sole:
    """All in m. heel_center_x, toe_center_x: centres of the arcs, which are also the ends of the flat."""

    ankle_height: float
    heel_center_x: float
    heel_radius: float
    toe_center_x: float
    toe_radius: float

    @classmethod
    def of(cls, body):
        """The sole of a body (anthropometry.Proportions)."""
        length, heel_radius, toe_radius = body.of(FOOT_LENGTH), body.of(0.020), body.of(0.022)
        heel_end = -HEEL_SHARE * length
        toe_end = heel_end + length
        toe_center = float(toe_end - toe_radius * np.sin(MAX_TOE_PITCH))
        return cls(body.ankle_height, heel_end + heel_radius, heel_radius, toe_center, toe_radius)

    def ankle_above_floor(self, pitch):
        """Height [...] of the ankle when the foot rests on the floor with this pitch [...]."""
        x, z, radius = self._arc(pitch)
        return radius - (x * np.sin(pitch) + z * np.cos(pitch))

    def ankle_lead(self, pitch):
        """Distance [...] by which the ankle leads its place over the flat foot, after rolling to this pitch [...]."""
        x, z, radius = self._arc(pitch)
        return x - radius * pitch - (x * np.cos(pitch) - z * np.sin(pitch))

    def ankle_clear_of_floor(self, pitch, lowest, highest):
        """As ankle_above_floor, but twice continuously differentiable also where a foot in the air passes pitch 0.

        Between the pitches `lowest` < 0 < `highest`, where the support jumps from toe to heel, a polynomial goes
        round the corner above it.
        """
        width = highest - lowest
        ends = [self._height_jet(end, width) for end in (lowest, highest)]
        s = (np.asarray(pitch, dtype=float) - lowest) / width
        return np.where((s > 0) & (s < 1), quintic(s, *ends), self.ankle_above_floor(pitch))

    def profile(self, x):
        """Height [N] of the sole above the floor under the flat foot at x [N], from the heel's end to the toe's tip."""
        x = np.asarray(x, dtype=float)
        behind = np.clip(self.heel_center_x - x, 0.0, self.heel_radius)
        ahead = np.clip(x - self.toe_center_x, 0.0, self.toe_radius)
        return (self.heel_radius - np.sqrt(self.heel_radius**2 - behind**2)
                + self.toe_radius - np.sqrt(self.toe_radius**2 - ahead**2))

    @property
    def heel_end(self):
        return self.heel_center_x - self.heel_radius

    @property
    def toe_end(self):
        return self.toe_center_x + self.toe_radius * np.sin(MAX_TOE_PITCH)

    def _arc(self, pitch):
        heel = np.asarray(pitch) > 0
        radius = np.where(heel, self.heel_radius, self.toe_radius)
        return np.where(heel, self.heel_center_x, self.toe_center_x), radius - self.ankle_height, radius

    def _height_jet(self, pitch, width):
        x, z, radius = self._arc(pitch)
        drop, slope = x * np.sin(pitch) + z * np.cos(pitch), -(x * np.cos(pitch) - z * np.sin(pitch))
        return radius - drop, slope * width, drop * width**2
