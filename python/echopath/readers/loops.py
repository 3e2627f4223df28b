"""Poses of a model over a loop of its animation, and what is said of one that does not end as it begins."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import _core
from .model import Model
from .sampled import CLOSED

END = 1e-9              # share of a loop before its end, at which its last pose is taken
ROUNDING = 2.0 ** -50   # of times, as a share
JUMPS = "the last pose is not the first"  # how the note begins


def note_of_jump(model: Model) -> list[str]:
    """A sentence on a looped animation whose last pose is not its first, with how far vertices are apart; none for others."""
    period = next((moving.period for moving in all_moving(model) if getattr(moving, "period", None)), None)
    if period is None:
        return []
    times = _begin(model) + period * np.array([0.0, 1.0 / 3.0, 2.0 / 3.0, _last(model, period)])
    jump = max(map(_jump, _poses_of_moving(model, times)), default=0.0)
    return [f"{JUMPS}: vertices jump by up to {jump:.2g} m wherever the loop begins anew"] if jump else []


def _jump(poses: np.ndarray) -> float:
    """m, the farthest that a vertex of a mesh is at last from where it was at first; 0 where that is little beside what the mesh
    sweeps. poses: [N, V, 3] m"""
    jump = float(np.linalg.norm(poses[-1] - poses[0], axis=1).max())
    return jump if jump > CLOSED * np.ptp(poses.reshape(-1, 3), axis=0).max() else 0.0


def _begin(model: Model) -> float:
    """s, when a loop begins."""
    return -min(getattr(moving, "offset", 0.0) for moving in all_moving(model))


def _last(model: Model, period: float) -> float:
    """The share of a loop at which its last pose is taken: beyond what rounds a time of the loop to the next one."""
    return 1.0 - max(END, ROUNDING * abs(_begin(model)) / period)


def all_moving(model: Model) -> Iterator:
    """What follows the animation's clock: the motions of nodes and joints, and the shares of morph targets."""
    for node in model.nodes:
        skin = node.deformation if isinstance(node.deformation, _core.Skin) else None
        joints = [] if skin is None else [*(joint.motion for joint in skin.joints), skin.shape]
        for moving in (node.motion, *joints, None if skin else node.deformation):
            if moving is not None:
                yield moving


def poses_of_loop(model: Model, period: float, num_steps: int) -> np.ndarray:
    """Vertices [num_steps + 1, V, 3] in m of all meshes at even shares of a loop of `period` s, wherever the whole goes."""
    times = _begin(model) + period * np.linspace(0.0, _last(model, period), num_steps + 1)
    all_nodes = np.ones(len(model.nodes), bool)
    poses = []
    for time in times:
        model_from_node = _model_from_nodes(model, time, all_nodes)
        poses.append(np.concatenate([_vertices(node, model_from_node[index], time)
                                     for index, node in enumerate(model.nodes) if node.mesh is not None]))
    return np.array(poses)


def _poses_of_moving(model: Model, times) -> Iterator[np.ndarray]:
    """[N, V, 3] m of each mesh that moves, at N times in s: one at a time, as there may be many instances of large ones."""
    moves = np.zeros(len(model.nodes), bool)
    for index, node in enumerate(model.nodes):
        moves[index] = node.motion is not None or node.deformation is not None or (node.parent >= 0 and moves[node.parent])
    needed = moves.copy()
    for index in np.flatnonzero(moves):
        while (index := model.nodes[index].parent) >= 0 and not needed[index]:
            needed[index] = True
    frames = [_model_from_nodes(model, time, needed) for time in times]
    for index, node in enumerate(model.nodes):
        if node.mesh is not None and moves[index]:
            yield np.array([_vertices(node, frame[index], time) for frame, time in zip(frames, times)])


def _model_from_nodes(model: Model, time: float, needed) -> dict[int, np.ndarray]:
    """{index: [4, 4], model from node} at a time in s of the nodes that are `needed` [N], with those above them."""
    found: dict[int, np.ndarray] = {}
    for index in np.flatnonzero(needed):
        node = model.nodes[index]
        own = np.eye(4) if node.placement is None else node.placement.copy()
        if node.motion is not None:  # about the origin of the node, in the axes of its parent
            place, own[:3, 3] = own[:3, 3].copy(), 0.0
            own = node.motion.at(time) @ own
            own[:3, 3] += place
        found[index] = own if node.parent < 0 else found[node.parent] @ own
    return found


def _vertices(node, model_from_node: np.ndarray, time: float) -> np.ndarray:
    """[V, 3] in m of a node's mesh in the model's axes at a time in s."""
    shape = node.mesh.vertices if node.deformation is None else node.deformation.at(time)
    return shape @ model_from_node[:3, :3].T + model_from_node[:3, 3]
