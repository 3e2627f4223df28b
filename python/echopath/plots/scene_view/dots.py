"""Fewer triangles for a picture, in the place of those that nobody could tell apart."""
from __future__ import annotations

import numpy as np

DOTS = 3000           # along the longest side of a picture: what is smaller than one cannot be told apart
DOT_COVERS = 3.0      # of its size: triangles of that leave no gaps between dots
LEAST = 1000          # triangles that any mesh may have
COARSER = 1.5


def thinned(triangles, low, high, most: float) -> np.ndarray:
    """Triangles [N, 3, 3], of those smaller than a dot of the picture one for each dot, which covers it: a person far away has
    thousands. Of a mesh of too many, dots are coarser.

    low, high: corners [3] of the picture in m; most: share of the triangles that may be left, unless there are few
    """
    dot, allowed = (high - low).max() / DOTS, max(most * len(triangles), LEAST)
    a, b, c = np.moveaxis(triangles, 1, 0)
    size = (np.maximum(np.maximum(a, b), c) - np.minimum(np.minimum(a, b), c)).max(axis=1)
    middle = (a + b + c) / 3.0
    kept = _one_for_each_dot(middle, size, low, dot)
    while len(kept) > allowed:
        dot *= COARSER
        kept = _one_for_each_dot(middle, size, low, dot)
    larger = np.where(size[kept] < dot, DOT_COVERS * dot / np.maximum(size[kept], np.finfo(float).tiny), 1.0)
    return middle[kept, None] + (triangles[kept] - middle[kept, None]) * larger[:, None, None]


def _one_for_each_dot(middle, size, low, dot: float) -> np.ndarray:
    """Indices of the triangles that are drawn, from their middles [N, 3] and sizes [N] in m. low: [3] where dots begin"""
    small = np.flatnonzero(size < dot)
    place = np.floor((middle[small] - low) / dot).astype(np.int64)
    _, first = np.unique((place[:, 0] * 2**20 + place[:, 1]) * 2**20 + place[:, 2], return_index=True)
    return np.concatenate([np.flatnonzero(size >= dot), small[first]])
