"""`echopath bench crowd`: each object of a crowded scene against itself traced alone, and whether the run says which errs."""
from __future__ import annotations

import dataclasses
import time
from pathlib import Path

import numpy as np

import echopath as ep

from ...base.storage.files import write_texts
from ..machine import machine
from ..speed.tracer import bare_share
from ..steps import json_text, told
from ..suite import judged_row
from ..timing import processor_time
from . import scenes
from .coverage import measure_coverage

RAYS, QUICK_RAYS = 300_000, 20_000
SEEDS, QUICK_SEEDS = 3, 1
ALONE_RAYS, QUICK_ALONE_RAYS = 2 ** 20, 2 ** 14
MAX_BOUNCES = 4
WANTED_DB, RIGHT_DB = 0.3, 0.1       # an echo errs by no more, or is flagged; one that errs by this is not flagged
GROUND_RAYS, QUICK_GROUND_RAYS = (100_000, 1_000_000), (20_000,)
PERSON_RAYS, PERSON_SEEDS = 100_000, 12
QUICK_PERSON_RAYS, QUICK_PERSON_SEEDS = 10_000, 2
CITIES, QUICK_CITIES = ((80, 3), (80, 4), (500, 2), (500, 3)), ((10, 2),)   # houses of five mirrors, most bounces
CITY_SECONDS = 1.0                   # of processor time, without rays, for what CITY_ASKED asks
CITY_ASKED = ((80, 3), (500, 2))
JUDGED_RUNS = 20                     # of a coverage, fewer of which tell it to no better than .05
PERSON_ERROR = 0.01                  # relative, standard error of his direct power


def run_crowd(folder, *, quick: bool = False, seeds: int | None = None, progress=None) -> dict:
    """Measures everything, writes crowd.json and crowd.png into `folder` and returns what the JSON holds.

    quick: few rays and seeds, for a look; seeds: scenes of each echo whose coverage is measured, None: as many as end in some
    ten minutes (coverage.NUM_SEEDS); progress: callable (stage, fraction) or None
    """
    from .figure import draw_crowd

    began = time.perf_counter()
    works = {"streets": lambda: measure_streets(quick=quick, progress=progress),
             "ground": lambda: measure_ground(quick=quick), "person": lambda: measure_person(quick=quick),
             "mirrors": lambda: measure_mirrors(quick=quick),
             "coverage": lambda: measure_coverage(quick=quick, seeds=seeds, progress=progress)}
    results = {"machine": machine(), "quick": quick} | {name: works[name]() for name in told(list(works), "crowd", progress)}
    results["must_reach"] = verdicts(results)
    results["seconds"] = time.perf_counter() - began
    folder = Path(folder)
    write_texts(folder, {"crowd.json": json_text(results)})
    draw_crowd(results, folder / "crowd.png", wanted_db=WANTED_DB)
    return results


@dataclasses.dataclass(frozen=True)
class Level:
    """A mean power as a run reports it. power: W; error_db: dB, half its 95 % interval; flagged: the run says that the
    power may err by more than WANTED_DB; paths: behind it."""

    power: float
    error_db: float
    flagged: bool
    paths: int


def level_of(paths) -> Level:
    found = ep.received_power(paths)
    return Level(found.power, found.interval_db, not found.resolved, paths.num_paths)


def direct(paths, name: str):
    """The echoes that touch that object alone, as often as they like."""
    return paths.select(f"T '{name}'+ R")


def decibels(power: float, truth: float) -> float:
    """Of the ratio, at least -99 dB. What is not a number is no result: it would compare as right or wrong by chance."""
    if not (np.isfinite(power) and np.isfinite(truth)):
        raise ValueError(f"power, truth: must be finite, got {power} W, {truth} W")
    return float(10.0 * np.log10(max(power / truth, 10.0 ** -9.9)))


# --- the street ---

