"""Tracks of GPS receivers (GPX)."""
from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from .markup import attribute, parse
from .samples import Samples, instant, number, refuse


def read_gpx(path: Path) -> dict[str, Samples]:
    """{name: Samples} of the tracks of a GPX file, whose places are latitudes, longitudes and heights. Raises FileError."""
    reader = _Gpx(path)
    parse(path, reader.begin, reader.end, reader.text)
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
            latitude, longitude = (number(self._path, line, name, attribute(self._path, line, tag, attributes, name), most)
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
            samples.coordinates.extend((latitude, longitude, height))
