"""Makes the frames of one scene of a dataset."""
from __future__ import annotations

import fcntl
import json
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .. import _core
from ..base.process.callers import warn_user
from ..base.storage.files import write_texts
from ..frame.frame import Frame
from ..sequence import Sequence
from ..sequence.folder import NAME as CONTENTS, differs_from as sequence_differs, frame_path
from ..sequence.keep import Keep
from .folder import (
    DRAWN,
    RECORD,
    SceneRecord,
    checksum,
    damaged_files,
    read_or_nothing,
    read_record,
    scene_folder,
    write_record,
)
from .template import Template
from .unresolved import NAME as UNRESOLVED, unresolved_in, write_unresolved

_CLAIM, _BEGUN = ".claim", ".begun"
_MOST_DEATHS = 2  # of workers of one run at one scene


@contextmanager
def claimed(folder: Path, scene: int) -> Iterator[bool]:
    """Whether this process alone makes the scene during the block; the system ends that when the process ends.

    Raises ep.FileError.
    """
    own = scene_folder(folder, scene)
    with _told(own):
        own.mkdir(parents=True, exist_ok=True)
        handle = os.open(own / _CLAIM, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
            return
        yield True
    finally:
        os.close(handle)


def is_done(folder: Path, scene: int) -> bool:
    """Whether all files of a scene are there as they were written; what is damaged is removed, and the scene is to do again.

    Warns (RuntimeWarning) of damaged files.
    """
    record = read_record(folder, scene)
    damaged = damaged_files(folder, scene, record)
    for path in filter(Path.exists, damaged):
        warn_user(f"{path}: is not as it was written: it is made again")
    if any(path.name == CONTENTS for path in damaged):  # without it, nobody knows of what the frames are
        damaged = [scene_folder(folder, scene) / name for name in record.files]
    for path in damaged:
        path.unlink(missing_ok=True)
    if damaged:
        (scene_folder(folder, scene) / RECORD).unlink(missing_ok=True)
    return record.state == "done" and not damaged


def make_scene(template: Template, folder: Path, scene: int, run: str) -> SceneRecord:
    """Makes the frames of a scene that are missing, and writes what came of it; the caller has claimed it.

    run: name of the run, in which a scene at which workers died twice has failed
    """
    deaths = _note_begin(folder, scene, run)
    if deaths >= _MOST_DEATHS:
        record = SceneRecord("failed", reason=f"{deaths} workers died at it")
    else:
        record = _made(template, folder, scene)
    tidy(folder, scene)
    write_record(folder, scene, record)  # the last: whoever waits for it may end this process
    return record


def differs_from(template: Template, sequence: Sequence, kept: bytes) -> str:
    """What the frames of a scene, as the template has them now, do not share with those that were made, in words; "" where they
    are the same. Files that the template names may have changed since, and echopath; the template itself has not.

    kept: content of the file sequence.h5 of the scene
    """
    return sequence_differs(sequence._contents(template.settings.keep), kept)


def tidy(folder: Path, scene: int) -> None:
    """Removes what a worker that was killed has left beside the files of a scene; the caller has claimed it."""
    own = scene_folder(folder, scene)
    for left in (own / _BEGUN, *own.glob(".*-*")):  # temporary files of `written_whole`
        left.unlink(missing_ok=True)


def _made(template: Template, folder: Path, scene: int) -> SceneRecord:
    own, frames = scene_folder(folder, scene), template.settings.frames
    try:
        drawn = template.draw(scene)
        sequence = template.sequence_of(drawn)
    except (ValueError, RuntimeError, _core.FileError, MemoryError) as error:  # files: those that the scene names
        return _failed(error)
    write_texts(own, {DRAWN: json.dumps(drawn.values, indent=1) + "\n"})
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what a frame warns of is in its labels and checks
            _save(sequence, own, template.settings.keep)
    except _core.FileError:
        raise  # a disk that is full or away is no fault of the scene
    except (ValueError, RuntimeError, MemoryError) as error:
        return _failed(error)
    paths = [own / CONTENTS, own / DRAWN, own / UNRESOLVED, *(frame_path(own, place) for place in range(frames))]
    return SceneRecord("done", {path.name: checksum(path) for path in paths})


def _save(sequence: Sequence, own: Path, keep: Keep) -> None:
    """Makes the frames that are missing, and tells of the first what its rays do not resolve."""
    labels = sequence._settings()["labels"]

    def look(frame: Frame) -> None:
        if frame.paths.frame.start_time == sequence.times[0]:
            write_unresolved(own, frame, labels)

    for _ in sequence._save_frames(own, keep, look=look):
        pass
    if unresolved_in(read_or_nothing(own / UNRESOLVED)) is None:  # the frame was there
        look(sequence[0])


def _failed(error: Exception) -> SceneRecord:
    return SceneRecord("failed", reason=f"{type(error).__name__}: {error}")


def _note_begin(folder: Path, scene: int, run: str) -> int:
    """How many workers of this run have begun the scene before."""
    path = scene_folder(folder, scene) / _BEGUN
    with _told(path):
        begun = path.read_text().split().count(run) if path.exists() else 0
        with path.open("a") as file:
            file.write(f"{run}\n")
    return begun


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Raises ep.FileError naming a path where the block raises OSError."""
    try:
        yield
    except OSError as error:
        raise _core.FileError(f"{path}: cannot be written ({error.strerror or error})") from None
