"""Rules of the arguments of trajectories and lanes."""
from __future__ import annotations

from typing import Literal

import numpy as np

from ..arguments.checks import array, optional, real, refused
from .path import Path, SplinePath, turned_path
from .profile import Profile, hermite_coefficients, slopes_of

MOST_POINTS = 1_000_000
FARTHEST = 1e7          # m, beyond which positions in double precision are no longer those of radar
FASTEST = 1e4           # m/s
LATEST = 1e7            # s, beyond which a time in double precision is no longer known to nanoseconds
RATE = real(high=1e6, unit="m/s^2", above=0.0)    # of accelerations
NEAREST = 1e-3          # m, of points that follow each other
SPACING = real(NEAREST, FARTHEST, "m")
GOES_ON = real(0.0, 1e5, "s")
Outside = Literal["stands", "absent"]   # where something is before the begin and after the end of its trajectory


def checked_points(argument: str, value) -> np.ndarray:
    """Points [P, 3] in m of [P, 2] or [P, 3]."""
    points = np.array(array("[P, 2]", "[P, 3]", finite=True)(argument, value), float)
    if not 2 <= len(points) <= MOST_POINTS or np.abs(points).max() > FARTHEST:
        raise refused(ValueError, argument, f"2 to {MOST_POINTS} rows of numbers from -{FARTHEST:g} to {FARTHEST:g} m", value)
    return points if points.shape[1] == 3 else np.concatenate([points, np.zeros((len(points), 1))], axis=1)


def checked_path(points: np.ndarray, turn_radius: float | None) -> Path:
    """The Path through points [P, 3]."""
    steps = np.diff(points, axis=0)
    near = np.flatnonzero(np.linalg.norm(steps, axis=-1) < NEAREST)
    if len(near):
        raise refused(ValueError, "points", f"at least {NEAREST:g} m from one to the next", points[near[0]:near[0] + 2].tolist())
    upright = np.flatnonzero(np.hypot(steps[:, 0], steps[:, 1]) < 1e-6 * np.abs(steps[:, 2]))
    if len(upright):
        raise refused(ValueError, "points", "none straight above the one before", points[upright[0]:upright[0] + 2].tolist())
    return SplinePath(points) if turn_radius is None else turned_path(points, turn_radius)


def checked_times(argument: str, value) -> np.ndarray:
    """Times [P] in s, ascending."""
    times = np.array(array("[P]", finite=True)(argument, value), float)
    if len(times) < 2 or np.any(np.diff(times) < 1e-6) or np.abs(times).max() > LATEST:
        raise refused(ValueError, argument, f"at least 2 numbers, ascending by 1e-6 s or more, up to {LATEST:g} s", value)
    return times


def span(argument: str, value) -> tuple[float, float]:
    """(begin, end) in s."""
    begin, end = (float(one) for one in array("[2]", finite=True)(argument, value))
    if begin > end:
        raise refused(ValueError, argument, "(begin, end) in s, the end not before the begin", value)
    return begin, end


optional_span = optional(span)


def checked_stops(argument: str, value) -> np.ndarray:
    """Stops [N, 2]: distances in m and waiting times in s."""
    if isinstance(value, (tuple, list)) and len(value) == 0:
        return np.zeros((0, 2))
    stops = np.array(array("[N, 2]")(argument, value), float)
    if np.any(np.isnan(stops)) or np.any(stops < 0.0) or np.any(stops[:, 1] > 1e6):
        raise refused(ValueError, argument, "rows of a distance of at least 0 m and a waiting time from 0 to 1e+06 s", value)
    return stops


def checked_speed(speed, over: str) -> np.ndarray:
    """Rows [N, 2] of distance or time and speed."""
    if speed is None:
        raise refused(ValueError, "speed", "given, in m/s, or times", speed)
    table = np.array(array("[]", "[N, 2]", finite=True)("speed", speed), float)
    if table.ndim == 0:
        table = np.array([[0.0, float(table)]])
    unit = "m" if over == "distance" else "s"
    wrong = not len(table) or np.any(table[:, 1] < 0.0) or np.any(table[:, 1] > FASTEST) or not np.any(table[:, 1] > 0.0)
    if wrong or np.any(np.diff(table[:, 0]) <= 0.0):
        raise refused(ValueError, "speed", f"above 0 m/s, at most {FASTEST:g} m/s, or rows of ascending {unit} and speeds of at "
                      "least 0 m/s, one of them above", speed)
    return table


def checked_headings(yaw, times) -> Profile | None:
    """Yaw in rad over time, without jumps."""
    if yaw is None:
        return None
    if len(yaw) != len(times):
        raise refused(ValueError, "yaw", f"{len(times)} numbers in rad, one for each of the times", yaw)
    yaw = np.unwrap(np.asarray(yaw, float))
    return Profile(times, hermite_coefficients(np.diff(times), yaw, slopes_of(times, yaw)))
