"""A drive through a city street: what each stage of a frame costs, memory over the frames, sizes of files; a person who walks.

Times are of the processor, of all threads, so that other programs do not matter. Stages are measured in frames one by one; the
drive itself goes the way of `Sequence.save`, which traces the next frame meanwhile.
"""
from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

import echopath as ep

from ...sequence.keep import write_frame
from ...sequence.unused_memory import resident_memory
from ..alone import alone
from ..suite import describe_judged, judged
from ..timing import processor_time, wall_time
from . import street

FRAMES, QUICK_FRAMES = 100, 5
STAGE_FRAMES, QUICK_STAGE_FRAMES = 5, 2   # of the drive, evenly spaced, whose stages are measured
INTERVAL = 0.05                           # s
RAYS, QUICK_RAYS = 100_000, 2_000
SETTLED = 3                               # frames, after which memory is to be flat
PERSON_FRAMES, QUICK_PERSON_FRAMES = 80, 4
PERSON_INTERVAL = 0.025                   # s: 80 frames are 2 s
STAGES = {"trace": "trace", "synthesis": "signal", "labels of cells": "labels"}  # what they are called here; others: "maps"
LIMITS = {"all stages, s a frame": 2.0, "frame over its stages": 1.1, "overlapped over one by one, wall": 1.1,
          "memory over that after 3 frames": 1.1, "file of labels, MiB": 2.0, "person, s": 8.0}
MIB = 2.0 ** 20


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each figure: what, measured, limit and whether it holds.

    quick: a short street, few rays and frames, for a look
    """
    return judged(alone(_measured, quick), LIMITS)


def describe(rows: list[dict]) -> list[str]:
    """What, the figure, its limit, and whether it holds."""
    return describe_judged(rows, "drive")


def sequence_of(frames: int, *, quick: bool = False) -> ep.Sequence:
    """So many frames of the drive."""
    seconds = frames * INTERVAL + 0.1
    scene = street.city_street(seconds, num_cars=3, num_people=2, length=street.QUICK_LENGTH) if quick else \
        street.city_street(seconds)
    return ep.Sequence(scene, street.radar(), frames=frames, interval=INTERVAL, num_rays=QUICK_RAYS if quick else RAYS,
                       labels=True)


def person_sequence(frames: int) -> ep.Sequence:
    """So many frames of a person who walks toward the radar, without a gap between them."""
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(speed=1.3, duration=3.0), name="walker", position=(8.0, 0.0, 0.0), yaw=np.pi)
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=64, sampling_rate=5e6, num_chirps=128,
                                chirp_interval=PERSON_INTERVAL / 128)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=10.0)
    return ep.Sequence(scene, radar, frames=frames, interval=PERSON_INTERVAL, num_rays=5000)


def _measured(quick: bool) -> dict:
    frames = QUICK_FRAMES if quick else FRAMES
    drive = sequence_of(frames, quick=quick)
    meshes = drive.scene.meshes
    found = {"triangles": sum(len(mesh.triangles) for mesh in meshes), "meshes": len(meshes), "frames": frames}
    return found | _whole_drive(drive) | _stages(drive, QUICK_STAGE_FRAMES if quick else STAGE_FRAMES) | \
        _person(QUICK_PERSON_FRAMES if quick else PERSON_FRAMES)


def _whole_drive(drive: ep.Sequence) -> dict:
    """Memory and files of all frames, each saved with its labels alone."""
    memory, sizes = [], []

    def run():
        with tempfile.TemporaryDirectory() as folder:
            for one in drive.save_frames(folder, keep="labels"):
                memory.append(resident_memory())
                sizes.append(one.path.stat().st_size)

    seconds, _ = processor_time(run)
    return {"memory after 3 frames, MiB": memory[SETTLED - 1] / MIB,
            "memory at most after that, MiB": max(memory[SETTLED:]) / MIB,
            "memory over that after 3 frames": max(memory[SETTLED:]) / memory[SETTLED - 1],
            "file of labels, MiB": max(sizes) / MIB, "drive, s a frame": seconds / len(drive)}


def _stages(drive: ep.Sequence, count: int) -> dict:
    """Medians of the stages of some frames one by one, and the same frames saved in a row."""
    some = drive[::max(1, len(drive) // count)][:count]
    some[0]  # what only a first frame costs
    measured, wholes, wall = [], [], 0.0
    with tempfile.TemporaryDirectory() as folder:
        for place in range(len(some)):
            took, (processor, (frame, file)) = wall_time(lambda: processor_time(lambda: _frame_and_file(some, place, folder)))
            measured.append(_by_name(frame.stages) | {"file": file})
            wholes.append(processor / sum(measured[-1].values()))
            wall += took
        in_a_row, _ = wall_time(lambda: [None for _ in some.save_frames(Path(folder) / "all", keep="labels")])
    names = list(dict.fromkeys(name for one in measured for name in one))
    medians = {name: float(np.median([one[name] for one in measured])) for name in names}
    return {f"{name}, s a frame": seconds for name, seconds in medians.items()} | {
        "all stages, s a frame": float(np.median([sum(one.values()) for one in measured])),
        "frame over its stages": float(np.median(wholes)), "overlapped over one by one, wall": in_a_row / wall}


def _frame_and_file(drive: ep.Sequence, place: int, folder: str):
    frame = drive[place]
    return frame, processor_time(lambda: write_frame(frame, Path(folder) / "frame.h5", "labels"))[0]


def _by_name(stages) -> dict:
    """{name: s of the processor}"""
    found = {}
    for stage in stages:
        name = STAGES.get(stage.name, "maps")
        found[name] = found.get(name, 0.0) + stage.processor_seconds
    return found


def _person(frames: int) -> dict:
    made = person_sequence(frames)
    seconds, picture = processor_time(lambda: ep.spectrogram(made, span_frames=True))
    return {"person, frames": frames, "person, columns of the spectrogram": len(picture.times), "person, s": seconds}
