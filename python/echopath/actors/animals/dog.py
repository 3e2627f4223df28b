"""A dog that trots or stands."""
from __future__ import annotations

import numpy as np

from ... import _core
from ...arguments.checks import checked, positive, real, refused
from ...arguments.number_rules import start_time_rule
from ...base.numerics.rotations import about_y, about_z, matrices, quaternions
from ...trajectories.trajectory import Trajectory
from ..actor import Actor, PartArrays
from ..following import refuse_beside_trajectory, trajectory_rule
from ..keyframes import Frames, key_times, keyframe_times, with_rates
from ..laid_line import LaidLine, usual_speed
from ..limits import size_rule
from ..shapes import capsule, ellipsoid

REFERENCE_HEIGHT = 0.57                          # m, of the withers of a Labrador retriever, by the breed's standard
# Its proportions in heights of its withers, drawn after photographs.
SHOULDER, HIP = (0.42, 0.66), (-0.48, 0.66)     # x, z of the upper joints of the legs
HALF_TRACK = 0.13                                # y of the legs
SEGMENTS = {"fore": (0.34, 0.34), "hind": (0.36, 0.36)}       # upper and lower part of the legs
RADII = {"upper": 0.065, "lower": 0.040}
KNEE_SIDE = {"fore": -1.0, "hind": 1.0}          # elbows bend backwards, knees forwards
GIRDLE = 0.3                                     # of the way of a paw from under its joint, by which that goes along: shoulder
# blades turn about their upper ends, some 0.95 heights above the ground, and the pelvis turns with the back
STRAIGHTEST, SHARPNESS = 0.985, 24.0             # longest leg over both of its parts, and the power by which it is approached
FUR = _core.Material(reflectivity=0.15, scattering=0.95)
# A wet skin under dry fur, effective: the power that skin reflects (0.34 at normal incidence), less what centimetres of fur
# are taken to scatter and absorb.

# 1/s at rest and its growth with the speed in 1/m: trotting dogs of the reference height, from memory. Times and speeds of others
# go by the root of their height, so that their steps are as long in heights.
STRIDE_FREQUENCY = (1.35, 0.33)
SUPPORT = 0.46                    # share of a cycle that a paw is on the ground
LIFT = 0.14                       # of a swinging paw, in heights of the withers
BOUNCE = 0.012                    # amplitude of the trunk, likewise, twice a cycle
LEGS = (("fore_left", "fore", 1.0, 0.0), ("hind_right", "hind", -1.0, 0.0), ("fore_right", "fore", -1.0, 0.5),
        ("hind_left", "hind", 1.0, 0.5))   # the diagonal pairs of a trot step together
# Part: semi-axes, edge of its triangles and place in heights of the withers, pitch in degrees.
TRUNK = {"trunk": ((0.62, 0.19, 0.22), 0.05, (-0.03, 0.0, 0.77), 2.0),
         "neck": ((0.25, 0.11, 0.13), 0.04, (0.58, 0.0, 0.98), -42.0),
         "head": ((0.17, 0.13, 0.13), 0.04, (0.75, 0.0, 1.14), 0.0),
         "snout": ((0.15, 0.07, 0.07), 0.03, (0.91, 0.0, 1.09), 8.0),
         "tail": ((0.30, 0.035, 0.035), 0.02, (-0.84, 0.0, 0.80), -22.0)}
SPEEDS = (0.3, 4.0)               # m/s, least and greatest of a trot, likewise
KEYFRAME_RATE = 240.0             # 1/s


@checked(height=size_rule, speed=real(0.0, unit="m/s"), start_time=start_time_rule, duration=positive("s"),
         phase=real(unit="cycles"), trajectory=trajectory_rule)