def measure_streets(*, quick: bool, progress=None) -> list[dict]:
    """Both streets, with flagged mirrors and with rough concrete; progress: callable (stage, fraction) or None."""
    names, radar = scenes.street_names(), scenes.radar()
    objects = [(name, False) for name in names] + [(name, True) for name in names if name in scenes.BACKDROPS]
    alone = {of: _alone(of[0], radar, of[1], quick) for of in told(objects, "objects alone", progress)}
    return [measure_street({name: alone[name, mirrors and name in scenes.BACKDROPS] for name in names}, mirrors=mirrors,
                           quick=quick) for mirrors in told([True, False], "streets", progress)]


def measure_street(alone: dict, *, mirrors: bool, quick: bool) -> dict:
    """Seconds of the trace and of its bare queries, and a row for each object. alone: what `_alone` says of each, by name."""
    radar, scene = scenes.radar(), scenes.street(mirrors=mirrors)
    rays, names = QUICK_RAYS if quick else RAYS, list(alone)

    def levels_of(seed: int) -> dict:
        paths = ep.trace(scene, radar, num_rays=rays, max_bounces=MAX_BOUNCES, seed=seed)
        return {name: level_of(direct(paths, name)) for name in names}

    runs = [levels_of(seed) for seed in range(1, (QUICK_SEEDS if quick else SEEDS) + 1)]
    noise = ep._core.noise_power_in_cell(radar)
    rows = [_row(name, *alone[name], [levels[name] for levels in runs], noise) for name in names]
    return {"title": "flagged mirrors" if mirrors else "rough concrete", "rays": rays, "rows": rows,
            **bare_share(scene, radar, rays, repetitions=1 if quick else 3)}


def _alone(name: str, radar, mirrors: bool, quick: bool) -> tuple[float, float]:
    """Direct power in W of an object traced alone, and by how many dB two seeds of it differ."""
    scene = scenes.alone(name, mirrors=mirrors)
    powers = [ep.received_power(direct(ep.trace(scene, radar, num_rays=QUICK_ALONE_RAYS if quick else ALONE_RAYS,
                                                max_bounces=MAX_BOUNCES, seed=seed), name)).power for seed in (101, 102)]
    mean = float(np.mean(powers))
    return mean, abs(decibels(powers[0], powers[1])) if min(powers) > 0.0 else 0.0


def _row(name: str, truth: float, spread_db: float, levels: list[Level], noise: float) -> dict:
    errors = [0.0 if truth == 0.0 else decibels(level.power, truth) for level in levels]
    return {"name": name, "truth_dbm": float(10.0 * np.log10(max(truth, 1e-300) * 1e3)), "alone_spread_db": spread_db,
            "snr_db": decibels(truth, noise), "error_db": errors, "claimed_db": [level.error_db for level in levels],
            "flagged": [level.flagged for level in levels], "paths": [level.paths for level in levels],
            "verdict": [judged(error, level.flagged) for error, level in zip(errors, levels)]}


def judged(error_db: float, flagged: bool) -> str:
    """right or flagged, as wanted; MISSED: wrong by more than WANTED_DB and not flagged; NEEDLESS: flagged, yet right."""
    error = abs(error_db)
    if flagged:
        return "NEEDLESS" if error <= RIGHT_DB else "flagged"
    return "right" if error <= WANTED_DB else "MISSED"


# --- the ground of a city ---

def measure_ground(*, quick: bool) -> list[dict]:
    """A row for each number of rays: the ground's path against the image method."""
    scene, radar = scenes.city_ground()
    truth = scenes.ground_path_power(radar.transmit_power)
    rows = []
    for rays in QUICK_GROUND_RAYS if quick else GROUND_RAYS:
        paths = ep.trace(scene, radar, num_rays=rays, max_bounces=1)
        level = level_of(paths.select("T 'ground' R"))
        error = decibels(level.power, truth)
        rows.append({"rays": rays, "error_db": error, "claimed_db": level.error_db, "flagged": level.flagged,
                     "verdict": judged(error, level.flagged)})
    return rows


