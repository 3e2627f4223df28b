"""A person who rides a bicycle."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ... import _core
from ...arguments.checks import checked, positive, real
from ...arguments.number_rules import start_time_rule
from ...base.numerics.rotations import about_y, quaternions
from ...trajectories.trajectory import Trajectory
from ..actor import Actor, PartArrays
from ..following import refuse_beside_trajectory, trajectory_rule
from ..human.anthropometry import Proportions
from ..human.foot import Sole
from ..human.pedestrian import MIN_KEYFRAME_RATE, body_arrays, edge_of, material_rule
from ..human.posture import leg, reaching_arm, trunk
from ..keyframes import Frames, key_times, keyframe_times, with_rates
from ..solids import block
from .bicycle import CRANK, DEVELOPMENT, GRIP, PEDAL, Ride, bicycle_parts, pedal_corners, seat_point
from .driving import Driving

RIDER_HEIGHTS = (1.45, 2.0)              # m, of riders whom the frame fits
PELVIS_LEAN, TORSO_LEAN = np.radians(18.0), np.radians(38.0)
STRAIGHTEST = 0.965                      # longest distance of hip and ankle over thigh and shank together
ANKLING = (np.radians(-14.0), np.radians(10.0))   # pitch of the foot: mean, and amplitude over a turn
SEAT_DEPTH = 0.052                       # of the saddle below the hip joints, in body heights


@checked(height=real(*RIDER_HEIGHTS, unit="m"), speed=positive("m/s"), start_time=start_time_rule, duration=positive("s"),
         phase=real(unit="cycles"), edge=positive("m"), keyframe_rate=real(MIN_KEYFRAME_RATE, unit="1/s"), clothing=material_rule,
         skin=material_rule, trajectory=trajectory_rule)
def cyclist(*, height: float = 1.78, speed: float = 5.0, start_time: float = -0.5, duration: float = 2.5, phase: float = 0.25,
            edge: float = 0.02, keyframe_rate: float = 120.0, clothing: str | _core.Material = "clothing",
            skin: str | _core.Material = "skin", trajectory: Trajectory | None = None) -> Actor:
    """A person who rides a bicycle along +x and pedals; the wheels roll.

    Thighs and shanks follow the pedals: hip and ankle are given, the knee is where both segments meet. One turn of the
    crank for each 4.2 m (71 a minute at 5 m/s). Proportions as of `pedestrian`, whose body parts are under rider/
    (rider/torso, rider/leg_left/shank and so on); those of `bicycle` are under bicycle/. At time 0 the bottom bracket is
    above the origin; the road is at z = 0.
    height: of the rider in m, 1.45 to 2. speed: m/s. start_time, duration: of the motion in s; a scene can be posed at no
    other time. phase: of the left crank past its top at time 0, in turns. edge: m, of the body's triangles. keyframe_rate:
    1/s, at least 60. clothing, skin: materials. trajectory: a Trajectory of the origin that is followed instead of speed,
    start_time and duration, upright; wheels and crank turn with its distance, so that the rider pedals as fast as it goes and
    stops with it; phase: of the crank where it begins.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    refuse_beside_trajectory(trajectory, speed=(speed, 5.0), start_time=(start_time, -0.5), duration=(duration, 2.5))
    body = Proportions(height)
    if trajectory is None:
        ride = Ride(speed, 2.0 * np.pi * speed / DEVELOPMENT, 2.0 * np.pi * phase)
        times = keyframe_times(start_time, duration, keyframe_rate)
    else:
        ride = Ride(phase=2.0 * np.pi * phase, trajectory=trajectory)
        times = key_times(trajectory, keyframe_rate)
    arrays = body_arrays(body, _ridden(body, ride, times), times, edge=edge_of(body, edge), clothing=clothing,
                         skin=skin)
    arrays += [_pedal(ride, times, side) for side in ("left", "right")]
    if trajectory is not None:
        arrays = with_rates(arrays, lambda at: _ridden(body, ride, at) | _pedal_frames(ride, at), times)
    seat = saddle_hip(body)[2] - body.of(SEAT_DEPTH)
    parts = bicycle_parts(ride, seat, Driving(ride.speed, trajectory=trajectory), pedals=False)
    parts = [replace(part, name=f"bicycle/{part.name}") for part in parts]
    pedals, person = [part.build() for part in arrays[-2:]], [part.build() for part in arrays[:-2]]
    return Actor(parts + pedals + person, trajectory)


def _ridden(body, ride, times):
    """Frames of the rider's parts under their names in the actor."""
    return {f"rider/{name}": frame for name, frame in rider_frames(body, ride, times).items()}


def rider_frames(body, ride, times):
    """Frames of every part of a body on a bicycle at times [T]; it goes along +x."""
    times = np.asarray(times, dtype=float)
    still = np.zeros(len(times))
    way = np.stack([ride.speed * times, still, still], axis=-1)
    pelvis = Frames(saddle_hip(body) + way, about_y(still + PELVIS_LEAN))
    parts = trunk(body, pelvis, still + TORSO_LEAN, head_pitch=np.radians(5.0))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        ankle, pitch = pedalling_ankle(body, ride, times, sign)
        limb = leg(body, pelvis, sign, ankle + way, pitch)
        arm = reaching_arm(body, parts["torso"], sign, np.array(GRIP) * [1.0, sign, 1.0] + [-0.06, 0.0, 0.035] + way)
        parts.update({f"leg_{side}/{name}": frame for name, frame in limb.items()})
        parts.update({f"arm_{side}/{name}": frame for name, frame in arm.items()})
    return parts


def pedalling_ankle(body, ride, times, sign):
    """Ankle [T, 3] relative to the bicycle and pitch [T] of a foot whose ball is on its pedal."""
    pedal = ride.pedal(times, sign)
    mean, amplitude = ANKLING
    pitch = mean + amplitude * (pedal[:, 0] / CRANK)
    ball = np.array([Sole.of(body).toe_center_x, 0.0, -body.ankle_height])
    ball_from_ankle = about_y(-pitch) @ ball
    return pedal + [0.0, 0.0, 0.5 * PEDAL[2]] - ball_from_ankle, pitch


def saddle_hip(body):
    """Middle [3] of the hip joints on the saddle, so high up the seat tube that no leg must be straighter than STRAIGHTEST."""
    ride = Ride(0.0, 1.0, 0.0)
    ankle, _ = pedalling_ankle(body, ride, np.linspace(0.0, 2.0 * np.pi, 181), 1.0)
    reach = STRAIGHTEST * (body.thigh + body.shank)
    distances = np.linspace(0.4, 1.1, 701)
    hips = seat_point(distances) + [0.0, body.hip_offset, 0.0]
    farthest = np.max(np.linalg.norm(hips[:, None] - ankle[None], axis=-1), axis=1)
    return seat_point(float(np.interp(reach, farthest, distances)))


def _pedal_frames(ride, times):
    """Frames of the pedals, which stay level as they go round."""
    way = np.outer(ride.speed * np.asarray(times), [1.0, 0.0, 0.0])
    return {f"bicycle/pedal_{side}": Frames(ride.pedal(times, sign) + way, about_y(np.zeros(len(way))))
            for side, sign in (("left", 1.0), ("right", -1.0))}


def _pedal(ride, times, side):
    """A pedal as PartArrays."""
    name = f"bicycle/pedal_{side}"
    frame = _pedal_frames(ride, times)[name]
    return PartArrays(name, *block(*pedal_corners()), "plastic", times, frame.origin, quaternions(frame.rotation))
