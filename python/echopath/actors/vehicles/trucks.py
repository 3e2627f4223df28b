"""An articulated truck: tractor and semitrailer."""
from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ... import _core
from ...arguments.checks import checked, flag, real
from ...trajectories.trajectory import Trajectory
from ..actor import Actor, Part
from ..following import trajectory_rule
from ..lattice import rounded_box, rounded_parts
from ..shapes import ellipsoid
from ..solids import block, tube
from ..surfaces import joined
from .articulated import Coupling, Towing
from .driving import Driving
from .fittings import PLATE, leaning_plate
from .materials import BUMPER, GRILLE, LAMP, UNDERSIDE
from .wheel import Wheel, wheel_parts

# Largest length, width and height of articulated vehicles (Council Directive 96/53/EC), and a common 4 x 2 tractor.
LENGTH, WIDTH, HEIGHT = 16.50, 2.55, 4.00       # m
TRAILER_LENGTH, FLOOR = 13.60, 1.15             # m, length of the box and height of its lower side
CAB_LENGTH, CAB_BOTTOM, CAB_HEIGHT = 2.28, 0.38, 3.75
TRACTOR_WHEELBASE, FRONT_OVERHANG = 3.70, 1.40
TRAILER_AXLES = (-6.60, -5.29, -3.98)           # m from the middle of the truck's length
TYRE = Wheel(1.01, 0.315, 0.57, num_spokes=8, spoke_width=0.11, segments=36)    # 315/70 R 22.5
CURTAIN = _core.Material(reflectivity=0.4, scattering=0.5)   # plastic sheet over slats and pallets, effective
FRONT = LENGTH / 2
DRIVE_AXLE = FRONT - FRONT_OVERHANG - TRACTOR_WHEELBASE
KINGPIN = 1.65          # m behind the front of the trailer
HITCH = -LENGTH / 2 + TRAILER_LENGTH - KINGPIN


