"""Smooth surfaces of coarse cages: the subdivision of Catmull and Clark, whose limit is made of bicubic patches.

E. Catmull, J. Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes", Computer-Aided Design 10
(1978) 350-355; edges that stay sharp after H. Hoppe et al., "Piecewise smooth surface reconstruction", SIGGRAPH 1994. Edges
with one face are sharp.
"""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Cage:
    """vertices [V, 3] in m; quads [Q, 4], counter-clockwise seen from outside; labels: list [Q] of names;
    sharp [E, 2]: pairs of vertices whose edges stay sharp."""

    vertices: np.ndarray
    quads: np.ndarray
    labels: list
    sharp: np.ndarray


class _Edges:
    """The edges of quads: ends [E, 2], of_quad [Q, 4] (edge k from corner k to k + 1), count [E] of faces, sharp [E]."""

    def __init__(self, quads, sharp):
        pairs = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
        self.ends, index = np.unique(pairs, axis=0, return_inverse=True)
        self.of_quad = index.reshape(quads.shape)
        self.count = np.bincount(self.of_quad.ravel(), minlength=len(self.ends))
        width = quads.max() + 1
        keys = self.ends[:, 0] * width + self.ends[:, 1]
        marked = np.sort(np.asarray(sharp, dtype=np.int64).reshape(-1, 2), axis=1)
        self.sharp = (self.count == 1) | np.isin(keys, marked[:, 0] * width + marked[:, 1])


def subdivided(cage):
    """The cage of the next level: each quad becomes four."""
    edges = _Edges(cage.quads, cage.sharp)
    vertices, num = cage.vertices, len(cage.vertices)
    faces = vertices[cage.quads].mean(axis=1)
    middles = vertices[edges.ends].mean(axis=1)
    beside = _sums(edges.of_quad.ravel(), np.repeat(faces, 4, axis=0), len(edges.ends)) / edges.count[:, None]
    on_edges = np.where(edges.sharp[:, None], middles, 0.5 * (middles + beside))
    at = _moved(vertices, edges, _smooth_rule(vertices, cage.quads, edges, faces, middles), (6.0, 1.0))
    a, e, f = cage.quads, num + edges.of_quad, num + len(edges.ends) + np.arange(len(cage.quads))
    quads = np.stack([np.stack([a[:, k], e[:, k], f, e[:, k - 1]], axis=-1) for k in range(4)], axis=1).reshape(-1, 4)
    creases = np.flatnonzero(edges.sharp)
    sharp = np.concatenate([np.stack([edges.ends[creases, k], num + creases], axis=-1) for k in (0, 1)])
    return Cage(np.concatenate([at, on_edges, faces]), quads, [label for label in cage.labels for _ in range(4)], sharp)


def on_limit(cage):
    """The cage with its vertices moved to where further subdivision would take them (Halstead, Kass and DeRose 1993)."""
    edges = _Edges(cage.quads, cage.sharp)
    vertices = cage.vertices
    valence = np.maximum(np.bincount(cage.quads.ravel(), minlength=len(vertices)), 1).astype(float)[:, None]
    around = _neighbour_sums(vertices, edges)
    opposite = _sums(cage.quads.ravel(), vertices[np.roll(cage.quads, 2, axis=1)].reshape(-1, 3), len(vertices))
    smooth = (valence**2 * vertices + 4.0 * around + opposite) / (valence * (valence + 5.0))
    return Cage(_moved(vertices, edges, smooth, (4.0, 1.0)), cage.quads, cage.labels, cage.sharp)


def triangulated(quads, vertices):
    """Triangles [2 Q, 3] of quads, cut along the shorter diagonal; those of quad q are 2 q and 2 q + 1."""
    corners = vertices[quads]
    first = np.linalg.norm(corners[:, 0] - corners[:, 2], axis=1) <= np.linalg.norm(corners[:, 1] - corners[:, 3], axis=1)
    along = np.stack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]], axis=1)
    across = np.stack([quads[:, [0, 1, 3]], quads[:, [1, 2, 3]]], axis=1)
    return np.where(first[:, None, None], along, across).reshape(-1, 3)


def _smooth_rule(vertices, quads, edges, faces, middles):
    num = len(vertices)
    valence = np.maximum(np.bincount(quads.ravel(), minlength=num), 1).astype(float)[:, None]
    face_mean = _sums(quads.ravel(), np.repeat(faces, 4, axis=0), num) / valence
    degree = np.maximum(np.bincount(edges.ends.ravel(), minlength=num), 1).astype(float)[:, None]
    edge_mean = (_sums(edges.ends[:, 0], middles, num) + _sums(edges.ends[:, 1], middles, num)) / degree
    return (face_mean + 2.0 * edge_mean + (valence - 3.0) * vertices) / valence


def _moved(vertices, edges, smooth, weights):
    """Vertices by the smooth rule, by that of a crease (weights of itself and of its two neighbours) or left at corners."""
    ends = edges.ends[edges.sharp]
    num_sharp = np.bincount(ends.ravel(), minlength=len(vertices))
    along = _sums(ends[:, 0], vertices[ends[:, 1]], len(vertices)) + _sums(ends[:, 1], vertices[ends[:, 0]], len(vertices))
    own, other = weights
    crease = (own * vertices + other * along) / (own + 2.0 * other)
    return np.where((num_sharp < 2)[:, None], smooth, np.where((num_sharp == 2)[:, None], crease, vertices))


def _neighbour_sums(vertices, edges):
    first, second = edges.ends.T
    return _sums(first, vertices[second], len(vertices)) + _sums(second, vertices[first], len(vertices))


def _sums(index, rows, count):
    return np.stack([np.bincount(index, weights=column, minlength=count) for column in rows.T], axis=1)
