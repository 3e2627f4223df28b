"""Filters, part names and what is told of the rays shown, by real keys and clicks."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import WHOLE, CellBox, Filters, from_frame, from_paths
from echopath_viewer.model.maps import signals
from echopath_viewer.window.main_window import SIGNAL_PAUSE_MS
from echopath_viewer.window.qt import Qt
from echopath_viewer.window.scene.filter_box import UNKNOWN_PATHS, around_caret
from support.window import LEFT, PATIENCE_MS, click_cell, held, settle


def test_a_typed_expression_filters_and_picks_agree_with_it(qtbot, window, frame):
    qtbot.keyClicks(window.filter_box.expression_edit, "T 'wall_*' 'walker/head' R")
    qtbot.waitUntil(lambda: window.session.filters.expression != "", timeout=PATIENCE_MS)
    settle(qtbot)
    wanted = frame.paths.select("T 'wall_*' 'walker/head' R")
    assert window.session.visible.sum() == wanted.num_paths > 0
    assert set(window.view3d.builder.rays.segments.rays) <= set(np.flatnonzero(window.session.visible))
    near, slow = window.session.cell_of(int(window.session.shown_rays(1)[0]))
    click_cell(qtbot, window, (WHOLE, WHOLE), near, slow)
    names = [window.table.model.text(row, 4) for row in range(window.table.model.rowCount())]
    assert names and all(name in ("wall_left > walker/head", "wall_right > walker/head") for name in names)


def test_a_wrong_expression_is_marked_where_it_was_typed(qtbot, window):
    before = window.session.visible.copy()
    qtbot.keyClicks(window.filter_box.expression_edit, "T 'nobody' R")
    qtbot.keyClick(window.filter_box.expression_edit, Qt.Key.Key_Return)
    label = window.filter_box.expression_error
    assert label.isVisible() and "nobody" in label.text() and "^" in label.text()
    assert np.array_equal(window.session.visible, before)
    window.filter_box.expression_edit.clear()
    qtbot.waitUntil(lambda: not label.isVisible(), timeout=PATIENCE_MS)


def test_the_caret_of_a_long_expression_is_in_sight():
    line, caret = "  " + "T ." * 30, " " * 61 + "^"
    shown, below = around_caret(line, caret)
    assert len(shown) <= 40 and shown[below.index("^")] == line[61] and shown in line
    assert around_caret("  T x R", "    ^") == ("  T x R", "    ^")


def test_bounces_and_power_filter(qtbot, window):
    window.filter_box.from_box.setValue(2)
    window.filter_box.power_box.setValue(-140)
    window.filter_box.power_check.click()
    columns = window.session.columns
    assert np.array_equal(window.session.visible, (columns.num_bounces >= 2) & (columns.power_dbm() >= -140))
    qtbot.mouseClick(window.filter_box.reset_button, LEFT)
    assert window.session.visible.all() and window.filter_box.from_box.value() == 0


def test_a_level_that_a_view_has_stays_as_it_is(window):
    """Rounded in the box, it would be another one with the next change of any filter."""
    window.session.set_filters(Filters(min_power_dbm=-137.625))
    window.filter_box.read(window.session)
    assert window.filter_box.power_box.text() == "-137.625 dBm" and window.filter_box.filters() == window.session.filters
    window.filter_box.from_box.setValue(2)
    assert window.session.filters == Filters(min_bounces=2, min_power_dbm=-137.625)
    assert "-137.625 dBm" in window.session.filters.describe()
    window.filter_box.power_box.setValue(-140.0)
    assert window.filter_box.power_box.text() == "-140 dBm"


def test_a_named_part_joins_the_maps_at_once(qtbot, window):
    window.filter_box.from_box.setValue(2)
    qtbot.keyClicks(window.filter_box.name_edit, "multipath")
    qtbot.mouseClick(window.filter_box.add_button, LEFT)
    settle(qtbot)
    assert ("own", "multipath") in window.map_area.panels
    qtbot.keyClicks(window.filter_box.name_edit, "multipath")
    qtbot.mouseClick(window.filter_box.add_button, LEFT)
    assert window.filter_box.name_error.isVisible() and "taken" in window.filter_box.name_error.text()
    window.session.set_part(("own", "multipath"))
    qtbot.keyClick(window, Qt.Key.Key_Delete)
    assert ("own", "multipath") not in window.map_area.panels and window.session.part_key == (WHOLE, WHOLE)


def test_signals_wait_until_the_filters_have_come_to_rest(qtbot, window, monkeypatch):
    made, synthesize = [], signals.synthesize_slots
    monkeypatch.setattr(signals, "synthesize_slots",
                        lambda *what, **keywords: made.append(what) or synthesize(*what, **keywords))
    window.session.select_cells(CellBox(0, 127, 0, 31))
    qtbot.waitUntil(lambda: len(made) == 1, timeout=PATIENCE_MS)
    for count in range(10, 15):
        window.filter_box.limit_box.setValue(count)
        settle(qtbot)
    qtbot.wait(2 * SIGNAL_PAUSE_MS)
    assert len(made) == 1  # the signal is of all rays in the cells, however many are drawn
    with held(window._pause):
        for bounces in (2, 1, 2, 3):
            window.filter_box.from_box.setValue(bounces)
            settle(qtbot)
        assert len(made) == 1 and window._pause.isActive()
    qtbot.waitUntil(lambda: len(made) == 2, timeout=PATIENCE_MS)
    slow = [10 * np.log10(np.mean(np.abs(chirp) ** 2) * 1e3) for chirp in synthesize(*made[-1])[0, 0]]
    assert window.time_bar.strip._power == pytest.approx(slow, abs=1e-6)
    assert made[-1][0].num_paths == window.session.lit.sum() and window.session.lit.any()


def test_of_a_signal_without_selections_it_is_said_that_its_rays_are_not_known(qtbot, window, frame):
    window.show_input(from_paths(None, frame.paths, dict(frame.parts["route"])))
    window.session.set_part(("parts", "ghost"))
    settle(qtbot)
    assert window.filter_box.count_label.text() == UNKNOWN_PATHS
    assert window.view3d.builder.rays.segments.num_segments == 0
    window.session.set_part((WHOLE, WHOLE))
    settle(qtbot)
    assert f"{frame.paths.num_paths:,} paths" in window.filter_box.count_label.text()


@pytest.mark.filterwarnings("ignore:.*chirps of transmitter")
def test_of_a_radar_that_hops_it_is_said_that_cells_tell_no_rays(qtbot, window, frame):
    hopping = frame.radar.replace(waveform=frame.radar.waveform.replace(frequency_steps=(0.0, 40e6, -25e6)))
    for radar, is_said in ((hopping, True), (frame.radar, False)):
        window.show_input(from_frame(ep.simulate(frame.scene, radar, num_rays=1000)))
        cell = window.session.cell_of(int(window.session.shown_rays(1)[0]))
        for velocity in (cell[1], (cell[1] + 16) % 32):
            window.session.select_cells(CellBox.around(cell[0], velocity))
            settle(qtbot)
            assert ("echoes are in cells of all velocities" in window.filter_box.count_label.text()) == is_said
