"""Files of trajectories: who is when on the way, and the trajectories of those who are asked for."""
from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ... import _core
from ...arguments.checks import Rule, anything, array, checked, file as file_rule, is_writable, one_of, real, refused, vector
from ...base.process.callers import warn_user
from ...base.storage.lines import refuse
from ...base.storage.pointers import pointers_are_told
from ...base.text.counts import counted
from ..arguments import FARTHEST, GOES_ON, NEAREST, Outside
from ..kinds import of_kind, usual_kind, warn_of_unused_kinds
from ..trajectory import Trajectory
from .doubts import doubt_of_turns, doubts_of
from .geodesy import east_north_up
from .rows import Rows, read_rows
from .samples import Samples
from .smoothing import smoothed


def _origin_rule(argument: str, value):
    if value is None:
        return None
    origin = np.asarray(array("[2]", "[3]", finite=True)(argument, value), float)
    if abs(origin[0]) > 90.0 or abs(origin[1]) > 360.0:
        raise refused(ValueError, argument, "latitude and longitude in degrees, and a height in m", value)
    return np.append(origin, np.zeros(3 - len(origin)))


def length_rule(argument: str, value):
    rule = real(0.0, 100.0, "m")
    if isinstance(value, Mapping):
        if not all(isinstance(kind, str) and is_writable(kind) for kind in value):
            raise refused(TypeError, argument, "a number in m, or a dict of them by types of vehicles", value)
        return {kind: rule(f"{argument}['{kind}']", one) for kind, one in value.items()}
    return None if value is None else rule(argument, value)


RULES: dict[str, Rule] = {
    "path": file_rule, "origin": _origin_rule, "smoothing": real(0.0, unit="m"), "vehicle_length": length_rule,
    "goes_on": GOES_ON, "outside": one_of(Outside), "position": vector, "yaw": real(unit="rad")}


SCATTER, LEAST_SCATTER = 3.0, 0.05  # of the smoothing and m at least, within which smoothed places are those of what stands


class Way(NamedTuple):
    """What a file tells of somebody before the Trajectory is made. begin, end: s; kind, is_person: as of Trajectory"""

    begin: float
    end: float
    kind: str
    is_person: bool


W = TypeVar("W", Way, Trajectory)


def on_the_way(ways: Mapping[str, W], during: tuple[float, float] | None) -> dict[str, W]:
    """Those who are on their way at some time of a span in s, None: all."""
    begin, end = during or (-math.inf, math.inf)
    return {name: one for name, one in ways.items() if one.begin <= end and begin <= one.end}


def warn_of_nobody(ways: Mapping[str, W], during: tuple[float, float] | None) -> None:
    """Warns (RuntimeWarning) where nobody is on the way in a span in s."""
    if during is not None and ways and not on_the_way(ways, during):
        warn_user(f"during: nobody is on the way from {during[0]:g} to {during[1]:g} s; trajectories are from "
                  f"{min(one.begin for one in ways.values()):g} to {max(one.end for one in ways.values()):g} s")


