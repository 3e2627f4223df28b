"""What faint paths by lot save in the street, and what they do to its map."""
from __future__ import annotations

import statistics

import numpy as np

import echopath as ep

from ...tracing.faint_paths import faint_power_of
from ..timing import processor_time
from .frames import street

RAYS, QUICK_RAYS, SEEDS, QUICK_SEEDS = 30_000, 5_000, 12, 3
TIMES_AUTO = (0.0, 0.1, 1.0, 10.0)  # faint powers over that of "auto"; 0: all paths are kept
SAVED = 0.75  # the most of the time of all paths that trace and signal may take with faint_power="auto", said only here
SIGMAS = 1.5  # the most by which mean maps may differ, rms over what chance makes of it, said only here


def measure_faint(*, quick: bool = False) -> list[dict]:
    """For each faint power: paths, medians of processor seconds of trace and signal, and what mean maps differ by.

    Mean maps are over seeds, summed over velocity, of the range cells above the noise. "db": mean of their ratio to that of
    all paths; "sigmas": rms of their difference over that which the seeds of both tell.
    """
    scene = street()
    rays, seeds = (QUICK_RAYS, QUICK_SEEDS) if quick else (RAYS, SEEDS)
    auto = faint_power_of("auto", scene.radar)
    rows = [_row(scene, rays, seeds, times * auto) | {"times_auto": times} for times in TIMES_AUTO]
    every = rows[0]["maps"]
    seen = every.mean(axis=0) > ep.noise_power(scene.radar)
    for row in rows:
        maps = row.pop("maps")
        difference = (maps.mean(axis=0) - every.mean(axis=0))[seen]
        error = np.sqrt((maps.var(axis=0, ddof=1) + every.var(axis=0, ddof=1)) / seeds)[seen]
        row["db"] = float(np.mean(10.0 * np.log10(maps.mean(axis=0)[seen] / every.mean(axis=0)[seen])))
        row["sigmas"] = float(np.sqrt(np.mean((difference / error) ** 2)))
    return rows


def _row(scene, rays: int, seeds: int, faint_power: float) -> dict:
    trace_s, signal_s, maps = [], [], []
    for seed in range(seeds):
        seconds, paths = processor_time(
            lambda: ep.trace(scene.scene, scene.radar, num_rays=rays, seed=seed, faint_power=faint_power))
        trace_s.append(seconds)
        seconds, cube = processor_time(lambda: ep.synthesize(paths))
        signal_s.append(seconds)
        maps.append((np.abs(ep.range_doppler(cube, scene.radar).values[0, 0]) ** 2).sum(axis=0))
    return {"paths": paths.num_paths, "trace_s": statistics.median(trace_s), "signal_s": statistics.median(signal_s),
            "maps": np.array(maps)}


def row_of_auto(rows: list[dict]) -> dict:
    """That of faint_power="auto"."""
    return next(row for row in rows if row["times_auto"] == 1.0)


def saved(rows: list[dict]) -> float:
    """Time of trace and signal with faint_power="auto" over that with all paths."""
    auto = row_of_auto(rows)
    return (auto["trace_s"] + auto["signal_s"]) / (rows[0]["trace_s"] + rows[0]["signal_s"])


def describe_faint(rows: list[dict]) -> list[str]:
    """Lines for people."""
    return ["", "street with faint paths by lot, processor time; mean maps beside those of all paths",
            'faint power over "auto"     paths    trace s   signal s    mean dB   rms over chance',
            *(f"{row['times_auto']:>23g}{row['paths']:>10,}{row['trace_s']:>11.3f}{row['signal_s']:>11.3f}{row['db']:>+11.3f}"
              f"{row['sigmas']:>18.2f}" for row in rows)]
