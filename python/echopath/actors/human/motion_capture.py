"""Motion capture in Biovision Hierarchy (BVH): joints, and where they are in each frame."""
from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ... import _core
from ...base.numerics.rotations import about_x, about_y, about_z
from ...base.storage.files import require_readable

MOST_JOINTS = 10_000
MOST_VALUES = 200_000_000  # joints times frames
MOST_NAME_WORDS = 20       # of a joint
POSE_HELD = 86_400.0       # s, that a file of a single frame, a pose, stays as it is
MAX_BYTES = 2**30
CHANNELS = ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation")
_TURNS = {"X": about_x, "Y": about_y, "Z": about_z}


@dataclass
class CapturedJoint:
    """name: as in the file, that of an end is its joint's with "_end"; parent: index, -1: none; offset [3] from the parent."""

    name: str
    parent: int
    offset: np.ndarray
    channels: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Capture:
    """joints: parents first; times [T] in s from the first frame; positions [T, J, 3] in units and axes of the file;
    rotations [T, J, 3, 3] of the joints in those axes."""

    joints: list[CapturedJoint]
    times: np.ndarray
    positions: np.ndarray
    rotations: np.ndarray


def read_capture(path: Path) -> Capture:
    """Reads a BVH file. Raises FileError naming the file and the word that is wrong."""
    words = _Words(path)
    words.expect("HIERARCHY")
    words.expect("ROOT")
    joints = _read_joints(words)
    words.expect("MOTION")
    words.expect_title("Frames:")
    num_frames = words.whole(1, MOST_VALUES // len(joints))
    words.expect("Frame")
    words.expect_title("Time:")
    frame_time = words.number()
    if not 1e-6 <= frame_time <= 100.0:
        words.refuse(f"the frame time must be from 1e-6 to 100 s, got {frame_time:g}")
    num_channels = sum(len(joint.channels) for joint in joints)
    values = words.numbers(num_frames * num_channels).reshape(num_frames, num_channels)
    if num_frames == 1:
        values, frame_time = np.repeat(values, 2, axis=0), POSE_HELD
    return Capture(joints, frame_time * np.arange(len(values)), *_posed(joints, values))


class _Words:
    """The words of a file, one after the other."""

    def __init__(self, path: Path):
        self._path = path
        require_readable(path)
        try:
            if path.stat().st_size > MAX_BYTES:
                raise _core.FileError(f"{path}: is larger than {MAX_BYTES} bytes")
            self._words = path.read_text(encoding="utf-8-sig", errors="replace").split()
        except OSError as error:
            raise _core.FileError(f"{path}: cannot be opened ({error.strerror})") from None
        self._at = 0

    def next(self) -> str:
        if self._at >= len(self._words):
            self.refuse("the file ends too early")
        self._at += 1
        return self._words[self._at - 1]

    def expect(self, word: str) -> None:
        found = self.next()
        if found.lower() != word.lower():
            self.refuse(f"must have '{word}' where it has '{found[:40]}'")

    def expect_title(self, word: str) -> None:
        """Expects a word behind which a number may stand without a space."""
        if self._at < len(self._words) and self._words[self._at].lower().startswith(word.lower()):
            number = self._words[self._at][len(word):]
            self._words[self._at:self._at + 1] = [word, number] if number else [word]
        self.expect(word)

    def name(self) -> str:
        """The words up to the next brace, since names of joints may have spaces."""
        words = [self.next()]
        while self._at < len(self._words) and self._words[self._at] != "{":
            words.append(self.next())
            if len(words) > MOST_NAME_WORDS:
                self.refuse(f"must have '{{' behind the name of a joint, got '{' '.join(words)[:40]}'")
        return " ".join(words)

    def number(self) -> float:
        word = self.next()
        try:
            value = float(word)
        except ValueError:
            value = np.inf
        if not abs(value) < 1e30:
            self.refuse(f"must have a number where it has '{word[:40]}'")
        return value

    def whole(self, least: int, most: int) -> int:
        value = self.number()
        if value != int(value) or not least <= value <= most:
            self.refuse(f"must have a whole number from {least} to {most}, got {value:g}")
        return int(value)

    def numbers(self, count: int) -> np.ndarray:
        left = len(self._words) - self._at
        if left < count:
            self.refuse(f"the file ends too early: it should have {count} values of channels and has {left}")
        try:
            values = np.array(self._words[self._at:self._at + count], float)
        except ValueError as error:
            self.refuse(f"channels must be numbers ({str(error)[:80]})")
        if not (np.abs(values) < 1e30).all():
            self.refuse("channels must be finite numbers")
        self._at += count
        return values

    def refuse(self, what: str):
        raise _core.FileError(f"{self._path}: {what} (word {self._at})")


def _read_joints(words: _Words) -> list[CapturedJoint]:
    """The tree behind ROOT, parents first."""
    joints: list[CapturedJoint] = []
    open_joints: list[int] = []
    name = words.name()
    while True:
        if len(joints) >= MOST_JOINTS:
            words.refuse(f"has more than {MOST_JOINTS} joints")
        words.expect("{")
        words.expect("OFFSET")
        joints.append(CapturedJoint(name, open_joints[-1] if open_joints else -1,
                                    np.array([words.number() for _ in range(3)])))
        open_joints.append(len(joints) - 1)
        word = words.next()
        if word.upper() == "CHANNELS":
            joints[-1].channels = _read_channels(words)
            word = words.next()
        while word == "}":
            open_joints.pop()
            if not open_joints:
                return joints
            word = words.next()
        if word.upper() not in ("JOINT", "END"):
            words.refuse(f"must have JOINT, End Site or '}}' where it has '{word[:40]}'")
        name = words.name()
        if word.upper() == "END":
            name = f"{joints[open_joints[-1]].name}_end"


def _read_channels(words: _Words) -> list[str]:
    known = {channel.lower(): channel for channel in CHANNELS}
    channels = [words.next() for _ in range(words.whole(0, 6))]
    for channel in channels:
        if channel.lower() not in known:
            words.refuse(f"must have a channel such as Xrotation where it has '{channel[:40]}'")
    return [known[channel.lower()] for channel in channels]


def _posed(joints: list[CapturedJoint], values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(positions [T, J, 3], rotations [T, J, 3, 3]) of channels [T, C]: turns in the order in which they stand."""
    count = len(values)
    positions, rotations = np.empty((count, len(joints), 3)), np.empty((count, len(joints), 3, 3))
    first = 0
    for index, joint in enumerate(joints):
        own = values[:, first:first + len(joint.channels)]
        first += len(joint.channels)
        place = np.broadcast_to(joint.offset, (count, 3)).copy()
        turn = np.broadcast_to(np.eye(3), (count, 3, 3))
        for channel, value in zip(joint.channels, own.T):
            if channel.endswith("position"):
                place[:, "XYZ".index(channel[0])] = value
            else:
                turn = turn @ _TURNS[channel[0]](np.radians(value))
        if joint.parent < 0:
            positions[:, index], rotations[:, index] = place, turn
        else:
            above = rotations[:, joint.parent]
            positions[:, index] = positions[:, joint.parent] + np.einsum("tij,tj->ti", above, place)
            rotations[:, index] = above @ turn
    return positions, rotations
