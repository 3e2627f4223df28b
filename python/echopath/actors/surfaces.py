"""Triangulated surfaces as plain arrays: each function returns vertices [V, 3] in m and triangles [F, 3].

Triangles are counter-clockwise seen from the front (outside, where the surface is closed).
"""
import functools

import numpy as np

from .curves import monotone_cubic

RING_SAMPLES = 256       # points that the perimeter of a section is measured with
MERIDIAN_SAMPLES = 600   # likewise of the length of a swept surface
ROW_HEIGHT = 0.87        # distance of the rings of near-equilateral triangles, in edges
FEWEST_OF_RING = 5       # vertices
WELD = 1e-9              # m: vertices nearer than that are one
MAX_TRIANGLES = 20_000_000


def edge_length(value, size, triangles_per_square=4.0):
    """Tessellation length in m for a surface `size` m wide; None means as few triangles as the shape needs."""
    if value is None:
        return np.inf
    if triangles_per_square * (size / value) ** 2 > MAX_TRIANGLES:
        raise too_short(value)
    return value


def too_short(edge) -> ValueError:
    """The error of an edge in m that makes too many triangles."""
    return ValueError(f"edge: must be long enough for less than {MAX_TRIANGLES} triangles, got {edge!r} m")


def parallelogram(corner, u, v, edge=np.inf):
    """The parallelogram corner + [0, 1] u + [0, 1] v with its front along u x v, in pieces of at most `edge` m."""
    corner, u, v = (np.asarray(x, dtype=float) for x in (corner, u, v))
    nu, nv = num_pieces(np.linalg.norm(u), edge), num_pieces(np.linalg.norm(v), edge)
    i, j = np.meshgrid(np.arange(nu + 1), np.arange(nv + 1), indexing="ij")
    vertices = corner + np.multiply.outer(i / nu, u) + np.multiply.outer(j / nv, v)
    index = np.arange((nu + 1) * (nv + 1)).reshape(nu + 1, nv + 1)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    triangles = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], axis=-2)
    return vertices.reshape(-1, 3), triangles.reshape(-1, 3)


def triangle(a, b, c, pieces=1):
    """The triangle a b c with every side in `pieces` equal pieces, pieces^2 triangles."""
    a, b, c = (np.asarray(x, dtype=float) for x in (a, b, c))
    n = int(pieces)
    i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
    inside = i + j <= n
    index = np.cumsum(inside.ravel()).reshape(n + 1, n + 1) - 1
    vertices = (a + np.multiply.outer(i / n, b - a) + np.multiply.outer(j / n, c - a))[inside]
    i, j = i[inside], j[inside]
    up = i + j < n
    down = i + j < n - 1
    upward = np.stack([index[i[up], j[up]], index[i[up] + 1, j[up]], index[i[up], j[up] + 1]], -1)
    i, j = i[down], j[down]
    return vertices, np.concatenate([upward, np.stack([index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]], -1)])


def joined(*pieces):
    """One surface of several (vertices, triangles); vertices at the same place become one."""
    offsets = np.cumsum([0] + [len(vertices) for vertices, _ in pieces[:-1]])
    vertices = np.concatenate([vertices for vertices, _ in pieces])
    triangles = np.concatenate([faces + offset for (_, faces), offset in zip(pieces, offsets)])
    places = np.round(vertices / WELD)
    order = np.lexsort(places.T[::-1])  # np.unique of rows takes five times as long
    is_new = np.r_[True, np.any(np.diff(places[order], axis=0) != 0.0, axis=1)]
    same = np.empty(len(order), np.intp)
    same[order] = np.cumsum(is_new) - 1
    return vertices[order[is_new]], same[triangles]


