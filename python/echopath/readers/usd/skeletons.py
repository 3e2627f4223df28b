"""Skeletons of a USD stage: which meshes they move, as Skins, and whose blend shapes their animations move."""
from __future__ import annotations

import numpy as np

from ... import _core
from ...base.text.node_names import fit_name, unique
from ..axes import Axes
from ..sampled import Clock, moved_rigidly, moved_with_scale
from ..tree import Tree
from .blend_shapes import blend_shapes_of
from .stage import Timeline, matrix
from .surfaces import Surface


class Skeletons:
    """The meshes of a stage that are bound to skeletons: path of the mesh -> queries of both."""

    def __init__(self, stage, pxr):
        self._pxr = pxr
        self._bound: dict = {}
        self._joints: dict = {}
        cache = pxr.UsdSkel.Cache()
        predicate = pxr.Usd.TraverseInstanceProxies()
        for prim in pxr.Usd.PrimRange(stage.GetPseudoRoot(), predicate):
            if prim.IsA(pxr.UsdSkel.Root):
                root = pxr.UsdSkel.Root(prim)
                cache.Populate(root, predicate)
                for binding in cache.ComputeSkelBindings(root, predicate):
                    query = cache.GetSkelQuery(binding.GetSkeleton())
                    for skinning in binding.GetSkinningTargets():
                        if query and (skinning.HasJointInfluences() or skinning.HasBlendShapes()):
                            self._bound[skinning.GetPrim().GetPath()] = (query, skinning)

    def skeleton_of(self, prim):
        """The prim of the skeleton that moves a mesh, None for any other mesh."""
        query, skinning = self._bound.get(prim.GetPath(), (None, None))
        return query.GetPrim() if query and skinning.HasJointInfluences() else None

    def time_codes(self) -> list[float]:
        """Of all samples of all joints and blend shapes."""
        queries = filter(None, (query.GetAnimQuery() for query, _ in self._bound.values()))
        return [code for query in queries for code in (*query.GetJointTransformTimeSamples(),
                                                       *query.GetBlendShapeWeightTimeSamples())]

    def shapes_of(self, prim, surface: Surface, axes: Axes, timeline: Timeline, clock: Clock | None):
        """The MorphTargets of a mesh, None for one whose blend shapes nothing moves; raises as skin_of."""
        if prim.GetPath() not in self._bound:
            return None
        return blend_shapes_of(*self._bound[prim.GetPath()], surface, axes, timeline, clock, self._pxr)

    def skin_of(self, prim, surface: Surface, axes: Axes, timeline: Timeline, clock: Clock | None, tree: Tree) -> _core.Skin:
        """The Skin of a mesh in the frame of its skeleton.

        Raises ValueError where what the file says of it does not fit together.
        """
        query, skinning = self._bound[prim.GetPath()]
        if skinning.GetSkinningMethod() == self._pxr.UsdSkel.Tokens.dualQuaternion:
            tree.count("a skin of dual quaternions is taken as a linear one, which is narrower at joints that twist or bend")
        indices, weights = _influences(skinning, len(surface.points), list(query.GetJointOrder()))
        bind = np.array(query.GetJointWorldBindTransforms(), float).transpose(0, 2, 1)
        if not np.isfinite(bind).all() or (np.abs(np.linalg.det(bind)) < 1e-60).any():
            raise ValueError("its skeleton has bind transforms that flatten space")
        inverse_bind = axes.matrices(np.linalg.inv(bind) @ matrix(skinning.GetGeomBindTransform()))
        joints = self._moved_joints(query, axes, timeline, clock, tree)
        bound = [joint.replace(inverse_bind=one) for joint, one in zip(joints, inverse_bind)]
        kept = surface.kept
        return _core.Skin(axes.points(surface.points[kept]), bound, weights[kept], joint_indices=indices[kept],
                          shape=self.shapes_of(prim, surface, axes, timeline, clock))

    def _moved_joints(self, query, axes, timeline, clock, tree) -> list:
        """The joints of a skeleton with their motions, made once."""
        path = query.GetPrim().GetPath()
        if path not in self._joints:
            self._joints[path] = list(_joints(query, axes, timeline, clock, tree))
        return self._joints[path]


