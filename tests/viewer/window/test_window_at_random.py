"""Clicks, drags, keys and drops by chance: nothing raises, and what is shown stays what is asked for."""
from __future__ import annotations

import os

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.window.keys import KEYS
from echopath_viewer.window.qt import Qt, QtCore, QtGui, QtWidgets
from support.window import LEFT, settle

NUM_ACTIONS = int(os.environ.get("ECHOPATH_VIEWER_ACTIONS", "30"))
LEAVE_OUT = ("dialog", "help", "quit")  # methods that ask or close


@pytest.fixture
def actions(qtbot, window, frame, tmp_path):
    """{name: callable (rng)}"""
    ep.save_frame(frame, tmp_path / "good.h5")
    (tmp_path / "bad.h5").write_text("no frame")
    keys = [key for key, method, _ in KEYS if not any(word in method for word in LEAVE_OUT)]

    def spot(widget, rng):
        return QtCore.QPoint(int(rng.integers(1, max(widget.width(), 2))), int(rng.integers(1, max(widget.height(), 2))))

    def click_map(rng):
        panels = list(window.map_area.panels.values())
        panel = panels[rng.integers(len(panels))]
        qtbot.mouseClick(panel, LEFT, pos=spot(panel, rng))

    def drag_map(rng):
        panel = next(iter(window.map_area.panels.values()))
        qtbot.mousePress(panel, LEFT, pos=spot(panel, rng))
        qtbot.mouseMove(panel, spot(panel, rng))
        qtbot.mouseRelease(panel, LEFT, pos=spot(panel, rng))

    def press_key(rng):
        qtbot.keySequence(window, QtGui.QKeySequence(keys[rng.integers(len(keys))]))

    def drop(rng):
        data = QtCore.QMimeData()
        name = ("good.h5", "bad.h5", "none.h5")[rng.integers(3)]
        data.setUrls([QtCore.QUrl.fromLocalFile(str(tmp_path / name))])
        at = spot(window, rng)
        for kind, place in ((QtGui.QDragEnterEvent, at), (QtGui.QDropEvent, QtCore.QPointF(at))):  # Qt drops where a drag entered
            event = kind(place, Qt.DropAction.CopyAction, data, LEFT, Qt.KeyboardModifier.NoModifier)
            QtWidgets.QApplication.sendEvent(window, event)

    def choose_row(rng):
        table = window.contributions.table
        if table.rowCount():
            table.selectRow(int(rng.integers(table.rowCount())))

    return {
        "map": click_map, "drag": drag_map, "key": press_key, "drop": drop, "family": choose_row,
        "scene": lambda rng: qtbot.mouseClick(window.view3d, LEFT, pos=spot(window.view3d, rng)),
        "layer": lambda rng: list(window.layer_actions.values())[rng.integers(4)].toggle(),
        "tab": lambda rng: list(window.docks.values())[3 + int(rng.integers(2))].raise_(),
        "expression": lambda rng: window.filter_box.expression_edit.setText(("", "T . R", "T (", "T 'w*' .* R")[rng.integers(4)]),
        "bounces": lambda rng: window.filter_box.from_box.setValue(int(rng.integers(4))),
        "channel": lambda rng: window.map_area.channel_box.activated.emit(int(rng.integers(4))),
        "draw": lambda rng: window.filter_box.limit_box.setValue(int(rng.integers(1, 3000))),
        "chirp": lambda rng: window.time_bar.slider.setValue(int(rng.integers(32))),
        "mesh": lambda rng: window.session.set_mesh_visible([int(rng.integers(4))], bool(rng.integers(2))),
    }


@pytest.mark.filterwarnings("ignore:.*QDragEnterEvent:DeprecationWarning")
def test_nothing_raises_and_what_is_shown_is_what_is_selected(qtbot, window, actions):
    rng, names = np.random.default_rng(11), sorted(actions)  # pytest-qt fails the test for what callbacks raise
    for _ in range(NUM_ACTIONS):
        name = names[rng.integers(len(names))]
        actions[name](rng)
        settle(qtbot)
        session = window.session
        drawn = window.view3d.builder.rays.segments.rays
        assert session.drawable[drawn].all() and len(drawn) <= session.max_rays, name
        text = session.filters.expression.strip()
        if text:
            assert np.asarray(ep.Selection(text).matches(session.paths))[drawn].all(), name
    window.time_bar.play_button.setChecked(False)
    for action in window.layer_actions.values():
        action.setChecked(False)
