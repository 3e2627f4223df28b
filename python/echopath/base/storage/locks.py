"""Locks of open files and folders, which end with the process that has them."""
from __future__ import annotations

import fcntl
import os
from pathlib import Path


def takes(handle: int, kind: int) -> bool:
    """Takes a lock, fcntl.LOCK_EX or fcntl.LOCK_SH, unless another has one that excludes it; returns whether it did."""
    try:
        fcntl.flock(handle, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def is_at(handle: int, path: Path) -> bool:
    """Whether what is open is still what has a path: it may have been removed before it was locked."""
    try:
        return os.path.samestat(os.fstat(handle), os.stat(path))
    except FileNotFoundError:
        return False
