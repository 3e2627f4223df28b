"""How a vehicle drives: straight ahead at a speed, or along a trajectory; its wheels roll."""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from ... import _core
from ..following import Wheels, refuse_beside_trajectory, wheels_along


@dataclass(frozen=True)
class Driving:
    """speed: m/s along +x, at which wheels roll; drives: whether it goes ahead, too, or its wheels turn alone; trajectory:
    instead of them what the whole follows, or None."""

    speed: float = 0.0
    drives: bool = True
    trajectory: Any = None

    def __post_init__(self):
        refuse_beside_trajectory(self.trajectory, speed=(self.speed, 0.0), drives=(self.drives, True))

    @property
    def ahead(self):
        """m/s at which its parts move in its own frame."""
        return self.speed if self.drives else 0.0

    def carried(self, parts):
        """Parts that move along +x."""
        if self.ahead == 0.0:
            return parts
        motion = _core.LinearMotion(velocity=(self.ahead, 0.0, 0.0))
        return [replace(part, motion=motion) for part in parts]

    def wheel(self, radius, *, center=(0.0, 0.0, 0.0), wheelbase=None):
        """The motion of a wheel of a radius in m at `center` [3] m that rolls without slipping; None at rest.

        wheelbase: m, of a wheel that steers along a trajectory, or None
        """
        if self.trajectory is not None:
            return _core.CurveMotion(rotation=self._wheels.curve(radius, center, wheelbase))
        if self.speed == 0.0:
            return None
        return _core.LinearMotion(velocity=(self.ahead, 0.0, 0.0), angular_velocity=(0.0, self.speed / radius, 0.0))

    @cached_property
    def _wheels(self) -> Wheels:
        return wheels_along(self.trajectory)
