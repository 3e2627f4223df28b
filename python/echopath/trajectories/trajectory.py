"""Trajectories: where something is over time, made of a path and of the speed along it."""
from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..arguments.checks import anything, array, checked, choice, flag, one_of, optional, positive, real, refused, text, vector
from ..base.numerics.rotations import product
from .arguments import (
    GOES_ON,
    LATEST,
    NEAREST,
    RATE,
    SPACING,
    Outside,
    checked_headings,
    checked_path,
    checked_points,
    checked_speed,
    checked_stops,
    checked_times,
)
from .knots import curve_through
from .limits import Limits, over_distance
from .path import DISTANCE_TOLERANCE, Path
from .profile import over_time, through
from .track import Track

TOLERANCE = 2e-6          # m, of positions at the places where curves are held against the trajectory
ROTATION_TOLERANCE = 1e-6  # of quaternions: a point 2.5 m from the origin errs by no more than 5 micrometres
LEAST_DETAIL = 1e-3       # s
ACCELERATION, DECELERATION = 2.0, 3.0   # m/s^2, of cars in traffic


class Trajectory(_core.CurveMotion):
    """Where something is over time: a path through points that is travelled at some speed; a Motion of objects and radars.

    `scene.add(..., motion=trajectory)`, `ep.Radar(motion=trajectory)`; actors with wheels and legs take it themselves
    (`ep.actors.car(trajectory=trajectory)`). It places an object in the axes of its parent, turned by the yaw; the position
    [0, 0, 0] of that object belongs to the points as they are. Before its begin and after its end it stands where it is
    then, or is not there at all (`outside`); `goes_on` lets it go straight on before that.

    points: [P, 2] or [P, 3] in m, P >= 2; those of two columns are at z = 0
    speed: m/s, constant; or [N, 2]: distances in m and speeds in m/s, between which the acceleration is constant; of `times`
        [P] m/s at the points, None: as the points say
    times: [P] in s, ascending: when it is at the points, which then may repeat where it stands. None: by `speed`
    spacing: m, with `times`: points no farther than that from the last one that the path goes through tell how far it has come,
        not where the path goes, as those of what stands and creeps; noise of places asks for more of it
    yaw: [P] in rad, with `times`: where it looks. None: along the path, and the other way at once where that turns back
    turn_radius: m; straight lines between the points, joined by arcs. None: a C2 spline over the chord lengths
    stops: [N, 2]: distances in m (math.inf: the end) and waiting times in s; one at 0 lets it start from rest. Needs no times
    acceleration, deceleration: m/s^2, by which it leaves and reaches its stops
    lateral_acceleration: m/s^2, the most that it takes in curves, before which it slows down, and until it stands where it turns
        back on the spot; None: it does not
    speed_over: "distance", or "time": the first column of `speed` is the time in s since its begin, the speed linear between
    start_time: s, when it is at its first point; of `times`, their own
    goes_on: s, so long it goes straight on at its first and last speed before its begin and after its end
    outside: "stands", or "absent": what follows it takes no part in frames that do not lie wholly between its begin and its end
        (`scene[name].lifetime`), as vehicles that come and go; a radar stands there all the same
    pitch: whether its nose follows the slope of the path, downwards where a yaw lets it back up a hill; else it stays level, and
        wheels ahead of its origin sink into the hill
    kind: what moves, as files tell ("passenger")
    is_person: whether it is a person, who is no vehicle whatever the word of the kind, as the persons of SUMO

    What the core follows are cubics through positions and velocities (`translation`, `rotation`) at times at which they err by
    less than 10 micrometres, and the rotation by less than 4 microradians. Raises TypeError or ValueError naming the argument.
    """

    @checked(self=anything, points=checked_points, speed=anything, times=optional(checked_times),
             yaw=optional(array("[P]", finite=True)), spacing=SPACING, turn_radius=optional(positive("m")), stops=checked_stops,
             acceleration=RATE, deceleration=RATE, lateral_acceleration=optional(RATE),
             speed_over=choice("distance", "time"), start_time=real(-LATEST, LATEST, "s"), goes_on=GOES_ON,
             outside=one_of(Outside), pitch=flag, kind=text, is_person=flag)
    def __init__(self, points: ArrayLike, *, speed: ArrayLike | None = None, times: ArrayLike | None = None,
                 yaw: ArrayLike | None = None, spacing: float = NEAREST, turn_radius: float | None = None, stops: ArrayLike = (),
                 acceleration: float = ACCELERATION, deceleration: float = DECELERATION,
                 lateral_acceleration: float | None = None, speed_over: Literal["distance", "time"] = "distance",
                 start_time: float = 0.0, goes_on: float = 0.0, outside: Outside = "stands", pitch: bool = False,
                 kind: str = "", is_person: bool = False):
        arguments = {name: value for name, value in locals().items() if name not in ("self", "__class__")}
        if times is None:
            if yaw is not None:
                raise refused(ValueError, "yaw", "given with times", yaw)
            if spacing != NEAREST:
                raise refused(ValueError, "spacing", "given with times", spacing)
            path = checked_path(points, turn_radius)
            track = Track(path, profile_along(path, speed, stops, acceleration, deceleration, lateral_acceleration, speed_over,
                                              start_time))
        else:
            track = _timed(arguments)
        self._follow(track, goes_on=goes_on, outside=outside, pitch=pitch, kind=kind, is_person=is_person,
                     made=(Trajectory, arguments))

    def _follow(self, track: Track, *, goes_on: float, outside: Outside, pitch: bool, kind: str, is_person: bool,
                made: tuple) -> None:
        """Becomes the motion of a track. made: (what makes it, its keywords), for copies."""
        self._track = Track(track.path, track.profile.going_on(goes_on), track.headings)
        self._has_pitch, self._kind, self._is_person, self._made, self._outside = pitch, kind, is_person, made, outside
        self._details: tuple[float, float] | None = None
        junctions = self._track.junctions()
        translation = curve_through(self._track.places, junctions, TOLERANCE)
        rotation = curve_through(lambda t: self._track.rotations(t, pitch), junctions, ROTATION_TOLERANCE)
        super().__init__(translation, rotation)

    @property
    def begin(self) -> float:
        """s, from which on it moves."""
        return self._track.profile.begin

    @property
    def end(self) -> float:
        """s, until which it moves."""
        return self._track.profile.end

    @property
    def lifetime(self) -> tuple[float, float] | None:
        """(begin, end) in s, between which alone what follows it is there (outside="absent"); None: it always is."""
        return (self.begin, self.end) if self._outside == "absent" else None

    @property
    def length(self) -> float:
        """m, of its path."""
        return self._track.path.length

    @property
    def kind(self) -> str:
        """What moves, "" where nothing is known."""
        return self._kind

    @property
    def is_person(self) -> bool:
        """Whether it is a person, who is no vehicle whatever the word of the kind."""
        return self._is_person

    def motion(self, position: ArrayLike = (0.0, 0.0, 0.0), *, axle: float = 0.0) -> _core.CurveMotion:
        """The CurveMotion that the core follows; scenes keep it in the place of the trajectory.

        position: [3] m, a place in the axes of what follows the trajectory (x ahead, y left, z up), whose motion is asked for:
            that of a radar behind the bumper of a car, `motion=car.motion((2.2, 0, 0.5))` of one at the origin, swings in curves
        axle: m, of the point ahead of the origin that stays on the path and looks along it where that is not the origin: 3.15
            for what rides on the cab of `ep.actors.truck`. A trajectory with a yaw of its own carries the cab as it says
        Raises TypeError or ValueError naming the argument.
        """
        mount, axle = np.asarray(vector("position", position), float), real(-100.0, 100.0, "m")("axle", axle)
        if axle and self._track.headings is None:
            return self._motion_on_axle(mount, axle)
        if not np.any(mount):
            return _core.CurveMotion(self.translation, self.rotation)

        def places(times):
            points, velocities = self._track.places(times)
            axes, rates = self._track.axes(times, self._has_pitch)
            return points + axes @ mount, velocities + rates @ mount

        return _core.CurveMotion(curve_through(places, self._track.junctions(), TOLERANCE), self.rotation)

    def _motion_on_axle(self, mount, axle: float) -> _core.CurveMotion:
        track, has_pitch = self._track, self._has_pitch
        place, turn = track.relative(lambda times: track.steered_by(times, axle), has_pitch)

        def places(times):
            points, velocities = track.places(times)
            axes, rates = track.axes(times, has_pitch)
            (origin, speed), (angle, rate) = place(times), turn(times)
            c, s = np.cos(angle), np.sin(angle)
            x, y = c * mount[0] - s * mount[1], s * mount[0] + c * mount[1]
            own = origin + np.stack([x, y, mount[2] + 0.0 * x], axis=-1)
            moving = speed + rate[:, None] * np.stack([-y, x, 0.0 * x], axis=-1)
            return (points + np.einsum("tij,tj->ti", axes, own),
                    velocities + np.einsum("tij,tj->ti", rates, own) + np.einsum("tij,tj->ti", axes, moving))

        def rotations(times):
            (values, changes), (angle, rate) = track.rotations(times, has_pitch), turn(times)
            turned, turning = _about_z(angle, rate)
            return product(values, turned), product(changes, turned) + product(values, turning)

        junctions = track.junctions_with(axle)
        return _core.CurveMotion(curve_through(places, junctions, TOLERANCE),
                                 curve_through(rotations, junctions, ROTATION_TOLERANCE))

    def position(self, time: ArrayLike) -> np.ndarray:
        """Position [3] or [T, 3] in m at a time or times [T] in s. Raises TypeError or ValueError naming `time`."""
        return _each(time, lambda at: self._track.places(at)[0])

    def velocity(self, time: ArrayLike) -> np.ndarray:
        """Velocity [3] or [T, 3] in m/s at a time or times [T] in s. Raises TypeError or ValueError naming `time`."""
        return _each(time, lambda at: self._track.places(at)[1])

    def acceleration(self, time: ArrayLike) -> np.ndarray:
        """Acceleration [3] or [T, 3] in m/s^2 at a time or times [T] in s. Raises TypeError or ValueError naming `time`."""
        return _each(time, self._track.accelerations)

    def speed(self, time: ArrayLike) -> np.ndarray:
        """Speed or [T] in m/s at a time or times [T] in s. Raises TypeError or ValueError naming `time`."""
        return _each(time, lambda at: self._track.profile.at(at)[1])

    def distance(self, time: ArrayLike) -> np.ndarray:
        """Distance travelled since the first point, or [T], in m, at a time or times [T] in s; below 0 before it with `goes_on`.
        Raises TypeError or ValueError naming `time`."""
        return _each(time, lambda at: self._track.profile.at(at)[0])

    def yaw(self, time: ArrayLike) -> np.ndarray:
        """Direction that it looks in, or [T], in rad from +x to the left, without jumps, so that it may be beyond a turn; at a
        time or times [T] in s. Raises TypeError or ValueError naming `time`."""
        return _each(time, lambda at: self._track.yaws(at)[0])

    def yaw_rate(self, time: ArrayLike) -> np.ndarray:
        """Change of the yaw, or [T], in rad/s at a time or times [T] in s. Raises TypeError or ValueError naming `time`."""
        return _each(time, lambda at: self._track.yaws(at)[1])

    def time_at(self, distance: ArrayLike) -> np.ndarray:
        """First time, or [N], in s at which it has travelled a distance, or distances [N], in m, from 0 to its length.
        Raises TypeError or ValueError naming `distance`."""
        def found(distances):
            reached = self._track.profile.at(np.array([self.begin, self.end]))[0]
            if np.any(distances < reached[0]) or np.any(distances > reached[1] + DISTANCE_TOLERANCE):
                raise refused(ValueError, "distance", f"from {reached[0]:g} to {reached[1]:g} m", distance)
            return self._track.time_at(np.minimum(distances, reached[1]))
        return _each(distance, found, "distance")

    @property
    def details(self) -> tuple[float, float]:
        """(begin, end) in s, between which alone what follows it moves in itself, too: wheels, trailers and limbs."""
        begin, end = self._details or (self.begin, self.end)
        return min(max(begin, self.begin), self.end), max(min(end, self.end), self.begin)

    def detailed(self, begin: float, end: float) -> Trajectory:
        """The same, whose followers move in themselves from `begin` to `end` alone; before and after, their wheels, trailers and
        limbs are held as they are then. The time that actors take to be made is by that span, no longer by the whole way.

        begin, end: s. Raises TypeError or ValueError naming the argument.
        """
        begin = real(-LATEST, LATEST, "s")("begin", begin)
        return self._with_details((begin, real(begin, LATEST, "s")("end", end)))

    def _within_details(self, times: ArrayLike) -> np.ndarray:
        """Those of the times [T] in s at which what follows it moves in itself, with the begin and the end of that, ascending."""
        begin, end = self.details
        if end - begin < LEAST_DETAIL:  # of a way that ends where the details begin
            begin, end = max(self.begin, begin - LEAST_DETAIL), min(self.end, end + LEAST_DETAIL)
        times = np.asarray(times, float)
        return np.unique(np.concatenate([[begin], times[(times > begin) & (times < end)], [end]]))

    def _with_details(self, details: tuple[float, float] | None) -> Trajectory:
        made = Trajectory.__new__(Trajectory)
        _core.CurveMotion.__init__(made, self.translation, self.rotation)
        made.__dict__.update(self.__dict__, _details=details)
        return made

    def shifted(self, seconds: float) -> Trajectory:
        """The same, so many s later.

        seconds: s. Raises TypeError or ValueError naming it.
        """
        seconds = real(-LATEST, LATEST, "s")("seconds", seconds)
        arguments = self._made[1]
        if arguments.get("times") is not None:
            later = self.replace(times=np.asarray(arguments["times"], float) + seconds)
        else:
            later = self.replace(start_time=arguments["start_time"] + seconds)
        return later if self._details is None else later.detailed(*(time + seconds for time in self._details))

    def replace(self, **changes: object) -> Trajectory:
        """A copy with other values of some arguments.

        changes: arguments of the constructor, or of `Lane.trajectory` where that made it, by name (m, s, m/s)
        Raises TypeError or ValueError as these do.
        """
        maker, arguments = self._made
        return _remade(maker, arguments | changes, self._details)

    def __reduce__(self):
        return _remade, (*self._made, self._details)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Trajectory) and (self.kind, self.is_person, self.lifetime) != (
                other.kind, other.is_person, other.lifetime):
            return False
        return super().__eq__(other)

    def __hash__(self) -> int:
        return super().__hash__()

    def __repr__(self) -> str:
        kind = f"'{self.kind}', " if self.kind else ""
        return f"Trajectory({kind}{self.length:.6g} m from {self.begin:g} to {self.end:g} s)"


