"""Some paths of a record with only the hits they use."""
from __future__ import annotations

import numpy as np

import echopath as ep


BLOCK_PATHS = 1 << 19  # whose power is computed at a time: bounds the memory, and Ctrl-C is answered in between


def path_power(paths):
    """Power of each path at the trace time for the first antennas, [P] in W."""
    power = np.empty(paths.num_paths)
    is_meant = np.zeros(paths.num_paths, bool)
    for begin in range(0, paths.num_paths, BLOCK_PATHS):
        block = slice(begin, begin + BLOCK_PATHS)
        is_meant[block] = True
        amplitude = paths.select(is_meant).amplitude
        is_meant[block] = False
        power[block] = amplitude.real**2 + amplitude.imag**2
    return power


def used_hits(offsets, num_bounces, num_hits: int):
    """The hits that paths use, and where the paths find them once the others are gone.

    offsets, num_bounces [P]: as in Paths; num_hits: H.
    Returns used [H'] (ascending indices of hits) and offsets [P] into them. Hits that paths share stay shared.
    """
    is_used = np.zeros(num_hits, bool)
    for _, hits in _hits_by_order(offsets, num_bounces):
        is_used[hits] = True
    used = np.flatnonzero(is_used)
    return used, np.searchsorted(used, offsets).astype(np.int64)


def _hits_by_order(offsets, num_bounces):
    """For the first, second, ... hits of paths: which paths have one (indices), and which hit it is."""
    for order in range(int(num_bounces.max(initial=0))):
        paths = np.flatnonzero(num_bounces > order)
        yield paths, offsets[paths] + order


def subset(paths, keep):
    """The paths where `keep` [P] is true (or of the indices `keep`), in order, with only the hits that they use."""
    chosen = np.flatnonzero(keep) if np.asarray(keep).dtype == bool else np.sort(np.asarray(keep, dtype=np.int64))
    offsets, num_bounces = paths.offsets[chosen], paths.num_bounces[chosen]
    used, new_offsets = used_hits(offsets, num_bounces, len(paths.hits))
    return ep.Paths.from_arrays(
        hits=paths.hits[used], offsets=new_offsets, num_bounces=num_bounces, diffuse=paths.diffuse[chosen],
        weight=paths.weight[chosen], stratum=paths.stratum[chosen], batch=paths.batch[chosen],
        flags=paths.flags[chosen], curved_cell=paths.curved_cell[chosen] if len(paths.curved_cell) else None, scene=paths.scene, radar=paths.radar, frame=paths.frame)


def part_of_path(paths, selections: dict):
    """The part of each path in a partition {name: selection}: u16 [P], index of a name, or their number for "other"."""
    return ep._core.partition_groups(paths, list(selections.items()))[1].astype(np.uint16)


def power_of_strongest(power, max_paths: int) -> float:
    """The power in W that at most `max_paths` of the paths reach, [P] `power` in W; 0 when all paths are few enough."""
    if len(power) <= max_paths:
        return 0.0
    strongest = np.partition(power, len(power) - max_paths)[len(power) - max_paths:]
    threshold = strongest.min()
    if np.count_nonzero(power >= threshold) > max_paths:
        threshold = np.nextafter(threshold, np.inf)
    return float(threshold)


def strongest(power, count: int, among=None):
    """Indices of the `count` strongest paths where `among` [P] is true, strongest first; never paths of no power."""
    candidates = np.flatnonzero(power > 0.0 if among is None else among & (power > 0.0))
    if len(candidates) > count:
        candidates = candidates[np.argpartition(power[candidates], len(candidates) - count)[-count:]]
    return candidates[np.argsort(-power[candidates], kind="stable")]


def paths_with(hit_is_meant, offsets, num_bounces):
    """Which paths have a hit that is meant: bool [P] from bool [H]."""
    found = np.zeros(len(offsets), bool)
    for paths, hits in _hits_by_order(offsets, num_bounces):
        found[paths] |= hit_is_meant[hits]
    return found
