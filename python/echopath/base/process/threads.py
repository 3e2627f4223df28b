"""How many threads the work takes."""
from __future__ import annotations

from ... import _core
from ...arguments.checks import LARGEST_COUNT, checked, count


@checked(num_threads=count(0, LARGEST_COUNT))
def set_num_threads(num_threads: int) -> None:
    """Number of threads of all parallel loops from now on.

    num_threads: 0 (one per core) or more. Results do not depend on it, not by a bit.
    Raises TypeError or ValueError naming the argument.
    """
    _core.set_num_threads(num_threads)


@checked()
def num_threads() -> int:
    """Number of threads of the parallel loops."""
    return _core.num_threads()
