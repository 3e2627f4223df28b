"""A dog that trots or stands."""
from __future__ import annotations

import numpy as np

from ...checks import checked, positive, real
from ... import _core
from ..actor import Actor, PartArrays
from ..human.pedestrian import keyframe_times
from ..shapes import capsule, ellipsoid

# Proportions of a Labrador retriever in heights of its withers (0.57 m by the breed's standard), drawn after photographs.
SHOULDER, HIP = (0.42, 0.66), (-0.48, 0.66)     # x, z of the upper joints of the legs
HALF_TRACK = 0.13                                # y of the legs
SEGMENTS = {"fore": (0.34, 0.34), "hind": (0.36, 0.36)}       # upper and lower part of the legs
RADII = {"upper": 0.065, "lower": 0.040}
KNEE_SIDE = {"fore": -1.0, "hind": 1.0}          # elbows bend backwards, knees forwards
FUR = _core.Material(reflectivity=0.15, scattering=0.95)
# A wet skin under dry fur, effective: the power that skin reflects (0.34 at normal incidence), less what centimetres of fur
# are taken to scatter and absorb.

STRIDE_FREQUENCY = (1.35, 0.33)   # 1/s at rest and its growth with the speed in 1/m: trotting dogs of that size, from memory
SUPPORT = 0.46                    # share of a cycle that a paw is on the ground
LIFT = 0.14                       # of a swinging paw, in heights of the withers
BOUNCE = 0.012                    # amplitude of the trunk, likewise, twice a cycle
LEGS = (("fore_left", "fore", 1.0, 0.0), ("hind_right", "hind", -1.0, 0.0), ("fore_right", "fore", -1.0, 0.5),
        ("hind_left", "hind", 1.0, 0.5))   # the diagonal pairs of a trot step together


@checked(height=positive("m"), speed=real(0.0, 4.0, unit="m/s"), start_time=real(unit="s"), duration=positive("s"),
         phase=real(unit="cycles"))
