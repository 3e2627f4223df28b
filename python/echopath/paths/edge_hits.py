"""Which hits of paths lie on sharp edges, as the bits of `Paths.flags` say."""
from __future__ import annotations

import numpy as np

_ON_EDGE = 1 << 2        # set for a path with hits on edges
_MORE, _FIRST = 3, 8     # lowest bits of how many hits on edges follow the first one, and of its number along the path


def is_around_edge(paths, chosen=slice(None)) -> np.ndarray:
    """[P] bool: whether a path goes around a sharp edge; chosen: index of those that are asked for."""
    return np.asarray(paths.flags)[chosen] & _ON_EDGE != 0


def first_edge_hit(paths, chosen=slice(None)) -> np.ndarray:
    """[P] int64: the number along its path of the first hit on an edge, where there is one; chosen: as of `is_around_edge`"""
    return (np.asarray(paths.flags)[chosen].astype(np.int64) >> _FIRST) & 63


def edge_hits(paths, chosen=slice(None)) -> np.ndarray:
    """[P] uint64, bit k: hit k of the path lies on an edge; up to four in a row do. chosen: as of `is_around_edge`"""
    one, flags = np.uint64(1), np.asarray(paths.flags)[chosen].astype(np.uint64)
    count = (flags >> np.uint64(_MORE) & np.uint64(3)) + one
    first = first_edge_hit(paths, chosen).astype(np.uint64)
    return np.where(is_around_edge(paths, chosen), ((one << count) - one) << first, np.uint64(0))
