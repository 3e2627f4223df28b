"""Planes that are large enough to be mirrors, found and flagged in whole scenes."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import an, checked, real
from ..base.classes.made_once import MadeOnce
from ..base.text.node_names import unique
from .scene import Scene, changed_scene

LEAST_COHERENT = 0.1  # share of the reflected power that keeps its phase: rougher walls have next to no images
LEAST_AREA = 0.8      # share of a mesh's area that large planes make up: the rest, such as the ends of a wall, mirrors with it
LEAST_EXTENT = 4.0    # m, longest side of walls and houses; of what is shorter, which may be an object, more is asked:
LEAST_AREA_OF_SHORT = 0.95  # nearly all of it, and on two sides at most
VEHICLE_LENGTH, VEHICLE_WIDTH = 19.0, 2.6  # m, of road trains (18.75) and reefers (2.6) at most: directive 96/53/EC
MOST_SMALL_PLANES = 8  # that mirror with the large ones; more would cost time, as each has images of all that it sees
SMALL_PLANES = "small_planes"  # the mesh that they become


@checked(scene=changed_scene, radar=an(_core.Radar), time=real(unit="s"))
def mark_mirrors(scene: Scene, radar: _core.Radar, *, time: float = 0.0) -> tuple[str, ...]:
    """Flags what is made of planes larger than their Fresnel zone as mirrors, as `Material(mirror=True)` does one by one.

    Ghosts of small targets over walls and ground are then found by images, which rays alone nearly never hit. A mesh is
    flagged where planes at least as wide as 4 sqrt(wavelength distance), twice the zone, make up 80 % of its area, so that
    walls may be as thick as a fifth of their height; what is shorter than 4 m may be an object, as a crate or a table is,
    unless two such planes make up 95 % of it, and so may what has three or more such planes and the size of a road vehicle: 19 m
    by 2.6 m between the largest of them and what is opposite; but what is around the antennas, in more than half of all
    directions, is a room. The distance is that of the antennas from the farthest corner of the plane, the width four times
    the area over the length of the rim (the side of a square), windows and other holes counted to the rim. At least a tenth
    of what it reflects must keep its phase. Smooth meshes, sheets, and what moves or deforms stay as they are, and so do
    planes that only several meshes make up together. What has more than eight smaller planes, as a house with windows that
    are set back, is cut: they become a mesh below it, "house/small_planes", which keeps the material and is no object of labels.
    Each flagged plane costs time: paths go over up to two of them on each side of a target.

    scene: is changed
    radar: where its antennas are at `time`, and its wavelength at the start of the band
    time: s, at which the meshes stand where they are looked at
    Returns the names of the meshes that became mirrors, in the order of their mesh IDs. Raises TypeError or ValueError
    naming the argument.
    """
    with scene._edit():
        found = _found(scene, radar, time)
        names = tuple(_core.mesh_names(scene, [mesh_id for mesh_id, _ in found]))
        cuts, taken = MadeOnce(), dict.fromkeys(scene, 1)
        for name, (_, small) in zip(names, found):
            if small:
                _cut(scene, name, np.array(small), cuts, taken)
            node = scene[name]
            node._change(material=node._node.material.replace(mirror=True))  # of its own mesh alone, not of those below it
    return names


def _cut(scene, name: str, small: np.ndarray, cuts: MadeOnce, taken: dict[str, int]) -> None:
    """Moves triangles of a node's mesh into a mesh below it.

    cuts: the two parts of each mesh that was cut before; taken: full names, of `unique`
    """
    def parts_of(mesh):
        is_small = np.isin(np.arange(len(mesh.triangles)), small)
        return mesh.part(~is_small), mesh.part(is_small)

    node = scene[name]._node
    large_part, small_part = cuts.of(node.mesh, parts_of, small.tobytes())
    scene[name]._change(mesh=large_part)
    own_name = unique(f"{name}/{SMALL_PLANES}", taken).rpartition("/")[2]
    below = scene.add(small_part, name=own_name, parent=name, material=node.material)
    scene[below]._change(material_name=node.material_name)


def large_planes(scene: _core.Scene, radar: _core.Radar, time: float) -> list[int]:
    """IDs of the meshes that `mark_mirrors` would flag at a time in s."""
    return [mesh_id for mesh_id, _ in _found(scene, radar, time)]


def _found(scene, radar, time: float) -> list[tuple[int, list[int]]]:
    """(mesh ID, triangles of its small planes where these are many) of each."""
    wavelength = _core.speed_of_light / radar.waveform.start_frequency
    return _core.meshes_of_large_planes(scene, radar, wavelength, time, LEAST_COHERENT, LEAST_AREA, LEAST_EXTENT,
                                       LEAST_AREA_OF_SHORT, VEHICLE_LENGTH, VEHICLE_WIDTH, MOST_SMALL_PLANES)
