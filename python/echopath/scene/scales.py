"""How the axes of objects lie and are scaled in the world."""
from __future__ import annotations

import numpy as np


def linear_maps(nodes) -> np.ndarray:
    """[N, 3, 3], by which nodes, parents first, turn and scale the axes of their meshes at rest. Motions do not scale."""
    maps = np.array([node.placement for node in nodes]).reshape(-1, 4, 4)[:, :3, :3]
    parents, depths = [node.parent for node in nodes], []
    for parent in parents:
        depths.append(0 if parent < 0 else depths[parent] + 1)
    above, depth_of = np.array(parents, int), np.array(depths, int)
    for depth in range(1, max(depths, default=0) + 1):  # all nodes of one at once
        of_depth = np.flatnonzero(depth_of == depth)
        maps[of_depth] = maps[above[of_depth]] @ maps[of_depth]
    return maps
