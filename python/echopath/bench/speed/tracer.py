"""The tracer beside a bare loop over its own Embree queries."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...actors import shapes
from .synthesis import waveform

SUBDIVISIONS, QUICK_SUBDIVISIONS = (10, 32, 100), (10,)   # 10k, 102k and 1M triangles in all
TARGETS = {10: 0.80, 32: 0.85, 100: 0.90}                 # of the bare loop
RAYS, QUICK_RAYS = 200_000, 2_000
REPETITIONS = 5


def rough_spheres(subdivisions: int):
    """Five rough spheres in a row, 100 subdivisions^2 triangles."""
    scene = ep.Scene()
    mesh = shapes.sphere(2.0, subdivisions=subdivisions)
    rough = ep.Material(reflectivity=0.6, scattering=0.8)
    for i in range(5):
        scene.add(mesh, name=f"sphere_{i}", position=(15.0, 4.2 * (i - 2), 0.0), material=rough)
    return scene


def measure_tracer(*, quick: bool = False) -> list[dict]:
    """Rows by triangles and threads: medians of processor seconds of trace and queries alone."""
    radar = ep.Radar(waveform(1), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    threads = ep.num_threads()
    rows = []
    try:
        for subdivisions in QUICK_SUBDIVISIONS if quick else SUBDIVISIONS:
            scene = rough_spheres(subdivisions)
            for count in sorted({1, threads}):
                ep.set_num_threads(count)
                rows.append({"triangles": 100 * subdivisions ** 2, "threads": count, "target": TARGETS[subdivisions],
                             **bare_share(scene, radar, QUICK_RAYS if quick else RAYS)})
    finally:
        ep.set_num_threads(threads)
    return rows


def bare_share(scene, radar, num_rays: int, repetitions: int = REPETITIONS) -> dict:
    """Queries of a trace, seconds by the clock of the trace and of the queries alone, packed alike, and processor time of
    the queries, packed alike (`share`) and one by one (`single_share`), over that of the trace."""
    found = ep._core.bench.bare_queries(scene, radar, num_rays=num_rays, repetitions=repetitions)

    def seconds(work: str, kind: str) -> float:
        return float(np.median(found[f"{work}_seconds"][kind]))

    trace_s = seconds("trace", "processor")
    return {"queries": found["num_queries"], "trace_s": seconds("trace", "elapsed"), "bare_s": seconds("bare", "elapsed"),
            "share": seconds("bare", "processor") / trace_s, "single_share": seconds("single", "processor") / trace_s}
