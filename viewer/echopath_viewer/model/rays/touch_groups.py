"""Paths sorted by the set of meshes that they touch."""
from __future__ import annotations

import numpy as np

_BLOCK = 1 << 15  # paths whose numbers stay in the cache
_STRIDE = 97  # of the paths that are looked at first: they know most sets


class TouchGroups:
    """Paths by the set of meshes that they hit, in whatever order and however often.

    group_of_path: u16 or u32 [P]; order: u32 [P] the paths, group by group; begins: [G + 1] where each group begins there
    meshes: [G] sorted mesh IDs of each group, tuples
    """

    def __init__(self, offsets, num_bounces, mesh_id, num_meshes: int, known=None):
        """offsets, num_bounces: [P]; mesh_id: [H] of the hits; known: (group_of_path, order) where they are."""
        if known is None:
            keys, group_of_path = _numbered(_keys_of_sets(offsets, num_bounces, mesh_id, num_meshes))
            self.group_of_path = group_of_path.astype(np.uint16 if len(keys) < 65536 else np.uint32)
            self.order = np.argsort(self.group_of_path, kind="stable").astype(np.uint32)
        else:
            self.group_of_path, self.order = known
        self.begins = np.concatenate([[0], np.cumsum(np.bincount(self.group_of_path))])
        first = self.order[self.begins[:-1]]
        self.meshes = [tuple(sorted(set(mesh_id[offsets[path]:offsets[path] + num_bounces[path]].tolist()))) for path in first]

    def __len__(self) -> int:
        return len(self.meshes)

    def sort_within(self, power) -> None:
        """Puts the strongest path of each group first; power: [P]."""
        order = self.order.copy()
        for rows in self.slices():
            within = order[rows]
            order[rows] = within[np.argsort(-power[within])]  # a stable order takes four times as long
        self.order = order

    def slices(self):
        """Where the paths of each group stand in `order`."""
        return (slice(begin, end) for begin, end in zip(self.begins[:-1], self.begins[1:]))

    def touching(self, num_meshes: int):
        """Which groups touch each mesh: bool [G, M]."""
        touches = np.zeros((len(self), num_meshes), bool)
        for group, meshes in enumerate(self.meshes):
            touches[group, list(meshes)] = True
        return touches


def _keys_of_sets(offsets, num_bounces, mesh_id, num_meshes: int):
    """A number for each path that says which meshes it hits: random words of the meshes, each taken once; u64 [P]."""
    words = np.random.default_rng(0).integers(1, 2**63, num_meshes, dtype=np.uint64)
    keys = np.zeros(len(offsets), np.uint64)
    for first in range(0, len(offsets), _BLOCK):
        some = slice(first, first + _BLOCK)
        _add_words(keys[some], offsets[some], num_bounces[some], mesh_id, words)
    return keys


def _add_words(keys, offsets, num_bounces, mesh_id, words) -> None:
    """Adds the words of their meshes to the keys [P] of some paths."""
    for hit in range(int(num_bounces.max(initial=0))):
        paths = np.flatnonzero(num_bounces > hit)
        at = offsets[paths]
        mesh = mesh_id[at + hit]
        is_new = np.ones(len(paths), bool)
        for earlier in range(hit):
            is_new &= mesh_id[at + earlier] != mesh
        keys[paths[is_new]] ^= words[mesh[is_new]]


def _numbered(keys):
    """(the different keys, sorted; which of them each one is, i32): faster than np.unique where there are few."""
    known, at = np.unique(keys[::_STRIDE]), np.zeros(len(keys), np.int32)
    blocks = [slice(first, first + _BLOCK) for first in range(0, len(keys), _BLOCK)]
    while True:
        missing = []
        for some in blocks:
            at[some] = np.minimum(np.searchsorted(known, keys[some]), len(known) - 1)
            missing.append(keys[some][known[at[some]] != keys[some]])
        if not any(map(len, missing)):
            return known, at
        known = np.union1d(known, np.concatenate(missing))
