"""Oriented boxes about objects of a scene at a time, and how they move."""
from __future__ import annotations

import posixpath
from typing import NamedTuple

import numpy as np

from .. import _core
from ..base.numerics.placements import parent_from_node
from ..base.numerics.rates import rate_of, step_within
from ..base.numerics.rotations import angular_velocity

_SCALE = 1e-12  # of the squares of scales, by which rounding changes these


class Boxes(NamedTuple):
    """The boxes of N objects, in world axes.

    centre: [N, 3] m; size: [N, 3] m along the box's own axes; rotation: [N, 3, 3], world_from_box
    velocity: [N, 3] m/s; angular_velocity: [N, 3] rad/s; origin: [N, 3] m, the objects' own origins, which go with their bodies
    """

    centre: np.ndarray
    size: np.ndarray
    rotation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    origin: np.ndarray


def boxes_at(scene, globs_of_objects, time: float, duration: float) -> Boxes:
    """The Boxes of objects at `time` in s.

    globs_of_objects: list [N] of lists of globs; duration: s, of the frame about that time, which differences stay within
    """
    named = _NamedScene(scene)
    rows = [_Body(named, globs).box(time, step_within(duration)) for globs in globs_of_objects]
    columns = zip(*rows) if rows else [[]] * len(Boxes._fields)
    shapes = {"rotation": (-1, 3, 3)}
    return Boxes(*(np.array(column, float).reshape(shapes.get(name, (-1, 3))) for name, column in zip(Boxes._fields, columns)))


class _NamedScene:
    """A scene whose nodes and meshes are listed once for all of its objects: many that each look through all are slow."""

    def __init__(self, scene):
        self.scene, self.nodes, self._meshes = scene, scene.nodes, scene.meshes
        self._node_of = {node.name: index for index, node in enumerate(self.nodes)}
        self._below: dict[str, list] = {}
        for mesh in self._meshes:
            steps = mesh.name.split("/")
            for count in range(1, len(steps) + 1):
                self._below.setdefault("/".join(steps[:count]), []).append(mesh)

    def meshes(self, globs) -> list:
        """The meshes that globs take, in the order of the scene."""
        if len(globs) == 1 and not set(globs[0]) & set("*?"):
            return self._below.get(globs[0], [])
        return [mesh for mesh in self._meshes if any(_core.glob_takes(glob, mesh.name) for glob in globs)]

    def common_node(self, globs, meshes) -> int:
        """Index of the node that a single name means, or the lowest that all meshes are at or below; -1: none."""
        if len(globs) == 1 and globs[0] in self._node_of:
            return self._node_of[globs[0]]
        name = posixpath.commonpath([mesh.name for mesh in meshes]) if meshes else ""
        return self._node_of.get(name, -1)


