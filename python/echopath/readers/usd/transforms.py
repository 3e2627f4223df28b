"""Transforms of prims over time, sampled so densely that curves through the samples follow them."""
from __future__ import annotations

import numpy as np

from .stage import Timeline, matrix

STEP_DEG, STEADY_STEP_DEG = 5.0, 60.0  # that a prim may turn from sample to sample; about one axis and a place that goes straight
LEAST_DEG, LEAST_STEPS = 0.25, 4       # that is no line any more, and steps for whose curve
MOST_SAMPLES, MOST_DEG = 100_000, 1e12  # of one prim, and about as many more between them; of one turn
PROBES, PROBE, STRAIGHT = 8, 0.37, 1e-6  # intervals and place in them, where what goes straight is off the line by a share less


def sampled_transforms(xformable, time, timeline: Timeline, animated: bool) -> tuple[list[float], np.ndarray, np.ndarray | None]:
    """(time codes [T], transforms [T, 4, 4] relative to the parent, knots) of a prim; one at `time` for a prim at rest, and for
    any where nothing is animated. Of the samples of the file the first MOST_SAMPLES count.

    knots: places [K] in T between which the transform is smooth, and evenly sampled; None: it goes straight and turns steadily
    from each sample to the next
    """
    codes = timeline.usable(xformable.GetTimeSamples())
    if len(codes) < 2 or not animated:
        at = codes[0] if len(codes) == 1 else time
        return [0.0], _at(xformable, at)[None], None
    codes, ops = codes[:MOST_SAMPLES], xformable.GetOrderedXformOps()
    steps, is_smooth = _steps(xformable, ops, codes)
    fine = _between(codes, steps)
    knots = np.concatenate([[0], np.cumsum(steps)]) if is_smooth else None
    return fine, np.swapaxes([xformable.GetLocalTransformation(ops, code) for code in fine], 1, 2), knots


def _at(xformable, code) -> np.ndarray:
    return matrix(xformable.GetLocalTransformation(code))


def _steps(xformable, ops, codes: list[float]) -> tuple[np.ndarray, bool]:
    """(steps [T - 1] into which the intervals between codes are to be cut, whether curves are to be laid through them)."""
    changes = [_turns(op, codes) for op in ops if op.MightBeTimeVarying()]
    turns = np.concatenate([np.zeros((len(codes) - 1, 0)), *changes], axis=1)
    turned = np.minimum(turns.sum(axis=1), MOST_DEG)
    is_steady = np.count_nonzero(turns.any(axis=0)) < 2 and _goes_straight(xformable, codes, np.flatnonzero(turned))
    step = max(STEADY_STEP_DEG if is_steady else STEP_DEG, turned.sum() / MOST_SAMPLES)
    steps = np.maximum(1 if is_steady else LEAST_STEPS, np.ceil(turned / step)).astype(int)
    steps[turned <= LEAST_DEG] = 1
    return steps, not is_steady


def _goes_straight(xformable, codes: list[float], turning: np.ndarray) -> bool:
    """Whether the origin of a prim goes straight while it turns, as none does that turns about another place."""
    for index in turning[np.linspace(0, len(turning) - 1, min(PROBES, len(turning))).astype(int)]:
        before, after = codes[index:index + 2]
        begin, place, end = (_at(xformable, code)[:3, 3] for code in (before, before + PROBE * (after - before), after))
        if np.abs(begin + PROBE * (end - begin) - place).max() > STRAIGHT * np.abs([begin, place, end]).max():
            return False
    return True


def _between(codes: list[float], steps: np.ndarray) -> list[float]:
    """The codes with those between them."""
    found = [codes[0]]
    for before, after, count in zip(codes, codes[1:], steps):
        found += [before + (after - before) * step / count for step in range(1, count + 1)]
    return found


def _turns(op, codes: list[float]) -> np.ndarray:
    """[T - 1, K] degrees by which an operation turns between codes, about each of its axes."""
    if "orient" in op.GetOpName():
        quaternions = np.array([_quaternion(op, code) for code in codes])
        cosines = np.abs(np.sum(quaternions[1:] * quaternions[:-1], axis=1))
        return 2.0 * np.degrees(np.arccos(np.minimum(cosines, 1.0)))[:, None]
    if "rotate" in op.GetOpName():
        return np.abs(np.diff(_angles(op, codes), axis=0))
    return np.zeros((len(codes) - 1, 0))


def _quaternion(op, code) -> np.ndarray:
    """[4] of length 1; that of no turn for values that are no quaternions, of which USD makes no transform."""
    value = op.Get(code)
    if hasattr(value, "GetNormalized"):
        unit = value.GetNormalized()
        found = np.array([unit.GetReal(), *unit.GetImaginary()], float)
        if np.isfinite(found).all():
            return found
    return np.array([1.0, 0.0, 0.0, 0.0])


def _angles(op, codes: list[float]) -> np.ndarray:
    """[T, 3] degrees about the axes of a rotation, about one axis as the first; zeros for values that are no angles.

    Of those USD makes no transform, and says so.
    """
    angles = np.zeros((len(codes), 3))
    values = [op.Get(code) for code in codes]
    given = [index for index, value in enumerate(values) if value is not None]
    try:
        rows = np.nan_to_num(np.array([values[index] for index in given], float)).reshape(len(given), -1)
    except (TypeError, ValueError):
        return angles
    if 0 < rows.shape[1] <= 3:
        angles[given, :rows.shape[1]] = rows
    return angles
