"""The walking person, moved by a motion capture."""
from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ... import _core
from ...arguments.checks import checked, choice, optional, positive, real
from ...arguments.number_rules import unit_rule
from ...base.numerics.rotations import about_z, quaternions
from ...base.process.callers import warn_user
from ...trajectories.trajectory import Trajectory
from ..actor import Actor, PartArrays
from ..following import refuse_beside_trajectory, trajectory_rule
from ..keyframes import Frames, key_times, with_rates
from .anthropometry import ANKLE_HEIGHT, HIP_HEIGHT, Proportions
from .body import surface
from .captured_along import CaptureAlong, cycle_of
from .captured_joints import find_joints, missing_joints
from .motion_capture import POSE_HELD, read_capture
from .pedestrian import HEIGHTS, SKIN_PARTS, edge_of, material_rule

UNITS = (1.0, 0.01, 0.0254, 0.3048, 0.001, 0.0254 / 0.45)  # m: metre, cm, inch, foot, mm, that of the CMU conversions
TYPICAL_HEIGHT = 1.75   # m
JUMP = 0.15             # m between the first two frames, and JUMPS times as far as any later step: a pose of its own
JUMPS = 4.0
ON_FLOOR = 0.10         # share of the frames in which the lower foot may be below the floor
ALONG = 0.87            # least cosine of the angle between an axis and a body that is along it
STANDS = 0.10           # least share of the frames with a body along y that makes y vertical, however it lies in the others
MOST_STRETCH = 10.0     # of a segment over that of a body of the same legs, up or down
MOST_SPEED = 0.1 * _core.speed_of_light  # m/s
TRAVEL = 0.5            # m from which on the way of the body is its direction
KEYFRAME_RATE = 120.0   # 1/s, along a trajectory


@checked(height=optional(real(*HEIGHTS, unit="m")), unit=optional(unit_rule), up=optional(choice("x", "y", "z")),
         offset=real(unit="s"), edge=positive("m"), clothing=material_rule, skin=material_rule, trajectory=trajectory_rule)
def captured_pedestrian(path: str | os.PathLike[str], *, height: float | None = None, unit: float | None = None,
                        up: str | None = None, offset: float = 0.0, edge: float = 0.018,
                        clothing: str | _core.Material = "clothing", skin: str | _core.Material = "skin",
                        trajectory: Trajectory | None = None) -> Actor:
    """A person who moves as a motion capture says, with the parts, names and materials of `pedestrian`.

    Each part sits at its captured joint and points along its captured segment, whose length it takes, so joints move exactly
    as captured (smoothly between the frames, by C2 cubics). Joints are known by their usual names (CMU, Mixamo, Poser and
    others). The lower sole is on the floor z = 0 in all but a tenth of the frames, where it is below.

    Frame: x forward (the way from first to last frame, or where a person looks who stays), y left, z up; at time 0 the
    pelvis is above the origin.

    path: of a BVH file
    height: of the body in m, which scales the capture; None: as captured
    unit: m per unit of the file; None: that of cm, m, inches, feet, mm and the conversions of the CMU library which makes
        the body nearest to 1.75 m
    up: vertical axis of the file, "x", "y" or "z"; None: y, unless the body is along another one most of the time and along y in
        less than a tenth of the frames. In more of them it may stand and then fall: a warning says that y is taken
    offset: s, time of the capture at time 0. It lasts as long as the capture; a scene can be posed at no other time
    edge, clothing, skin: as of `pedestrian`
    trajectory: a Trajectory of the origin that is followed, instead of offset: the captured cycle of steps that closes best, of
        half a metre at least, is repeated, so fast that feet which stand in the capture stand on a straight way; in curves they
        turn with the body, at stops the pose stays
    Returns an Actor. Raises ep.FileError naming the file and what is wrong with it, ValueError or TypeError naming the
    argument.
    """
    refuse_beside_trajectory(trajectory, offset=(offset, 0.0))
    body = captured_body(Path(path), unit=unit, up=up, height=height)
    if trajectory is not None:
        return Actor([part.build() for part in body.parts_along(trajectory, edge, clothing, skin)], trajectory)
    return Actor([part.build() for part in body.parts(offset, edge, clothing, skin)])


