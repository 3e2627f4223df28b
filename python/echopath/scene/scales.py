"""How the axes of objects lie and are scaled in the world."""
from __future__ import annotations

import numpy as np


def linear_maps(nodes) -> np.ndarray:
    """[N, 3, 3], by which nodes, parents first, turn and scale the axes of their meshes at rest. Motions do not scale."""
    maps: list[np.ndarray] = []
    for node in nodes:
        own = node.placement[:3, :3]
        maps.append(own if node.parent < 0 else maps[node.parent] @ own)
    return np.array(maps).reshape(-1, 3, 3)
