"""Memory that nothing uses, back to the system where it would fill up."""
from __future__ import annotations

import ctypes
import functools
import os

SETTLED = 3     # frames after which the memory is to stay as it is
GROWTH = 1.06   # of the memory that the process has then, up to which the C library may keep what a frame leaves for the next


@functools.cache
def _trim():
    """malloc_trim of the C library, None where it has none."""
    try:
        return ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return None


def give_back_memory() -> None:
    """Gives back what the C library keeps for later: pieces that the threads of many frames left would fill it up."""
    if trim := _trim():
        trim(0)


def resident_memory() -> int | None:
    """Bytes of this process that are in memory now, None where the system does not tell."""
    try:
        with open("/proc/self/statm", encoding="ascii") as told:
            return int(told.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError):
        return None


class MemoryOfFrames:
    """Keeps the memory of a process from growing in a loop over frames; each loop has a MemoryOfFrames of its own.

    Pages that the system has taken back must be cleared before they are used again, which costs a frame some 3 to 7 % of its
    time. So what the work on the first frames leaves stays with the process for the next ones, and unused memory goes back
    only where the process has grown beyond what it had after those.
    """

    def __init__(self):
        self._num_frames, self._settled = 0, 0

    def end_frame(self) -> None:
        """To be called after the work on each frame. Where the system does not tell the memory it gives back each time."""
        resident = resident_memory()
        if resident is None:
            give_back_memory()
        elif self._num_frames < SETTLED:
            self._num_frames += 1
            self._settled = max(self._settled, resident)
        elif resident > GROWTH * self._settled:
            give_back_memory()
