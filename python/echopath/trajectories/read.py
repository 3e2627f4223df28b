"""Trajectories of files."""
from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..arguments.checks import Rule, array, checked, is_writable, one_of, real, refused, vector
from ..arguments.checks import file as file_rule
from ..base.callers import warn_user
from ..base.counts import counted
from .arguments import GOES_ON, Outside
from .doubts import doubts_of
from .geodesy import east_north_up
from .kinds import of_kind, require_kinds, usual_kind
from .markup import PACKED, read_fcd, read_gpx
from .samples import Samples, refuse
from .smoothing import smoothed
from .table import read_table
from .trajectory import Trajectory

MOST_SECONDS = 1e6     # from which on times are taken to count from some day long ago
SUFFIXES = (".csv", ".txt", ".tsv", ".xml", ".xml.gz", ".gpx")


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


_RULES: dict[str, Rule] = {
    "path": file_rule, "origin": _origin_rule, "smoothing": real(0.0, unit="m"), "vehicle_length": length_rule,
    "goes_on": GOES_ON, "outside": one_of(Outside), "position": vector, "yaw": real(unit="rad")}


@checked(**_RULES)
def read_trajectories(path: str | os.PathLike[str], *, origin: ArrayLike | None = None, smoothing: float = 0.0,
                      vehicle_length: float | Mapping[str, float] | None = None, goes_on: float = 0.0,
                      outside: Outside = "absent", position: ArrayLike = (0.0, 0.0, 0.0),
                      yaw: float = 0.0) -> dict[str, Trajectory]:
    """Reads where objects were over time, by the suffix of the file.

    path: of the file, one of
    .csv, .txt, .tsv: a line of names of columns, then a row for each position: time (s, or ISO 8601), x and y (m), or lat and lon
        (degrees), and, where it has them, z or ele (m), id or name, type, yaw (rad, from x to y) or yaw_deg, speed (m/s). Names
        may be written in other usual ways ("Timestamp [s]", "track_id"), with a usual unit in brackets ("t [ms]", "x [cm]",
        "speed (km/h)"); other columns are left out. Commas, semicolons or tabs
    .xml, .xml.gz: floating car data of SUMO (--fcd-output), in m; vehicles and persons. Speeds are those of the positions
    .gpx: tracks of a GPS receiver

    origin: (latitude, longitude) in degrees, or with a height in m, about which positions of .gpx and of tables with lat and lon
        are made metres east (x), north (y) and up (z), on the WGS 84 ellipsoid; None: the first position of the file
    smoothing: m, root mean square by which the positions of an object may be moved to make them smooth; 0: not at all
    vehicle_length: m, or {glob of types: m}, by whose half the middle of a vehicle of SUMO lies behind the front bumper, of which
        its files tell; None, and types that none takes: as long as the actor that `add_traffic` takes for the type, so that
        its front is where the file has it (with an `actor_of` of one's own, give the lengths of its actors). Each glob must
        take a type of the file
    goes_on: s, so long they go straight on before their first and behind their last positions; outside: "absent": nobody is
        there before and behind that, or "stands"; both as of Trajectory
    position, yaw: [3] m and rad (left positive), where the origin and the +x of the file are in the world: a point p of the file
        is at position + R(yaw) p. A crossing at (x, y) of a network comes to the origin by position=(-x, -y, 0)
    Returns {name: Trajectory}, in the order of the file, each with the kind that the file tells. Between positions it goes along
    a C2 spline, by distances that are monotone cubics over time, so that what stands stays. Times are those of the file; those of
    ISO 8601 and beyond 1e6 s, such as those since 1970, count from the first of the file. Warns (RuntimeWarning) of objects
    with a single position, which are left out, and of speeds and yaws that the positions contradict, as those in km/h and in
    degrees do.
    Raises FileError naming the file, the line, the rule and the value, TypeError or ValueError naming the argument.
    """
    found = read_along(path, origin=origin, smoothing=smoothing, vehicle_length=vehicle_length, goes_on=goes_on,
                       outside=outside, position=position, yaw=yaw)
    if isinstance(vehicle_length, Mapping):
        require_kinds("vehicle_length", vehicle_length, (one.kind for one in found.values()))
    return found


