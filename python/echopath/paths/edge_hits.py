"""Which hits of paths lie on sharp edges, as the bits of `Paths.flags` say."""
from __future__ import annotations

import numpy as np

_ON_EDGE = 1 << 2        # set for a path with hits on edges
_MORE, _FIRST = 3, 8     # lowest bits of how many hits on edges follow the first one, and of its number along the path


def is_around_edge(paths) -> np.ndarray:
    """[P] bool: whether a path goes around a sharp edge."""
    return np.asarray(paths.flags) & _ON_EDGE != 0


def first_edge_hit(paths) -> np.ndarray:
    """[P] int64: the number along its path of the first hit on an edge, where there is one."""
    return (np.asarray(paths.flags).astype(np.int64) >> _FIRST) & 63


def edge_hits(paths) -> np.ndarray:
    """[P] uint64, bit k: hit k of the path lies on an edge; up to four in a row do."""
    one, flags = np.uint64(1), np.asarray(paths.flags).astype(np.uint64)
    count = (flags >> np.uint64(_MORE) & np.uint64(3)) + one
    return np.where(is_around_edge(paths), ((one << count) - one) << first_edge_hit(paths).astype(np.uint64), np.uint64(0))
