"""`echopath bench labels`: what parts cost beside the whole signal, how fast expressions are matched, false alarms."""
from __future__ import annotations

import time
from importlib.resources import as_file
from pathlib import Path

import numpy as np

import echopath as ep

from ...base.storage.data_folder import data_folder
from ...base.storage.files import write_texts
from ...scene_file import load_scene
from ...signals.measures import residual
from ..machine import machine
from ..steps import json_text
from ..timing import processor_time
from .false_alarms import describe_false_alarms, measure_false_alarms

RAYS, QUICK_RAYS = (5_000, 50_000), (1_000,)
NUM_PARTS = (1, 4, 16, 64)
REPEATS, QUICK_REPEATS = 3, 2
NUM_HITS, QUICK_NUM_HITS = 4_000_000, 200_000
MATCH_REPEATS = 9
NOISE_CELLS, QUICK_NOISE_CELLS = 10_000_000, 300_000
RATE_TARGET = 200e6    # hits/s on one core
SUM_TARGET = 1e-12     # |whole - sum of parts| / |whole|
HITS_PER_PATH = ((1, 1), (1, 4), (1, 16))
EXPRESSIONS = ("T .* R", "T .* 'wall_*' .* R", "T 'pedestrian' R", "T (S+ | D['floor' '*left'] .{1,3})+ R")