def _about_z(angle, rate):
    """(unit quaternions [N, 4] (w, x, y, z) of turns about z by angles [N] in rad, their rates [N, 4] per s)."""
    c, s, zero = np.cos(0.5 * angle), np.sin(0.5 * angle), np.zeros_like(angle)
    return np.stack([c, zero, zero, s], axis=-1), 0.5 * rate[:, None] * np.stack([-s, zero, zero, c], axis=-1)


def profile_along(path: Path, speed, stops, acceleration, deceleration, lateral_acceleration, speed_over, start_time):
    """The Profile of a path, by the arguments of Trajectory."""
    table, given = checked_speed(speed, speed_over), checked_stops("stops", stops)
    places, waits = given.T
    if np.any(np.isfinite(places) & (places > path.length + DISTANCE_TOLERANCE)):
        raise refused(ValueError, "stops", f"at distances from 0 to {path.length:g} m, or math.inf", given.tolist())
    places = np.where(places > path.length - DISTANCE_TOLERANCE, path.length, places)  # the length is rounded either way
    if np.any(np.diff(places) <= 0.0):
        raise refused(ValueError, "stops", "at ascending distances", given.tolist())
    limits = Limits(np.stack([places, waits], axis=-1), acceleration, deceleration, lateral_acceleration)
    if speed_over == "distance":
        return over_distance(start_time, table, path, limits)
    if limits.are_any:
        raise refused(ValueError, "speed_over", "'distance', with stops and lateral_acceleration", speed_over)
    return over_time(start_time, table, path.length)


