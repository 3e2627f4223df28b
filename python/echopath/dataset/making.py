"""Makes a dataset of a template, or goes on where that was ended."""

import os
import shutil
import tempfile
import time
import uuid
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from .. import _core
from ..arguments.checks import array, checked, count, flag, optional, path as file_or_folder, refused, text
from ..base.storage.files import require_writable
from ..base.text.counts import counted
from ..sequence.folder import NAME as CONTENTS
from ..sequence.saving import Shard, shard_rule
from .address import Address, is_address
from .cluster import in_dask
from .folder import SceneRecord, prepare_folder, read_or_nothing, read_record, scene_name, write_manifest
from .scene_work import differs_from, is_done, tidy
from .template import Template
from .unresolved import NAME as UNRESOLVED, UnresolvedEchoes, unresolved_in
from .workers import Done, forget, in_processes, in_this_process

_LOOKED_AT, _BUILT = 1000, 8  # scenes at most that are drawn, and made ready to trace, before the first frame
_TRIED = 3                    # scenes at most, on one of which a frame is made before, for the forecast
_MARGIN = 1.1                 # of the disk that is asked for over what the first frame and its scene take


class Forecast(NamedTuple):
    """What is to be made: frames; seconds: that it takes, None: not known, of the workers of a scheduler; bytes: on the disk.

    Both go by the first frame that can be made, as if all were like it: scenes that differ may take half or twice as long.
    `MadeScene.seconds_left` goes by the scenes that have been made so far."""

    frames: int
    seconds: float | None
    bytes: int

    def __repr__(self) -> str:
        time = "a time that depends on the workers" if self.seconds is None else f"about {self.seconds:.2g} s"
        return f"Forecast({counted(self.frames, 'frame')} in {time}, {self.bytes / 2**20:.2g} MiB)"


class MadeScene(NamedTuple):
    """One scene that was looked at or made.

    scene: its number; split: name of its split; record: SceneRecord; was_there: whether nothing was to be done
    done, total: how many of how many scenes of this run have been looked at; seconds_left: None: not known yet
    unresolved: UnresolvedEchoes of its first frame, None: not known, as of scenes that failed
    """

    scene: int
    split: str
    record: SceneRecord
    was_there: bool
    done: int
    total: int
    seconds_left: float | None
    unresolved: UnresolvedEchoes | None = None

    def __repr__(self) -> str:
        told = [f"{self.done} of {self.total}: scene {self.scene} ({self.split}) {self.record.state}"]
        told += [self.record.reason] if self.record.reason else []
        told += [f"about {self.seconds_left:.2g} s left"] if self.seconds_left else []
        return f"MadeScene({', '.join(told)})"


def _frames_rule(argument: str, value: Any) -> tuple[int, int] | None:
    """None, or (first, end) of numbers of frames."""
    if value is None:
        return None
    first, end = array("[2]", kind="whole")(argument, value).tolist()
    if not 0 <= first < end:
        raise refused(ValueError, argument, "(first, end) with 0 <= first < end", value)
    return first, end


class _LocalFolder:
    """The folder of a dataset in the file system, as `Address` is one elsewhere."""

    def __init__(self, folder: Path):
        require_writable(folder, "folder")
        self.folder, self.address = folder, str(folder)

    def prepare(self, template: Template) -> None:
        prepare_folder(self.folder, template)

    def record(self, scene: int) -> SceneRecord:
        """What is written of a scene; to do where files are damaged, which are removed."""
        record = read_record(self.folder, scene)
        if record.state != "done":
            return record
        if not is_done(self.folder, scene):
            return SceneRecord("to do")
        tidy(self.folder, scene)
        return record

    def get(self, name: str) -> bytes:
        """The content of a file, nothing where there is none."""
        return read_or_nothing(self.folder / name)

    def forget(self, scenes: list[int]) -> None:
        forget(self.folder, scenes)

    def write_manifest(self, template: Template) -> None:
        write_manifest(self.folder, template)


@checked(template=file_or_folder, folder=file_or_folder, workers=count(1, 1024), shard=shard_rule,
         frames=_frames_rule, only_failed=flag, scheduler=optional(text))