def captured_body(path: Path, *, unit: float | None, up: str | None, height: float | None) -> CapturedBody:
    """The body of a BVH file."""
    capture = read_capture(path)
    found = find_joints([joint.name for joint in capture.joints])
    if missing_joints(found):
        names = ", ".join(joint.name for joint in capture.joints)
        raise _core.FileError(f"{path}: must be the capture of a person, but has no joint for "
                              f"{', '.join(missing_joints(found))}; its joints are {names[:400]}")
    vertical = up or _vertical_axis(path, capture.positions, found)
    axis = "xyz".index(vertical)
    order = [(axis + 1) % 3, (axis + 2) % 3, axis]  # what becomes x, y and z
    positions = capture.positions[:, list(found.values())][..., order]
    rotations = capture.rotations[:, list(found.values())][..., order, :][..., order]
    notes = [] if up or vertical == "y" else [f"its vertical axis is taken to be {vertical}, along which the body is"]
    joints = CapturedJoints(capture.times, dict(zip(found, positions.swapaxes(0, 1))),
                            dict(zip(found, rotations.swapaxes(0, 1))))
    return CapturedBody(path, vertical, notes, joints, unit=unit, height=height)


class CapturedJoints(NamedTuple):
    """Places [T, 3] in units of the file and rotations [T, 3, 3] of joints by name, at times [T] in s."""

    times: np.ndarray
    places: dict
    rotations: dict


