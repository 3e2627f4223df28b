"""A slow tracer in plain NumPy: Moeller-Trumbore against every triangle, in double."""
import numpy as np


def closest_hit(origin, direction, triangles):
    """Nearest triangle [F, 3, 3] on a ray; (index, u, v, distance), index -1 for none."""
    v0, edge_u, edge_v = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    p = np.cross(direction, edge_v)
    determinant = np.einsum("fi,fi->f", edge_u, p)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = origin - v0
        u = np.einsum("fi,fi->f", s, p) / determinant
        q = np.cross(s, edge_u)
        v = q @ direction / determinant
        distance = np.einsum("fi,fi->f", edge_v, q) / determinant
    meets = (np.abs(determinant) > 1e-300) & (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > 1e-4)
    if not meets.any():
        return -1, 0.0, 0.0, np.inf
    index = int(np.argmin(np.where(meets, distance, np.inf)))
    return index, u[index], v[index], distance[index]


def segment_is_free(start, end, triangles, margin=1e-3):
    """No triangle between two points, `margin` (m) at both ends left out."""
    length = np.linalg.norm(end - start)
    direction = (end - start) / length
    index, _, _, distance = closest_hit(start + margin * direction, direction, triangles)
    return index < 0 or distance > length - 2 * margin
