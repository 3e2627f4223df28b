"""Frames of a sequence into a folder or a file, so that a run that was ended goes on where it was."""

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from pathlib import Path
from typing import NamedTuple

from .. import _core
from ..arguments.checks import array, refused
from ..base.process.callers import warn_user
from ..frame.frame import Frame
from ..frame_file.maps import start_time_in
from .contents import Contents
from .keep import Keep
from .one_file import Store

Shard = tuple[int, int]  # (k, n): the frames at places k - 1, k - 1 + n and so on


class SavedFrame(NamedTuple):
    """One frame that is there now.

    place: of the frame; start_time: s; path: of its file, or of its group in a file of all
    seconds: that it took, None: it was there
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


def saved_frames(times, store: Store, keep: Keep, frames_at: Callable[[Iterable[int]], Iterator[Frame]], contents: Contents,
                 shard: Shard | None = None) -> Iterator[SavedFrame]:
    """Makes the frames that a store misses, in order, and tells of each.

    times: starts of the frames [K] in s; frames_at: callable (places) that gives their Frames, one after the other; contents: of
    the store; shard: which frames this process makes while others write to the folder, None: all of them, alone
    Raises ValueError naming the path where it holds another sequence or another process writes to it, ep.FileError.
    """
    with store.writing(contents, shard is not None):
        yield from _made(times, store, keep, frames_at, places_of(shard, len(times)))


def places_of(shard: Shard | None, count: int) -> range:
    """The places of the frames of a shard, of `count` frames."""
    k, n = shard or (1, 1)
    return range(k - 1, count, n)


def _made(times, store: Store, keep: Keep, frames_at, places: range) -> Iterator[SavedFrame]:
    there = dict(zip(places, store.are_there(places)))
    todo = _Todo(times, store, there)
    missing = sum(not is_there for is_there in there.values())
    spent, made = 0.0, 0
    with closing(frames_at(todo.missing())) as frames:
        for place in places:
            begin = time.perf_counter()
            missing -= not there[place]
            was_there = todo.is_done(place)
            if not was_there:
                store.write(next(frames), place, keep)
                spent, made = spent + time.perf_counter() - begin, made + 1
            yield SavedFrame(place, float(times[place]), store.frame_path(place),
                             None if was_there else time.perf_counter() - begin, missing * spent / made if made else None)


class _Todo:
    """Which frames are there: each is looked at once, in order, by who asks for one of its kind first."""

    def __init__(self, times, store: Store, there: dict[int, bool]):
        """there: {place: whether it has a frame, whole or not}"""
        self._times, self._store, self._there, self._unseen = times, store, there, deque(there)
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
        self._is_done[place] = self._there[place] and _is_done(self._store.frame_path(place), self._times[place])
        if not self._is_done[place]:
            self._missing.append(place)


def _is_done(path: Path, start_time: float) -> bool:
    """Whether the file of a frame is whole and of its time. Warns (RuntimeWarning) of one that is damaged."""
    try:
        return start_time_in(path) == start_time
    except _core.FileError as error:
        warn_user(f"{error}: it is made again")
        return False
