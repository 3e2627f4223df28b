"""`echopath bench physics`: the error of levels against rays and against time, truth from closed forms alone."""
from __future__ import annotations

import dataclasses
import json
import platform
import time
from pathlib import Path

import numpy as np

import echopath as ep

from ..files import written_whole
from .cost import measure_costs
from .targets import Target, all_targets, radar

EXPONENTS = (10, 11, 12, 13, 14, 15, 16, 18, 20)   # of two: numbers of rays
NUM_SHIFTS, NUM_SHIFTS_ABOVE, MANY_RAYS = 20, 8, 2 ** 15
QUICK_SHIFTS, QUICK_RAYS = 6, 2 ** 12
FLOOR_DB, FLOOR_MARGIN = 0.01, 1.5  # error that counts as settled: absolute, and over the least of the curve
LEAST_POWER = 1e-12  # of the truth: what a sum of nothing counts as


@dataclasses.dataclass(frozen=True)
class Variant:
    """One way to trace; `label` as in tables and figures."""

    footprint: str
    sampler: str

    @property
    def label(self) -> str:
        return f"{self.footprint} {self.sampler}"


DEFAULT = Variant("second_order", "lattice")
FOOTPRINTS = (DEFAULT, Variant("first_order", "lattice"), Variant("none", "lattice"))
SAMPLERS = (Variant("second_order", "fibonacci"), Variant("second_order", "r2"), Variant("second_order", "random"))


def run_physics(folder, *, rays_max: int = 2 ** 16, quick: bool = False, progress=None) -> dict:
    """Runs all targets, writes physics.json and physics.png into `folder` and returns what the JSON holds.

    rays_max: most rays of a trace; quick: few shifts and rays, for a look; progress: callable (stage, fraction) or None
    """
    from .figure import draw_physics
    from .report import verdicts

    most = min(rays_max, QUICK_RAYS) if quick else rays_max
    rays = [2 ** exponent for exponent in EXPONENTS if 2 ** exponent <= most]
    shifts = QUICK_SHIFTS if quick else NUM_SHIFTS
    began = time.perf_counter()
    targets = all_targets()
    curves = {}
    for index, target in enumerate(targets):
        curves[target.name] = _curves(target, rays, shifts)
        if progress:
            progress("physics", (index + 1) / len(targets))
    results = {"machine": _machine(), "shifts": shifts, "rays": rays, "targets": curves,
               "costs": measure_costs(radar(), num_rays=min(rays_max, 2 ** 16))}
    results["must_reach"] = verdicts(results)
    results["seconds"] = time.perf_counter() - began
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with written_whole(folder / "physics.json") as temporary:
        Path(temporary).write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    draw_physics(results, folder / "physics.png")
    return results


def _curves(target: Target, rays: list[int], shifts: int) -> dict:
    variants = (*FOOTPRINTS, *SAMPLERS) if target.compares_footprints else (DEFAULT, *SAMPLERS)
    curves = {variant.label: [_point(target, variant, count, shifts) for count in rays] for variant in variants}
    return {"title": target.title, "truth": target.truth, "curves": curves,
            "slopes": {label: _slope(points) for label, points in curves.items()}}


def _point(target: Target, variant: Variant, num_rays: int, shifts: int) -> dict:
    """Error over shifts of the rays: a seed moves all sets of directions."""
    count = shifts if num_rays < MANY_RAYS else min(shifts, NUM_SHIFTS_ABOVE)
    errors, seconds = [], []
    for seed in range(1, count + 1):
        began = time.perf_counter()
        paths = ep.trace(target.scene, radar(), num_rays=num_rays, max_bounces=target.max_bounces, seed=seed,
                         footprint=variant.footprint, sampler=variant.sampler)
        value = target.value(paths)
        seconds.append(time.perf_counter() - began)
        errors.append(10.0 * np.log10(max(value / target.truth, LEAST_POWER)))
    errors = np.array(errors)
    return {"num_rays": num_rays, "shifts": count, "rms_db": float(np.sqrt(np.mean(errors ** 2))),
            "mean_db": float(errors.mean()), "worst_db": float(np.abs(errors).max()),
            "seconds": min(seconds)}


def _slope(points: list[dict]) -> float | None:
    """Of log error over log rays, least squares, until the error reaches what mesh and closed form leave, not the rays.

    None for fewer than three numbers of rays.
    """
    errors = np.array([max(point["rms_db"], 1e-9) for point in points])
    floor = max(FLOOR_DB, FLOOR_MARGIN * errors.min())
    used = int(np.argmax(errors <= floor)) + 1 if np.any(errors <= floor) else len(errors)
    if len(points) < 3 or used < 3:
        return None
    rays = [point["num_rays"] for point in points[:used]]
    return float(np.polyfit(np.log(rays), np.log(errors[:used]), 1)[0])


def _machine() -> dict:
    return {"processor": _processor(), "threads": ep.num_threads(), "system": platform.platform(),
            "python": platform.python_version(), "numpy": np.__version__, "echopath": ep.__version__}


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
