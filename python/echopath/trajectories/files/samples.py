"""Samples of what moves, as files hold them, before they become trajectories."""
from __future__ import annotations

import datetime
import math
from array import array
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

from ...base.storage.lines import refuse

MOST_SAMPLES = 20_000_000
LATEST = 1e12           # s, of any time

_numbers = partial(array, "d")  # 8 bytes each: files have millions


@dataclass
class Samples:
    """Of one object, a row for each time at which the file has it.

    is_person: who is no vehicle, whatever the kind; has_fronts: whether places are those of the front bumper, not of the middle
    lines: [P], of the file; times: [P] s; coordinates: [3 P], of each row (x, y, z) in m, or (latitude, longitude, height) in
    degrees and m, heights NaN in rows without one; yaws: [P] rad, speeds: [P] m/s, or empty where the file has none
    told_in_degrees: whether the file calls its yaws degrees
    """

    kind: str = ""
    is_person: bool = False
    has_fronts: bool = False
    told_in_degrees: bool = False
    lines: array = field(default_factory=partial(array, "q"))
    times: array = field(default_factory=_numbers)
    coordinates: array = field(default_factory=_numbers)
    yaws: array = field(default_factory=_numbers)
    speeds: array = field(default_factory=_numbers)

    @property
    def places(self) -> np.ndarray:
        """[P, 3], the coordinates by rows."""
        return np.array(self.coordinates).reshape(-1, 3)

    def fill_heights(self) -> None:
        """Gives rows without a height one between those around, 0 where no row has any."""
        heights = np.array(self.coordinates[2::3])
        is_known = ~np.isnan(heights)
        if not is_known.all():
            times = np.array(self.times)
            heights = np.interp(times, times[is_known], heights[is_known]) if is_known.any() else np.zeros(len(times))
            self.coordinates[2::3] = array("d", heights)


def number(path: Path, line: int, name: str, text: str, most: float = 1e9) -> float:
    """A finite number of a file."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= most:
        refuse(path, line, f"{name}: must be a number from {-most:g} to {most:g}, got '{text.strip()[:60]}'")
    return value


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def instant(path: Path, line: int, name: str, text: str, unit: float = 1.0) -> float:
    """A time in s, of a number of units of so many s, or of ISO 8601 in s since 1970."""
    if _is_number(text):
        if unit == 1.0 and abs(float(text)) > LATEST:
            refuse(path, line, f"{name}: must be at most {LATEST:g} s, got '{text.strip()[:60]}'; a unit in brackets, such as "
                   f"'{name} [ns]', says in which it counts")
        return unit * number(path, line, name, text, LATEST / unit)
    try:
        moment = datetime.datetime.fromisoformat(text.strip())
    except ValueError:
        refuse(path, line, f"{name}: must be a number of seconds or a time such as 2026-05-01T12:00:00Z, got "
               f"'{text.strip()[:60]}'")
    if moment.tzinfo is None:
        moment = moment.replace(tzinfo=datetime.UTC)
    return moment.timestamp()
