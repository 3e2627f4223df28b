"""Bicycles: a tube frame on two spoked wheels, with crank and pedals.

Frame: x forward, y left, z up from the road; the bottom bracket is above the origin. Lengths in m.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ... import _core
from ...arguments.checks import checked, flag, real
from ...trajectories.trajectory import Trajectory
from ..actor import Actor, Part
from ..following import trajectory_rule, wheels_along
from ..limits import size_rule
from ..shapes import ellipsoid
from ..solids import block, ring, tube
from ..surfaces import joined
from .driving import Driving

WHEEL_RADIUS = 0.343          # of tyres 32-622
TYRE_RADIUS = 0.016
RIM_RADIUS, RIM_HALF_HEIGHT, RIM_HALF_WIDTH = 0.315, 0.010, 0.012
NUM_SPOKES, SPOKE_RADIUS, HUB_RADIUS, HUB_HALF_WIDTH = 28, 0.001, 0.022, 0.033
REAR_AXLE, FRONT_AXLE = -0.44, 0.64       # x of the axles
BRACKET_HEIGHT = 0.285
CRANK = 0.170                 # length
PEDAL_Y = 0.13                # middle of a pedal from the middle plane
PEDAL = (0.09, 0.10, 0.022)   # along, across, height
SEAT_ANGLE = np.radians(73.0)
HEAD_TOP, HEAD_BOTTOM = (0.40, 0.86), (0.455, 0.70)   # x, z of the head tube
GRIP = (0.44, 0.28, 1.03)     # x, y, z of the middle of the left grip
DEVELOPMENT = 4.2             # m that the bicycle goes ahead in one turn of the crank
FRAME_TUBE, STAY_TUBE = 0.016, 0.008      # radii


@dataclass(frozen=True)
class Ride:
    """speed in m/s; cadence: turns of the crank in rad/s; phase: rad of the left crank past its top at time 0, or where the
    trajectory begins that it follows instead."""

    speed: float = 0.0
    cadence: float = 0.0
    phase: float = 0.5 * np.pi
    trajectory: Trajectory | None = None

    def crank_angle(self, times):
        """Angle [T] in rad of the left crank past its top, ahead positive."""
        if self.trajectory is not None:
            return self.phase + 2.0 * np.pi / DEVELOPMENT * self.trajectory._track.rolled.at(times)[0]
        return self.phase + self.cadence * np.asarray(times, dtype=float)

    def pedal(self, times, sign):
        """Middle [T, 3] of the pedal of a side (left: 1) relative to the bicycle, which stands still."""
        angle = self.crank_angle(times) + (0.0 if sign > 0 else np.pi)
        return np.stack([CRANK * np.sin(angle), np.full_like(angle, sign * PEDAL_Y), BRACKET_HEIGHT + CRANK * np.cos(angle)], -1)


@checked(speed=real(unit="m/s"), saddle_height=size_rule, drives=flag, trajectory=trajectory_rule)
def bicycle(*, speed: float = 0.0, saddle_height: float = 0.95, drives: bool = True,
            trajectory: Trajectory | None = None) -> Actor:
    """A trekking bicycle with wheels of 28 inches that rolls along +x, without a rider; the crank stands still.

    Parts: frame, fork, handlebar, saddle, crank, pedal_left, pedal_right, and wheel_front/tyre, wheel_front/rim,
    wheel_front/spokes, likewise wheel_rear. The bottom bracket is above the origin, the road at z = 0.
    speed: m/s; the wheels roll. saddle_height: m, of its upper side above the road. drives: False turns the wheels alone.
    trajectory: a Trajectory of the origin that it follows instead, upright; the wheels roll its way.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    return Actor(bicycle_parts(Ride(speed), saddle_height, Driving(speed, drives, trajectory)), trajectory)


def bicycle_parts(ride, saddle_height, driving, *, pedals=True):
    """Parts of a bicycle on a Ride that drives (driving.Driving); pedals: whether they, at rest relative to the frame, are
    among them."""
    still = list(_at_rest(float(saddle_height)))
    if pedals:
        still += [Part(f"pedal_{side}", _mesh(block(*pedal_corners())), "plastic", None, tuple(ride.pedal([0.0], sign)[0]))
                  for side, sign in (("left", 1.0), ("right", -1.0))]
    parts = driving.carried(still) + [_crank(ride, driving.ahead)]
    for end, x in (("front", FRONT_AXLE), ("rear", REAR_AXLE)):
        parts += [replace(part, name=f"wheel_{end}/{part.name}", position=(x, 0.0, WHEEL_RADIUS),
                          motion=driving.wheel(WHEEL_RADIUS)) for part in _wheel()]
    return parts


@lru_cache(maxsize=32)
def _at_rest(saddle_height):
    """Frame, fork, handlebar and saddle, which bicycles of one size share: a tuple of parts."""
    return (Part("frame", _mesh(*_frame(saddle_height)), "metal", smooth=True),
            Part("fork", _mesh(*_fork()), "metal", smooth=True),
            Part("handlebar", _mesh(*_handlebar()), "metal", smooth=True),
            replace(_saddle(saddle_height), smooth=True))


def pedal_corners():
    """Lower and upper corner of a pedal about its middle."""
    half = 0.5 * np.array(PEDAL)
    return -half, half


def seat_point(distance):
    """[..., 3] at distances [...] in m from the bottom bracket up the seat tube."""
    distance = np.asarray(distance)
    return np.stack([-np.cos(SEAT_ANGLE) * distance, 0.0 * distance, BRACKET_HEIGHT + np.sin(SEAT_ANGLE) * distance], axis=-1)