def run_labels(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures on the street scene, writes labels.json and labels.png into `folder` and returns what the JSON holds.

    quick: few rays, for a look; progress: callable (stage, fraction) or None
    """
    from .figure import draw_labels

    began = time.perf_counter()
    with as_file(data_folder("scenes") / "street.toml") as path:
        street = load_scene(path)
    all_rays = QUICK_RAYS if quick else RAYS
    num_steps = len(all_rays) + len(HITS_PER_PATH) + 2
    steps = iter(np.arange(1, num_steps + 1) / num_steps)
    results = {"machine": machine(), "parts": [], "rates": []}
    for rays in all_rays:
        paths = ep.trace(street.scene, street.radar, num_rays=rays)
        results["parts"].append({"rays": rays, "paths": paths.num_paths,
                                 "rows": _cost_of_parts(paths, QUICK_REPEATS if quick else REPEATS)})
        _tell(progress, steps)
    results["rates"].append(_rates(f"street, {all_rays[-1]:,} rays", paths))
    _tell(progress, steps)
    for least, most in HITS_PER_PATH:
        made = random_paths(paths, QUICK_NUM_HITS if quick else NUM_HITS, least, most)
        results["rates"].append(_rates(f"random, {least} to {most} hits" if most > least else f"random, hits: {least}",
                                       made))
        _tell(progress, steps)
    results["false_alarms"] = measure_false_alarms(QUICK_NOISE_CELLS if quick else NOISE_CELLS)
    _tell(progress, steps)
    results["seconds"] = time.perf_counter() - began
    folder = Path(folder)
    write_texts(folder, {"labels.json": json_text(results)})
    draw_labels(results, folder / "labels.png", rate_target=RATE_TARGET)
    return results


def _tell(progress, steps) -> None:
    fraction = float(next(steps))
    if progress:
        progress("labels", fraction)


# --- parts ---

def partition_of(paths, num_parts: int) -> dict:
    """A partition of `num_parts` parts, "other" counted: by mesh that is touched and number of bounces."""
    names = [mesh.name for mesh in paths.scene.meshes]
    pairs = [(name, count) for count in (1, 2, 3, 4) for name in names]
    chosen = np.linspace(0, len(pairs) - 1, num_parts - 1).astype(int) if num_parts > 1 else []
    return {f"{pairs[i][0]}, {pairs[i][1]}": ep.hits(pairs[i][0]) & (ep.num_bounces == pairs[i][1]) for i in chosen}


def _cost_of_parts(paths, repeats: int) -> list[dict]:
    """A row for each number of parts: processor time of decompose over that of synthesize just before, median of repeats."""
    rows = []
    for num_parts in NUM_PARTS:
        parts, ratios, seconds = partition_of(paths, num_parts), [], []
        for _ in range(repeats):
            whole_seconds, whole = processor_time(lambda: ep.synthesize(paths))
            part_seconds, cubes = processor_time(lambda: ep.decompose(paths, None, parts))
            ratios.append(part_seconds / whole_seconds)
            seconds.append(part_seconds)
        matching, _ = processor_time(lambda: ep._core.partition_groups(paths, list(parts.items())))
        rows.append({"num_parts": num_parts, "num_filled": sum(bool(cube.any()) for cube in cubes.values()),
                     "over_synthesize": float(np.median(ratios)), "processor_s": float(np.median(seconds)),
                     "matching_s": matching, "sum_error": residual(whole, cubes)})
    return rows


# --- matching ---

def random_paths(paths, num_hits: int, least: int, most: int):
    """Paths of `least` to `most` hits on random meshes of the scene, about `num_hits` in all; of no power.

    paths: whose scene, radar and frame they take.
    """
    draw = np.random.default_rng(1)
    counts = draw.integers(least, most + 1, size=max(1, round(2 * num_hits / (least + most))))
    total = int(counts.sum())
    hits = np.zeros(total, paths.hits.dtype)
    hits["mesh_id"] = draw.integers(0, len(paths.scene.meshes), total)
    none = np.zeros(len(counts))
    return ep.Paths.from_arrays(
        hits=hits, offsets=np.cumsum(counts) - counts, num_bounces=counts.astype(np.uint8),
        diffuse=draw.integers(0, 2**63, len(counts), np.uint64)
        & ((np.uint64(1) << counts.astype(np.uint64)) - np.uint64(1)),
        weight=none.astype(np.complex64), stratum=none.astype(np.uint16), batch=none.astype(np.uint8),
        flags=none.astype(np.uint32), scene=paths.scene, radar=paths.radar, frame=paths.frame,
        jones=np.zeros((len(none), 2, 2), np.complex64) if paths.frame.polarization == "jones" else None)


def _rates(title: str, paths) -> dict:
    """Hits per second on one core: a bare loop over the same memory, and each expression."""
    hits = int(paths.num_bounces.sum(dtype=np.int64))
    threads = ep.num_threads()
    ep.set_num_threads(1)
    try:
        bare = hits / _least_time(lambda: _read_hits(paths))
        rates = {text: hits / _least_time(lambda text=text: ep.Selection(text).matches(paths)) for text in EXPRESSIONS}
    finally:
        ep.set_num_threads(threads)
    return {"title": title, "paths": paths.num_paths, "hits": hits, "bare_hits_per_second": bare, "hits_per_second": rates}


def _read_hits(paths) -> None:
    """Reads what matching reads of every path, on one thread: mesh IDs and events."""
    np.bitwise_xor.reduce(paths.mesh_id)
    np.bitwise_xor.reduce(paths.diffuse)


def _least_time(work) -> float:
    return min(processor_time(work)[0] for _ in range(MATCH_REPEATS))


# --- words ---

def describe(results: dict) -> list[str]:
    """Lines for people: cost of parts, additivity, rates of matching against the target."""
    found = results["machine"]
    lines = [f"{found['processor']}, {found['threads']} threads", "",
             "street, processor time of decompose over that of synthesize (median); |whole - sum of parts| / |whole|",
             f"{'rays':>10}{'paths':>12}{'parts':>8}{'of them lit':>13}{'over synthesize':>17}{'matching, s':>13}"
             f"{'sum':>10}"]
    for case in results["parts"]:
        for row in case["rows"]:
            verdict = "" if row["sum_error"] <= SUM_TARGET else "   MISSED 1e-12"
            lines.append(f"{case['rays']:>10,}{case['paths']:>12,}{row['num_parts']:>8}{row['num_filled']:>13}"
                         f"{row['over_synthesize']:>17.2f}{row['matching_s']:>13.3f}{row['sum_error']:>10.1e}{verdict}")
    lines += ["", f"matching on one core, M hits/s (promised: {RATE_TARGET * 1e-6:.0f}; over the time of a bare loop)"]
    for case in results["rates"]:
        lines.append(f"  {case['title']:<44}{case['bare_hits_per_second'] * 1e-6:8.0f}  bare loop")
        for text, rate in case["hits_per_second"].items():
            verdict = "holds" if rate >= RATE_TARGET else "MISSED"
            lines.append(f"    {text:<42}{rate * 1e-6:8.0f}  {case['bare_hits_per_second'] / rate:5.2f}  {verdict}")
    return lines + ["", *describe_false_alarms(results["false_alarms"]), "", f"{results['seconds']:.0f} s in all"]
