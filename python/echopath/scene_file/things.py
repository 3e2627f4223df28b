"""What of a foreign scene its labels tell apart: things as large as vehicles, not walls and grounds."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..readers.sizes import box_of
from ..scene.large_planes import VEHICLE_LENGTH, large_planes
from ..scene.scene import Scene

THICKEST = 4.5  # m, of the second longest side: what stands yawed takes more than the 4 m of a lorry
MOST = 40  # named one by one: a whole city would make a file of names


Things = dict[str, list[int]]  # {name of a node: IDs of the meshes below it}


def things_of(scene: Scene) -> Things:
    """The nodes of a scene that are no larger than a vehicle at time 0: of those below the first node that has several.

    scene: one object, with all else below it
    """
    of_thing: Things = {}
    depth = _depth_of_several([mesh.name.split("/") for mesh in scene.meshes])
    for mesh in scene.meshes:
        of_thing.setdefault("/".join(mesh.name.split("/")[:depth]), []).append(mesh.id)
    return {name: meshes for name, meshes in of_thing.items() if _is_thing(*box_of(scene, 0.0, meshes))}


def told_apart(scene: Scene, things: Things, radar: _core.Radar) -> list[str]:
    """Names of the things that are objects of labels: what `mark_mirrors` flags is none. Nothing where that is one alone, or
    more than MOST.

    radar: where it stands, with its wavelength
    """
    mirrors = set(large_planes(scene, radar, 0.0))
    found = [name for name, meshes in things.items() if mirrors.isdisjoint(meshes) and not set("*?[") & set(name)]
    return found if 2 <= len(found) <= MOST else []


def _depth_of_several(names: list[list[str]]) -> int:
    """How many segments of the names [M] it takes until they differ; all, where they never do."""
    deepest = max(map(len, names), default=1)
    return next((depth for depth in range(1, deepest) if len({tuple(name[:depth]) for name in names}) > 1), deepest)


def _is_thing(low, high) -> bool:
    """Whether a box between two corners is as long as a vehicle at most, and as high or wide as one, or slender, as a pole."""
    sides = np.sort(high - low)
    return bool(sides[2] <= VEHICLE_LENGTH and sides[1] <= THICKEST)
