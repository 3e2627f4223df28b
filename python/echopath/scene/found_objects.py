"""What of a scene labels tell apart, also within a town that was read as one object: things as large as vehicles."""
from __future__ import annotations

from collections import Counter
from os.path import commonprefix
from typing import NamedTuple

import numpy as np

from .. import _core
from ..arguments.checks import an, checked, optional, real
from ..arguments.frame_times import require_motion
from .boxes import box_of
from .large_planes import VEHICLE_LENGTH, large_planes

THICKEST = 4.5  # m, of the second longest side: what stands yawed takes more than the 4 m of a lorry
GAP = 0.1    # m, along the axis that separates two boxes most: parts of one body touch

Box = tuple[np.ndarray, np.ndarray]  # least and greatest coordinates [3], m
Things = dict[str, list[int]]        # {name of a node: IDs of the meshes below it}


@checked(scene=an(_core.Scene), radar=an(_core.Radar), time=optional(real(unit="s")))
def find_objects(scene: _core.Scene, radar: _core.Radar, *, time: float | None = None) -> dict[str, str]:
    """Finds what labels of a scene tell apart: its usual objects, and what stands in a town that was read as one.

    Usual objects are those that `families` has by itself, children of the scene's root. One that is larger than a road vehicle
    (19 m long, and 4.5 m across, or slender, as a pole) and whose parts stand apart, as those of a parked row do, gives way to
    its parts; of groups in it that reach through each other, what is in them counts. A child that surrounds the radar, as a
    town, a room or a tunnel does, is no object: here the things in it are, the nodes below the first one that has several, or
    below a larger one whose parts stand apart, as far as they are no larger than a vehicle. A mesh is never cut. What carries
    the radar is no larger itself, and has no things. No thing or part is what is a mirror or such as `mark_mirrors` would flag.

    scene: of `Scene`, of `load_scene` or of a record; radar: with its antennas in the scene
    time: s, at which it is looked at, with its antennas and all that moves; None: the middle of a frame that starts at 0.
        What is absent then (`SceneNode.lifetime`) surrounds nothing, but is named: other frames may have it
    Returns {name: glob}, to be given as `objects` of `families`, `annotate`, `simulate` and others: names of children of the
    root as they are, of others the last part of their path where no other object has it, else the whole path. Raises TypeError
    or ValueError naming the argument.
    """
    time = radar.middle_of_frame() if time is None else time
    require_motion("radar", radar, (time,))
    usual = _core.meshes_of_usual_objects(scene, radar, time)
    names = _names_of(scene, radar, usual, time)
    lasts = Counter(name.split("/")[-1] for name in names)
    return {name if lasts[last := name.split("/")[-1]] > 1 else last: name for name in names}


def things_of(scene: _core.Scene) -> Things:
    """The nodes that are no larger than a vehicle at time 0, of those below the first node that has several, and of those below
    larger ones of these whose parts stand apart, as the cars of a group do and the walls of a house do not."""
    return {part.name: list(part.meshes) for part in _things_among(_everything(scene, 0.0).parts())}


def _names_of(scene: _core.Scene, radar: _core.Radar, usual: Things, time: float) -> list[str]:
    """Names of the usual objects, or of their parts, and of the things in what surrounds the radar."""
    of_usual = {mesh: name for name, meshes in usual.items() for mesh in meshes}
    found = []
    for child in _everything(scene, time).parts(depth=1):
        own = child.among(of_usual)
        found += _things_of_usual(own, child) if own.meshes else []
        rest = child.without(of_usual)
        found += _things_among(rest.parts()) if rest.meshes and not child.is_thing else []
    mirrors = {mesh.id for mesh in scene.meshes if mesh.material.mirror}.union(
        _core.meshes_cut_from_mirrors(scene), large_planes(scene, radar, time))
    return [part.name for part in found if part.name in usual or mirrors.isdisjoint(part.meshes)]


