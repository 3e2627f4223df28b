"""How much of a record a file of many frames holds."""
from __future__ import annotations

from ..frame.frame import Frame
from ..paths.subset import power_of_strongest

RECORD_BYTES = 250e6  # of paths and hits in a frame file, at most
PATH_BYTES, HIT_BYTES, JONES_BYTES, CURVED_CELL_BYTES = 31, 16, 32, 28


def min_power_of_budget(frame: Frame, record_bytes: float = RECORD_BYTES) -> float:
    """Power in W that a path must have so that the strongest paths that fit into `record_bytes` are kept."""
    if frame.paths.num_paths == 0:
        return 0.0
    paths = frame.paths
    columns = JONES_BYTES * (len(paths.jones) > 0) + CURVED_CELL_BYTES * (len(paths.curved_cell) > 0)
    bytes_per_path = PATH_BYTES + columns + HIT_BYTES * float(paths.num_bounces.mean())
    return power_of_strongest(frame.path_power, int(record_bytes / bytes_per_path))
