"""What the guard costs: signals of the street with and without its spot checks, in turn."""
from __future__ import annotations

import statistics

import echopath as ep

from ..timing import processor_time
from .frames import street

RAYS, QUICK_RAYS, REPEATS, QUICK_REPEATS = 60_000, 10_000, 11, 3
TARGET = 0.03  # of the processor time of trace and signal: the most that the guard may cost, said only here


def measure_guard(*, quick: bool = False) -> dict:
    """Medians of processor seconds of trace, signal without and with spot checks, and the share of the guard in the sum."""
    scene = street()
    settings = scene.trace.replace(num_rays=QUICK_RAYS if quick else RAYS)
    seconds = {"trace_s": [], "without_s": [], "with_s": []}
    for turn in range(QUICK_REPEATS if quick else REPEATS):
        trace_s, paths = processor_time(lambda: ep.trace(scene.scene, scene.radar, settings=settings))
        seconds["trace_s"].append(trace_s)
        probes = {"without_s": None, "with_s": ep.SignalProbe(seed=turn)}
        for name in sorted(probes, reverse=turn % 2 == 1):  # whichever comes first finds the memory of the other one cold
            seconds[name].append(processor_time(lambda: ep.synthesize(paths, probe=probes[name]))[0])
    found = {name: statistics.median(values) for name, values in seconds.items()}
    added = max(0.0, found["with_s"] - found["without_s"])
    return {"paths": paths.num_paths, **found, "share": added / (found["trace_s"] + found["without_s"])}


def describe_guard(found: dict) -> list[str]:
    """A line for people."""
    return ["", f"guard of the street, {found['paths']:,} paths, processor time: trace {found['trace_s']:.3f} s, signal "
            f"{found['without_s']:.3f} s, with spot checks {found['with_s']:.3f} s: {100.0 * found['share']:.1f} % of both"]
