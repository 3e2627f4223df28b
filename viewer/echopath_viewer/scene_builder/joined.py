"""Several meshes of a scene as one."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np


class JoinedMeshes(NamedTuple):
    """points: [V, 3] m; triangles: [F, 3]; mesh_of_point: [V], mesh_of_triangle: [F], IDs of the meshes that they are of."""

    points: np.ndarray
    triangles: np.ndarray
    mesh_of_point: np.ndarray
    mesh_of_triangle: np.ndarray


def joined_meshes(session, meshes) -> JoinedMeshes:
    """Meshes, by their IDs, as they stand at the time on display."""
    points = [np.asarray(session.scene.world_vertices(int(mesh), session.time)) for mesh in meshes]
    triangles = [np.asarray(session.scene.meshes[mesh].triangles, np.int64) for mesh in meshes]
    begins = np.cumsum([0, *map(len, points)])
    return JoinedMeshes(np.concatenate([np.zeros((0, 3)), *points]),
                        np.concatenate([np.zeros((0, 3), np.int64), *(one + begin for one, begin in zip(triangles, begins))]),
                        _each(meshes, points), _each(meshes, triangles))


def _each(meshes, rows) -> np.ndarray:
    """The mesh of each row of each."""
    return np.repeat(np.asarray(meshes, np.int64), np.array([len(one) for one in rows], np.int64))
