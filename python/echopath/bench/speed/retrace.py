"""Traces of the same scene at other times: with the geometry kept from the trace before, beside those that build it anew."""
from __future__ import annotations

import hashlib
import time

import numpy as np

import echopath as ep

from ...actors import shapes
from .frames import street
from .synthesis import waveform

STEP = 5e-3                                # s from trace to trace
REPETITIONS, QUICK_REPETITIONS = 5, 2
RAYS, QUICK_RAYS = 200_000, 2_000
SUBDIVISIONS, QUICK_SUBDIVISIONS = 32, 6   # 1 003 520 triangles in 49 spheres, 35 280 when quick


def spheres(subdivisions: int, car_motion=None):
    """48 spheres at rest and a car, also a sphere: 20 subdivisions^2 triangles each."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.6, scattering=0.8)
    mesh = shapes.sphere(2.0, subdivisions=subdivisions)
    for i in range(48):
        scene.add(mesh, name=f"sphere_{i}", position=(12.0 + 4.5 * (i // 8), 4.2 * (i % 8 - 3.5), 0.0), material=rough)
    scene.add(shapes.sphere(1.0, subdivisions=subdivisions), name="car", position=(6.0, 0.0, -1.0), material=rough,
              motion=car_motion)
    return scene


def cases(quick: bool) -> list:
    """(title, scene, radar): who moves is all that differs between the last three."""
    subdivisions = QUICK_SUBDIVISIONS if quick else SUBDIVISIONS
    driving = ep.LinearMotion(velocity=(10.0, 3.0, 0.0))

    def radar(motion=None):
        return ep.Radar(waveform(1), transmitters=[ep.Antenna()], receivers=[ep.Antenna()], motion=motion)

    demo = street()
    return [("street, a person walks", demo.scene, demo.radar),
            ("spheres, one drives", spheres(subdivisions, driving), radar()),
            ("spheres, the radar drives", spheres(subdivisions), radar(ep.LinearMotion(velocity=(10.0, 0.0, 0.0)))),
            ("spheres, nothing moves", spheres(subdivisions), radar())]


def measure_retrace(*, quick: bool = False) -> list[dict]:
    """Rows {name, triangles, rays, paths, fresh_s, kept_s, same_hits}: medians of processor seconds, in turn; of all traces
    but the first; same_hits: whether all hits and weights have the same bits."""
    return [_row(*case, QUICK_RAYS if quick else RAYS, QUICK_REPETITIONS if quick else REPETITIONS) for case in cases(quick)]


def _row(name: str, scene, radar, rays: int, repetitions: int) -> dict:
    kept, seconds, same = ep._core.KeptGeometry(), {"fresh": [], "kept": []}, True
    for turn in range(repetitions + 1):
        digests = set()
        for how, geometry in (("fresh", None), ("kept", kept)):
            began = time.process_time()
            paths = ep._core.trace(scene, radar, num_rays=rays, start_time=turn * STEP, kept=geometry)
            seconds[how].append(time.process_time() - began)
            digests.add(_digest(paths))
            num_paths = paths.num_paths
            del paths  # the next one has its memory
        same = same and len(digests) == 1
    return {"name": name, "triangles": scene.num_triangles, "rays": rays, "paths": num_paths,
            "fresh_s": float(np.median(seconds["fresh"][1:])), "kept_s": float(np.median(seconds["kept"][1:])),
            "same_hits": same}


def _digest(paths) -> str:
    digest = hashlib.blake2b()
    for name in ("offsets", "mesh_id", "triangle_id", "u", "v", "weight"):
        digest.update(np.ascontiguousarray(getattr(paths, name)))
    return digest.hexdigest()


def describe_retrace(rows: list[dict]) -> list[str]:
    """Lines for people."""
    lines = ["the next trace of a scene, processor time", f"{'':<28}{'triangles':>10}{'rays':>9}{'paths':>11}{'anew':>10}"
             f"{'kept':>10}{'share':>7}  hits"]
    lines += [f"{row['name']:<28}{row['triangles']:>10,}{row['rays']:>9,}{row['paths']:>11,}{row['fresh_s']:>8.3f} s"
              f"{row['kept_s']:>8.3f} s{row['kept_s'] / row['fresh_s']:>7.2f}  "
              f"{'same bits' if row['same_hits'] else 'DIFFER'}"
              for row in rows]
    return [*lines, ""]