class CapturedBody:
    """Joints over time in the axes of a scene. unit: m per unit of the file; notes: what was guessed or left out."""

    def __init__(self, path: Path, up: str, notes: list, joints: CapturedJoints, *, unit: float | None,
                 height: float | None):
        self._path, self.up, self.notes = path, up, notes
        self.times, self._joints, self._rotations = _without_first_pose(*joints, self.notes)
        tall = self._length("hip", "knee", "ankle") / (HIP_HEIGHT - ANKLE_HEIGHT)
        if not 1e-9 < tall < 1e9:
            raise _core.FileError(f"{path}: its legs have no length")
        self.unit = unit or min(UNITS, key=lambda one: abs(np.log(one * tall / TYPICAL_HEIGHT)))
        if unit is None:
            self.notes.append(f"its unit is taken to be {self.unit:g} m, which makes the person {self.unit * tall:.2f} m tall")
        scale = self.unit if height is None else height / tall
        self._joints = {name: scale * place for name, place in self._joints.items()}
        if not HEIGHTS[0] <= scale * tall <= HEIGHTS[1]:
            raise _core.FileError(f"{path}: a person of {scale * tall:.3g} m must be from {HEIGHTS[0]} to {HEIGHTS[1]} m tall: "
                                  f"with unit={TYPICAL_HEIGHT / tall:.3g} it is {TYPICAL_HEIGHT} m")
        self.body = Proportions(scale * tall)

    @property
    def is_pose(self) -> bool:
        """Whether the file has a single frame: no two of others are so far apart."""
        return float(self.times[1] - self.times[0]) == POSE_HELD

    def parts(self, offset: float, edge: float, clothing, skin) -> list[PartArrays]:
        """PartArrays of the actor; arguments as of captured_pedestrian."""
        frames, surfaces = self._surfaced(offset, edge)
        return _arrays(frames, surfaces, self.times - offset, clothing, skin)

    def parts_along(self, trajectory: Trajectory, edge: float, clothing, skin) -> list[PartArrays]:
        """PartArrays of the actor along a trajectory; arguments as of captured_pedestrian."""
        frames, surfaces = self._surfaced(float(self.times[0]), edge)
        along = CaptureAlong(cycle_of(frames, self.times, self._path), trajectory._track)
        times = key_times(trajectory, KEYFRAME_RATE)
        return with_rates(_arrays(along.frames(times), surfaces, times, clothing, skin), along.frames, times)

    def _surfaced(self, offset: float, edge: float) -> tuple[dict[str, Frames], dict]:
        """Frames of every part as they stand in the actor, and (vertices, triangles) of its surface."""
        edge = edge_of(self.body, edge)
        frames, stretch = self._frames()
        kinds = {name: name.rsplit("/")[-1] for name in frames}
        of_kind = {kind: surface(kind, self.body, edge) for kind in dict.fromkeys(kinds.values())}
        surfaces = {name: of_kind[kind] for name, kind in kinds.items()}
        self._place(frames, surfaces, offset)
        self._check_speeds(frames)
        return frames, {name: (vertices * [1.0, 1.0, stretch.get(name, 1.0)], triangles)
                        for name, (vertices, triangles) in surfaces.items()}

    def _check_speeds(self, frames: dict[str, Frames]) -> None:
        """Raises FileError for a part that is carried as fast as light, which splines through its frames may exceed."""
        for name, frame in frames.items():
            steps = np.linalg.norm(np.diff(frame.origin, axis=0), axis=-1) / np.diff(self.times)
            if steps.max(initial=0.0) > MOST_SPEED:
                raise _core.FileError(f"{self._path}: its {name} moves by {steps.max():.3g} m/s")

    def _length(self, *names: str) -> float:
        """Mean length of a chain of joints, over both sides and time."""
        return float(np.mean([sum(np.linalg.norm(self._joints[f"{side}_{a}"] - self._joints[f"{side}_{b}"], axis=-1)
                                  for a, b in zip(names, names[1:])).mean() for side in ("left", "right")]))

    def _frames(self) -> tuple[dict[str, Frames], dict[str, float]]:
        """Frames of every part, by name, and by how much parts are longer than those of a body of that height."""
        joints, body = self._joints, self.body
        hips, shoulders = (0.5 * (joints[f"left_{name}"] + joints[f"right_{name}"]) for name in ("hip", "shoulder"))
        up = shoulders - hips
        pelvis = Frames(hips, _axes(up, joints["left_hip"] - joints["right_hip"]))
        across = joints["left_shoulder"] - joints["right_shoulder"]
        torso = Frames(hips + pelvis.rotation @ [0.0, 0.0, body.spine_base], _axes(up, across))
        taller = float((np.linalg.norm(up, axis=-1).mean() - body.spine_base) / body.shoulder_above_spine_base)
        base = torso.origin + torso.rotation @ [0.0, 0.0, taller * body.neck_above_spine_base]
        neck = Frames(base, _axes(joints["head"] - base, across))
        frames = {"pelvis": pelvis, "torso": torso, "neck": neck, "head": self._head(torso)}
        stretch = {"torso": taller, "neck": float(np.linalg.norm(joints["head"] - base, axis=-1).mean() / body.neck)}
        for side in ("left", "right"):
            for limb, names, lengths in (("leg", ("thigh", "shank"), (body.thigh, body.shank)),
                                         ("arm", ("upper", "forearm"), (body.upper_arm, body.forearm))):
                chain = ("hip", "knee", "ankle") if limb == "leg" else ("shoulder", "elbow", "wrist")
                left = pelvis.rotation[..., 1] if limb == "leg" else torso.rotation[..., 1]
                for name, begin, end, length in zip(names, chain, chain[1:], lengths):
                    key = f"{limb}_{side}/{name}"
                    frames[key] = self._limb(f"{side}_{begin}", f"{side}_{end}", left)
                    segment = joints[f"{side}_{begin}"] - joints[f"{side}_{end}"]
                    stretch[key] = float(np.linalg.norm(segment, axis=-1).mean()) / length
            frames[f"leg_{side}/foot"] = self._foot(side, frames[f"leg_{side}/shank"])
            frames[f"arm_{side}/hand"] = self._hand(side, frames[f"arm_{side}/forearm"])
        for name, times in stretch.items():
            if not 1.0 / MOST_STRETCH <= times <= MOST_STRETCH:
                raise _core.FileError(f"{self._path}: its {name} is {times:.3g} times as long as that of a body of such legs")
        return frames, stretch

    def _limb(self, begin: str, end: str, left) -> Frames:
        """Axes that turn with the joint: z up the segment, y to the left where the segment is most across it."""
        up = self._joints[begin] - self._joints[end]
        slant = np.abs(np.einsum("ti,ti->t", up, left)) / np.linalg.norm(up, axis=-1)
        return self._turning(begin, int(slant.argmin()), _axes(up, left))

    def _turning(self, joint: str, reference: int, axes) -> Frames:
        """Axes [T, 3, 3] fixed to a joint, which are those given in the frame `reference`."""
        turn = self._rotations[joint]
        return Frames(self._joints[joint], turn @ (turn[reference].T @ axes[reference]))

    def _head(self, torso: Frames) -> Frames:
        upright = int(torso.rotation[:, 2, 2].argmax())
        return self._turning("head", upright, _axes(np.broadcast_to([0.0, 0.0, 1.0], torso.origin.shape), torso.rotation[..., 1]))

    def _hand(self, side: str, forearm: Frames) -> Frames:
        """Straight on from the forearm where the wrist turns least from the file's pose at rest."""
        turn_of = self._rotations
        aligned = int(np.einsum("tij,tij->t", turn_of[f"{side}_elbow"], turn_of[f"{side}_wrist"]).argmax())
        return self._turning(f"{side}_wrist", aligned, forearm.rotation)

    def _foot(self, side: str, shank: Frames) -> Frames:
        """Flat, and ahead to the toes, where it is lowest and slowest."""
        ankle = self._joints[f"{side}_ankle"]
        ahead = self._joints[f"{side}_toe"] - ankle if f"{side}_toe" in self._joints else shank.rotation[..., 0]
        speed = np.linalg.norm(np.gradient(ankle, self.times, axis=0), axis=-1)
        height = ankle[:, 2] - ankle[:, 2].min()
        flat = int((speed / max(float(speed.max()), 1e-9) + height / max(float(height.max()), 1e-9)).argmin())
        up = np.broadcast_to([0.0, 0.0, 1.0], ankle.shape)
        return self._turning(f"{side}_ankle", flat, _axes(up, np.cross(up, ahead)))

    def _place(self, frames: dict[str, Frames], surfaces: dict, offset: float) -> None:
        """Turns and moves all frames: ahead along x, at time 0 above the origin, soles on the floor."""
        begin = self.times[0] - 1e-9
        if not begin <= offset <= self.times[-1] + 1e-9:
            raise ValueError(f"offset: must be a time of the capture, 0 to {self.times[-1]:g} s, got {offset:g}")
        pelvis = frames["pelvis"]
        way = (pelvis.origin[-1] - pelvis.origin[0])[:2]
        ahead = way if np.linalg.norm(way) > TRAVEL else pelvis.rotation[0, :2, 0]
        turn = about_z(-np.arctan2(ahead[1], ahead[0]))
        start = turn @ np.array([np.interp(offset, self.times, pelvis.origin[:, axis]) for axis in range(3)])
        start[2] = self._floor(frames, surfaces)
        for name, frame in frames.items():
            frames[name] = Frames(frame.origin @ turn.T - start, turn @ frame.rotation)

    def _floor(self, frames: dict[str, Frames], surfaces: dict) -> float:
        """Height of the floor: that which the lower sole is below in ON_FLOOR of the frames."""
        lowest = [(frames[name].rotation[:, 2] @ surfaces[name][0].T).min(axis=1) + frames[name].origin[:, 2]
                  for name in ("leg_left/foot", "leg_right/foot")]
        return float(np.quantile(np.minimum(*lowest), ON_FLOOR))


