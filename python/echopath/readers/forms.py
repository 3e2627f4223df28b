"""Simple solids as vertices [V, 3] and triangles [F, 3], for formats that name them."""
from __future__ import annotations

import numpy as np

AROUND = 32  # triangles around a full circle

Surface = tuple[np.ndarray, list]


def box(size) -> Surface:
    """About the origin; size [3]."""
    corners = 0.5 * np.asarray(size, float) * np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners, [triangle for a, b, c, d in quads for triangle in ([a, b, c], [a, c, d])]


def rectangle(width: float, length: float) -> Surface:
    """In the plane z = 0 about the origin, along x and y."""
    return (np.array([[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]) * [width, length, 0],
            [[0, 1, 2], [0, 2, 3]])


def revolved(profile) -> Surface:
    """The surface of a profile of points (radius, z), downwards, turned about z; points of radius 0 close it."""
    circle = _circle()
    vertices, rings, triangles = [], [], []
    for radius, z in profile:
        first, points = sum(map(len, vertices)), circle if radius > 0.0 else circle[:1]
        vertices.append(np.column_stack([radius * points, np.full(len(points), z)]))
        rings.append(first + np.arange(AROUND) % len(points))
    for above, below in zip(rings, rings[1:]):
        for i in range(AROUND):
            a, b, c, d = above[i], below[i], below[(i + 1) % AROUND], above[(i + 1) % AROUND]
            triangles += [face for face in ([a, b, c], [a, c, d]) if len(set(face)) == 3]
    return np.concatenate(vertices), triangles


def sphere(radius: float) -> Surface:
    """About the origin, its vertices on the surface."""
    return revolved(_arc(radius, 0.0, 0.0, np.pi))


def cylinder(radius: float, height: float, caps: bool = True, radius_above: float | None = None) -> Surface:
    """About the origin, along z; radius_above: of its upper end, None: as below."""
    side = [(radius if radius_above is None else radius_above, 0.5 * height), (radius, -0.5 * height)]
    return revolved([(0.0, 0.5 * height), *side, (0.0, -0.5 * height)] if caps else side)


def cone(radius: float, height: float) -> Surface:
    """About the origin, its point up, along z."""
    return revolved([(0.0, 0.5 * height), (radius, -0.5 * height), (0.0, -0.5 * height)])


def capsule(radius: float, height: float, radius_above: float | None = None) -> Surface:
    """About the origin, along z; height: of its straight part; radius_above: of the upper half sphere, None: as below."""
    upper = _arc(radius if radius_above is None else radius_above, 0.5 * height, 0.0, 0.5 * np.pi)
    return revolved(upper + _arc(radius, -0.5 * height, 0.5 * np.pi, np.pi))


def _arc(radius: float, height: float, begin: float, end: float) -> list:
    """Points (radius, z) of a circle about (0, height), by the angle from its top."""
    angles = np.linspace(begin, end, max(2, int(round(0.5 * AROUND * (end - begin) / np.pi)) + 1))
    tiny = 1e-12 * radius
    return [(float(r) if r > tiny else 0.0, float(z)) for r, z in
            zip(radius * np.sin(angles), height + radius * np.cos(angles))]


def _circle() -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
    return np.column_stack([np.cos(angle), np.sin(angle)])
