"""What normals of files say: which meshes stand for curved surfaces, and where these have edges. One rule for all formats.

Vertices that files keep twice, for textures and for edges, are made one again.
"""
from __future__ import annotations

import numpy as np

from ..base.numerics.triangles import areas_of

FLAT_COSINE = np.cos(np.radians(0.1))     # normals of a facet that differ by less stand for a plane
COARSE_FLAT_COSINE = np.cos(np.radians(1.0))  # the same of normals of few bits, which differ by rounding
EDGE_COSINE = np.cos(np.radians(20.0))    # normals at a place that differ by more stand for an edge
CURVED_SHARE = 0.5                        # of the area, from which on a mesh stands for a curved surface
MOST_NORMALS = 16                         # at one place; beyond, each vertex is by itself


def as_smooth(vertices: np.ndarray, triangles: np.ndarray, normals: np.ndarray, coarse: bool = False) -> bool:
    """Whether most of the area has normals that turn from corner to corner: then the facets stand for a curved surface.

    Turns of less than .1 degree are none: a cylinder of more than 3600 segments has facets. Of coarse normals it is 1 degree.

    normals: [F, 3, 3] of the corners of triangles, of any length; coarse: whether they have few bits, as bytes and Draco have
    """
    a, b, c = (_units(normals[:, corner]) for corner in range(3))
    cosines = [np.einsum("ij,ij->i", first, second) for first, second in ((a, b), (b, c), (c, a))]
    turns = np.minimum(np.minimum(*cosines[:2]), cosines[2]) < (COARSE_FLAT_COSINE if coarse else FLAT_COSINE)
    if not turns.any():
        return False
    with np.errstate(all="ignore"):
        areas = areas_of(vertices[triangles])
    areas = np.where(np.isfinite(areas), areas, 0.0)
    return bool(areas[turns].sum() > CURVED_SHARE * areas.sum())


def welded_corners(vertices: np.ndarray, triangles: np.ndarray, normals: np.ndarray, places: np.ndarray | None = None) -> tuple:
    """(vertices that are kept [W], triangles [F, 3] of these, whether it is smooth) of a mesh with normals [F, 3, 3] of corners.

    places: [V] numbers of vertices, equal for those that are one; None: those of equal coordinates are
    """
    smooth = as_smooth(vertices, triangles, normals)
    places = _equal_rows(vertices)[1] if places is None else places
    corners = triangles.reshape(-1)
    groups = _split_by_normals(places[corners], normals.reshape(-1, 3)) if smooth else places[corners]
    first, number = np.unique(groups, return_index=True, return_inverse=True)[1:]
    order = np.lexsort([first, corners[first]])    # vertices stay in the order of the file
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return corners[first[order]], rank[number.reshape(triangles.shape)], smooth


def welded(vertices: np.ndarray, triangles: np.ndarray, moved_by: list, normals: np.ndarray | None) -> tuple:
    """(vertices that are kept [W], triangles [F, 3] of these) with vertices of one place and one movement made one.

    moved_by: arrays [V, ...] that must be equal, too; normals: where they are given, those of one place must also be alike,
    so that the surface stays cut where the file has an edge
    """
    first, number = _equal_rows(np.concatenate([vertices, *(rows.reshape(len(vertices), -1) for rows in moved_by)], axis=1))
    if normals is not None:
        first, number = np.unique(_split_by_normals(number, normals), return_index=True, return_inverse=True)[1:]
    order = np.argsort(first, kind="stable")       # vertices stay in the order of the file
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[number.reshape(-1)][triangles]


def _equal_rows(rows: np.ndarray) -> tuple:
    """(first [G], group [V]) of rows that are equal."""
    rows = np.ascontiguousarray(rows + 0.0)        # -0 is 0
    _, first, group = np.unique(rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1]))).ravel(),
                                return_index=True, return_inverse=True)
    return first, group.reshape(-1)


def _split_by_normals(place: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Groups of a place, each of normals that differ little from the first of the group."""
    units = _units(normals)
    group = np.full(len(place), -1)
    left = np.arange(len(place))
    for _ in range(MOST_NORMALS):
        if not len(left):
            break
        _, first, inverse = np.unique(place[left], return_index=True, return_inverse=True)
        leader = left[first][inverse.reshape(-1)]
        alike = (units[left] * units[leader]).sum(axis=1) >= EDGE_COSINE
        alike |= left == leader
        group[left[alike]] = leader[alike]
        left = left[~alike]
    group[left] = left
    return group


def _units(normals: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(normals, axis=1)
    return normals / np.where(lengths > 0.0, lengths, 1.0)[:, None]
