"""Whole frames: time and memory against paths, chirps, channels and parts, and the street scene beside its floor."""
from __future__ import annotations

import time
from importlib.resources import as_file

import numpy as np

import echopath as ep

from ..materials import data_folder
from ..scene_file import load_scene
from ..stages import StageClock
from .speed_tracer import bare_share
from .timing import wall_time

PATHS, QUICK_PATHS = (1_000, 10_000, 100_000, 1_000_000, 10_000_000), (1_000, 10_000)
LINEAR_FROM, LINEAR_TARGET = 100_000, 0.10      # time per path from there on stays within that share
SEED_RAYS, QUICK_SEED_RAYS = 5_500, 1_000       # whose paths are repeated to any number
FRAME_CHIRPS = 16                               # of the frames that the number of paths is varied of
SOME_PATHS = 200_000
CHIRPS = (16, 64, 256)
ARRAYS = ((1, 1), (1, 4), (3, 4))
PARTS = (1, 4, 16)
STREET_RAYS, QUICK_STREET_RAYS = 500_000, 2_000
MOVING_NS = 2.5                                 # per moving path and chirp on two cores, the floor that LIMITS sets
STREET_TARGET = 1.3                             # times the floor
MOST_MEMORY = 4 * 2 ** 30                       # bytes


def street():
    """The scene file of the demo."""
    with as_file(data_folder("scenes") / "street.toml") as path:
        return load_scene(path)


def repeated(paths, count: int):
    """`count` paths of the mixture and in the order of a record: all of it again and again, and a random share at last."""
    times, rest = divmod(count, paths.num_paths)
    some = np.sort(np.random.default_rng(1).permutation(paths.num_paths)[:rest])
    chosen = np.concatenate([np.tile(np.arange(paths.num_paths), times), some])
    turn = np.concatenate([np.repeat(np.arange(times), paths.num_paths), np.full(rest, times)])
    columns = {name: np.asarray(getattr(paths, name))[chosen]
               for name in ("num_bounces", "diffuse", "weight", "stratum", "batch", "flags")}
    return ep.Paths.from_arrays(hits=np.tile(paths.hits, times + (rest > 0)),
                                offsets=paths.offsets[chosen] + turn * len(paths.hits), scene=paths.scene, radar=paths.radar,
                                frame=paths.frame, **columns)


def with_frame(radar, num_chirps: int, array=(1, 1)):
    """The radar with another number of chirps and antennas."""
    old = radar.waveform
    new = ep.ChirpSequence(start_frequency=old.start_frequency, bandwidth=old.bandwidth, num_samples=old.num_samples,
                           sampling_rate=old.sampling_rate, num_chirps=num_chirps, chirp_interval=old.chirp_interval)
    half = ep.speed_of_light / old.start_frequency / 2.0
    transmitters = [ep.Antenna((0.0, array[1] * half * i, 1.0)) for i in range(array[0])]
    return ep.Radar(new, transmitters=transmitters, receivers=[ep.Antenna((0.0, half * i, 1.0)) for i in range(array[1])])


def _measured(work) -> dict:
    """Seconds of the clock and of the processor, and the peak of memory in bytes."""
    clock, began = StageClock(), time.process_time()
    with clock("work"):
        work()
    return {"wall_s": clock.stages[0].seconds, "processor_s": time.process_time() - began,
            "peak_bytes": clock.stages[0].peak_memory}


def measure_frames(*, quick: bool = False, tell=None) -> dict:
    """Rows of measured frames by what was varied."""
    scene = street()
    seed = ep.trace(scene.scene, scene.radar, num_rays=QUICK_SEED_RAYS if quick else SEED_RAYS)
    found = {"paths": [], "chirps": [], "channels": [], "parts": []}

    def add(kind: str, value, work) -> None:
        found[kind].append({kind: value, **_measured(work)})
        if tell:
            tell()

    few = with_frame(scene.radar, FRAME_CHIRPS)
    ep.synthesize(repeated(seed, 1000), few)
    for count in QUICK_PATHS if quick else PATHS:
        paths = repeated(seed, count)
        add("paths", count, lambda paths=paths: ep.synthesize(paths, few))
    some = repeated(seed, 2_000 if quick else SOME_PATHS)
    for count in CHIRPS:
        add("chirps", count, lambda count=count: ep.synthesize(some, with_frame(scene.radar, count)))
    for array in ARRAYS:
        add("channels", array[0] * array[1], lambda array=array: ep.synthesize(some, with_frame(scene.radar, 64, array)))
    for count in PARTS:
        parts = _parts(scene.scene, count)
        add("parts", count, lambda parts=parts: ep.decompose(some, with_frame(scene.radar, 64), parts))
    return found


def _parts(scene, count: int) -> dict:
    names = [mesh.name for mesh in scene.meshes]
    pairs = [(name, bounces) for bounces in (1, 2, 3, 4) for name in names][:count - 1]
    return {f"{name}, {bounces}": ep.hits(name) & (ep.num_bounces == bounces) for name, bounces in pairs}


def linearity(rows: list[dict]) -> float | None:
    """Largest over least processor time per path, less 1, from LINEAR_FROM paths on; None of fewer than two rows."""
    costs = [row["processor_s"] / row["paths"] for row in rows if row["paths"] >= LINEAR_FROM]
    return max(costs) / min(costs) - 1.0 if len(costs) > 1 else None


def measure_street(*, quick: bool = False) -> dict:
    """The frame of the demo with both partitions, and the floor under it, term by term."""
    scene = street()
    rays = QUICK_STREET_RAYS if quick else STREET_RAYS
    trace_s, paths = wall_time(lambda: ep.trace(scene.scene, scene.radar, num_rays=rays))
    path_chirps = ep._core.replay_only(paths, scene.radar)
    replay_s, _ = wall_time(lambda: ep._core.replay_only(paths, scene.radar))
    chirps = scene.radar.waveform.num_chirps
    moving = round((path_chirps - paths.num_paths) / (chirps - 1))
    whole_s, _ = wall_time(lambda: ep.synthesize(paths, scene.radar))
    parts_s, _ = wall_time(lambda: ep.decompose(paths, scene.radar, scene.parts))
    one_chirp = with_frame(scene.radar, 1)
    still_s, _ = wall_time(lambda: ep.synthesize(paths, one_chirp))
    queries_s = bare_share(scene.scene, scene.radar, rays)["bare_s"]
    moving_s = 1e-9 * MOVING_NS * moving * chirps * 2.0 / ep.num_threads()
    terms = {"queries_s": queries_s, "moving_s": moving_s, "still_s": still_s * (1.0 - moving / max(1, paths.num_paths))}
    return {"rays": rays, "paths": paths.num_paths, "moving_paths": moving, "chirps": chirps, "trace_s": trace_s,
            "replay_s": replay_s, "synthesize_s": whole_s, "decompose_s": parts_s, "frame_s": trace_s + parts_s,
            "floor": terms, "floor_s": sum(terms.values())}
