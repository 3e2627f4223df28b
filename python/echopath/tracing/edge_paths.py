"""A word on paths around sharp edges so many that signals of them take long."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.process.callers import warn_user
from ..base.text.counts import rounded
from ..paths.edge_hits import first_edge_hit, is_around_edge
from ..paths.subset import subset

SECONDS_OF_PATH = 1e-5     # of one thread for a channel, measured in a street; other paths take a tenth of that
LONG = 5.0                 # s of one thread, from which on signals are worth a word
_NAMED = 3                 # mirrors of which it tells, those that most of the paths meet


def warn_of_edge_paths(paths: _core.Paths) -> None:
    """Warns (RuntimeWarning) where a signal of the paths around sharp edges takes long: of how many edges and over which
    mirrors they are, and what to do."""
    if not paths.frame.edges:
        return
    around = np.flatnonzero(is_around_edge(paths))
    radar = paths.radar
    seconds = SECONDS_OF_PATH * len(around) * len(radar.transmitters) * len(radar.receivers)
    if seconds > LONG:
        warn_user(f"about {rounded(len(around)):,} paths go around {rounded(_num_edges(paths, around)):,} sharp edges"
                  f"{_over_mirrors(paths, around)}: each signal of them takes about {rounded(seconds)} s of processor time. "
                  "edges=False leaves them out")


def _num_edges(paths, around) -> int:
    """Triangles whose edges these paths meet first."""
    hit = paths.offsets[around] + first_edge_hit(paths)[around]
    return len(np.unique(paths.mesh_id[hit].astype(np.int64) << 32 | paths.triangle_id[hit]))


def _over_mirrors(paths, around) -> str:
    """Over which mirrors most of the paths go; "" where most go over none."""
    meshes = paths.scene.meshes
    is_mirror = np.array([mesh.material.mirror for mesh in meshes])
    own = subset(paths, around)  # with the hits of these paths alone
    met = np.bincount(own.mesh_id, minlength=len(meshes)) * is_mirror
    before = np.concatenate([[0], np.cumsum(is_mirror[own.mesh_id])])
    if 2 * np.count_nonzero(before[own.offsets + own.num_bounces] > before[own.offsets]) <= len(around):
        return ""
    names = [f"'{meshes[index].name}'" for index in np.argsort(-met, kind="stable")[:np.count_nonzero(met)]]
    named = ", ".join(names[:_NAMED]) + (" and others" if len(names) > _NAMED else "")
    mirrors = f"{len(names)} flagged mirrors" if len(names) > 1 else "flagged mirror"
    return f", most over the {mirrors} ({named}), of which fewer would make fewer paths"
