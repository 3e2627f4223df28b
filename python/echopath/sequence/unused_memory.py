"""Memory that nothing uses, back to the system."""
from __future__ import annotations

import ctypes
import functools


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
