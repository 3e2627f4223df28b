"""Positions over time in XML: floating car data of SUMO, and tracks of GPS receivers (GPX)."""
from __future__ import annotations

import gzip
import math
import re
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from xml.parsers import expat

from .. import _core
from .samples import MAX_BYTES, MOST_SAMPLES, Samples, instant, number, refuse

MAX_DEPTH = 64          # of nested elements
PACKED = ".gz"          # suffix behind that of the file, as SUMO writes large ones
_GEO_OPTION = re.compile(r'fcd-output\.geo\s+value="(true|1|yes|on|x|t)"', re.IGNORECASE)  # in SUMO's comment on its options
_IN_DEGREES = "places are in degrees (--fcd-output.geo), must be in m: write them without that option"
LEAST_WAY, SMALLEST_SHARE = 10.0, 0.01  # m by speed, from which on places that go less than that share of it are no metres


def read_fcd(path: Path, length_of: Callable[[str], float]) -> dict[str, Samples]:
    """{name: Samples} of a file of SUMO's --fcd-output; length_of: m, of a vehicle of a type. Raises FileError.

    x and y are the middle of the front bumper, the angle is in degrees from north (+y) clockwise. Persons are where they are.
    Persons are left out while they ride in a vehicle; one who gets off is another from there on, "name_2".
    Longitudes and latitudes are refused: by the options that the file names, or where all go much less far than their speeds say.
    """
    tracks: dict[str, Samples] = {}
    ways, on_foot = _Ways(), _OnFoot()
    state = {"time": math.nan, "root": "", "count": 0}

    def begin(tag: str, attributes: Mapping[str, str], line: int) -> None:
        if not state["root"]:
            state["root"] = tag
            if tag != "fcd-export":
                refuse(path, line, f"must begin with <fcd-export>, got <{tag[:60]}>")
        if tag == "timestep":
            state["time"] = number(path, line, "time", _attribute(path, line, tag, attributes, "time"), 1e9)
        elif tag in ("vehicle", "person"):
            state["count"] += 1
            if state["count"] > MOST_SAMPLES or math.isnan(state["time"]):
                refuse(path, line, f"<{tag}>: must stand in a <timestep>, at most {MOST_SAMPLES} in all")
            name = _attribute(path, line, tag, attributes, "id")
            if tag == "person":
                name = on_foot.name_of(name, rides=bool(attributes.get("vehicle")))
            if name:
                _add_vehicle(path, line, tag, {**attributes, "id": name}, state["time"], tracks, length_of)
                ways.add({**attributes, "id": name}, state["time"])

    def comment(words: str, line: int) -> None:
        if _GEO_OPTION.search(words):
            refuse(path, line, _IN_DEGREES)

    _parse(path, begin, comment=comment)
    if ways.are_in_degrees:
        raise _core.FileError(f"{path}: {_IN_DEGREES} (they go {ways.by_place:.3g}, by their speeds {ways.by_speed:.3g} m)")
    return tracks


class _OnFoot:
    """Tells the ways of persons on foot apart, between which they ride in vehicles: their rows then name the vehicle."""

    def __init__(self):
        self._riding: set[str] = set()
        self._ways: dict[str, int] = {}

    def name_of(self, name: str, rides: bool) -> str:
        """The name of the way that a row of a person belongs to, "" where the person rides."""
        if rides:
            self._riding.add(name)
            return ""
        if name in self._riding or name not in self._ways:
            self._riding.discard(name)
            self._ways[name] = self._ways.get(name, 0) + 1
        return f"{name}_{self._ways[name]}" if self._ways[name] > 1 else name


class _Ways:
    """How far all vehicles and persons of a file go, by their places and by their speeds."""

    def __init__(self):
        self.by_place, self.by_speed, self._may_be_degrees = 0.0, 0.0, True
        self._last: dict[str, tuple[float, float, float]] = {}

    def add(self, attributes: Mapping[str, str], time: float) -> None:
        """Takes a row that was read without an error; one without a usable speed says nothing."""
        x, y, name = float(attributes["x"]), float(attributes["y"]), attributes["id"]
        self._may_be_degrees &= abs(x) <= 180.0 and abs(y) <= 90.0
        before, self._last[name] = self._last.get(name), (time, x, y)
        try:
            speed = abs(float(attributes.get("speed", "nan")))
        except ValueError:
            return
        if before is not None and math.isfinite(speed):
            self.by_place += math.hypot(x - before[1], y - before[2])
            self.by_speed += speed * abs(time - before[0])

    @property
    def are_in_degrees(self) -> bool:
        """Whether the places can be no metres: a degree is 111 km."""
        return self._may_be_degrees and self.by_speed >= LEAST_WAY and self.by_place < SMALLEST_SHARE * self.by_speed


def _attribute(path: Path, line: int, tag: str, attributes: Mapping[str, str], name: str) -> str:
    if name not in attributes:
        refuse(path, line, f"<{tag}>: {name} is missing")
    return attributes[name]


