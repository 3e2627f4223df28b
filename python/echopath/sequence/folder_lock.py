"""Who may write to a folder of frames: one process alone, or several that each make a shard of its frames."""
from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..arguments.checks import refused
from ..base.storage.locks import is_at, takes

PATIENCE, PAUSE = 5.0, 0.02  # s that a shard waits for others to begin, and between its tries


@contextmanager
def writing_to(folder: Path, is_shared: bool, prepare: Callable[[bool], None], of: Path | None = None) -> Iterator[None]:
    """Keeps other processes from writing to a folder during the block: all, or where it is shared those that do not share.

    The folder is made where there is none. The system ends that when this process ends, however it does.
    prepare: called with whether this process is alone in the folder; processes that share one begin one after the other
    of: what the folder is there for, which an error tells of; None: itself
    Raises ValueError naming the path where another process does not let this one in.
    """
    handle, is_alone = _entered(folder, of or folder, is_shared)
    try:
        prepare(is_alone)
        if is_shared and is_alone:
            fcntl.flock(handle, fcntl.LOCK_SH)
        yield
    finally:
        os.close(handle)


def _entered(folder: Path, told: Path, is_shared: bool) -> tuple[int, bool]:
    """The folder, open and locked, and whether nobody else has it. One that another run removes meanwhile is made again."""
    while True:
        folder.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            handle = os.open(folder, os.O_RDONLY)
            try:
                is_alone = _enter(handle, told, is_shared)
                if is_at(handle, folder):
                    return handle, is_alone
            except BaseException:
                os.close(handle)
                raise
            os.close(handle)


def _enter(handle: int, told: Path, is_shared: bool) -> bool:
    """Takes the lock, and returns whether nobody else has it."""
    last_try = time.monotonic() + PATIENCE
    while True:
        if takes(handle, fcntl.LOCK_EX):
            return True
        if is_shared and takes(handle, fcntl.LOCK_SH):
            return False
        if not is_shared or time.monotonic() > last_try:
            raise refused(ValueError, "path", "one that no other run is writing to, or all by shards", str(told))
        time.sleep(PAUSE)  # another shard is beginning
