"""Tables of positions over time: CSV with a line of names, in metres or as latitude and longitude."""
from __future__ import annotations

import csv
import math
import re
from pathlib import Path
from typing import NamedTuple

from ... import _core
from ...base.storage.lines import MAX_BYTES, refuse
from .samples import MOST_SAMPLES, Samples, instant, number

# What a column may be called, without case, blanks, marks and a unit in brackets.
NAMES = {
    "time": ("time", "t", "timestamp", "times", "seconds", "sec"),
    "id": ("id", "name", "object", "objectid", "track", "trackid", "vehicle", "vehicleid", "agent", "agentid"),
    "kind": ("type", "kind", "class", "objecttype", "vehicletype", "agenttype"),
    "x": ("x", "east", "easting", "posx", "positionx", "xcenter", "xm"),
    "y": ("y", "north", "northing", "posy", "positiony", "ycenter", "ym"),
    "z": ("z", "up", "posz", "positionz", "zcenter", "zm"),
    "latitude": ("lat", "latitude", "latdeg"),
    "longitude": ("lon", "lng", "long", "longitude", "londeg"),
    "height": ("ele", "elevation", "alt", "altitude", "height"),
    "yaw": ("yaw", "yawrad", "psi", "psirad"),
    "yaw_deg": ("yawdeg", "psideg"),
    "speed": ("speed", "v", "speedms", "velocity"),
}
COLUMN_OF = {word: name for name, words in NAMES.items() for word in words}
_LENGTHS = {"m": 1.0, "metre": 1.0, "metres": 1.0, "meter": 1.0, "meters": 1.0, "cm": 1e-2, "mm": 1e-3, "km": 1e3, "ft": 0.3048,
            "feet": 0.3048}
_DEGREES = {"deg": 1.0, "degree": 1.0, "degrees": 1.0, "\u00b0": 1.0}
_EARTH = _DEGREES | {"wgs84": 1.0, "wgs 84": 1.0}
# {column: {unit that may stand in brackets behind its name: what it is in s, m, m/s, rad or degrees}}, in small letters;
# \u00b0 are degrees, \u00b5 and \u03bc micro.
UNITS = {
    "time": {"s": 1.0, "sec": 1.0, "second": 1.0, "seconds": 1.0, "utc": 1.0, "iso 8601": 1.0,
             "iso8601": 1.0, "ms": 1e-3, "milliseconds": 1e-3, "us": 1e-6, "\u00b5s": 1e-6, "\u03bcs": 1e-6, "microseconds": 1e-6,
             "ns": 1e-9, "nanoseconds": 1e-9},
    "x": _LENGTHS, "y": _LENGTHS, "z": _LENGTHS, "height": _LENGTHS,
    "latitude": _EARTH, "longitude": _EARTH, "yaw": {"rad": 1.0, "radians": 1.0}, "yaw_deg": _DEGREES,
    "speed": {"m/s": 1.0, "mps": 1.0, "km/h": 1.0 / 3.6, "kmh": 1.0 / 3.6, "kph": 1.0 / 3.6, "mph": 0.44704,
              "knots": 1852.0 / 3600.0},
}
OF_SUMO = "timesteptime"     # the time of its tables, whose places are those of fronts and angles those of a compass
_OF_TEXT = ("id", "kind")
UNCLEAR = ("heading", "headingdeg", "headingrad", "angle", "course", "orientation", "bearing")


class Column(NamedTuple):
    """Which one of a row it is, and what its unit is in s, m, m/s, rad or degrees."""

    index: int
    unit: float


