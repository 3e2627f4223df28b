"""Transforms and vertices sampled over time as motions of a scene: held beyond their ends, or repeated."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..actors.human.rotations import quaternions
from ..checks import refused
from .options import ReadOptions

HOLD = 1e5             # s for which the poses of the ends are held, from them and from time 0 of the scene
REPEATED = 60.0        # s after time 0 that a repeated animation lasts at least
MOST_SAMPLES = 20_000  # of a repeated animation
RIGID = 1e-6           # by which a turn may differ from one


def chosen_animation(options: ReadOptions, names: tuple[str, ...]) -> str | None:
    """The name of the animation that the options ask for, None: none. Raises ValueError for one that is not there."""
    if options.animation == "" or (options.animation is None and not names):
        return None
    if options.animation is not None and options.animation not in names:
        rule = " or ".join(f"'{name}'" for name in names) or "none, the file has no animation"
        raise refused(ValueError, "animation", rule, options.animation)
    return options.animation or names[0]


class Clock:
    """Takes samples of an animation to times of the scene.

    begin, end: of the animation in s; it is at `options.offset` at time 0. With `options.loop` it is repeated from 1 s
    before time 0 until REPEATED, as far as MOST_SAMPLES allow; else the poses of its ends are held.
    """

    def __init__(self, options: ReadOptions, begin: float, end: float):
        self._begin, self._end, self._loop, self._offset = begin, end, options.loop and end > begin, options.offset

    def spread(self, times, *samples):
        """(times [T'], samples [T', ...] of each) in scene time of samples [T, ...] at `times` [T] s, ascending."""
        times = np.asarray(times, float)
        if self._loop:
            return self._repeated(times, samples)
        ends = (min(times[0], self._offset) - HOLD, max(times[-1], self._offset) + HOLD)
        held = [np.concatenate([one[:1], one, one[-1:]]) for one in map(np.asarray, samples)]
        return np.concatenate([ends[:1], times, ends[1:]]) - self._offset, *held

    def _repeated(self, times, samples):
        period = self._end - self._begin
        first = int(np.floor((self._offset - 1.0 - self._begin) / period))
        last = int(np.ceil((self._offset + REPEATED - self._begin) / period))
        last = max(first + 2, min(last, first + max(1, MOST_SAMPLES // len(times))))
        inner = times < self._end - 1e-9 * period if times[-1] >= self._end - 1e-9 * period and len(times) > 1 else times < np.inf
        turns = np.arange(first, last)
        spread = (times[inner][None, :] + period * turns[:, None]).ravel() - self._offset
        return spread, *(np.concatenate([np.asarray(one)[inner]] * len(turns)) for one in samples)


def moved_rigidly(times, matrices, clock: Clock):
    """(placement [4, 4], KeyframeMotion or None, whether it was rigid) of transforms [T, 4, 4] at `times` [T] s.

    The placement holds the scale and the turn at first, the motion everything after it, linear between the samples. A scale
    that changes stays as it is at first.
    """
    matrices = np.asarray(matrices, float)
    if len(matrices) < 2 or np.array_equal(matrices, np.broadcast_to(matrices[0], matrices.shape)):
        return matrices[0], None, True
    turns = matrices[:, :3, :3] @ np.linalg.inv(matrices[0, :3, :3])
    rotations = _nearest_rotations(turns)
    placement = matrices[0].copy()
    placement[:3, 3] = 0.0
    spread, translations, turned = clock.spread(times, matrices[:, :3, 3], rotations)
    motion = _core.KeyframeMotion(times=spread, translations=translations, rotations=quaternions(turned),
                                  interpolation="linear")
    return placement, motion, bool(np.abs(turns - rotations).max() < RIGID)


def _nearest_rotations(turns: np.ndarray) -> np.ndarray:
    """The rotation nearest to each of matrices [T, 3, 3] (Higham 1986)."""
    left, _, right = np.linalg.svd(turns)
    flips = np.ones((len(turns), 3))
    flips[:, 2] = np.sign(np.linalg.det(left @ right))
    return left * flips[:, None, :] @ right


def deformed(times, vertices, clock: Clock) -> _core.VertexSequence:
    """A VertexSequence of vertices [T, V, 3] in m at `times` [T] s, linear between them."""
    spread, moved = clock.spread(times, vertices)
    return _core.VertexSequence(times=spread, vertices=moved, interpolation="linear")
