"""What each term costs: rays per second, and bytes of a hit and of a path, with one term on at a time."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep

from ...actors import shapes
from ..timing import fastest

REPEATS = 3
PATH_ARRAYS = ("offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "curved_cell", "jones")
OPTIONAL_ARRAYS = ("curved_cell", "jones")


@dataclasses.dataclass(frozen=True)
class Terms:
    """Which terms a row has; the first row has none."""

    label: str
    smooth: bool = False
    footprint: str = "none"
    polarization: str = "scalar"
    rough: bool = False


ROWS = (Terms("all off"), Terms("first-order footprint", footprint="first_order"),
        Terms("second-order footprint", footprint="second_order"), Terms("smooth", smooth=True),
        Terms("jones", polarization="jones"), Terms("diffuse", rough=True),
        Terms("all on", True, "second_order", "jones", True))


def measure_costs(radar, *, num_rays: int) -> list[dict]:
    """Two spheres of 0.5 m side by side, up to three bounces; one row for each of ROWS."""
    return [_measure(terms, radar, num_rays) for terms in ROWS]


def _two_spheres(terms: Terms):
    scene = ep.Scene()
    scene.add(None, name="pair")
    mesh = shapes.sphere(0.5, subdivisions=40)
    material = ep.Material(reflectivity=1.0, scattering=np.sqrt(0.5)) if terms.rough else ep.Material.metal()
    for side in (-0.55, 0.55):
        scene.add(mesh, name=f"at{side:+g}", parent="pair", material=material, position=(20.0, side, 0.0),
                  smooth=terms.smooth)
    return scene


def _measure(terms: Terms, radar, num_rays: int) -> dict:
    scene = _two_spheres(terms)
    settings = {"max_bounces": 3, "footprint": terms.footprint, "polarization": terms.polarization}
    base = fastest(lambda: ep.trace(scene, radar, num_rays=1, **settings), REPEATS)[0]
    seconds, paths = fastest(lambda: ep.trace(scene, radar, num_rays=num_rays, **settings), REPEATS)
    replay = fastest(lambda: paths.amplitude, REPEATS)[0]
    sizes = {name: np.asarray(getattr(paths, name)).nbytes / paths.num_paths for name in PATH_ARRAYS}
    return {**dataclasses.asdict(terms), "rays_per_second": num_rays / max(seconds - base, 1e-9), "setup_seconds": base,
            "replayed_paths_per_second": paths.num_paths / max(replay, 1e-9),
            "bytes_per_hit": paths.hits.nbytes / max(paths.num_hits, 1), "bytes_per_path": sum(sizes.values()),
            **{f"bytes_of_{name}": sizes[name] for name in OPTIONAL_ARRAYS},
            "num_hits": paths.num_hits, "num_paths": paths.num_paths}
