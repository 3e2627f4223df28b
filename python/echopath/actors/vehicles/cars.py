"""Passenger cars of the common classes."""
from __future__ import annotations

from typing import Literal

from ...arguments.checks import checked, flag, one_of, real
from ...trajectories.trajectory import Trajectory
from ..actor import Actor
from ..following import trajectory_rule
from .driving import Driving
from .outline import Outline
from .road_vehicle import drive

CarKind = Literal["small", "compact", "saloon", "estate", "suv"]

# Length, width without mirrors, height, wheelbase and tyres of production cars, from their makers' data sheets: Volkswagen
# up! (2011), Volkswagen Golf VII (2012), Mercedes-Benz C-Class W205 (2014), Volkswagen Passat B8 Variant (2014), Volkswagen
# Tiguan II (2016). The other lines are drawn to resemble such bodies.
CARS = {
    "small": Outline(3.540, 1.641, 1.489, 2.420, 0.60, 0.587, 0.165, 0.17, 0.76, 0.99, (0.93, 0.98), 0.62, 0.66,
                     tail_roof=0.96, tail_rake=0.14),
    "compact": Outline(4.255, 1.799, 1.452, 2.637, 0.85, 0.632, 0.205, 0.16, 0.77, 0.98, (0.91, 0.97), 0.72, 0.64,
                       tail_roof=0.95, tail_rake=0.24),
    "saloon": Outline(4.686, 1.810, 1.442, 2.840, 0.80, 0.657, 0.225, 0.15, 0.78, 0.98, (0.92, 0.98), 0.78, 0.62,
                      deck=1.09),
    "estate": Outline(4.767, 1.832, 1.477, 2.786, 0.87, 0.660, 0.215, 0.15, 0.78, 0.99, (0.93, 0.99), 0.76, 0.62,
                      tail_roof=0.96, tail_rake=0.23),
    "suv": Outline(4.486, 1.839, 1.643, 2.681, 0.87, 0.711, 0.215, 0.20, 0.96, 1.13, (1.04, 1.10), 0.74, 0.65,
                   tail_roof=0.96, tail_rake=0.20),
}


@checked(kind=one_of(CarKind), speed=real(unit="m/s"), drives=flag, trajectory=trajectory_rule)
def car(*, kind: CarKind = "compact", speed: float = 0.0, drives: bool = True,
        trajectory: Trajectory | None = None) -> Actor:
    """A passenger car of smooth metal panels on four turning wheels.

    Length, width, height, wheelbase and tyres are those of production cars (CARS in vehicles/cars.py); the panels are a
    subdivision surface through lines drawn to resemble such bodies. Windows, bumpers and lamps are opaque: what passes
    through them is not modelled; bumpers reflect what painted plastic before a metal beam is taken to reflect. About
    7500 triangles.

    Frame: x forward from the middle of the length, y left, z up, the road at z = 0.
    Parts: body/hood, body/roof, body/door_front_left and so on, body/fender_*, body/quarter_*, body/pillar_*, body/tailgate,
    body/mirror_*; glass/windscreen, glass/rear_window, glass/door_*; lamp/head_*, lamp/tail_*; bumper/front, bumper/grille,
    bumper/rear; plate/front, plate/rear; underside/floor, underside/arches; wheel/front_left/tyre, wheel/front_left/rim, and
    likewise front_right, rear_left and rear_right.

    kind: "small" 3.54 m long, "compact" 4.26 m, "saloon" 4.69 m, "estate" 4.77 m or "suv" 4.49 m.
    speed: m/s ahead along +x; the wheels roll. drives: False turns the wheels at `speed` alone, for a car that a motion of
    its node carries. trajectory: a Trajectory of the origin that it follows instead; the wheels roll its way, those in
    front steer.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    return drive(CARS[kind], Driving(speed, drives, trajectory))