def make(template: str | os.PathLike[str], folder: str | os.PathLike[str], *, workers: int = 1, shard: Shard | None = None,
         frames: tuple[int, int] | None = None, only_failed: bool = False, scheduler: str | None = None
         ) -> Iterator[Forecast | MadeScene]:
    """Makes the frames of a template that are missing in a folder; yields a Forecast, then each scene as it is there.

    Files are written whole or not at all, so that a run that was ended, however it was, is gone on with by the same call, and
    all frames have the same bits. Each is a function of the template's seed and its own number, for any number of workers.
    Files that are not as they were written are made again; scenes that failed are left alone without `only_failed`.
    template: path of a TOML file (keys: data/README.md); folder: new, or of this template, with as many scenes or fewer; with a
        scheduler also an address of fsspec, such as s3://bucket/folder
    workers: number of processes, which share the processors; 1 with a scheduler. Each reads the script, whose call belongs
        below if __name__ == "__main__":
    shard: (k, n), the k-th of n shards, k from 1 to n: every n-th scene from the k-th on, while other processes or machines make
        the other shards in the same folder; None: all
    frames: (first, end), numbers of frames from 0: the scenes that one of first ... end - 1 belongs to; None: all
    only_failed: whether those scenes alone are made, again, that failed
    scheduler: address of a Dask scheduler, such as tcp://host:8786, whose workers see the template and the folder under the
        same names: each makes a scene at a time with each of its threads (extra `cluster`); None: this machine
    Raises TypeError or ValueError naming the argument, before the first frame also of a folder whose scenes were made of other
    files than those that the template names now (eight are looked at), or by another echopath; ValueError naming the file, the
    scene and the key of a fault of the template, likewise; ep.FileError where files cannot be written, or those of an address
    not be read, and before the first frame where the disk is too small; ModuleNotFoundError without the libraries of a
    scheduler or an address; ConnectionError naming `scheduler` where that does not answer.
    """
    plan = Template(Path(template))
    scenes = _chosen(plan, shard, frames)
    where = os.fspath(folder)
    if is_address(where) and scheduler is None:
        raise refused(ValueError, "folder", "no address where there is no scheduler", where)
    if workers > 1 and scheduler is not None:
        raise refused(ValueError, "workers", "1 where there is a scheduler", workers)
    place = Address(where) if is_address(where) else _LocalFolder(Path(where))
    _look_at(plan, scenes)
    place.prepare(plan)

    def front(missing: list[int], run: str) -> Iterator[Done]:
        if scheduler is not None:
            return in_dask(scheduler, plan.path, where, missing, run)
        if workers == 1:
            return in_this_process(plan, Path(where), missing, run)
        return in_processes(plan.path, Path(where), missing, run, min(workers, len(missing)))

    return _made(plan, place, scenes, front, only_failed, workers if scheduler is None else None)


