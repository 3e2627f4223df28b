"""The same input gives the same bits: for any number of threads, again, and after a file."""
from __future__ import annotations

import dataclasses
import tempfile
from pathlib import Path

import h5py
import numpy as np

import echopath as ep

from ...actors import shapes
from .case import Cases
from .scenes import METAL, make_radar, same_bits, scene_of, traced

cases = Cases("The same bits")
THREADS = (1, 2, 3, 7)


def small_street(num_chirps: int = 16):
    """A moving rough ball, a metal corner and a mirror, all regimes at once."""
    motion = ep.LinearMotion(velocity=(-3.0, 1.0, 0.0), angular_velocity=(0.0, 0.0, 2.0))
    scene = scene_of(("ball", shapes.sphere(0.4), ep.Material(permittivity=4 - 0.2j, scattering=0.6),
                      {"position": (6.0, 0.5, 0.2), "motion": motion, "smooth": True}),
                     ("corner", shapes.dihedral(0.5), METAL, {"position": (9.0, -1.0, 0.0)}),
                     ("wall", shapes.wall(40.0, 6.0), ep.Material(permittivity=5 - 0.3j, scattering=0.3, mirror=True),
                      {"position": (10.0, 3.0, -2.0)}))
    waveform = make_radar(num_chirps=num_chirps).waveform
    receivers = [ep.Antenna((0.0, 0.002 * k, 0.0)) for k in range(3)]
    return scene, ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=receivers)


def outcome(num_rays: int = 8000):
    """Paths and the bytes of all that is made of them."""
    scene, radar = small_street()
    paths = traced(scene, radar, num_rays, batches=4, seed=7)
    cube = ep.synthesize(paths, radar)
    parts = ep.decompose(paths, radar, {"ball": "T .* 'ball' .* R"})
    shown = ep.range_doppler(ep.add_noise(cube, radar, seed=3), radar)
    report = ep.validity(paths, radar, times=[1.6 * paths.frame.trace_time])
    power = ep.received_power(paths)
    angles = ep.range_azimuth(shown, radar)
    return paths, [cube.tobytes(), *(part.tobytes() for part in parts.values()), shown.values.tobytes(),
                   np.asarray(angles.power).tobytes(),
                   repr(power).encode(), str(report).encode()]


def differences(one, two) -> int:
    (paths, made), (again, made_again) = one, two
    return int(not same_bits(paths, again)) + sum(a != b for a, b in zip(made, made_again, strict=True))


def with_threads(counts, work) -> list:
    """What `work` gives with each number of threads."""
    before = ep.num_threads()
    try:
        made = []
        for count in counts:
            ep.set_num_threads(count)
            made.append(work())
    finally:
        ep.set_num_threads(before)
    return made


@cases("threads", "record, signal, parts, maps with noise, validity, power: results whose bits differ between 1, 2, 3 and 7 "
       "threads", bound=0.0, unit="results",
       broken="as many partial sums as threads: 4; random numbers in the order of their calls: 8")
def threads() -> float:
    made = with_threads(THREADS, outcome)
    return float(max(differences(made[0], other) for other in made[1:]))


def labelled_frame():
    """With partitions, labels and their errors, detections and checks, all from one call."""
    scene, radar = small_street()
    parts = {"route": {"direct": "T 'ball' R", "wall": "T .* 'wall' .* R"}, "object": {"ball": "T .* 'ball' .* R"}}
    return ep.simulate(scene, radar, num_rays=4000, seed=5, noise_seed=9, batches=4, parts=parts,
                       labels={"errors": True, "noise": False}, detections={"false_alarm_rate": 1e-3})


