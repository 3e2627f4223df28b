"""Tables of positions over time: CSV with a line of names, in metres or as latitude and longitude."""
from __future__ import annotations

import csv
import math
import re
from pathlib import Path

from .. import _core
from .samples import MAX_BYTES, MOST_SAMPLES, Samples, instant, number, refuse

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
UNCLEAR = ("heading", "headingdeg", "headingrad", "angle", "course", "orientation", "bearing")


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
    is_geographic = "x" not in columns
    tracks: dict[str, Samples] = {}
    for count, (line, text) in enumerate(lines):
        if count >= MOST_SAMPLES:
            refuse(path, line, f"more than {MOST_SAMPLES} rows")
        values = next(csv.reader([text], delimiter=delimiter))
        if len(values) <= max(columns.values()):
            refuse(path, line, f"must have at least {max(columns.values()) + 1} values, has {len(values)}")
        _add(path, line, {name: values[index] for name, index in columns.items()}, tracks, is_geographic)
    return tracks, is_geographic


def _columns(path: Path, line: int, header: list[str]) -> dict[str, int]:
    """{name: index} of the columns that are known."""
    found: dict[str, int] = {}
    for index, text in enumerate(header):
        word = re.sub(r"[^a-z]", "", re.sub(r"[\[(].*?[\])]", "", text.lower()))
        unit = re.search(r"[\[(](.*?)[\])]", text.lower())
        if word in ("yaw", "psi") and unit and "deg" in unit[1]:
            word += "deg"
        if word in UNCLEAR:
            refuse(path, line, f"column '{text.strip()[:60]}': may be counted in several ways; call it yaw (rad, from x to y) or "
                   "yaw_deg")
        name = COLUMN_OF.get(word)
        if name in found:
            refuse(path, line, f"column '{text.strip()[:60]}': there is another {name}")
        if name:
            found[name] = index
    groups = ("x", "y"), ("latitude", "longitude")
    if "time" not in found or not any(all(name in found for name in group) for group in groups):
        refuse(path, line, "must name columns: time, and x and y, or latitude and longitude; got "
               + (", ".join(text.strip()[:30] for text in header)[:120] or "none"))
    return found


def _add(path: Path, line: int, row: dict[str, str], tracks: dict[str, Samples], is_geographic: bool) -> None:
    """Adds a row to the track that it belongs to."""
    name = row.get("id", "").strip() or path.stem
    samples = tracks.setdefault(name, Samples(kind=row.get("kind", "").strip()))
    samples.lines.append(line)
    samples.times.append(instant(path, line, "time", row["time"]))
    most = {"latitude": 90.0, "longitude": 360.0, "height": 1e5}
    names = ("latitude", "longitude", "height") if is_geographic else ("x", "y", "z")
    place = [number(path, line, key, row[key], most.get(key, 1e7)) if row.get(key, "").strip() or key in names[:2] else 0.0
             for key in names]
    samples.places.append((place[0], place[1], place[2]))
    if "yaw" in row or "yaw_deg" in row:
        key = "yaw" if "yaw" in row else "yaw_deg"
        value = number(path, line, key, row[key])
        samples.yaws.append(value if key == "yaw" else math.radians(value))
    if "speed" in row:
        speed = number(path, line, "speed", row["speed"], 1e4)
        if speed < 0.0:
            refuse(path, line, f"speed: must be at least 0 m/s, got '{row['speed'].strip()[:60]}'")
        samples.speeds.append(speed)
