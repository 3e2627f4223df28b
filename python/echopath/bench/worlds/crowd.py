"""A crowd of 20 cars and 20 people: labels beside synthesis, their memory, and visibility.

The signals of the labels' families add up to the whole, so that `annotate` makes the cube on its way, and a labelled frame
pays for that once. What labels cost beside the synthesis that a frame has anyhow is therefore the time of `annotate` without
that of one synthesis: the limit is of this, over synthesis ("labels at most as long as synthesis"). The time of `annotate` as
a whole, which is more by one, stands beside it.
"""
from __future__ import annotations

import resource

import numpy as np

import echopath as ep

from ...paths.families import families
from ...paths.visibility import visibility_in_trace
from ..alone import alone
from ..suite import describe_judged, judged
from ..timing import processor_time
from . import crowd_scene

EACH, QUICK_EACH = 20, 3
RAYS, QUICK_RAYS = 100_000, 5_000
GIB = 2.0 ** 30
LIMITS = {"peak memory, GiB": 1.0, "labels beyond synthesis, over it": 1.0, "visibility, ms an object": 0.3,
          "sum over whole - 1": 1e-12}


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each figure: what, measured, limit and whether it holds; times are of the processor, in one run.

    quick: a small crowd, for a look
    """
    found = alone(_labels, QUICK_EACH if quick else EACH, QUICK_RAYS if quick else RAYS, start="forkserver")
    return [row | {"what": f"crowd: {row['what']}"} for row in judged(found, LIMITS)]


def describe(rows: list[dict]) -> list[str]:
    """What, the figure, its limit, and whether it holds."""
    return describe_judged(rows)


def _labels(each: int, rays: int) -> dict:
    scene, radar = crowd_scene.crowd(each), crowd_scene.radar()
    frame = ep.simulate(scene, radar, num_rays=rays, labels=True, noise_seed=None, guard=False)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0
    paths, labels = frame.paths, frame.labels["parts"]
    synthesis, cube = processor_time(lambda: ep.synthesize(paths, radar))
    annotation, _ = processor_time(lambda: ep.annotate(paths, None, radar))
    looking, seen = processor_time(lambda: visibility_in_trace(paths, radar))
    return {"paths": paths.num_paths, "families": len(families(paths)), "families left out": labels.left_out.families,
            "left out together, dBm": _dbm(labels.left_out.power), "at most in a cell, dBm": _dbm(labels.left_out.bound),
            "noise of a cell, dBm": _dbm(labels.noise_power), "peak memory, GiB": peak / GIB, "synthesis, s": synthesis,
            "annotate over synthesis": annotation / synthesis,
            "labels beyond synthesis, over it": annotation / synthesis - 1.0,
            "visibility, ms an object": 1e3 * looking / len(seen),
            "sum over whole - 1": float(np.linalg.norm(frame.cube - cube) / np.linalg.norm(cube))}


def _dbm(power: float) -> float:
    return float(10.0 * np.log10(max(power, 1e-300) * 1e3))
