"""Whole frames: time and memory against paths, chirps, channels and parts, and the street scene beside its floor."""
from __future__ import annotations

from importlib.resources import as_file

import numpy as np

import echopath as ep

from ...base.process.stages import StageClock
from ...base.storage.data_folder import data_folder
from ...scene_file import load_scene
from ..timing import processor_time, wall_time
from .tracer import bare_share

PATHS, QUICK_PATHS = (1_000, 10_000, 100_000, 1_000_000, 10_000_000), (1_000, 10_000)
LINEAR_FROM, LINEAR_TARGET = 100_000, 0.10      # time per path from there on stays within that share
LINEAR_ROUNDS = 9
TRIAL_RAYS = 16_000                             # that tell how many paths come of a ray
MARGIN = 1.02                                   # of rays, since records differ in paths per ray by a per cent
FRAME_CHIRPS = 16                               # of the frames that the number of paths is varied of
MEASURED_PATHS = 10_000_000                     # in all repeats of a frame; 5 to 31 repeats
SOME_PATHS = 200_000
CHIRPS = (16, 64, 256)
ARRAYS = ((1, 1), (1, 4), (3, 4))
PARTS = (1, 4, 16)
STREET_RAYS, QUICK_STREET_RAYS = (500_000, 2_000_000), (2_000,)
STREET_FRAMES = 4                               # of each, the first of which is told for itself
MOVING_NS = 2.5                                 # per moving path and chirp on two cores, the floor that LIMITS sets
STREET_SECONDS = {500_000: 3.0}                 # s a frame of so many rays may take
STREET_TARGET = 1.3                             # times the floor
MOST_MEMORY = 4 * 2 ** 30                       # bytes
LARGE_PATHS, LARGE_CHIRPS, LARGE_ARRAY = 10_000_000, 256, (3, 4)    # of the frame that must run within that


def street():
    """The scene file of the demo."""
    with as_file(data_folder("scenes") / "street.toml") as path:
        return load_scene(path)


def record_of(scene, num_paths: int):
    """A record of the street of about `num_paths` paths, and hardly fewer."""
    paths_of_ray = ep.trace(scene.scene, scene.radar, num_rays=TRIAL_RAYS).num_paths / TRIAL_RAYS
    return ep.trace(scene.scene, scene.radar, num_rays=int(np.ceil(MARGIN * num_paths / paths_of_ray)))


def with_frame(radar, num_chirps: int, array=(1, 1)):
    """The radar with another number of chirps and antennas."""
    old = radar.waveform
    new = ep.ChirpSequence(start_frequency=old.start_frequency, bandwidth=old.bandwidth, num_samples=old.num_samples,
                           sampling_rate=old.sampling_rate, num_chirps=num_chirps, chirp_interval=old.chirp_interval)
    half = ep.speed_of_light / old.start_frequency / 2.0
    transmitters = [ep.Antenna((0.0, array[1] * half * i, 1.0)) for i in range(array[0])]
    return ep.Radar(new, transmitters=transmitters, receivers=[ep.Antenna((0.0, half * i, 1.0)) for i in range(array[1])])


