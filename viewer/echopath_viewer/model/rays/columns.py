"""What is known of each path at one channel."""
from __future__ import annotations

import dataclasses
from functools import cached_property

import numpy as np

import echopath as ep
from echopath.base.numerics.decibels import SMALLEST_POWER, in_dbm
from echopath.paths.cells import OUTSIDE

CLOSE = 1e-9  # of a power: nearer ones are compared in decibels


@dataclasses.dataclass(frozen=True)
class Columns:
    """Columns by path at one channel of the radar, and by hit as in the record.

    paths: the record; tx, rx: indices of the antennas
    power: [P] W at the trace time; range: f32 [P] m and velocity: f32 [P] m/s, as of `path_cells`
    cell: i32 [P], velocity index * num_ranges + range index in a map, OUTSIDE for paths outside of it
    """

    paths: object
    tx: int
    rx: int
    power: np.ndarray
    range: np.ndarray
    velocity: np.ndarray
    cell: np.ndarray
    num_ranges: int

    @cached_property
    def offsets(self):
        """[P], of the first hit."""
        return np.asarray(self.paths.offsets)

    @cached_property
    def num_bounces(self):
        """[P]"""
        return np.asarray(self.paths.num_bounces)

    @cached_property
    def mesh_id(self):
        """[H], of the hits: as they lie in the record, of which this is no copy."""
        return self.paths.hits["mesh_id"]

    def power_dbm(self, paths=slice(None)):
        """dB re 1 mW of some of the paths: made when it is asked for, as few are."""
        return in_dbm(self.power[paths], SMALLEST_POWER)

    def is_at_least(self, dbm: float):
        """Which paths have that power in dB re 1 mW: bool [P]."""
        least = 1e-3 * 10.0 ** (0.1 * dbm)
        found = self.power >= least
        near = np.flatnonzero(np.abs(self.power - least) <= CLOSE * least)  # where rounding decides
        found[near] = self.power_dbm(near) >= dbm
        return found

    def cell_of(self, path: int) -> tuple | None:
        """(range index, velocity index) of a path; None for one outside the map."""
        velocity, distance = divmod(int(self.cell[path]), self.num_ranges)
        return None if self.cell[path] == OUTSIDE else (distance, velocity)

    def meshes_of(self, path: int):
        """Mesh IDs of the hits of a path, in order of travel: [B]."""
        return self.mesh_id[self.offsets[path]:self.offsets[path] + self.num_bounces[path]]


def read_columns(paths, spectrum, tx: int = 0, rx: int = 0) -> tuple:
    """(the columns of a record at a channel, complex64 [P] amplitudes in sqrt(W)); spectrum: any map of the radar, for its
    axes."""
    amplitude = paths.amplitudes([paths.frame.trace_time], tx, rx)[0]
    power = np.abs(amplitude) ** 2
    amplitude = amplitude.astype(np.complex64)
    cells, num_ranges = ep.path_cells(paths, spectrum, tx=tx, rx=rx), len(spectrum.range)
    cell = cells.velocity_index * np.int32(num_ranges) + cells.range_index
    cell[cells.range_index == OUTSIDE] = OUTSIDE
    columns = Columns(paths=paths, tx=tx, rx=rx, power=power, range=cells.range.astype(np.float32),
                      velocity=cells.velocity.astype(np.float32), cell=cell, num_ranges=num_ranges)
    return columns, amplitude
