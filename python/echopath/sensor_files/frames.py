"""Frames and sub-frames of a mmWave configuration: which chirps they send how often."""
from __future__ import annotations

from typing import NamedTuple

from .cfg import Command, Lines

MOST_CHIRPS = 512  # of one loop, whose indices end at 511 (mmWave SDK, chirpCfg)
ADVANCED = 3  # dfeDataOutputMode of frames that have sub-frames


class FramePlan(NamedTuple):
    """A frame or sub-frame.

    command: its line; subframe: its index, 0 of plain frames; first, num_chirps: indices of the chirps of one loop
    num_loops: of them; forced_profile: instead of that of the chirps, -1: none
    start_time: s, after the frame's start; interval: s, from frame to frame, period: s, of it alone, 0: not told
    num_frames: 0: without end
    """

    command: Command
    subframe: int
    first: int
    num_chirps: int
    num_loops: int
    forced_profile: int
    start_time: float
    interval: float
    period: float
    num_frames: int

    def check_duration(self, duration: float) -> None:
        """Raises ep.FileError naming the line where the chirps take longer. duration: s, from the first to the last sample"""
        if 0.0 < self.period < duration:
            raise self.command.error(f"period_ms: must be at least {1e3 * duration:.6g}, the time of its chirps, got "
                                     f"{1e3 * self.period:g}")


def plans_of(lines: Lines) -> list[FramePlan]:
    """The frame, or its sub-frames. Raises ep.FileError naming the line."""
    modes = lines.of("dfeDataOutputMode")
    if modes and modes[-1]["mode"] == ADVANCED or not modes and lines.of("advFrameCfg"):
        return _subframes(lines)
    if modes and modes[-1]["mode"] != 1:
        raise modes[-1].error(f"mode: must be 1 (frames) or {ADVANCED} (sub-frames), got {modes[-1]['mode']}")
    frame = lines.one("frameCfg")
    count = _num_chirps(frame, "last", frame["last"] - frame["first"] + 1)
    period = 1e-3 * _from_zero(frame, "period_ms")
    return [FramePlan(frame, 0, frame["first"], count, _positive(frame, "num_loops", frame["num_loops"]), -1, 0.0,
                      period, period, _from_zero(frame, "num_frames"))]


def _subframes(lines: Lines) -> list[FramePlan]:
    frame = lines.one("advFrameCfg")
    given = {command["subframe"]: command for command in lines.of("subFrameCfg")}
    commands = []
    for index in range(_positive(frame, "num_subframes", frame["num_subframes"])):
        if index not in given:
            raise frame.error(f"num_subframes: subFrameCfg {index} is missing")
        commands.append(given[index])
    plans, start, interval = [], 0.0, sum(1e-3 * _from_zero(command, "period_ms") for command in commands)
    for index, command in enumerate(commands):
        if command["num_bursts"] * command["num_burst_loops"] != 1:
            raise command.error("num_bursts, num_burst_loops: must be 1, other bursts are not known")
        plans.append(FramePlan(command, index, command["first"], _num_chirps(command, "num_chirps", command["num_chirps"]),
                               _positive(command, "num_loops", command["num_loops"]), command["forced_profile"], start,
                               interval, 1e-3 * command["period_ms"], _from_zero(frame, "num_frames")))
        start += 1e-3 * command["period_ms"]
    return plans


def _num_chirps(command: Command, name: str, value: int) -> int:
    if _positive(command, name, value) > MOST_CHIRPS:
        raise command.error(f"{name}: must leave at most {MOST_CHIRPS}, got {value}")
    return value


def _from_zero(command: Command, name: str):
    if command[name] < 0:
        raise command.error(f"{name}: must be at least 0, got {command[name]:g}")
    return command[name]


def _positive(command: Command, name: str, value: int) -> int:
    if value < 1:
        raise command.error(f"{name}: must leave at least 1, got {value}")
    return value
