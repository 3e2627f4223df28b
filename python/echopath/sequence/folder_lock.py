"""Who may write to a folder of frames: one process alone, or several that each make a shard of its frames."""
from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..arguments.checks import refused

PATIENCE, PAUSE = 5.0, 0.02  # s that a shard waits for others to begin, and between its tries


@contextmanager
def writing_to(folder: Path, is_shared: bool, prepare: Callable[[bool], None], of: Path | None = None) -> Iterator[None]:
    """Keeps other processes from writing to a folder during the block: all, or where it is shared those that do not share.

    The system ends that when this process ends, however it does.
    prepare: called with whether this process is alone in the folder; processes that share one begin one after the other
    of: what the folder is there for, which an error tells of; None: itself
    Raises ValueError naming the path where another process does not let this one in.
    """
    handle = os.open(folder, os.O_RDONLY)
    try:
        is_alone = _enter(handle, of or folder, is_shared)
        prepare(is_alone)
        if is_shared and is_alone:
            fcntl.flock(handle, fcntl.LOCK_SH)
        yield
    finally:
        os.close(handle)


def _enter(handle: int, told: Path, is_shared: bool) -> bool:
    """Takes the lock, and returns whether nobody else has it."""
    last_try = time.monotonic() + PATIENCE
    while True:
        if _takes(handle, fcntl.LOCK_EX):
            return True
        if is_shared and _takes(handle, fcntl.LOCK_SH):
            return False
        if not is_shared or time.monotonic() > last_try:
            raise refused(ValueError, "path", "one that no other run is writing to, or all by shards", str(told))
        time.sleep(PAUSE)  # another shard is beginning


def _takes(handle: int, kind: int) -> bool:
    try:
        fcntl.flock(handle, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
