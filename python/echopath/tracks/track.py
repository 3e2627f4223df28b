"""Tracks: a Kalman filter for each object that detections show, and whose it is by the truth."""
from __future__ import annotations

import math
from collections.abc import Iterable
from statistics import NormalDist

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, an, array, checked, count, optional, real
from ..base.process.callers import warn_user
from ..detections import Detections
from ..truth import Truth
from .assignment import assigned
from .kalman import Filters, begun
from .points import carrier_of, detections_rule, points_of
from .record import Tracks

_DISTANCE = real(0.0, unit="m")


def _std(unit: str):
    return real(above=0.0, high=1e6, unit=unit)


@checked(detections=detections_rule, times=array("[F]", finite=True), truth=optional(an(Truth)), radar=optional(an(_core.Radar)),
         range_std=_std("m"), azimuth_std=_std("rad"), velocity_std=optional(_std("m/s")), acceleration_std=_std("m/s^2"),
         speed_std=_std("m/s"), merge_distance=_DISTANCE, gate_probability=real(0.5, 1.0 - 1e-12), min_hits=count(1, 1000),
         max_misses=count(0, 1000), truth_distance=_DISTANCE)
def track(detections: Iterable[Detections] | Iterable[ArrayLike], times: ArrayLike, *, truth: Truth | None = None,
          radar: _core.Radar | None = None, range_std: float = 0.2, azimuth_std: float = 0.02, velocity_std: float | None = 1.0,
          acceleration_std: float = 2.0, speed_std: float = 10.0, merge_distance: float = 1.0,
          gate_probability: float = 0.99, min_hits: int = 3, max_misses: int = 3, truth_distance: float = 2.0) -> Tracks:
    """Tracks of detections from frame to frame, for comparison with the truth.

    Model: points in the plane that go straight but for random accelerations, a Kalman filter for each; detections within the
    gate of a track are assigned so that the sum of their log likelihoods is largest. With `radar` the radial velocities of
    Detections count, too, folded by its ambiguity, as soon as a track's speed along the line of sight is known to a quarter
    of that: a track does not go on with what moves otherwise. Frames of one chirp tell none. Heights are left out.
    detections: of each frame, in the order of time: Detections with azimuths, or points [D, 2] or [D, 3] in m in the radar's
        axes
    times: [F] s, ascending, of the frames: their middles, as `Truth` has them
    truth: of the same frames, names the object of each track, and of an object that shows in several places, as a guard rail
        does, only the track that follows it best; None: no names
    radar: whose motion carries the points into the axes of the world; None: tracks are in the x and y of the radar, a plane
        that stands upright where it looks down from a ceiling, and radial velocities are not used
    range_std, azimuth_std: m and rad, standard errors of a detection along and across the line of sight, across it upwards, too,
        where elevations or heights are known
    velocity_std: m/s, by which the radial velocity of a detection differs from that of its object, with limbs and wheels; None:
        radial velocities are not used
    acceleration_std: m/s^2, of each coordinate from frame to frame; speed_std: m/s, of the speeds with which tracks begin:
        what moves faster than about three times this, and whose radial velocity does not tell, begins none
    merge_distance: m, detections of a frame nearer to each other are one, in their mean weighted by power; 0: none are
    gate_probability: with which a detection of an object is within its gate, 0.5 to 1
    min_hits: detections that a track needs to count, within max_misses frames in a row without one; then it ends
    truth_distance: m, from the outline of an object's box at most, for a track to be its; one that is nearer to another object
        by more than half of it does not become its, as the further tracks of a guard rail do not become what passes the rail
    Returns Tracks, empty without any, with a warning where `min_hits` frames have detections. Raises TypeError or ValueError
    naming the argument.
    """
    _check_times(times, detections)
    _check_truth(truth, times)
    settings = {"range_std": range_std, "azimuth_std": azimuth_std, "speed_std": velocity_std, "merge_distance": merge_distance}
    tracker = _Tracker(acceleration_std, speed_std, gate_probability, min_hits, max_misses)
    for number, (found, time) in enumerate(zip(detections, times)):
        carrier = None if radar is None else carrier_of(radar, float(time))
        tracker.take(number, float(time), points_of(found, carrier, **settings))
    rows = tracker.rows()
    if not rows and sum(len(found) > 0 for found in detections) >= min_hits:
        axes, more = ("of the radar", ", or radar= for radial velocities") if radar is None else ("of the world", "")
        warn_user(f"speed_std: no track has min_hits = {min_hits} detections; what moves faster than about three times speed_std "
                  f"= {speed_std:g} m/s in the axes {axes} begins none: give a larger one{more}")
    return _as_tracks(rows, _objects_of(rows, truth, radar is not None, truth_distance))