def dog(*, height: float = 0.57, speed: float = 2.2, start_time: float = -0.5, duration: float = 2.5,
        phase: float = 0.0) -> Actor:
    """A dog that trots along +x, or stands at speed 0: smooth ellipsoids and capsules, proportions of a Labrador.

    Paws on the ground z = 0 do not slide. Parts: trunk, neck, head, snout, tail, leg_fore_left/upper, leg_fore_left/lower, and
    likewise fore_right, hind_left, hind_right.
    height: m, of the withers. speed: m/s, at most 4. start_time, duration: of the motion in s; a scene can be posed at no
    other time. phase: of the cycle at time 0, in cycles.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    times = keyframe_times(start_time, duration, 240.0)
    frequency = (STRIDE_FREQUENCY[0] + STRIDE_FREQUENCY[1] * speed) * np.sqrt(0.57 / height) if speed else 0.0
    cycles = phase + frequency * times
    way = np.stack([speed * times, 0 * times, 0 * times], axis=-1)
    bounce = height * BOUNCE * np.cos(4.0 * np.pi * (cycles - 0.5 * SUPPORT)) * -1.0 if speed else 0.0 * times
    body = way + np.stack([0 * times, 0 * times, bounce], axis=-1)
    parts = _trunk(height, body, times)
    for name, kind, side, lag in LEGS:
        step = speed / frequency / height if speed else 0.0
        paw = _paw(cycles - lag, step) if speed else np.zeros((len(times), 2))
        parts += _leg(f"leg_{name}", kind, side, height, body, way, paw, times)
    moves = speed > 0.0
    return Actor([(part if moves else _at_rest(part)).build() for part in parts])


def _paw(cycles, step):
    """Paw [T, 2] (x relative to the place under its joint, z) in heights of the withers: planted, then through the air.

    step: way of a cycle. In swing x is a cubic that leaves and meets the ground at its speed, less a quarter of a sine.
    """
    part = np.mod(cycles, 1.0)
    reach = 0.5 * SUPPORT * step
    stance = reach - step * part
    s = np.clip((part - SUPPORT) / (1.0 - SUPPORT), 0.0, 1.0)
    slope = -step * (1.0 - SUPPORT)
    swing = -reach + slope * s + (2.0 * reach - slope) * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    lift = LIFT * (4.0 * s * (1.0 - s)) ** 3
    return np.stack([np.where(part < SUPPORT, stance, swing), np.where(part < SUPPORT, 0.0, lift)], axis=-1)


def _trunk(height, body, times):
    shapes = [("trunk", ellipsoid((0.62 * height, 0.19 * height, 0.22 * height), edge=0.05 * height), (-0.03, 0.0, 0.77), 2.0),
              ("neck", ellipsoid((0.25 * height, 0.11 * height, 0.13 * height), edge=0.04 * height), (0.58, 0.0, 0.98), -42.0),
              ("head", ellipsoid((0.17 * height, 0.13 * height, 0.13 * height), edge=0.04 * height), (0.75, 0.0, 1.14), 0.0),
              ("snout", ellipsoid((0.15 * height, 0.07 * height, 0.07 * height), edge=0.03 * height), (0.91, 0.0, 1.09), 8.0),
              ("tail", ellipsoid((0.30 * height, 0.035 * height, 0.035 * height), edge=0.02 * height), (-0.84, 0.0, 0.80), -22.0)]
    return [PartArrays(name, mesh.vertices, mesh.triangles, FUR, times, height * np.array(place) + body,
                       _about_y(np.full(len(times), np.radians(pitch))), smooth=True)
            for name, mesh, place, pitch in shapes]


def _leg(name, kind, side, height, body, way, paw, times):
    """Upper and lower part of a leg whose paw is given: two bars that meet in elbow or knee."""
    upper, lower = (height * length for length in SEGMENTS[kind])
    x, z = SHOULDER if kind == "fore" else HIP
    joint = np.stack([body[:, 0] + height * x, np.full(len(times), side * HALF_TRACK * height), height * z + body[:, 2]], -1)
    sole = RADII["lower"] * height
    foot = np.stack([way[:, 0] + height * (x + paw[:, 0]), joint[:, 1], sole + height * paw[:, 1]], axis=-1)
    between = joint - foot
    distance = np.minimum(np.linalg.norm(between, axis=-1, keepdims=True), 0.999 * (upper + lower))
    along = between / np.linalg.norm(between, axis=-1, keepdims=True)
    below = (distance**2 + lower**2 - upper**2) / (2.0 * distance)
    across = np.stack([along[:, 2], 0 * times, -along[:, 0]], axis=-1)
    knee = foot + below * along + KNEE_SIDE[kind] * np.sqrt(np.maximum(lower**2 - below**2, 0.0)) * across
    return [_bar(f"{name}/upper", joint, knee, RADII["upper"] * height, upper, times),
            _bar(f"{name}/lower", knee, foot, RADII["lower"] * height, lower, times)]


def _bar(name, start, end, radius, length, times):
    """A capsule whose half spheres are about `start` and `end` [T, 3], which lie in a plane of constant y."""
    mesh = capsule(radius, length + 2.0 * radius, edge=0.5 * radius)
    up = start - end
    angle = np.arctan2(up[:, 0], up[:, 2])
    return PartArrays(name, mesh.vertices, mesh.triangles, FUR, times, 0.5 * (start + end), _about_y(angle), smooth=True)


def _about_y(angle):
    """Unit quaternions [T, 4]."""
    return np.stack([np.cos(0.5 * angle), 0 * angle, np.sin(0.5 * angle), 0 * angle], axis=-1)


def _at_rest(part):
    """The same without motion, as it stands at the first instant."""
    w, _, y, _ = part.rotations[0]
    c, s = w * w - y * y, 2.0 * w * y
    rotation = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return PartArrays(part.name, np.asarray(part.vertices) @ rotation.T + part.translations[0], part.triangles, part.material,
                      smooth=True)
