"""Floating car data of SUMO: where its vehicles and persons are, step by step."""
from __future__ import annotations

import math
import re
from array import array
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np

from ... import _core
from ...base.storage.lines import refuse
from ...base.storage.markup import attribute, parse
from ...base.text.node_names import unique
from .absences import parted
from .samples import MOST_SAMPLES, Samples, number

_GEO_OPTION = re.compile(r'fcd-output\.geo\s+value="(true|1|yes|on|x|t)"', re.IGNORECASE)  # in SUMO's comment on its options
_CLOCK = re.compile(r"(?:(\d{1,5}):)?(\d\d?):(\d\d):(\d\d(?:\.\d+)?)")
_IN_DEGREES = "places are in degrees (--fcd-output.geo), must be in m: write them without that option"
LEAST_WAY, SMALLEST_SHARE = 10.0, 0.01  # m by speed, from which on places that go less than that share of it are no metres
MOST_METRES, MOST_DEGREES = 1e7, 1e6    # of places and angles


def read_fcd(path: Path) -> dict[str, Samples]:
    """{name: Samples} of a file of SUMO's --fcd-output. Raises FileError.

    x and y are the middle of the front bumper, the angle is in degrees from north (+y) clockwise. Persons are where they are.
    Persons are left out while they ride in a vehicle; one who gets off is another from there on, "name_2", and so is who is
    missing in some steps and comes back where the speeds before and behind do not lead, and a person who jumps. A person with
    the id of a vehicle is "id_person".
    Longitudes and latitudes are refused: by the options that the file names, or where all go much less far than their speeds say.
    """
    reader = _Fcd(path)
    parse(path, reader.begin, comment=reader.comment)
    reader.refuse_degrees()
    return reader.ways()


class _Who(NamedTuple):
    """A vehicle or person of a file, by its own id; way: number of the way on foot of a person, from 1 on."""

    id: str
    is_person: bool = False
    way: int = 1


def _names_of(everybody: Collection[_Who]) -> dict[_Who, str]:
    """{who: name}, each of its own: vehicles and persons of a file are counted for themselves, mostly from 0 on."""
    vehicles = {who.id for who in everybody if not who.is_person}
    names: dict[_Who, str] = {who: who.id for who in everybody if not who.is_person}
    taken = dict.fromkeys(vehicles, 1)
    for who in everybody:
        if who.is_person:
            own = f"{who.id}_person" if who.id in vehicles else who.id
            names[who] = unique(own if who.way == 1 else f"{own}_{who.way}", taken)
    return names


