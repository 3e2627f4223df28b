"""Where Python's garbage is let go while a window is open."""
from __future__ import annotations

import gc
import threading

from echopath_viewer.window import MainWindow
from echopath_viewer.window.background_work import BackgroundWork
from support.window import PATIENCE_MS

NUM_OBJECTS = 5000  # more than Python collects at


class Knot:
    """Garbage that nothing but a search finds; notes the thread that lets it go."""

    def __init__(self, let_go_by: list):
        self.itself, self.let_go_by = self, let_go_by

    def __del__(self):
        self.let_go_by.append(threading.current_thread())


def test_garbage_is_let_go_in_the_thread_of_the_window(qtbot, shared_window):
    let_go_by, work = [], BackgroundWork()
    work.start(lambda _: [Knot(let_go_by) for _ in range(NUM_OBJECTS)] and None)
    qtbot.waitUntil(lambda: not work.is_running, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: len(let_go_by) == NUM_OBJECTS, timeout=PATIENCE_MS)
    assert set(let_go_by) == {threading.main_thread()}


def test_python_finds_garbage_by_itself_once_the_last_window_is_closed(qtbot, shared_window):
    usual = shared_window._collector
    before = gc.get_threshold()
    other = MainWindow(remembers=False)
    other.close()
    other.close()  # a window may be closed twice
    assert gc.get_threshold() == before and before[0] > 100_000 and usual.isActive()
    usual.end()
    try:
        assert gc.get_threshold()[0] < 100_000
    finally:
        shared_window._collector = type(usual)(shared_window)
