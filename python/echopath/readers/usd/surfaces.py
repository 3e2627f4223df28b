"""Meshes and simple solids of a USD stage, split by the materials of their faces."""
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from ... import _core
from .. import forms
from ..axes import Axes
from ..normals import welded_corners

SOLIDS = ("Cube", "Sphere", "Cylinder", "Cylinder_1", "Cone", "Capsule", "Capsule_1", "Plane")
SIZES = ("size", "radius", "radiusBottom", "radiusTop", "height", "width", "length")
CURVED = ("Sphere", "Cylinder", "Cylinder_1", "Cone", "Capsule", "Capsule_1")
NON_VISUAL = "omni:simready:nonvisual:base"  # what Isaac Sim says of a material for its radars and lidars


@dataclass
class Surface:
    """points [V, 3] in units of the file; parts: (name, name of the material, Mesh in m); smooth as of ModelNode.

    kept: [W] points of which the meshes have their vertices, some of them twice, where normals say that there is an edge
    num_flat: triangles without area, which are in none of the parts
    """

    points: np.ndarray
    kept: np.ndarray
    parts: list = field(default_factory=list)
    smooth: bool = False
    num_flat: int = 0

    def of(self, instance, pxr) -> Surface:
        """That of an instance of the prim, whose materials may be bound above it, outside of what the instances share."""
        parts = [(name, material_name(instance.GetChild(name) if name else instance, pxr), mesh) for name, _, mesh in self.parts]
        return replace(self, parts=parts)


class BadMesh(ValueError):
    """A mesh whose arrays do not fit together; the text says how."""


def surface_of(prim, time, axes: Axes, pxr) -> Surface:
    """The Surface of a mesh or solid. Raises BadMesh."""
    if prim.GetTypeName() in SOLIDS:
        points, triangles = _solid(prim, time)
        surface = Surface(points, np.arange(len(points)), smooth=prim.GetTypeName() in CURVED)
        return _with_parts(surface, axes, np.asarray(triangles), np.arange(len(triangles)), [("", prim, None)], pxr)
    mesh = pxr.UsdGeom.Mesh(prim)
    points, corners, counts = (numbers(attribute.Get(time), shape) for attribute, shape in (
        (mesh.GetPointsAttr(), (-1, 3)), (mesh.GetFaceVertexIndicesAttr(), (-1,)), (mesh.GetFaceVertexCountsAttr(), (-1,))))
    holes = integers(mesh.GetHoleIndicesAttr(), time)
    polygons = _polygons(points, corners.astype(np.int64), counts.astype(np.int64), holes)
    triangles, polygon, places = _core.triangles_of_polygons(points, polygons.points, polygons.counts)
    if mesh.GetOrientationAttr().Get(time) == "leftHanded":  # whose front is where its corners go clockwise
        triangles, places = triangles[:, ::-1], places[:, ::-1]
    surface = Surface(points, np.arange(len(points)), smooth=is_subdivided(mesh))
    normals = None if surface.smooth else _normals(mesh, time, polygons, len(points), pxr)
    if normals is not None:
        surface.kept, triangles, surface.smooth = welded_corners(points, triangles, normals[places], surface.kept)
    return _with_parts(surface, axes, triangles, polygons.face[polygon], _subsets(prim, time, pxr), pxr)


def is_subdivided(mesh) -> bool:
    """Whether a mesh is the cage of a subdivision surface; one that does not say is taken as it stands."""
    scheme = mesh.GetSubdivisionSchemeAttr()
    return scheme.HasAuthoredValue() and scheme.Get() != "none"


def _normals(mesh, time, corners: Polygons, num_points: int, pxr) -> np.ndarray | None:
    """[N, 3] of the corners; None for a mesh without normals, or with some that do not fit it."""
    primvar = pxr.UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    if primvar and primvar.HasAuthoredValue():
        values, interpolation = primvar.ComputeFlattened(time), primvar.GetInterpolation()
    else:
        values, interpolation = mesh.GetNormalsAttr().Get(time), mesh.GetNormalsInterpolation()
    try:
        normals = np.array(values if values is not None else [], float).reshape(-1, 3)
    except (TypeError, ValueError):
        return None
    entries = {"vertex": corners.points, "varying": corners.points, "faceVarying": corners.place}.get(interpolation)
    size = {"vertex": num_points, "varying": num_points, "faceVarying": corners.num_in_file}.get(interpolation)
    return normals[entries] if size and len(normals) == size and np.isfinite(normals).all() else None


def numbers(value, shape) -> np.ndarray:
    """An array of floats of a shape, empty for no value. Raises BadMesh for another type and for what is not finite."""
    try:
        array = np.array(value if value is not None else [], float).reshape(shape)
    except (TypeError, ValueError):
        raise BadMesh("has points or corners of another type than the schema of USD") from None
    if not np.isfinite(array).all() or (array.size and np.abs(array).max() > 1e60):
        raise BadMesh("has a point that is not finite")
    return array


