"""A motorcycle with its rider."""
from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ... import _core
from ...arguments.checks import checked, flag, real
from ...base.numerics.rotations import about_y
from ...trajectories.trajectory import Trajectory
from ..actor import Actor, Part
from ..following import trajectory_rule
from ..human.anthropometry import Proportions
from ..human.pedestrian import body_arrays
from ..human.posture import leg, reaching_arm, trunk
from ..keyframes import Frames
from ..lattice import rounded_box, rounded_parts
from ..shapes import ellipsoid
from ..solids import tube
from ..surfaces import joined
from .driving import Driving
from .fittings import leaning_plate
from .materials import LAMP, UNDERSIDE
from .wheel import Wheel, wheel_parts

# Wheelbase, tyres, seat height and overall width of a naked motorcycle of the middle class (Yamaha MT-07, 2014: 2085 mm x
# 745 mm x 1090 mm, wheelbase 1400 mm, seat 805 mm, tyres 120/70 ZR 17 and 180/55 ZR 17); the shapes between are drawn.
WHEELBASE, SEAT_HEIGHT = 1.40, 0.805     # m
FRONT_WHEEL = Wheel(0.600, 0.120, 0.44, num_spokes=5, spoke_width=0.04)
REAR_WHEEL = Wheel(0.630, 0.180, 0.44, num_spokes=5, spoke_width=0.04)
FRONT_AXLE, REAR_AXLE = 0.5 * WHEELBASE, -0.5 * WHEELBASE
HEAD = np.array([0.40, 0.0, 0.92])       # the steering head
GRIP = np.array([0.28, 0.33, 1.04])
FOOT_REST = np.array([-0.16, 0.22, 0.36])
HIP_ABOVE_SEAT = 0.055                   # in body heights


