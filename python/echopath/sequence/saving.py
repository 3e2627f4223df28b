"""Frames of a sequence into a folder, one file each, so that a run that was ended goes on where it was."""
from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from pathlib import Path
from typing import NamedTuple

from .. import _core
from ..arguments.checks import array, refused
from ..base.files import require_writable
from ..frame.frame import Frame
from ..frame_file.maps import start_time_in
from .contents import Contents, frame_path, write_contents
from .folder_lock import writing_to
from .keep import Keep, write_frame

Shard = tuple[int, int]  # (k, n): the frames at places k - 1, k - 1 + n and so on


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


def shard_rule(argument: str, value) -> Shard | None:
    """None, or (k, n): the k-th of n shards, k from 1 to n."""
    if value is None:
        return None
    k, n = array("[2]", kind="whole")(argument, value).tolist()
    if not 1 <= k <= n:
        raise refused(ValueError, argument, "(k, n), the k-th of n shards, k from 1 to n", value)
    return k, n


def saved_frames(times, folder, keep: Keep, frames_at: Callable[[Iterable[int]], Iterator[Frame]], contents: Contents,
                 shard: Shard | None = None) -> Iterator[SavedFrame]:
    """Makes the missing files of a folder, in order, and tells of each frame.

    times: starts of the frames [K] in s; frames_at: callable (places) that gives their Frames, one after the other; contents:
    of sequence.h5; shard: which frames this process makes while others write to the folder, None: all of them, alone
    Raises ValueError naming the folder where it holds another sequence or another process writes to it, ep.FileError.
    """
    require_writable(folder, "folder")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)

    def prepare(is_alone: bool) -> None:
        write_contents(folder, contents)
        if is_alone:
            _remove_leftovers(folder)

    with writing_to(folder, shard is not None, prepare):
        yield from _made(times, folder, keep, frames_at, places_of(shard, len(times)))


def places_of(shard: Shard | None, count: int) -> range:
    """The places of the frames of a shard, of `count` frames."""
    k, n = shard or (1, 1)
    return range(k - 1, count, n)


def _made(times, folder: Path, keep: Keep, frames_at, places: range) -> Iterator[SavedFrame]:
    todo = _Todo(times, folder, places)
    missing = sum(not frame_path(folder, place).exists() for place in places)
    spent, made = 0.0, 0
    with closing(frames_at(todo.missing())) as frames:
        for place in places:
            path, begin = frame_path(folder, place), time.perf_counter()
            missing -= not path.exists()
            was_there = todo.is_done(place)
            if not was_there:
                write_frame(next(frames), path, keep)
                spent, made = spent + time.perf_counter() - begin, made + 1
            yield SavedFrame(place, float(times[place]), path, None if was_there else time.perf_counter() - begin,
                             missing * spent / made if made else None)


class _Todo:
    """Which frames are there: each is looked at once, in order, by who asks for one of its kind first."""

    def __init__(self, times, folder: Path, places: range):
        self._times, self._folder, self._unseen = times, folder, deque(places)
        self._is_done: dict[int, bool] = {}  # of places that nobody has asked for yet
        self._missing: deque[int] = deque()

    def is_done(self, place: int) -> bool:
        """Whether the frame at a place was there; to be asked in order."""
        while place not in self._is_done:
            self._look()
        return self._is_done.pop(place)

    def missing(self) -> Iterator[int]:
        """The places of those that were not."""
        while self._missing or self._unseen:
            if self._missing:
                yield self._missing.popleft()
            else:
                self._look()

    def _look(self) -> None:
        place = self._unseen.popleft()
        self._is_done[place] = _is_done(frame_path(self._folder, place), self._times[place])
        if not self._is_done[place]:
            self._missing.append(place)


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
