"""Some paths of a record, and which of them are strong. Long arrays are walked in blocks: that bounds the memory, and
Ctrl-C is answered in between."""
from __future__ import annotations

import numpy as np

from .. import _core

BLOCK = 1 << 20  # paths
_DIGIT = 16      # bits of a power that one pass of `power_of_strongest` looks at

HIT_FIELDS = {"mesh_id": np.uint32, "triangle_id": np.uint32, "u": np.float32, "v": np.float32}
HIT = np.dtype(list(HIT_FIELDS.items()))


def _blocks(size: int):
    """Slices that cover `size` entries."""
    return (slice(begin, min(begin + BLOCK, size)) for begin in range(0, size, BLOCK))


def subset(paths, keep):
    """The paths where `keep` [P] is true (or of the indices `keep`), in order, with only the hits that they use."""
    keep = np.asarray(keep)
    if keep.dtype != bool:
        mask = np.zeros(paths.num_paths, bool)
        mask[keep] = True
        keep = mask
    return paths._select_with_own_hits(keep)


def part_of_path(paths, selections: dict):
    """The part of each path in a partition {name: selection}: u16 [P], index of a name, or their number for "other"."""
    return _core.partition_groups(paths, list(selections.items()))[1].astype(np.uint16)


def power_of_strongest(power, max_paths: int) -> float:
    """The power in W that at most `max_paths` of the paths reach, [P] `power` in W; 0 when all paths are few enough.

    max_paths: at least 1.
    """
    if len(power) <= max_paths:
        return 0.0
    # Digit by digit from the highest: the bits of positive floats are in the order of their values.
    bits = np.ascontiguousarray(power, np.float64).view(np.uint64)
    prefix, rank = 0, max_paths
    for shift in range(64 - _DIGIT, -1, -_DIGIT):
        counts = _count_digits(bits, shift, prefix)
        reached = counts[::-1].cumsum()[::-1]  # paths of this digit or a higher one
        digit = int(np.flatnonzero(reached >= rank)[-1])
        rank -= int(reached[digit] - counts[digit])
        prefix = (prefix << _DIGIT) | digit
    threshold = np.uint64(prefix).view(np.float64)
    if sum(np.count_nonzero(power[block] >= threshold) for block in _blocks(len(power))) > max_paths:
        threshold = np.nextafter(threshold, np.inf)
    return float(threshold)


def _count_digits(bits, shift: int, prefix: int):
    """How often each digit at `shift` occurs among the numbers whose higher digits are `prefix`."""
    counts = np.zeros(1 << _DIGIT, np.int64)
    for block in _blocks(len(bits)):
        digits = bits[block] >> np.uint64(shift)
        if shift < 64 - _DIGIT:
            digits = digits[digits >> np.uint64(_DIGIT) == np.uint64(prefix)] & np.uint64((1 << _DIGIT) - 1)
        counts += np.bincount(digits.astype(np.int64), minlength=len(counts))
    return counts


def strongest(power, count: int, among=None):
    """Indices of the `count` strongest paths where `among` [P] is true, strongest first; never paths of no power."""
    best = np.zeros(0, np.int64)
    for block in _blocks(len(power)):
        is_candidate = power[block] > 0.0 if among is None else among[block] & (power[block] > 0.0)
        best = np.concatenate([best, block.start + np.flatnonzero(is_candidate)])
        if len(best) > count:
            best = best[np.argpartition(-power[best], count)[:count]]
    best.sort()
    return best[np.argsort(-power[best], kind="stable")]


def strongest_of_each(power, group, num_groups: int, count: int):
    """Indices of about `count` paths: half of them shared evenly among the groups, the strongest of each, the rest the strongest
    of all.

    power: [P] W; group: [P], of `num_groups`, those of others (-1) are left out; more groups than half of `count`: the strongest
    of all alone
    """
    among = group >= 0
    share = count // (2 * num_groups) if num_groups else 0
    of_each = [strongest(power, share, among=group == number) for number in range(num_groups)] if share else []
    chosen = np.concatenate([np.zeros(0, np.int64), *of_each])
    among[chosen] = False
    return np.concatenate([chosen, strongest(power, count - len(chosen), among=among)])


def first_group(paths, group_of_mesh):
    """The group of the first mesh along each path that has one: [P] from [M], -1 for none."""
    found = np.full(paths.num_paths, -1, np.int64)
    offsets, num_bounces, mesh_id = paths.offsets, paths.num_bounces, paths.mesh_id
    for block in _blocks(paths.num_paths):
        for order in range(int(num_bounces[block].max(initial=0))):
            is_open = (num_bounces[block] > order) & (found[block] < 0)
            open_ones = block.start + np.flatnonzero(is_open)
            found[open_ones] = group_of_mesh[mesh_id[offsets[open_ones] + order]]
    return found


def paths_on(paths, mesh_is_meant):
    """Which paths have a hit on a mesh that is meant: bool [P] from bool [M]."""
    found = np.zeros(paths.num_paths, bool)
    offsets, num_bounces, mesh_id = paths.offsets, paths.num_bounces, paths.mesh_id
    for block in _blocks(paths.num_paths):
        for order in range(int(num_bounces[block].max(initial=0))):
            with_one = block.start + np.flatnonzero(num_bounces[block] > order)
            found[with_one] |= mesh_is_meant[mesh_id[offsets[with_one] + order]]
    return found
