"""Samples of what moves, as files hold them, before they become trajectories."""
from __future__ import annotations

import datetime
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

from .. import _core

MOST_SAMPLES = 20_000_000
MAX_BYTES = 2**31


@dataclass
class Samples:
    """Of one object: rows of time in s, coordinates and, where the file has them, yaw in rad and speed in m/s.

    lines: those of the file; places: (x, y, z) in m, or (latitude, longitude, height) in degrees and m
    """

    kind: str = ""
    is_person: bool = False
    lines: list[int] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    places: list[tuple[float, float, float]] = field(default_factory=list)
    yaws: list[float] = field(default_factory=list)
    speeds: list[float] = field(default_factory=list)


def refuse(path: Path, line: int, what: str) -> NoReturn:
    """Raises FileError naming the file and the line."""
    raise _core.FileError(f"{path}, line {line}: {what}")


def number(path: Path, line: int, name: str, text: str, most: float = 1e9) -> float:
    """A finite number of a file."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= most:
        refuse(path, line, f"{name}: must be a number from {-most:g} to {most:g}, got '{text.strip()[:60]}'")
    return value


def instant(path: Path, line: int, name: str, text: str, unit: float = 1.0) -> float:
    """A time in s, of a number of units of so many s, or of ISO 8601 in s since 1970."""
    try:
        return unit * number(path, line, name, text, 1e12 / unit)
    except _core.FileError:
        if "-" not in text[1:]:
            raise
    try:
        moment = datetime.datetime.fromisoformat(text.strip())
    except ValueError:
        refuse(path, line, f"{name}: must be a number of seconds or a time such as 2026-05-01T12:00:00Z, got "
               f"'{text.strip()[:60]}'")
    if moment.tzinfo is None:
        moment = moment.replace(tzinfo=datetime.UTC)
    return moment.timestamp()