def _timed(arguments: dict) -> Track:
    """The Track through points at times."""
    points, times = arguments["points"], arguments["times"]
    for name, at_rest in (("stops", ()), ("lateral_acceleration", None), ("start_time", 0.0)):
        if len(arguments[name]) if name == "stops" else arguments[name] != at_rest:
            raise refused(ValueError, name, "given without times", arguments[name])
    if len(times) != len(points):
        raise refused(ValueError, "times", f"as many as the {len(points)} points", times)
    headings = checked_headings(arguments["yaw"], times)
    towards = 0.0 if headings is None else float(headings.at(times[:1])[0][0])
    path, places = _path_of_places(points, arguments["spacing"], arguments["turn_radius"], towards)
    speeds = arguments["speed"]
    if speeds is not None:
        speeds = np.asarray(array("[P]", "[]", "[N, 2]", finite=True)("speed", speeds), float)
        if speeds.shape != (len(points),) or np.any(speeds < 0.0):
            raise refused(ValueError, "speed", f"{len(points)} numbers of at least 0 m/s, one for each of the times", speeds)
    return Track(path, through(times, places, speeds), headings)


def _path_of_places(points, spacing: float, turn_radius, towards: float):
    """(the Path through points [P, 3] which may repeat, their distances [P] along it).

    Points within `spacing` of the last one that the path goes through tell no direction, but how far it has come: what creeps by
    less than that from row to row still moves.
    """
    if turn_radius is not None:
        raise refused(ValueError, "turn_radius", "given without times", turn_radius)
    kept = _apart(points, spacing)
    stands = len(kept) == 1
    ends = points[kept] if not stands else points[0] + np.array([np.zeros(3), [math.cos(towards), math.sin(towards), 0.0]])
    path = checked_path(ends, None)
    if stands:
        path.length = 0.0  # its second point only says where it looks
        return path, np.zeros(len(points))
    of = np.minimum(np.searchsorted(kept, np.arange(len(points)), side="right") - 1, len(kept) - 2)
    chords = np.diff(ends, axis=0)[of]
    shares = np.clip(np.sum((points - ends[of]) * chords, axis=-1) / np.sum(chords**2, axis=-1), 0.0, 1.0)
    places = path.junctions[of] + shares * np.diff(path.junctions)[of]
    return path, np.maximum.accumulate(places)


def _apart(points, spacing: float) -> np.ndarray:
    """Indices of the points [P, 3] that are more than `spacing` from the one before among them, both ends included if they
    can."""
    rows, kept = points.tolist(), [0]
    for index, row in enumerate(rows):
        if math.dist(row, rows[kept[-1]]) > spacing:
            kept.append(index)
    if len(kept) > 1 and math.dist(rows[-1], rows[kept[-2]]) > spacing:
        kept[-1] = len(rows) - 1
    return np.array(kept)


def _each(values: ArrayLike, function, argument: str = "time"):
    """function [N] -> [N, ...] of a number or numbers [N]."""
    given = np.asarray(array("[]", "[T]", finite=True)(argument, values), float)
    found = function(np.atleast_1d(given))
    return found if given.ndim else found[0]


def _remade(maker, arguments: dict, details: tuple[float, float] | None) -> Trajectory:
    made = maker(**arguments)
    return made if details is None else made._with_details(details)
