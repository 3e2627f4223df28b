"""How nodes move: curves of an animation, relative to rest."""
from __future__ import annotations

import numpy as np

from ... import _core
from ...base.numerics.rotations import matrices, product
from .animations import Animation
from .nodes import Nodes

SMALLEST_VOLUME = 1e-300  # below, determinants are rounding
MOVING = ("translation", "rotation", "scale")


class Motions:
    """Placement and motion of each node under one animation, so that parent_from_node(t) is T(t) R(t) S(t) of the file."""

    def __init__(self, nodes: Nodes, animation: Animation):
        self._nodes, self._animation = nodes, animation
        self._curves = {key: curve for key, curve in animation.curves.items() if key[1] in MOVING}
        self._made: dict[int, tuple] = {}

    def of(self, node: int) -> tuple:
        """(placement [4, 4], motion or None)."""
        if node not in self._made:
            self._made[node] = self._made_of(node)
        return self._made[node]

    def moves(self, node: int) -> bool:
        """Whether it is elsewhere at another time."""
        motion = self.of(node)[1]
        return motion is not None and _changes(motion)

    def stretches(self, node: int) -> bool:
        """Whether its motion is not rigid, which only joints take: its scale is animated, or is 0."""
        motion = self.of(node)[1]
        return motion is not None and motion.scale is not None

    def _made_of(self, node: int) -> tuple:
        rest = self._nodes.rest(node)
        curves = {path: self._curve(node, path) for path in MOVING}
        if curves["scale"] is None and not _is_flat(rest):
            placement, motion = self._rigid(node, rest, curves)
        else:
            placement, motion = self._scaling(node, curves)
        if motion is None or _changes(motion):
            return placement, motion
        still = motion.at(0.0)
        still[:3, :3] = still[:3, :3] @ placement[:3, :3]
        still[:3, 3] += placement[:3, 3]
        return (placement, motion) if _is_flat(still) else (still, None)

    def _rigid(self, node: int, rest: np.ndarray, curves: dict) -> tuple:
        translation, rotation = curves["translation"], curves["rotation"]
        if translation is None and rotation is None:
            return rest, None
        place, turn, scale = self._nodes.parts(node)
        placement = np.eye(4)
        placement[:3, :3] = matrices(turn) * scale
        placement[:3, 3] = place
        if rotation is not None:
            back = turn * (1.0, -1.0, -1.0, -1.0)
            rotation = _mapped(rotation, lambda values: product(values, back), lambda tangents: product(tangents, back))
        return placement, self._motion(node, self._from(translation, place), rotation, None)

    def _scaling(self, node: int, curves: dict) -> tuple:
        """All of it is in the motion but the place: a scale may be 0, which a placement must not be."""
        place, turn, scale = self._nodes.parts(node)
        placement = np.eye(4)
        placement[:3, 3] = place
        rotation = curves["rotation"] or _core.Curve([0.0], [turn])
        scales = curves["scale"] or _core.Curve([0.0], [scale])
        return placement, self._motion(node, self._from(curves["translation"], place), rotation, scales)

    @staticmethod
    def _from(translation, place: np.ndarray):
        """The translation relative to a place."""
        if translation is None:
            return None
        return _mapped(translation, lambda values: values - place, lambda tangents: tangents)

    def _motion(self, node: int, translation, rotation, scale):
        animation = self._animation
        try:
            return _core.CurveMotion(translation, rotation, scale, period=animation.period, offset=animation.offset)
        except ValueError as error:  # keys that are no rotations
            self._nodes.item(node).fail(f"cannot be animated by '{animation.name}': {error}")

    def _curve(self, node: int, path: str):
        """In axes and units of a scene; None where it stays at rest."""
        curve = self._curves.get((node, path))
        if curve is None:
            return None
        axes = self._nodes.axes
        convert = {"translation": axes.points, "rotation": axes.quaternions, "scale": axes.turned}[path]
        if path == "rotation" and curve.interpolation != "hermite":
            lengths = np.linalg.norm(curve.values, axis=1)[:, None]
            curve = curve.replace(values=curve.values / np.where(lengths > 0.0, lengths, 1.0))
        curve = _short(_mapped(curve, convert, convert))
        rest = dict(zip(MOVING, self._nodes.parts(node), strict=True))[path]
        return None if len(curve.times) == 1 and np.array_equal(curve.values[0], rest) else curve


def _short(curve):
    """A curve that stays at one value as one key, which is no breakpoint."""
    stays = (curve.values == curve.values[0]).all()
    tangents = (curve.in_tangents, curve.out_tangents)
    if not stays or any(rows is not None and rows.any() for rows in tangents):
        return curve
    return _core.Curve(curve.times[:1], curve.values[:1], "step")


def _mapped(curve, values, tangents):
    changed = {"values": values(curve.values)}
    if curve.interpolation == "hermite":
        changed |= {"in_tangents": tangents(curve.in_tangents), "out_tangents": tangents(curve.out_tangents)}
    return curve.replace(**changed)


def _is_flat(transform: np.ndarray) -> bool:
    """Whether it takes space into a plane, which the placement of a node must not."""
    with np.errstate(all="ignore"):
        determinant = np.linalg.det(transform[:3, :3])
    return not SMALLEST_VOLUME < abs(determinant) < np.inf


def _changes(motion) -> bool:
    return any(curve is not None and len(curve.times) > 1 for curve in (motion.translation, motion.rotation, motion.scale))
