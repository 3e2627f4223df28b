"""Patterns of two cuts, as makers of antennas and planners of networks exchange them (MSI Planet).

Angles of the horizontal cut turn clockwise seen from above, those of the vertical one from the horizon ahead downward; the losses
count from the largest gain.
"""
from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...arguments.checks import ArrayLike

DBI_OF_DBD = 2.15                             # gain of a half-wave dipole
CUTS = ("HORIZONTAL", "VERTICAL")
DARKEST_DB = -120.0                           # what a cut has of its largest gain at least
ELEVATION_DEG = np.linspace(-90.0, 90.0, 181)
AZIMUTH_DEG = np.linspace(-180.0, 179.0, 360)
_HEAD = re.compile(r"\s*(HORIZONTAL|VERTICAL)(\s+[-+.\d]+)?\s*", re.IGNORECASE)
_GAIN = re.compile(r"\s*([-+.\deE]+)\s*(dbi|dbd)?\s*", re.IGNORECASE)


class _Cut(NamedTuple):
    angle_deg: NDArray[np.float64]  # ascending
    level_db: NDArray[np.float64]   # over the largest gain, at most 0

    def power(self, angle_deg: ArrayLike) -> NDArray[np.float64]:
        """Over that of the largest gain."""
        return 10.0 ** (0.1 * np.maximum(np.interp(angle_deg, self.angle_deg, self.level_db, period=360.0), DARKEST_DB))

    def peak(self) -> float:
        """The angle of the largest level, -180 to 180, of equal ones the nearest to 0."""
        highest = (self.angle_deg[self.level_db == self.level_db.max()] + 180.0) % 360.0 - 180.0
        return float(highest[np.argmin(np.abs(highest))])


def are_cuts(lines: list[str]) -> bool:
    """Whether lines are of this kind."""
    return any(_HEAD.fullmatch(line) for line in lines)


def pattern_of_cuts(lines: list[str], normalize: bool) -> _core.AntennaPattern:
    """The pattern of two cuts that meet in the direction of the largest gain, and behind it.

    Over elevations the power goes as the vertical cut, of which front and back count by the share of the azimuth between them,
    times what the horizontal cut has at that azimuth over what these two have where they meet it. That ratio fades with the
    cosine of the elevation, so that up and down are one direction each, and nulls of the horizontal cut fill up. Where cuts
    agree in both places, both are met exactly. Raises ValueError naming the line.
    """
    gain = _gain(lines)
    across, along = (_cut(lines, name) for name in CUTS)
    peak, meeting = across.peak(), -along.peak()  # degrees: azimuth to the right, elevation
    behind = np.abs((-AZIMUTH_DEG - peak + 180.0) % 360.0 - 180.0) / 180.0

    def over_elevation(elevation_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        front, back = (along.power(angle)[..., None] for angle in (-elevation_deg, 180.0 + elevation_deg))
        return (1.0 - behind) * front + behind * back

    fading = np.clip(np.cos(np.radians(ELEVATION_DEG)) / np.cos(np.radians(meeting)), 0.0, 1.0)[:, None]
    filling = (1.0 - fading) ** 2
    ratio = (across.power(-AZIMUTH_DEG) + filling) / (over_elevation(np.array([meeting])) + filling)
    power = over_elevation(ELEVATION_DEG) * ratio ** fading
    return _core.GainTable(azimuth=np.radians(AZIMUTH_DEG), elevation=np.radians(ELEVATION_DEG),
                           gain=10.0 ** (0.1 * gain) * power, normalize=normalize)


def _keyword(line: str) -> str:
    return line.split(maxsplit=1)[0].upper() if line.strip() else ""


def _gain(lines: list[str]) -> float:
    """dB over isotropic. Raises ValueError naming the line."""
    number, line = next(((number, line) for number, line in enumerate(lines, 1) if _keyword(line) == "GAIN"), (0, ""))
    if not number:
        raise ValueError("holds no line GAIN, such as GAIN 12.5 dBi")
    found = _GAIN.fullmatch(line.split(maxsplit=1)[1] if len(line.split()) > 1 else "")
    try:
        value = float(found[1] if found else "")
    except ValueError:
        raise ValueError(f"line {number}: GAIN must be a number with dBd, as where it says nothing, or dBi, got "
                         f"'{line.strip()}'") from None
    return value if (found[2] or "").lower() == "dbi" else value + DBI_OF_DBD


def _cut(lines: list[str], name: str) -> _Cut:
    """Of the lines below a keyword with their number. Raises ValueError naming the line."""
    start = next((number for number, line in enumerate(lines, 1) if _keyword(line) == name), None)
    if start is None:
        raise ValueError(f"holds no cut {name}; one cut makes no pattern")
    count = lines[start - 1].split()[1:]
    if len(count) != 1 or not count[0].isdigit() or int(count[0]) < 2:
        raise ValueError(f"line {start}: {name} must have the number of its lines, at least 2, got '{lines[start - 1].strip()}'")
    rows = [(number, line.split()) for number, line in enumerate(lines[start:], start + 1) if line.strip()][:int(count[0])]
    values = []
    for number, row in rows:
        try:
            angle, loss = map(float, row)
        except ValueError:
            raise ValueError(f"line {number}: must have an angle and a loss, got '{' '.join(row)}'; {name} has "
                             f"{count[0]} lines") from None
        if not (np.isfinite(angle) and np.isfinite(loss)):
            raise ValueError(f"line {number}: angle and loss must be finite, got '{' '.join(row)}'")
        values.append((angle % 360.0, -loss))
    if len(values) < int(count[0]):
        raise ValueError(f"line {start}: {name} must have {count[0]} lines, has {len(values)}")
    angles, first = np.unique(np.round([value[0] for value in values], 6) % 360.0, return_index=True)
    return _Cut(angles, np.array([values[index][1] for index in first]))