@checked(speed=real(unit="m/s"), rider=flag, height=real(1.45, 2.0, unit="m"), drives=flag, trajectory=trajectory_rule)
def motorcycle(*, speed: float = 0.0, rider: bool = True, height: float = 1.78, drives: bool = True,
               trajectory: Trajectory | None = None) -> Actor:
    """A naked motorcycle, 2 m long, with or without its rider.

    Frame: x forward, y left, z up, the road at z = 0, the origin between the wheels.
    Parts: body/tank, body/seat, body/engine, body/frame, body/exhaust, body/fork, body/handlebar, body/mudguard, lamp/head,
    lamp/tail, plate/rear, wheel/front/tyre, wheel/front/rim, wheel/rear/tyre, wheel/rear/rim, and the body parts of
    `pedestrian` under rider/, whose head wears no helmet of its own.
    speed: m/s ahead along +x; the wheels roll. rider: False leaves it out; height: of the rider in m, 1.45 to 2.
    drives: False turns the wheels at `speed` alone. trajectory: a Trajectory of the origin that it follows instead, upright;
    the wheels roll its way.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    still = [*_at_rest(), *(_rider(Proportions(height)) if rider else [])]
    driving = Driving(speed, drives, trajectory)
    parts = driving.carried(still)
    for end, x, wheel in (("front", FRONT_AXLE, FRONT_WHEEL), ("rear", REAR_AXLE, REAR_WHEEL)):
        parts += wheel_parts(wheel, f"wheel/{end}", (x, 0.0, wheel.radius), driving)
    return Actor(parts, trajectory)


@lru_cache(maxsize=1)
def _at_rest():
    """All but wheels and rider, which motorcycles share: a tuple of parts."""
    return (*_body(), *_tubes())


def _body():
    tank = ellipsoid((0.30, 0.155, 0.15), edge=0.035)
    seat = rounded_parts(rounded_box((-0.72, -0.13, 0.74), (0.05, 0.13, 0.83), 0.03, (6, 3, 1)), lambda face: "body/seat",
                         {"body": "plastic"})
    engine = rounded_parts(rounded_box((-0.22, -0.22, 0.26), (0.28, 0.22, 0.62), 0.05, (3, 3, 3)), lambda face: "body/engine",
                           {"body": UNDERSIDE})
    return [*seat, replace(engine[0], smooth=False),
            Part("body/tank", tank, "metal", None, (0.16, 0.0, 0.86), smooth=True),
            Part("lamp/head", ellipsoid((0.09, 0.10, 0.10), edge=0.02), LAMP, None, (0.52, 0.0, 0.88)),
            Part("lamp/tail", ellipsoid((0.05, 0.06, 0.03), edge=0.02), LAMP, None, (-0.78, 0.0, 0.83)),
            leaning_plate("plate/rear", -0.90, 0.73, -1.0, (0.18, 0.18))]


def _tubes():
    front, rear = np.array([FRONT_AXLE, 0, FRONT_WHEEL.radius]), np.array([REAR_AXLE, 0, REAR_WHEEL.radius])
    pivot = np.array([-0.18, 0.0, 0.42])
    fork, frame, bars = [], [], []
    for sign in (1.0, -1.0):
        side = np.array([0.0, sign, 0.0])
        fork.append(tube(front + 0.10 * side, HEAD + [0, 0, 0.08] + 0.10 * side, 0.026, 0.022, segments=12))
        frame += [tube(rear + 0.13 * side, pivot + 0.10 * side, 0.025, segments=12),
                  tube(HEAD + 0.03 * side, pivot + 0.12 * side, 0.022, segments=12),
                  tube(pivot + [0, 0, 0.12] + 0.10 * side, np.array([-0.75, 0, 0.78]) + 0.08 * side, 0.016, segments=12),
                  tube(pivot + 0.1 * side, (FOOT_REST - [0, 0, 0.015]) * [1, sign, 1] + 0.06 * side, 0.012, segments=8)]
        bars.append(tube(HEAD + [-0.02, 0.05 * sign, 0.14], GRIP * [1, sign, 1] + 0.06 * side, 0.014, segments=10))
    frame.append(tube((-0.74, 0.0, 0.79), (-0.895, 0.0, 0.74), 0.012, segments=8))
    exhaust = [tube((0.22, -0.12, 0.25), (-0.30, -0.16, 0.22), 0.03, segments=14),
               tube((-0.30, -0.16, 0.22), (-0.62, -0.18, 0.33), 0.055, segments=16)]
    guard = ellipsoid((0.20, 0.07, 0.05), edge=0.03)
    return [Part("body/fork", _core.Mesh(*joined(*fork)), "metal", smooth=True),
            Part("body/frame", _core.Mesh(*joined(*frame)), "metal", smooth=True),
            Part("body/handlebar", _core.Mesh(*joined(*bars)), "metal", smooth=True),
            Part("body/exhaust", _core.Mesh(*joined(*exhaust)), "metal", smooth=True),
            Part("body/mudguard", guard, "plastic", None, (FRONT_AXLE - 0.05, 0.0, 0.64), smooth=True)]


def _rider(body):
    still = np.zeros(1)
    pelvis = Frames(np.array([[-0.22, 0.0, SEAT_HEIGHT + body.of(HIP_ABOVE_SEAT)]]), about_y(still + np.radians(8.0)))
    frames = trunk(body, pelvis, still + np.radians(24.0))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        ankle = (FOOT_REST * [1, sign, 1] + [-0.09, 0.0, body.ankle_height])[None]
        wrist = (GRIP * [1, sign, 1] + [-0.07, 0.0, 0.035])[None]
        frames.update({f"leg_{side}/{name}": part for name, part in leg(body, pelvis, sign, ankle, still).items()})
        frames.update({f"arm_{side}/{name}": part for name, part in reaching_arm(body, frames["torso"], sign, wrist).items()})
    arrays = body_arrays(body, frames, None, edge=0.02, clothing="clothing", skin="skin")
    return [replace(part, name=f"rider/{part.name}").build() for part in arrays]