class _Body:
    """The meshes of one object and the node whose axes its box has."""

    def __init__(self, named: _NamedScene, globs):
        self._scene, self._nodes, self._meshes = named.scene, named.nodes, named.meshes(globs)
        self._mesh_ids = [mesh.id for mesh in self._meshes]
        self._node = named.common_node(globs, self._meshes)
        self._shared = self._shared_motion()

    def box(self, time: float, step: float) -> tuple:
        """One row of Boxes."""
        frame = self._frame(time)
        rotation, origin = frame[:3, :3], frame[:3, 3]
        own = (self._vertices(time) - origin) @ rotation
        low, high = own.min(axis=0), own.max(axis=0)
        centre = 0.5 * (low + high)
        rate = rate_of(self._frame, time, step)
        velocity, gone = rate[:3, 3] + rate[:3, :3] @ centre, np.zeros(3)
        is_rigid = self._is_rigid()
        if not is_rigid or self._is_stretched_anew(time, step):
            velocity = velocity + rotation @ rate_of(self._own_centroid, time, step)
        if not is_rigid and (self._node < 0 or self._nodes[self._node].motion is None):  # what carries itself along
            gone = rotation @ (self._own_centroid(time) - self._own_centroid(self._reference_time()))
        spin = angular_velocity(rotation, rate[:3, :3])
        return origin + rotation @ centre, high - low, rotation, velocity, spin, origin + gone

    def _frame(self, time: float):
        """World from the object's node [4, 4] without its scale, and from where the motion of all its meshes has brought that;
        the world itself for objects that share no node. What is mirrored looks ahead and up as it does, and left is the other
        side."""
        transform = self._scaled_frame(time)
        left, _, right = np.linalg.svd(transform[:3, :3])
        nearest = left @ right
        transform[:3, :3] = nearest if np.linalg.det(nearest) > 0.0 else nearest * [1.0, -1.0, 1.0]
        return transform

    def _scaled_frame(self, time: float):
        """Likewise with its scale, [4, 4]."""
        transform = np.eye(4) if self._shared is None else _moved(self._shared, time)
        index = self._node
        while index >= 0:
            node = self._nodes[index]
            transform = parent_from_node(node, time) @ transform
            index = node.parent
        return transform

    def _is_stretched_anew(self, time: float, step: float) -> bool:
        """Whether the scale changes, as that of a limb does which turns below a body that is scaled along one axis alone."""
        before, after = (self._scaled_frame(time + late)[:3, :3] for late in (-step, step))
        return not np.allclose(before.T @ before, after.T @ after, rtol=0.0, atol=_SCALE * np.sum(before**2))

    def _own_centroid(self, time: float):
        """Centroid of the surface, [3] in m, in the axes of the box; of one scaled to nothing the mean of its vertices."""
        frame = self._frame(time)
        centroid = _core.surface_centroid(self._scene, self._mesh_ids, time)
        if not np.isfinite(centroid).all():
            centroid = self._vertices(time).mean(axis=0)
        return (centroid - frame[:3, 3]) @ frame[:3, :3]

    def _vertices(self, time: float) -> np.ndarray:
        """[V, 3] in m, world."""
        return np.concatenate([self._scene.world_vertices(mesh.id, time) for mesh in self._meshes])

    def _reference_time(self) -> float:
        """Time 0, or the nearest at which all that moves and deforms the meshes is defined, s."""
        first, last = -np.inf, np.inf
        for mesh in self._meshes:
            index = mesh.node
            while index >= 0:
                for change in (self._nodes[index].motion, self._nodes[index].deformation):
                    if change is not None:
                        first, last = max(first, change.span[0]), min(last, change.span[1])
                index = self._nodes[index].parent
        return float(np.clip(0.0, first, last))

    def _shared_motion(self):
        """The node of one mesh, where all meshes are placed and moved as it is right below the object's node, as those of a
        trailer are that turns at its hitch; None: there is no such motion."""
        own = [self._nodes[mesh.node] for mesh in self._meshes if mesh.node != self._node]
        if self._node < 0 or len(own) < len(self._meshes) or own[0].motion is None:
            return None
        groups = [self._nodes[index] for mesh in self._meshes for index in self._above(mesh)]
        if any(group.motion is not None or not np.array_equal(group.placement, np.eye(4)) for group in groups):
            return None
        are_alike = all(node.deformation is None and node.motion == own[0].motion
                        and np.array_equal(node.placement, own[0].placement) for node in own)
        return own[0] if are_alike else None

    def _above(self, mesh):
        """Indices of the nodes between that of a mesh and the object's."""
        index = self._nodes[mesh.node].parent
        while index not in (self._node, -1):
            yield index
            index = self._nodes[index].parent

    def _is_rigid(self) -> bool:
        """Whether nothing between its axes and its meshes moves or deforms by itself."""
        for mesh in self._meshes if self._shared is None else []:
            index = mesh.node
            if self._nodes[index].deformation is not None:
                return False
            while index not in (self._node, -1):
                if self._nodes[index].motion is not None:
                    return False
                index = self._nodes[index].parent
        return True


def _moved(node, time: float):
    """[4, 4], what the motion of a node makes of the axes of its parent about the place of the node."""
    moved = np.array(node.motion.at(time))
    moved[:3, 3] += node.placement[:3, 3]
    return moved
