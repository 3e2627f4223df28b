"""What switches that are off cost: the signal with noise of a street, beside the core's synthesis and noise alone.

Both are made in turns, many times over, on one thread: the ratio is the median of those of neighbours, in which the machine is as
fast. The bits of both are compared, too.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

import echopath as ep

from ... import _core
from ...receiver.chain import reception
from ..suite import describe_judged, judged_row
from ..timing import processor_time
from . import street

LIMIT = 1.01               # of the time without the receiver; a single turn of a quick run does not know it
TURNS, QUICK_TURNS = 21, 1
START, SEED = 0.1, 1
CASES = {"no receiver": None, "a Receiver without faults": ep.Receiver()}


def rows(*, quick: bool) -> list[dict]:
    """How many samples differ, and the ratio of processor times, of each case."""
    threads = ep.num_threads()
    ep.set_num_threads(1)
    try:
        return [row for name in CASES for row in _rows_of(name, quick)]
    finally:
        ep.set_num_threads(threads)


def describe(rows: list[dict]) -> list[str]:
    """Lines for people."""
    return describe_judged(rows, "switches that are off", width=60, measured="10.5g")


def _rows_of(name: str, quick: bool) -> list[dict]:
    paths, radar = street.paths(street.QUICK_NUM_RAYS if quick else street.NUM_RAYS), street.radar(receiver=CASES[name])
    plain = radar.replace(receiver=None)

    def without():
        return _core.add_noise(_core.synthesize(paths, plain), plain, seed=SEED, start_time=START)

    def with_receiver():
        return reception(ep.synthesize(paths, radar), radar, SEED, START).cube

    different = float(np.count_nonzero(without() != with_receiver()))
    ratio = _ratio(without, with_receiver, QUICK_TURNS if quick else TURNS)
    return [judged_row(f"{name}, samples that differ", different, 0.0),
            judged_row(f"{name}, ratio of processor times", ratio, None if quick else LIMIT)]


def _ratio(without: Callable, with_it: Callable, turns: int) -> float:
    """Median over turns of what the second takes in parts of the first; every other turn begins with the second."""
    ratios = []
    for turn in range(turns):
        works = [without, with_it] if turn % 2 else [with_it, without]
        seconds = {work: processor_time(work)[0] for work in works}
        ratios.append(seconds[with_it] / seconds[without])
    return float(np.median(ratios))