# --- a person among thousands of flat objects ---

def measure_person(*, quick: bool) -> dict:
    """Scatter of his direct power over seeds, relative, beside the one that the intervals claim."""
    scene, radar = scenes.flat_city()
    rays, num_seeds = (QUICK_PERSON_RAYS, QUICK_PERSON_SEEDS) if quick else (PERSON_RAYS, PERSON_SEEDS)
    levels = [level_of(direct(ep.trace(scene, radar, num_rays=rays, max_bounces=2, seed=seed), "person"))
              for seed in range(1, num_seeds + 1)]
    powers = np.array([level.power for level in levels])
    mean = float(powers.mean())
    claimed = [0.5 * (10.0 ** (0.1 * level.error_db) - 1.0) for level in levels]
    return {"rays": rays, "seeds": num_seeds, "objects": scene_size(scene),
            "paths": float(np.mean([one.paths for one in levels])),
            "scatter": float(powers.std(ddof=1) / mean) if mean > 0.0 else float("inf"),
            "claimed": float(np.sqrt(np.mean(np.square(claimed)))), "flagged": sum(one.flagged for one in levels)}


# --- a city of mirrors ---

def measure_mirrors(*, quick: bool) -> list[dict]:
    """A row for each city: paths over mirrors alone by number of bounces, and processor seconds of a trace of one ray."""
    rows = []
    for houses, bounces in QUICK_CITIES if quick else CITIES:
        scene, radar = scenes.mirror_city(houses)
        seconds, paths = processor_time(lambda: ep.trace(scene, radar, num_rays=1, max_bounces=bounces))
        counts = np.bincount(np.asarray(paths.num_bounces), minlength=bounces + 1)[1:]
        rows.append({"houses": houses, "mirrors": len(scene.meshes), "max_bounces": bounces, "paths": counts.tolist(),
                     "unfollowed": paths.frame.statistics.num_unfollowed_frusta, "processor_s": seconds})
    return rows


def scene_size(scene) -> int:
    """Number of children of the scene's root."""
    return sum(node.parent < 0 for node in scene.nodes)


# --- words ---

def verdicts(results: dict) -> list[dict]:
    """What the crowd must reach: one row {what, limit, measured, holds} each."""
    rows = []
    for street in results["streets"]:
        verdict = [one for row in street["rows"] for one in row["verdict"]]
        rows += [judged_row(f"street, {street['title']}: objects off by over {WANTED_DB} dB and not flagged",
                            verdict.count("MISSED"), 0),
                 judged_row(f"street, {street['title']}: objects right to {RIGHT_DB} dB and flagged",
                            verdict.count("NEEDLESS"), 0)]
    rows += [judged_row(f"city ground, {row['rays']:,} rays: off by over {WANTED_DB} dB and not flagged",
                        int(row["verdict"] == "MISSED"), 0) for row in results["ground"]]
    rows.append(judged_row("person among 2400: scatter of his direct power", results["person"]["scatter"], PERSON_ERROR))
    rows += [judged_row(f"{row['mirrors']} mirrors, {row['max_bounces']} bounces: processor seconds", row["processor_s"],
                        CITY_SECONDS) for row in results["mirrors"] if (row["houses"], row["max_bounces"]) in CITY_ASKED]
    rows += [judged_row(f"{row['mirrors']} mirrors, {row['max_bounces']} bounces: sequences not followed", row["unfollowed"], 0)
             for row in results["mirrors"]]
    low, high = results["coverage"]["wanted"]
    least = results["coverage"]["wanted_of_one"]
    enough = [row for row in results["coverage"]["rows"] if row["count"] >= JUDGED_RUNS]
    if enough:
        worst = min(enough, key=lambda row: row["coverage"])
        rows.append({"what": f"coverage, the worst: {worst['kind']}, {worst['rays']:,} rays: at least {least}", "limit": least,
                     "measured": worst["coverage"], "holds": bool(worst["coverage"] >= least)})
    for row in results["coverage"]["classes"]:
        if row["count"] < JUDGED_RUNS:
            continue
        holds = low <= row["coverage"] <= high
        rows.append({"what": f"coverage, {row['kind']}, {row['count']} runs: {low} to {high}", "limit": low,
                     "measured": row["coverage"], "holds": bool(holds)})
    return rows


