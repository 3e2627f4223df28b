"""Maps and the time bar by real clicks."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from echopath.signals.measures import for_pictures
from echopath_viewer.model import WHOLE, CellBox, from_paths
from echopath_viewer.window.maps.map_area import HINT
from echopath_viewer.window.maps.map_panel import VELOCITY_LABEL
from echopath_viewer.window.maps.ticks import axis_ticks, place_text
from echopath_viewer.window.qt import Qt, QtCore, QtGui, QtWidgets
from support.window import LEFT, PATIENCE_MS, panel_of, settle, strongest_cell

# --- maps ---

def test_all_maps_share_one_colour_scale(qtbot, window):
    window.map_area.range_slider.setValue(45)
    limits = {panel.limits for panel in window.map_area.panels.values()}
    assert limits == {window.map_area.colour_bar.limits} and len(window.map_area.panels) == 4
    low, high = limits.pop()
    assert high - low == 45
    level = window.session.parts.whole.level(0, 0)
    panel = panel_of(window, WHOLE, WHOLE)
    for velocity, distance in [(0, 0), (20, 30), np.unravel_index(level.argmax(), level.shape)]:
        shade = panel.image.pixelIndex(int(distance), level.shape[0] - 1 - int(velocity))
        assert shade == int(np.clip((level[velocity, distance] - low) / (high - low) * 255, 0, 255))


def test_one_large_map_or_all(qtbot, window):
    qtbot.keyClick(window, Qt.Key.Key_M)
    settle(qtbot)
    assert panel_of(window, WHOLE, WHOLE).y_text(window.fontMetrics()) == VELOCITY_LABEL
    assert list(window.map_area.panels) == [(WHOLE, WHOLE)]
    window.map_area.partition_box.setCurrentText("count")
    window.map_area.partition_box.activated.emit(1)
    qtbot.keyClick(window, Qt.Key.Key_M)
    assert [key[1] for key in window.map_area.panels] == ["whole", "one", "other"]


def test_the_cursor_reads_metres_and_speed_and_power(qtbot, window):
    panel, whole = panel_of(window, WHOLE, WHOLE), window.session.parts.whole
    distance, velocity = strongest_cell(window, (WHOLE, WHOLE))
    at = panel.to_pixel(whole.spectrum.range[distance], whole.spectrum.velocity[velocity])
    no_button = Qt.MouseButton.NoButton  # sent, as the real cursor of the virtual screen is somewhere else
    move = QtGui.QMouseEvent(QtCore.QEvent.Type.MouseMove, at, panel.mapToGlobal(at), no_button, no_button,
                             Qt.KeyboardModifier.NoModifier)
    QtWidgets.QApplication.sendEvent(panel, move)
    text = window.map_area.read_out.text()
    for word in (f"{whole.spectrum.range[distance]:.2f} m", f"{whole.spectrum.velocity[velocity]:+.2f} m/s",
                 f"{whole.level(0, 0)[velocity, distance]:.1f} dBm"):
        assert for_pictures(word) in text


def test_maps_of_many_rules_scroll_and_leave_the_window_its_height(qtbot, window, frame):
    parts = {f"rule {number} of a long list of rules": "T 'walker' R" for number in range(40)}
    before, needed = window.height(), window.minimumSizeHint().height()
    window.show_input(from_paths(frame.paths.scene, frame.paths, parts))
    settle(qtbot)
    assert len(window.map_area.panels) > 40 and window.height() == before
    assert window.minimumSizeHint().height() < needed + 400
    panels = list(window.map_area.panels.values())
    assert min(panel.height() for panel in panels) >= 110 and min(panel.width() for panel in panels) >= 140
    assert panels[-1].y_text(window.fontMetrics()) == "m/s"  # there is no room for more
    last = window.map_area.part_box.count() - 1
    assert panels[-1].visibleRegion().isEmpty() and not panels[0].visibleRegion().isEmpty()
    window.map_area.part_box.setCurrentIndex(last)
    window.map_area.part_box.activated.emit(last)
    settle(qtbot)
    assert not panel_of(window, *window.session.part_key).visibleRegion().isEmpty()


@pytest.mark.parametrize("cell, speed, texts", [(0.15, 0.08, ("9.89 m, -1.05 m/s", "9.9 m, -1.1 m/s")),
                                                (0.0214, 0.24, ("9.888 m, -1.05 m/s", "9.89 m, -1.1 m/s")),
                                                (15.0, 0.004, ("9.89 m, -1.055 m/s", "9.9 m, -1.05 m/s"))])
def test_places_in_maps_of_fine_cells_have_more_digits(cell, speed, texts):
    axes = SimpleNamespace(range=cell * np.arange(4), velocity=speed * np.arange(-2, 2))
    assert tuple(place_text(axes, 9.8881, -1.0549, is_rough=rough) for rough in (False, True)) == texts


def test_a_channel_is_chosen(qtbot, window, frame):
    window.map_area.channel_box.setCurrentIndex(3)
    window.map_area.channel_box.activated.emit(3)
    settle(qtbot)
    assert window.session.channel == (1, 1)
    level = 10 * np.log10(np.abs(frame.spectrum.values[1, 1]) ** 2 * 1e3)
    assert panel_of(window, WHOLE, WHOLE).level == pytest.approx(level, abs=1e-3)


def test_the_mouse_shows_that_a_channel_is_read(qtbot, window, monkeypatch):
    shown, read = [], window.session.set_channel
    monkeypatch.setattr(window.session, "set_channel",
                        lambda *channel: (shown.append(QtWidgets.QApplication.overrideCursor().shape()), read(*channel)))
    window.map_area.channel_box.setCurrentIndex(2)
    window.map_area.channel_box.activated.emit(2)
    assert shown == [Qt.CursorShape.WaitCursor] and QtWidgets.QApplication.overrideCursor() is None


def test_the_wheel_zooms_about_the_cursor_and_a_double_click_resets(qtbot, window):
    panel, before = panel_of(window, WHOLE, WHOLE), QtCore.QRectF(window.map_area.view)
    at = QtCore.QPointF(panel.plot_rect().center())
    value = panel.to_value(at)
    turn = QtGui.QWheelEvent(at, panel.mapToGlobal(at), QtCore.QPoint(), QtCore.QPoint(0, 120), Qt.MouseButton.NoButton,
                             Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False)
    QtWidgets.QApplication.sendEvent(panel, turn)
    assert window.map_area.view.width() < before.width() and panel.to_value(at) == pytest.approx(value)
    qtbot.mouseDClick(panel, LEFT, pos=at.toPoint())
    moving = QtCore.QRectF(window.map_area.view)
    qtbot.mouseDClick(panel, LEFT, pos=at.toPoint())
    assert window.map_area.view == before and moving.width() < before.width()
    time = window.session.paths.frame.trace_time
    walker = window.session.scene.world_vertices(0, time).mean(axis=0)
    assert moving.left() < np.linalg.norm(walker) < moving.right()


def turn_wheel(panel, at, steps: int) -> None:
    turn = QtGui.QWheelEvent(at, panel.mapToGlobal(at), QtCore.QPoint(), QtCore.QPoint(0, 120 * steps), Qt.MouseButton.NoButton,
                             Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False)
    QtWidgets.QApplication.sendEvent(panel, turn)


def test_the_wheel_stops_at_a_cell_and_at_the_whole_map(qtbot, window):
    area, panel, spectrum = window.map_area, panel_of(window, WHOLE, WHOLE), window.session.parts.whole.spectrum
    cell = spectrum.range[1] - spectrum.range[0], spectrum.velocity[1] - spectrum.velocity[0]
    at = QtCore.QPointF(panel.plot_rect().center())
    for steps, cells in ((1, (1, 1)), (-1, (len(spectrum.range), len(spectrum.velocity)))):
        for _ in range(50):
            turn_wheel(panel, at, steps)
        seen = area.view.width() / cell[0], area.view.height() / cell[1]
        assert seen == pytest.approx(cells, rel=1e-6)


def test_beyond_the_map_nothing_is_read_or_selected(qtbot, window):
    area, panel, spectrum = window.map_area, panel_of(window, WHOLE, WHOLE), window.session.parts.whole.spectrum
    area.set_view(QtCore.QRectF(float(spectrum.range[-1]) - 1.0, -1.0, 2.0, 2.0))
    inside, beyond = (panel.to_pixel(float(spectrum.range[-1]) + way, 0.0) for way in (-0.5, 0.5))
    told = []
    panel.hovered.connect(lambda *cell: told.append(cell))
    for at in (beyond, inside):
        move = QtGui.QMouseEvent(QtCore.QEvent.Type.MouseMove, at, panel.mapToGlobal(at), Qt.MouseButton.NoButton,
                                 Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier)
        QtWidgets.QApplication.sendEvent(panel, move)
        assert len(told) == (at is inside)
        qtbot.mouseClick(panel, LEFT, pos=at.toPoint())
        assert (window.session.box is not None) == (at is inside)


def test_an_axis_of_a_single_cell_has_its_value_alone():
    assert axis_ticks(np.zeros(1), -0.5, 0.5, 10.0) == [0.0] and axis_ticks(np.zeros(1), 0.1, 0.5, 10.0) == []
    assert axis_ticks(np.arange(3.0), 0.0, 2.0, 3.0) == [0.0, 1.0, 2.0]


def test_a_press_on_title_or_axes_selects_no_cell(qtbot, window):
    panel = panel_of(window, "route", "ghost")
    inside = panel.plot_rect().center().toPoint()
    for at in (QtCore.QPoint(inside.x(), 5), QtCore.QPoint(10, inside.y()), QtCore.QPoint(inside.x(), panel.height() - 4)):
        qtbot.mouseClick(panel, LEFT, pos=at)
        assert window.session.box is None and window.session.part_key == (WHOLE, WHOLE)


def test_a_double_click_leaves_part_and_selection_as_they_were(qtbot, window):
    window.session.select_cells(CellBox(3, 4, 5, 6))
    panel = panel_of(window, "route", "ghost")
    at = panel.plot_rect().center().toPoint()
    qtbot.mouseClick(panel, LEFT, pos=at)  # what a screen sends: a click, and in place of the next press a double click
    assert window.session.part_key == ("route", "ghost")
    qtbot.mouseDClick(panel, LEFT, pos=at)
    assert window.session.part_key == (WHOLE, WHOLE) and window.session.box == CellBox(3, 4, 5, 6)


def test_a_double_click_keeps_a_beam_and_its_paths(qtbot, window):
    session = window.session
    session.select_beam(45, 0.1, 0.0)
    before = session.beam, session.cell, session.box, session.lit.copy()
    panel = panel_of(window, WHOLE, WHOLE)
    at = panel.plot_rect().center().toPoint()
    qtbot.mouseClick(panel, LEFT, pos=at)
    assert session.beam is None
    qtbot.mouseDClick(panel, LEFT, pos=at)
    assert (session.beam, session.cell, session.box) == before[:3] and np.array_equal(session.lit, before[3])


def test_the_hint_below_the_maps_has_room_in_the_smallest_window(window):
    label, wrap = window.map_area.read_out, Qt.TextFlag.TextWordWrap
    width = window.docks["Range-Doppler"].minimumSizeHint().width() - 8
    needed = label.fontMetrics().boundingRect(QtCore.QRect(0, 0, width, 1000), wrap, HINT).height()
    assert needed <= label.height()


def test_without_partitions_there_is_no_choice_of_one_and_room_for_the_names_of_parts(window, frame):
    area = window.map_area
    assert area.partition_box.isVisible() and area.by_label.isVisible()
    window.show_input(from_paths(frame.scene, frame.paths))
    QtWidgets.QApplication.processEvents()
    assert not area.partition_box.isVisible() and not area.by_label.isVisible()
    assert area.part_box.width() >= min(area.part_box.sizeHint().width(), area.part_box.maximumWidth())


# --- time ---

def test_the_slider_moves_scene_and_rays_to_their_replayed_places(qtbot, window, frame):
    window.time_bar.slider.setValue(2)
    session, builder = window.session, window.view3d.builder
    time = frame.radar.chirp_time(0, 2)
    assert session.time == time and "chirp 3 of 32" in window.time_bar.label.text()
    vertices = frame.scene.world_vertices(0, time)
    assert builder.meshes._polys[0].points == pytest.approx(vertices, abs=1e-5)
    ray = int(builder.rays.segments.rays[0])
    hit = frame.paths.points(time)[frame.paths.offsets[ray]]
    assert builder.rays.segments.points[1] == pytest.approx(hit, abs=1e-5)


def test_play_runs_through_the_frame(qtbot, window):
    window.time_bar.slider.setValue(0)
    qtbot.mouseClick(window.time_bar.play_button, LEFT)
    qtbot.waitUntil(lambda: window.session.chirp >= 3, timeout=PATIENCE_MS)
    qtbot.mouseClick(window.time_bar.play_button, LEFT)
    chirp = window.session.chirp
    qtbot.wait(200)
    assert window.session.chirp == chirp


def test_a_click_in_the_slow_time_signal_goes_to_its_chirp(qtbot, window):
    strip = window.time_bar.strip
    qtbot.mouseClick(strip, LEFT, pos=QtCore.QPoint(round(strip.x_of(25)), 30))
    assert window.session.chirp == 25
