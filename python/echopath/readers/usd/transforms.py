"""Transforms of prims over time, sampled so densely that straight lines between the samples follow them."""
from __future__ import annotations

import numpy as np

from .stage import Timeline, matrix

STEP_DEG, COARSEST_DEG = 5.0, 60.0  # that a prim may turn between two samples, and where these would be more than MANY_SAMPLES
MANY_SAMPLES, MOST_SAMPLES = 5000, 100_000  # of one prim


def sampled_transforms(xformable, time, timeline: Timeline, animated: bool) -> tuple[list[float], np.ndarray]:
    """(time codes [T], transforms [T, 4, 4] relative to the parent) of a prim; one at `time` for a prim at rest, and for any
    where nothing is animated. Of samples the first MOST_SAMPLES count."""
    codes = timeline.usable(xformable.GetTimeSamples())
    if len(codes) < 2 or not animated:
        at = codes[0] if len(codes) == 1 else time
        return [0.0], matrix(xformable.GetLocalTransformation(at))[None]
    codes = _refined(xformable, codes[:MOST_SAMPLES])[:MOST_SAMPLES]
    return codes, np.stack([matrix(xformable.GetLocalTransformation(code)) for code in codes])


def _refined(xformable, codes: list[float]) -> list[float]:
    """Codes with others in between, where rotations turn by more than STEP_DEG."""
    turning = [op for op in xformable.GetOrderedXformOps() if op.MightBeTimeVarying()]
    change = sum((_turns(op, codes) for op in turning), np.zeros(len(codes) - 1))
    if not change.any():
        return codes
    fine = np.clip(np.ceil(change / STEP_DEG), 1, max(1, MANY_SAMPLES // len(codes)))
    refined = [codes[0]]
    for before, after, steps in zip(codes, codes[1:], np.maximum(fine, np.ceil(change / COARSEST_DEG))):
        steps = int(min(steps, MOST_SAMPLES))
        refined += [before + (after - before) * step / steps for step in range(1, steps + 1)]
    return refined


def _turns(op, codes: list[float]) -> np.ndarray:
    """[T - 1] degrees by which an operation turns between codes, of rotations about three axes by all of them together."""
    if "orient" in op.GetOpName():
        quaternions = np.array([_quaternion(op, code) for code in codes])
        cosines = np.abs(np.sum(quaternions[1:] * quaternions[:-1], axis=1))
        return 2.0 * np.degrees(np.arccos(np.minimum(cosines, 1.0)))
    if "rotate" in op.GetOpName():
        return np.abs(np.diff([_angles(op, code) for code in codes], axis=0)).sum(axis=1)
    return np.zeros(len(codes) - 1)


def _quaternion(op, code) -> np.ndarray:
    """[4] of length 1; that of no turn for values that are no quaternions, of which USD makes no transform."""
    value = op.Get(code)
    if hasattr(value, "GetNormalized"):
        unit = value.GetNormalized()
        found = np.array([unit.GetReal(), *unit.GetImaginary()], float)
        if np.isfinite(found).all():
            return found
    return np.array([1.0, 0.0, 0.0, 0.0])


def _angles(op, code) -> np.ndarray:
    """[3] degrees about the axes of a rotation, about one axis as the first; zeros for values that are no angles.

    Of those USD makes no transform, and says so.
    """
    angles = np.zeros(3)
    try:
        values = np.nan_to_num(np.array(op.Get(code), float)).ravel()
    except (TypeError, ValueError):
        return angles
    if len(values) <= len(angles):
        angles[:len(values)] = values
    return angles
