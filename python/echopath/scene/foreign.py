"""Meshes of other libraries' objects. None of these libraries is needed: an object is known by the arrays that it has."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import anything, checked
from ..arguments.number_rules import unit_rule

_SURFACES = {"triangle": 3, "quad": 4}         # cells of meshio by the number of their corners
_NO_SURFACES = ("vertex", "line")              # left out, as lines of files are


@checked(source=anything, unit=unit_rule)
def mesh_from(source: object, *, unit: float = 1.0) -> _core.Mesh:
    """A Mesh of an object of trimesh, meshio or pyvista, or of any that has the same arrays.

    source: a trimesh.Trimesh (vertices [V, 3], faces [F, 3]), a pyvista.PolyData (points, and faces as VTK has them) or a
        meshio.Mesh (points, and cells of the types triangle, quad and polygon; points and lines are left out)
    unit: m per unit of its coordinates, 1e-12 to 1e9
    Polygons of more than three corners are cut into triangles as `load_mesh` does it; `original_triangle` of the Mesh names
    the faces of the source from 0. Raises TypeError for other objects and ValueError naming what is wrong: coordinates that
    are not finite, corners that are no vertices, cells of volumes, no face at all.
    """
    vertices, corners, counts = _polygons_of(source)
    vertices = unit * _checked_vertices(vertices)
    outside = (corners < 0) | (corners >= len(vertices))
    if outside.any():
        raise ValueError(f"source: corners must be 0 to {len(vertices) - 1}, the vertices, got {corners[outside][0]}")
    if not len(counts):
        raise ValueError("source: must have faces, got none")
    if counts.min() < 3:
        raise ValueError(f"source: faces must have 3 corners or more, got one of {counts.min()}")
    triangles, face, _ = _core.triangles_of_polygons(vertices, corners, counts)
    return _core.Mesh(vertices, triangles, original_triangle=face)


def _checked_vertices(vertices):
    vertices = np.asarray(vertices, np.float64)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise ValueError(f"source: vertices must be [V, 3], got {list(vertices.shape)}")
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        raise ValueError(f"source: vertices must be finite, got {vertices[bad[0]].tolist()} at vertex {bad[0]}")
    return vertices


def _polygons_of(source) -> tuple:
    """Vertices [V, 3], corners [N] face by face, and how many each face has [F]."""
    if hasattr(source, "vertices") and hasattr(source, "faces"):
        return source.vertices, *_joined([np.asarray(source.faces)])
    if hasattr(source, "points") and hasattr(source, "faces"):
        return _of_vtk(source)
    if hasattr(source, "points") and hasattr(source, "cells") and isinstance(source.cells, (list, tuple)):
        return source.points, *_joined([block for cells in source.cells for block in _surfaces(cells)])
    raise TypeError("source: must be a mesh of trimesh, meshio or pyvista (vertices and faces, or points and faces or cells), "
                    f"got {type(source).__name__}")


def _joined(blocks) -> tuple:
    """(corners [N], counts [F]) of arrays [F, corners]."""
    for block in blocks:
        if block.ndim != 2 or block.dtype.kind not in "iu":
            raise ValueError(f"source: faces must be integers [F, corners], got {block.dtype} {list(block.shape)}")
    corners = [np.zeros(0, np.int64), *(block.ravel().astype(np.int64) for block in blocks)]
    counts = [np.zeros(0, np.int64), *(np.full(len(block), block.shape[1]) for block in blocks)]
    return np.concatenate(corners), np.concatenate(counts)


def _surfaces(cells) -> list:
    """Arrays [F, corners] of a block of cells of meshio; polygons of different sizes apart."""
    if cells.type in _NO_SURFACES:
        return []
    if cells.type in _SURFACES:
        return [np.asarray(cells.data)]
    if cells.type.startswith("polygon"):
        return [np.asarray(corners)[None] for corners in cells.data]
    raise ValueError(f"source: cells must be triangles, quads or polygons, got '{cells.type}'")


def _of_vtk(source) -> tuple:
    if getattr(source, "n_strips", 0):
        source = source.triangulate()
    table = np.asarray(source.faces)  # count, corners, count, corners, ...
    if table.ndim != 1 or (table.size and table.dtype.kind not in "iu"):
        raise ValueError(f"source: faces must be integers [N], counts and corners, got {table.dtype} {list(table.shape)}")
    starts = _starts_of_faces(table)
    return source.points, np.delete(table, starts), table[starts]


def _starts_of_faces(table) -> np.ndarray:
    """Where each face begins in a table of VTK, [F]."""
    starts, at = [], 0
    while at < len(table):
        count = int(table[at])
        if count < 0:
            raise ValueError(f"source: faces must begin with their number of corners, got {count} at {at}")
        starts.append(at)
        at += count + 1
    if at > len(table):
        raise ValueError(f"source: faces must have as many corners as they say, the last lacks {at - len(table)}")
    return np.array(starts, np.int64)
