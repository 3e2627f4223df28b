"""Undo, recent files, remembered sizes."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox, from_frame
from echopath_viewer.model.history import MOST_STATES, History
from echopath_viewer.window import MainWindow
from echopath_viewer.window.command_palette import CommandPalette
from echopath_viewer.window.files.remembered import recent_files, settings
from echopath_viewer.window.qt import Qt, QtWidgets
from support.window import PATIENCE_MS, project, settle

CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def test_what_was_shown_comes_back_and_goes_again(qtbot, window):
    session = window.session
    steps = [lambda: session.set_color_by("power"), lambda: session.select_cells(CellBox(3, 5, 4, 6)),
             lambda: window.filter_box.from_box.setValue(2), lambda: session.set_mesh_visible([2], False)]
    for step in steps:
        step()
        settle(qtbot)
    told = [lambda: sorted(session.hidden_meshes) == [2], lambda: session.filters.min_bounces == 2,
            lambda: session.box == CellBox(3, 5, 4, 6), lambda: session.color_by == "power"]
    for is_shown in told:
        assert is_shown()
        qtbot.keyClick(window, Qt.Key.Key_Z, CONTROL)
        settle(qtbot)
        assert not is_shown()
    assert window.filter_box.from_box.value() == 0
    for is_shown in reversed(told):
        qtbot.keyClick(window, Qt.Key.Key_Z, CONTROL | SHIFT)
        settle(qtbot)
        assert is_shown()


def test_a_history_forgets_what_was_undone_and_what_is_long_ago():
    history = History()
    assert history.back() is None and history.forward() is None
    for number in range(MOST_STATES + 5):
        history.record({"number": number})
        history.record({"number": number})
    assert history.back() == {"number": MOST_STATES + 3}
    history.record({"number": -1})
    assert history.forward() is None and history.back() == {"number": MOST_STATES + 3}
    steps = 0
    while history.back() is not None:
        steps += 1
    assert steps == MOST_STATES - 2


def test_opened_frames_are_remembered_latest_first(qtbot, window, frame, tmp_path):
    settings().remove("recent")
    for name in ("a.h5", "b.h5", "a.h5"):
        ep.save_frame(frame, tmp_path / name)
        assert window.open_file(tmp_path / name)
    assert not window.open_file(tmp_path / "none.h5")
    assert recent_files() == [str((tmp_path / name).resolve()) for name in ("a.h5", "b.h5")]
    window._fill_recent()
    assert [action.text() for action in window.recent_menu.actions()] == recent_files()
    (tmp_path / "a.h5").unlink()
    assert recent_files() == [str((tmp_path / "b.h5").resolve())]


def test_an_ampersand_in_the_name_of_a_recent_file_is_no_key(qtbot, window, frame, tmp_path):
    path = tmp_path / "R&D.h5"
    ep.save_frame(frame, path)
    window.open_file(path)
    window._fill_recent()
    action = window.recent_menu.actions()[0]
    assert action.text().endswith("R&&D.h5")  # Qt shows two as one
    action.trigger()
    assert window.windowTitle().startswith(str(path))


def test_sizes_and_places_of_panels_are_remembered(qtbot, frame):
    first = MainWindow()
    first.resize(1250, 640)
    first.show_input(from_frame(frame))
    first.docks["Scene"].close()
    first.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, first.docks["Rays"])
    qtbot.wait(20)
    first.close()
    second = MainWindow()
    assert (second.width(), second.height()) == (1250, 640)
    second.show_input(from_frame(frame))
    assert second.docks["Scene"].isHidden() and not second.docks["Range-Doppler"].isHidden()
    assert second.dockWidgetArea(second.docks["Rays"]) == Qt.DockWidgetArea.LeftDockWidgetArea
    second.close()
    settings().clear()


def test_panels_that_float_close_with_the_window_and_float_the_next_time(qtbot, frame):
    first = MainWindow()
    first.show_input(from_frame(frame))
    first.docks["Rays"].setFloating(True)
    qtbot.wait(20)
    assert first.docks["Rays"].isVisible()
    first.close()
    assert not first.docks["Rays"].isVisible()
    second = MainWindow()
    second.show_input(from_frame(frame))
    assert second.docks["Rays"].isFloating() and second.docks["Rays"].isVisible()
    second.close()
    settings().clear()


def test_every_control_says_what_it_does(window):
    kinds = (QtWidgets.QAbstractButton, QtWidgets.QComboBox, QtWidgets.QAbstractSpinBox, QtWidgets.QAbstractSlider,
             QtWidgets.QLineEdit)
    inner = (QtWidgets.QAbstractSpinBox, QtWidgets.QLineEdit, QtWidgets.QComboBox, QtWidgets.QTabBar, QtWidgets.QDockWidget,
             QtWidgets.QToolBar, QtWidgets.QAbstractItemView, QtWidgets.QScrollArea)
    silent = [widget for kind in kinds for widget in window.findChildren(kind)
              if not widget.toolTip() and not isinstance(widget.parent(), inner) and not isinstance(widget, QtWidgets.QScrollBar)
              and not widget.objectName().startswith("qt_")]
    assert [(type(widget).__name__, getattr(widget, "text", str)()) for widget in silent] == []


def test_the_window_fits_a_small_screen(window):
    smallest = window.minimumSizeHint()
    assert smallest.width() <= 1024 and smallest.height() <= 700


def test_the_tabulator_leaves_a_table(qtbot, window):
    """It had gone through all of its cells, thousands of rays."""
    table = window.table.view
    table.setFocus()
    table.setCurrentIndex(table.model().index(0, 0))
    qtbot.keyClick(table, Qt.Key.Key_Tab)
    assert not table.hasFocus() and not window.contributions.table.tabKeyNavigation()


def test_menus_open_by_their_letters(qtbot, window):
    letters = [menu.text().partition("&")[2][:1] for menu in window.menuBar().actions()]
    assert all(letters) and len(set(letters)) == len(letters)
    qtbot.keyClick(window, Qt.Key.Key_L, Qt.KeyboardModifier.AltModifier)
    menu = QtWidgets.QApplication.activePopupWidget()
    assert [action.text() for action in menu.actions()][-1] == "Names"
    menu.close()


def test_commands_are_found_by_their_letters(qtbot, window):
    qtbot.keyClick(window, Qt.Key.Key_K, CONTROL)
    palette = window.findChild(CommandPalette)
    palette.edit.setText("eye rad")
    assert [palette.list.item(row).text() for row in range(palette.list.count())] == ["The radar's eye   R"]
    palette.edit.setText("ghost twins")
    qtbot.keyClick(palette.edit, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: "ghost twins" in window.session.layers)
    window.layer_actions["ghost twins"].setChecked(False)
    palette.deleteLater()


def test_a_file_that_is_written_anew_is_shown_anew(qtbot, window, frame, tmp_path):
    path = tmp_path / "frame.h5"
    ep.save_frame(frame, path)
    window.open_file(path)
    window.session.set_color_by("power")
    session = window.session
    ep.save_frame(frame, path)
    for _ in range(2):  # once it is at rest
        window.file_watch.look()
    qtbot.waitUntil(lambda: window.session is not session and not window.loading.is_running, timeout=PATIENCE_MS)
    assert window.session.color_by == "power" and window.session.paths.num_paths == frame.paths.num_paths


def test_a_file_that_was_half_written_is_told_of_until_it_is_whole(qtbot, window, frame, tmp_path):
    path = tmp_path / "frame.h5"
    ep.save_frame(frame, path)
    window.open_file(path)
    session, whole = window.session, path.read_bytes()
    path.write_bytes(whole[:len(whole) // 2])
    window.reload()
    qtbot.waitUntil(lambda: not window.loading.is_running, timeout=PATIENCE_MS)
    assert "truncated" in window.banner.text() and window.session is session
    path.write_bytes(whole)
    window.reload()
    qtbot.waitUntil(lambda: window.session is not session and not window.loading.is_running, timeout=PATIENCE_MS)
    assert window.banner.isHidden()


def test_names_and_axes_follow_the_scene(qtbot, window):
    names = window.view3d.name_box
    window.layer_actions["names"].setChecked(True)
    window.settle()
    assert names.isVisible() and {text for _, text in names.boxes} <= {"walker", "wall_left", "wall_right"}
    window.layer_actions["names"].setChecked(False)
    window.settle()
    assert names.isHidden()
    window.look_top()
    window.settle()
    compass = window.view3d.compass
    assert compass.isVisible() and compass.axes[0] == pytest.approx([1.0, 0.0], rel=0, abs=1e-6)  # x to the right
    ends = [np.array([project(window, point).x(), project(window, point).y()]) for point in
            (window.view3d.camera.focal_point, np.array(window.view3d.camera.focal_point) + (compass.metres, 0.0, 0.0))]
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(compass.pixels, rel=0, abs=2.0)


def test_each_row_of_tabs_is_that_of_a_dock(qtbot, frame):
    """Docks that come before the window is shown leave rows of an earlier layout behind, over the maps of a picture."""
    window = MainWindow()
    window.show_input(from_frame(frame))
    window.show()
    window.settle()
    rows = [[row.tabText(tab) for tab in range(row.count())] for row in window.findChildren(QtWidgets.QTabBar)]
    assert sorted(rows) == [["Rays shown", "Live"], ["What makes the cell", "Rays"]]
    window.close()