def frame_results(frame) -> list:
    """The bytes of a frame's signals, maps, labels, detections and checks."""
    arrays = [frame.cube, frame.spectrum.values, frame.range_azimuth.power]
    arrays += [cube for cubes in frame.parts.values() for cube in cubes.values()] + list(frame.part_of_path.values())
    results = [np.asarray(array).tobytes() for array in arrays]
    for labels in frame.labels.values():
        results += [_bytes_of(getattr(labels, field.name)) for field in dataclasses.fields(labels)]
    columns = [field.name for field in dataclasses.fields(frame.detections) if field.name != "echoes"]
    return results + [_bytes_of(getattr(frame.detections, name)) for name in columns] + [repr(frame.checks).encode()]


def _bytes_of(value) -> bytes:
    """Of an array of numbers; of all else its words."""
    is_numbers = isinstance(value, np.ndarray) and value.dtype.kind not in "UO"
    return value.tobytes() if is_numbers else repr(value.tolist() if isinstance(value, np.ndarray) else value).encode()


@cases("a labelled frame", "partitions, labels with errors, detections and checks: results whose bits differ between 1, 2, "
       "3 and 7 threads, at a second run, or in a file", bound=0.0, unit="results",
       broken="as many partial sums as threads: 30")
def a_labelled_frame() -> float:
    frames = with_threads((*THREADS, THREADS[0]), labelled_frame)
    with tempfile.TemporaryDirectory() as folder:
        ep.save_frame(frames[0], Path(folder) / "frame.h5")
        frames.append(ep.load_frame(Path(folder) / "frame.h5"))
    first, *others = map(frame_results, frames)
    return float(max(sum(a != b for a, b in zip(first, other, strict=True)) for other in others))


@cases("again", "the same, run twice in one process", bound=0.0, unit="results",
       broken="random numbers in the order of their calls: 8")
def again() -> float:
    return float(differences(outcome(), outcome()))


@cases("another seed", "other rays: share of weights that are the same", bound=0.01, unit="of them",
       broken="the seed left out: 1")
def another_seed() -> float:
    scene, radar = small_street()
    one, two = (traced(scene, radar, 4000, seed=seed) for seed in (1, 2))
    count = min(one.num_paths, two.num_paths)
    return float(np.mean(np.asarray(one.weight)[:count] == np.asarray(two.weight)[:count]))


@cases("after save and load", "record, signal and map of a file have the bits of the original", bound=0.0, unit="results",
       broken="weights rounded once more on their way: 2")
def after_a_file() -> float:
    scene, radar = small_street()
    frame = ep.simulate(scene, radar, num_rays=8000, seed=5, noise_seed=9, parts={"ball": "T .* 'ball' .* R"})
    with tempfile.TemporaryDirectory() as folder:
        ep.save_frame(frame, Path(folder) / "frame.h5")
        loaded = ep.load_frame(Path(folder) / "frame.h5")
    wrong = int(not same_bits(frame.paths, loaded.paths))
    wrong += ep.synthesize(loaded.paths, loaded.radar).tobytes() != ep.synthesize(frame.paths, radar).tobytes()
    wrong += loaded.spectrum.values.tobytes() != frame.spectrum.values.tobytes()
    return float(wrong + sum(loaded.parts["parts"][name].tobytes() != cube.tobytes() for name,
                             cube in frame.parts["parts"].items()))


@cases("seeds in files", "files of records and frames that do not tell the seeds of rays and noise", bound=0.0, unit="files",
       broken="seeds not written: 2")
def seeds_in_files() -> float:
    scene, radar = small_street(4)
    frame = ep.simulate(scene, radar, num_rays=500, seed=123457, noise_seed=98765)
    with tempfile.TemporaryDirectory() as folder:
        names = [Path(folder) / "frame.h5", Path(folder) / "paths.h5"]
        ep.save_frame(frame, names[0])
        frame.paths.save(names[1])
        told = [_numbers_in(name) for name in names]
    return float((not {123457, 98765} <= told[0]) + (123457 not in told[1]))


def _numbers_in(path) -> set:
    """All whole numbers that stand in attributes of an HDF5 file."""
    found = set()

    def look(_, item):
        found.update(int(value) for value in item.attrs.values() if isinstance(value, (int, np.integer)))

    with h5py.File(path) as file:
        file.visititems(look)
    return found
