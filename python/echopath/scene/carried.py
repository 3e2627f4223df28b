"""The way in the world of a place on an object of a scene, as what rides there goes it."""
from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import refused
from ..base.numerics.placements import parent_from_node
from ..base.numerics.rates import STEP
from ..base.numerics.rotations import nearest_rotations, quaternions
from ..trajectories.knots import curve_through
from ..trajectories.trajectory import ROTATION_TOLERANCE, TOLERANCE

TURN = 0.5         # rad between samples of a rotation, by which the signs of its quaternions are told
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
        if np.linalg.det(self._poses(during[:1])[0, :3, :3]) < 0.0:
            raise ValueError(f"scene: '{name}' must not be mirrored to carry something")
        self._samples = _samples_between(self.junctions, motions, name)
        self._signs = quaternions(self._turns(self._samples))

    def positions(self, times):
        """([N, 3] m, their rates in m/s) at times [N] in s."""
        return self._with_rates(lambda at: (self._poses(at) @ self._place)[:, :3], times)

    def rotations(self, times):
        """([N, 4] quaternions (w, x, y, z), their rates per s) at times [N] in s."""
        return self._with_rates(self._quaternions, times)

    def _with_rates(self, values, times):
        """By differences between the junctions about a time alone; near one of these, what the rates tend to. At a junction a
        value is that of the time after it already."""
        after = np.clip(np.searchsorted(self.junctions, times), 1, len(self.junctions) - 1)
        begins, ends = self.junctions[after - 1], self.junctions[after]
        steps = np.minimum(STEP, 0.14 * (ends - begins))
        near = np.clip(times, begins + 2.5 * steps, ends - 2.5 * steps)
        rates = _rates(values, near, steps)
        return values(times), 2.0 * rates - np.where((near == times)[:, None], rates, _rates(values, 2.0 * near - times, steps))

    def _poses(self, times):
        """world_from_object [N, 4, 4] in m."""
        poses = np.broadcast_to(np.eye(4), (len(times), 4, 4))
        for node in self._nodes:
            poses = poses @ np.array([parent_from_node(node, time) for time in times]).reshape(-1, 4, 4)
        return poses

    def _turns(self, times):
        return nearest_rotations(self._poses(times)[:, :3, :3])

    def _quaternions(self, times):
        """[N, 4], of one sign with those before them from the last junction on, at which they may jump."""
        found = quaternions(self._turns(times))
        before = np.searchsorted(self._samples, times, side="right") - 1
        return found * np.where(np.sum(found * self._signs[before], axis=1) < 0.0, -1.0, 1.0)[:, None]


def _samples_between(junctions, motions: list[_core.Motion], name: str) -> NDArray[np.float64]:
    """The junctions, and times in s between them from one to the next of which the motions turn by no more than TURN."""
    pieces = list(itertools.pairwise(junctions))
    rates = [sum(motion.turn_rate(*piece) for motion in motions) for piece in pieces]
    numbers = [math.ceil((end - begin) * rate / TURN) + 1 for (begin, end), rate in zip(pieces, rates)]
    if sum(numbers) > MOST_SAMPLES:
        raise refused(ValueError, "during", f"shorter: '{name}' turns by up to {max(rates):.3g} rad/s",
                      (float(junctions[0]), float(junctions[-1])))
    between = [np.linspace(*piece, number, endpoint=False) for piece, number in zip(pieces, numbers)]
    return np.append(np.concatenate(between), junctions[-1])


def _rates(values, times, steps):
    """Derivatives [N, C] of values(times) by differences of fourth order."""
    near, far = (values(times + reach) - values(times - reach) for reach in (steps, 2.0 * steps))
    return (8.0 * near - far) / (12.0 * steps)[:, None]


def _breaks(motion: _core.Motion, during) -> NDArray[np.float64]:
    """Times in s at which a motion is not smooth, of all runs of a loop."""
    breaks, period = np.asarray(motion.breakpoints), getattr(motion, "period", None)
    if period is None or not len(breaks):
        return breaks
    first, last = (math.floor((time - breaks[0]) / period) for time in during)
    return (breaks + period * np.arange(first, last + 1)[:, None]).ravel()
