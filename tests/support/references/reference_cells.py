"""Points of surfaces for slow sums: triangles cut into small cells, on the curved surfaces that smooth meshes stand for; and
what stands in the way, by trying all triangles."""
import dataclasses
import functools

import numpy as np

CLEAR = 1e-6  # m: both ends of a segment that are not looked at


@dataclasses.dataclass
class Cells:
    """Cells of surfaces: points [M, 3], normals [M, 3], areas [M] in m^2, mesh [M], triangle [M] among all; facets [M, 3]:
    the points of the flat triangles below, from which shadows are looked for; bent [M]: whether they lie on curved surfaces."""

    points: np.ndarray
    normals: np.ndarray
    areas: np.ndarray
    mesh: np.ndarray
    triangle: np.ndarray
    facets: np.ndarray
    bent: np.ndarray


def cells_of(corners, normals, pieces, mesh, triangle):
    """Cells [pieces^2] of one triangle of corners [3, 3]; normals [3, 3] of its vertices, or None where it is flat."""
    weights = _grid(pieces)
    facets, edges = weights @ corners, corners[1:] - corners[0]
    if normals is None:
        points, (along_u, along_v) = facets, np.broadcast_to(edges[:, None], (2, len(facets), 3))
    else:
        points, (along_u, along_v) = _lifted(facets, edges, corners, normals, weights)
    across = cross(along_u, along_v)
    areas = 0.5 * lengths_of(across) / len(weights)
    return Cells(points, unit(across if normals is None else weights @ normals), areas, np.full(len(points), mesh),
                 np.full(len(points), triangle), facets, np.full(len(points), normals is not None))


def _lifted(facets, edges, corners, normals, weights):
    """p' = p + 1/2 sum b_i [(p_i - p).n_i] n_i [M, 3] and its derivatives to the second and third weight."""
    heights = np.einsum("mij,ij->mi", corners - facets[:, None], normals)
    derivatives = []
    for k, edge in enumerate(edges):
        change = np.array([-1.0, 1.0 - k, float(k)])
        derivatives.append(edge + 0.5 * (change * heights - weights * (normals @ edge)) @ normals)
    return facets + 0.5 * (weights * heights) @ normals, derivatives


def joined(parts):
    """One Cells of several."""
    names = [field.name for field in dataclasses.fields(Cells)]
    return Cells(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


@functools.lru_cache
def _grid(pieces):
    """Barycentric middles [pieces^2, 3] of equal small triangles."""
    weights = []
    for i in range(pieces):
        for j in range(pieces - i):
            weights.append(((i + 1 / 3) / pieces, (j + 1 / 3) / pieces))
            if i + j < pieces - 1:
                weights.append(((i + 2 / 3) / pieces, (j + 2 / 3) / pieces))
    uv = np.array(weights)
    return np.column_stack([1 - uv.sum(axis=1), uv])


def unit(vectors):
    """Vectors [..., 3] of length 1; zero stays zero."""
    length = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]
    return vectors / np.where(length > 0, length, 1.0)


def lengths_of(vectors):
    """Lengths of vectors [M, 3]; np.linalg.norm takes several times as long."""
    return np.sqrt(np.einsum("ij,ij->i", vectors, vectors))


def cross(a, b):
    """Cross products of vectors [..., 3]; np.cross takes several times as long."""
    a, b = np.asarray(a), np.asarray(b)
    return np.stack([a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1], a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
                     a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]], axis=-1)


def inside(points, triangle, margin=1e-12):
    """Whether points [M, 3] of a triangle's plane lie in it."""
    a, b, c = triangle
    normal = cross(b - a, c - a)
    to_u, to_v = np.array([cross(c - a, normal), cross(normal, b - a)]) / (normal @ normal)
    from_a = points - a
    u, v = from_a @ to_u, from_a @ to_v
    return (u >= -margin) & (v >= -margin) & (u + v <= 1 + margin)


def blocked(starts, ends, corners, own, leave_out=()):
    """Whether a triangle [F, 3, 3] meets the open segments between points [M, 3]; own: triangle [M] that does not count."""
    line = ends - starts
    found = np.zeros(len(starts), bool)
    with np.errstate(divide="ignore", invalid="ignore"):  # no share of a line along the plane lies between its ends
        near = CLEAR / lengths_of(line)
        far = 1 - near
        for index, (a, b, c) in enumerate(corners):
            if index in leave_out:
                continue
            normal = cross(b - a, c - a)
            share = (a @ normal - starts @ normal) / (line @ normal)
            between = np.flatnonzero((share > near) & (share < far) & (own != index))
            if len(between):
                point = starts[between] + share[between, None] * line[between]
                found[between[inside(point, corners[index])]] = True
    return found