@checked(speed=real(unit="m/s"), drives=flag, trajectory=trajectory_rule)
def truck(*, speed: float = 0.0, drives: bool = True, trajectory: Trajectory | None = None) -> Actor:
    """An articulated truck: a cab-over tractor with a box semitrailer, 16.5 m long, 2.55 m wide and 4 m high.

    The sides of the box bulge by centimetres, as those of real ones do; a flat side would flash by tens of dB. Frame: x
    forward from the middle of the length, y left, z up, the road at z = 0.
    Parts: cab/body, cab/windscreen, cab/window_left and _right, cab/grille, cab/bumper, lamp/head_*, mirror_*, tractor/chassis,
    trailer/front, trailer/side_left and _right, trailer/roof, trailer/doors, trailer/floor, trailer/chassis,
    trailer/underrun, plate/rear, and wheels: wheel/front_left/tyre and /rim, wheel/drive_*, wheel/trailer_1_* to _3_*.
    speed: m/s ahead along +x; the wheels roll. drives: False turns the wheels at `speed` alone.
    trajectory: a Trajectory that it follows instead: the tractor's rear axle, 3.15 m ahead of the origin, stays on its path (one
    with a yaw of its own carries the tractor as it says); the trailer follows its hitch without slipping sideways, in line at
    the begin, or at the end of what backs up, and cuts corners as trailers do. All wheels roll their way, those in front
    steer. `trajectory.motion((8.3, 0, 0.7), axle=3.15)` is that of a radar before its bumper. Warns (RuntimeWarning) of ways
    that fold it by more than 90 degrees.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    driving = Driving(speed, drives, trajectory)
    tractor = trailer = driving
    if trajectory is not None:
        towing = Towing(trajectory, Coupling(DRIVE_AXLE, HITCH, float(np.mean(TRAILER_AXLES))))
        towing.warn_of_folding()
        tractor, trailer = towing.tractor, towing.trailer
    ahead, behind = _at_rest()
    return Actor(tractor.carried(list(ahead)) + trailer.carried(list(behind)) + _wheels(tractor, trailer), trajectory)


@lru_cache(maxsize=1)
def _at_rest():
    """(parts of the tractor, parts of the trailer), all but the wheels, which trucks share."""
    parts = _cab() + _fittings() + _trailer() + _frames()
    is_behind = [part.name.startswith(("trailer/", "plate/")) for part in parts]
    return tuple(tuple(part for part, behind in zip(parts, is_behind) if behind == asked) for asked in (False, True))


def _cab():
    low, high = (FRONT - CAB_LENGTH, -WIDTH / 2 + 0.03, CAB_BOTTOM), (FRONT, WIDTH / 2 - 0.03, CAB_HEIGHT)
    points = rounded_box(low, high, 0.30, (4, 6, 8), bow=0.06)
    rise = np.clip((points[..., 2] - 1.6) / (CAB_HEIGHT - 1.6), 0.0, 1.0)
    ahead = np.clip((points[..., 0] - low[0]) / CAB_LENGTH, 0.0, 1.0)
    points[..., 0] -= 0.22 * rise**2 * ahead                # the windscreen leans back
    points[..., 0] -= 0.10 * (points[..., 1] / WIDTH * 2) ** 4 * ahead
    materials = {"cab": "metal", "cab/windscreen": "glass", "cab/window_left": "glass", "cab/window_right": "glass",
                 "cab/grille": GRILLE, "cab/bumper": BUMPER}
    return rounded_parts(points, _cab_label, materials, levels=2)


def _cab_label(face):
    i, j, k = face.cell
    if face.axis == 0 and face.side > 0:
        if k in (7, 8) and 1 <= j <= 8:
            return "cab/windscreen"
        if k <= 2:
            return "cab/bumper"
        return "cab/grille" if 3 <= k <= 5 and 2 <= j <= 7 else "cab/body"
    if face.axis == 1 and k in (6, 7) and 4 <= i <= 6:
        return "cab/window_left" if face.side > 0 else "cab/window_right"
    return "cab/body"


def _fittings():
    parts = []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        parts.append(Part(f"lamp/head_{side}", ellipsoid((0.05, 0.22, 0.10), edge=0.03), LAMP, None,
                          (FRONT - 0.10, 0.92 * sign, 0.72), smooth=True))
        parts.append(Part(f"mirror_{side}", ellipsoid((0.12, 0.07, 0.32), edge=0.03), "plastic", None,
                          (FRONT - 0.42, 1.37 * sign, 2.05), smooth=True))
    return parts + [leaning_plate("plate/rear", 0.04 - LENGTH / 2, 0.70, -1.0, PLATE)]


def _trailer():
    low, high = (-LENGTH / 2, -WIDTH / 2 + 0.03, FLOOR), (-LENGTH / 2 + TRAILER_LENGTH, WIDTH / 2 - 0.03, HEIGHT - 0.02)
    points = rounded_box(low, high, 0.06, (12, 4, 4), bow=0.03)
    names = {(0, -1): "doors", (0, 1): "front", (1, -1): "side_right", (1, 1): "side_left", (2, -1): "floor", (2, 1): "roof"}
    materials = {"trailer": "metal", "trailer/side_left": CURTAIN, "trailer/side_right": CURTAIN, "trailer/floor": UNDERSIDE}
    return rounded_parts(points, lambda face: f"trailer/{names[face.axis, face.side]}", materials)


def _frames():
    """Beams under tractor and trailer, and the bar behind the trailer's wheels."""
    beams = [block((DRIVE_AXLE - 0.8, 0.38 * sign - 0.05, 0.70), (FRONT - 0.6, 0.38 * sign + 0.05, 0.96)) for sign in (1, -1)]
    axle = tube((DRIVE_AXLE, -0.75, TYRE.radius), (DRIVE_AXLE, 0.75, TYRE.radius), 0.09, segments=10)
    long = [block((-LENGTH / 2 + 0.15, 0.50 * sign - 0.06, 0.98), (-LENGTH / 2 + TRAILER_LENGTH - 2.4, 0.50 * sign + 0.06, 1.13))
            for sign in (1, -1)]
    legs = [block((1.35, 0.85 * sign - 0.06, 0.45), (1.47, 0.85 * sign + 0.06, 1.14)) for sign in (1, -1)]
    axles = [tube((x, -0.75, TYRE.radius), (x, 0.75, TYRE.radius), 0.07, segments=10) for x in TRAILER_AXLES]
    struts = [block((-LENGTH / 2 + 0.16, 0.50 * sign - 0.04, 0.50), (-LENGTH / 2 + 0.24, 0.50 * sign + 0.04, 1.00))
              for sign in (1, -1)]
    bar = block((-LENGTH / 2 + 0.05, -1.15, 0.45), (-LENGTH / 2 + 0.15, 1.15, 0.57))
    return [Part("tractor/chassis", _core.Mesh(*joined(*beams, axle)), UNDERSIDE),
            Part("trailer/chassis", _core.Mesh(*joined(*long, *legs, *axles, *struts)), UNDERSIDE),
            Part("trailer/underrun", _core.Mesh(*bar), "metal")]


def _wheels(tractor, trailer):
    twin = replace(TYRE, width=2 * TYRE.width)   # a pair of tyres side by side
    axles = [("front", DRIVE_AXLE + TRACTOR_WHEELBASE, TYRE, tractor), ("drive", DRIVE_AXLE, twin, tractor)]
    axles += [(f"trailer_{n}", x, replace(TYRE, width=0.385), trailer) for n, x in enumerate(reversed(TRAILER_AXLES), 1)]
    parts = []
    for name, x, wheel, driving in axles:
        for side, sign in (("left", 1.0), ("right", -1.0)):
            y = sign * (WIDTH / 2 - 0.02 - wheel.width / 2)
            parts += wheel_parts(wheel, f"wheel/{name}_{side}", (x, y, wheel.radius), driving, outer=sign,
                                 wheelbase=TRACTOR_WHEELBASE if name == "front" else None)
    return parts
