"""What of a foreign scene its labels tell apart: things as large as vehicles, not walls and grounds."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..scene.large_planes import VEHICLE_LENGTH, large_planes
from ..scene.scene import Scene

THICKEST = 4.5  # m, of the second longest side: what stands yawed takes more than the 4 m of a lorry
MOST = 40  # named one by one: a whole city would make a file of names


def things_of(scene: Scene, radar: _core.Radar) -> list[str]:
    """Names of the nodes of a scene that are told apart as objects, at time 0: those below the first that has several, without
    what `mark_mirrors` flags and what is larger than a vehicle. Nothing where that is one alone, or more than MOST.

    scene: one object, with all else below it; radar: where it stands, with its wavelength
    """
    mirrors = set(large_planes(scene, radar, 0.0))
    of_thing: dict[str, list[int]] = {}
    depth = _depth_of_several([mesh.name.split("/") for mesh in scene.meshes])
    for mesh in scene.meshes:
        of_thing.setdefault("/".join(mesh.name.split("/")[:depth]), []).append(mesh.id)
    found = [name for name, meshes in of_thing.items()
             if mirrors.isdisjoint(meshes) and not set("*?[") & set(name) and _is_thing(scene, meshes)]
    return found if 2 <= len(found) <= MOST else []


def _depth_of_several(names: list[list[str]]) -> int:
    """How many segments of the names [M] it takes until they differ; all, where they never do."""
    deepest = max(map(len, names), default=1)
    return next((depth for depth in range(1, deepest) if len({tuple(name[:depth]) for name in names}) > 1), deepest)


def _is_thing(scene: Scene, meshes: list[int]) -> bool:
    """Whether the box about some meshes is as long as a vehicle at most, and as high or wide as one, or slender, as a pole."""
    sides = np.sort(np.ptp(np.concatenate([scene.world_vertices(mesh, 0.0) for mesh in meshes]), axis=0))
    return bool(sides[2] <= VEHICLE_LENGTH and sides[1] <= THICKEST)
