"""Where ghosts seem to be: the place that a radar would give each family of echoes that came by a detour."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep
from echopath import _core
from echopath.arguments.objects import named_globs
from echopath.paths.subset import strongest, subset
from echopath.plots.labels import CLASSES

from ..palette import rgb_of
from .attribution import name_of

MOST_TWINS = 8
MOST_PATHS = 200  # of a family, the strongest, whose mean is its place


@dataclasses.dataclass(frozen=True)
class GhostTwin:
    """A ghost of an object.

    name: object, way, type and order; object: its name; ghost_type: 1 or 2; meshes: IDs of the object
    offset: [3] m in the world, from where the object's own echo seems to be to where the ghost's does; power: W, sum of its paths
    """

    name: str
    object: str
    ghost_type: int
    meshes: tuple
    offset: np.ndarray
    power: float


def ghost_twins(paths, columns, objects=None) -> list[GhostTwin]:
    """The strongest ghosts, strongest first. objects: as in `ep.families`

    Model: an echo seems to be at its range, half of the length of its path, in the direction in which it arrives: that of its
    last hit from the receiver. A family is where the mean of its strongest paths is, weighted by power.
    """
    families, meshes_of = ep.families(paths, objects), _meshes_of(paths, objects)
    own, ghosts = {}, []
    for number, family in enumerate(families.families):
        mask = families.family_of_path == number
        if family.object and not family.is_ghost:
            own[family.object] = _apparent_place(paths, columns, mask)
        elif family.is_ghost:
            ghosts.append((float(columns.power[mask].sum()), family, mask))
    ghosts.sort(key=lambda one: -one[0])
    twins = []
    for power, family, mask in ghosts[:MOST_TWINS]:
        place, origin = _apparent_place(paths, columns, mask), own.get(family.object)
        meshes = tuple(meshes_of.get(family.object, ()))
        if not meshes:
            continue
        origin = _centre(paths, meshes) if origin is None else origin
        if place is not None:
            twins.append(GhostTwin(name_of(family), family.object, family.ghost_type, meshes, place - origin, power))
    return twins


def _meshes_of(paths, objects) -> dict:
    """{object: IDs of its meshes}, those of mirrors among them only where a call names them: a town that is one object would
    else be painted over by the twins of its ground."""
    if objects is not None:
        return _core.meshes_of_objects(paths.scene, named_globs(objects))
    time = paths.frame.trace_time if paths.frame.objects_time is None else paths.frame.objects_time
    return _core.meshes_of_usual_objects(paths.scene, paths.radar, time)


def twin_rows(twins) -> tuple:
    """Legend rows ((name, rgb), ...) of the types that there are."""
    return tuple((CLASSES[kind][0], rgb_of(CLASSES[kind][1])) for kind in sorted({twin.ghost_type for twin in twins}))


def _apparent_place(paths, columns, mask):
    """[3] m in the world, None where no path of `mask` [P] has power."""
    chosen = strongest(columns.power, MOST_PATHS, mask)
    if not len(chosen):
        return None
    is_chosen = np.zeros(len(mask), bool)
    is_chosen[chosen] = True
    kept, rows, radar, time = subset(paths, is_chosen), np.flatnonzero(is_chosen), paths.radar, paths.frame.trace_time
    last = np.asarray(kept.offsets) + np.asarray(kept.num_bounces).astype(np.int64) - 1
    hits = np.asarray(kept.points(time)).reshape(-1, 3)[last]
    world = np.asarray(radar.world_from_radar(time))
    receiver = world[:3, :3] @ np.asarray(radar.receivers[columns.rx].position) + world[:3, 3]
    way = hits - receiver
    places = receiver + columns.range[rows, None] * way / np.linalg.norm(way, axis=1, keepdims=True)
    return np.average(places, axis=0, weights=columns.power[rows])


def _centre(paths, meshes):
    """[3] m, of the box around meshes."""
    points = np.concatenate([paths.scene.world_vertices(mesh, paths.frame.trace_time) for mesh in meshes])
    return 0.5 * (points.min(axis=0) + points.max(axis=0))
