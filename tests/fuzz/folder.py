"""Where the fuzzers keep the files of their cases."""
from __future__ import annotations

import tempfile
from pathlib import Path

MEMORY = Path("/dev/shm")


def memory_folder() -> tempfile.TemporaryDirectory:
    """A folder in memory, where there is one: on a disk, emptying a file for the next case takes longer than the case."""
    return tempfile.TemporaryDirectory(prefix="fuzz-", dir=MEMORY if MEMORY.is_dir() else None)