def integers(attribute, time) -> np.ndarray:
    """The whole numbers [N] of an attribute, none for one without a value. Raises BadMesh for another type."""
    try:
        values = np.array(attribute.Get(time) or [], np.int64)
    except (TypeError, ValueError, OverflowError):
        values = None
    if values is None or values.ndim != 1:
        raise BadMesh(f"has {attribute.GetName()} of another type than the schema of USD")
    return values


class Polygons(NamedTuple):
    """points [N] of the corners, counts [F] of these, face of the file [F], place [N] of corners in the file, which has more"""

    points: np.ndarray
    counts: np.ndarray
    face: np.ndarray
    place: np.ndarray
    num_in_file: int


def _polygons(points, corners, counts, holes) -> Polygons:
    """The faces with three corners or more, without holes."""
    if (counts < 0).any() or counts.sum() != len(corners):
        raise BadMesh(f"has {len(corners)} corners, where its faces ask for {counts.sum()}")
    if len(corners) and (corners.min() < 0 or corners.max() >= len(points)):
        raise BadMesh(f"has corners that are no points, of which it has {len(points)}")
    kept = counts >= 3
    kept[holes[(holes >= 0) & (holes < len(counts))]] = False
    if not kept.any():
        raise BadMesh("has no faces")
    place = np.flatnonzero(np.repeat(kept, counts))
    return Polygons(corners[place], counts[kept], np.flatnonzero(kept), place, len(corners))


def _subsets(prim, time, pxr) -> list:
    """(name, prim that material is bound to, faces) of the subsets by material; faces None: all others."""
    if not prim.IsA(pxr.UsdGeom.Mesh):
        return [("", prim, None)]
    subsets = pxr.UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets()
    found = [(subset.GetPrim().GetName(), subset.GetPrim(), integers(subset.GetIndicesAttr(), time))
             for subset in subsets]
    return [*found, ("", prim, None)]


def _with_parts(surface: Surface, axes: Axes, triangles, face, subsets, pxr) -> Surface:
    """The surface with a mesh for each subset that has an area; each mesh is made of all points, as deformations ask."""
    vertices, left = axes.points(surface.points[surface.kept]), np.ones(len(triangles), bool)
    for name, prim, faces in subsets:
        chosen = left if faces is None else left & np.isin(face, faces)
        left = left & ~chosen
        try:
            mesh = _core.Mesh(vertices, np.asarray(triangles)[chosen], original_triangle=np.asarray(face)[chosen])
        except ValueError:
            continue  # no triangle with an area
        surface.parts.append((name, material_name(prim, pxr), mesh))
    if not surface.parts:
        raise BadMesh("has no face with an area")
    surface.num_flat = len(triangles) - sum(len(mesh.triangles) for _, _, mesh in surface.parts)
    return surface


def material_name(prim, pxr) -> str:
    """The name of the material bound to a prim, or what it says of itself for other sensors than cameras; "" for none."""
    material, _ = pxr.UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    if not material:
        return ""
    base = material.GetPrim().GetAttribute(NON_VISUAL)
    word = base.Get() if base and base.HasAuthoredValue() else None
    return str(word) if word else material.GetPrim().GetName()


def changes_size(prim) -> bool:
    """Whether a solid has another size at other times."""
    sizes = (prim.GetAttribute(name) for name in SIZES)
    return any(size and size.GetNumTimeSamples() > 1 for size in sizes)


_TURNS = {"X": [2, 0, 1], "Y": [1, 2, 0], "Z": [0, 1, 2]}  # of axes, so that z points along the axis of a solid


def _solid(prim, time):
    def number(name: str) -> float:
        try:
            value = float(prim.GetAttribute(name).Get(time))
        except (TypeError, ValueError):
            raise BadMesh(f"has no number as its {name}") from None
        if not 0.0 < value < 1e60:
            raise BadMesh(f"has {name} {value:g}, which must be finite and above 0")
        return value

    kind = prim.GetTypeName()
    if kind == "Cube":
        return forms.box([number("size")] * 3)
    if kind == "Sphere":
        return forms.sphere(number("radius"))
    axis = str(prim.GetAttribute("axis").Get(time))
    if kind == "Plane":  # the width of one that looks along x lies along z, that of others along x
        sides = number("width"), number("length")
        points, triangles = forms.rectangle(*(sides[::-1] if axis in "XY" else sides))
    elif kind.endswith("_1"):  # whose ends have radii of their own
        form = getattr(forms, kind.removesuffix("_1").lower())
        points, triangles = form(number("radiusBottom"), number("height"), radius_above=number("radiusTop"))
    else:
        points, triangles = getattr(forms, kind.lower())(number("radius"), number("height"))
    return points[:, _TURNS.get(axis, _TURNS["Z"])], triangles
