"""Puts the prims of a USD stage into a tree."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ... import _core
from ..axes import Axes
from ..sampled import Clock, deformed, moved_rigidly
from ..tree import MAX_NODES, Tree
from .skeletons import Skeletons
from .stage import Timeline, changes_points, changes_visibility, is_left_out
from .surfaces import SOLIDS, BadMesh, Surface, changes_size, integers, is_subdivided, numbers, surface_of
from .transforms import MOST_SAMPLES, sampled_transforms

NO_NODES = ("Material", "Shader", "NodeGraph")  # types of prims without surfaces below them: others name what is there
MAX_DEPTH = 200         # of instances within instances
MAX_VALUES = 500_000_000  # coordinates of one mesh over all its samples


class Content:
    """The prims of a stage; meshes of instances are made once."""

    def __init__(self, path: Path, stage, tree: Tree, axes: Axes, timeline: Timeline, pxr):
        self._path, self._stage, self._tree, self._axes = path, stage, tree, axes
        self._timeline, self._pxr = timeline, pxr
        self._time = timeline.start
        self._clock: Clock | None = None
        self._skeletons = Skeletons(stage, pxr)
        self._surfaces: dict = {}
        self._index_of: dict = {}    # path -> node
        self._skinned: list = []     # meshes that hang on skeletons, added when these are there
        self._waiting: list = []     # (prim, node of its parent, instances around it)

    def time_codes(self) -> list[float]:
        """Of all samples of transforms, points, instances and joints, ascending."""
        codes = set(self._skeletons.time_codes())
        for prim in self._pxr.Usd.PrimRange(self._stage.GetPseudoRoot(), self._pxr.Usd.TraverseInstanceProxies()):
            if prim.IsA(self._pxr.UsdGeom.Xformable):
                codes |= set(self._pxr.UsdGeom.Xformable(prim).GetTimeSamples()[:MOST_SAMPLES])
            if prim.IsA(self._pxr.UsdGeom.Mesh):
                codes |= set(self._pxr.UsdGeom.Mesh(prim).GetPointsAttr().GetTimeSamples()[:MOST_SAMPLES])
            if prim.IsA(self._pxr.UsdGeom.PointInstancer):
                codes |= set(_codes_of_instances(self._pxr.UsdGeom.PointInstancer(prim))[:MOST_SAMPLES])
        return self._timeline.usable(codes)

    def add_all(self, clock: Clock | None) -> None:
        """Adds everything; clock None: at rest."""
        self._clock = clock
        self._waiting = [(prim, -1, 0) for prim in reversed(self._children(self._stage.GetPseudoRoot()))]
        while self._waiting:
            prim, parent, depth = self._waiting.pop()
            self._add(prim, parent, depth)
        for prim, surface, parent in self._skinned:
            self._add_skinned(prim, surface, parent)

    def _children(self, prim) -> list:
        return list(prim.GetFilteredChildren(self._pxr.Usd.TraverseInstanceProxies()))

    def _add(self, prim, parent: int, depth: int) -> None:
        if changes_visibility(prim, self._pxr.UsdGeom):
            self._tree.count("the visibility of a prim changes over time: it stays as it is at first")
        reason = is_left_out(prim, self._time, self._pxr.UsdGeom)
        if reason:
            self._tree.count(reason)
            return
        if len(self._tree.nodes) > MAX_NODES or depth > MAX_DEPTH:
            raise _core.FileError(f"{self._path}: has more than {MAX_NODES} prims, or {MAX_DEPTH} instances in each other")
        if prim.IsA(self._pxr.UsdGeom.Xformable):
            placed = self._placed(prim)
            if placed is None:
                return
            if self._pxr.UsdGeom.Xformable(prim).GetResetXformStack():
                parent = -1
            placement, motion = placed
            parent = self._add_prim(prim, parent, placement, motion)
            self._index_of[prim.GetPath()] = parent
        elif prim.GetTypeName() not in NO_NODES:
            parent = self._tree.add(prim.GetName(), parent)
        if prim.IsA(self._pxr.UsdGeom.PointInstancer):
            self._add_instances(prim, parent, depth)
        else:
            self._waiting += [(child, parent, depth) for child in reversed(self._children(prim))]

    def _placed(self, prim):
        """(placement, motion or None) of a prim; None, counted, where it flattens space."""
        xformable, animated = self._pxr.UsdGeom.Xformable(prim), self._clock is not None
        codes, matrices, knots = sampled_transforms(xformable, self._time, self._timeline, animated)
        if animated and len(xformable.GetTimeSamples()) > MOST_SAMPLES:
            self._tree.count(f"a prim of more than {MOST_SAMPLES} samples stays where the last of so many has it")
        matrices = self._axes.matrices(matrices)
        if not np.isfinite(matrices).all() or np.abs(matrices).max() > 1e60 or (np.linalg.det(matrices[:, :3, :3]) == 0.0).any():
            self._tree.count("a prim whose transform flattens it, or is not finite, is left out")
            return None
        return self._moved(codes, matrices, knots)

    def _moved(self, codes, matrices, knots=None):
        if self._clock is None:
            return matrices[0], None
        placement, motion, is_rigid = moved_rigidly(self._timeline.seconds(codes), matrices, self._clock, knots)
        if not is_rigid:
            self._tree.count("the changing scale of a prim is left out")
        return placement, motion

    def _add_prim(self, prim, parent: int, placement, motion) -> int:
        """The node of a prim, with its meshes; returns its index."""
        surface = self._surface(prim)
        name = prim.GetName()
        if surface is None or self._skeletons.skeleton_of(prim) is not None:
            if surface is not None:
                self._skinned.append((prim, surface, parent))
            return self._tree.add(name, parent, placement=placement, motion=motion)
        if prim.GetTypeName() in SOLIDS and changes_size(prim):
            self._tree.count("the size of a solid changes over time: it stays as it is at first")
        deformation = self._deformation(prim, surface)
        if deformation is not None and surface.num_flat:
            self._tree.count("faces without area in the first frame are left out of all frames")
        if len(surface.parts) == 1 and deformation is None:
            _, material, mesh = surface.parts[0]
            return self._tree.add(name, parent, placement=placement, motion=motion, mesh=mesh, foreign_material=material,
                                  smooth=surface.smooth)
        index = self._tree.add(name, parent, placement=placement, motion=motion)
        self._add_parts(surface, index, deformation, surface.smooth)
        return index

    def _add_parts(self, surface: Surface, parent: int, deformation, smooth: bool, name: str = "surface") -> None:
        for own, material, mesh in surface.parts:
            self._tree.add(own or (name if len(surface.parts) == 1 else "rest"), parent, mesh=mesh, deformation=deformation,
                           foreign_material=material, smooth=smooth)

    def _surface(self, prim) -> Surface | None:
        """The surface of a prim, None for one without; instances share meshes, each has its own materials."""
        if not (prim.IsA(self._pxr.UsdGeom.Mesh) or prim.GetTypeName() in SOLIDS):
            if prim.IsA(self._pxr.UsdGeom.Gprim):
                self._tree.count(f"a prim of the type {prim.GetTypeName()} is left out")
            return None
        own = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        if own.GetPath() not in self._surfaces:
            try:
                self._surfaces[own.GetPath()] = surface_of(prim, self._time, self._axes, self._pxr)
                if prim.IsA(self._pxr.UsdGeom.Mesh) and is_subdivided(self._pxr.UsdGeom.Mesh(prim)):
                    self._tree.count("a subdivision surface is taken as its control cage, smoothed")
            except BadMesh as error:
                self._tree.note(f"the mesh {prim.GetPath()} is left out: it {error}")
                self._surfaces[own.GetPath()] = None
        surface = self._surfaces[own.GetPath()]
        return surface if surface is None or own == prim else surface.of(prim, self._pxr)

    def _deformation(self, prim, surface: Surface):
        """A VertexSequence of points that change over time, or MorphTargets; None for others."""
        attribute = self._pxr.UsdGeom.Mesh(prim).GetPointsAttr() if prim.IsA(self._pxr.UsdGeom.Mesh) else None
        codes = attribute.GetTimeSamples() if attribute and self._clock is not None else []
        codes = self._timeline.usable(codes)
        if len(codes) < 2:
            return self._shapes(prim, surface)
        if len(codes) * surface.points.size > MAX_VALUES:
            raise _core.FileError(f"{self._path}: the points of {prim.GetPath()} have more than {MAX_VALUES} values over time")
        try:
            frames = [numbers(attribute.Get(code), (-1, 3)) for code in codes]
        except BadMesh:
            frames = []
        if not frames or any(frame.shape != surface.points.shape for frame in frames):
            self._tree.count("a mesh whose points change in number over time, or are no points, stays as it is at first")
            return None
        vertices = self._axes.points(np.stack(frames)[:, surface.kept])
        if self._clock.steps:
            self._tree.count("the points of a mesh move on straight lines, where the stage has them jump")
        return deformed(self._timeline.seconds(codes), vertices, self._clock)

    def _shapes(self, prim, surface: Surface):
        """The MorphTargets of a mesh; None, noted, for blend shapes that do not fit it."""
        try:
            return self._skeletons.shapes_of(prim, surface, self._axes, self._timeline, self._clock)
        except ValueError as error:
            self._tree.note(f"the mesh {prim.GetPath()} keeps its shape: {error}")
            return None

    def _add_skinned(self, prim, surface: Surface, parent: int) -> None:
        """A mesh below its skeleton, whose frame its points are in once they are bound."""
        skeleton = self._skeletons.skeleton_of(prim)
        try:
            skin = self._skeletons.skin_of(prim, surface, self._axes, self._timeline, self._clock, self._tree)
        except ValueError as error:
            self._tree.note(f"the mesh {prim.GetPath()} does not move with its skeleton: {error}")
            self._add_parts(surface, self._index_of.get(prim.GetPath(), parent), None, surface.smooth, prim.GetName())
            return
        if self._clock is not None and surface.num_flat:
            self._tree.count("faces of skinned meshes without area at rest are left out of all frames")
        self._add_parts(surface, self._index_of.get(skeleton.GetPath(), parent), skin, surface.smooth, prim.GetName())

    def _add_instances(self, prim, parent: int, depth: int) -> None:
        """The instances of a point instancer, each a node with its prototype below it."""
        instancer = self._pxr.UsdGeom.PointInstancer(prim)
        prototypes = [self._stage.GetPrimAtPath(path) for path in instancer.GetPrototypesRel().GetForwardedTargets()]
        try:
            which = integers(instancer.GetProtoIndicesAttr(), self._time)
        except BadMesh as error:
            self._tree.note(f"the point instancer {prim.GetPath()} is left out: it {error}")
            return
        codes, transforms = self._instance_transforms(instancer, len(which))
        if transforms is None:
            self._tree.note(f"the point instancer {prim.GetPath()} is left out: its arrays do not fit together")
            return
        if changes_points(instancer):
            self._tree.count("the prototypes, the ids or the mask of a point instancer change over time: they stay as at first")
        mask = instancer.ComputeMaskAtTime(self._time) or [True] * len(which)
        instances = []
        for number, index in enumerate(which):
            kept = mask[number] and 0 <= index < len(prototypes) and prototypes[index]
            if not kept or (np.linalg.det(transforms[:, number, :3, :3]) == 0.0).any():
                self._tree.count("a point that is masked, or without a prototype or extent, is left out")
                continue
            placement, motion = self._moved(codes, transforms[:, number])
            node = self._tree.add(f"{prototypes[index].GetName()}_{number}", parent, placement=placement, motion=motion)
            instances.append((prototypes[index], node, depth + 1))
        self._waiting += reversed(instances)

    def _instance_transforms(self, instancer, count: int):
        """(time codes [T], transforms [T, N, 4, 4] without those of the prototypes, None where something is wrong)."""
        codes = self._timeline.usable(_codes_of_instances(instancer))
        codes = codes if len(codes) > 1 and self._clock is not None else [self._time]
        if 16 * len(codes) * count > MAX_VALUES:
            raise _core.FileError(f"{self._path}: {instancer.GetPath()} has more than {MAX_VALUES} values over time")
        found = []
        for code in codes:
            values = instancer.ComputeInstanceTransformsAtTime(code, code, self._pxr.UsdGeom.PointInstancer.ExcludeProtoXform,
                                                               self._pxr.UsdGeom.PointInstancer.IgnoreMask)
            array = np.array(values if values is not None else [], float)
            if array.shape != (count, 4, 4) or not np.isfinite(array).all():
                return codes, None
            found.append(self._axes.matrices(array.transpose(0, 2, 1)))
        return codes, np.stack(found)


def _codes_of_instances(instancer) -> list[float]:
    """Time codes of the samples of a point instancer."""
    attributes = (instancer.GetPositionsAttr(), instancer.GetOrientationsAttr(), instancer.GetScalesAttr())
    return [code for attribute in attributes for code in attribute.GetTimeSamples()]