class _Fcd:
    """Gathers the rows of a file."""

    def __init__(self, path: Path):
        self._tracks: dict[_Who, Samples] = {}
        self._path, self._root, self._time, self._count = path, "", math.nan, 0
        self._on_foot = _OnFoot()
        self._steps = array("d")  # s
        self._told_speeds: dict[_Who, array] = {}  # m/s, nan where a row has none: what follows a way is as fast as its places

    def begin(self, tag: str, attributes: Mapping[str, str], line: int) -> None:
        if not self._root:
            self._root = tag
            if tag != "fcd-export":
                refuse(self._path, line, f"must begin with <fcd-export>, got <{tag[:60]}>")
        if tag in ("vehicle", "person"):
            self._row(tag, attributes, line)
        elif tag == "timestep":
            self._time = _time(self._path, line, attribute(self._path, line, tag, attributes, "time"))
            self._steps.append(self._time)

    def ways(self) -> dict[str, Samples]:
        """{name: Samples}, of everybody from coming to leaving."""
        names = _names_of(self._tracks)
        return parted({names[who]: samples for who, samples in self._tracks.items()},
                      {names[who]: speeds for who, speeds in self._told_speeds.items()}, np.unique(self._steps))

    def comment(self, words: str, line: int) -> None:
        if _GEO_OPTION.search(words):
            refuse(self._path, line, _IN_DEGREES)

    def _row(self, tag: str, attributes: Mapping[str, str], line: int) -> None:
        self._count += 1
        if self._count > MOST_SAMPLES or self._time != self._time:  # no timestep yet
            refuse(self._path, line, f"<{tag}>: must stand in a <timestep>, at most {MOST_SAMPLES} in all")
        who = _Who(attribute(self._path, line, tag, attributes, "id"))
        if tag == "person":
            who = self._on_foot.way_of(who.id, rides=bool(attributes.get("vehicle")))
            if who is None:
                return
        x, y, z, angle = self._numbers(tag, attributes, line)
        samples = self._tracks.get(who)
        if samples is None:
            samples = self._begun(who, attributes)
        samples.lines.append(line)
        samples.times.append(self._time)
        samples.coordinates.extend((x, y, z))
        samples.yaws.append(math.radians(90.0 - angle))
        try:
            speed = float(attributes.get("speed", "nan"))
        except ValueError:
            speed = math.nan
        self._told_speeds[who].append(speed)

    def _begun(self, who: _Who, attributes: Mapping[str, str]) -> Samples:
        """The Samples of somebody who is new."""
        kind = attributes.get("type", "") or ("pedestrian" if who.is_person else "")
        self._told_speeds[who] = array("d")
        return self._tracks.setdefault(who, Samples(kind, who.is_person, has_fronts=not who.is_person, told_in_degrees=True))

    def _numbers(self, tag: str, attributes: Mapping[str, str], line: int) -> tuple[float, float, float, float]:
        """(x, y, z in m, angle in degrees) of a row."""
        try:
            x, y, angle = float(attributes["x"]), float(attributes["y"]), float(attributes["angle"])
            z = float(attributes.get("z", 0.0))
            if abs(x) <= MOST_METRES and abs(y) <= MOST_METRES and abs(z) <= MOST_METRES and abs(angle) <= MOST_DEGREES:
                return x, y, z, angle
        except (KeyError, ValueError):
            pass
        self._refuse_numbers(tag, attributes, line)

    def _refuse_numbers(self, tag: str, attributes: Mapping[str, str], line: int) -> NoReturn:
        """Raises FileError naming the first of the numbers of a row that is missing or wrong."""
        for name, most in (("x", MOST_METRES), ("y", MOST_METRES), ("angle", MOST_DEGREES), ("z", MOST_METRES)):
            if name != "z" or name in attributes:
                number(self._path, line, name, attribute(self._path, line, tag, attributes, name), most)
        raise AssertionError("a row without fault was refused")

    def refuse_degrees(self) -> None:
        """Raises FileError where the places can be no metres, by the speeds beside them: a degree is 111 km."""
        by_place = by_speed = 0.0
        for who, samples in self._tracks.items():
            places, speeds = samples.places[:, :2], np.abs(np.array(self._told_speeds[who]))[1:]
            if np.any(np.abs(places) > (180.0, 90.0)):
                return
            is_told = np.isfinite(speeds)
            by_place += float(np.sum(np.linalg.norm(np.diff(places, axis=0), axis=1)[is_told]))
            by_speed += float(np.sum((speeds * np.abs(np.diff(samples.times)))[is_told]))
        if by_speed >= LEAST_WAY and by_place < SMALLEST_SHARE * by_speed:
            raise _core.FileError(f"{self._path}: {_IN_DEGREES} (they go {by_place:.3g}, by their speeds {by_speed:.3g} m)")


def _time(path: Path, line: int, text: str) -> float:
    """A time in s, also as --human-readable-time has it, "12:00:00.00" with days before that from the second on."""
    clock = _CLOCK.fullmatch(text.strip())
    if clock is None:
        return number(path, line, "time", text, 1e9)
    days, hours, minutes, seconds = (float(part or 0.0) for part in clock.groups())
    return ((24.0 * days + hours) * 60.0 + minutes) * 60.0 + seconds


class _OnFoot:
    """Tells the ways of persons on foot apart, between which they ride in vehicles: their rows then name the vehicle."""

    def __init__(self):
        self._riding: set[str] = set()
        self._ways: dict[str, int] = {}

    def way_of(self, name: str, rides: bool) -> _Who | None:
        """The way that a row of a person belongs to, None where the person rides."""
        if rides:
            self._riding.add(name)
            return None
        if name in self._riding or name not in self._ways:
            self._riding.discard(name)
            self._ways[name] = self._ways.get(name, 0) + 1
        return _Who(name, True, self._ways[name])
