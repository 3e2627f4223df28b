"""Postures: where the parts of a body are when its joints are given, standing or on a bicycle.

Frames are those of keyframes.py: T instants, axes x forward, y left, z up.
"""
import numpy as np

from ...base.numerics.rotations import about_x, about_y, about_z
from ..keyframes import Frames
from .gait import ARM_ABDUCTION, bend_leg

STANDING_KNEE = np.radians(8.0)
STANDING_ELBOW = np.radians(12.0)


def trunk(body, pelvis, lean, *, head_pitch=0.0):
    """Torso, neck and head over a pelvis (Frames); lean [T] in rad, forward positive."""
    base = pelvis.origin + pelvis.rotation @ np.array([0.0, 0.0, body.spine_base])
    torso = Frames(base, about_y(lean))
    neck = Frames(base + torso.rotation @ np.array([0.0, 0.0, body.neck_above_spine_base]),
                  about_y(lean / 2 + np.radians(8.0)))
    head = Frames(neck.origin + neck.rotation @ np.array([0.0, 0.0, body.neck]), about_y(0.0 * lean + head_pitch))
    return {"pelvis": pelvis, "torso": torso, "neck": neck, "head": head}


def leg(body, pelvis, sign, ankle, pitch):
    """Thigh, shank and foot from the hip of a side (left: 1) to an ankle [T, 3] with the foot's pitch [T], toes up positive."""
    hip = pelvis.origin + pelvis.rotation @ np.array([0.0, sign * body.hip_offset, 0.0])
    knee, thigh, shank = bend_leg(hip, ankle, body.thigh, body.shank, np.zeros(len(pitch)))
    return {"thigh": Frames(hip, thigh), "shank": Frames(knee, shank), "foot": Frames(ankle, about_y(-pitch))}


def shoulder_of(body, torso, sign):
    """The shoulder joint [T, 3] of a side."""
    return torso.origin + torso.rotation @ np.array([0.0, sign * body.shoulder_offset, body.shoulder_above_spine_base])


def hanging_arm(body, torso, sign):
    """Upper arm, forearm and hand of an arm that hangs down."""
    still = np.zeros(len(torso.origin))
    shoulder = shoulder_of(body, torso, sign)
    upper = torso.rotation @ about_x(still + sign * ARM_ABDUCTION)
    forearm = upper @ about_y(still - STANDING_ELBOW) @ about_x(still - 0.8 * sign * ARM_ABDUCTION)
    elbow = shoulder + upper @ np.array([0.0, 0.0, -body.upper_arm])
    wrist = elbow + forearm @ np.array([0.0, 0.0, -body.forearm])
    return {"upper": Frames(shoulder, upper), "forearm": Frames(elbow, forearm), "hand": Frames(wrist, forearm)}


def reaching_arm(body, torso, sign, wrist):
    """Upper arm, forearm and hand of an arm whose wrist [T, 3] is given; the elbow points down, back and outwards."""
    shoulder = shoulder_of(body, torso, sign)
    reach = wrist - shoulder
    distance = np.linalg.norm(reach, axis=-1, keepdims=True)
    along = reach / distance
    upper, forearm = body.upper_arm, body.forearm
    before = (distance**2 + upper**2 - forearm**2) / (2.0 * distance)
    out = np.sqrt(np.maximum(upper**2 - before**2, 0.0))
    pole = np.array([-0.35, 0.55 * sign, -1.0]) - np.sum(along * np.array([-0.35, 0.55 * sign, -1.0]), -1, keepdims=True) * along
    elbow = shoulder + before * along + out * pole / np.linalg.norm(pole, axis=-1, keepdims=True)
    return {"upper": Frames(shoulder, _hanging_axes(shoulder - elbow)), "forearm": Frames(elbow, _hanging_axes(elbow - wrist)),
            "hand": Frames(wrist, _hanging_axes(elbow - wrist))}


def standing(body):
    """Frames of every part of a person who stands at the origin, at one instant."""
    distance = np.sqrt(body.thigh**2 + body.shank**2 + 2.0 * body.thigh * body.shank * np.cos(STANDING_KNEE))
    height = body.ankle_height + distance
    pelvis = Frames(np.array([[0.0, 0.0, height]]), about_z(np.zeros(1)))
    parts = trunk(body, pelvis, np.zeros(1))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        ankle = np.array([[0.0, sign * (0.5 * body.step_width + 0.02 * body.height), body.ankle_height]])
        parts.update({f"leg_{side}/{name}": value for name, value in leg(body, pelvis, sign, ankle, np.zeros(1)).items()})
        parts.update({f"arm_{side}/{name}": value for name, value in hanging_arm(body, parts["torso"], sign).items()})
    return parts


def _hanging_axes(up):
    """Axes [T, 3, 3] of a segment that hangs from its proximal joint: z along `up` [T, 3], x as far forward as it can."""
    z = up / np.linalg.norm(up, axis=-1, keepdims=True)
    y = np.cross(z, np.array([1.0, 0.0, 0.0]))
    y /= np.linalg.norm(y, axis=-1, keepdims=True)
    return np.stack([np.cross(y, z), y, z], axis=-1)
