"""A captured walk along a trajectory: its cycle that closes best is repeated, as fast as the way asks.

The cycle goes on by the distance: over the way W of a cycle its poses pass once, so that on a straight way every foot is where it
was captured, standing feet stand. At a stop the pose stays what it is; in a curve soles turn with the body.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ... import _core
from ...base.numerics.rotations import about_z, matrices, product, quaternions
from ..keyframes import Frames

MOST_FRAMES = 400        # that are held against each other
SHORTEST = 0.4           # s, of a cycle
LEAST_WAY = 0.5          # m, of a cycle
MOST_APART = 0.10        # m, root mean square over the parts, between both ends of a cycle


@dataclass(frozen=True)
class CapturedCycle:
    """Poses by the share of a cycle, from 0 to the one before 1: origins [K, N, 3] in m and quaternions [K, N, 4] of the parts
    `names` [N], relative to a point that goes `way` m ahead along x in a cycle at a steady speed."""

    names: list
    way: float
    origins: np.ndarray
    turns: np.ndarray

    def frames(self, shares) -> dict[str, Frames]:
        """Frames of every part at shares [T] of a cycle, beyond 1 of the next ones."""
        origins, turns = (_periodic(values, shares) for values in (self.origins, self.turns))
        turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
        return {name: Frames(origins[:, index], matrices(turns[:, index])) for index, name in enumerate(self.names)}


class CaptureAlong:
    """A CapturedCycle along a Track (trajectories/track.py), which begins with the cycle."""

    def __init__(self, cycle: CapturedCycle, track):
        self._cycle, self._profile = cycle, track.profile

    def frames(self, times) -> dict[str, Frames]:
        """Frames of every part, by name, at times [T], relative to the place and yaw of the track."""
        return self._cycle.frames(self._profile.at(times)[0] / self._cycle.way)


def cycle_of(frames: dict[str, Frames], times, path) -> CapturedCycle:
    """The cycle of captured frames at times [T], z up, that closes best. Raises FileError naming the path for none."""
    names = list(frames)
    origins = np.stack([frames[name].origin for name in names], axis=1)
    turns = np.stack([quaternions(frames[name].rotation) for name in names], axis=1)
    begin, end = _best_span(origins - _level(origins[:, :1]), origins[:, 0], times, path)
    origins, turns = origins[begin:end + 1], turns[begin:end + 1]
    way = (origins[-1, 0] - origins[0, 0])[:2]
    ahead = about_z(np.array([-np.arctan2(way[1], way[0])]))[0]
    shares = np.linspace(0.0, 1.0, len(origins))
    going = origins[0, :1] + shares[:, None, None] * (_level(origins[-1:, :1]) - _level(origins[:1, :1]))
    origins = (origins - _level(going)) @ ahead.T
    turns = product(quaternions(ahead[None])[0], turns)
    origins = origins - shares[:, None, None] * (origins[-1] - origins[0])      # what is left between both ends is spread
    turns = turns * np.where(np.sum(turns[:1] * turns, axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    turns = turns - shares[:, None, None] * (turns[-1] - turns[0])
    return CapturedCycle(names, float(np.linalg.norm(way)), origins[:-1], turns[:-1])


def _best_span(poses, pelvis, times, path) -> tuple[int, int]:
    """(first, last) index of the cycle: poses [T, N, 3] about the pelvis [T, 3] at both ends, and their rates, are most alike."""
    step = max(1, len(times) // MOST_FRAMES)
    rates = np.gradient(poses, times, axis=0) * SHORTEST / (2.0 * np.pi)
    features = np.concatenate([poses, rates], axis=1)[::step].reshape(len(times[::step]), -1)
    squares = np.sum(features**2, axis=1)
    apart = squares[:, None] + squares - 2.0 * features @ features.T
    some, places = times[::step], pelvis[::step, :2]
    way = np.linalg.norm(places[None] - places[:, None], axis=-1)
    is_cycle = (some[None] - some[:, None] >= SHORTEST) & (way >= LEAST_WAY)
    if not is_cycle.any():
        raise _core.FileError(f"{path}: goes less than {LEAST_WAY} m, too little to go along a trajectory")
    best = np.where(is_cycle, apart, np.inf)
    first, last = np.unravel_index(int(best.argmin()), best.shape)
    off = float(np.sqrt(max(best[first, last], 0.0) / poses.shape[1]))
    if off > MOST_APART:
        raise _core.FileError(f"{path}: has no cycle of steps to be repeated along a trajectory: the poses that are most alike "
                              f"are {off:.2f} m apart, where {MOST_APART} m is the most")
    return int(first * step), int(last * step)


def _level(points):
    """Points [..., 3] on the ground below."""
    return points * [1.0, 1.0, 0.0]


def _periodic(values, shares):
    """Values [T, N, C] at shares [T] of C2 splines through one period of them [K, N, C]."""
    from scipy.interpolate import CubicSpline

    closed = np.concatenate([values, values[:1]])
    spline = CubicSpline(np.linspace(0.0, 1.0, len(closed)), closed, bc_type="periodic")
    return spline(np.mod(shares, 1.0))