def _things_of_usual(own: _Part, child: _Part) -> list[_Part]:
    """Of a usual object, some or all of a child of the root: a child of which the rest are mirrors, as a room, is as little an
    object as one around the radar, where its parts stand apart."""
    below = own.parts() if len(own.meshes) < len(child.meshes) else []
    finer = _expanded(below)
    if len(below) == 1 or _stand_apart(below) or _stand_apart(finer):
        return [part for part in finer if part.is_thing]
    return _things_among([own], keeps_larger=True)


class _Part(NamedTuple):
    """A node and what is below it. meshes: {ID: the segments of its name}; boxes: {ID: its Box}, of all meshes"""

    name: str
    meshes: dict[int, list[str]]
    boxes: dict[int, Box]

    def parts(self, depth: int | None = None) -> list[_Part]:
        """The nodes below the first one that has several, or `depth` segments below the root."""
        depth = depth or _depth_of_several(list(self.meshes.values()))
        found: dict[str, dict[int, list[str]]] = {}
        for mesh, path in self.meshes.items():
            found.setdefault("/".join(path[:depth]), {})[mesh] = path
        return [self._replace(name=name, meshes=meshes) for name, meshes in found.items()]

    def among(self, some) -> _Part:
        """Its meshes that are among some."""
        return self._replace(meshes={mesh: path for mesh, path in self.meshes.items() if mesh in some})

    def without(self, some) -> _Part:
        return self._replace(meshes={mesh: path for mesh, path in self.meshes.items() if mesh not in some})

    @property
    def box(self) -> Box:
        lows, highs = zip(*(self.boxes[mesh] for mesh in self.meshes))
        return np.min(lows, axis=0), np.max(highs, axis=0)

    @property
    def is_thing(self) -> bool:
        """Whether it is as long as a vehicle at most, and as high or wide as one, or slender, as a pole."""
        low, high = self.box
        sides = np.sort(high - low)
        return bool(sides[2] <= VEHICLE_LENGTH and sides[1] <= THICKEST)


def _everything(scene: _core.Scene, time: float) -> _Part:
    return _Part("", {mesh.id: mesh.name.split("/") for mesh in scene.meshes},
                 {mesh.id: box_of(scene, time, [mesh.id]) for mesh in scene.meshes})


def _things_among(parts: list[_Part], keeps_larger: bool = False) -> list[_Part]:
    """Those of some parts that are things, in their order, and those below larger ones whose own parts stand apart.

    keeps_larger: whether larger ones whose parts do not are among them
    """
    return [part for part in _expanded(parts) if part.is_thing or keeps_larger]


def _expanded(parts: list[_Part]) -> list[_Part]:
    """Some parts, in the place of each larger one what is below it, expanded likewise, where that stands apart, before or after:
    the groups of a town by kind, such as its bins and its trams, reach through each other, while what is in them does not."""
    expanded = []
    for part in parts:
        below = [] if part.is_thing else part.parts()
        finer = _expanded(below) if len(below) > 1 else []
        expanded += finer if _stand_apart(below) or _stand_apart(finer) else [part]
    return expanded


def _depth_of_several(names: list[list[str]]) -> int:
    """How many segments of the names [M] it takes until they differ; all, where they never do."""
    deepest = max(map(len, names), default=1)
    return min(len(commonprefix(names)) + 1, deepest)


def _stand_apart(parts: list[_Part]) -> bool:
    """Whether they are several, and the boxes of more than half of them are farther than GAP from all others."""
    if len(parts) < 2:
        return False
    lows, highs = map(np.array, zip(*(part.box for part in parts)))
    order = np.argsort(lows[:, 0])
    lows, highs = lows[order], highs[order]
    ends = np.searchsorted(lows[:, 0], highs[:, 0] + GAP, side="right")  # of those that begin along x before each one ends
    is_near = np.zeros(len(parts), bool)
    for one, end in enumerate(ends):
        others = slice(one + 1, end)
        near = (np.maximum(lows[others] - highs[one], lows[one] - highs[others]) <= GAP).all(axis=1)
        is_near[others] |= near
        is_near[one] |= near.any()
    return 2 * np.count_nonzero(is_near) < len(parts)
