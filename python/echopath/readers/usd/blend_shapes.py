"""Blend shapes of a USD mesh as MorphTargets, with the shares that the library of USD computes of their weights."""
from __future__ import annotations

import numpy as np

from ... import _core
from ..axes import Axes
from ..sampled import Clock
from .stage import Timeline
from .surfaces import Surface

MAX_VALUES = 500_000_000  # coordinates of all shapes of one mesh


def blend_shapes_of(query, skinning, surface: Surface, axes: Axes, timeline: Timeline, clock: Clock | None, pxr):
    """MorphTargets of a mesh whose skeleton's animation moves blend shapes, None for any other mesh and at rest.

    Shapes in between, which stand for certain weights, are targets of their own: a weight shares itself out among the two next
    to it. Raises ValueError for arrays that do not fit together.
    """
    animation = query.GetAnimQuery() if clock is not None and skinning.HasBlendShapes() else None
    mapper = skinning.GetBlendShapeMapper()
    if not animation or not animation.GetBlendShapeOrder() or not mapper:
        return None
    shapes = pxr.UsdSkel.BlendShapeQuery(pxr.UsdSkel.BindingAPI(skinning.GetPrim()))
    weights = _Weights(animation, mapper, shapes)
    codes = weights.with_turns(timeline.usable(animation.GetBlendShapeWeightTimeSamples()) or [timeline.start])
    shares = np.array([weights.shares(code) for code in codes])
    if not np.isfinite(shares).all() or np.abs(shares).max(initial=0.0) > 1e6:
        raise ValueError("its blend shapes have weights that are not finite, or beyond 1e6")
    kept = np.flatnonzero(shares.any(axis=0))
    if not len(kept):
        return None
    if len(kept) * surface.points.size > MAX_VALUES:
        raise ValueError(f"its blend shapes have more than {MAX_VALUES} values")
    targets = axes.points(_targets(shapes, kept, len(surface.points))[:, surface.kept])
    curve = _core.Curve(clock.times(timeline.seconds(codes)), shares[:, kept], clock.interpolation)
    return _core.MorphTargets(axes.points(surface.points[surface.kept]), targets, curve, **clock.playback)


class _Weights:
    """The weights of blend shapes over time, and the shares of their shapes that they stand for."""

    def __init__(self, animation, mapper, shapes):
        self._animation, self._mapper, self._shapes = animation, mapper, shapes

    def _of_shapes(self, code: float):
        """In the order of the mesh; 0 where the animation has none of that name."""
        found = self._animation.ComputeBlendShapeWeights(code)
        weights = self._mapper.Remap(found) if found is not None else None
        if weights is None or len(weights) != self._shapes.GetNumBlendShapes():
            raise ValueError("its blend shapes have not as many weights as there are shapes")
        return weights

    def shares(self, code: float) -> np.ndarray:
        """[K] of all shapes, those in between too."""
        shares = np.zeros(self._shapes.GetNumSubShapes())
        found = self._shapes.ComputeSubShapeWeights(self._of_shapes(code))
        if found is None:
            raise ValueError("its blend shapes have weights that cannot be shared out")
        values, _, shapes = found
        places = np.array(shapes, int)
        if places.size and not 0 <= places.min() <= places.max() < len(shares):
            raise ValueError(f"its blend shapes name the shape {places.max()}, where there are {len(shares)}")
        np.add.at(shares, places, np.array(values, float))
        return shares

    def with_turns(self, codes: list[float]) -> list[float]:
        """The codes, with those between them at which a weight passes that of a shape: there its shares turn."""
        knots = self._knots()
        if not knots or len(codes) < 2:
            return codes
        weights = np.array([self._of_shapes(code) for code in codes], float)
        found = set(codes)
        for column, values in knots.items():
            for at in values:
                before, after = weights[:-1, column] - at, weights[1:, column] - at
                for piece in np.flatnonzero(before * after < 0.0):
                    share = before[piece] / (before[piece] - after[piece])
                    found.add(codes[piece] + share * (codes[piece + 1] - codes[piece]))
        return sorted(found)

    def _knots(self) -> dict[int, list[float]]:
        """{blend shape: weights at which its shares turn} of those with shapes in between."""
        knots: dict[int, list[float]] = {}
        for shape in range(self._shapes.GetNumSubShapes()):
            between = self._shapes.GetInbetween(shape)
            weight = between.GetWeight() if between else None
            if weight is not None:
                knots.setdefault(self._shapes.GetBlendShapeIndex(shape), [0.0]).append(float(weight))
        return knots


def _targets(shapes, kept, num_points: int) -> np.ndarray:
    """Displacements [K, V, 3] in units of the file of the shapes `kept`."""
    offsets, indices = shapes.ComputeSubShapePointOffsets(), shapes.ComputeBlendShapePointIndices()
    targets = np.zeros((len(kept), num_points, 3))
    for target, shape in zip(targets, kept):
        moved = np.array(offsets[shape], float).reshape(-1, 3)
        places = np.array(indices[shapes.GetBlendShapeIndex(int(shape))], np.int64)
        places = places if len(places) else np.arange(num_points)
        if not len(moved):
            continue  # the shape that nothing moves, or one without offsets
        if len(moved) != len(places) or places.min() < 0 or places.max() >= num_points:
            raise ValueError(f"its blend shapes have {len(moved)} offsets for {len(places)} of {num_points} points")
        if not np.isfinite(moved).all() or np.abs(moved).max() > 1e60:
            raise ValueError("its blend shapes have offsets that are not finite")
        target[places] = moved
    return targets
