"""Points of surfaces, spread by area: the same points of the material at every time."""
from __future__ import annotations

import dataclasses

import numpy as np

from ..base.numerics.triangles import areas_of

_STEPS = 0.7548776662466927 ** np.array([1.0, 2.0])  # 1/g and 1/g^2 with g^3 = g + 1: an even sequence in the square


@dataclasses.dataclass(frozen=True)
class SurfacePoints:
    """Points of triangles of a scene.

    mesh_ids: [N]; corners: [N, 3], vertices of the mesh; weights: [N, 3], of the corners, whose sum is 1
    """

    mesh_ids: np.ndarray
    corners: np.ndarray
    weights: np.ndarray

    def __len__(self) -> int:
        return len(self.mesh_ids)

    def __getitem__(self, chosen) -> SurfacePoints:
        return SurfacePoints(self.mesh_ids[chosen], self.corners[chosen], self.weights[chosen])

    def at(self, scene, time) -> np.ndarray:
        """Where they are at a time in s: [N, 3], m, world."""
        places = np.zeros((len(self), 3))
        for mesh_id in np.unique(self.mesh_ids):
            own = self.mesh_ids == mesh_id
            corners = scene.world_vertices(int(mesh_id), time)[self.corners[own]]
            places[own] = np.einsum("nk,nkx->nx", self.weights[own], corners)
        return places


def surface_points(scene, meshes, time, count) -> SurfacePoints:
    """As many points of some SceneMesh as `count`, each for the same area at a time in s; none where there is no area.

    They lie in the order of the triangles, evenly over their areas, and within triangles by an even sequence.
    """
    corners = np.concatenate([mesh.triangles for mesh in meshes])
    mesh_ids = np.repeat([mesh.id for mesh in meshes], [len(mesh.triangles) for mesh in meshes])
    areas = np.concatenate([areas_of(scene.world_vertices(mesh.id, time)[mesh.triangles]) for mesh in meshes])
    if not areas.sum() > 0.0:
        return SurfacePoints(mesh_ids[:0], corners[:0], np.zeros((0, 3)))
    upto = np.cumsum(areas)
    chosen = np.searchsorted(upto, (np.arange(count) + 0.5) / count * upto[-1])
    return SurfacePoints(mesh_ids[chosen], corners[chosen], _even_weights(count))


def _even_weights(count) -> np.ndarray:
    """[N, 3], of points that lie evenly in triangles: the square's other half is folded over."""
    across = ((np.arange(count)[:, None] + 0.5) * _STEPS) % 1.0
    across = np.where(across.sum(axis=-1, keepdims=True) > 1.0, 1.0 - across, across)
    return np.column_stack([1.0 - across.sum(axis=-1), across])
