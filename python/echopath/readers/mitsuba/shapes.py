"""Shapes of a Mitsuba file as meshes in their own frames, in m; each mesh is made once."""
from __future__ import annotations

import numpy as np

from ... import _core
from ..axes import Axes
from ..obj import turned
from .elements import Element, file_of

SPHERE_STEPS = 32  # triangles around a full circle
FILES = ("ply", "obj")
KNOWN = (*FILES, "rectangle", "cube", "sphere", "disk", "cylinder")
CURVED = ("sphere", "cylinder")


class Shapes:
    """Makes the surfaces of shapes, the same object for the same file or form."""

    def __init__(self, axes: Axes):
        self._axes = axes
        self._made: dict[tuple, list] = {}

    def surfaces(self, shape: Element) -> list[tuple[str, str, _core.Mesh]]:
        """(name, name of its material in the mesh file, Mesh) of each part; none of a file without any area.

        Raises FileError naming the scene file, and the mesh file where that is wrong.
        """
        kind = shape.get("type")
        if kind in FILES:
            path = file_of(shape, shape.value("filename", "string") or "")
            return self._once((kind, path), lambda: self._of_file(shape, path))
        return self._once((kind, *_parameters(shape)), lambda: [("", "", self._form(shape))])

    def _once(self, key: tuple, make):
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]

    def _of_file(self, shape: Element, path) -> list:
        if path.suffix.lower() not in (".ply", ".obj"):
            shape.refuse(f"the file '{path.name}' must be .ply or .obj")
        try:
            surfaces, _ = _core.load_surfaces(path, self._axes.unit)
        except _core.FileError as error:
            if str(error).endswith(("has no faces", "has no face with an area")):
                return []
            shape.refuse(str(error))
        return [(name, material, turned(mesh, self._axes)) for name, material, mesh in surfaces]

    def _form(self, shape: Element) -> _core.Mesh:
        vertices, triangles = _FORMS[shape.get("type")](shape)
        try:
            return _core.Mesh(self._axes.points(vertices), triangles)
        except ValueError as error:
            shape.refuse(f"has no area ({error})")


def _parameters(shape: Element) -> list:
    """What gives a form its size: radius, center, p0 and p1."""
    return [shape.number("radius", 1.0), *(tuple(shape.point(name, (0, 0, 0))) for name in ("center", "p0", "p1"))]


def _rectangle(_: Element):
    return np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float), [[0, 1, 2], [0, 2, 3]]


def _cube(_: Element):
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners, [triangle for a, b, c, d in quads for triangle in ([a, b, c], [a, c, d])]


def _disk(_: Element):
    ring = _circle()
    vertices = np.vstack([[0.0, 0.0, 0.0], np.column_stack([ring, 0.0 * ring[:, 0]])])
    return vertices, [[0, 1 + i, 1 + (i + 1) % SPHERE_STEPS] for i in range(SPHERE_STEPS)]


def _sphere(shape: Element):
    """Rings of latitude between two poles, outside facing out."""
    rings = SPHERE_STEPS // 2
    polar = np.pi * np.arange(1, rings) / rings
    ring = _circle()
    body = np.concatenate([np.column_stack([np.sin(one) * ring, np.full(len(ring), np.cos(one))]) for one in polar])
    unit = np.vstack([body, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    north, south, last = len(body), len(body) + 1, len(body) - SPHERE_STEPS
    caps = [triangle for i in range(SPHERE_STEPS) for triangle in (
        [north, i, (i + 1) % SPHERE_STEPS], [south, last + (i + 1) % SPHERE_STEPS, last + i])]
    radius = shape.number("radius", 1.0)
    return np.array(shape.point("center", (0, 0, 0))) + radius * unit, _strips(rings - 2) + caps


def _cylinder(shape: Element):
    """A tube without caps from p0 to p1."""
    begin, end = (np.array(shape.point(name, default)) for name, default in (("p0", (0, 0, 0)), ("p1", (0, 0, 1))))
    length = float(np.linalg.norm(end - begin))
    if not 1e-30 < length < 1e60:
        shape.refuse("p0 and p1 must differ")
    axis = (end - begin) / length
    side = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    side /= np.linalg.norm(side)
    around = shape.number("radius", 1.0) * (_circle() @ np.stack([side, np.cross(axis, side)]))
    return np.vstack([end + around, begin + around]), _strips(1)


def _circle() -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(SPHERE_STEPS) / SPHERE_STEPS
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _strips(count: int) -> list:
    """Triangles between neighbouring rings of vertices."""
    triangles = []
    for first in range(0, count * SPHERE_STEPS, SPHERE_STEPS):
        for i in range(SPHERE_STEPS):
            a, b = first + i, first + (i + 1) % SPHERE_STEPS
            triangles += [[a, a + SPHERE_STEPS, b], [b, a + SPHERE_STEPS, b + SPHERE_STEPS]]
    return triangles


_FORMS = {"rectangle": _rectangle, "cube": _cube, "disk": _disk, "sphere": _sphere, "cylinder": _cylinder}
