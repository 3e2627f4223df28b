"""A file that is written anew is told of, whatever the window does with it, or with another one, at that time."""
from __future__ import annotations

import threading

import pytest

import echopath as ep
from echopath_viewer.model import from_file
from echopath_viewer.model.frames import kept_orders, preview
from echopath_viewer.window import app
from echopath_viewer.window.files import opening


@pytest.fixture
def large_files(frame, tmp_path, monkeypatch):
    """Two files that are read and kept as large ones are."""
    monkeypatch.setattr(kept_orders, "FEWEST_PATHS", 1)
    monkeypatch.setattr(preview, "LARGE", 1)
    for name in ("one.h5", "other.h5"):
        ep.save_frame(frame, tmp_path / name)
    return tmp_path / "one.h5", tmp_path / "other.h5"


def is_told_of(watch) -> bool:
    """Whether the next looks find the watched file written anew."""
    told = []
    watch.changed.connect(told.append)
    for _ in range(3):
        watch.look()
    watch.changed.disconnect(told.append)
    return bool(told)


def test_a_file_written_after_its_orders_were_kept(window, frame, large_files, monkeypatch):
    def keep_and_write(path, session):
        state = kept_orders.keep_orders(path, session)
        assert state is not None
        ep.save_frame(frame, path)
        return state

    window.open_file(large_files[0])
    with monkeypatch.context() as patch:
        patch.setattr(opening, "keep_orders", keep_and_write)
        window.settle()
    assert is_told_of(window.file_watch)
    window.settle()


def test_a_file_written_while_the_orders_of_another_are_kept(qtbot, window, frame, large_files, monkeypatch):
    one, other = large_files
    goes_on, kept = threading.Event(), []

    def keep_later(path, session):
        if path == one:
            goes_on.wait(20.0)
        kept.append(kept_orders.keep_orders(path, session))
        return kept[-1]

    monkeypatch.setattr(opening, "keep_orders", keep_later)
    window.open_file(one)
    qtbot.waitUntil(lambda: window.keeping.is_running)
    monkeypatch.setattr(preview, "LARGE", 1 << 30)  # the other one is read at once, and nothing is kept in it
    window.open_file(other)
    ep.save_frame(frame, other)
    goes_on.set()
    qtbot.waitUntil(lambda: bool(kept) and not window.keeping.is_running)
    qtbot.wait(50)
    assert is_told_of(window.file_watch)
    window.settle()


@pytest.fixture
def read_and_write(frame, monkeypatch):
    """Reads a frame file at once, which is written anew right after."""
    def read(path):
        view_input = from_file(path)
        ep.save_frame(frame, path)
        return view_input

    monkeypatch.setattr(preview, "LARGE", 1 << 30)
    return read


def test_a_file_of_the_menu_written_while_it_is_read(window, large_files, read_and_write, monkeypatch):
    monkeypatch.setattr(opening, "from_file", read_and_write)
    window.open_file(large_files[0])
    assert is_told_of(window.file_watch)
    window.settle()


def test_a_file_of_the_command_line_written_while_it_is_read(qtbot, large_files, read_and_write, monkeypatch):
    monkeypatch.setattr(app, "from_file", read_and_write)
    opened = app.view(large_files[0], block=False)
    qtbot.addWidget(opened)
    assert is_told_of(opened.file_watch)
