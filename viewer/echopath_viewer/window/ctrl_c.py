"""Ctrl-C while a window is open: it ends long work and closes the window, and interrupts no drawing."""
from __future__ import annotations

import signal
import sys
import threading
from contextlib import contextmanager

import echopath as ep

from .qt import QtCore

CHECK_MS = 200

_heard = threading.Event()
_at_work = []  # a mark for each `long_work` underway


def is_heard() -> bool:
    """Whether Ctrl-C was pressed since the window opened: long work should end."""
    return _heard.is_set()


@contextmanager
def long_work():
    """For work that draws progress on the window: the window stays until the block has ended."""
    _at_work.append(True)
    try:
        yield
    finally:
        _at_work.pop()


@contextmanager
def closing_on_ctrl_c(application):
    """In the block, on the main thread, Ctrl-C closes all windows; behind it, it is raised as KeyboardInterrupt."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _heard.clear()
    handler, print_exception = signal.signal(signal.SIGINT, _hear), sys.excepthook
    # Qt prints what its callbacks raise: here the ends of work that Ctrl-C has interrupted.
    sys.excepthook = lambda kind, *told: None if kind is KeyboardInterrupt else print_exception(kind, *told)
    # Python sees signals only while it runs, not while Qt waits for events.
    watch = QtCore.QTimer(interval=CHECK_MS)
    watch.timeout.connect(lambda: _look(application))
    watch.start()
    try:
        yield
    finally:
        watch.stop()
        sys.excepthook = print_exception
        signal.signal(signal.SIGINT, handler)
        was_heard = is_heard()
        _heard.clear()
    if was_heard:
        raise KeyboardInterrupt


def _look(application) -> None:
    """Ends the event loop on Ctrl-C and with the last window: Qt takes the scene inside of a closed one for one that is open."""
    if is_heard() and not _at_work:
        application.closeAllWindows()
    if not any(widget.isVisible() for widget in application.topLevelWidgets()):
        application.quit()


def _hear(number, frame) -> None:
    """Raises where that ends work of the core; in the middle of drawing it must not."""
    _heard.set()
    if ep._core.looks_for_signals():
        raise KeyboardInterrupt
