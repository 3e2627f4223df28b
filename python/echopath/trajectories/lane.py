"""Lanes: ways beside a centre line, and from one to the next."""
from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ..arguments.checks import anything, array, checked, choice, flag, one_of, optional, positive, real, refused, text
from .arguments import GOES_ON, LATEST, RATE, Outside, checked_path, checked_points
from .path import Path, turn_of
from .track import Track
from .trajectory import ACCELERATION, DECELERATION, Trajectory, profile_along

WIDEST = 1e4          # m
PARTS = 16            # of each interval between knots of a centre line, at first, among which hairpins are looked for
MOST_TURN = 0.2       # rad, from place to place in a hairpin
NARROWEST = 1e-9      # m, of a hairpin; in less way a line turns back on itself
STEP = 1e-4            # m, of differences that give the second derivative
INSIDE = 1e-6          # of a step: how far from a knot the ends of differences stay, behind which the centre line bends otherwise


class Offsets:
    """The way to the left of a centre line over the distance along it, by quintics between constant values.

    first: m; changes [N, 3]: distance at which each begins, its length and the offset behind it, in m
    """

    def __init__(self, first: float, changes: np.ndarray):
        self._begins, self._lengths = changes[:, 0], changes[:, 1]
        self._after = changes[:, 2]
        self._before = np.concatenate([[first], changes[:-1, 2]])
        self._first = first
        self.knots = np.concatenate([self._begins, self._begins + self._lengths])

    @property
    def largest(self) -> float:
        """m, to either side."""
        return float(np.abs(np.append(self._after, self._first)).max())

    def at(self, distances):
        """(offset in m, its change in m/m), each [N]."""
        offset, slope = np.full(len(distances), self._first), np.zeros(len(distances))
        for begin, length, before, after in zip(self._begins, self._lengths, self._before, self._after):
            s = np.clip((distances - begin) / length, 0.0, 1.0)
            offset += (after - before) * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
            slope += (after - before) * 30.0 * s**2 * (1.0 - s) ** 2 / length
        return offset, slope


def _hairpins(center: Path, offset: float) -> np.ndarray:
    """Distances [N] in m along a line, close to each other where it turns within so little way that a way beside it, so many m
    away, swings farther than that. Raises ValueError where it turns back on itself, beside which no way leads on."""
    shares = np.linspace(0.0, 1.0, PARTS, endpoint=False)
    places = np.append((center.knots[:-1, None] + np.diff(center.knots)[:, None] * shares).ravel(), center.knots[-1])
    found: list[np.ndarray] = []
    while True:
        slopes, distances = center.slopes_at(places), center.distances(places)
        turns, ways = np.abs(np.diff(np.unwrap(np.arctan2(slopes[:, 1], slopes[:, 0])))), np.diff(distances)
        is_sharp = (turns > MOST_TURN) & (turns * offset > ways)
        if not is_sharp.any():
            return np.concatenate([[], *found])
        if np.any(ways[is_sharp] < NARROWEST):
            place = distances[:-1][is_sharp & (ways < NARROWEST)][0]
            raise ValueError(f"offset: must be 0 where the lane turns back on itself, as it does at {place:g} m, got up to "
                             f"{offset:g} m to a side")
        middles = 0.5 * (places[:-1] + places[1:])[is_sharp]
        found.append(center.distances(middles))
        places = np.sort(np.append(places, middles))


class OffsetPath(Path):
    """A path beside another one; u is the distance along that one."""

    def __init__(self, center: Path, offsets: Offsets):
        self._center, self._offsets = center, offsets
        junctions = np.concatenate([center.junctions, offsets.knots[(offsets.knots > 0.0) & (offsets.knots < center.length)]])
        self.knots = np.unique(np.concatenate([junctions, _hairpins(center, offsets.largest)]))
        super().__init__(self.knots)
        self.junctions = self.distances(np.unique(junctions))
        sideways = np.sum(self.jets(self._u)[1] * center.at(self._u)[1], axis=-1)
        if np.any(sideways <= 0.0):
            place = float(self._u[int(np.argmin(sideways))])
            raise ValueError(f"offset: must be less than the radius of the curve at {place:g} m, got "
                             f"{float(offsets.at(np.array([place]))[0][0]):g} m")

    def jets(self, u):
        k = np.clip(np.searchsorted(self.knots, u, side="right") - 1, 0, len(self.knots) - 2)
        begin, end = self.knots[k], self.knots[k + 1]
        inside = INSIDE * np.minimum(STEP, end - begin)
        low, high = np.maximum(u - STEP, begin + inside), np.minimum(u + STEP, end - inside)
        point, first = self._jet(u)
        second = (self._jet(high)[1] - self._jet(low)[1]) / (high - low)[:, None]
        return point, first, second

    def slopes_at(self, u):
        return self._jet(u)[1]

    def _jet(self, u):
        point, tangent, bend = self._center.at(u)
        turn = turn_of(tangent, bend)
        offset, slope = (values[:, None] for values in self._offsets.at(u))
        level = tangent * [1.0, 1.0, 0.0]
        level /= np.linalg.norm(level, axis=-1, keepdims=True)
        left = np.stack([-level[:, 1], level[:, 0], np.zeros(len(u))], axis=-1)
        return point + offset * left, tangent + slope * left - offset * turn[:, None] * level


