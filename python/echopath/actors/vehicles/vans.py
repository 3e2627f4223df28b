"""Panel vans."""
from __future__ import annotations

from typing import Literal

from ...arguments.checks import checked, flag, one_of, real
from ...trajectories.trajectory import Trajectory
from ..actor import Actor
from ..following import trajectory_rule
from .driving import Driving
from .outline import Outline
from .road_vehicle import drive

VanKind = Literal["small", "large"]

# Length, width without mirrors, height, wheelbase and tyres from their makers' data sheets: Volkswagen Transporter T6 (2015),
# Mercedes-Benz Sprinter of middle length (2006). The other lines are drawn to resemble such bodies.
VANS = {
    "small": Outline(4.904, 1.904, 1.990, 3.000, 0.92, 0.686, 0.215, 0.20, 1.08, 1.28, (1.15, 1.15), 0.74, 0.85,
                     tail_roof=0.985, tail_rake=0.08, glazed=False, levels=2),
    "large": Outline(5.910, 1.993, 2.435, 3.665, 1.00, 0.712, 0.235, 0.21, 1.20, 1.44, (1.28, 1.28), 0.84, 0.85,
                     tail_roof=0.985, tail_rake=0.06, glazed=False, levels=2),
}


@checked(kind=one_of(VanKind), speed=real(unit="m/s"), drives=flag, trajectory=trajectory_rule)
def van(*, kind: VanKind = "large", speed: float = 0.0, drives: bool = True,
        trajectory: Trajectory | None = None) -> Actor:
    """A panel van of smooth metal panels on four turning wheels, without windows behind the front doors.

    Made as `car` is, whose frame, parts and arguments it shares; body/panel_left and body/panel_right are the walls behind
    the doors. About 22 000 triangles.
    kind: "small" 4.90 m long and 1.99 m high, or "large" 5.91 m and 2.44 m.
    speed: m/s ahead along +x; the wheels roll. drives: False turns the wheels at `speed` alone.
    trajectory: a Trajectory of the origin that it follows instead; the wheels roll its way, those in front steer.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    return drive(VANS[kind], Driving(speed, drives, trajectory))
