"""Triangles cut to a box, because matplotlib draws beyond the limits of 3-D axes."""
from __future__ import annotations

import numpy as np


def clip_triangles(triangles, low, high) -> list:
    """The parts of triangles [F, 3, 3] inside the box `low` [3] to `high` [3]: a list of polygons [N, 3], N >= 3."""
    below, above = triangles < low, triangles > high
    is_outside = np.any(np.all(below, axis=1) | np.all(above, axis=1), axis=1)
    is_inside = ~np.any(below | above, axis=(1, 2))
    polygons = list(triangles[is_inside])
    for triangle in triangles[~is_inside & ~is_outside]:
        polygon = clip_polygon(triangle, low, high)
        if len(polygon) >= 3:
            polygons.append(polygon)
    return polygons


def clip_polygon(polygon, low, high):
    """The part of a convex polygon [N, 3] inside a box: [M, 3], M = 0 when there is none (Sutherland, Hodgman 1974)."""
    for axis in range(3):
        for sign, bound in ((1.0, low[axis]), (-1.0, -high[axis])):
            polygon = _cut(polygon, sign * polygon[:, axis] - bound) if len(polygon) else polygon
    return polygon


def _cut(polygon, distance):
    """The part of a polygon where `distance` [N], one per corner and linear between them, is not negative."""
    kept = []
    for corner in range(len(polygon)):
        here, before = distance[corner], distance[corner - 1]
        if (here >= 0.0) != (before >= 0.0):
            share = before / (before - here)
            kept.append(polygon[corner - 1] + share * (polygon[corner] - polygon[corner - 1]))
        if here >= 0.0:
            kept.append(polygon[corner])
    return np.array(kept).reshape(-1, 3)


def outline(polygons) -> list:
    """The edges [2, 3] that belong to one of the polygons [N, 3] only."""
    edges = {}
    for polygon in polygons:
        for corner in range(len(polygon)):
            edge = np.array([polygon[corner - 1], polygon[corner]])
            key = frozenset(map(tuple, np.round(edge, 9) + 0.0))
            edges[key] = None if key in edges else edge
    return [edge for edge in edges.values() if edge is not None]
