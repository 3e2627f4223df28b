"""`echopath bench speed`: synthesis beside FINUFFT and the direct sum, whole frames, memory, replay, tracer, the street
frame beside its floor."""
from __future__ import annotations

import time
from pathlib import Path

import numpy as np

import echopath as ep

from ...base.storage.files import write_texts
from ..machine import machine
from ..replay import cases as replay_cases
from ..steps import csv_text, json_text
from ..timing import processor_time
from . import faint, frames, guard, retrace, synthesis, tracer

REPLAY_RAYS, QUICK_REPLAY_RAYS = 50_000, 1_000
REPLAY_REPEATS = 7
REPLAY_AIM, REPLAY_TARGET = ep._core.PHASE_TOLERANCE, 1.0   # rad; processor time over that of the trace
PHASE_TOLERANCES = (1e-1, 1e-3, REPLAY_AIM, 1e-7)
COLUMNS = ("tolerance", "ns", "error", "scattered_ns", "finufft_ns", "finufft_error", "gain", "scattered_gain")


def run_speed(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures everything, writes speed.json, speed.csv and two figures into `folder` and returns what the JSON holds.

    quick: few paths, for a look; progress: callable (stage, fraction) or None
    """
    from .figure import draw_frames, draw_synthesis

    began = time.perf_counter()
    tell = _counter(progress, quick)
    results = {"machine": machine(), "finufft": synthesis.finufft_version(), "quick": quick}
    results["synthesis"] = synthesis.measure_synthesis(quick=quick, tell=tell)
    results["frames"] = frames.measure_frames(quick=quick, tell=tell)
    results["linear"] = [] if quick else frames.measure_linearity()
    results["large"] = None if quick else frames.measure_large()
    results["replay"] = [_replay(case, quick) for case in replay_cases.all_cases()]
    tell()
    results["tracer"] = tracer.measure_tracer(quick=quick)
    tell()
    results["retrace"] = retrace.measure_retrace(quick=quick)
    tell()
    results["street"] = frames.measure_street(quick=quick)
    tell()
    results["guard"] = guard.measure_guard(quick=quick)
    tell()
    results["faint"] = faint.measure_faint(quick=quick)
    tell()
    results["must_reach"] = verdicts(results)
    results["seconds"] = time.perf_counter() - began
    folder = Path(folder)
    write_texts(folder, {"speed.json": json_text(results),
                         "speed.csv": csv_text(results["synthesis"]["rows"], COLUMNS)})
    draw_synthesis(results, folder / "speed_synthesis.png")
    draw_frames(results, folder / "speed_frames.png")
    return results


def _counter(progress, quick: bool):
    counts = (synthesis.TOLERANCES, frames.QUICK_PATHS if quick else frames.PATHS, frames.CHIRPS,
              frames.ARRAYS, frames.PARTS)
    steps, done = 6 + sum(map(len, counts)), 0

    def tell():
        nonlocal done
        done += 1
        if progress:
            progress("speed", min(1.0, done / steps))

    return tell


def _replay(case, quick: bool) -> dict:
    """Processor seconds of a trace and of its replay at all chirps without synthesis, for each aim of the phase: medians."""
    rays = QUICK_REPLAY_RAYS if quick else REPLAY_RAYS

    def median_of(work) -> float:
        return float(np.median([processor_time(work)[0] for _ in range(REPLAY_REPEATS)]))

    def trace():
        return ep.trace(case.scene, case.radar, num_rays=rays, max_bounces=case.max_bounces)

    paths = trace()
    trace_s = median_of(trace)
    ep._core.bench.replay_only(paths, case.radar)
    rows = [{"phase_tolerance": tolerance,
             "replay_s": median_of(lambda: ep._core.bench.replay_only(paths, case.radar, phase_tolerance=tolerance))}
            for tolerance in PHASE_TOLERANCES]
    return {"name": case.name, "title": case.title, "paths": paths.num_paths, "trace_s": trace_s, "rows": rows}


def verdicts(results: dict) -> list[dict]:
    """What must be reached: one row {what, limit, measured, holds} each; only what the run has measured."""
    rows = []
    for row in results["synthesis"]["rows"]:
        target = synthesis.TARGETS.get(row["tolerance"])
        if target and "gain" in row:
            rows.append(_row(f"synthesis at {row['tolerance']:.0e}, times FINUFFT", target, row["gain"]))
    fastest = max(results["synthesis"]["rates"], key=lambda row: (row["threads"], not row["scattered"]))
    rows.append(_row(f"path-chirps/s at 1e-6, {fastest['threads']} threads", synthesis.RATE_TARGET,
                     fastest["per_second_of_free_cores"]))
    over = max(row["error"] / row["tolerance"] for row in results["synthesis"]["slow"])
    rows.append(_row("error of all methods over the tolerance, 1 to 1e6 echoes", 1.0, over, most=True))
    excess = frames.linearity(results["linear"])
    if excess is not None:
        rows.append(_row("time per path from 1e5 paths on, spread", frames.LINEAR_TARGET, excess, most=True))
    rows += _memory_rows(results["frames"], results["large"])
    rows += [_row(f"bare queries over their trace, {row['triangles']:,} triangles, {row['threads']} threads", row["target"],
                  row["share"])
             for row in results["tracer"]]
    for case in results["replay"]:
        replay_s = next(row["replay_s"] for row in case["rows"] if row["phase_tolerance"] == REPLAY_AIM)
        rows.append(_row(f"replay at {REPLAY_AIM:.0e} rad over the trace, {case['title']}", REPLAY_TARGET,
                         replay_s / case["trace_s"], most=True))
    rows.append(_row("guard, share of trace and signal", guard.TARGET, results["guard"]["share"], most=True))
    rows.append(_row("faint paths by lot, trace and signal over all paths", faint.SAVED, faint.saved(results["faint"]),
                     most=True))
    rows.append(_row("faint paths by lot, mean maps over what chance makes", faint.SIGMAS,
                     faint.row_of_auto(results["faint"])["sigmas"], most=True))
    for street in results["street"]:
        what, seconds = f"street frame, {street['rays']:,} rays", frames.STREET_SECONDS.get(street["rays"])
        if seconds:
            rows.append(_row(f"{what}, s", seconds, street["frame_s"], most=True))
        rows.append(_row(f"{what}, over its floor", frames.STREET_TARGET, street["frame_s"] / street["floor_s"],
                         most=True))
    return rows


def _memory_rows(by_kind: dict, large: dict | None) -> list[dict]:
    most = max(row["peak_bytes"] for rows_of in by_kind.values() for row in rows_of)
    rows = [_row("peak memory of any frame, bytes", frames.MOST_MEMORY, most, most=True)]
    if large:
        what = f"of {large['paths']:.0e} paths, {large['chirps']} chirps, {large['channels']} channels"
        rows.append(_row(f"peak memory {what}", frames.MOST_MEMORY, large["peak_bytes"], most=True))
    return rows


def _row(what: str, limit: float, measured: float, *, most: bool = False) -> dict:
    holds = measured <= limit if most else measured >= limit
    return {"what": what, "limit": limit, "at_most": most, "measured": measured, "holds": bool(holds)}


def describe(results: dict) -> list[str]:
    """Lines for people: synthesis, rates, frames, replay, the street with its floor, what must be reached."""
    found = results["machine"]
    lines = [f"{found['processor']}, {found['threads']} threads, {found['instruction_set']}, "
             f"FINUFFT {results['finufft'] or 'not installed: its column is empty'}", "",
             *_synthesis_lines(results["synthesis"]), *_frame_lines(results["frames"]), *_linear_lines(results["linear"]),
             *_large_lines(results["large"]),
             *_replay_lines(results["replay"]),
             *_tracer_lines(results["tracer"]), *retrace.describe_retrace(results["retrace"]),
             *(line for street in results["street"] for line in _street_lines(street)),
             *guard.describe_guard(results["guard"]), *faint.describe_faint(results["faint"]), "",
             "must reach" + " " * 55 + "limit     measured"]
    lines += [f"  {row['what']:<56}{'at most' if row['at_most'] else 'at least':>9}{row['limit']:>10.4g}"
              f"{row['measured']:>13.4g}  {'holds' if row['holds'] else 'MISSED'}"
              for row in results["must_reach"]]
    return lines + ["", f"{results['seconds']:.0f} s in all"]


def _synthesis_lines(found: dict) -> list[str]:
    lines = [f"synthesis, {found['paths']:,} echoes, {found['chirps']} chirps of {found['samples']} samples, one thread: "
             "processor time in ns per echo and chirp",
             "              echoes of bodies,        each echo at      FINUFFT, points and        gain",
             " tolerance    lengths and amplitudes   a speed of its    strengths given",
             "              interpolated    error    own                        error      bodies  own"]
    for row in found["rows"]:
        theirs = (f"{row['finufft_ns']:14.2f}{row['finufft_error']:13.1e}{row['gain']:10.1f}{row['scattered_gain']:6.1f}"
                  if "gain" in row else "")
        lines.append(f"{row['tolerance']:10.0e}{row['ns']:14.2f}{row['error']:12.1e}{row['scattered_ns']:12.2f}{theirs}")
    lines += [f"{row['method']:>10}{row['ns']:14.2f}{row['error']:12.1e}" for row in found["sums"]]
    lines += ["", f"beside a slow sum, one chirp of {synthesis.SLOW_SAMPLES} samples: rms error over the samples",
              "    echoes      method  tolerance   of the sum of |a|   of the signal's rms",
              *(f"{row['echoes']:>10,}{row['method']:>12}{row['tolerance']:11.0e}{row['error']:20.1e}"
                f"{row['error_of_signal']:22.1e}"
                for row in found["slow"]), ""]
    for row in found["rates"]:
        kind = "a speed of its own each" if row["scattered"] else "bodies"
        lines.append(f"{row['threads']} threads, {kind:<24}{1e-6 * row['per_second']:7.0f} M path-chirps/s by the clock, "
                     f"{1e-6 * row['per_second_of_free_cores']:.0f} M by processor time")
    return lines


def _frame_lines(by_kind: dict) -> list[str]:
    lines = ["", "street, whole signal, medians             wall s  processor s   peak MiB"]
    for kind, rows in by_kind.items():
        for row in rows:
            each = f"   {1e9 * row['processor_s'] / row['paths']:8.1f} ns per path" if kind == "paths" else ""
            lines.append(f"  {row[kind]:>12,} {kind:<22}{row['wall_s']:12.3f}{row['processor_s']:13.3f}"
                         f"{row['peak_bytes'] / 2 ** 20:11,.0f}{each}")
    return lines


def _linear_lines(rows: list[dict]) -> list[str]:
    """Time per path of frames of all sizes in turn."""
    each = ", ".join(f"{1e9 * row['processor_s'] / row['paths']:.1f} ns of {row['paths']:,}" for row in rows)
    return ["", f"processor time per path, all sizes in turn: {each}"] if rows else []


def _large_lines(row: dict | None) -> list[str]:
    return [f"{row['paths']:,} paths, {row['chirps']} chirps, {row['channels']} channels: trace {row['trace_s']:.1f} s, "
            f"signal {row['signal_s']:.1f} s by the clock, peak {row['peak_bytes'] / 2 ** 20:,.0f} MiB"] if row else []


def _replay_lines(cases: list[dict]) -> list[str]:
    lines = ["",
             "replay of 128 chirps without synthesis, processor time over that of the trace, by aim for the phase in rad",
             f"{'':26}   paths  trace s" + "".join(f"{tolerance:>9.0e}" for tolerance in PHASE_TOLERANCES)]
    for case in cases:
        shares = "".join(f"{row['replay_s'] / max(case['trace_s'], 1e-9):9.2f}" for row in case["rows"])
        lines.append(f"{case['title']:<26}{case['paths']:>8}{case['trace_s']:9.3f}{shares}")
    return lines


def _tracer_lines(rows: list[dict]) -> list[str]:
    lines = ["", "tracer beside bare loops over its own queries: packed alike, and one by one",
             " triangles  threads   queries   trace s    bare s   share of it   of one by one"]
    return lines + [f"{row['triangles']:>10,}{row['threads']:>9}{row['queries']:>10,}{row['trace_s']:10.4f}"
                    f"{row['bare_s']:10.4f}{row['share']:12.2f}{row['single_share']:16.2f}" for row in rows]


def _street_lines(street: dict) -> list[str]:
    floor, first = street["floor"], street["first"]
    return ["", f"street, {street['rays']:,} rays, {street['chirps']} chirps, {street['paths']:,} paths, "
            f"{street['moving_paths']:,} moving, {street['frame_s']:.3f} s a frame by the clock",
            f"  trace {street['trace_s']:.3f} s, both partitions {street['decompose_s']:.3f} s; of the first frame, which "
            f"has to be given its memory, {first['trace_s']:.3f} s and {first['decompose_s']:.3f} s",
            f"  besides: replay alone {street['replay_s']:.3f} s, signal without partitions {street['synthesize_s']:.3f} s",
            f"  floor {street['floor_s']:.3f} s: own Embree queries at the bare rate {floor['queries_s']:.3f} s, moving "
            f"path-chirps x {frames.MOVING_NS} ns {floor['moving_s']:.3f} s, static paths once "
            f"{floor['still_s']:.3f} s"]
