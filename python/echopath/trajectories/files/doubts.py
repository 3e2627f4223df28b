"""Speeds and yaws of a file that its positions contradict, as those in other units do, positions that jump, and what spins."""
from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

LEAST_WAY = 5.0        # m, below which nothing is said
STEADY = 0.5           # of two speeds in a row the smaller over the larger, from which on their mean tells the way between
MOST_RATIO = 1.5       # of a way by speeds and by positions: corners and rounding make less, km/h 3.6
LEAST_STEP = 0.2       # m, of positions that tell a direction
FASTEST = 150.0        # m/s from one position to the next, above which nothing goes on roads and rails
FASTEST_TURN = 20.0    # rad/s, three turns a second, above which nothing on roads turns as a whole
ACROSS, ALONG = 0.9, 0.97   # mean cosines of yaws and way, below and above which these are not and are along it
BETTER = 0.05          # mean cosine by which yaws in degrees lie nearer to the way than they do in rad


def doubts_of(times: NDArray[np.float64], places: NDArray[np.float64], yaws: NDArray[np.float64],
              speeds: NDArray[np.float64], told_in_degrees: bool) -> list[str]:
    """What is said of an object of a file, none where its columns agree.

    times: [P] s; places: [P, 3] m; yaws: [P] rad or empty; speeds: [P] m/s or empty; told_in_degrees: whether
    the file calls its yaws so
    """
    said = [_of_speeds(times, places, speeds) if len(speeds) else "",
            _of_yaws(places, yaws, told_in_degrees) if len(yaws) else "", _of_jumps(times, places)]
    return [words for words in said if words]


def doubt_of_turns(times: NDArray[np.float64], yaws: NDArray[np.float64], has_yaws: bool) -> str:
    """What is said of an object that turns too fast, "" where it does not.

    times: [K] s, so close that yaws [K] in rad between are those between; has_yaws: whether the file tells them
    """
    if len(times) < 2:
        return ""
    rates = np.abs(np.diff(yaws)) / np.diff(times)
    fastest = int(np.argmax(rates))
    if rates[fastest] <= FASTEST_TURN:
        return ""
    reason = ("yaws that flip do" if has_yaws else
              "what stands does by the noise of its positions, and what turns back; smoothing, or a column yaw, holds it")
    return f"turns by {rates[fastest]:.3g} rad/s at {times[fastest]:.4g} s, as {reason}"


def _of_speeds(times: NDArray[np.float64], places: NDArray[np.float64], speeds: NDArray[np.float64]) -> str:
    before, after = speeds[:-1], speeds[1:]
    is_steady = np.minimum(before, after) > STEADY * np.maximum(before, after)
    by_speed = float(np.sum((0.5 * (before + after) * np.diff(times))[is_steady]))
    by_place = float(np.sum(np.linalg.norm(np.diff(places, axis=0), axis=1)[is_steady]))
    if max(by_speed, by_place) < LEAST_WAY or by_place < MOST_RATIO * by_speed < MOST_RATIO**2 * by_place:
        return ""
    return (f"goes {by_speed:.3g} m by its speeds and {by_place:.3g} m by its positions; a unit in brackets, such as "
            "'speed [km/h]', says in which a column is")


def _of_jumps(times: NDArray[np.float64], places: NDArray[np.float64]) -> str:
    ways = np.linalg.norm(np.diff(places, axis=0), axis=1)
    beyond = ways - FASTEST * np.diff(times)
    jump = int(np.argmax(beyond))
    if beyond[jump] <= LEAST_WAY:
        return ""
    return (f"goes {ways[jump]:.3g} m from {times[jump]:g} to {times[jump + 1]:g} s, as where a name is given to something "
            "else, or a unit is another")


def _of_yaws(places: NDArray[np.float64], yaws: NDArray[np.float64], told_in_degrees: bool) -> str:
    steps = np.diff(places, axis=0)
    moves = np.hypot(steps[:, 0], steps[:, 1]) > LEAST_STEP
    if not moves.any():
        return ""
    bearings = np.arctan2(steps[moves, 1], steps[moves, 0])

    def nearness(turns: NDArray[np.float64]) -> float:
        turns = np.unwrap(turns)
        return float(np.mean(np.cos(0.5 * (turns[:-1] + turns[1:])[moves] - bearings)))

    as_told, in_degrees = nearness(yaws), -1.0 if told_in_degrees else nearness(np.radians(yaws))
    largest = f"has a yaw of up to {np.abs(yaws).max():.4g} rad, which points along its way as degrees; call the column yaw_deg"
    if np.abs(yaws).max() > 2.0 * math.pi and in_degrees >= as_told + BETTER:
        return largest
    if abs(as_told) >= ACROSS:  # what backs up all the way looks against it
        return ""
    if in_degrees > ALONG:  # of straight roads these are few, which as rad point across them
        return largest
    for axis, turns in (("y, as from north", 0.5 * math.pi - yaws), ("x", -yaws)):
        if nearness(turns) > ALONG:
            return f"has yaws that point along its way as counted clockwise from +{axis}; they count from +x to +y, to the left"
    return ""