class Lane:
    """A lane of a road: a centre line and a width. Whatever drives in it, or beside it, follows `trajectory`.

    points: [P, 2] or [P, 3] in m along the centre line; width: m; turn_radius: m, arcs between straight lines; None: a C2 spline
    Raises TypeError or ValueError naming the argument.
    """

    @checked(self=anything, points=checked_points, width=positive("m"), turn_radius=optional(positive("m")))
    def __init__(self, points: ArrayLike, *, width: float = 3.5, turn_radius: float | None = None):
        self._points, self._width, self._turn_radius = np.asarray(points, float), width, turn_radius
        self._path = checked_path(checked_points("points", points), turn_radius)

    @property
    def points(self) -> np.ndarray:
        """[P, 3] in m."""
        return self._points.copy()

    @property
    def width(self) -> float:
        """Width of the lane in m."""
        return self._width

    @property
    def length(self) -> float:
        """m, of the centre line."""
        return self._path.length

    @checked(self=anything, distance=array("[]", "[N]", finite=True), offset=array("[]", "[N]", finite=True))
    def position(self, distance: ArrayLike, offset: ArrayLike = 0.0) -> np.ndarray:
        """Points of the road, [3] or [N, 3] in m.

        distance: m along the centre line, or [N]; offset: m to the left of it, or [N]
        Raises TypeError or ValueError naming the argument.
        """
        distances, offsets = np.broadcast_arrays(np.asarray(distance, float), np.asarray(offset, float))
        point, tangent, _ = self._path.at(np.atleast_1d(distances))
        left = np.stack([-tangent[:, 1], tangent[:, 0], np.zeros(len(tangent))], axis=-1)
        left /= np.linalg.norm(left, axis=-1, keepdims=True)
        found = point + np.atleast_1d(offsets)[:, None] * left
        return found if distances.ndim else found[0]

    @checked(self=anything, speed=anything, offset=real(-WIDEST, WIDEST, "m"), changes=anything, reverse=flag, stops=anything,
             acceleration=RATE, deceleration=RATE, lateral_acceleration=optional(RATE),
             speed_over=choice("distance", "time"), start_time=real(-LATEST, LATEST, "s"), goes_on=GOES_ON,
             outside=one_of(Outside), pitch=flag, kind=text, is_person=flag)
    def trajectory(self, *, speed: ArrayLike, offset: float = 0.0, changes: ArrayLike = (), reverse: bool = False,
                   stops: ArrayLike = (), acceleration: float = ACCELERATION, deceleration: float = DECELERATION,
                   lateral_acceleration: float | None = None, speed_over: Literal["distance", "time"] = "distance",
                   start_time: float = 0.0, goes_on: float = 0.0, outside: Outside = "stands", pitch: bool = False,
                   kind: str = "", is_person: bool = False) -> Trajectory:
        """Drives along the lane, or so far beside it: a Trajectory.

        offset: m to the left of the centre line as its points go; `lane.width` is the middle of the next lane on the left
        changes: [N, 3]: distance at which a change of lanes begins, its length along the centre line, and the offset behind it,
            in m; a quintic, which begins and ends without sideways speed and acceleration
        reverse: whether it drives against the points; then distances count from the last one
        speed, stops, acceleration, deceleration, lateral_acceleration, speed_over, start_time, goes_on, outside, pitch,
            kind, is_person: as of Trajectory; distances of `speed` and `stops` are those that it travels
        Returns a Trajectory. Raises TypeError or ValueError naming the argument.
        """
        arguments = {name: value for name, value in locals().items() if name != "self"}
        rows, sign = _checked_changes(changes, self.length), -1.0 if reverse else 1.0
        center = checked_path(self._points[::-1], self._turn_radius) if reverse else self._path
        path = center
        if offset != 0.0 or len(rows):
            path = OffsetPath(center, Offsets(sign * offset, rows * [1.0, 1.0, sign]))
        profile = profile_along(path, speed, stops, acceleration, deceleration, lateral_acceleration, speed_over, start_time)
        trajectory = Trajectory.__new__(Trajectory)
        trajectory._follow(Track(path, profile), goes_on=goes_on, outside=outside, pitch=pitch, kind=kind,
                           is_person=is_person, made=(self.trajectory, arguments))
        return trajectory

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Lane) and np.array_equal(self._points, other._points) and \
            (self._width, self._turn_radius) == (other._width, other._turn_radius)

    def __hash__(self) -> int:
        return hash((self._points.tobytes(), self._width, self._turn_radius))

    def __repr__(self) -> str:
        return f"Lane({self.length:.6g} m long, {self.width:g} m wide)"


def _checked_changes(value, longest: float) -> np.ndarray:
    """Changes of lanes [N, 3], one after the other, on a lane of `longest` m."""
    if isinstance(value, (tuple, list)) and len(value) == 0:
        return np.zeros((0, 3))
    rows = np.array(array("[N, 3]", finite=True)("changes", value), float)
    ends = rows[:, 0] + rows[:, 1]
    is_out_of_range = np.any(rows[:, 1] <= 0.0) or np.any(rows[:, 0] < 0.0) or np.any(np.abs(rows) > WIDEST)
    if is_out_of_range or np.any(ends[:-1] > rows[1:, 0] + 1e-9):
        raise refused(ValueError, "changes", "rows of a distance of at least 0 m, a length above 0 m and an offset, each behind "
                      "the one before", value)
    if len(rows) and ends.max() > longest + 1e-6:
        raise refused(ValueError, "changes", f"made within the {longest:g} m of the lane", rows[int(ends.argmax())].tolist())
    return rows
