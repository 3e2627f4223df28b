"""What smooth meshes and footprints cost: rays per second, and bytes of a hit and of a path."""
from __future__ import annotations

import time

import numpy as np

import echopath as ep

from ..actors import shapes

REPEATS = 3
PATH_ARRAYS = ("offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "curved_cell")


def measure_costs(radar, *, num_rays: int) -> list[dict]:
    """Two metal spheres of 0.5 m side by side, up to three bounces; one row for each of smooth and footprint."""
    rows = []
    for smooth in (False, True):
        for footprint in ("none", "first_order", "second_order"):
            rows.append(_measure(_two_spheres(smooth), radar, smooth, footprint, num_rays))
    return rows


def _two_spheres(smooth: bool):
    scene = ep.Scene()
    scene.add(None, name="pair")
    mesh = shapes.sphere(0.5, subdivisions=32)
    for side in (-0.55, 0.55):
        scene.add(mesh, name=f"at{side:+g}", parent="pair", material=ep.Material.metal(), position=(20.0, side, 0.0),
                  smooth=smooth)
    return scene


def _measure(scene, radar, smooth: bool, footprint: str, num_rays: int) -> dict:
    base = _fastest(lambda: ep.trace(scene, radar, num_rays=1, footprint=footprint))[0]
    seconds, paths = _fastest(lambda: ep.trace(scene, radar, num_rays=num_rays, max_bounces=3, footprint=footprint))
    replay = _fastest(lambda: paths.amplitude)[0]
    return {"smooth": smooth, "footprint": footprint, "rays_per_second": num_rays / max(seconds - base, 1e-9),
            "setup_seconds": base, "replayed_paths_per_second": paths.num_paths / max(replay, 1e-9),
            "bytes_per_hit": paths.hits.nbytes / max(paths.num_hits, 1),
            "bytes_per_path": sum(np.asarray(getattr(paths, name)).nbytes for name in PATH_ARRAYS) / paths.num_paths,
            "num_hits": paths.num_hits, "num_paths": paths.num_paths}


def _fastest(work):
    best, result = float("inf"), None
    for _ in range(REPEATS):
        began = time.perf_counter()
        result = work()
        best = min(best, time.perf_counter() - began)
    return best, result