def _chosen(plan: Template, shard: Shard | None, frames: tuple[int, int] | None) -> list[int]:
    per_scene, total = plan.settings.frames, plan.settings.scenes * plan.settings.frames
    first, end = frames or (0, total)
    if end > total:
        raise refused(ValueError, "frames", f"within the {total} frames of the template", frames)
    k, n = shard or (1, 1)
    return [scene for scene in range(first // per_scene, -(-end // per_scene)) if scene % n == k - 1]


def _some(scenes: list[int], most: int) -> list[int]:
    """So many of some scenes at most, evenly among them."""
    return scenes[::-(-len(scenes) // most) or 1]


def _look_at(plan: Template, scenes: list[int]) -> None:
    """Raises ValueError for faults of the template: some scenes are drawn, a few of them made ready. Warns of unused classes."""
    for scene in _some(scenes, _LOOKED_AT):
        plan.check(scene)
    for scene in _some(scenes, _BUILT):
        plan.sequence(scene)
    for scene in scenes[:1]:
        plan.warn_of_unused_classes(scene)


def _require_same(plan: Template, place: _LocalFolder | Address, done: list[int]) -> None:
    """Raises ValueError naming `folder` where a few of the scenes that are done would be others if they were made now."""
    for scene in _some(done, _BUILT):
        kept = place.get(f"{scene_name(scene)}/{CONTENTS}")
        if differing := differs_from(plan, plan.sequence(scene), kept):
            raise refused(ValueError, "folder", "new, or of the files that the template names as they are now (scene "
                          f"{scene} was made of others, or by another echopath: {differing})", place.address)


def _made(plan: Template, place: _LocalFolder | Address, scenes: list[int], front: Callable[[list[int], str], Iterator[Done]],
          only_failed: bool, workers: int | None) -> Iterator[Forecast | MadeScene]:
    records = {scene: place.record(scene) for scene in scenes}
    if only_failed:
        scenes = [scene for scene in scenes if records[scene].state == "failed"]
        place.forget(scenes)
    missing = scenes if only_failed else [scene for scene in scenes if records[scene].state == "to do"]
    if missing:
        _require_same(plan, place, [scene for scene, record in records.items() if record.state == "done"])
    forecast = _forecast(plan, place, missing, workers) if missing else Forecast(0, 0.0, 0)
    yield forecast
    there = [scene for scene in scenes if scene not in set(missing)]
    for done, scene in enumerate(there, 1):
        yield MadeScene(scene, plan.split_of(scene), records[scene], True, done, len(scenes), None, _unresolved(place, scene))
    if not missing:
        place.write_manifest(plan)
        return
    run, begin = uuid.uuid4().hex, time.perf_counter()
    try:
        for number, (scene, record) in enumerate(front(missing, run), 1):
            now = time.perf_counter()
            if number == 1 and forecast.seconds is not None:  # workers take seconds to start, which no later scene does
                begin = max(begin, now - forecast.seconds / len(missing))
            left = (now - begin) / number * (len(missing) - number)
            yield MadeScene(scene, plan.split_of(scene), record, False, len(there) + number, len(scenes), left,
                            _unresolved(place, scene))
    finally:
        place.write_manifest(plan)


def _unresolved(place: _LocalFolder | Address, scene: int) -> UnresolvedEchoes | None:
    return unresolved_in(place.get(f"{scene_name(scene)}/{UNRESOLVED}"))


def _forecast(plan: Template, place: _LocalFolder | Address, missing: list[int], workers: int | None) -> Forecast:
    """By the first frame that can be made. Raises ep.FileError where the disk is too small; nobody knows what room an address
    has, or how fast workers are that may join and leave (workers: None)."""
    begin = time.perf_counter()
    sizes = _sizes_of_a_frame(plan, missing[:_TRIED])
    frames = len(missing) * plan.settings.frames
    once = sizes.pop(CONTENTS, 0)  # for all frames of a scene
    needed = int(_MARGIN * (once * len(missing) + sum(sizes.values()) * frames))
    if isinstance(place, _LocalFolder) and needed > (free := shutil.disk_usage(place.folder).free):
        raise _core.FileError(f"folder: must have {needed / 2 ** 20:.1f} MiB for {frames} frames, got "
                              f"{free / 2 ** 20:.1f} MiB in '{place.folder}'")
    seconds = None if workers is None else (time.perf_counter() - begin) * frames / min(workers, len(missing))
    return Forecast(frames, seconds, needed)


def _sizes_of_a_frame(plan: Template, scenes: list[int]) -> dict[str, int]:
    """{file: bytes} of the first frame of a scene, made on trial. Raises ValueError, of the first scene, where none can be."""
    faults = []
    for scene in scenes:
        with tempfile.TemporaryDirectory(prefix="echopath-") as trial, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # as when it is made in earnest
            try:
                next(iter(plan.sequence(scene).save_frames(trial, keep=plan.settings.keep)))
                return {path.name: path.stat().st_size for path in Path(trial).iterdir()}
            except (ValueError, RuntimeError) as error:
                faults.append(f"{plan.path}: scene {scene}: {str(error).removeprefix(f'{plan.path}: ')}")
    raise ValueError(faults[0])
