"""How much room meshes of a scene take."""
from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .. import _core


def box_of(scene: _core.Scene, time: float = 0.0, mesh_ids: Iterable[int] | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest coordinates [3] in m of meshes of a scene at `time` in s; zeros where there are none.

    mesh_ids: of those that count, None: all
    """
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for mesh_id in range(len(scene.meshes)) if mesh_ids is None else mesh_ids:
        vertices = scene.world_vertices(mesh_id, time)
        low, high = np.minimum(low, vertices.min(axis=0)), np.maximum(high, vertices.max(axis=0))
    return (low, high) if np.isfinite(low).all() else (np.zeros(3), np.zeros(3))
