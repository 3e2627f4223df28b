"""Frames of a sequence into a folder, one file each, so that a run that was ended goes on where it was."""
from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from .. import _core
from ..checks import refused
from ..files import require_writable
from ..frame_file.maps import start_time_in
from .contents import Contents, frame_path, write_contents
from .keep import Keep, write_frame


class SavedFrame(NamedTuple):
    """One frame that is in the folder now.

    place: of the frame; start_time: s; path: of its file; seconds: that it took, None: it was there
    seconds_left: for those that are missing, by the mean of those that were made; None: not known yet
    """

    place: int
    start_time: float
    path: Path
    seconds: float | None
    seconds_left: float | None


def saved_frames(times, folder, keep: Keep, frame_at, contents: Contents) -> Iterator[SavedFrame]:
    """Makes the missing files of a folder, in order, and tells of each frame.

    times: starts of the frames [K] in s; frame_at: callable (place) that gives a Frame; contents: of sequence.h5
    Raises ValueError naming the folder where it holds another sequence or another process writes to it, ep.FileError.
    """
    require_writable(folder, "folder")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with _alone_in(folder):
        write_contents(folder, contents)
        _remove_leftovers(folder)
        missing = sum(not frame_path(folder, place).exists() for place in range(len(times)))
        spent, made = 0.0, 0
        for place, start_time in enumerate(times):
            path, begin = frame_path(folder, place), time.perf_counter()
            missing -= not path.exists()
            was_there = _is_done(path, start_time)
            if not was_there:
                write_frame(frame_at(place), path, keep)
                spent, made = spent + time.perf_counter() - begin, made + 1
            yield SavedFrame(place, float(start_time), path, None if was_there else time.perf_counter() - begin,
                             missing * spent / made if made else None)


def _remove_leftovers(folder: Path) -> None:
    """Removes the temporary files of a process that was killed."""
    for name in (".frame_*-*.h5", ".sequence-*.h5"):
        for leftover in folder.glob(name):
            leftover.unlink(missing_ok=True)


def _is_done(path: Path, start_time: float) -> bool:
    """Whether the file of a frame is there, whole, and of its time."""
    try:
        return path.exists() and start_time_in(path) == start_time
    except _core.FileError:
        return False


@contextmanager
def _alone_in(folder: Path):
    """Keeps other processes from writing to a folder; the system ends that when this one ends, however it does."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise refused(ValueError, "folder", "one that no other run is writing to", str(folder)) from None
        yield
    finally:
        os.close(handle)
