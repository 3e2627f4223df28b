"""The pedestrian: a parametric walking person."""
from __future__ import annotations

import numpy as np

from ... import _core
from ...arguments.checks import an, checked, positive, real, refused
from ...arguments.number_rules import start_time_rule
from ...base.numerics.rotations import quaternions
from ...trajectories.trajectory import Trajectory
from ..actor import Actor, PartArrays
from ..following import refuse_beside_trajectory, trajectory_rule
from ..keyframes import Frames, key_times, keyframe_times, with_rates
from ..laid_line import usual_speed
from ..surfaces import edge_length
from .anthropometry import Proportions
from .body import surface
from .gait import Gait, relative_speed_limit
from .gait_along import GaitAlong

HEIGHTS = (0.5, 2.5)          # m
MIN_SPEED = 0.1               # m/s
MIN_KEYFRAME_RATE = 60.0      # 1/s: fewer do not follow the landing of a foot
SKIN_PARTS = ("head", "neck", "hand")


def material_rule(argument: str, value):
    """A Material or the name of one, which `Scene.add` looks up."""
    return an(_core.Material, str, called="a Material or the name of one")(argument, value)


@checked(height=real(*HEIGHTS, unit="m"), speed=positive("m/s"), start_time=start_time_rule,
         duration=positive("s"), phase=real(unit="cycles"), edge=positive("m"), keyframe_rate=real(MIN_KEYFRAME_RATE, unit="1/s"),
         clothing=material_rule, skin=material_rule, trajectory=trajectory_rule)
def pedestrian(*, height: float = 1.78, speed: float = 1.4, start_time: float = -0.5, duration: float = 2.5,
               phase: float = 0.0, edge: float = 0.018, keyframe_rate: float = 120.0,
               clothing: str | _core.Material = "clothing", skin: str | _core.Material = "skin",
               trajectory: Trajectory | None = None) -> Actor:
    """A person who walks along +x, 16 closed smooth meshes that move by keyframes.

    Proportions after Drillis and Contini (anthropometry.py), motion after Boulic, Thalmann and Thalmann (boulic.py)
    with feet that are planted (steps.py): a sole that touches the floor z = 0 does not slide. Steady walking on level
    ground, arms free.

    Frame: x forward, y left, z up. At time 0 the pelvis, but for its oscillation of a few cm, is above the origin; it
    has been and goes on along the x axis at `speed`.

    Parts: pelvis, torso, neck, head, arm_left/upper, arm_left/forearm, arm_left/hand, leg_left/thigh, leg_left/shank,
    leg_left/foot, and likewise right; "pedestrian/arm_*" takes both arms of an actor added as "pedestrian".

    height: of the body in m, 0.5 to 2.5. speed: in m/s, 0.1 to 3 hip heights a second (where walking ends).
    start_time, duration: first time and length of the motion in s; a scene can be posed at no other time.
    phase: of the walking cycle (two steps, about 1.1 s) at time 0, in cycles; 0 is the strike of the right heel.
    edge: length in m of the triangles' sides, at most 0.05 heights; about 20 000 triangles in all by default.
    keyframe_rate: in 1/s, at least 60.
    clothing, skin: materials, names in echopath.materials or objects; skin are head, neck and hands.
    trajectory: a Trajectory of the origin that is followed instead of speed, start_time, duration and phase; the steps go with
    its distance, a sole that touches the floor does not slide, and at its stops both feet are down.

    Returns an Actor. Raises ValueError for values out of range, TypeError for unknown keywords.
    """
    refuse_beside_trajectory(trajectory, speed=(speed, 1.4), start_time=(start_time, -0.5), duration=(duration, 2.5),
                             phase=(phase, 0.0))
    return walking(Proportions(height), speed=speed, start_time=start_time, duration=duration, phase=phase, edge=edge,
                   keyframe_rate=keyframe_rate, clothing=clothing, skin=skin, trajectory=trajectory)


def walking(body, **settings):
    """The Actor of a body that walks. Settings as of pedestrian()."""
    return on_foot(body, Gait, (MIN_SPEED, round(relative_speed_limit(body), 3)), **settings)


def on_foot(body, gait_of, speeds, *, speed, start_time, duration, phase, edge, keyframe_rate, clothing, skin, trajectory):
    """The Actor of a body that moves by a gait.

    gait_of: (body, usual speed in m/s) -> Gait; speeds: least and greatest in m/s of the gait; others as of pedestrian()
    """
    looks = {"edge": edge_of(body, edge), "clothing": clothing, "skin": skin}
    if trajectory is not None:
        return _along(body, gait_of, speeds, trajectory, keyframe_rate, looks)
    real(*speeds, f"m/s for a height of {body.height:g} m")("speed", speed)
    times, gait = keyframe_times(start_time, duration, keyframe_rate), gait_of(body, speed)
    frames = gait.frames(phase + times / gait.cycle.duration)
    start = np.array([phase * gait.cycle.length, 0.0, 0.0])
    moved = {name: Frames(frame.origin - start, frame.rotation) for name, frame in frames.items()}
    return Actor([part.build() for part in body_arrays(body, moved, times, **looks)])


def _along(body, gait_of, speeds, trajectory, keyframe_rate, looks):
    """The Actor of a body that follows a trajectory by a gait."""
    speed = usual_speed(trajectory._track)
    if speed > speeds[1]:
        rule = f"one of at most {speeds[1]:.3g} m/s for a person of {body.height:g} m, as most of its way is"
        raise refused(ValueError, "trajectory", rule, f"{speed:.3g} m/s")
    times = key_times(trajectory, keyframe_rate)
    gait = GaitAlong(gait_of(body, max(speed, speeds[0])), trajectory._track, trajectory._has_pitch)
    arrays = body_arrays(body, gait.frames(times), times, **looks)
    return Actor([part.build() for part in with_rates(arrays, gait.frames, times)], trajectory)


def edge_of(body, edge: float) -> float:
    """The length of the triangles' sides in m: with longer ones than a twentieth of its height, a body has no shape."""
    return real(0.0, 0.05 * body.height, "m")("edge", edge_length(edge, 3.0 * body.height))


def body_arrays(body, frames, times, *, edge, clothing, skin):
    """The parts of a body at frames {name: Frames} of times [T], as plain arrays; times None: placed once, at rest."""
    parts = []
    for name, frame in frames.items():
        kind = name.rsplit("/")[-1]
        vertices, triangles = surface(kind, body, edge)
        material = skin if kind in SKIN_PARTS else clothing
        if times is None:
            placed = vertices @ frame.rotation[0].T + frame.origin[0]
            parts.append(PartArrays(name, placed, triangles, material, smooth=True))
        else:
            parts.append(PartArrays(name, vertices, triangles, material, times, frame.origin, quaternions(frame.rotation),
                                    smooth=True))
    return parts