def dog(*, height: float = 0.57, speed: float = 2.2, start_time: float = -0.5, duration: float = 2.5,
        phase: float = 0.0, trajectory: Trajectory | None = None) -> Actor:
    """A dog that trots along +x, or stands at speed 0: smooth ellipsoids and capsules, proportions of a Labrador.

    Paws on the ground z = 0 do not slide. Parts: trunk, neck, head, snout, tail, leg_fore_left/upper, leg_fore_left/lower, and
    likewise fore_right, hind_left, hind_right.
    height: m, of the withers. speed: m/s, at most 4 for a dog of 0.57 m, others by the root of their height. start_time,
    duration: of the motion in s; a scene can be posed at no other time. phase: of the cycle at time 0, in cycles.
    trajectory: a Trajectory of the origin that is followed instead of speed, start_time, duration and phase; the steps go with
    its distance, paws on the ground do not slide, and at its stops all are down.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    refuse_beside_trajectory(trajectory, speed=(speed, 2.2), start_time=(start_time, -0.5), duration=(duration, 2.5),
                             phase=(phase, 0.0))
    if trajectory is not None:
        return _along(height, trajectory)
    real(0.0, trot_speeds(height)[1], f"m/s for a height of {height:g} m")("speed", speed)
    times = keyframe_times(start_time, duration, KEYFRAME_RATE)
    frequency = stride_frequency(height, speed) if speed else 0.0
    cycles = phase + frequency * times
    ahead = np.array([1.0, 0.0, 0.0])
    body = np.outer(speed * times, ahead) + (_bounce(height, cycles) if speed else 0.0)
    feet = {}
    for name, kind, side, lag in LEGS:
        paw = _paw(cycles - lag, speed / frequency / height) if speed else np.zeros((len(times), 2))
        feet[name] = _under(height, kind, side) + np.outer(speed * times + height * paw[:, 0], ahead)
        feet[name][:, 2] += height * paw[:, 1]
    arrays = _arrays(height, _frames(height, body, feet), times)
    return Actor([(part if speed > 0.0 else _at_rest(part)).build() for part in arrays])


def stride_frequency(height: float, speed: float) -> float:
    """1/s, of a trot at a speed in m/s."""
    scale = _scale(height)
    return (STRIDE_FREQUENCY[0] + STRIDE_FREQUENCY[1] * speed / scale) / scale


def trot_speeds(height: float) -> tuple[float, float]:
    """Least and greatest speed in m/s."""
    least, greatest = (round(speed * _scale(height), 3) for speed in SPEEDS)
    return least, greatest


def _scale(height: float) -> float:
    """Times and speeds of a dog over those of one of the reference height."""
    return float(np.sqrt(height / REFERENCE_HEIGHT))


def _along(height: float, trajectory: Trajectory) -> Actor:
    speed, (least, greatest) = usual_speed(trajectory._track), trot_speeds(height)
    if speed > greatest:
        rule = f"one of at most {greatest:.3g} m/s for a dog of {height:g} m, as most of its way is"
        raise refused(ValueError, "trajectory", rule, f"{speed:.3g} m/s")
    trot = TrotAlong(height, max(speed, least), trajectory._track, trajectory._has_pitch)
    times = key_times(trajectory, KEYFRAME_RATE)
    arrays = _arrays(height, trot.frames(times), times)
    return Actor([part.build() for part in with_rates(arrays, trot.frames, times)], trajectory)


class TrotAlong:
    """The trot that is usual at a speed in m/s, along a Track (trajectories/track.py); has_pitch: whether the dog leans with the
    slope of the path."""

    def __init__(self, height: float, speed: float, track, has_pitch: bool):
        self._height, self._track, self._has_pitch = height, track, has_pitch
        self._length = speed / stride_frequency(height, speed)
        between = 0.5 * (SUPPORT + 0.5)     # one pair has just left the ground, the other is about to meet it
        self._laid = LaidLine(track, speed, 0.5 * self._length, between * self._length)

    def frames(self, times):
        """Frames of every part, by name, at times [T], relative to the place and axes of the track."""
        cycles = self._laid.line.at(times)[0] / self._length
        feet = {name: self._foot(times, cycles - lag, lag, _under(self._height, kind, side)) for name, kind, side, lag in LEGS}
        return _frames(self._height, _bounce(self._height, cycles), feet)

    def _foot(self, times, own, lag: float, under):
        """A foot [T, 3] in m: it stands where it is under its joint in the middle of a stance."""
        cycle = np.floor(own)
        s = np.clip((own - cycle - SUPPORT) / (1.0 - SUPPORT), 0.0, 1.0)
        share = (s**3 * (10.0 - 15.0 * s + 6.0 * s**2))[:, None]
        middle = (cycle + lag + 0.5 * SUPPORT) * self._length
        place, next_place = (self._planted(line, under) for line in (middle, middle + self._length))
        away = place + share * (next_place - place) - self._track.places(times)[0]
        foot = np.einsum("tji,tj->ti", self._track.axes(times, self._has_pitch)[0], away)
        foot[:, 2] += self._height * LIFT * (4.0 * s * (1.0 - s)) ** 3
        return foot

    def _planted(self, line, under):
        """Places [T, 3] in m of a foot that stands where the body is at places [T] on the line of the gait."""
        place, yaw = self._laid.footprints(line)
        slope = self._track.path.slopes(self._laid.distances(line))[0] if self._has_pitch else 0.0 * yaw
        return place + about_z(yaw) @ about_y(-slope) @ under


def _bounce(height: float, cycles):
    """[T, 3] in m, of the trunk."""
    rise = -height * BOUNCE * np.cos(4.0 * np.pi * (cycles - 0.5 * SUPPORT))
    return np.outer(rise, [0.0, 0.0, 1.0])


def _joint(height: float, kind: str, side: float):
    """[3] in m, of the upper end of a leg at rest."""
    x, z = SHOULDER if kind == "fore" else HIP
    return height * np.array([x, side * HALF_TRACK, z])


def _under(height: float, kind: str, side: float):
    """[3] in m, of the lower end of a leg on the ground below its joint."""
    return _joint(height, kind, side) * [1.0, 1.0, 0.0] + [0.0, 0.0, RADII["lower"] * height]


def _paw(cycles, step):
    """Paw [T, 2] (x relative to the place under its joint, z) in heights of the withers: planted, then through the air.

    step: way of a cycle. In swing x is a line, of the speed of the ground, and a quintic that begins and ends at rest beside it.
    """
    part = np.mod(cycles, 1.0)
    reach = 0.5 * SUPPORT * step
    stance = reach - step * part
    s = np.clip((part - SUPPORT) / (1.0 - SUPPORT), 0.0, 1.0)
    slope = -step * (1.0 - SUPPORT)
    swing = -reach + slope * s + (2.0 * reach - slope) * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    lift = LIFT * (4.0 * s * (1.0 - s)) ** 3
    return np.stack([np.where(part < SUPPORT, stance, swing), np.where(part < SUPPORT, 0.0, lift)], axis=-1)


def _frames(height: float, body, feet: dict) -> dict:
    """{part: Frames} of a body at [T, 3] in m whose legs end at feet {leg: [T, 3]}."""
    found = {name: Frames(height * np.array(place) + body, about_y(np.full(len(body), np.radians(pitch))))
             for name, (_, _, place, pitch) in TRUNK.items()}
    for name, kind, side, _ in LEGS:
        joint, foot = _joint(height, kind, side) + body, feet[name]
        joint = joint + GIRDLE * (foot - joint) * [1.0, 1.0, 0.0]
        joint, knee = _bent(kind, joint, foot, *(height * length for length in SEGMENTS[kind]))
        found |= {f"leg_{name}/upper": _between(joint, knee), f"leg_{name}/lower": _between(knee, foot)}
    return found


def _bent(kind: str, joint, foot, upper: float, lower: float):
    """(joint, elbow or knee), [T, 3] each, of a leg to a foot [T, 3], above and below whose knee it has these lengths in m.

    The joint comes down the line to a foot that is far away, so that the leg stays bent: near a straight one the rate of its knee
    has no bound.
    """
    between, straightest = joint - foot, STRAIGHTEST * (upper + lower)
    length = np.linalg.norm(between, axis=-1, keepdims=True)
    along, distance = between / length, length * (1.0 + (length / straightest) ** SHARPNESS) ** (-1.0 / SHARPNESS)
    below = (distance**2 + lower**2 - upper**2) / (2.0 * distance)
    across = np.array([1.0, 0.0, 0.0]) - along[:, :1] * along
    across /= np.linalg.norm(across, axis=-1, keepdims=True)
    return foot + distance * along, foot + below * along + KNEE_SIDE[kind] * np.sqrt(lower**2 - below**2) * across


def _between(start, end) -> Frames:
    """The middle of a bar from `end` up to `start` [T, 3], whose axis is z."""
    up = (start - end) / np.linalg.norm(start - end, axis=-1, keepdims=True)
    left = np.cross(up, [1.0, 0.0, 0.0])
    left /= np.linalg.norm(left, axis=-1, keepdims=True)
    return Frames(0.5 * (start + end), np.stack([np.cross(left, up), left, up], axis=-1))


def _arrays(height: float, frames: dict, times) -> list:
    """The parts with their motions over times [T], as plain arrays."""
    meshes = {name: ellipsoid(tuple(height * axis for axis in axes), edge=edge * height)
              for name, (axes, edge, _, _) in TRUNK.items()}
    for name, kind, _, _ in LEGS:
        for part, length in zip(("upper", "lower"), SEGMENTS[kind]):
            radius = RADII[part] * height
            meshes[f"leg_{name}/{part}"] = capsule(radius, height * length + 2.0 * radius, edge=0.5 * radius)
    return [PartArrays(name, mesh.vertices, mesh.triangles, FUR, times, frames[name].origin, quaternions(frames[name].rotation),
                       smooth=True) for name, mesh in meshes.items()]


def _at_rest(part):
    """The same without motion, as it stands at the first instant."""
    vertices = np.asarray(part.vertices) @ matrices(part.rotations[0]).T + part.translations[0]
    return PartArrays(part.name, vertices, part.triangles, part.material, smooth=True)