def _arrays(frames: dict[str, Frames], surfaces: dict, times, clothing, skin) -> list[PartArrays]:
    return [PartArrays(name, *surfaces[name], skin if name.rsplit("/")[-1] in SKIN_PARTS else clothing, times, frame.origin,
                       quaternions(frame.rotation), smooth=True) for name, frame in frames.items()]


def _axes(up, left) -> np.ndarray:
    """[T, 3, 3]: z along `up` [T, 3], y as near to `left` [T, 3] as may be."""
    z = _unit(up)
    y = left - np.einsum("ti,ti->t", left, z)[:, None] * z
    other = np.cross(z, np.roll(z, 1, axis=-1) + [0.0, 0.0, 1e-3])  # any direction across it, where `left` is along it
    y = _unit(np.where(np.linalg.norm(y, axis=-1)[:, None] > 1e-9, y, other))
    return np.stack([np.cross(y, z), y, z], axis=-1)


def _unit(vectors) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1)[:, None]
    return np.where(length > 1e-12, vectors / np.maximum(length, 1e-12), np.array([0.0, 0.0, 1.0]))


def _vertical_axis(path: Path, positions, found: dict[str, int]) -> str:
    """The axis from the feet to the head, on the mean over time, where it is clearly another one than y, and y where the body is
    along it in some frames all the same, with a warning: it lies in those, or in the others."""
    tall = positions[:, found["head"]] - 0.5 * (positions[:, found["left_ankle"]] + positions[:, found["right_ankle"]])
    mean = np.abs(tall.mean(axis=0))
    axis = "xyz"[int(mean.argmax())]
    if mean[1] >= 0.5 * mean.max():
        return "y"
    along_y = float(np.mean(np.abs(tall[:, 1]) > ALONG * np.linalg.norm(tall, axis=1)))
    if along_y < STANDS:
        return axis
    warn_user(f"up: {path.name} has a body along y in {100.0 * along_y:.0f} % of its frames and along {axis} in most "
              f"others, as of someone who falls; y is taken for the vertical axis: say up=\"y\" where it is, else up=\"{axis}\"")
    return "y"


def _without_first_pose(times, joints: dict, rotations: dict, notes: list):
    """Leaves out a first frame that is a pose of its own, as libraries put it before the motion."""
    if len(times) < 4:
        return times, joints, rotations
    relative = np.stack([place - joints["left_hip"] for place in joints.values()])
    steps = np.linalg.norm(np.diff(relative, axis=1), axis=-1).max(axis=0)
    tall = np.linalg.norm(joints["left_hip"][0] - joints["left_ankle"][0])
    if steps[0] < JUMP * tall or steps[0] < JUMPS * steps[1:].max():
        return times, joints, rotations
    notes.append("the first frame, a pose of its own, is left out")
    return (times[1:] - times[1], {name: place[1:] for name, place in joints.items()},
            {name: turn[1:] for name, turn in rotations.items()})