def _measured(work, num_paths: int) -> dict:
    """Seconds of the clock and of the processor, medians of the repeats after a first that is not counted, and the peak of
    memory in bytes."""
    clock, processor_s = StageClock(), []
    work()
    for _ in range(int(np.clip(MEASURED_PATHS // num_paths, 5, 31))):
        with clock("work"):
            processor_s.append(processor_time(work)[0])
    return {"wall_s": float(np.median([stage.seconds for stage in clock.stages])),
            "processor_s": float(np.median(processor_s)),
            "peak_bytes": max(stage.peak_memory for stage in clock.stages), "repeats": len(processor_s)}


def measure_frames(*, quick: bool = False, tell=None) -> dict:
    """Rows of measured frames by what was varied."""
    scene = street()
    found = {"paths": [], "chirps": [], "channels": [], "parts": []}

    def add(kind: str, value, num_paths: int, work) -> None:
        found[kind].append({kind: value, **_measured(work, num_paths)})
        if tell:
            tell()

    few = with_frame(scene.radar, FRAME_CHIRPS)
    for count in QUICK_PATHS if quick else PATHS:
        paths = record_of(scene, count)
        add("paths", paths.num_paths, paths.num_paths, lambda paths=paths: ep.synthesize(paths, few))
    some = record_of(scene, 2_000 if quick else SOME_PATHS)
    for count in CHIRPS:
        add("chirps", count, some.num_paths, lambda count=count: ep.synthesize(some, with_frame(scene.radar, count)))
    for array in ARRAYS:
        add("channels", array[0] * array[1], some.num_paths,
            lambda array=array: ep.synthesize(some, with_frame(scene.radar, 64, array)))
    for count in PARTS:
        parts = _parts(scene.scene, count)
        add("parts", count, some.num_paths, lambda parts=parts: ep.decompose(some, with_frame(scene.radar, 64), parts))
    return found


def measure_large(num_paths: int = LARGE_PATHS) -> dict:
    """A row of the frame with many paths, chirps and channels, run once: seconds of trace and signal by the clock and the
    peak of memory in bytes over both, the record and the cube included."""
    scene, clock = street(), StageClock()
    radar = with_frame(scene.radar, LARGE_CHIRPS, LARGE_ARRAY)
    with clock("both"):
        trace_s, paths = wall_time(lambda: record_of(scene, num_paths))
        signal_s, cube = wall_time(lambda: ep.synthesize(paths, radar))
    return {"paths": paths.num_paths, "chirps": cube.shape[2], "channels": cube.shape[0] * cube.shape[1], "trace_s": trace_s,
            "signal_s": signal_s, "peak_bytes": clock.stages[0].peak_memory}


def _parts(scene, count: int) -> dict:
    names = [mesh.name for mesh in scene.meshes]
    pairs = [(name, bounces) for bounces in (1, 2, 3, 4) for name in names][:count - 1]
    return {f"{name}, {bounces}": ep.hits(name) & (ep.num_bounces == bounces) for name, bounces in pairs}


def measure_linearity() -> list[dict]:
    """Rows {paths, processor_s} of frames from LINEAR_FROM paths on. All sizes in turn, since machines have faster and
    slower minutes; medians of the rounds."""
    scene = street()
    few = with_frame(scene.radar, FRAME_CHIRPS)
    records = [record_of(scene, count) for count in PATHS if count >= LINEAR_FROM]
    rounds = [[_frame_seconds(paths, few) for paths in records] for _ in range(LINEAR_ROUNDS)]
    return [{"paths": paths.num_paths, "processor_s": seconds}
            for paths, seconds in zip(records, np.median(rounds, axis=0).tolist())]


def _frame_seconds(paths, radar) -> float:
    """Processor time of a frame, the mean over as many as take about as long as one of MEASURED_PATHS // 4 paths."""
    repeats = max(1, MEASURED_PATHS // 4 // paths.num_paths)
    return processor_time(lambda: [ep.synthesize(paths, radar) for _ in range(repeats)])[0] / repeats


def linearity(rows: list[dict]) -> float | None:
    """Largest over least processor time per path, less 1, from LINEAR_FROM paths on; None of fewer than two rows."""
    costs = [row["processor_s"] / row["paths"] for row in rows if row["paths"] >= LINEAR_FROM]
    return max(costs) / min(costs) - 1.0 if len(costs) > 1 else None


def measure_street(*, quick: bool = False) -> list[dict]:
    """Frames of the demo with both partitions by number of rays, and the floor under each, term by term."""
    return [_street_frames(street(), rays) for rays in (QUICK_STREET_RAYS if quick else STREET_RAYS)]


def _street_frames(scene, rays: int) -> dict:
    """The first frame by the clock, for which the system has to find memory, and the medians of later ones."""
    frames = [_street_frame(scene, rays) for _ in range(STREET_FRAMES)]
    paths = ep.trace(scene.scene, scene.radar, num_rays=rays)
    replay_s, path_chirps = wall_time(lambda: ep._core.bench.replay_only(paths, scene.radar))
    chirps = scene.radar.waveform.num_chirps
    moving = round((path_chirps - paths.num_paths) / (chirps - 1))
    whole_s, _ = wall_time(lambda: ep.synthesize(paths, scene.radar))
    still_s, _ = wall_time(lambda: ep.synthesize(paths, with_frame(scene.radar, 1)))
    num_paths = paths.num_paths
    paths = None  # gives its memory back
    queries_s = bare_share(scene.scene, scene.radar, rays, repetitions=1)["bare_s"]
    moving_s = 1e-9 * MOVING_NS * moving * chirps * 2.0 / ep.num_threads()
    terms = {"queries_s": queries_s, "moving_s": moving_s, "still_s": still_s * (1.0 - moving / max(1, num_paths))}
    trace_s, decompose_s, frame_s = (float(np.median([frame[key] for frame in frames[1:]]))
                                     for key in ("trace_s", "decompose_s", "frame_s"))
    return {"rays": rays, "paths": num_paths, "moving_paths": moving, "chirps": chirps, "trace_s": trace_s,
            "replay_s": replay_s, "synthesize_s": whole_s, "decompose_s": decompose_s, "frame_s": frame_s,
            "first": frames[0], "floor": terms, "floor_s": sum(terms.values())}


def _street_frame(scene, rays: int) -> dict:
    trace_s, paths = wall_time(lambda: ep.trace(scene.scene, scene.radar, num_rays=rays))
    decompose_s, _ = wall_time(lambda: ep.decompose(paths, scene.radar, scene.parts))
    return {"trace_s": trace_s, "decompose_s": decompose_s, "frame_s": trace_s + decompose_s}
