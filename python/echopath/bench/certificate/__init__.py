"""`echopath bench certificate`: objects of random moving scenes against traces of every 8th chirp, and what `validity` says."""
from __future__ import annotations

import dataclasses
import time
from pathlib import Path

import numpy as np

import echopath as ep

from ...base.storage.files import write_texts
from ..machine import machine
from ..steps import json_text, told
from .scenes import KINDS, random_scene

SCENES, QUICK_SCENES = 40, 8
RAYS = 12_000
EVERY = 8                # chirps
FREQUENCIES = 8          # over the band, for fields
WRONG_DB, RIGHT_DB = 1.0, 0.1
DYNAMIC_RANGE_DB = 60.0
SEEDS = (11, 12)         # of the traces that are the truth: what they differ by is no error of the replay


@dataclasses.dataclass(frozen=True)
class Verdict:
    """An object of a scene: power over the frame in the replay and by traces of every 8th chirp, and what validity says of it.

    kind, scene, name: whose; replayed, truth: W; scatter_db: between two truths; in_range: it counts; certified: `ok`
    """

    kind: str
    scene: int
    name: str
    replayed: float
    truth: float
    scatter_db: float
    in_range: bool
    certified: bool

    @property
    def error_db(self) -> float:
        """Of the replay; infinite where one of the two has nothing."""
        if self.replayed == self.truth:
            return 0.0
        if self.replayed <= 0.0 or self.truth <= 0.0:
            return float("inf")
        return float(10.0 * np.log10(self.replayed / self.truth))

    @property
    def is_wrong(self) -> bool:
        """By more than 1 dB and what the truth scatters by."""
        return self.in_range and abs(self.error_db) > WRONG_DB + self.scatter_db

    @property
    def is_right(self) -> bool:
        """To .1 dB."""
        return self.in_range and abs(self.error_db) <= RIGHT_DB


def run_certificate(folder, *, scenes: int | None = None, quick: bool = False, progress=None) -> dict:
    """Runs random scenes, writes certificate.json into `folder` and returns what it holds.

    scenes: how many; quick: few of them; progress: callable (stage, fraction) or None
    """
    count = scenes or (QUICK_SCENES if quick else SCENES)
    began = time.perf_counter()
    verdicts, check_s = [], 0.0
    for seed in told(range(count), "certificate", progress):
        found, seconds = judge_scene(seed)
        verdicts += found
        check_s += seconds
    results = {"machine": machine(), "scenes": count, "rays": RAYS, "kinds": {kind: _row(kind, verdicts) for kind in KINDS},
               "all": _row(None, verdicts), "check_s": check_s, "seconds": time.perf_counter() - began,
               "uncertified": [_entry(v) for v in verdicts if v.is_wrong and v.certified],
               "false_alarms": [_entry(v) for v in verdicts if v.is_right and not v.certified]}
    write_texts(Path(folder), {"certificate.json": json_text(results)})
    return results


