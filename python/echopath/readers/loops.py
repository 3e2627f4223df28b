"""Poses of a model over a loop of its animation, and what is said of one that does not end as it begins."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import _core
from .model import Model

LAST = 1.0 - 1e-9  # share of a loop at its last pose
CLOSED = 1e-6      # of the size, by which the last pose may differ from the first
JUMPS = "the last pose is not the first"  # how the note begins


def note_of_jump(model: Model) -> list[str]:
    """A sentence on a looped animation whose last pose is not its first, with how far vertices are apart; none for others."""
    periods = [moving.period for moving in all_moving(model) if getattr(moving, "period", None)]
    if not periods:
        return []
    first, last = poses_of_loop(model, periods[0], (0.0, LAST))
    jump, size = float(np.linalg.norm(last - first, axis=1).max()), float(np.ptp(first, axis=0).max())
    return [f"{JUMPS}: vertices jump by up to {jump:.2g} m wherever the loop begins anew"] if jump > CLOSED * size else []


def all_moving(model: Model) -> Iterator:
    """What follows the animation's clock: the motions of nodes and joints, and the shares of morph targets."""
    for node in model.nodes:
        skin = node.deformation if isinstance(node.deformation, _core.Skin) else None
        joints = [] if skin is None else [*(joint.motion for joint in skin.joints), skin.shape]
        for moving in (node.motion, *joints, None if skin else node.deformation):
            if moving is not None:
                yield moving


def poses_of_loop(model: Model, period: float, shares) -> np.ndarray:
    """Vertices [N, V, 3] in m of all meshes at shares [N] of a loop of `period` s, from 0 to below 1, wherever the whole goes."""
    begin = -min(getattr(moving, "offset", 0.0) for moving in all_moving(model))
    return np.array([_vertices_at(model, begin + period * share) for share in shares])


def _vertices_at(model: Model, time: float) -> np.ndarray:
    """[V, 3] in m of all meshes in the model's axes at a time in s."""
    model_from_node, vertices = [], []
    for node in model.nodes:
        own = np.eye(4) if node.placement is None else node.placement.copy()
        if node.motion is not None:  # about the origin of the node, in the axes of its parent
            place, own[:3, 3] = own[:3, 3].copy(), 0.0
            own = node.motion.at(time) @ own
            own[:3, 3] += place
        model_from_node.append(own if node.parent < 0 else model_from_node[node.parent] @ own)
        if node.mesh is not None:
            shape = node.mesh.vertices if node.deformation is None else node.deformation.at(time)
            vertices.append(shape @ model_from_node[-1][:3, :3].T + model_from_node[-1][:3, 3])
    return np.concatenate(vertices)
