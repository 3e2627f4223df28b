"""Work on the next of some things while the caller uses the one before."""
from __future__ import annotations

import functools
import threading
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Generic, TypeVar

from ..base.process.callers import at_line_of_user
from ..base.process.threads import num_threads

Result = TypeVar("Result")
Work = Callable[[Any], Result]  # of a progress callable (stage, fraction), or None

POLL = 0.05      # s between looks for Ctrl-C and calls of a progress callable
BEGINNING = 1.0  # s within which a thread begins, if it was made


def one_ahead(works: Iterable[Work[Result]], progress=None) -> Iterator[Result]:
    """What `work(progress)` of each returns, in order; while the caller uses one result, a thread works on the next.

    A work is taken from `works` when the one before has ended, so there is one result at most that nobody has asked for.
    What a work raises is raised in its turn; its warnings name the line of the user, who asked for the result before it. Who
    leaves early stops the thread and waits for its end. With one thread for all loops (ep.set_num_threads) nothing is done
    ahead.
    progress: callable (stage, fraction) or None; it is called in the thread of the caller, while that waits
    """
    if num_threads() == 1:
        yield from (work(progress) for work in works)
        return
    ahead = _Ahead(iter(works))
    try:
        yield from ahead.results(progress)  # a loop here would let Ctrl-C at its backward jump pass by, from Python 3.12 on
    finally:
        ahead.stop()


class _Stopped(BaseException):
    """Raised by the progress callable of a work that nobody waits for any more."""


class _Ahead(Generic[Result]):
    """One of some works at a time, each in a thread of its own that ends with the program."""

    def __init__(self, works: Iterator[Work[Result]]):
        self._works = works
        self._result: list[Result] = []
        self._failure: BaseException | None = None
        self._told: tuple[str, float] | None = None
        self._thread: threading.Thread | None = None
        self._is_stopped, self._has_begun, self._has_ended = False, threading.Event(), threading.Event()

    def results(self, progress) -> Iterator[Result]:
        """The result of each work, in order, while the next one is under way."""
        has_next = self._begin_next()
        while has_next:
            result = self._result_of_work(progress)
            has_next = self._begin_next()
            yield result
            del result  # it is not to live as long as the next one is waited for

    def stop(self) -> None:
        """Has the work end early, if there is one, and waits for it."""
        self._is_stopped = True
        # Ctrl-C may have come before the start, or into it: then the thread is yet to run, or was not made.
        if self._thread in threading.enumerate() and self._has_begun.wait(BEGINNING):
            self._thread.join()

    def _begin_next(self) -> bool:
        """Begins the next work, after the result of the one before; False, and nothing begins, where there is none."""
        for work in self._works:
            if self._thread is not None:
                self._thread.join()  # its work has ended
            self._thread, self._told = None, None
            self._has_begun, self._has_ended = threading.Event(), threading.Event()
            # Kept before it starts: Ctrl-C may come at any step, and `stop` is to find it.
            self._thread = threading.Thread(target=at_line_of_user(functools.partial(self._run, work)), daemon=True,
                                            name="echopath-ahead")
            self._thread.start()
            return True
        return False

    def _result_of_work(self, progress) -> Result:
        """Waits for the end of the work; returns or raises what it did. To be called once for each."""
        while not self._has_ended.wait(POLL):
            self._tell(progress)
        self._tell(progress)
        if self._failure is not None:
            try:
                raise self._failure
            finally:
                self._failure = None  # an exception that holds its own traceback lives on
        return self._result.pop()

    def _run(self, work: Work[Result]) -> None:
        self._has_begun.set()
        try:
            if not self._is_stopped:
                self._result.append(work(self._hear))
        except BaseException as failure:
            self._failure = failure
        finally:
            self._has_ended.set()

    def _hear(self, stage: str, fraction: float) -> None:
        if self._is_stopped:
            raise _Stopped
        self._told = stage, fraction

    def _tell(self, progress) -> None:
        if progress is not None and self._told is not None:
            progress(*self._told)
