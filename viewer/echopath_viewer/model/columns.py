"""What is known of each path at one channel."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep
from echopath.signals.measures import SMALLEST_POWER, in_dbm


@dataclasses.dataclass(frozen=True)
class Columns:
    """Columns by path and by hit at one channel of the radar.

    paths: the record; tx, rx: indices of the antennas
    amplitude: complex [P] sqrt(W) at the trace time; power: [P] W, its square; power_dbm: the same in dB re 1 mW
    cells: PathCells, range in m and velocity in m/s and cell of each path
    offsets, num_bounces: [P]; mesh_id: [H]
    """

    paths: object
    tx: int
    rx: int
    amplitude: np.ndarray
    power: np.ndarray
    power_dbm: np.ndarray
    cells: ep.PathCells
    offsets: np.ndarray
    num_bounces: np.ndarray
    mesh_id: np.ndarray

    def meshes_of(self, path: int):
        """Mesh IDs of the hits of a path, in order of travel: [B]."""
        return self.mesh_id[self.offsets[path]:self.offsets[path] + self.num_bounces[path]]

    def count_by_mesh(self, shown, num_meshes: int):
        """How many of the paths `shown` (bool [P]) hit each mesh, once or more: [M]."""
        counts = np.zeros(num_meshes, np.int64)
        chosen = np.flatnonzero(shown)
        offsets, num_bounces = self.offsets[chosen], self.num_bounces[chosen]
        for order in range(int(num_bounces.max(initial=0))):
            at = offsets[num_bounces > order]
            mesh = self.mesh_id[at + order]
            is_new = np.ones(len(at), bool)
            for earlier in range(order):
                is_new &= self.mesh_id[at + earlier] != mesh
            counts += np.bincount(mesh[is_new], minlength=num_meshes)
        return counts


def read_columns(paths, spectrum, tx: int = 0, rx: int = 0) -> Columns:
    """The columns of a record at a channel; spectrum: any map of the radar, for its axes."""
    amplitude = paths.amplitudes([paths.frame.trace_time], tx, rx)[0]
    power = np.abs(amplitude) ** 2
    return Columns(paths=paths, tx=tx, rx=rx, amplitude=amplitude.astype(np.complex64), power=power,
                   power_dbm=in_dbm(power, SMALLEST_POWER), cells=ep.path_cells(paths, spectrum, tx=tx, rx=rx),
                   offsets=np.asarray(paths.offsets), num_bounces=np.asarray(paths.num_bounces),
                   mesh_id=np.ascontiguousarray(paths.mesh_id))
