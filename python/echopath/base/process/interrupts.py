"""Ctrl-C that nothing swallows.

Python raises KeyboardInterrupt in whatever runs when the signal comes. In a finaliser or a callback of a weak reference, of
which h5py has many, it is printed and lost; in a model that pydantic builds it becomes an error of the model. Within
`interrupts_are_kept` it is raised again at the next `heed`, and in the place of any error that leaves the block.
"""
from __future__ import annotations

import functools
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

_Arguments, _Result = ParamSpec("_Arguments"), TypeVar("_Result")

_depth = 0      # blocks within each other
_heard = False  # a plain value: an Event's lock may be held by the very line that the signal interrupts


@contextmanager
def interrupts_are_kept():
    """Makes sure that Ctrl-C ends the block: at a `heed` in it, or behind it, and all such blocks around it."""
    global _depth
    before = signal.getsignal(signal.SIGINT)
    if not _is_main_thread() or not callable(before):
        yield
        return

    def remember(number, frame):
        _note(True)
        before(number, frame)

    print_ignored, depth = sys.unraisablehook, _depth

    def restore():
        global _depth
        sys.unraisablehook = print_ignored
        signal.signal(signal.SIGINT, before)
        _depth = depth
        _note(_heard and depth > 0)

    try:
        signal.signal(signal.SIGINT, remember)
        sys.unraisablehook = lambda told: None if isinstance(told.exc_value, KeyboardInterrupt) else print_ignored(told)
        _depth = depth + 1
        yield
        heed()
    except Exception:
        heed()
        raise
    finally:
        try:
            restore()
        except KeyboardInterrupt:  # it came just now
            restore()
            raise


def keeps_interrupts(function: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """The function, each call of it within `interrupts_are_kept`.

    That as a decorator would call it from a file of Python, whose line warnings then name in the place of the user's.
    """
    @functools.wraps(function)
    def call(*args: _Arguments.args, **named: _Arguments.kwargs) -> _Result:
        with interrupts_are_kept():
            return function(*args, **named)

    return call


@contextmanager
def interrupts_wait():
    """Ctrl-C that comes within the block is answered behind it: for what is short and must not be cut."""
    answer = signal.getsignal(signal.SIGINT)
    if not _is_main_thread() or not callable(answer):
        yield
        return
    came = []
    signal.signal(signal.SIGINT, lambda number, frame: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, answer)
        if came:
            signal.raise_signal(signal.SIGINT)


@contextmanager
def ends_as_by_ctrl_c():
    """SIGTERM and SIGHUP, by which batch systems and closed terminals end a program, act as Ctrl-C does within the block: what is
    half written is removed. Yields a list, which then has the number of the signal.

    Those that the program was started to ignore are ignored.
    """
    came: list[int] = []
    if not _is_main_thread():
        yield came
        return

    def end(number, frame):
        came.append(number)
        if not callable(signal.getsignal(signal.SIGINT)):  # ignored: a script of a shell started it in the background
            raise KeyboardInterrupt
        signal.raise_signal(signal.SIGINT)

    answered = [number for number in (signal.SIGTERM, signal.SIGHUP) if signal.getsignal(number) == signal.SIG_DFL]
    for number in answered:
        signal.signal(number, end)
    try:
        yield came
    finally:
        for number in answered:
            signal.signal(number, signal.SIG_DFL)


def heed() -> None:
    """Raises KeyboardInterrupt where Ctrl-C was pressed in the block around and got lost; not where what it ends cleans up."""
    if _heard and _is_main_thread() and not isinstance(sys.exc_info()[1], KeyboardInterrupt):
        raise KeyboardInterrupt


def _note(heard: bool) -> None:
    global _heard
    _heard = heard


def _is_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()
