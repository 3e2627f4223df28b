"""Cells, rays and meshes selected by real clicks, under a virtual screen."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import MESH_GROUP, WHOLE, CellBox, Filters, from_frame, from_paths
from echopath_viewer.scene_builder.web_page import ScenePage
from echopath_viewer.window.qt import Qt, QtCore, QtGui, QtWidgets
from support import shapes
from support.window import LEFT, PATIENCE_MS, click_cell, panel_of, project, settle, strongest_cell

EDGE = 0.01          # of a cell: paths that close to its edge may fall to either side


def cells_from_phases(frame):
    """Range and velocity of each path in cells, from the exact IF phase at neighbouring samples and chirps."""
    waveform = frame.radar.waveform
    chirp, half = 0.5 * (waveform.num_chirps - 1), 0.5

    def cycles(n: float, j: float):
        within = n / waveform.sampling_rate
        slot = j * len(frame.radar.transmitters) * waveform.chirp_interval
        delay = frame.paths.lengths([slot + within], 0, 0)[0] / ep.speed_of_light
        return waveform.start_frequency * delay + waveform.slope * within * delay - 0.5 * waveform.slope * delay ** 2

    middle = 0.5 * (waveform.num_samples - 1)
    per_sample = cycles(middle + half, chirp) - cycles(middle - half, chirp)
    per_chirp = cycles(middle, chirp + half) - cycles(middle, chirp - half)
    return per_sample * waveform.num_samples, per_chirp * waveform.num_chirps + waveform.num_chirps // 2


def offset_in_turns(value, index: int, count: int):
    """Cells from `index`, the shorter way round."""
    return (value - index + 0.5 * count) % count - 0.5 * count


# --- cell -> rays ---

def test_a_clicked_cell_lights_exactly_the_rays_that_the_phases_say(qtbot, window, frame):
    key = ("route", "ghost")
    distance, velocity = strongest_cell(window, key)
    window.map_area.reach_box.setValue(1)
    click_cell(qtbot, window, key, distance, velocity)
    session, waveform = window.session, frame.radar.waveform
    assert session.part_key == key and session.box == CellBox.around(distance, velocity, 1)
    ranges, velocities = cells_from_phases(frame)
    off = np.maximum(np.abs(offset_in_turns(ranges, distance, waveform.num_samples)),
                     np.abs(offset_in_turns(velocities, velocity, waveform.num_chirps)))
    is_ghost = frame.part_of_path["route"] == list(frame.parts["route"]).index("ghost")
    surely, perhaps = is_ghost & (off < 1.5 - EDGE), is_ghost & (off < 1.5 + EDGE)
    assert surely.sum() > 20
    assert np.all(session.lit[surely]) and not np.any(session.lit & ~perhaps)
    assert set(window.table.model.rays) == set(np.flatnonzero(session.lit))
    assert set(window.view3d.builder.lit.segments.rays) == set(np.flatnonzero(session.lit))
    assert f"{session.lit.sum():,}" in window.filter_box.count_label.text()


def test_a_dragged_rectangle_lights_its_rays(qtbot, window):
    panel, spectrum = panel_of(window, WHOLE, WHOLE), window.session.parts.whole.spectrum
    distance, velocity = strongest_cell(window, (WHOLE, WHOLE))
    begin = panel.to_pixel(spectrum.range[distance] - 0.6, spectrum.velocity[velocity] - 0.8).toPoint()
    end = panel.to_pixel(spectrum.range[distance] + 0.6, spectrum.velocity[velocity] + 0.8).toPoint()
    qtbot.mousePress(panel, LEFT, pos=begin)
    qtbot.mouseMove(panel, QtCore.QPoint((begin.x() + end.x()) // 2, (begin.y() + end.y()) // 2))
    qtbot.mouseMove(panel, end)
    qtbot.mouseRelease(panel, LEFT, pos=end)
    session = window.session
    assert session.box.first_range < distance < session.box.last_range
    cells = ep.path_cells(session.paths, session.parts.whole.spectrum)
    assert np.array_equal(session.lit, cells.within((session.box.first_range, session.box.last_range),
                                                    (session.box.first_velocity, session.box.last_velocity)))
    qtbot.keyClick(window, Qt.Key.Key_Escape)
    assert session.box is None


# --- ray -> hits and cell ---

def spot_beside_others(window, segments, ray: int, leg: int):
    """(pixels, place): where the picture of a leg of a ray is farthest from those of other rays, and how far."""
    def points_of(row, count):
        begin, end = segments.points[segments.ends[row]].astype(float)
        return [project(window, begin + share * (end - begin)) for share in np.linspace(0.2, 0.8, count)]

    others = [point for row in np.flatnonzero(segments.ray != ray) for point in points_of(row, 60)]
    own = points_of(np.flatnonzero((segments.ray == ray) & (segments.bounce == leg))[0], 13)
    return max(((min((at - other).manhattanLength() for other in others), at) for at in own), key=lambda found: found[0])


@pytest.mark.parametrize("leg", [0, 1])
def test_a_click_on_a_projected_ray_selects_it(qtbot, window, leg):
    window.session.set_part(("route", "ghost"))
    window.session.set_filters(Filters(expression="T 'wall_*' 'walker' R"))  # without the same rays the other way round
    window.session.set_max_rays(3)
    settle(qtbot)
    segments = window.view3d.builder.rays.segments
    clear = [spot_beside_others(window, segments, ray, leg) for ray in range(len(segments.rays))]
    ray = int(np.argmax([distance for distance, _ in clear]))
    distance, spot = clear[ray]
    assert distance > 2  # pixels, or the click could not tell them apart
    qtbot.mouseClick(window.view3d, LEFT, pos=spot)
    settle(qtbot)
    path = int(segments.rays[ray])
    assert window.session.ray == path
    assert window.view3d.builder.chosen.segments.rays.tolist() == [path]
    for mesh in window.session.columns.meshes_of(path):
        assert window.session.mesh_names[mesh] in window.table.details.text()
    assert panel_of(window, "route", "ghost").ray_cell == window.session.cell_of(path)
    assert window.table.model.rays[window.table.view.currentIndex().row()] == path


def test_a_row_of_the_table_selects_its_ray(qtbot, window):
    window.table.view.selectRow(4)
    assert window.session.ray == window.table.model.rays[4]


def test_a_click_beside_everything_selects_nothing(qtbot, window):
    window.session.select_ray(3)
    qtbot.mouseClick(window.view3d, LEFT, pos=QtCore.QPoint(3, 3))
    assert window.session.ray is None


# --- mesh -> its spectrum ---

def test_a_click_on_a_body_shows_its_own_spectrum(qtbot, window, frame):
    window.session.set_max_rays(1)
    head = frame.scene.meshes[0]
    centre = frame.scene.world_vertices(0, window.session.time).mean(axis=0)
    window.look_radar()  # no wall in between
    settle(qtbot)
    qtbot.mouseClick(window.view3d, LEFT, Qt.KeyboardModifier.ControlModifier, pos=project(window, centre + [0, 0.2, 0.2]))
    settle(qtbot)
    assert window.session.node == head.name == "walker/head"
    assert ("mesh", "walker/head") in window.map_area.panels
    qtbot.keyClick(window, Qt.Key.Key_Escape)
    assert window.session.node is None and ("mesh", "walker/head") not in window.map_area.panels


def test_the_check_boxes_of_the_tree_hide_meshes(qtbot, window):
    walker = window.tree.topLevelItem(0)
    walker.setCheckState(0, Qt.CheckState.Unchecked)
    settle(qtbot)
    actors = window.view3d.builder.meshes.actors
    assert [bool(actor.GetVisibility()) for actor in actors] == [False, False, True, True]
    assert walker.child(0).checkState(0) == Qt.CheckState.Unchecked
    counts = [walker.child(row).text(1) for row in range(2)]
    assert counts == [f"{count:,}" for count in window.session.node_counts()[1:3]]
    either = np.asarray(ep.hits("walker/*").matches(window.session.paths)) & window.session.visible
    assert walker.text(1) == f"{np.count_nonzero(either):,}"


def test_the_check_box_of_a_mesh_with_meshes_below_it_tells_of_both(qtbot, window):
    """A house whose windows were cut from its front is the mesh "house" and the mesh "house/small_planes"."""
    scene = ep.Scene()
    scene.add(shapes.plate((9.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 4.0), name="house", material=shapes.lambert(0.8))
    scene.add(shapes.plate((8.9, 0.0, 0.0), (-1.0, 0.0, 0.0), 1.0), name="windows", parent="house", material=shapes.lambert(0.8))
    paths = ep.trace(scene, window.session.radar, num_rays=300, max_bounces=1, seed=1)
    window.show_input(from_paths(scene, paths))
    settle(qtbot)
    house, states = window.tree.topLevelItem(0), Qt.CheckState
    for item, state, hidden, shown in ((house.child(0), states.Unchecked, {1}, (states.PartiallyChecked, states.Unchecked)),
                                       (house, states.Unchecked, {0, 1}, (states.Unchecked, states.Unchecked)),
                                       (house.child(0), states.Checked, {0}, (states.PartiallyChecked, states.Checked))):
        item.setCheckState(0, state)
        settle(qtbot)
        assert window.session.hidden_meshes == hidden
        assert (house.checkState(0), house.child(0).checkState(0)) == shown


def test_the_tree_shows_the_row_of_a_mesh_that_is_chosen_in_the_scene(qtbot, window):
    tree = window.tree
    tree.collapseAll()
    window.view3d.mesh_clicked.emit(window.session.mesh_names.index("walker/legs"))
    settle(qtbot)
    legs = tree.topLevelItem(0).child(1)
    assert tree.selectedItems() == [legs] and tree.viewport().rect().contains(tree.visualItemRect(legs))
    tree.collapseAll()
    window.session.set_mesh_visible([0], False)
    settle(qtbot)
    assert not tree.topLevelItem(0).isExpanded()  # it is told once
    qtbot.keyClick(window, Qt.Key.Key_Escape)
    settle(qtbot)
    assert tree.selectedItems() == []
    tree.expandAll()


def test_menus_of_the_tree_go_without_a_trace_and_without_a_word_of_qt(qtbot, window, qtlog):
    place = window.tree.visualItemRect(window.tree.topLevelItem(0)).center()
    for _ in range(3):
        window.tree.customContextMenuRequested.emit(place)
        menu = QtWidgets.QApplication.activePopupWidget()
        assert menu.actions()[2].text() == "Show it alone"
        qtbot.keyClick(menu, Qt.Key.Key_Escape)
        settle(qtbot)
    assert window.tree.findChildren(QtWidgets.QMenu) == [] and [record.message for record in qtlog.records] == []


def test_the_map_of_a_mesh_is_made_anew_when_the_filters_have_come_to_rest(qtbot, window):
    window.session.select_node("walker/head")
    key = (MESH_GROUP, "walker/head")
    before = window.session.parts[key]
    window.filter_box.from_box.setValue(2)
    qtbot.waitUntil(lambda: window.session.parts[key] is not before, timeout=PATIENCE_MS)
    session = window.session
    shown = session.visible & np.asarray(ep.hits("walker/head").matches(session.paths))
    wanted = ep.range_doppler(ep.synthesize(session.paths.select(shown)), session.radar).values
    assert np.abs(session.parts[key].spectrum.values - wanted).max() <= 1e-9 * np.abs(wanted).max()  # rounding


# --- table ---

def test_the_table_is_sorted_and_copied(qtbot, window):
    window.table.view.sortByColumn(1, Qt.SortOrder.AscendingOrder)
    ranges = window.session.columns.range[window.table.model.rays]
    assert np.all(np.diff(ranges) >= 0.0)
    window.table.view.selectRow(1)
    window.table.view.setFocus()
    qtbot.keyClick(window.table.view, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    heading, row = QtWidgets.QApplication.clipboard().text().split("\n")
    assert heading.split("\t")[0] == "Bounces" and row.split("\t")[1] == f"{ranges[1]:.3f}"


def test_the_row_that_is_selected_keeps_its_ray_in_another_order(qtbot, window):
    view, model = window.table.view, window.table.model
    view.selectRow(4)
    ray = window.session.ray
    for column in (1, 4, 2):
        view.sortByColumn(column, Qt.SortOrder.AscendingOrder)
        assert [model.rays[index.row()] for index in view.selectionModel().selectedRows()] == [ray]
        assert model.rays[view.currentIndex().row()] == window.session.ray == ray


def test_a_ray_that_was_chosen_behind_another_panel_is_in_sight_when_its_table_is(qtbot, window):
    window.docks["What makes the cell"].raise_()
    settle(qtbot)
    rays = window.table.model.rays
    window.session.select_ray(int(rays[-1]))
    settle(qtbot)
    window.docks["Rays"].raise_()
    settle(qtbot)
    view = window.table.view
    assert view.viewport().rect().contains(view.visualRect(window.table.model.index(len(rays) - 1, 0)).center())


def test_headings_of_the_table_have_room(window):
    header, style = window.table.view.horizontalHeader(), window.style()
    beside = style.pixelMetric(style.PixelMetric.PM_HeaderMarkSize) + 2 * style.pixelMetric(style.PixelMetric.PM_HeaderMargin)
    font = header.font()
    font.setBold(header.highlightSections())  # of the column with a selected row
    for column in range(window.table.model.columnCount() - 1):
        text = window.table.model.headerData(column, Qt.Orientation.Horizontal)
        assert header.sectionSize(column) >= QtGui.QFontMetrics(font).horizontalAdvance(text) + beside


def test_names_with_signs_of_markup_are_told_as_they_are(qtbot, window, frame):
    scene = ep.Scene()
    scene.add(shapes.plate((6.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 2.0), name="wall<left> & b", material=shapes.lambert(0.8))
    shown = ep.simulate(scene, frame.radar, num_rays=500, parts={"<i>": "T 'wall*' R"})
    window.show_input(from_frame(shown))
    window.session.select_ray(int(window.table.model.rays[0]))
    window.layer_actions["labels"].setChecked(True)
    settle(qtbot)
    told = QtGui.QTextDocument()
    told.setHtml(window.table.details.text())
    assert "wall<left> & b (diffuse)" in told.toPlainText()
    told.setHtml(window.map_area.layer_legend.text())
    assert "<i>" in told.toPlainText()
    assert "wall&lt;left&gt; &amp; b" in ScenePage(window.session)._text_of(window.session.ray)
    window.layer_actions["labels"].setChecked(False)


def test_where_no_ray_is_drawn_it_is_said_why(qtbot, window):
    everything = range(len(window.session.mesh_names))
    window.session.set_mesh_visible(everything, False)
    settle(qtbot)
    assert window.filter_box.count_label.text().endswith("paths; these rays go over hidden meshes or have no power")
    window.session.set_mesh_visible(everything, True)
    settle(qtbot)
    assert window.filter_box.count_label.text().endswith("are drawn")