@checked(**_RULES)
def read_along(path: str | os.PathLike[str], *, origin: ArrayLike | None, smoothing: float,
               vehicle_length: float | Mapping[str, float] | None, goes_on: float, outside: Outside, position: ArrayLike,
               yaw: float) -> dict[str, Trajectory]:
    """As `read_trajectories`, with lengths by globs of which some may take no type of the file."""
    _core.warn_of_turns(yaw)
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix == ".xml" or path.name.lower().endswith(".xml" + PACKED):
        tracks, is_geographic = read_fcd(path, _length_of(vehicle_length)), False
    elif suffix == ".gpx":
        tracks, is_geographic = read_gpx(path), True
    elif suffix in SUFFIXES:
        tracks, is_geographic = read_table(path)
    else:
        raise _core.FileError(f"{path}: must end in {', '.join(SUFFIXES)}")
    if not tracks:
        raise _core.FileError(f"{path}: holds no positions")
    earliest = min(min(samples.times) for samples in tracks.values())
    for samples in tracks.values():
        _check_order(path, samples)
        if earliest > MOST_SECONDS:
            samples.times = [time - earliest for time in samples.times]
    if is_geographic:
        origin = next(iter(tracks.values())).places[0] if origin is None else origin
    ends, placement = {"goes_on": goes_on, "outside": outside}, _Placement(np.asarray(position, float), yaw)
    return _trajectories(path, tracks, origin if is_geographic else None, smoothing, placement, ends)


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

    def yaws(self, yaws: list[float]) -> list[float]:
        """Yaws of the file in the world, rad."""
        return [yaw + self.yaw for yaw in yaws]


def _length_of(vehicle_length):
    """type -> m"""
    if isinstance(vehicle_length, Mapping):
        return lambda kind: of_kind(vehicle_length.items(), kind, usual_kind(kind).length)
    return lambda kind: usual_kind(kind).length if vehicle_length is None else vehicle_length


def _check_order(path: Path, samples: Samples) -> None:
    """Raises FileError where the times of an object do not ascend."""
    for before, after, line in zip(samples.times, samples.times[1:], samples.lines[1:]):
        if after - before < 1e-6:
            refuse(path, line, f"time: must be later than the {before:.12g} s of the row before of the same object, got "
                   f"{after:.12g}")


def _trajectories(path: Path, tracks: dict[str, Samples], origin, smoothing: float, placement: _Placement,
                  ends: dict) -> dict[str, Trajectory]:
    single = [name for name, samples in tracks.items() if len(samples.times) < 2]
    if single:
        warn_user(f"{path}: {counted(len(single), 'object')} with a single position "
                  f"{'are' if len(single) > 1 else 'is'} left out, such as '{single[0][:60]}'")
    found, doubts = {}, []
    for name, samples in tracks.items():
        if len(samples.times) < 2:
            continue
        places = np.array(samples.places)
        if origin is not None:
            places = east_north_up(places[:, 0], places[:, 1], places[:, 2], origin)
        doubts += [f"'{name[:60]}' {words}" for words in doubts_of(np.array(samples.times), places, samples.yaws, samples.speeds)]
        try:
            places = placement.places(smoothed(np.array(samples.times), places, smoothing))
            found[name] = Trajectory(points=places, times=samples.times, yaw=placement.yaws(samples.yaws) or None,
                                     speed=samples.speeds or None, kind=samples.kind, is_person=samples.is_person, **ends)
        except ValueError as error:
            refuse(path, samples.lines[0], f"'{name[:60]}': {error}")
    if doubts:
        warn_user(f"{path}: {doubts[0]}" + (f" ({len(doubts) - 1} more alike)" if len(doubts) > 1 else ""))
    return found
