"""Trajectories of files."""
from __future__ import annotations

import os
from collections.abc import Mapping

from numpy.typing import ArrayLike

from ...arguments.checks import checked
from ..arguments import Outside, optional_span
from ..trajectory import Trajectory
from .track_file import RULES, TrackFile, on_the_way, warn_of_nobody


@checked(during=optional_span, **RULES)
def read_trajectories(path: str | os.PathLike[str], *, origin: ArrayLike | None = None, smoothing: float = 0.0,
                      vehicle_length: float | Mapping[str, float] | None = None, goes_on: float = 0.0,
                      outside: Outside = "absent", during: ArrayLike | None = None, position: ArrayLike = (0.0, 0.0, 0.0),
                      yaw: float = 0.0) -> dict[str, Trajectory]:
    """Reads where objects were over time, by the suffix of the file.

    path: of the file, one of
    .csv, .txt, .tsv: a line of names of columns, then a row for each position: time (s, or ISO 8601), x and y (m), or lat and lon
        (degrees), and, where it has them, z or ele (m), id or name, type, yaw (rad, from x to y) or yaw_deg, speed (m/s). Names
        may be written in other usual ways ("Timestamp [s]", "track_id"), with a usual unit in brackets ("t [ms]", "x [cm]",
        "speed (km/h)"); other columns are left out. Commas, semicolons or tabs
    .xml, .xml.gz: floating car data of SUMO (--fcd-output), in m; vehicles and persons. Speeds are those of the positions.
        Who is missing in some steps and comes back where no speed leads, as behind a teleport, is another from there, "name_2",
        and so is a person who jumps, as across junctions without crossings; a person with the id of a vehicle is "id_person"
    .gpx: tracks of a GPS receiver; one with the name of a track before it is "name_2"

    Rows without a height have one between those of the rows around.

    origin: (latitude, longitude) in degrees, or with a height in m, about which positions of .gpx and of tables with lat and lon
        are made metres east (x), north (y) and up (z), on the WGS 84 ellipsoid; None: the first position of the file
    smoothing: m, root mean square by which the positions of an object may be moved to make them smooth; 0: not at all. Places
        within three times that, 5 cm at least, are those of what stands (`spacing` of Trajectory): give the noise of recorded
        positions, by which what stands would spin
    vehicle_length: m, or {glob of types: m}, by whose half the middle of a vehicle of SUMO lies behind the front bumper, of which
        its files tell; None, and types that none takes: as long as the actor that `add_traffic` takes for the type, so that
        its front is where the file has it (with an `actor_of` of one's own, give the lengths of its actors)
    goes_on: s, so long they go straight on before their first and behind their last positions; outside: "absent": nobody is
        there before and behind that, or "stands"; both as of Trajectory
    during: (begin, end) in s, outside of which nothing is of interest: who is on the way at no time of it is left out, and what
        follows the others moves in itself in it alone (`Trajectory.detailed`). Large files are so read faster. None: all
    position, yaw: [3] m and rad (left positive), where the origin and the +x of the file are in the world: a point p of the file
        is at position + R(yaw) p. A crossing at (x, y) of a network comes to the origin by position=(-x, -y, 0)
    Returns {name: Trajectory}, in the order of the file, each with the kind that the file tells. Between positions it goes along
    a C2 spline, by distances that are monotone cubics over time, so that what stands stays. Times are those of the file; those of
    ISO 8601 and beyond 1e6 s, such as those since 1970, count from the first of the file. Warns (RuntimeWarning) of objects
    with a single position, which are left out, of speeds and yaws that the positions contradict, as those in km/h, in degrees
    and from north do, of positions that jump by more than 150 m/s, of what turns by more than 20 rad/s, of globs of types of
    which the file has none, and of a span in which nobody is on the way.
    Raises FileError naming the file, the line, the rule and the value, TypeError or ValueError naming the argument.
    """
    file = TrackFile(path, origin=origin, smoothing=smoothing, vehicle_length=vehicle_length, goes_on=goes_on, outside=outside,
                     position=position, yaw=yaw)
    if isinstance(vehicle_length, Mapping):
        file.warn_of_unused("vehicle_length", vehicle_length)
    warn_of_nobody(file.ways, during)
    found = file.trajectories(on_the_way(file.ways, during))
    return found if during is None else {name: one.detailed(*during) for name, one in found.items()}
