"""Where Python's garbage is let go while a window is open."""
from __future__ import annotations

import gc
import threading

import pytest

from echopath_viewer.window import MainWindow, collector
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


@pytest.mark.parametrize("end", ["close", "close twice", "destroy"])
def test_python_finds_garbage_by_itself_once_the_last_window_is_gone(qtbot, shared_window, end):
    before = gc.get_threshold()
    shared_window._collector.end()
    try:
        usual = gc.get_threshold()
        window = MainWindow(remembers=False)
        assert gc.get_threshold() == before and before[0] > 100_000 > usual[0]
        if end == "destroy":
            gone = window._collector.destroyed
            with qtbot.waitSignal(gone, timeout=PATIENCE_MS):
                window.deleteLater()
        else:
            for _ in end.split():
                window.close()
        assert gc.get_threshold() == usual
    finally:
        shared_window._collector = type(shared_window._collector)(shared_window)


def test_nobody_looks_for_garbage_where_the_user_wants_none(qtbot, shared_window, monkeypatch):
    searches = []
    monkeypatch.setattr(collector.gc, "collect", lambda *generation: searches.append(generation))
    gc.disable()
    try:
        kept = [Knot([]) for _ in range(NUM_OBJECTS)]
        collector._collect()
        assert searches == []
    finally:
        gc.enable()
    collector._collect()
    assert searches and kept
