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
ELEVATION_DEG = np.linspace(-90.0, 90.0, 181)
AZIMUTH_DEG = np.linspace(-180.0, 179.0, 360)
_GAIN = re.compile(r"\s*([-+.\deE]+)\s*(dbi|dbd)?\s*", re.IGNORECASE)


class _Cut(NamedTuple):
    angle_deg: NDArray[np.float64]  # ascending
    level_db: NDArray[np.float64]   # over the largest gain, at most 0

    def at(self, angle_deg: ArrayLike) -> NDArray[np.float64]:
        return np.interp(angle_deg, self.angle_deg, self.level_db, period=360.0)

    def peak(self) -> float:
        """The angle of the largest level, of equal ones the nearest to 0."""
        highest = self.angle_deg[self.level_db == self.level_db.max()]
        return float(highest[np.argmin(np.minimum(highest, 360.0 - highest))])


def are_cuts(lines: list[str]) -> bool:
    """Whether lines are of this kind."""
    return any(_keyword(line) in CUTS for line in lines)


def pattern_of_cuts(lines: list[str], normalize: bool) -> _core.AntennaPattern:
    """The pattern of two cuts through the direction of the largest gain.

    At an elevation the level in dB is that of the horizontal cut and what the vertical cut differs there from where both meet, in
    front and behind, by the share of the azimuth between them (Gil, Claro, Ferreira, Pardelinha and Correia, IEEE Antennas and
    Propagation Magazine 43, 2001). Raises ValueError naming the line.
    """
    gain = _gain(lines)
    across, along = (_cut(lines, name) for name in CUTS)
    peak = across.peak()
    behind = np.abs((-AZIMUTH_DEG - peak + 180.0) % 360.0 - 180.0) / 180.0
    level = across.at(-AZIMUTH_DEG) + np.zeros((len(ELEVATION_DEG), 1))
    for share, there, meeting in ((1.0 - behind, along.at(-ELEVATION_DEG), across.at(peak)),
                                  (behind, along.at(180.0 + ELEVATION_DEG), across.at(peak + 180.0))):
        level += share * (there - meeting)[:, None]
    return _core.GainTable(azimuth=np.radians(AZIMUTH_DEG), elevation=np.radians(ELEVATION_DEG),
                           gain=10.0 ** (0.1 * (gain + level)), normalize=normalize)


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