def _influences(skinning, num_points: int, order: list) -> tuple[np.ndarray, np.ndarray]:
    """(joint indices [V, K] into `order`, weights [V, K]); each row adds up to 1."""
    found = skinning.ComputeVaryingJointInfluences(num_points)
    if found is None:
        raise ValueError("it has no weights of joints that fit its points")
    per_point = skinning.GetNumInfluencesPerComponent()
    indices, weights = (np.array(values) for values in found)
    if per_point < 1 or len(indices) != num_points * per_point or len(weights) != len(indices):
        raise ValueError(f"it has {len(weights)} weights of joints for {num_points} points")
    own = skinning.GetJointOrder()
    names = list(own) if own else order
    place = {name: index for index, name in enumerate(order)}
    indices, weights = indices.astype(np.int64), np.nan_to_num(np.maximum(weights.astype(float), 0.0), posinf=0.0)
    if indices.min(initial=0) < 0 or indices.max(initial=0) >= len(names):
        raise ValueError(f"it names the joint {indices.max()}, where there are {len(names)}")
    indices = np.array([place.get(name, 0) for name in names])[indices].reshape(num_points, per_point)
    weights = weights.reshape(num_points, per_point)
    weights[weights.sum(axis=1) <= 0.0, 0] = 1.0
    return indices, weights / weights.sum(axis=1, keepdims=True)


def _joints(query, axes: Axes, timeline: Timeline, clock: Clock | None, tree: Tree):
    """ep.Joint of each joint, parents first, moving where there is an animation."""
    codes, local = _local_transforms(query, clock is not None, timeline)
    topology, names = query.GetTopology(), _names(query.GetJointOrder())
    for index, name in enumerate(names):
        parent = topology.GetParent(index)
        if parent >= index:
            raise ValueError("its joints must stand behind their parents")
        moved = axes.matrices(local[:, index])
        if not np.isfinite(moved).all() or (np.abs(np.linalg.det(moved[:, :3, :3])) < 1e-60).any():
            raise ValueError(f"its joint '{name}' flattens space, or is not finite")
        placement, motion = _moved(timeline.seconds(codes), moved, clock, tree) if clock else (moved[0], None)
        yield _core.Joint(name, names[parent] if parent >= 0 else None, transform=placement, motion=motion)


def _moved(times, moved: np.ndarray, clock: Clock, tree: Tree) -> tuple:
    """(placement [4, 4], motion or None) of a joint: where its scale changes, all of it is in the motion."""
    placement, motion, is_rigid = moved_rigidly(times, moved, clock)
    if is_rigid:
        return placement, motion
    motion, is_whole = moved_with_scale(times, moved, clock)
    if not is_whole:
        tree.count("the shear of a joint is left out")
    return np.eye(4), motion


def _local_transforms(query, animated: bool, timeline: Timeline) -> tuple[list, np.ndarray]:
    """(time codes [T], transforms [T, J, 4, 4] relative to the parents)."""
    animation = query.GetAnimQuery() if animated else None
    codes = list(animation.GetJointTransformTimeSamples()) if animation else []
    codes = timeline.usable(codes) or [0.0]
    local = [query.ComputeJointLocalTransforms(code, atRest=not animation) for code in codes]
    if any(one is None or not len(one) for one in local):
        raise ValueError("its skeleton has no pose")
    return codes, np.array([np.array(one, float) for one in local]).transpose(0, 1, 3, 2)


def _names(order) -> list[str]:
    """The last words of the joints' paths, each once."""
    taken: dict[str, int] = {}
    return [unique(fit_name(str(path).rsplit("/", 1)[-1], "joint"), taken) for path in order]