@functools.cache
def _icosahedron():
    """The corners of the faces [20, 3, 3] of an icosahedron with edges of 2, counter-clockwise from outside."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    corners = np.array([[0, s, t * golden] for s in (-1, 1) for t in (-1, 1)], dtype=float)
    corners = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    distance = np.linalg.norm(corners[:, None] - corners[None], axis=-1)
    near = np.abs(distance - 2.0) < 1e-9
    faces = [(i, j, k) for i in range(12) for j in range(i) for k in range(j)
             if near[i, j] and near[j, k] and near[i, k]]
    sides = corners[np.array(faces)]
    is_inward = np.linalg.det(sides) < 0
    sides[is_inward] = sides[is_inward][:, [0, 2, 1]]
    return sides


def icosphere(radius, pieces):
    """Sphere about the origin, vertices on it: an icosahedron with its edges in `pieces` pieces."""
    vertices, triangles = joined(*(triangle(*face, pieces) for face in _icosahedron()))
    return radius * vertices / np.linalg.norm(vertices, axis=1)[:, None], triangles


def table_section(table, begin_cap, end_cap):
    """Section function of a limb (see swept) from a table [N, 6] of stations.

    Columns: place along the axis, centre u, centre v, half width u, half width v, power of the superellipse. Between
    the stations, of which the first and last are the tips, it is interpolated without overshoot. Within begin_cap and
    end_cap m of the tips it is rounded off as an ellipsoid is.
    """
    table = np.asarray(table, dtype=float)
    begin, end = table[0, 0], table[-1, 0]

    def section(t):
        values = monotone_cubic(table[:, 0], table[:, 1:6], t)
        lack = np.maximum(1.0 - (t - begin) / begin_cap, 0.0) ** 2 + np.maximum(1.0 - (end - t) / end_cap, 0.0) ** 2
        values[:, 2:4] *= np.sqrt(np.maximum(1.0 - lack, 0.0))[:, None]
        return values

    return section


def swept(section, begin, end, edge, axes=(0, 1, 2)):
    """Closed surface swept along an axis by superellipses that shrink to a point at both ends.

    section(t [N]) -> [N, 5]: centre u and v, half width u and v, power (2: ellipse) of the section at t m.
    axes: which coordinates u, v and t are; a cyclic permutation of 0, 1, 2. Triangles have sides of about `edge` m.
    """
    places = _ring_places(section, begin, end, edge)
    values = section(places)
    rings, triangles, first = [], [], 0
    for k, (place, value) in enumerate(zip(places, values)):
        tip = k in (0, len(places) - 1)
        ring = value[None, :2] if tip else _ring(value, edge, 0.5 * (k % 2))
        rings.append(np.column_stack([ring, np.full(len(ring), place)]))
        if k:
            before = len(rings[-2])
            triangles.append(_band(before, len(ring), 0.5 * ((k - 1) % 2), 0.5 * (k % 2)) + first)
            first += before
    vertices = np.empty((first + len(rings[-1]), 3))
    vertices[:, list(axes)] = np.concatenate(rings)
    return vertices, np.concatenate(triangles)


def num_swept_triangles(section, begin, end, edge):
    """About how many triangles `swept` makes of ellipses (the perimeter of an ellipse is that of Ramanujan 1914)."""
    _, values, along = _meridian(section, begin, end)
    a, b = values[:, 2], values[:, 3]
    perimeter = np.pi * (3.0 * (a + b) - np.sqrt((3.0 * a + b) * (a + 3.0 * b)))
    of_ring = 2.0 * np.maximum(perimeter / edge, FEWEST_OF_RING)
    return float(np.sum(0.5 * (of_ring[1:] + of_ring[:-1]) * np.diff(along)) / (ROW_HEIGHT * edge))


def num_pieces(length, edge):
    """Number of equal pieces of a line that are at most `edge` long."""
    return max(1, int(np.ceil(length / edge - 1e-9)))


def signed_volume(vertices, triangles):
    """Volume in m^3 inside a closed surface; negative when it is inside out."""
    a, b, c = np.moveaxis(np.asarray(vertices)[np.asarray(triangles)], 1, 0)
    return float(np.sum(a * cross(b, c)) / 6.0)


def cross(a, b):
    """Cross products of vectors [..., 3]; of few, np.cross takes four times as long."""
    return np.stack([a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1], a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
                     a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]], axis=-1)


def _ring_places(section, begin, end, edge):
    """Places of the rings, tips included, at equal distances along the longest meridian."""
    t, _, along = _meridian(section, begin, end)
    count = max(3, int(round(along[-1] / (ROW_HEIGHT * edge))))
    return np.interp(np.linspace(0.0, along[-1], count + 1), along, t)


def _meridian(section, begin, end):
    """(places [N] in m, values of the sections there [N, 5], m [N] along the longest meridian)"""
    t = begin + (end - begin) * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, MERIDIAN_SAMPLES)))
    values = section(t)
    u, v, half_u, half_v, _ = values.T
    steps = [np.hypot(np.diff(t), np.diff(line)) for line in (u + half_u, u - half_u, v + half_v, v - half_v)]
    return t, values, np.concatenate([[0.0], np.cumsum(np.max(steps, axis=0))])


def _ring(value, edge, offset):
    """Points [M, 2] at equal distances on a superellipse, counter-clockwise; the first `offset` distances from +u."""
    angle, circle = _measured_circle()
    u, v = _superellipse(value, circle)
    du, dv = u[1:] - u[:-1], v[1:] - v[:-1]
    along = np.zeros(len(angle))
    np.cumsum(np.sqrt(du * du + dv * dv), out=along[1:])
    count = max(FEWEST_OF_RING, int(round(along[-1] / edge)))
    at = (np.arange(count) + offset) / count * along[-1]
    return np.stack(_superellipse(value, _circle(np.interp(at, along, angle))), axis=-1)


@functools.cache
def _measured_circle():
    """The angles [M] in rad that the perimeter of a section is measured at, and what `_circle` says of them."""
    angle = np.linspace(0.0, 2.0 * np.pi, RING_SAMPLES + 1)
    return angle, _circle(angle)


def _circle(angle):
    """Signs and magnitudes of the cosine and the sine of angles [M] in rad, four arrays."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.sign(cosine), np.abs(cosine), np.sign(sine), np.abs(sine)


