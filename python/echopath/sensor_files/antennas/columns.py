"""Columns of tables of gain over two angles: by our names, and as field solvers head them."""
from __future__ import annotations

import csv
import math
import re
from typing import NamedTuple

OWN = ("azimuth_deg", "elevation_deg", "gain_db", "phase_deg")
PAIRS = (("azimuth", "elevation"), ("theta", "phi"))

# Each pattern takes a cell of a head in lower case, without its spaces.
_ANGLE = re.compile(r"(azimuth|elevation|theta|phi)(?:[_\[(]?(deg|rad)(?:rees?|ians?)?\.?[\])]?)?")
_PHASE = re.compile(r"phase_deg")
_DECIBELS = (re.compile(r"(?:reali[sz]ed)?(?:gain|directivity)[_\[(]dbi?[\])]?"),        # gain_db, Gain (dBi)
             re.compile(r"db(?:10)?\((?:reali[sz]ed)?(?:gain|dir)(?:total)?\)(?:\[.*\])?"),  # HFSS: dB(GainTotal) []
             re.compile(r"abs\((?:(?:reali[sz]ed)?(?:gain|dir|directivity)|grlz)\.?\)\[dbi?\]"),  # CST: Abs(Gain)[dBi   ]
             re.compile(r"(?:reali[sz]ed)?(?:gain|directivity)\(total\)"))               # FEKO, which writes it in dB
_LINEAR = (re.compile(r"(?:mag\()?(?:reali[sz]ed)?(?:gain|dir)total\)?(?:\[.*\])?"),     # HFSS: GainTotal []
           re.compile(r"abs\((?:(?:reali[sz]ed)?(?:gain|dir|directivity)|grlz)\.?\)\[\]"))        # CST: Abs(Gain)[      ]
_CELL = re.compile(r'"[^"]*"|[^\s"(\[]+(?:\s*\([^)]*\))?(?:\s*\[[^\]]*\])?')           # of a head without commas


class Column(NamedTuple):
    """One that counts."""

    index: int
    name: str          # as the file has it
    unit: str = "deg"  # of an angle: "deg" or "rad"; of a gain: "db" or "linear"

    def read(self, texts: list[str]) -> float:
        """In degrees, or in dB."""
        try:
            value = float(texts[self.index])
        except ValueError:
            raise ValueError(f"{self.name} must be a number, got '{texts[self.index].strip()}'") from None
        if self.unit == "linear" and value >= 0.0:
            value = 10.0 * math.log10(value) if value > 0.0 else -math.inf
        elif self.unit == "linear":
            raise ValueError(f"{self.name} must be at least 0, got {value:g}")
        if not (math.isfinite(value) or (self.unit in ("db", "linear") and value == -math.inf)):
            raise ValueError(f"{self.name} must be finite, got '{texts[self.index].strip()}'")
        return math.degrees(value) if self.unit == "rad" else value


class Head(NamedTuple):
    """What the columns of a table are."""

    angles: tuple[Column, Column]  # azimuth and elevation, or phi and theta
    gain: Column
    phase: Column | None
    num_columns: int
    separator: str | None          # None: blanks

    @property
    def is_spherical(self) -> bool:
        """Whether the angles are phi and theta."""
        return "phi" in self.angles[0].name.lower()

    @property
    def is_directivity(self) -> bool:
        return "dir" in self.gain.name.lower()

    def texts(self, line: str) -> list[str]:
        """The values of a line."""
        found = line.split() if self.separator is None else next(csv.reader([line], delimiter=self.separator))
        if len(found) != self.num_columns:
            raise ValueError(f"must have {self.num_columns} values, has {len(found)}")
        return found


def is_head(line: str) -> bool:
    """Whether a line, a comment or not, names both angles of a table."""
    kinds = {kind for kind, _ in map(_kind, _cells(line.lstrip("#/ \t"))[1])}
    return any(set(pair) <= kinds for pair in PAIRS)


def head_of(line: str) -> Head:
    """Of a line of column names. Raises ValueError naming the column that is missing, unknown or there twice."""
    separator, names = _cells(line.lstrip("#/ \t"))
    columns: dict[str, Column] = {}
    for index, name in enumerate(names):
        kind, unit = _kind(name)
        if kind in columns:
            again = "stands twice" if name == columns[kind].name else f"is a second one beside '{columns[kind].name}'"
            raise ValueError(f"column '{name}' {again}")
        if kind:
            columns[kind] = Column(index, name, unit)
        elif re.fullmatch(r"\w*", name):  # what solvers write beside the gain has units or arguments
            raise ValueError(f"column '{name}' is none of {', '.join(OWN)}")
    second, first = PAIRS[1] if "theta" in columns or "phi" in columns else PAIRS[0][::-1]
    for kind, name in ((first, f"{first}_deg"), (second, f"{second}_deg"), ("gain", "gain_db")):
        if kind not in columns:
            raise ValueError(f"column '{name}' is missing")
    return Head((columns[first], columns[second]), columns["gain"], columns.get("phase"), len(names), separator)


def _cells(line: str) -> tuple[str | None, list[str]]:
    """The separator of a line of column names, None: blanks, and its cells."""
    separator = next((mark for mark in ",;\t" if mark in line), None)
    if separator is None:
        return None, [cell.strip('"').strip() for cell in _CELL.findall(line)]
    return separator, [cell.strip() for cell in next(csv.reader([line], delimiter=separator, skipinitialspace=True))]


def _kind(name: str) -> tuple[str, str]:
    """What a column is, "": nothing that counts, and its unit."""
    cell = re.sub(r"\s", "", name.lower())
    cell = cell[:cell.find("]") + 1] or cell  # HFSS adds the variation: dB(GainTotal) [] - Freq='77GHz'
    if angle := _ANGLE.fullmatch(cell):
        return angle[1], angle[2] or "deg"
    if _PHASE.fullmatch(cell):
        return "phase", "deg"
    for unit, patterns in (("db", _DECIBELS), ("linear", _LINEAR)):
        if any(pattern.fullmatch(cell) for pattern in patterns):
            return "gain", unit
    return "", ""