def _add_vehicle(path, line, tag, attributes, time, tracks, length_of) -> None:
    """Adds the middle of a vehicle, or a person."""
    def of(name: str, most: float) -> float:
        return number(path, line, name, _attribute(path, line, tag, attributes, name), most)

    x, y, yaw = of("x", 1e7), of("y", 1e7), math.radians(90.0 - of("angle", 1e6))
    z = of("z", 1e7) if "z" in attributes else 0.0
    kind = attributes.get("type", "") or ("pedestrian" if tag == "person" else "")
    back = 0.5 * length_of(kind) if tag == "vehicle" else 0.0
    samples = tracks.setdefault(_attribute(path, line, tag, attributes, "id"), Samples(kind, tag == "person"))
    samples.lines.append(line)
    samples.times.append(time)
    samples.places.append((x - back * math.cos(yaw), y - back * math.sin(yaw), z))
    samples.yaws.append(yaw)


def read_gpx(path: Path) -> dict[str, Samples]:
    """{name: Samples} of the tracks of a GPX file, whose places are latitudes, longitudes and heights. Raises FileError."""
    reader = _Gpx(path)
    _parse(path, reader.begin, reader.end, reader.text)
    return reader.tracks


class _Gpx:
    """Gathers the track points of a GPX file."""

    def __init__(self, path: Path):
        self.tracks: dict[str, Samples] = {}
        self._path, self._texts, self._name, self._count = path, {}, path.stem, 0
        self._point: tuple[int, float, float] | None = None
        self._inside: list[str] = []

    def begin(self, tag: str, attributes: Mapping[str, str], line: int) -> None:
        self._inside.append(tag)
        if tag == "trk":
            self._count += 1
            self._name = self._path.stem if self._count == 1 else f"{self._path.stem}_{self._count}"
        if tag == "trkpt":
            latitude, longitude = (number(self._path, line, name, _attribute(self._path, line, tag, attributes, name), most)
                                   for name, most in (("lat", 90.0), ("lon", 360.0)))
            self._point, self._texts = (line, latitude, longitude), {}

    def text(self, words: str) -> None:
        if self._inside:
            self._texts[self._inside[-1]] = self._texts.get(self._inside[-1], "")[:1000] + words[:1000]

    def end(self, tag: str, line: int) -> None:
        self._inside.pop()
        if tag == "name" and self._inside[-1:] == ["trk"] and self._texts.get("name", "").strip():
            self._name = self._texts["name"].strip()
        if tag == "trkpt" and self._point is not None:
            begin, latitude, longitude = self._point
            if "time" not in self._texts:
                refuse(self._path, begin, "<trkpt>: time is missing")
            samples = self.tracks.setdefault(self._name, Samples())
            samples.lines.append(begin)
            samples.times.append(instant(self._path, begin, "time", self._texts["time"]))
            height = number(self._path, begin, "ele", self._texts["ele"], 1e5) if "ele" in self._texts else 0.0
            samples.places.append((latitude, longitude, height))


class _Bounded:
    """A file for a parser, no longer than MAX_BYTES once it is unpacked. Raises FileError."""

    def __init__(self, path: Path, file):
        self._path, self._file, self._read = path, file, 0

    def read(self, size: int) -> bytes:
        content = self._file.read(size)
        self._read += len(content)
        if self._read > MAX_BYTES:
            raise _core.FileError(f"{self._path}: is larger than {MAX_BYTES} bytes")
        return content



def _parse(path: Path, begin, end=None, text=None, comment=None) -> None:
    """Calls begin(tag, attributes, line), end(tag, line), text(words) and comment(words, line) for the content of an XML file
    without entities."""
    parser = expat.ParserCreate()
    depth = [0]

    def on_begin(tag, attributes):
        depth[0] += 1
        if depth[0] > MAX_DEPTH:
            refuse(path, parser.CurrentLineNumber, f"more than {MAX_DEPTH} elements within each other")
        begin(tag, attributes, parser.CurrentLineNumber)

    def on_end(tag):
        depth[0] -= 1
        if end:
            end(tag, parser.CurrentLineNumber)

    def refuse_types(*_):
        refuse(path, parser.CurrentLineNumber, "a document type, which may expand without end, is refused")

    parser.StartElementHandler, parser.EndElementHandler = on_begin, on_end
    parser.StartDoctypeDeclHandler = refuse_types
    if comment:
        parser.CommentHandler = lambda words: comment(words, parser.CurrentLineNumber)
    if text:
        parser.CharacterDataHandler = text
    try:
        if path.stat().st_size > MAX_BYTES:
            raise _core.FileError(f"{path}: is larger than {MAX_BYTES} bytes")
        with gzip.open(path) if path.suffix.lower() == PACKED else open(path, "rb") as file:
            parser.ParseFile(_Bounded(path, file))
    except expat.ExpatError as error:
        reason = expat.errors.messages[error.code] if error.code in expat.errors.messages else str(error)
        raise _core.FileError(f"{path}, line {error.lineno}: is no XML ({reason})") from None
    except (OSError, EOFError, zlib.error) as error:
        if isinstance(error, _core.FileError):
            raise
        raise _core.FileError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    except (LookupError, ValueError) as error:  # an encoding that is not known
        raise _core.FileError(f"{path}: is no XML ({error})") from None
