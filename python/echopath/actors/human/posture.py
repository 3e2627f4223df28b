"""Postures: where the parts of a body are when its joints are given, standing, walking or on a bicycle.

Frames are those of keyframes.py: T instants, axes x forward, y left, z up.
"""
import numpy as np

from ...base.numerics.rotations import about_x, about_y, about_z
from ..keyframes import Frames

ARM_ABDUCTION = np.radians(7.0)
STANDING_KNEE = np.radians(8.0)
STANDING_ELBOW = np.radians(12.0)


def trunk(body, pelvis, lean, *, yaw=0.0, head_pitch=0.0):
    """Torso, neck and head over a pelvis (Frames), and that; lean [T] in rad, forward positive; yaw of the torso [T] in rad."""
    base = pelvis.origin + pelvis.rotation @ np.array([0.0, 0.0, body.spine_base])
    yaw = yaw + 0.0 * lean
    torso = Frames(base, about_z(yaw) @ about_y(lean))
    neck = Frames(base + torso.rotation @ np.array([0.0, 0.0, body.neck_above_spine_base]),
                  about_z(yaw / 2) @ about_y(lean / 2 + np.radians(8.0)))
    head = Frames(neck.origin + neck.rotation @ np.array([0.0, 0.0, body.neck]), about_y(0.0 * lean + head_pitch))
    return {"pelvis": pelvis, "torso": torso, "neck": neck, "head": head}


def bend_leg(hip, ankle, thigh, shank, heading):
    """Knee [T, 3] and axes of thigh and shank [T, 3, 3] of a leg from hip [T, 3] to ankle [T, 3] that bends forwards.

    thigh, shank: lengths in m; heading [T]: direction in rad, about z from x, of the vertical plane that the knee
    bends in when the leg is upright. The axes have z up the segment and y along the knee's axis, to the left.
    """
    leg = hip - ankle
    distance = np.linalg.norm(leg, axis=-1)
    up = leg / distance[:, None]
    axis = np.cross(up, np.stack([np.cos(heading), np.sin(heading), 0.0 * heading], axis=-1))
    axis /= np.linalg.norm(axis, axis=-1)[:, None]
    forward = np.cross(axis, up)
    below = (distance**2 + shank**2 - thigh**2) / (2 * distance)
    out = np.sqrt(shank**2 - below**2)
    knee = ankle + below[:, None] * up + out[:, None] * forward
    return knee, _segment_axes(hip - knee, axis), _segment_axes(knee - ankle, axis)


def _segment_axes(up, left):
    up = up / np.linalg.norm(up, axis=-1)[:, None]
    return np.stack([np.cross(left, up), left, up], axis=-1)


def leg(body, pelvis, sign, ankle, pitch):
    """Thigh, shank and foot from the hip of a side (left: 1) to an ankle [T, 3] with the foot's pitch [T], toes up positive."""
    hip = pelvis.origin + pelvis.rotation @ np.array([0.0, sign * body.hip_offset, 0.0])
    knee, thigh, shank = bend_leg(hip, ankle, body.thigh, body.shank, np.zeros(len(pitch)))
    return {"thigh": Frames(hip, thigh), "shank": Frames(knee, shank), "foot": Frames(ankle, about_y(-pitch))}


def shoulder_of(body, torso, sign):
    """The shoulder joint [T, 3] of a side."""
    return torso.origin + torso.rotation @ np.array([0.0, sign * body.shoulder_offset, body.shoulder_above_spine_base])


def hanging_arm(body, torso, sign, *, swing=0.0, elbow=STANDING_ELBOW, hand_pitch=0.0):
    """Upper arm, forearm and hand of an arm that hangs down.

    swing: of the upper arm forward, elbow: its bend, each [T] in rad or one for all; hand_pitch: rad, of the hand forward
    """
    still = np.zeros(len(torso.origin))
    shoulder = shoulder_of(body, torso, sign)
    upper = torso.rotation @ about_y(still - swing) @ about_x(still + sign * ARM_ABDUCTION)
    # The forearm hangs back towards the body by as much as the upper arm is spread.
    forearm = upper @ about_y(still - elbow) @ about_x(still - 0.8 * sign * ARM_ABDUCTION)
    at_elbow = shoulder + upper @ np.array([0.0, 0.0, -body.upper_arm])
    wrist = at_elbow + forearm @ np.array([0.0, 0.0, -body.forearm])
    hand = forearm @ about_y(still - hand_pitch)
    return {"upper": Frames(shoulder, upper), "forearm": Frames(at_elbow, forearm), "hand": Frames(wrist, hand)}


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