def _check_times(times, detections) -> None:
    if len(times) != len(detections):
        raise ValueError(f"times: must have one for each of the {len(detections)} frames of detections, got {len(times)}")
    late = np.flatnonzero(np.diff(times) <= 0.0)
    if len(late):
        raise ValueError(f"times: must ascend, with all points of one time in one frame, got {times[late[0] + 1]:g} after "
                         f"{times[late[0]]:g}")


def _check_truth(truth: Truth | None, times) -> None:
    """Refuses the truth of other times, which would name objects by where they are then."""
    if truth is None or len(times) < 2:
        return
    rows = np.flatnonzero((truth.frame >= 0) & (truth.frame < len(times)))
    apart = np.abs(truth.time[rows] - np.asarray(times)[truth.frame[rows]])
    if len(rows) and apart.max() > 0.5 * np.diff(times).min():
        row = rows[apart.argmax()]
        raise ValueError(f"truth: must be of the times of the detections, got {truth.time[row]:g} s for frame {truth.frame[row]} "
                         f"of {times[truth.frame[row]]:g} s")


class _Track:
    """The rows (frame, time, state, covariance, is_detected) that a filter has given."""

    def __init__(self):
        self.rows, self.hits, self.misses = [], 0, 0

    def note(self, frame: int, time: float, state, covariance, is_detected: bool) -> None:
        self.hits, self.misses = self.hits + is_detected, 0 if is_detected else self.misses + 1
        self.rows.append((frame, time, state.copy(), covariance.copy(), is_detected))


class _Tracker:
    """The tracks that go on, `_live`, with a filter each, and those that have ended and count."""

    def __init__(self, acceleration_std, speed_std, gate_probability, min_hits, max_misses):
        self._acceleration_std, self._speed_std = acceleration_std, speed_std
        self._gate = -2.0 * math.log1p(-gate_probability)  # of chi-square with two degrees of freedom
        self._gate_of_speed = NormalDist().inv_cdf(0.5 + 0.5 * gate_probability) ** 2
        self._min_hits, self._max_misses = min_hits, max_misses
        self._live, self._ended, self._time = [], [], None
        self._filters = Filters(np.zeros((0, 4)), np.zeros((0, 4, 4)))

    def take(self, frame: int, time: float, found) -> None:
        """Brings all tracks to the points of a frame; what belongs to none begins a track."""
        if self._time is not None:
            self._filters = self._filters.predicted(time - self._time, self._acceleration_std)
        tracks, points = self._pairs(found)
        is_detected, is_new = np.zeros(len(self._live), bool), np.ones(len(found.points), bool)
        is_detected[tracks], is_new[points] = True, False
        self._filters = self._filters.updated(tracks, found.some(points)).with_others(begun(found.some(is_new), self._speed_std))
        self._live += [_Track() for _ in range(np.count_nonzero(is_new))]
        is_detected = np.append(is_detected, np.ones(np.count_nonzero(is_new), bool))
        for one, *values in zip(self._live, self._filters.states, self._filters.covariances, is_detected.tolist()):
            one.note(frame, time, *values)
        self._let_end()
        self._time = time

    def _let_end(self) -> None:
        """Tracks end that have missed too often."""
        goes_on = np.array([one.misses <= self._max_misses for one in self._live], bool)
        self._ended += [one for one, goes in zip(self._live, goes_on) if not goes and one.hits >= self._min_hits]
        self._live = [one for one, goes in zip(self._live, goes_on) if goes]
        self._filters = self._filters.some(goes_on)

    def rows(self) -> list:
        """[(number of the track, frame, time, state, covariance, is_detected)] of all that count, up to their last detection."""
        counted = self._ended + [one for one in self._live if one.hits >= self._min_hits]
        counted.sort(key=lambda one: one.rows[0][0])
        return [(number, *row) for number, one in enumerate(counted) for row in one.rows[:len(one.rows) - one.misses]]

    def _pairs(self, found) -> tuple[list[int], list[int]]:
        """(tracks [N], points [N]) that go together."""
        tracks, points = self._near(found)
        fit = self._filters.some(tracks).fit(found.some(points))
        is_within = (fit.place <= self._gate) & (fit.speed <= self._gate_of_speed)
        tracks, points, costs = tracks[is_within], points[is_within], fit.cost[is_within]
        some, row_of = np.unique(tracks, return_inverse=True)
        cost = np.full((len(some), len(found.points)), np.inf)
        cost[row_of, points] = costs
        limit = np.max(costs, initial=0.0) + self._gate + self._gate_of_speed  # of a track without any
        pairs = assigned(cost, limit)
        return [int(some[row]) for row, _ in pairs], [point for _, point in pairs]

    def _near(self, found) -> tuple[np.ndarray, np.ndarray]:
        """(tracks [N], points [N]) that may be within the gate: no axis of an ellipse is longer than the root of its trace."""
        beyond = sum((mine[:, None] - theirs) ** 2 for mine, theirs in zip(self._filters.states.T[:2], found.points.T))
        traces = [np.trace(one[:, :2, :2], axis1=1, axis2=2) for one in (self._filters.covariances, found.covariances)]
        return np.nonzero(beyond <= self._gate * (traces[0][:, None] + traces[1]))


