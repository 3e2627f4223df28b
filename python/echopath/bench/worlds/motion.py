"""What it costs that the radar moves: a street of parked cars before radars at rest and in motion.

A radar at rest before a street at rest synthesises each path once for all chirps, so it is no measure of a path that moves.
The measure is the same street when it moves past a radar at rest: every path then moves as before a moving radar. Beside the
time of each case stands its error against evaluation in every chirp, in the same run. The time of a record that is renewed at
keyframes holds the ray queries of the renewal.
"""
from __future__ import annotations

import statistics

import numpy as np

import echopath as ep

from ...actors import shapes
from ..crowd.scenes import rounded_car
from ..pace import told_at_reference, verdict
from ..timing import processor_time
from . import crowd_scene

RAYS, QUICK_RAYS = 30_000, 1_000
ROUNDS, QUICK_ROUNDS = 5, 1
CARS = 20
SPEED, TURN = 10.0, 0.5                     # m/s, rad/s
KEYFRAMES = 4                               # of the record that is renewed
LIMIT_NS, LIMIT_RATIO, LIMIT_ERROR = 3.5, 1.1, 1e-6
PHASE_TOLERANCE = 1e-6                      # rad: with it signals are within LIMIT_ERROR, as amplitudes follow it, too
STILL_RADAR = "street moves past"


def street(motion=None) -> ep.Scene:
    """Ground, walls, poles and parked cars. motion: of all of it together, or None"""
    scene, draw = ep.Scene(), np.random.default_rng(1)
    root = scene.add(None, name="street", motion=motion)
    mirror = ep.materials["concrete"].replace(scattering=0.3, mirror=True)
    metal, car, pole = ep.Material.metal(), rounded_car(), shapes.capsule(0.05, 4.0, edge=0.02)
    scene.add(shapes.ground((120.0, 40.0)), name="ground", parent=root, material=mirror, position=(50.0, 0.0, 0.0))
    for name, side in (("wall_left", 1.0), ("wall_right", -1.0)):
        scene.add(shapes.wall(120.0, 6.0), name=name, parent=root, material=mirror, position=(50.0, 10.0 * side, 0.0),
                  yaw=0.0 if side > 0 else np.pi)
    for k in range(CARS):
        place = 8.0 + 14.0 * (k // 4) + draw.uniform(0.0, 6.0), crowd_scene.LANES[k % 4], 0.0
        scene.add(car, name=f"car_{k}", parent=root, position=place, material=metal, smooth=True)
    for k in range(8):
        scene.add(pole, name=f"pole_{k}", parent=root, position=(12.0 + 10.0 * (k // 2), 9.3 if k % 2 else -9.3, 2.01),
                  material=metal, smooth=True)
    return scene


def _keys() -> ep.KeyframeMotion:
    times = np.array([0.0, 0.05, 0.1, 0.15])
    return ep.KeyframeMotion(times=times, translations=np.stack([SPEED * times, 2.0 * times ** 2, 0.0 * times], axis=1))


def _cases() -> dict:
    """(scene, radar, keywords of the signal) by name."""
    forward, back = ep.LinearMotion(velocity=(SPEED, 0.0, 0.0)), ep.LinearMotion(velocity=(-SPEED, 0.0, 0.0))
    turning = ep.LinearMotion(velocity=(SPEED, 0.0, 0.0), angular_velocity=(0.0, 0.0, TURN))
    still, passing = street(), street(back)
    return {"all at rest": (still, crowd_scene.radar(), {}),
            STILL_RADAR: (passing, crowd_scene.radar(), {}),
            "radar drives": (still, crowd_scene.radar(forward), {}),
            "radar drives and turns": (still, crowd_scene.radar(turning), {}),
            "radar moves by keyframes": (still, crowd_scene.radar(_keys()), {}),
            "record renewed, street moves past": (passing, crowd_scene.radar(),
                                                  {"retrace": "invalid", "keyframes": KEYFRAMES})}


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each case: ns of the processor a path, chirp and channel (median of rounds in turn), that over the
    reference, and the largest error of a sample over the largest sample."""
    rays = QUICK_RAYS if quick else RAYS
    cases = {name: (ep.trace(scene, radar, num_rays=rays), radar, keywords)
             for name, (scene, radar, keywords) in _cases().items()}
    found = {name: [] for name in cases}
    for _ in range(QUICK_ROUNDS if quick else ROUNDS):
        for name, (paths, radar, keywords) in cases.items():
            found[name].append(processor_time(lambda: _signal(paths, radar, **keywords))[0])
    return [_row(name, *cases[name], statistics.median(seconds), statistics.median(found[STILL_RADAR]))
            for name, seconds in found.items()]


def _row(name: str, paths, radar, keywords: dict, seconds: float, reference: float) -> dict:
    values = paths.num_paths * radar.waveform.num_chirps * len(radar.transmitters) * len(radar.receivers)
    return {"name": name, "paths": paths.num_paths, "ns": 1e9 * seconds / values, "over_reference": seconds / reference,
            "error": _error(paths, radar, keywords), "timed": name.startswith("radar")}


def _error(paths, radar, keywords: dict) -> float:
    """Of the first receiver."""
    alone = radar.replace(receivers=radar.receivers[:1])
    exact = _signal(paths, alone, evaluate="chirps", **keywords)
    return float(np.abs(_signal(paths, alone, **keywords) - exact).max() / np.abs(exact).max())


def _signal(paths, radar, **keywords) -> np.ndarray:
    return ep.synthesize(paths, radar, phase_tolerance=PHASE_TOLERANCE, **keywords)


def describe(rows: list[dict]) -> list[str]:
    """A line for each case; limits stand on those of a radar that moves."""
    lines = [f"{'':<36}{'paths':>10}{'ns':>8}{'over ref.':>11}{'error':>10}"]
    for row in rows:
        line = f"{row['name']:<36}{row['paths']:>10,}{row['ns']:8.2f}{row['over_reference']:11.2f}{row['error']:10.1e}"
        lines.append(line + (_judgement(row) if row.get("timed") else ""))
    return lines + [f"limits of a radar that moves: {LIMIT_NS} ns a path, chirp and channel, {LIMIT_RATIO} of the time of "
                    f"\"{STILL_RADAR}\", error {LIMIT_ERROR:g}"]


def _judgement(row: dict) -> str:
    found = {"ns": verdict(row["ns"], LIMIT_NS, row.get("paces")), "ratio": verdict(row["over_reference"], LIMIT_RATIO),
             "error": verdict(row["error"], LIMIT_ERROR)}
    worst = next((said for said in ("MISSED", "undecided") if said in found.values()), "holds")
    which = "" if worst == "holds" else " " + ", ".join(what for what, said in found.items() if said == worst)
    return f"  {worst}{which}{told_at_reference(row['ns'], row.get('paces'))}"
