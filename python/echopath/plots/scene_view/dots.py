"""Fewer triangles for a picture, in the place of those that nobody could tell apart."""
from __future__ import annotations

import numpy as np

DOTS = 3000           # along the longest side of a picture: what is smaller than one cannot be told apart
DOT_COVERS = 3.0      # of its size: triangles of that leave no gaps between dots
LEAST = 12            # triangles that any mesh may have, as a box has
COARSER = 1.5


def thinned(triangles, low, high, most: float = np.inf) -> np.ndarray:
    """Triangles [N, 3, 3], of those smaller than a dot of the picture one for each dot, which covers it: a person far away has
    thousands. Of a mesh of more than `most`, dots are coarser.

    low, high: corners [3] of the picture in m
    """
    dot = (high - low).max() / DOTS
    a, b, c = np.moveaxis(triangles, 1, 0)
    length = (np.maximum(np.maximum(a, b), c) - np.minimum(np.minimum(a, b), c)).max(axis=1)
    size, middle = length, (a + b + c) / 3.0
    kept = _one_for_each_dot(middle, size, low, dot)
    if len(kept) > most:  # long triangles count as short ones of their area: of poles some of each are kept, not some poles
        size = np.sqrt(np.linalg.norm(np.cross(b - a, c - a), axis=1))
    while len(kept) > most:
        dot *= COARSER
        kept = _one_for_each_dot(middle, size, low, dot)
    covering = np.maximum(DOT_COVERS * dot / np.maximum(length[kept], np.finfo(float).tiny), 1.0)
    larger = np.where(size[kept] < dot, covering, 1.0)
    return middle[kept, None] + (triangles[kept] - middle[kept, None]) * larger[:, None, None]


def most_of_each(counts, most: float) -> float:
    """How many triangles each mesh of `counts` may have for all of them to have `most`: the smaller ones keep all of theirs."""
    counts, left = sorted(counts), most
    for place, count in enumerate(counts):
        share = left / (len(counts) - place)
        if count > share:
            return max(share, LEAST)
        left -= count
    return most


def _one_for_each_dot(middle, size, low, dot: float) -> np.ndarray:
    """Indices of the triangles that are drawn, from their middles [N, 3] and sizes [N] in m. low: [3] where dots begin"""
    small = np.flatnonzero(size < dot)
    place = np.floor((middle[small] - low) / dot).astype(np.int64)
    _, first = np.unique((place[:, 0] * 2**20 + place[:, 1]) * 2**20 + place[:, 2], return_index=True)
    return np.concatenate([np.flatnonzero(size >= dot), small[first]])
