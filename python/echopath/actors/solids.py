"""Closed bodies of few triangles: turned profiles, tubes and bodies of six sides. Plain arrays, as in surfaces.py."""
import numpy as np

from .surfaces import cross, joined, signed_volume


def revolved(profile, segments, *, arc=1.0):
    """A closed profile [(radius, y), ...] turned about the y axis in `segments` steps; points on the axis are poles.

    The profile's last point joins its first one, unless both lie on the axis. Front outwards.
    """
    profile = np.asarray(profile, dtype=float)
    count = len(profile)
    angle = 2.0 * np.pi * arc * np.arange(segments) / segments
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    vertices = np.empty((segments, count, 3))
    vertices[..., 0], vertices[..., 2] = circle[:, :1] * profile[:, 0], circle[:, 1:] * profile[:, 0]
    vertices[..., 1] = profile[:, 1]
    n, k = np.meshgrid(np.arange(segments), np.arange(count), indexing="ij")
    a, b = n * count + k, ((n + 1) % segments) * count + k
    c, d = ((n + 1) % segments) * count + (k + 1) % count, n * count + (k + 1) % count
    triangles = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], axis=-2).reshape(-1, 3)
    return outward(_without_slivers(*joined((vertices.reshape(-1, 3), triangles))))


def tube(start, end, radius, end_radius=None, *, segments=10):
    """A straight round bar from `start` to `end` [3] in m with flat ends; end_radius: where it tapers."""
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    length = float(np.linalg.norm(end - start))
    last = radius if end_radius is None else end_radius
    vertices, triangles = revolved([(0.0, 0.0), (radius, 0.0), (last, length), (0.0, length)], segments)
    return vertices @ axes_along(end - start).T + start, triangles


def axes_along(direction):
    """A rotation [3, 3] that takes +y to a direction [3]."""
    y = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    helper = np.array([0.0, 0.0, 1.0]) if abs(y[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    x = cross(y, helper)
    x /= np.linalg.norm(x)
    return np.stack([x, y, cross(x, y)], axis=-1)


def hexahedron(corners):
    """A closed body of six sides; corners [8, 3] in the order of a box's (x, y, z) from low to high, z fastest."""
    sides = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    triangles = np.concatenate([sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]])
    return outward((np.asarray(corners, dtype=float), triangles))


def block(low, high):
    """A box from the corner `low` to the corner `high` [3] in m."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    steps = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    return hexahedron(low + steps * (high - low))


def outward(surface):
    """A closed surface with its fronts outside."""
    vertices, triangles = surface
    return (vertices, triangles) if signed_volume(vertices, triangles) > 0 else (vertices, triangles[:, ::-1].copy())


def _without_slivers(vertices, triangles):
    """Triangles with three different corners."""
    a, b, c = triangles.T
    return vertices, triangles[(a != b) & (b != c) & (c != a)]


def round_segments(radius):
    """Segments of a round bar of `radius` m whose coherent echo at 77 GHz is right to 0.3 dB where it is smooth."""
    edge = 1.4 * np.sqrt(radius * 0.0039)   # 4 times 0.4 sqrt(radius wavelength) would do
    return max(14, int(np.ceil(2.0 * np.pi * radius / edge)))


def extruded(outline, length):
    """A closed outline [N, 2] of (y, z), counter-clockwise seen from +x, drawn along x from -length/2 to length/2.

    Its ends are closed by triangles between the first half of the outline's points and the second: for bent sheets, whose
    outline goes forth along one face and back along the other.
    """
    outline = np.asarray(outline, dtype=float)
    count = len(outline)
    vertices = np.concatenate([np.column_stack([np.full(count, x), outline]) for x in (-length / 2, length / 2)])
    k = np.arange(count)
    n = (k + 1) % count
    sides = np.concatenate([np.stack([k, n, count + n], -1), np.stack([k, count + n, count + k], -1)])
    k = np.arange(count // 2 - 1)
    m = count - 1 - k
    cap = np.concatenate([np.stack([k, m, m - 1], -1), np.stack([k, m - 1, k + 1], -1)])
    return outward((vertices, np.concatenate([sides, cap, cap[:, ::-1] + count])))


def ring(radius, tube_radius, segments, around=8, *, width=None):
    """A torus about the y axis: `radius` to the middle of its tube, whose half width along y is `width` (that of its radius)."""
    angle = 2.0 * np.pi * np.arange(around) / around
    half = tube_radius if width is None else width
    return revolved(np.column_stack([radius + tube_radius * np.cos(angle), half * np.sin(angle)]), segments)