def read_table(path: Path) -> tuple[dict[str, Samples], bool]:
    """({name: Samples}, whether places are latitudes, longitudes and heights) of a table. Raises FileError."""
    try:
        if path.stat().st_size > MAX_BYTES:
            raise _core.FileError(f"{path}: is larger than {MAX_BYTES} bytes")
        with open(path, encoding="utf-8-sig", newline="") as file:
            return _read(path, file)
    except OSError as error:
        if isinstance(error, _core.FileError):
            raise
        raise _core.FileError(f"{path}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError as error:
        raise _core.FileError(f"{path}: is not UTF-8 text (byte {error.start})") from None
    except csv.Error as error:
        raise _core.FileError(f"{path}: is no table ({error})") from None


def _read(path: Path, file) -> tuple[dict[str, Samples], bool]:
    lines = ((count, line) for count, line in enumerate(file, 1) if line.strip() and not line.startswith("#"))
    first, header = next(lines, (1, ""))
    delimiter = max(",;\t", key=header.count)
    columns = _columns(path, first, next(csv.reader([header], delimiter=delimiter), []))
    units, least = {name: column.unit for name, column in columns.items()}, 1 + max(column.index for column in columns.values())
    is_geographic = "x" not in columns
    tracks: dict[str, Samples] = {}
    marks: set[str] = set()  # of decimals that the rows have had
    for count, (line, text) in enumerate(lines):
        if count >= MOST_SAMPLES:
            refuse(path, line, f"more than {MOST_SAMPLES} rows")
        values = next(csv.reader([text], delimiter=delimiter))
        if len(values) < least:
            refuse(path, line, f"must have at least {least} values, has {len(values)}")
        row = {name: values[column.index] for name, column in columns.items()}
        if delimiter != ",":
            numbers = {name: text for name, text in row.items() if name not in _OF_TEXT}
            marks |= {mark for mark in ",." if any(mark in text for text in numbers.values())}
            if len(marks) > 1:
                refuse(path, line, "numbers must have decimal points or decimal commas, the file has both")
            row |= {name: _with_point(text) for name, text in numbers.items()}
        _add(path, line, row, units, tracks, is_geographic)
    return tracks, is_geographic


def _with_point(text: str) -> str:
    """A number with a decimal comma, as tables between semicolons have it in half of Europe, with a point."""
    return re.sub(r"^(\s*[+-]?\d*),(?=\d)", r"\1.", text)


def _columns(path: Path, line: int, header: list[str]) -> dict[str, Column]:
    """{name: Column} of the columns that are known."""
    found: dict[str, Column] = {}
    for index, text in enumerate(header):
        word = re.sub(r"[^a-z]", "", re.sub(r"[\[(].*?[\])]", "", text.lower()))
        marks = [mark.strip() for mark in re.findall(r"[\[(](.*?)[\])]", text.lower())]
        if word in ("yaw", "psi") and any(mark in _DEGREES for mark in marks):
            word += "deg"
        if word == OF_SUMO:
            refuse(path, line, f"column '{text.strip()[:60]}': is a table of SUMO, whose floating car data are read as .xml only")
        if word in UNCLEAR:
            refuse(path, line, f"column '{text.strip()[:60]}': may be counted in several ways; call it yaw (rad, from x to y) or "
                   "yaw_deg")
        name = COLUMN_OF.get(word)
        if name in found:
            refuse(path, line, f"column '{text.strip()[:60]}': there is another {name}")
        if name:
            found[name] = Column(index, _unit(path, line, text, name, marks))
    groups = ("x", "y"), ("latitude", "longitude")
    if "time" not in found or not any(all(name in found for name in group) for group in groups):
        refuse(path, line, "must name columns: time, and x and y, or latitude and longitude; got "
               + (", ".join(text.strip()[:30] for text in header)[:120] or "none")
               + (", without commas, semicolons or tabs between them" if len(header) == 1 else ""))
    return found


def _unit(path: Path, line: int, text: str, name: str, marks: list[str]) -> float:
    """What the unit of a column is. text: its whole name; marks: what stands in brackets there. Raises FileError."""
    units = UNITS.get(name, {})
    known = [units[mark] for mark in marks if mark in units]
    if units and marks and not known:
        refuse(path, line, f"column '{text.strip()[:60]}': its unit must be one of {', '.join(units)}, got '{marks[-1][:30]}'")
    return known[0] if known else 1.0


def _add(path: Path, line: int, row: dict[str, str], units: dict[str, float], tracks: dict[str, Samples],
         is_geographic: bool) -> None:
    """Adds a row to the track that it belongs to."""
    def of(name: str, most: float) -> float:
        return units[name] * number(path, line, name, row[name], most / units[name])

    name = row.get("id", "").strip() or path.stem
    samples = tracks.setdefault(name, Samples(kind=row.get("kind", "").strip(), told_in_degrees="yaw" not in row))
    samples.lines.append(line)
    samples.times.append(instant(path, line, "time", row["time"], units["time"]))
    most = {"latitude": 90.0, "longitude": 360.0, "height": 1e5}
    names = ("latitude", "longitude", "height") if is_geographic else ("x", "y", "z")
    place = [of(key, most.get(key, 1e7)) if row.get(key, "").strip() or key in names[:2] else math.nan for key in names]
    samples.coordinates.extend(place)
    if "yaw" in row or "yaw_deg" in row:
        key = "yaw" if "yaw" in row else "yaw_deg"
        value = of(key, 1e9)
        samples.yaws.append(value if key == "yaw" else math.radians(value))
    if "speed" in row:
        speed = of("speed", 1e4)
        if speed < 0.0:
            refuse(path, line, f"speed: must be at least 0 m/s, got '{row['speed'].strip()[:60]}'")
        samples.speeds.append(speed)
