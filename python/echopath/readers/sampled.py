"""Transforms and vertices sampled over time as motions of a scene: held beyond their ends, or repeated without end."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import refused
from ..base.numerics.rotations import nearest_rotations, quaternions
from .options import ReadOptions

HOLD = 1e5            # s for which vertices of the ends are held, from them and from time 0 of the scene
SHORTEST_LOOP = 1e-6  # s, as of ep.CurveMotion
RIGID = 1e-6          # by which a turn may differ from one
CLOSED = 1e-6         # by which the ends of a closed loop may differ, as a share of its size
ROUNDING = 1e-13
# shares of five even samples in the slope at each of them, exact up to the fourth power
_FIVE = np.array([[-25, 48, -36, 16, -3], [-3, -10, 18, -6, 1], [1, -8, 0, 8, -1], [-1, 6, -18, 10, 3],
                  [3, -16, 36, -48, 25]]) / 12.0
SEAM_FRAMES = 16      # of its other end that a closed loop has beyond each end: splines forget them by 0.27 a frame


def chosen_animation(options: ReadOptions, names: tuple[str, ...]) -> str | None:
    """The name of the animation that the options ask for, None: none. Raises ValueError for one that is not there."""
    if options.animation == "" or (options.animation is None and not names):
        return None
    if options.animation is not None and options.animation not in names:
        rule = " or ".join(f"'{name}'" for name in names) or "none, the file has no animation"
        raise refused(ValueError, "animation", rule, options.animation)
    return options.animation or names[0]


class Clock:
    """Takes times of a file to those of the curves of a scene, which begin with the animation.

    begin, end: of the animation in s, which is at `options.offset` at time 0 of the scene
    period: s after which it begins anew, None: its ends are held; offset: s, the time of the curves at time 0 of the scene
    steps: whether each sample holds until the next one; it is linear between them otherwise
    """

    def __init__(self, options: ReadOptions, begin: float, end: float, steps: bool = False):
        self._begin = begin
        self.steps = steps
        self.period = period_of(options, end - begin)
        self.offset = options.offset - begin

    @property
    def playback(self) -> dict:
        """The arguments of what is played by curves."""
        return {"period": self.period, "offset": self.offset}

    @property
    def interpolation(self) -> str:
        """Of Curves of sampled transforms and weights."""
        return "step" if self.steps else "linear"

    def times(self, seconds) -> np.ndarray:
        """Times [T] of curves in s of times of the file."""
        return np.asarray(seconds, float) - self._begin


def period_of(options: ReadOptions, duration: float) -> float | None:
    """The period in s of an animation of that duration, None where it is not to be repeated."""
    return duration if options.loop and duration >= SHORTEST_LOOP else None


def moved_rigidly(times, matrices, clock: Clock, knots=None):
    """(placement [4, 4], CurveMotion or None, whether it was rigid) of transforms [T, 4, 4] at `times` [T] s.

    The placement holds the scale and the turn at first, the motion everything after it, as the clock says between the samples.
    A scale that changes stays as it is at first.

    knots: places [K] in T between which the transforms are smooth, and evenly sampled; None: it is as the clock says
    """
    matrices = np.asarray(matrices, float)
    if len(matrices) < 2 or np.array_equal(matrices, np.broadcast_to(matrices[0], matrices.shape)):
        return matrices[0], None, True
    turns = matrices[:, :3, :3] @ np.linalg.inv(matrices[0, :3, :3])
    rotations = nearest_rotations(turns)
    placement = matrices[0].copy()
    placement[:3, 3] = 0.0
    keys = clock.times(times)
    turning = None
    if np.abs(turns - np.eye(3)).max() > ROUNDING:
        turning = _curve(keys, quaternions(rotations), clock, knots)
    motion = _core.CurveMotion(_curve(keys, matrices[:, :3, 3], clock, knots), turning, **clock.playback)
    return placement, motion, bool(np.abs(turns - rotations).max() < RIGID)


def _curve(keys, values, clock: Clock, knots) -> _core.Curve:
    if knots is None or clock.steps:
        return _core.Curve(keys, values, clock.interpolation)
    leaving, arriving = np.zeros_like(values), np.zeros_like(values)
    for begin, end in zip(knots, knots[1:]):
        slopes = _slopes(values[begin:end + 1]) * (end - begin) / (keys[end] - keys[begin])
        leaving[begin:end], arriving[begin + 1:end + 1] = slopes[:-1], slopes[1:]
    return _core.Curve(keys, values, "hermite", in_tangents=arriving, out_tangents=leaving)


def _slopes(values: np.ndarray) -> np.ndarray:
    """[T, C] of even samples by their spacing: those of polynomials through five, of the line through two."""
    if len(values) == 2:
        return np.repeat(np.diff(values, axis=0), 2, axis=0)
    first = np.clip(np.arange(len(values)) - 2, 0, len(values) - 5)  # of the five
    rows = _FIVE[np.arange(len(values)) - first]
    return np.einsum("tk,tkc->tc", rows, values[first[:, None] + np.arange(5)])


def moved_with_scale(times, matrices, clock: Clock) -> tuple[_core.CurveMotion, bool]:
    """(CurveMotion, whether it is all of it) of transforms [T, 4, 4] at `times` [T] s that turn and scale, for a joint.

    Each is a scale along its own axes, then a turn, then a shift, as the clock says between the samples; what shears stays out.
    """
    matrices = np.asarray(matrices, float)
    scales = np.linalg.norm(matrices[:, :3, :3], axis=1)
    scales[:, 2] *= np.sign(np.linalg.det(matrices[:, :3, :3]))
    turns = matrices[:, :3, :3] / scales[:, None, :]
    rotations = nearest_rotations(turns)
    keys = clock.times(times)
    curves = [_core.Curve(keys, values, clock.interpolation) for values in (matrices[:, :3, 3], quaternions(rotations), scales)]
    motion = _core.CurveMotion(*curves, **clock.playback)
    return motion, bool(np.abs(turns - rotations).max() < RIGID)


def deformed(times, vertices, clock: Clock) -> _core.VertexSequence:
    """A VertexSequence of vertices [T, V, 3] in m at `times` [T] s, linear between them and held beyond."""
    keys, vertices = clock.times(times), np.asarray(vertices)
    if clock.period is None:
        keys = keys - clock.offset
        ends = (min(keys[0], 0.0) - HOLD, max(keys[-1], 0.0) + HOLD)
    else:
        ends = (min(keys[0], 0.0) - 1.0, max(keys[-1], clock.period) + 1.0)
    held = np.concatenate([vertices[:1], vertices, vertices[-1:]])
    return _core.VertexSequence(np.concatenate([ends[:1], keys, ends[1:]]), held, "linear", **_loop_of(clock))


def repeated(times, vertices, clock: Clock) -> _core.VertexSequence:
    """A VertexSequence of frames [T, V, 3] in m at `times` [T] s, cubic between them.

    A loop whose last frame is the first goes on through its seam as smoothly as elsewhere.
    """
    keys = clock.times(times)
    if clock.period is None:
        keys = keys - clock.offset
    elif np.abs(vertices[-1] - vertices[0]).max() <= CLOSED * np.ptp(vertices[0], axis=0).max():
        keys, vertices = _with_seam(keys, vertices, clock.period)
    return _core.VertexSequence(keys, vertices, **_loop_of(clock))


def _with_seam(keys, vertices, period: float) -> tuple[np.ndarray, np.ndarray]:
    """The frames of a closed loop with some of the runs before and after it."""
    count = min(SEAM_FRAMES, len(keys) - 1)
    before, after = slice(len(keys) - 1 - count, len(keys) - 1), slice(1, 1 + count)
    return (np.concatenate([keys[before] - period, keys, keys[after] + period]),
            np.concatenate([vertices[before], vertices, vertices[after]]))


def _loop_of(clock: Clock) -> dict:
    return {} if clock.period is None else clock.playback