def _objects_of(rows, truth, in_world: bool, truth_distance: float) -> list:
    """The name of the object that each row follows, "" for none, frame by frame, each object in one track at most.

    A track keeps its object while it is near it and no other track has followed that since; the rest go together so that their
    distances are least (the rule of CLEAR MOT: Bernardin and Stiefelhagen 2008).
    """
    names, kept, rows_of_frame = [""] * len(rows), {}, {}
    for index, row in enumerate(rows):
        rows_of_frame.setdefault(row[1], []).append(index)
    for frame, here in sorted(rows_of_frame.items()) if truth is not None else []:
        there = truth.of_frame(frame)
        places = (there.position, there.yaw) if in_world else (there.position_in_radar, there.yaw_in_radar)
        distance = _outline_distances(np.array([rows[index][3][:2] for index in here]), *places, there.size)
        is_kept = np.array([there.name == kept.get(rows[index][0], "") for index in here])
        cost = np.where(is_kept, -len(here) * (truth_distance + 1.0), distance)
        nearest = np.min(distance, axis=1, keepdims=True, initial=np.inf)
        is_possible = (distance <= truth_distance) & (is_kept | (distance <= nearest + 0.5 * truth_distance))
        pairs = assigned(np.where(is_possible, cost, np.inf), truth_distance + 1.0)
        taken = {rows[here[row]][0]: str(there.name[found]) for row, found in pairs}
        kept = {number: name for number, name in kept.items() if name not in taken.values()} | taken
        for row, found in pairs:
            names[here[row]] = str(there.name[found])
    return names


def _outline_distances(points, positions, yaws, sizes):
    """m, [M, N]: from points [M, 2] to the boxes from above, with a little of the distance to their centres within them."""
    way = points[:, None] - positions[None, :, :2]
    along = way[..., 0] * np.cos(yaws) + way[..., 1] * np.sin(yaws)
    across = way[..., 1] * np.cos(yaws) - way[..., 0] * np.sin(yaws)
    beyond = np.maximum(np.abs(np.stack([along, across], axis=-1)) - 0.5 * sizes[:, :2], 0.0)
    return np.linalg.norm(beyond, axis=-1) + 1e-12 * np.linalg.norm(way, axis=-1)


def _as_tracks(rows: list, names: list) -> Tracks:
    columns = list(zip(*rows)) or [[]] * 6
    return Tracks(track=np.array(columns[0], np.int32), frame=np.array(columns[1], np.int32), time=np.array(columns[2], float),
                  state=np.array(columns[3], float).reshape(-1, 4), covariance=np.array(columns[4], float).reshape(-1, 4, 4),
                  is_detected=np.array(columns[5], bool), object=np.array(names, dtype=str))
