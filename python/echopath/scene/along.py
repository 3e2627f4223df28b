"""Animated models along trajectories: a loop of the animation is played over the way that it is made for."""
from __future__ import annotations

import dataclasses
import math

import numpy as np

from .. import _core
from ..arguments.checks import refused
from ..base.classes.made_once import MadeOnce
from ..readers.loops import JUMPS, all_moving, poses_of_loop
from ..readers.model import Model
from ..readers.played import PlayedCurve

SAMPLES = 48          # poses of a loop, in which the way of the feet is measured
ON_GROUND = 0.02      # of the height, within which points of the lowest ones are on the ground
LEAST_WAY = 0.05      # of the height, in a loop
MOST_APART = 0.2      # of the way that an animation goes ahead, by which points of the last pose are elsewhere than in the first
TURNED = 1e-3         # rad, by which a model may look elsewhere than it goes


def model_along(model: Model, trajectory, way: float | None) -> Model:
    """What Model.along returns."""
    period = _period_of(model)
    found, direction = _way_of(model, period)
    if way is None:
        way = found
    if way is None:
        raise ValueError("way: must be given, in m of a loop, for a model whose animation neither goes ahead nor has feet that "
                         "stand, got None")
    player = _Player(trajectory, period, way)
    nodes = [dataclasses.replace(node, motion=player.motion(node.motion), deformation=player.deformation(node.deformation))
             for node in model.nodes]
    goes_on = not any(curve.interpolation == "step" for curve in _curves_of(model))  # a gap is spread over the loop
    notes = [note for note in model.notes if not (goes_on and note.startswith(JUMPS))]
    notes.append(f"its animation of {period:g} s is played once in {way:.3g} m of the trajectory")
    played = dataclasses.replace(model, nodes=tuple(nodes), motion=trajectory, notes=tuple(notes))
    return played.placed(yaw=-direction) if abs(direction) > TURNED else played


def _period_of(model: Model) -> float:
    """s, of the loop that all moving nodes share. Raises ValueError for models that are not looped or move otherwise."""
    for node in model.nodes:
        for moving in (node.motion, node.deformation):
            if not isinstance(moving, (type(None), _core.CurveMotion, _core.Skin, _core.MorphTargets)):
                rule = "animated by curves (glTF, USD) to go along a trajectory"
                raise refused(ValueError, "model", rule, type(moving).__name__)
    periods = {moving.period for moving in all_moving(model)}
    if len(periods) != 1 or None in periods:
        raise ValueError("model: must have a looped animation (load_model(..., loop=True)) to go along a trajectory, "
                         f"got {model.animation!r}")
    return float(periods.pop())


def _curves_of(model: Model):
    """The curves by which what moves in it follows the clock."""
    for moving in all_moving(model):
        for name in ("translation", "rotation", "scale", "weights"):
            if (curve := getattr(moving, name, None)) is not None:
                yield curve


class _Player:
    """Motions as they are along a Trajectory; what nodes share is made once."""

    def __init__(self, trajectory, period: float, way: float):
        self._trajectory, self._period, self._way = trajectory, period, way
        self._made = MadeOnce()

    def motion(self, motion):
        return None if motion is None else self._made.of(motion, self._motion)

    def deformation(self, deformation):
        return None if deformation is None else self._made.of(deformation, self._deformation)

    def _motion(self, motion):
        return _core.CurveMotion(self._curve(motion.translation), self._curve(motion.rotation, True), self._curve(motion.scale))

    def _deformation(self, deformation):
        if isinstance(deformation, _core.MorphTargets):
            return _core.MorphTargets(deformation.vertices, deformation.targets, self._curve(deformation.weights))
        joints = [joint.replace(motion=self.motion(joint.motion)) for joint in deformation.joints]
        return deformation.replace(joints=joints, shape=self.deformation(deformation.shape))

    def _curve(self, curve, is_rotation: bool = False):
        """A loop begins with its first pose where the trajectory begins, whatever its offset."""
        if curve is None:
            return None
        return PlayedCurve(curve, self._period, is_rotation).along(self._trajectory, self._way)


def _way_of(model: Model, period: float) -> tuple[float | None, float]:
    """(m that a loop goes, None where nothing tells; the direction in rad in which it goes, in the model's axes)."""
    poses = poses_of_loop(model, period, SAMPLES)
    moved = (poses[-1] - poses[0])[:, :2]
    drift, height = moved.mean(axis=0), float(np.ptp(poses[..., 2]))
    gone, apart = float(np.linalg.norm(drift)), float(np.sqrt(np.mean(np.sum((moved - drift) ** 2, axis=1))))
    if gone >= LEAST_WAY * height and apart < MOST_APART * gone:
        return gone, math.atan2(drift[1], drift[0])
    is_down = poses[..., 2] < poses[..., 2].min() + ON_GROUND * height
    both = is_down[1:] & is_down[:-1]
    steps = [np.median(after[stays, :2] - before[stays, :2], axis=0) for before, after, stays in zip(poses, poses[1:], both)
             if stays.any()]
    ahead = -np.median(steps, axis=0) * SAMPLES if steps else np.zeros(2)
    way = float(np.linalg.norm(ahead))
    return (way, math.atan2(ahead[1], ahead[0])) if way >= LEAST_WAY * height else (None, 0.0)
