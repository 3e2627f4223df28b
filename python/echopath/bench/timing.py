"""Seconds that work takes, and what it returns."""
from __future__ import annotations

import time


def wall_time(work):
    """(s by the clock, result) of one call of `work`."""
    began = time.perf_counter()
    result = work()
    return time.perf_counter() - began, result


def processor_time(work):
    """(s of the processor, result) of one call of `work`: of all threads, and what other programs take is not in it."""
    began = time.process_time()
    result = work()
    return time.process_time() - began, result


def fastest(work, repeats: int):
    """(fewest s by the clock, last result) of `repeats` calls of `work`."""
    best = float("inf")
    for _ in range(repeats):
        seconds, result = wall_time(work)
        best = min(best, seconds)
    return best, result
