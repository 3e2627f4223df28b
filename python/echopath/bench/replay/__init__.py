"""`echopath bench replay`: one record for all chirps and antennas, against tracing each of them anew."""
from __future__ import annotations

import time
from pathlib import Path

import numpy as np

import echopath as ep

from ...actors import shapes
from ...base.storage.files import write_texts
from ..machine import machine
from ..steps import json_text
from ..timing import fastest
from .cases import CHIRPS, FREQUENCY, Case, all_cases, person_scene, radar

RAYS, QUICK_RAYS = 100_000, 5_000               # of the times
ERROR_RAYS = 3_000                              # of the errors, whose reference renews each chirp
ARRAYS = ((1, 1), (3, 4), (12, 16))             # transmitters, receivers
APERTURES = (0.02, 0.1, 0.25, 0.5)              # m
RANGES = (1.0, 5.0, 20.0, 50.0)                 # m
WALL = 1.0                                      # m aside
REPEATS = 3
TRACED_CHIRPS = 4                               # of which the time for all is scaled up


def run_replay(folder, *, quick: bool = False, progress=None) -> dict:
    """Runs all cases, writes replay.json and replay.png into `folder` and returns what the JSON holds.

    quick: few rays, for a look; progress: callable (stage, fraction) or None
    """
    from .figure import draw_replay

    began = time.perf_counter()
    rays = QUICK_RAYS if quick else RAYS
    cases = all_cases()
    steps = len(cases) + len(ARRAYS) + 1
    done = _counter(progress, steps)
    results = {"machine": machine(), "chirps": CHIRPS, "rays": rays, "cases": {}, "arrays": [], "apertures": []}
    for case in cases:
        results["cases"][case.name] = {"title": case.title, **_times(case, rays), "variants": _errors(case)}
        done()
    for transmitters, receivers in ARRAYS:
        results["arrays"].append(_array(transmitters, receivers, rays))
        done()
    results["apertures"] = [_aperture(aperture, distance) for aperture in APERTURES for distance in RANGES]
    done()
    results["seconds"] = time.perf_counter() - began
    folder = Path(folder)
    write_texts(folder, {"replay.json": json_text(results)})
    draw_replay(results, folder / "replay.png")
    return results


def _counter(progress, steps: int):
    done = 0

    def count():
        nonlocal done
        done += 1
        if progress:
            progress("replay", done / steps)

    return count


def _fastest(work, repeats=REPEATS):
    return fastest(work, repeats)


def _times(case: Case, rays: int) -> dict:
    """Seconds of one trace, of its replay at all chirps, and of tracing every chirp anew."""
    settings = {"num_rays": rays, "max_bounces": case.max_bounces}
    trace, paths = _fastest(lambda: ep.trace(case.scene, case.radar, **settings))
    replay, path_chirps = _fastest(lambda: ep._core.bench.replay_only(paths, case.radar))
    synthesis, _ = _fastest(lambda: ep.synthesize(paths, case.radar))
    few, _ = _fastest(lambda: [ep.trace(case.scene, radar(num_chirps=1), start_time=i * 1e-3, **settings)
                               for i in range(TRACED_CHIRPS)], 1)
    every_chirp = few / TRACED_CHIRPS * CHIRPS
    return {"paths": paths.num_paths, "path_chirps": path_chirps, "trace_s": trace, "replay_s": replay,
            "synthesis_s": synthesis, "every_chirp_s": every_chirp, "replay_over_trace": replay / trace,
            "gain": every_chirp / replay}


# How to replay; the error is that of the map against hits renewed and evaluated at every chirp.
VARIANTS = {
    "interpolated, 1e-1 rad": {"phase_tolerance": 1e-1},
    "interpolated, 1e-3 rad": {"phase_tolerance": 1e-3},
    "interpolated, 1e-5 rad (default)": {},
    "every chirp": {"evaluate": "chirps"},
    "Newton step": {"replay": "fermat"},
    "renewed 4 times": {"retrace": "invalid", "keyframes": 4},
    "renewed 16 times": {"retrace": "invalid", "keyframes": 16},
}


def _errors(case: Case) -> list[dict]:
    paths = _same_hits(ep.trace(case.scene, case.radar, num_rays=ERROR_RAYS, max_bounces=case.max_bounces))
    precise = {"tolerance": 1e-10}
    every, reference = _fastest(lambda: _map(ep.synthesize(
        paths, case.radar, retrace="invalid", keyframes=CHIRPS, evaluate="chirps", **precise), case.radar), 1)
    rows = []
    for label, settings in VARIANTS.items():
        seconds, found = _fastest(lambda: _map(ep.synthesize(paths, case.radar, **settings, **precise), case.radar), 2)
        error = np.abs(found - reference).max() / np.abs(reference).max()
        rows.append({"label": label, "seconds": seconds, "share_of_every_chirp": seconds / every,
                     "error_db": float(20.0 * np.log10(max(error, 1e-12)))})
    return rows


def _same_hits(paths):
    """All paths but the first: a selection, to which renewing adds no surface that comes into view."""
    return paths.select(np.arange(paths.num_paths) > 0)


def _map(cube, of_radar):
    return ep.range_doppler(cube, of_radar, window="hann").values


