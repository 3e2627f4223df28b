"""Files whose map is shown before their rays are read."""
from __future__ import annotations

import subprocess
import sys

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox
from echopath_viewer.model.frames import preview
from echopath_viewer.model.frames.preview import READING, preview_of
from echopath_viewer.window.qt import QtWidgets
from support.window import PATIENCE_MS


@pytest.fixture
def large_file(frame, tmp_path, monkeypatch):
    ep.save_frame(frame, tmp_path / "frame.h5")
    monkeypatch.setattr(preview, "LARGE", 1)
    return tmp_path / "frame.h5"


def wait_until_read(qtbot, window) -> None:
    qtbot.waitUntil(lambda: not window.is_to_load and not window.loading.is_running, timeout=4 * PATIENCE_MS)


def test_a_preview_has_scene_and_map_of_the_file(frame, large_file):
    early = preview_of(large_file)
    assert np.array_equal(early.parts.whole.spectrum.values, frame.spectrum.values)
    assert [mesh.name for mesh in early.paths.scene.meshes] == [mesh.name for mesh in frame.scene.meshes]
    assert early.paths.num_paths == 0 and early.paths.frame.start_time == frame.paths.frame.start_time
    assert early.note == READING


def test_the_rays_come_later(qtbot, shared_window, frame, large_file):
    window = shared_window
    assert window.open_file(large_file)
    assert window.session.paths.num_paths == 0 and window.loading_bar.isVisible()
    assert window.is_to_load and not window.loading.is_running  # the picture comes first
    wait_until_read(qtbot, window)
    assert window.session.paths.num_paths == frame.paths.num_paths and not window.loading_bar.isVisible()
    assert window.view3d.builder.session is window.session and len(window.session.parts.partitions) == 2


def test_what_was_chosen_before_the_rays_came_stays(qtbot, shared_window, frame, large_file):
    window, box = shared_window, CellBox(3, 9, 2, 9)
    assert window.open_file(large_file)
    QtWidgets.QApplication.processEvents()
    session = window.session
    assert session.paths.num_paths == 0
    session.set_channel(1, 0)
    session.set_dynamic_range(33.0)
    session.select_cells(box)
    window.look_top()
    camera = window.view3d.camera_state()
    wait_until_read(qtbot, window)
    assert window.session is not session and window.session.paths.num_paths == frame.paths.num_paths
    assert (window.session.channel, window.session.dynamic_range_db, window.session.box) == ((1, 0), 33.0, box)
    assert window.view3d.camera_state() == camera and window.map_area.channel_box.currentData() == (1, 0)
    assert len(window.session.parts.partitions) == 2 and len(window.view3d.builder.rays.segments.rays)


def test_what_is_damaged_behind_the_map_is_told(qtbot, shared_window, large_file):
    with h5py.File(large_file, "a") as file:
        del file["partitions"]
    shared_window.open_file(large_file)
    wait_until_read(qtbot, shared_window)
    assert "frame.h5" in shared_window.banner.text() and not shared_window.loading_bar.isVisible()
    shared_window.show_message("")


def test_rays_come_where_nothing_is_drawn(qtbot, shared_window, frame, large_file, monkeypatch):
    """As in a window that is minimised before its first picture."""
    window, view = shared_window, shared_window.view3d
    monkeypatch.setattr("echopath_viewer.window.scene.view3d.LONGEST_WAIT_MS", 50)
    monkeypatch.setattr(type(view), "_first_look", lambda self: None)
    monkeypatch.setattr(window, "isMinimized", lambda: True)
    assert window.open_file(large_file)
    window.settle()
    assert window.session.paths.num_paths == frame.paths.num_paths and view._is_behind


def test_a_picture_after_the_window_was_closed_is_no_error(shared_window, monkeypatch):
    view, builder = shared_window.view3d, shared_window.view3d.builder
    monkeypatch.setattr(view, "builder", None)
    monkeypatch.setattr(view, "_pace", view._turning)
    view._draw()
    monkeypatch.undo()
    assert view.builder is builder
    view.look("fit")


CLOSED_AT_WORK = """
import time
from echopath_viewer.window.background_work import BackgroundWork
from echopath_viewer.window.qt import QtCore

application, work = QtCore.QCoreApplication([]), BackgroundWork()
work.start(lambda progress: (time.sleep(0.3), print("read", flush=True)))
work.stop()
"""


def test_a_program_that_ends_waits_for_what_is_read():
    """Python stops daemons wherever they are, and hangs or crashes where that is in the middle of a file."""
    ended = subprocess.run([sys.executable, "-c", CLOSED_AT_WORK], capture_output=True, text=True, timeout=60, check=True)
    assert ended.stdout == "read\n" and ended.stderr == ""