def judge_scene(seed: int):
    """(list of Verdict, seconds of the check) of the scene of that number."""
    made = random_scene(seed)
    paths = ep.trace(made.scene, made.radar, num_rays=RAYS, max_bounces=made.max_bounces)
    began = time.perf_counter()
    report = ep.validity(paths)
    seconds = time.perf_counter() - began
    waveform = made.radar.waveform
    times = (np.arange(EVERY // 2, waveform.num_chirps, EVERY) * waveform.chirp_interval
             + 0.5 * (waveform.num_samples - 1) / waveform.sampling_rate)
    names = sorted({mesh.name for mesh in made.scene.meshes})
    replayed = object_powers(paths, times, names).mean(axis=1)
    truths = [np.mean([_traced_powers(made, at, seed_of_truth, names) for at in times], axis=0) for seed_of_truth in SEEDS]
    truth = np.mean(truths, axis=0)
    noise = ep._core.noise_power_in_cell(made.radar)
    floor = max(noise, max(truth.max(), replayed.max()) * 10.0 ** (-DYNAMIC_RANGE_DB / 10.0))
    verdicts = []
    for i, name in enumerate(names):
        entry = report.objects.get(name)
        verdicts.append(Verdict(made.kind, seed, name, float(replayed[i]), float(truth[i]), _scatter(truths[0][i], truths[1][i]),
                                bool(max(truth[i], replayed[i]) >= floor), entry is None or entry.ok))
    return verdicts, seconds


def _scatter(first: float, second: float) -> float:
    if first == second:
        return 0.0
    return float(abs(10.0 * np.log10(first / second))) if min(first, second) > 0.0 else 3.0


def _traced_powers(made, at: float, seed: int, names):
    instant = made.radar.replace(waveform=ep.ChirpSequence(**_instant(made.radar.waveform)))
    paths = ep.trace(made.scene, instant, num_rays=RAYS, max_bounces=made.max_bounces, seed=seed, start_time=float(at))
    return object_powers(paths, [float(at)], names)[:, 0]


def _instant(waveform) -> dict:
    names = ("start_frequency", "bandwidth", "sampling_rate", "chirp_interval")
    return {name: getattr(waveform, name) for name in names} | {"num_samples": 1, "num_chirps": 1}


def object_powers(paths, times, names):
    """Mean power [objects, T] in W of the paths that end on each object: fields over the band, powers of rough surfaces.

    paths: of a trace without flagged mirrors; times: [T] s; names: of meshes, each an object of its own
    """
    amplitudes, lengths = paths.amplitudes(times), paths.lengths(times)
    last = paths.mesh_id[paths.offsets + paths.num_bounces.astype(np.int64) - 1] if paths.num_paths else np.zeros(0, int)
    ids = {mesh.name: mesh.id for mesh in paths.scene.meshes}
    waveform = paths.radar.waveform
    tones = waveform.start_frequency + waveform.bandwidth * (np.arange(FREQUENCIES) + 0.5) / FREQUENCIES
    out = np.zeros((len(names), len(times)))
    for i, name in enumerate(names):
        mine = last == ids[name]
        rough = mine & (paths.diffuse != 0)
        out[i] = (np.abs(amplitudes[:, rough]) ** 2).sum(axis=1)
        smooth = mine & (paths.diffuse == 0)
        if smooth.any():
            turns = np.exp(-2j * np.pi / ep.speed_of_light * tones[:, None, None] * lengths[None, :, smooth])
            out[i] += (np.abs((turns * amplitudes[:, smooth]).sum(axis=2)) ** 2).mean(axis=0)
    return out


def _row(kind, verdicts) -> dict:
    mine = [v for v in verdicts if (kind is None or v.kind == kind) and v.in_range]
    return {"objects": len(mine), "wrong": sum(v.is_wrong for v in mine),
            "wrong_uncertified": sum(v.is_wrong and v.certified for v in mine), "flagged": sum(not v.certified for v in mine),
            "false_alarms": sum(v.is_right and not v.certified for v in mine)}


def _entry(verdict: Verdict) -> dict:
    return {"kind": verdict.kind, "scene": verdict.scene, "name": verdict.name, "error_db": verdict.error_db,
            "scatter_db": verdict.scatter_db}


def describe(results: dict) -> list[str]:
    """Lines for people: by kind of scene how many objects are wrong, flagged, and flagged without need."""
    found = results["machine"]
    lines = [f"{found['processor']}, {found['threads']} threads, {results['scenes']} scenes, {results['rays']} rays", "",
             f"{'':18} objects  wrong by    of these    flagged   flagged, but",
             f"{'':18}            > {WRONG_DB:g} dB  certified               right to {RIGHT_DB:g} dB"]
    for kind, row in [*results["kinds"].items(), ("all", results["all"])]:
        lines.append(f"{kind:<18}{row['objects']:>8}{row['wrong']:>10}{row['wrong_uncertified']:>12}{row['flagged']:>11}"
                     f"{row['false_alarms']:>15}")
    for entry in results["uncertified"]:
        lines.append(f"  certified, but wrong: scene {entry['scene']} ({entry['kind']}), '{entry['name']}', "
                     f"{entry['error_db']:+.2f} dB (truth to {entry['scatter_db']:.2f})")
    return [*lines, "", f"validity {results['check_s']:.0f} s of {results['seconds']:.0f} s in all"]
