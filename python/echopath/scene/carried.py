"""The way in the world of a place on an object of a scene, as what rides there goes it."""
from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import refused
from ..base.numerics.placements import parent_from_node
from ..base.numerics.rates import STEP, rate_of
from ..base.numerics.rotations import nearest_rotations, quaternions
from ..trajectories.knots import curve_through
from ..trajectories.trajectory import ROTATION_TOLERANCE, TOLERANCE

TURN = 0.5         # rad between samples of a rotation by which the sign of its quaternions is told
MOST_SAMPLES = 2_000_000


def carried_motion(nodes: list[_core.Node], name: str, place: NDArray[np.float64],
                   during: tuple[float, float]) -> _core.CurveMotion:
    """The CurveMotion of a place [3] in m on the last of some nodes, each of which carries the next.

    name: of the last one, for errors; during: (begin, end) in s
    Raises ValueError naming the argument as `SceneNode.carried` does.
    """
    way = _Way(nodes, name, place, during)
    return _core.CurveMotion(curve_through(way.positions, way.junctions, TOLERANCE),
                             curve_through(way.rotations, way.junctions, ROTATION_TOLERANCE))


class _Way:
    """Positions and rotations of a place over time, with their rates.

    junctions: [N] s, both ends and where a motion is not smooth between them
    """

    def __init__(self, nodes, name, place, during):
        self._nodes, self._place = nodes, np.append(place, 1.0)
        motions = [node.motion for node in nodes if node.motion is not None]
        for node in nodes:
            if node.deformation is not None:
                raise ValueError(f"scene: '{name}' must not deform to carry something, has a {type(node.deformation).__name__}")
        begin = max((motion.span[0] for motion in motions), default=-math.inf)
        end = min((motion.span[1] for motion in motions), default=math.inf)
        if not begin <= during[0] < during[1] <= end:
            raise refused(ValueError, "during", f"within {begin:g} to {end:g} s, in which '{name}' has a motion", during)
        inside = [times[(times > during[0]) & (times < during[1])] for times in (_breaks(motion, during) for motion in motions)]
        self.junctions = np.unique(np.concatenate([during, *inside]))
        if np.linalg.det(self._pose(during[0])[:3, :3]) < 0.0:
            raise ValueError(f"scene: '{name}' must not be mirrored to carry something")
        rate = sum(motion.turn_rate(*during) for motion in motions)
        number = math.ceil((during[1] - during[0]) * rate / TURN) + 2
        if number > MOST_SAMPLES:
            raise refused(ValueError, "during", f"shorter: '{name}' turns by up to {rate:.3g} rad/s", during)
        self._samples = np.unique(np.concatenate([np.linspace(*during, number), self.junctions]))
        self._signs = quaternions([self._turn(time) for time in self._samples])

    def positions(self, times):
        """([N, 3] m, their rates in m/s) at times [N] in s."""
        return self._with_rates(lambda time: (self._pose(time) @ self._place)[:3], times, 3)

    def rotations(self, times):
        """([N, 4] quaternions (w, x, y, z), their rates per s) at times [N] in s."""
        return self._with_rates(self._quaternion, times, 4)

    def _with_rates(self, value, times, columns: int):
        rows = [(value(time), self._rate(value, time)) for time in times]
        values, rates = np.moveaxis(np.array(rows, float).reshape(-1, 2, columns), 1, 0)
        return values, rates

    def _rate(self, value, time: float):
        """By differences between the junctions about a time alone; near one of these, of what they tend to."""
        after = min(max(int(np.searchsorted(self.junctions, time)), 1), len(self.junctions) - 1)
        begin, end = self.junctions[after - 1:after + 1]
        step = min(STEP, 0.16 * (end - begin))
        near = min(max(time, begin + 2.0 * step), end - 2.0 * step)
        rate = rate_of(value, near, step)
        return rate if near == time else 2.0 * rate - rate_of(value, 2.0 * near - time, step)

    def _pose(self, time: float):
        """world_from_object [4, 4] in m."""
        pose = np.eye(4)
        for node in self._nodes:
            pose = pose @ parent_from_node(node, time)
        return pose

    def _turn(self, time: float):
        return nearest_rotations(self._pose(time)[None, :3, :3])[0]

    def _quaternion(self, time: float):
        found = quaternions([self._turn(time)])[0]
        nearest = min(int(np.searchsorted(self._samples, time)), len(self._samples) - 1)
        return found if found @ self._signs[nearest] >= 0.0 else -found


def _breaks(motion: _core.Motion, during) -> NDArray[np.float64]:
    """Times in s at which a motion is not smooth, of all runs of a loop."""
    breaks, period = np.asarray(motion.breakpoints), getattr(motion, "period", None)
    if period is None or not len(breaks):
        return breaks
    first, last = (math.floor((time - breaks[0]) / period) for time in during)
    return (breaks + period * np.arange(first, last + 1)[:, None]).ravel()
