"""Tracks of GPS receivers (GPX)."""
from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from ...base.storage.lines import refuse
from ...base.storage.markup import attribute, parse
from ...base.text.node_names import unique
from .samples import Samples, instant, number


def read_gpx(path: Path) -> dict[str, Samples]:
    """{name: Samples} of the tracks of a GPX file, whose places are latitudes, longitudes and heights. Raises FileError."""
    reader = _Gpx(path)
    parse(path, reader.begin, reader.end, reader.text)
    return reader.tracks


class _Gpx:
    """Gathers the track points of a GPX file."""

    def __init__(self, path: Path):
        self.tracks: dict[str, Samples] = {}
        self._path, self._name, self._count = path, "", 0
        self._taken: dict[str, int] = {}        # names of the tracks
        self._samples: Samples | None = None    # of the track, from its first point on
        self._point: tuple[int, float, float] | None = None
        self._texts: dict[str, str] = {}        # of the elements right in the point
        self._inside: list[str] = []
        self._words = ""                        # of the element that began last

    def begin(self, tag: str, attributes: Mapping[str, str], line: int) -> None:
        self._inside.append(tag)
        self._words = ""
        if tag == "trk":
            self._count += 1
            self._name, self._samples = self._path.stem if self._count == 1 else f"{self._path.stem}_{self._count}", None
        if tag == "trkpt":
            latitude, longitude = (number(self._path, line, name, attribute(self._path, line, tag, attributes, name), most)
                                   for name, most in (("lat", 90.0), ("lon", 360.0)))
            self._point, self._texts = (line, latitude, longitude), {}

    def text(self, words: str) -> None:
        self._words = (self._words + words)[:1000]

    def end(self, tag: str, line: int) -> None:
        self._inside.pop()
        within = self._inside[-1] if self._inside else ""
        if tag == "name" and within == "trk" and self._words.strip():
            self._name = self._words.strip()
        if within == "trkpt":
            self._texts[tag] = self._words
        if tag == "trkpt" and self._point is not None:
            self._add(*self._point)

    def _add(self, line: int, latitude: float, longitude: float) -> None:
        """Adds a point to the track that it belongs to."""
        if "time" not in self._texts:
            refuse(self._path, line, "<trkpt>: time is missing")
        if self._samples is None:
            self._samples = self.tracks[unique(self._name, self._taken)] = Samples()
        self._samples.lines.append(line)
        self._samples.times.append(instant(self._path, line, "time", self._texts["time"]))
        height = number(self._path, line, "ele", self._texts["ele"], 1e5) if "ele" in self._texts else math.nan
        self._samples.coordinates.extend((latitude, longitude, height))
