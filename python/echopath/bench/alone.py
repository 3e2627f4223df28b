"""Work in a process of its own, so that what is measured there, its memory above all, is that of the work alone."""
from __future__ import annotations

import multiprocessing
import warnings
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor

from ..base.process.callers import warn_user


def alone(work: Callable, *arguments, start: str = "spawn"):
    """What `work(*arguments)` returns in a new process; what it warns of there is warned of here, once for each text.

    work: a function of a module; start: how multiprocessing starts the process. Raises BrokenProcessPool where that process
    ends before it returns, as for want of memory.
    """
    with ProcessPoolExecutor(max_workers=1, mp_context=multiprocessing.get_context(start)) as pool:
        found, warned = pool.submit(_with_warnings, work, arguments).result()
    for text, category in warned:
        warn_user(text, category)
    return found


def _with_warnings(work: Callable, arguments: tuple) -> tuple[object, list[tuple[str, type[Warning]]]]:
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("default")  # once for each place and text, so that many frames keep no long list of them
        found = work(*arguments)
    return found, list(dict.fromkeys((str(one.message), one.category) for one in warned))