def describe(results: dict) -> list[str]:
    """Lines for people: the streets by object, ground, person, coverage, and what must be reached."""
    found = results["machine"]
    lines = [f"{found['processor']}, {found['threads']} threads, echopath {found['echopath']}"]
    for street in results["streets"]:
        lines += ["", *_describe_street(street)]
    lines += ["", "ground of a city, 30 m from transmitter to receiver, against the image method"]
    lines += [f"  {row['rays']:>9,} rays: {row['error_db']:+7.2f} dB, claimed +-{row['claimed_db']:.2f}, {row['verdict']}"
              for row in results["ground"]]
    person = results["person"]
    lines += ["", f"person at 40 m among {person['objects'] - 1} flat objects, {person['rays']:,} rays, {person['seeds']} seeds: "
              f"{person['paths']:.0f} direct paths, scatter {100 * person['scatter']:.2f} %, "
              f"claimed {100 * person['claimed']:.2f} %, flagged {person['flagged']} times", "", "paths over mirrors alone"]
    lines += [f"  {row['mirrors']:>5} mirrors, {row['max_bounces']} bounces: {row['paths']} paths by bounces, "
              f"{row['processor_s']:.2f} s of processor time, {row['unfollowed']} sequences not followed"
              for row in results["mirrors"]]
    lines += ["", *_describe_coverage(results["coverage"])]
    lines += ["", f"{'must reach':<82}limit  measured"]
    lines += [f"  {row['what']:<78} {row['limit']:6.4g} {row['measured']:9.4g}  {'holds' if row['holds'] else 'MISSED'}"
              for row in results["must_reach"]]
    return lines + ["", f"{results['seconds']:.0f} s in all"]


def _describe_coverage(coverage: dict) -> list[str]:
    lines = ["coverage of the true value by the 95 % interval",
             f"  {'':<30}{'rays':>9}{'runs':>6}{'coverage':>10} {'+-':>5}{'mean error, dB':>16}{'claimed, dB':>13}"
             f"{'unresolved':>12}"]
    for row in [*coverage["rows"], *coverage["classes"]]:
        rays = f"{row['rays']:,}" if "rays" in row else "all"
        lines.append(f"  {row['kind']:<30}{rays:>9}{row['count']:>6}{row['coverage']:>10.3f} {row['coverage_error']:>5.3f}"
                     f"{row['mean_error_db']:>+16.3f}{row['claimed_db']:>13.3f}{row['unresolved']:>12}")
    lines += [f"  {kind}: {number} scenes more were drawn and left out, whose power even many rays do not know"
              for kind, number in coverage["left_out"].items()]
    return lines


def _describe_street(street: dict) -> list[str]:
    lines = [f"street, {street['title']}, {street['rays']:,} rays: trace {street['trace_s']:.2f} s, "
             f"{1.0 / street['share']:.2f} times the processor time of its {street['queries']:,} bare queries",
             f"  {'direct echoes of':<16}{'alone, dBm':>11}{'(2 seeds, dB)':>14}{'over noise':>11}"
             "   error and claimed error, dB, of each seed"]
    for row in street["rows"]:
        runs = "   ".join(f"{error:+6.2f} +-{min(claimed, 99.0):5.2f} {verdict:<8}" for error, claimed, verdict in
                          zip(row["error_db"], row["claimed_db"], row["verdict"]))
        lines.append(f"  {row['name']:<16}{row['truth_dbm']:>11.1f}{row['alone_spread_db']:>14.2f}{row['snr_db']:>11.0f}"
                     f"   {runs}")
    return lines
