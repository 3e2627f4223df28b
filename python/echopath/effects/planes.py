"""The planes that image themselves: unflagged ones over which the image method found paths."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..paths.absent import NO_STRATUM
from ..paths.edge_hits import edge_hits

FLAT = 1.0 / 16.0      # wavelengths by which triangles of one plane stray from it (EmbreeScene::plane_tolerance, rounding apart)


def imaged_planes(paths) -> tuple[int, list[int]]:
    """(how many planes, the IDs of their meshes, ascending). Planes of several meshes count once where they are one."""
    hits = _unflagged_hits(paths)
    wavelength = _core.speed_of_light / paths.radar.waveform.start_frequency
    planes: list = []  # (unit normal [3], point [3] in m)
    for mesh_id, triangle_id in hits.tolist():
        corners = _corners(paths, mesh_id, triangle_id)
        if any(np.abs((corners - point) @ normal).max() <= FLAT * wavelength for normal, point in planes):
            continue
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        planes.append((normal / np.linalg.norm(normal), corners[0]))
    return len(planes), sorted(set(hits[:, 0].tolist()))


def _unflagged_hits(paths):
    """[N, 2] mesh and triangle IDs of the hits of image paths on meshes that are no flagged mirrors, each once."""
    images = np.flatnonzero(np.asarray(paths.stratum) == NO_STRATUM)
    counts = np.asarray(paths.num_bounces)[images].astype(np.int64)
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    hits = np.repeat(np.asarray(paths.offsets)[images], counts) + within
    hits = hits[np.repeat(edge_hits(paths)[images], counts) >> within.astype(np.uint64) & np.uint64(1) == 0]
    found = np.unique(np.stack([np.asarray(paths.mesh_id)[hits], np.asarray(paths.triangle_id)[hits]], axis=1), axis=0)
    materials, of_mesh, *_ = _core.mesh_traits(paths.scene)
    is_mirror = np.array([material.mirror for material in materials], bool)[of_mesh]
    return found[~is_mirror[found[:, 0]]]


def _corners(paths, mesh_id: int, triangle_id: int):
    """[3, 3] in m at the time of the trace."""
    scene = paths.scene
    name, = _core.mesh_names(scene, [mesh_id])
    triangle = scene._node(scene._index_of(name)).mesh.triangles[triangle_id]
    return scene.world_vertices(mesh_id, paths.frame.trace_time)[triangle]
