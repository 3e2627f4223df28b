"""Straight pieces of rays, ready to be drawn."""
from __future__ import annotations

import dataclasses

import numpy as np

from echopath.path_subset import subset


@dataclasses.dataclass(frozen=True)
class Segments:
    """Rays as two-point segments, ray by ray in the order they were asked for.

    rays: [N] index of the path of each ray; points: [V, 3] f32 m; ends: [S, 2] the two points of each segment
    ray: [S] row in `rays`; bounce: [S] 0 for the leg that leaves the transmitter
    mesh_id: [S] mesh of the hit that the segment leads to; the last leg has that of its last hit
    hits: [K] which of the points are hits; hit_mesh: [K] their meshes; hit_ray: [K] rows in `rays`
    """

    rays: np.ndarray
    points: np.ndarray
    ends: np.ndarray
    ray: np.ndarray
    bounce: np.ndarray
    mesh_id: np.ndarray
    hits: np.ndarray
    hit_mesh: np.ndarray
    hit_ray: np.ndarray

    @property
    def num_segments(self) -> int:
        return len(self.ends)

    def num_segments_of(self, num_rays: int) -> int:
        """Number of segments of the first `num_rays` rays."""
        return int(np.searchsorted(self.ray, num_rays, "left"))


def ray_segments(paths, chosen, time: float, transmitter, receiver) -> Segments:
    """The segments of some paths.

    chosen: [N] indices of paths, in the order wanted; time: s, of the replayed positions
    transmitter, receiver: [3] m in the world at that time.
    """
    chosen = np.asarray(chosen, np.int64)
    kept = subset(paths, chosen)
    row = np.empty(len(chosen), np.int64)  # of each ray among the kept paths, which are in the order of the record
    row[np.argsort(chosen, kind="stable")] = np.arange(len(chosen))
    num_hits = np.asarray(kept.num_bounces).astype(np.int64)[row]
    first_point = np.concatenate([[0], np.cumsum(num_hits + 2)])
    ray_of_hit = np.repeat(np.arange(len(chosen)), num_hits)
    order = np.arange(len(ray_of_hit)) - np.repeat(np.cumsum(num_hits) - num_hits, num_hits)
    hit = np.asarray(kept.offsets)[row][ray_of_hit] + order
    hits = first_point[ray_of_hit] + 1 + order

    points = np.empty((first_point[-1], 3), np.float32)
    points[first_point[:-1]] = transmitter
    points[first_point[1:] - 1] = receiver
    points[hits] = np.asarray(kept.points(time)).reshape(-1, 3)[hit]

    ray = np.repeat(np.arange(len(chosen)), num_hits + 1)
    bounce = np.arange(len(ray)) - np.repeat(np.cumsum(num_hits + 1) - (num_hits + 1), num_hits + 1)
    begin = first_point[ray] + bounce
    hit_mesh = np.asarray(kept.mesh_id)[hit]
    return Segments(rays=chosen, points=points, ends=np.stack([begin, begin + 1], axis=1), ray=ray, bounce=bounce,
                    mesh_id=_mesh_of_segments(hit_mesh, num_hits, ray, bounce), hits=hits, hit_mesh=hit_mesh,
                    hit_ray=ray_of_hit)


def _mesh_of_segments(hit_mesh, num_hits, ray, bounce):
    """[S] i64, -1 for a path without hits."""
    if not len(hit_mesh):
        return np.full(len(ray), -1)
    first_hit = np.cumsum(num_hits) - num_hits
    leads_to = first_hit[ray] + np.minimum(bounce, np.maximum(num_hits[ray] - 1, 0))
    return np.where(num_hits[ray] > 0, hit_mesh[np.minimum(leads_to, len(hit_mesh) - 1)].astype(np.int64), -1)
