"""Closed bodies as cells of a bent lattice: the faces between full and empty cells make the cage of a smooth surface."""
from dataclasses import dataclass

import numpy as np

from .. import _core
from .actor import Part
from .subdivision import Cage, on_limit, subdivided, triangulated

# Of a cell: the corners of the face on the lower and on the upper side of each axis, counter-clockwise from outside.
_CORNERS = {(0, -1): ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)), (0, 1): ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)),
            (1, -1): ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)), (1, 1): ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)),
            (2, -1): ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)), (2, 1): ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))}


@dataclass(frozen=True)
class Face:
    """A side of a full cell: cell (i, j, k); axis 0 to 2 (x, y, z); side -1 or 1; outer: at the rim of the lattice."""

    cell: tuple
    axis: int
    side: int
    outer: bool


def faces_of(full):
    """Faces between the full cells [X, Y, Z] of bool and the empty ones or the outside."""
    found = []
    for (axis, side) in _CORNERS:
        for cell in np.argwhere(full):
            beyond = cell.copy()
            beyond[axis] += side
            outer = not 0 <= beyond[axis] < full.shape[axis]
            if outer or not full[tuple(beyond)]:
                found.append(Face(tuple(int(n) for n in cell), axis, side, outer))
    return found


def cage_of(points, full, label):
    """The Cage of full cells [X, Y, Z] whose corners are at points [X + 1, Y + 1, Z + 1, 3] in m.

    label(Face) -> (sheet, name): edges between faces of different sheets stay sharp.
    """
    faces = faces_of(full)
    corners = np.array([[np.add(face.cell, step) for step in _CORNERS[face.axis, face.side]] for face in faces])
    index = np.ravel_multi_index(np.moveaxis(corners, -1, 0), points.shape[:3])
    used, quads = np.unique(index, return_inverse=True)
    labels = [label(face) for face in faces]
    quads = quads.reshape(index.shape)
    return Cage(points.reshape(-1, 3)[used], quads, labels, _between_sheets(quads, [sheet for sheet, _ in labels]))


def refined(cage, levels):
    """The cage after `levels` subdivisions, its vertices on the limit surface."""
    for _ in range(levels):
        cage = subdivided(cage)
    return on_limit(cage)


def parts_of(cage, materials, *, flat_sheets=()):
    """Parts of a refined cage, one for each label, smooth but for those of `flat_sheets`.

    materials: {part name or the group before its '/': material}. Normals go on across the parts of a sheet.
    """
    parts = []
    triangles = triangulated(cage.quads, cage.vertices)
    for sheet in dict.fromkeys(sheet for sheet, _ in cage.labels):
        of_sheet = [n for n, (own, _) in enumerate(cage.labels) if own == sheet]
        whole = _core.Mesh(cage.vertices, triangles.reshape(-1, 2, 3)[of_sheet].reshape(-1, 3))
        names = np.repeat([cage.labels[n][1] for n in of_sheet], 2)
        for name in dict.fromkeys(names.tolist()):
            mesh = whole.part(names == name)
            material = materials.get(name, materials.get(name.split("/")[0]))
            parts.append(Part(name, mesh, material, smooth=sheet not in flat_sheets))
    return parts


def _between_sheets(quads, sheets):
    """Edges [E, 2] whose two faces are of different sheets."""
    home, sharp = {}, []
    for quad, sheet in zip(quads.tolist(), sheets):
        for edge in zip(quad, quad[1:] + quad[:1]):
            key = tuple(sorted(edge))
            if home.setdefault(key, sheet) != sheet:
                sharp.append(key)
    return np.array(sharp, dtype=int).reshape(-1, 2)


def rounded_box(low, high, radius, pieces, *, bow=0.0):
    """Points [X, Y, Z, 3] of a lattice whose limit surface is a box from `low` to `high` [3] in m with rounded edges.

    radius: m, width of the strip along the edges that is rounded; pieces [3]: of its length between them; bow: m by which the
    middle of each side stands out. All cells are full.
    """
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    axes = [np.concatenate([[a, a + 0.5 * radius], np.linspace(a + radius, b - radius, n + 1), [b - 0.5 * radius, b]])
            for a, b, n in zip(low, high, pieces)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    share = (2.0 * points - low - high) / (high - low)
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        out = bow * (1.0 - share[..., first]**2) * (1.0 - share[..., second]**2)
        points[..., axis] += np.where(np.abs(share[..., axis]) > 1.0 - 1e-9, np.sign(share[..., axis]) * out, 0.0)
    return points


def rounded_parts(points, label, materials, levels=1):
    """Parts of a lattice of full cells; label(Face) -> part name."""
    full = np.ones(np.array(points.shape[:3]) - 1, dtype=bool)
    return parts_of(refined(cage_of(points, full, lambda face: ("skin", label(face))), levels), materials)