class TrackFile:
    """A file of trajectories, with the arguments of read_trajectories; rows: of the file, None: it is read.

    ways: {name: Way}, in the order of the file. Warns (RuntimeWarning) of those with a single position, which are left out.
    """

    @checked(self=anything, rows=anything, **RULES)
    def __init__(self, path: str | os.PathLike[str], *, origin: ArrayLike | None = None, smoothing: float = 0.0,
                 vehicle_length: float | Mapping[str, float] | None = None, goes_on: float = 0.0,
                 outside: Outside = "absent", position: ArrayLike = (0.0, 0.0, 0.0), yaw: float = 0.0,
                 rows: Rows | None = None):
        _core.warn_of_turns(yaw)
        self._path = Path(path)
        with pointers_are_told(path):
            rows = read_rows(self._path) if rows is None else rows
        self._origin = None
        if rows.is_geographic:
            self._origin = next(iter(rows.tracks.values())).places[0] if origin is None else np.asarray(origin, float)
        self._smoothing, self._vehicle_length = smoothing, vehicle_length
        self._placement = _Placement(np.asarray(position, float), yaw)
        self._ends = {"goes_on": goes_on, "outside": outside}
        self._tracks = {name: samples for name, samples in rows.tracks.items() if len(samples.times) > 1}
        self._warn_of_single([name for name in rows.tracks if name not in self._tracks])
        self.ways = {name: Way(samples.times[0] - goes_on, samples.times[-1] + goes_on, samples.kind, samples.is_person)
                     for name, samples in self._tracks.items()}

    def warn_of_unused(self, argument: str, globs: Iterable[str]) -> None:
        """Warns (RuntimeWarning) of globs of types that take none of the file."""
        warn_of_unused_kinds(argument, globs, (way.kind for way in self.ways.values()))

    def trajectories(self, names: Iterable[str]) -> dict[str, Trajectory]:
        """{name: Trajectory} of some of `ways`. Raises FileError; warns (RuntimeWarning) of speeds and yaws that the positions
        contradict."""
        found, doubts = {}, []
        for name in names:
            found[name], words = self._made(name, self._tracks[name])
            doubts += words
        if doubts:
            warn_user(f"{self._path}: {doubts[0]}" + (f" ({len(doubts) - 1} more alike)" if len(doubts) > 1 else ""))
        return found

    def _made(self, name: str, samples: Samples) -> tuple[Trajectory, list[str]]:
        """The Trajectory of somebody, and what is doubtful about the rows."""
        places, times, yaws, speeds = samples.places, *map(np.array, (samples.times, samples.yaws, samples.speeds))
        if self._origin is not None:
            places = east_north_up(places[:, 0], places[:, 1], places[:, 2], self._origin)
        if samples.has_fronts:
            back = 0.5 * self._length_of(samples.kind)
            places[:, :2] -= back * np.stack([np.cos(yaws), np.sin(yaws)], axis=-1)
        doubts = [f"'{name[:60]}' {words}" for words in doubts_of(times, places, yaws, speeds, samples.told_in_degrees)]
        places = self._placement.places(smoothed(times, places, self._smoothing))
        try:
            made = Trajectory(points=places, times=times, yaw=yaws + self._placement.yaw if len(yaws) else None,
                              spacing=_spacing_of(self._smoothing), speed=speeds if len(speeds) else None,
                              kind=samples.kind, is_person=samples.is_person, **self._ends)
        except ValueError as error:
            refuse(self._path, samples.lines[0], f"'{name[:60]}': {error}")
        words = doubt_of_turns(made.rotation.times, made.yaw(made.rotation.times), has_yaws=len(yaws) > 0)
        return made, doubts + ([f"'{name[:60]}' {words}"] if words else [])

    def _length_of(self, kind: str) -> float:
        """m, of vehicles of a kind."""
        given, usual = self._vehicle_length, usual_kind(kind).length
        if isinstance(given, Mapping):
            return of_kind(given.items(), kind, usual)
        return usual if given is None else given

    def _warn_of_single(self, names: list[str]) -> None:
        if names:
            are = "are" if len(names) > 1 else "is"
            warn_user(f"{self._path}: {counted(len(names), 'object')} with a single position {are} left out, such as "
                      f"'{names[0][:60]}'")


def _spacing_of(smoothing: float) -> float:
    """The spacing in m of a Trajectory through places that are smoothed by so many m."""
    return min(max(LEAST_SCATTER, SCATTER * smoothing), FARTHEST) if smoothing > 0.0 else NEAREST


class _Placement(NamedTuple):
    """Where the origin and the +x of a file are in the world: position [3] in m, yaw in rad."""

    position: np.ndarray
    yaw: float

    def places(self, places: np.ndarray) -> np.ndarray:
        """Places [P, 3] of the file in the world, m."""
        if self.yaw == 0.0:
            return places + self.position
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return places @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + self.position