@lru_cache(maxsize=1)
def _wheel():
    """Tyre, rim and spokes about the axle, which all wheels share."""
    tyre = ring(WHEEL_RADIUS - TYRE_RADIUS, TYRE_RADIUS, 40, 6)
    rim = ring(RIM_RADIUS, RIM_HALF_HEIGHT, 40, 6, width=RIM_HALF_WIDTH)
    hub = tube((0, -HUB_HALF_WIDTH, 0), (0, HUB_HALF_WIDTH, 0), HUB_RADIUS, segments=10)
    spokes = []
    for n in range(NUM_SPOKES):
        angle = 2.0 * np.pi * n / NUM_SPOKES
        direction = np.array([np.cos(angle), 0.0, np.sin(angle)])
        foot = HUB_RADIUS * direction + np.array([0.0, HUB_HALF_WIDTH * (0.9 if n % 2 else -0.9), 0.0])
        spokes.append(tube(foot, (RIM_RADIUS - RIM_HALF_HEIGHT) * direction, SPOKE_RADIUS, segments=4))
    return (Part("tyre", _mesh(tyre), "rubber", smooth=True), Part("rim", _mesh(rim), "metal", smooth=True),
            Part("spokes", _mesh(hub, *spokes), "metal", smooth=True))


def _frame(saddle_height):
    bracket, seat = seat_point(0.0), seat_point(0.50)
    top, bottom = _in_plane(HEAD_TOP), _in_plane(HEAD_BOTTOM)
    axle = np.array([REAR_AXLE, 0.0, WHEEL_RADIUS])
    post = seat_point((saddle_height - 0.04 - BRACKET_HEIGHT) / np.sin(SEAT_ANGLE))
    bars = [_bar(bracket, post), _bar(top, bottom), _bar(seat, _in_plane((0.41, 0.83))),
            _bar(_in_plane((0.01, BRACKET_HEIGHT + 0.01)), _in_plane((0.445, 0.73)))]
    for sign in (1.0, -1.0):
        side = np.array([0.0, 0.06 * sign, 0.0])
        bars += [tube(bracket + 0.4 * side, axle + side, STAY_TUBE, segments=8),
                 tube(seat + 0.3 * side, axle + side, STAY_TUBE, segments=8)]
    return bars


def _fork():
    axle, crown = np.array([FRONT_AXLE, 0.0, WHEEL_RADIUS]), _in_plane((0.462, 0.68))
    bars = [_bar(crown + [0, -0.055, 0], crown + [0, 0.055, 0])]
    for sign in (1.0, -1.0):
        side = np.array([0.0, 0.052 * sign, 0.0])
        bars.append(tube(crown + side, axle + side, 0.012, 0.009, segments=8))
    return bars


def _handlebar():
    stem, grip = _in_plane((0.392, 0.93)), np.array(GRIP)
    middle = np.array([0.47, 0.0, 1.00])
    bars = [tube(_in_plane((0.402, 0.85)), stem, 0.014, segments=10), tube(stem - [0, 0, 0.004], middle, 0.013, segments=10)]
    for sign in (1.0, -1.0):
        mirrored = grip * [1.0, sign, 1.0]
        bars += [tube(middle + [0, 0.003 * sign, 0], mirrored - [0, 0.06 * sign, 0], 0.011, segments=8),
                 tube(mirrored - [0, 0.063 * sign, 0], mirrored + [-0.02, 0.06 * sign, 0], 0.013, segments=8)]
    return bars


def _saddle(saddle_height):
    place = seat_point((saddle_height - 0.03 - BRACKET_HEIGHT) / np.sin(SEAT_ANGLE))
    return Part("saddle", ellipsoid((0.13, 0.075, 0.03), edge=0.02), "plastic", None, tuple(place))


def _crank(ride, ahead):
    """Chain ring, axle and both crank arms, the left one at the phase of the ride at time 0."""
    pieces = [ring(0.085, 0.006, 28, 4, width=0.003), tube((0, -0.085, 0), (0, 0.085, 0), 0.014, segments=8)]
    pieces[0] = (pieces[0][0] + [0.0, -0.05, 0.0], pieces[0][1])
    for sign in (1.0, -1.0):
        end = sign * CRANK * np.array([np.sin(ride.phase), 0.0, np.cos(ride.phase)])
        pieces += [tube((0, 0.075 * sign, 0), end + [0, 0.078 * sign, 0], 0.012, 0.009, segments=6),
                   tube(end + [0, 0.07 * sign, 0], end + [0, (PEDAL_Y - 0.2 * PEDAL[1]) * sign, 0], 0.007, segments=6)]
    motion = None
    if ride.trajectory is not None:
        motion = _core.CurveMotion(rotation=wheels_along(ride.trajectory).curve(DEVELOPMENT / (2.0 * np.pi)))
    elif ahead or ride.cadence:
        motion = _core.LinearMotion(velocity=(ahead, 0.0, 0.0), angular_velocity=(0.0, ride.cadence, 0.0))
    return Part("crank", _mesh(*pieces), "metal", motion, (0.0, 0.0, BRACKET_HEIGHT), smooth=True)


def _bar(start, end):
    return tube(start, end, FRAME_TUBE, segments=10)


def _in_plane(point):
    return np.array([point[0], 0.0, point[1]])


def _mesh(*pieces):
    return _core.Mesh(*(joined(*pieces) if len(pieces) > 1 else pieces[0]))
