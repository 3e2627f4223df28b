"""Makes a dataset of a template, or goes on where that was ended."""
from __future__ import annotations

import os
import shutil
import tempfile
import time
import uuid
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from .. import _core
from ..checks import array, checked, count, flag, refused
from ..checks import path as file_or_folder
from ..files import require_writable
from ..sequence.saving import Shard, shard_rule
from .folder import SceneRecord, prepare_folder, read_record, write_manifest
from .scene_work import is_done
from .template import Template
from .workers import forget_failures, in_processes, in_this_process

_LOOKED_AT, _BUILT = 1000, 8  # scenes at most that are drawn, and made ready to trace, before the first frame
_MARGIN = 1.1                 # of the disk that is asked for over what one frame takes


class Forecast(NamedTuple):
    """What is to be made: frames; seconds: that it takes; bytes: on the disk, by its first frame."""

    frames: int
    seconds: float
    bytes: int


class MadeScene(NamedTuple):
    """One scene that was looked at or made.

    scene: its number; split: name of its split; record: SceneRecord; was_there: whether nothing was to be done
    done, total: how many of how many scenes of this run have been looked at; seconds_left: None: not known yet
    """

    scene: int
    split: str
    record: SceneRecord
    was_there: bool
    done: int
    total: int
    seconds_left: float | None


def _frames_rule(argument: str, value: Any) -> tuple[int, int] | None:
    """None, or (first, end) of numbers of frames."""
    if value is None:
        return None
    first, end = array("[2]", kind="whole")(argument, value).tolist()
    if not 0 <= first < end:
        raise refused(ValueError, argument, "(first, end) with 0 <= first < end", value)
    return first, end


@checked(template=file_or_folder, folder=file_or_folder, workers=count(1, 1024), shard=shard_rule,
         frames=_frames_rule, only_failed=flag)
def make(template: str | os.PathLike[str], folder: str | os.PathLike[str], *, workers: int = 1, shard: Shard | None = None,
         frames: tuple[int, int] | None = None, only_failed: bool = False) -> Iterator[Forecast | MadeScene]:
    """Makes the frames of a template that are missing in a folder; yields a Forecast, then each scene as it is there.

    Files are written whole or not at all, so that a run that was ended, however it was, is gone on with by the same call, and
    all frames have the same bits. Each is a function of the template's seed and its own number, for any number of workers.
    Files that are not as they were written are made again; scenes that failed are left alone without `only_failed`.
    template: path of a TOML file (keys: data/README.md); folder: new, or of this template, with as many scenes or fewer
    workers: number of processes, which share the processors
    shard: (k, n), the k-th of n shards, k from 1 to n: every n-th scene from the k-th on, while other processes or machines make
        the other shards in the same folder; None: all
    frames: (first, end), numbers of frames from 0: the scenes that one of first ... end - 1 belongs to; None: all
    only_failed: whether those scenes alone are made, again, that failed
    Raises TypeError or ValueError naming the argument; ValueError naming the file, the scene and the key of a fault of the
    template, before the first frame; ep.FileError where files cannot be written, and before the first frame where the disk is
    too small.
    """
    folder = Path(folder)
    require_writable(folder, "folder")
    plan = Template(Path(template))
    scenes = _chosen(plan, shard, frames)
    _look_at(plan, scenes)
    prepare_folder(folder, plan)
    return _made(plan, folder, scenes, workers, only_failed)


def _chosen(plan: Template, shard: Shard | None, frames: tuple[int, int] | None) -> list[int]:
    per_scene, total = plan.settings.frames, plan.settings.scenes * plan.settings.frames
    first, end = frames or (0, total)
    if end > total:
        raise refused(ValueError, "frames", f"within the {total} frames of the template", frames)
    k, n = shard or (1, 1)
    return [scene for scene in range(first // per_scene, -(-end // per_scene)) if scene % n == k - 1]


def _look_at(plan: Template, scenes: list[int]) -> None:
    """Raises ValueError for faults of the template: some scenes are drawn, a few of them made ready."""
    for scene in scenes[::-(-len(scenes) // _LOOKED_AT) or 1]:
        plan.check(scene)
    for scene in scenes[::-(-len(scenes) // _BUILT) or 1]:
        plan.sequence(scene)


def _made(plan: Template, folder: Path, scenes: list[int], workers: int, only_failed: bool) -> Iterator[Forecast | MadeScene]:
    if only_failed:
        scenes = forget_failures(folder, scenes)
    missing = [scene for scene in scenes if _is_missing(folder, scene)]
    forecast = _forecast(plan, folder, missing, workers) if missing else Forecast(0, 0.0, 0)
    yield forecast
    places = set(missing)
    done = 0
    for scene in scenes:
        if scene not in places:
            done += 1
            yield MadeScene(scene, plan.split_of(scene), read_record(folder, scene), True, done, len(scenes), None)
    run, begin = uuid.uuid4().hex, time.perf_counter()
    try:
        made = (in_this_process(plan, folder, missing, run) if workers == 1 else
                in_processes(plan.path, folder, missing, run, min(workers, max(1, len(missing)))))
        for number, (scene, record) in enumerate(made, 1):
            left = (time.perf_counter() - begin) / number * (len(missing) - number)
            yield MadeScene(scene, plan.split_of(scene), record, False, done + number, len(scenes), left)
    finally:
        write_manifest(folder, plan)


def _is_missing(folder: Path, scene: int) -> bool:
    """Whether a scene is to be made; frames that are damaged are removed, and their scene is to do."""
    record = read_record(folder, scene)
    return record.state == "to do" or (record.state == "done" and not is_done(folder, scene))


def _forecast(plan: Template, folder: Path, missing: list[int], workers: int) -> Forecast:
    """By the first frame that is missing, which is made on trial. Raises ep.FileError where the disk is too small."""
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="echopath-") as trial, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # as when it is made in earnest
        next(iter(plan.sequence(missing[0]).save_frames(trial, keep=plan.settings.keep)))
        size = sum(path.stat().st_size for path in Path(trial).iterdir())
    frames = len(missing) * plan.settings.frames
    needed, free = int(_MARGIN * size * frames), shutil.disk_usage(folder).free
    if needed > free:
        raise _core.FileError(f"folder: must have {needed >> 20} MiB for {frames} frames, got {free >> 20} MiB in '{folder}'")
    return Forecast(frames, (time.perf_counter() - begin) * frames / min(workers, len(missing)), needed)
