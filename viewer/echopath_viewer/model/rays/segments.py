"""Straight pieces of rays, ready to be drawn."""
from __future__ import annotations

import dataclasses

import numpy as np

from echopath.paths.subset import subset

from ..drawn_points import as_drawn

NO_MESH = -1


@dataclasses.dataclass(frozen=True)
class Segments:
    """Rays as two-point segments, ray by ray in the order they were asked for.

    rays: [N] index of the path of each ray; points: [V, 3] m, as they are drawn; ends: [S, 2] the two points of each segment
    ray: [S] row in `rays`; bounce: [S] 0 for the leg that leaves the transmitter
    mesh_id: [S] mesh of the hit that the segment leads to; the last leg has that of its last hit; -1: no hit
    hits: [K] which of the points are hits; hit_mesh: [K] their meshes
    """

    rays: np.ndarray
    points: np.ndarray
    ends: np.ndarray
    ray: np.ndarray
    bounce: np.ndarray
    mesh_id: np.ndarray
    hits: np.ndarray
    hit_mesh: np.ndarray

    @property
    def num_segments(self) -> int:
        return len(self.ends)

    def num_segments_of(self, num_rays: int) -> int:
        """Number of segments of the first `num_rays` rays."""
        return int(np.searchsorted(self.ray, num_rays, "left"))


class RayBundle:
    """Some paths of a record with how their rays hang together, which no time changes: only the points move."""

    def __init__(self, paths, chosen):
        """chosen: [N] indices of paths, in the order wanted."""
        self.rays = np.asarray(chosen, np.int64)
        is_chosen = np.zeros(paths.num_paths, bool)
        is_chosen[self.rays] = True
        self._kept = subset(paths, is_chosen)
        row = (np.cumsum(is_chosen) - 1)[self.rays]  # of each ray among the kept paths, which are in the order of the record
        num_hits = np.asarray(self._kept.num_bounces).astype(np.int64)[row]
        self._last = np.cumsum(num_hits + 2) - 1      # point of each ray: the receiver
        self._first = self._last - num_hits - 1       # the transmitter
        self._num_points = int(self._last[-1]) + 1 if len(self._last) else 0
        self._join(row, num_hits)
        self._asked = self._made = None

    def _join(self, row, num_hits) -> None:
        """Which points follow each other, and which are hits of what."""
        first, last, count = self._first, self._last, self._num_points
        ray_of_point = np.repeat(np.arange(len(self.rays), dtype=np.int32), num_hits + 2)
        order = np.arange(count, dtype=np.int32) - first.astype(np.int32)[ray_of_point]
        leads_on, is_hit = np.ones(count, bool), np.ones(count, bool)
        leads_on[last] = is_hit[last] = is_hit[first] = False
        begin, hits = np.flatnonzero(leads_on), np.flatnonzero(is_hit)
        self._hit = (np.asarray(self._kept.offsets)[row] - 1)[ray_of_point[hits]] + order[hits]
        hit_mesh = np.asarray(self._kept.mesh_id)[self._hit]
        mesh = np.full(count, NO_MESH, np.int32)
        mesh[hits] = hit_mesh
        mesh[last] = mesh[last - 1]
        self._joined = {"ends": np.stack([begin, begin + 1], axis=1), "ray": ray_of_point[begin], "bounce": order[begin],
                        "mesh_id": mesh[begin + 1], "hits": hits, "hit_mesh": hit_mesh}

    def at(self, time: float, transmitter, receiver) -> Segments:
        """The segments at a time in s; transmitter, receiver: [3] m in the world at that time. The last ones are kept."""
        asked = time, *map(float, transmitter), *map(float, receiver)
        if self._asked != asked:
            self._asked, self._made = asked, self._segments_at(time, transmitter, receiver)
        return self._made

    def _segments_at(self, time: float, transmitter, receiver) -> Segments:
        replayed = as_drawn(self._kept.points(time)).reshape(-1, 3)
        points = np.empty((self._num_points, 3), np.result_type(replayed, as_drawn([transmitter, receiver])))
        points[self._first], points[self._last] = transmitter, receiver
        points[self._joined["hits"]] = np.take(replayed, self._hit, axis=0)  # four times as fast as [hit]
        return Segments(rays=self.rays, points=points, **self._joined)


def ray_segments(paths, chosen, time: float, transmitter, receiver) -> Segments:
    """The segments of some paths.

    chosen: [N] indices of paths, in the order wanted; time: s, of the replayed positions
    transmitter, receiver: [3] m in the world at that time.
    """
    return RayBundle(paths, chosen).at(time, transmitter, receiver)
