"""A few of the one-way paths of a trace that stand for all of them."""
from __future__ import annotations

from itertools import product

import numpy as np

from ..base.radar.antennas import one_of_each_look
from ..paths.subset import subset

HELD, MOST_PATHS = 0.999, 1024  # share of the power of a trace, and of its paths: each is a crossing of its own in every chirp


def few_paths(paths) -> tuple:
    """Paths that stand for all of those of a trace, and what to multiply their amplitudes by [P].

    The strongest that hold HELD of the power at the trace time, in the mean over antennas that look different ways, as they are,
    where MOST_PATHS or fewer do. Otherwise a sample of about MOST_PATHS drawn by the seed of the trace. Diffuse paths, whose
    phases are random, are kept with a chance p in proportion to their power and multiplied by 1/sqrt(p): their power is
    whole. The others add up as fields: p is in proportion to their amplitude, the factor 1/p, and the field is that of all in
    the mean over seeds.
    Source: threshold sampling after Duffield, Lund, Thorup 2005, "Learn more, sample less".
    """
    if paths.num_paths == 0:
        return paths, np.ones(0)
    powers = powers_over_looks(paths)
    falling = np.sort(powers)[::-1]
    count = int(np.searchsorted(np.cumsum(falling), HELD * falling.sum())) + 1
    if count <= MOST_PATHS:
        keep = powers >= falling[count - 1]
        return subset(paths, keep), np.ones(np.count_nonzero(keep))
    chance, scale = _chances(powers, paths.diffuse != 0)
    keep = _drawn(chance, paths.lengths([paths.frame.trace_time], 0, 0)[0], paths.frame.seed)
    return subset(paths, keep), scale[keep]


def powers_over_looks(paths) -> np.ndarray:
    """W [P] at the trace time, in the mean over pairs of antennas, of which those that look the same way count once."""
    pairs = list(product(*(one_of_each_look(antennas) for antennas in (paths.radar.transmitters, paths.radar.receivers))))
    fields = [paths.amplitudes([paths.frame.trace_time], tx, rx)[0] for tx, rx in pairs]
    return np.mean(np.abs(fields) ** 2, axis=0)


def _chances(powers, is_diffuse) -> tuple:
    """Chance [P] of each path to be kept, and the factor [P] of its amplitude then."""
    chance, scale = np.zeros(len(powers)), np.zeros(len(powers))
    groups = [(is_diffuse, powers, -0.5), (~is_diffuse, np.sqrt(powers), -1.0)]
    fewer = min(np.count_nonzero(which) for which, _, _ in groups)
    of_fewer = min(fewer, MOST_PATHS // 2)
    for which, weight, exponent in groups:
        most = of_fewer if np.count_nonzero(which) == fewer else MOST_PATHS - of_fewer
        chance[which] = _threshold_chances(weight[which], most)
        with np.errstate(divide="ignore"):
            scale[which] = chance[which] ** exponent
    return chance, scale


def _threshold_chances(weight, most: int):
    """min(1, weight / t) of weights [P], with t such that they add up to `most`; 1 where that many or fewer are not zero."""
    if np.count_nonzero(weight) <= most:
        return (weight > 0.0).astype(float)
    falling = np.sort(weight)[::-1]
    rest = np.cumsum(falling[::-1])[::-1][:most]  # what those from each place on add up to
    thresholds = rest / np.arange(most, 0, -1)
    return np.minimum(1.0, weight / thresholds[np.argmax(falling[:most] <= thresholds)])


def _drawn(chance, length, seed: int):
    """Which are kept [P] by their chances: systematically, one after the other in the order of their lengths, so that fields of
    neighbours stand for each other."""
    keep = chance >= 1.0
    order = np.argsort(length, kind="stable")
    order = order[~keep[order]]
    steps = np.floor(np.cumsum(chance[order]) + np.random.default_rng(seed).random())
    keep[order] = np.diff(steps, prepend=0.0) > 0.0
    return keep
