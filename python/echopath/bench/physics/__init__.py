"""`echopath bench physics`: the error of levels against rays and against time, truth from closed forms alone."""
from __future__ import annotations

import dataclasses
import time
from pathlib import Path

import numpy as np

import echopath as ep

from ..machine import machine
from . import report
from .cost import measure_costs
from .targets import Target, all_targets, plate, radar

EXPONENTS = (10, 11, 12, 13, 14, 15, 16, 18, 20)   # of two: numbers of rays
FEW_EXPONENTS = (6, 7, 8, 9)         # before them, for the default: smooth targets converge there
CONVERGED_RAYS = 2 ** 18             # of the level that the slope is measured from
NUM_SHIFTS, NUM_SHIFTS_ABOVE, MANY_RAYS = 20, 8, 2 ** 16
QUICK_SHIFTS, QUICK_RAYS = 6, 2 ** 12
MEANINGFUL_DB = 3.0  # a slope is that of errors from here to report.SETTLED_DB
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
UNFILTERED = FOOTPRINTS[2]
PLATE_ANGLES, PLATE_RAYS = (0.0, 0.5, 1.7, 2.8, 5.0, 7.3, 10.6, 12.9, 15.7, 18.0, 20.3), 2 ** 14
SAMPLERS = (Variant("second_order", "fibonacci"), Variant("second_order", "r2"), Variant("second_order", "random"))


def run_physics(folder, *, rays_max: int = 2 ** 16, quick: bool = False, progress=None) -> dict:
    """Runs all targets, writes physics.json, physics.csv, costs.csv and physics.png into `folder`; returns what the JSON
    holds.

    rays_max: most rays of a trace; quick: few shifts and rays, for a look; progress: callable (stage, fraction) or None
    """
    from .figure import draw_physics

    most = min(rays_max, QUICK_RAYS) if quick else rays_max
    rays = [2 ** exponent for exponent in EXPONENTS if 2 ** exponent <= most]
    shifts = QUICK_SHIFTS if quick else NUM_SHIFTS
    began, used = time.perf_counter(), time.process_time()
    advance = _Progress(progress)
    results = {"machine": machine(), "shifts": shifts, "rays": rays, "targets": {}}
    advance.share(all_targets(), 0.0, 0.7, lambda target: results["targets"].update(
        {target.name: _curves(target, rays, shifts, most)}))
    results["plates"] = []
    advance.share(PLATE_ANGLES, 0.7, 0.95, lambda angle: results["plates"].extend(plate_pairs(angle, rays, shifts)))
    results["costs"] = measure_costs(radar(), num_rays=min(rays_max, 2 ** 16))
    results["must_reach"] = report.verdicts(results)
    results["seconds"], results["processor_seconds"] = time.perf_counter() - began, time.process_time() - used
    report.write_results(results, Path(folder))
    draw_physics(results, Path(folder) / "physics.png")
    advance(1.0)
    return results


class _Progress:
    """Passes the share of the work that is done to a callable (stage, fraction) or to nobody."""

    def __init__(self, progress):
        self._progress = progress

    def __call__(self, fraction: float) -> None:
        if self._progress:
            self._progress("physics", fraction)

    def share(self, items, begin: float, end: float, work) -> None:
        """Does `work` for each item, from the share `begin` to the share `end`."""
        items = list(items)
        for index, item in enumerate(items):
            self(begin + (end - begin) * index / len(items))
            work(item)


def _curves(target: Target, rays: list[int], shifts: int, most: int) -> dict:
    """Errors of one target: {variant: [one dict per number of rays]}, their slopes, and the level that the default converges to,
    None in quick runs, which have too few rays to tell it."""
    variants = (*FOOTPRINTS, *SAMPLERS) if target.compares_footprints else (DEFAULT, *SAMPLERS)
    few = [2 ** exponent for exponent in FEW_EXPONENTS] if most > QUICK_RAYS else []
    curves = {}
    for variant in variants:
        counts = [*few, *rays] if variant == DEFAULT else rays
        curves[variant.label] = [_point(target, variant, count, shifts) for count in counts]
    converged = float(np.mean(_errors(target, DEFAULT, CONVERGED_RAYS, NUM_SHIFTS_ABOVE)[0])) if few else None
    for points in curves.values():
        for point in points:
            errors = np.array(point.pop("errors"))
            point["rms_from_converged_db"] = None if converged is None else _rms(errors - converged)
    return {"title": target.title, "truth": target.truth, "converged_db": converged, "curves": curves,
            "slopes": {label: _slope(points, "rms_db") for label, points in curves.items()},
            "slopes_from_converged": {label: _slope(points, "rms_from_converged_db") for label, points in curves.items()}}


def _rms(values) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _point(target: Target, variant: Variant, num_rays: int, shifts: int) -> dict:
    """Error over shifts of the rays: a seed moves all sets of directions."""
    count = shifts if num_rays < MANY_RAYS else min(shifts, NUM_SHIFTS_ABOVE)
    errors, seconds = _errors(target, variant, num_rays, count)
    return {"num_rays": num_rays, "shifts": count, "rms_db": _rms(errors), "mean_db": float(errors.mean()),
            "worst_db": float(np.abs(errors).max()), "seconds": min(seconds), "errors": errors.tolist()}


def _errors(target: Target, variant: Variant, num_rays: int, count: int):
    """Errors [S] in dB and times [S] in s of trace and replay, one for each shift."""
    errors, seconds = [], []
    for seed in range(1, count + 1):
        began = time.perf_counter()
        paths = ep.trace(target.scene, radar(target.polarization), num_rays=num_rays, max_bounces=target.max_bounces, seed=seed,
                         footprint=variant.footprint, sampler=variant.sampler)
        value = target.value(paths)
        seconds.append(time.perf_counter() - began)
        errors.append(10.0 * np.log10(max(value / target.truth, LEAST_POWER)))
    return np.array(errors), seconds


def plate_pairs(angle_deg: float, rays: list[int], shifts: int) -> list[dict]:
    """Plates with and without the filter over the same shifts: errors, and the margin with its standard error, in dB."""
    target, rows = plate(angle_deg), []
    for num_rays in [count for count in rays if count >= PLATE_RAYS]:
        filtered, unfiltered = (_errors(target, variant, num_rays, 2 * shifts)[0] for variant in (DEFAULT, UNFILTERED))
        squares = filtered ** 2 - unfiltered ** 2
        with_filter, without = _rms(filtered), _rms(unfiltered)
        error = squares.std(ddof=1) / np.sqrt(len(squares)) / max(with_filter + without, 1e-12)
        rows.append({"angle_deg": angle_deg, "num_rays": num_rays, "shifts": len(squares), "filtered_db": with_filter,
                     "unfiltered_db": without, "margin_db": with_filter - without, "margin_error_db": float(error)})
    return rows


def _slope(points: list[dict], quantity: str) -> float | None:
    """Of log error over log rays, least squares: from the first error below 3 dB to the first below 0.01 dB.

    None for fewer than three numbers of rays there, and where the quantity is not known.
    """
    if points[0][quantity] is None:
        return None
    errors = np.array([max(point[quantity], 1e-9) for point in points])
    meant, settled = errors < MEANINGFUL_DB, errors < report.SETTLED_DB
    begin = int(np.argmax(meant)) if meant.any() else len(errors)
    end = int(np.argmax(settled)) + 1 if settled.any() else len(errors)
    if end - begin < 3:
        return None
    rays = [point["num_rays"] for point in points[begin:end]]
    return float(np.polyfit(np.log(rays), np.log(errors[begin:end]), 1)[0])