def _superellipse(value, circle):
    """Coordinates u [M] and v [M] of the section `value` [5] (see swept) at the angles of `circle`, which `_circle` says."""
    sign_u, size_u, sign_v, size_v = circle
    power = 2.0 / value[4]
    return value[0] + value[2] * sign_u * size_u ** power, value[1] + value[3] * sign_v * size_v ** power


@functools.lru_cache(maxsize=1024)
def _band(num_lower, num_upper, lower_offset, upper_offset):
    """Triangles between two rings of vertices 0.. and num_lower.., by merging their steps around the axis.

    A ring of one vertex is a tip and has no steps. The triangles are kept, as neighbours of a body and bodies have the same
    counts: nobody changes them.
    """
    lower = (np.arange(num_lower) + 1 + lower_offset) / num_lower if num_lower > 1 else np.empty(0)
    upper = (np.arange(num_upper) + 1 + upper_offset) / num_upper if num_upper > 1 else np.empty(0)
    is_lower = np.concatenate([np.ones(len(lower), bool), np.zeros(len(upper), bool)])
    is_lower = is_lower[np.argsort(np.concatenate([lower, upper]), kind="stable")]
    done_lower = np.cumsum(is_lower) - is_lower
    done_upper = np.cumsum(~is_lower) - ~is_lower
    a, b = done_lower % num_lower, num_lower + done_upper % num_upper
    next_a, next_b = (done_lower + 1) % num_lower, num_lower + (done_upper + 1) % num_upper
    return np.where(is_lower[:, None], np.column_stack([a, next_a, b]), np.column_stack([a, next_b, b]))
