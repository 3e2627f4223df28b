"""Single rays that stand for the image of a whole surface in a large plane.

Model: a rough surface sends its echo over a plane mostly in ways that end at the plane near the one point of reflection. A
ray from the surface meets this point next to never, and where it does, it counts for all that missed: such a path is an echo
of its own in the map. Rough surfaces over flagged mirrors are found by images, with as many paths as all others.
"""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.settings import LabelSettings
from ..base.numerics.decibels import in_dbm
from ..base.text.mesh_names import object_of
from ..paths.subset import subset
from ..scene.large_planes import large_planes
from .check import Check

NAME = "single rays over planes that are no mirrors"
LEAST_SHARE = 0.5  # of what an object sends over planes, in one way and its reverse: it stands for the others
_NAMED = 3         # objects, and planes, of which the advice tells


def check_planes(paths: _core.Paths, window) -> list[Check]:
    """How far the strongest of such paths stands above the noise in a cell of the map.

    paths: of a trace; window: of the map, as in `range_doppler`
    Returns list [C] of one Check, where one path stands for all that an object with rough surfaces sends over large planes
    that are no mirrors; else []. Its promise is the margin from which on labels take a cell for more than noise, its advice
    names objects and planes.
    """
    chosen = _over_surfaces(paths)
    if not len(chosen):
        return []
    planes = large_planes(paths.scene, paths.radar, paths.frame.trace_time)
    is_plane = np.zeros(len(paths.scene.meshes), bool)
    is_plane[planes] = True
    over = _Legs(paths, chosen).met_as_mirrors(is_plane)
    return _checks_of(paths, chosen[over], is_plane, window) if over.any() else []


def _over_surfaces(paths):
    """Indices of the paths of several hits, some rough and some not, that rays found."""
    several = np.flatnonzero((paths.diffuse != 0) & (paths.num_bounces > 1))
    all_rough = (np.uint64(1) << paths.num_bounces[several].astype(np.uint64)) - np.uint64(1)
    return several[paths.diffuse[several] != all_rough]


class _Legs:
    """The hits of chosen paths, column by column."""

    def __init__(self, paths, chosen):
        self._first, self._count = paths.offsets[chosen], paths.num_bounces[chosen].astype(np.int64)
        self._rough, self._mesh_id = paths.diffuse[chosen], paths.mesh_id

    def columns(self):
        """(paths that have such a hit, mesh of it, whether it is rough), hit by hit."""
        for hit in range(int(self._count.max(initial=0))):
            has = np.flatnonzero(self._count > hit)
            yield has, self._mesh_id[self._first[has] + hit], (self._rough[has] >> np.uint64(hit)) & np.uint64(1) == 1

    def met_as_mirrors(self, is_plane):
        """Whether a path goes over one of the planes as over a mirror, bool [P]. is_plane: [meshes]"""
        met = np.zeros(len(self._first), bool)
        for has, mesh, rough in self.columns():
            met[has] |= is_plane[mesh] & ~rough
        return met

    def first_mesh(self, where):
        """The first mesh of each path for which `where(mesh, rough)` is true, [P]; -1: none."""
        found = np.full(len(self._first), -1)
        for has, mesh, rough in self.columns():
            new = (found[has] < 0) & where(mesh, rough)
            found[has[new]] = mesh[new]
        return found


def _checks_of(paths, chosen, is_plane, window) -> list[Check]:
    """Of paths over planes. is_plane: [meshes]"""
    power = np.abs(subset(paths, chosen).amplitude) ** 2
    noise = _core.cell_noise_power(paths.radar, window)
    objects, of_path = _objects(paths, _Legs(paths, chosen).first_mesh(lambda mesh, rough: rough))
    strongest = np.zeros(len(objects))
    np.maximum.at(strongest, of_path, power)
    # Most ways occur twice, there and back.
    stands_for_all = 2.0 * strongest >= LEAST_SHARE * np.bincount(of_path, power, len(objects))
    level_db = in_dbm(np.where(stands_for_all, strongest, 0.0)) - in_dbm(noise)
    if not np.isfinite(level_db.max()):
        return []
    promise = LabelSettings.noise_margin_db
    loud = np.flatnonzero(level_db > promise)
    alone = chosen[np.isin(of_path, loud) & (power == strongest[of_path])]
    planes = np.unique(_Legs(paths, alone).first_mesh(lambda mesh, rough: is_plane[mesh] & ~rough))
    advice = _advice([objects[k] for k in loud[np.argsort(-level_db[loud])]],
                     _core.mesh_names(paths.scene, planes.tolist())) if len(loud) else ""
    return [Check(NAME, float(level_db.max()), promise, "dB over the noise", len(chosen), advice)]


def _objects(paths, meshes):
    """(names of the objects of meshes [P], index of each path's [P])."""
    used, which = np.unique(meshes, return_inverse=True)
    objects = [object_of(name) for name in _core.mesh_names(paths.scene, used.tolist())]
    names, index = np.unique(objects, return_inverse=True)
    return names.tolist(), index[which]


def _advice(objects: list, planes: list) -> str:
    return (f"the echoes of {_listed(objects)} over {_listed(planes)} rest on single rays, which stand out of the noise and may "
            "be detected as objects that are not there: flag such planes as mirrors, by mirror=True in their materials or all "
            "at once by ep.mark_mirrors(scene, radar), mark_mirrors = true in a scene file")


def _listed(names: list) -> str:
    shown = [f"'{name}'" for name in names[:_NAMED]]
    if len(names) > len(shown):
        shown.append(f"{len(names) - len(shown)} more")
    return " and ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown)
