"""Segments that lie on each other: paths share the legs to the hits that they have in common."""
from __future__ import annotations

import numpy as np

# Odd factors for the three bit patterns of a point, and the two of Steele et al. (2014) that mix the bits of a sum.
OF_AXES = np.uint64([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9])
MIXES = (np.uint64(30), np.uint64(0xBF58476D1CE4E5B9)), (np.uint64(27), np.uint64(0x94D049BB133111EB))
LAST_SHIFT = np.uint64(31)
FAR = 2.0**62  # cells: nothing that is drawn lies farther, and it fits into 64 bits


def first_of_each(points, ends, cell: float = 0.0) -> np.ndarray:
    """Ascending indices of the segments that lie on none before them, in either direction.

    points: [V, 3] f32 or f64 m; ends: [S, 2] the two points of each segment; cell: m, ends in the same cube of a grid of that
    spacing count as one, 0: only equal ones do.
    What is infinite or NaN counts as far away where there is a cell.
    Ends are compared by 64 random bits: of 100 000 segments one is taken for another once in 4e9 times.
    """
    points = np.ascontiguousarray(points).reshape(-1, 3)
    of_point = _mixed((_words(points, cell) * OF_AXES).sum(axis=1, dtype=np.uint64))
    begin, end = of_point[np.reshape(ends, (-1, 2))].T
    return np.sort(np.unique(_mixed(begin + end), return_index=True)[1])


def _words(points, cell: float):
    """[V, 3] unsigned, the same where points count as one."""
    if cell == 0.0:
        return (points + points.dtype.type(0.0)).view(f"u{points.dtype.itemsize}").astype(np.uint64)  # -0 becomes 0
    cells = np.rint(points.astype(np.float64) / cell)  # NumPy before 2 would divide in f32
    return np.fmax(np.fmin(cells, FAR), -FAR).astype(np.int64).view(np.uint64)


def _mixed(bits):
    for shift, factor in MIXES:
        bits = (bits ^ (bits >> shift)) * factor
    return bits ^ (bits >> LAST_SHIFT)
