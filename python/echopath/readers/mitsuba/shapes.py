"""Shapes of a Mitsuba file as meshes in their own frames, in m; each mesh is made once."""
from __future__ import annotations

import numpy as np

from ... import _core
from ...base.storage.pointers import pointers_are_told
from .. import forms
from ..axes import Axes
from ..mesh_files import NO_AREA, MeshPart, part_of, parts_of_file
from .elements import Element, file_of
from .serialized import read_serialized

FILES = ("ply", "obj", "serialized")
KNOWN = (*FILES, "rectangle", "cube", "sphere", "disk", "cylinder")
CURVED = ("sphere", "cylinder")


class Shapes:
    """Makes the surfaces of shapes, the same object for the same file or form."""

    def __init__(self, axes: Axes):
        self._axes = axes
        self._made: dict[tuple, list] = {}

    def surfaces(self, shape: Element) -> list[MeshPart]:
        """Each part of a shape, its material named after that in the mesh file; none of a file without any area.

        Raises FileError naming the scene file, and the mesh file where that is wrong.
        """
        kind = shape.get("type")
        if kind in FILES:
            path = file_of(shape, shape.value("filename", "string") or "")
            faceted = (shape.value("face_normals", "boolean") or "").strip().lower() == "true"
            if kind == "serialized":
                index = shape.whole("shape_index", 0)
                return self._once((kind, path, index, faceted), lambda: self._of_serialized(shape, path, index, faceted))
            return self._once((kind, path, faceted), lambda: self._of_file(shape, path, faceted))
        return self._once((kind, *_parameters(shape)), lambda: [MeshPart("", "", "", self._form(shape), kind in CURVED)])

    def _once(self, key: tuple, make):
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]

    def _of_file(self, shape: Element, path, faceted: bool) -> list:
        if path.suffix.lower() not in (".ply", ".obj"):
            shape.refuse(f"the file '{path.name}' must be .ply or .obj")
        try:
            with pointers_are_told(path):
                return parts_of_file(path, self._axes, faceted)[0]
        except _core.FileError as error:
            if str(error).endswith(("has no faces", NO_AREA)):
                return []
            shape.refuse(str(error))

    def _of_serialized(self, shape: Element, path, index: int, faceted: bool) -> list:
        try:
            name, vertices, triangles, normals = read_serialized(path, index)
        except _core.FileError as error:
            shape.refuse(str(error))
        if not np.isfinite(vertices).all():
            shape.refuse(f"{path}: must have finite positions")
        corners = None if normals is None or faceted else normals[triangles]
        part = part_of("", name or path.stem, "", self._axes.unit * vertices, triangles, np.arange(len(triangles)), corners,
                       self._axes)
        return [] if part is None else [part]

    def _form(self, shape: Element) -> _core.Mesh:
        vertices, triangles = _FORMS[shape.get("type")](shape)
        try:
            return _core.Mesh(self._axes.points(vertices), triangles)
        except ValueError as error:
            shape.refuse(f"has no area ({error})")


def _parameters(shape: Element) -> list:
    """What gives a form its size: radius, center, p0 and p1."""
    return [shape.number("radius", 1.0), *(tuple(shape.point(name, (0, 0, 0))) for name in ("center", "p0", "p1"))]


def _sphere(shape: Element):
    vertices, triangles = forms.sphere(shape.number("radius", 1.0))
    return np.array(shape.point("center", (0, 0, 0))) + vertices, triangles


def _cylinder(shape: Element):
    """A tube without caps from p0 to p1."""
    begin, end = (np.array(shape.point(name, default)) for name, default in (("p0", (0, 0, 0)), ("p1", (0, 0, 1))))
    length = float(np.linalg.norm(end - begin))
    if not 1e-30 < length < 1e60:
        shape.refuse("p0 and p1 must differ")
    axis = (end - begin) / length
    side = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    side /= np.linalg.norm(side)
    vertices, triangles = forms.cylinder(shape.number("radius", 1.0), length, caps=False)
    return 0.5 * (begin + end) + vertices @ np.stack([side, np.cross(axis, side), axis]), triangles


_FORMS = {"rectangle": lambda _: forms.rectangle(2.0, 2.0), "cube": lambda _: forms.box([2.0, 2.0, 2.0]),
          "disk": lambda _: forms.revolved([(0.0, 0.0), (1.0, 0.0)]), "sphere": _sphere, "cylinder": _cylinder}
