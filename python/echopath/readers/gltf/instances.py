"""Copies of the mesh of a node (Khronos Group, EXT_mesh_gpu_instancing)."""
from __future__ import annotations

import numpy as np

from ...base.numerics.rotations import matrices
from ..axes import Axes
from .accessors import FLOAT, Accessors
from .item import Item

INSTANCING = "EXT_mesh_gpu_instancing"
SIGNED = (5120, 5122)  # normalised numbers that rotations may also be
COPY_BYTES = 128       # of a transform


def instances_of(node: Item, accessors: Accessors, axes: Axes) -> np.ndarray | None:
    """Transforms [N, 4, 4] of the copies in the frame of their node, in axes and units of a scene; None for a node without.

    Each is a scale, then a rotation, then a translation, from accessors of the file; what is missing stays at rest.
    Raises FileError where a small file asks for much.
    """
    attributes = node["extensions"][INSTANCING]["attributes"] if INSTANCING in node["extensions"] else None
    given = {name: attributes[name] for name in ("TRANSLATION", "ROTATION", "SCALE") if name in attributes} if attributes else {}
    if not given:
        return None
    counts = {name: accessors.count(item) for name, item in given.items()}
    if len(set(counts.values())) > 1:
        attributes.fail(f"must have as many entries in each accessor, has {', '.join(f'{n} in {k}' for k, n in counts.items())}")
    numbers = {name: accessors.numbers(item, *(("VEC4", FLOAT + SIGNED) if name == "ROTATION" else ("VEC3", FLOAT)))
               for name, item in given.items()}
    count = next(iter(counts.values()))
    accessors.spend(COPY_BYTES * count, attributes)
    made = np.tile(np.eye(4), (count, 1, 1))
    if "ROTATION" in given:
        made[:, :3, :3] = matrices(axes.quaternions(_units(numbers["ROTATION"], given["ROTATION"])))
    if "SCALE" in given:
        made[:, :3, :3] *= axes.turned(numbers["SCALE"])[:, None, :]
    if "TRANSLATION" in given:
        made[:, :3, 3] = axes.points(numbers["TRANSLATION"])
    return made


def _units(rotations: np.ndarray, reference: Item) -> np.ndarray:
    """Quaternions [N, 4] (x, y, z, w) of length 1 of those that `reference` names."""
    lengths = np.linalg.norm(rotations, axis=1)
    if lengths.min() < 0.5 or lengths.max() > 2.0:
        reference.fail("must hold unit quaternions (x, y, z, w)")
    return rotations / lengths[:, None]