def _array(transmitters: int, receivers: int, rays: int) -> dict:
    """The walking person seen by an array: what channels cost, against a trace for each pair of antennas and chirp."""
    scene, with_array = person_scene(), radar(transmitters=transmitters, receivers=receivers)
    channels = transmitters * receivers
    few = max(1000, rays // channels)
    trace, paths = _fastest(lambda: ep.trace(scene, with_array, num_rays=few, max_bounces=3))
    replay, path_chirps = _fastest(lambda: ep._core.bench.replay_only(paths, with_array), 2)
    synthesis, _ = _fastest(lambda: ep.synthesize(paths, with_array), 1)
    return {"transmitters": transmitters, "receivers": receivers, "rays": few, "paths": paths.num_paths, "trace_s": trace,
            "replay_s": replay, "synthesis_s": synthesis, "ns_per_path_chirp_channel": 1e9 * synthesis / path_chirps,
            "gain": trace * CHIRPS * channels / replay}


def _aperture(aperture: float, distance: float) -> dict:
    """Largest phase error of echoes over a metal wall beside the radar for the outer antennas of an array; truth: the image.

    aperture: m, width of the array; distance: m, of the target
    """
    scene = ep.Scene()
    scene.add(shapes.wall(4.0 * distance, 2.0 * distance), name="wall", position=(distance, WALL, -distance),
              material=ep.Material.metal())
    width, height = 0.15 * distance, 0.4 * distance
    target = ep.Mesh([[0, -width, -height], [0, width, -height], [0, width, height], [0, -width, height]],
                     [[0, 1, 2], [0, 2, 3]])
    scene.add(target, name="target", position=(distance, min(0.0, 0.8 * WALL - width), 0.0), material=_diffuse())
    centre = ep.Radar(radar(num_chirps=1).waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    paths = ep.trace(scene, centre, num_rays=100_000, max_bounces=2).select("T 'wall' 'target' R")
    antenna, at = np.array([0.0, aperture / 2.0, 0.0]), [paths.frame.trace_time]
    hits = paths.points(at[0])[paths.offsets + 1]
    exact = np.linalg.norm(hits - [0.0, 2.0 * WALL - antenna[1], 0.0], axis=1) + np.linalg.norm(hits - antenna, axis=1)

    def error(replay):
        lengths = paths.lengths(at, tuple(antenna), tuple(antenna), replay=replay)[0]
        wave_number = 2.0 * np.pi * FREQUENCY / ep.speed_of_light
        return float(wave_number * np.abs(lengths - exact).max()) if len(exact) else None

    return {"aperture_m": aperture, "distance_m": distance, "paths": paths.num_paths, "material_rad": error("material"),
            "fermat_rad": error("fermat")}


def _diffuse():
    return ep.Material(reflectivity=0.5, scattering=1.0)


def describe(results: dict) -> list[str]:
    """Lines for people: times of one record against tracing every chirp, errors, arrays."""
    found = results["machine"]
    lines = [f"{found['processor']}, {found['threads']} threads, {results['rays']} rays, {results['chirps']} chirps", "",
             f"{'':26}   paths   trace  replay  signal  every chirp   replay/  every chirp/",
             f"{'':26}               s       s       s  traced, s    trace       replay"]
    for case in results["cases"].values():
        lines.append(f"{case['title']:<26}{case['paths']:>8}{case['trace_s']:8.3f}{case['replay_s']:8.3f}"
                     f"{case['synthesis_s']:8.3f}{case['every_chirp_s']:12.1f}{case['replay_over_trace']:9.2f}"
                     f"{case['gain']:13.0f}")
    lines += ["", "error of the map against hits renewed at every chirp, dB of its peak (time, share of that)"]
    for label in VARIANTS:
        rows = [next(row for row in case["variants"] if row["label"] == label) for case in results["cases"].values()]
        lines.append(f"  {label:<34}" + "".join(f"{row['error_db']:8.0f} ({row['share_of_every_chirp']:.3f})"
                                                for row in rows))
    lines += ["", "  arrays      rays    paths   trace  replay  signal   ns per path,      every pair and chirp traced /"]
    lines += ["                                  s       s       s   chirp, channel                       replay"]
    for row in results["arrays"]:
        lines.append(f"  {row['transmitters']:>2} x {row['receivers']:<2}{row['rays']:>10}{row['paths']:>9}"
                     f"{row['trace_s']:8.3f}{row['replay_s']:8.3f}{row['synthesis_s']:8.3f}"
                     f"{row['ns_per_path_chirp_channel']:12.1f}{row['gain']:30.0f}")
    lines += ["", "phase error of echoes over a wall 1 m aside at the rim of an array, rad: recorded points | Newton step"]
    lines += ["  aperture   " + "".join(f"{f'target at {distance:g} m':>22}" for distance in RANGES)]
    for aperture in APERTURES:
        rows = [row for row in results["apertures"] if row["aperture_m"] == aperture]
        lines.append(f"  {aperture:5.2f} m    " + "".join(f"{row['material_rad']:13.2g} |{row['fermat_rad']:7.1g}"
                                                           if row["paths"] else f"{'-':>22}" for row in rows))
    return lines + ["", f"{results['seconds']:.0f} s in all"]
