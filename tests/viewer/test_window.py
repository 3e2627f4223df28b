"""The window by real clicks and keys, under a virtual screen."""
from __future__ import annotations

import gc
import weakref

import h5py
import numpy as np
import pytest
import pyvista as pv

import echopath as ep
from echopath.stages import peak_memory
from echopath_viewer.model import WHOLE, CellBox, Filters, from_frame
from echopath_viewer.window import MainWindow
from echopath_viewer.window.filter_box import around_caret
from echopath_viewer.window.keys import KEYS
from echopath_viewer.window.qt import Qt, QtCore, QtGui, QtWidgets

EDGE = 0.01          # of a cell: paths that close to its edge may fall to either side
LEAK_BYTES = 40e6    # a window with this frame takes more; caches of fonts and of the driver take less
PATIENCE_MS = 5000
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def shared_window(qapp):
    """One window for all tests: what a window costs is mostly its first picture."""
    window = MainWindow()
    window.resize(1100, 700)
    window.show()
    window.activateWindow()
    yield window
    window.close()


@pytest.fixture
def window(qtbot, shared_window, frame):
    """Fresh, as far as it shows."""
    window = shared_window
    window.show_input(from_frame(frame, title="frame"))
    window.map_area.show_one(False)
    window.map_area.set_view(window.map_area.whole_view)
    window.filter_box.hits_check.setChecked(False)
    window.filter_box.name_edit.clear()
    window.filter_box.show_name_error("")
    window.table.view.sortByColumn(3, Qt.SortOrder.DescendingOrder)
    open_on_screen(qtbot, window)
    return window


def open_on_screen(qtbot, window) -> None:
    with qtbot.waitActive(window):  # shortcuts belong to the active window
        window.show()
        window.activateWindow()
    settle(qtbot)


def settle(qtbot) -> None:
    """Until timers of zero length and the lists have had their turn."""
    qtbot.wait(60)


def panel_of(window, *key):
    return window.map_area.panels[key]


def click_cell(qtbot, window, key: tuple, range_index: int, velocity_index: int) -> None:
    panel, spectrum = panel_of(window, *key), window.session.parts[key].spectrum
    middle = QtCore.QPointF(spectrum.range[range_index], spectrum.velocity[velocity_index])
    window.map_area.set_view(QtCore.QRectF(middle.x() - 1.0, middle.y() - 1.0, 2.0, 2.0))  # cells of many pixels
    at = panel.to_pixel(spectrum.range[range_index], spectrum.velocity[velocity_index])
    assert panel.plot_rect().contains(at)
    qtbot.mouseClick(panel, LEFT, pos=at.toPoint())
    settle(qtbot)


def cells_from_phases(frame):
    """Range and velocity of each path in cells, from the exact IF phase at neighbouring samples and chirps."""
    waveform = frame.radar.waveform
    sample, chirp, half = waveform.num_samples // 2, 0.5 * (waveform.num_chirps - 1), 0.5

    def cycles(n: float, j: float):
        within = n / waveform.sampling_rate
        slot = j * len(frame.radar.transmitters) * waveform.chirp_interval
        delay = frame.paths.lengths([slot + within], 0, 0)[0] / ep.speed_of_light
        return waveform.start_frequency * delay + waveform.slope * within * delay - 0.5 * waveform.slope * delay ** 2

    middle = 0.5 * (waveform.num_samples - 1)
    per_sample = cycles(middle + half, chirp) - cycles(middle - half, chirp)
    per_chirp = cycles(middle, chirp + half) - cycles(middle, chirp - half)
    assert sample
    return per_sample * waveform.num_samples, per_chirp * waveform.num_chirps + waveform.num_chirps // 2


def offset_in_turns(value, index: int, count: int):
    """Cells from `index`, the shorter way round."""
    return (value - index + 0.5 * count) % count - 0.5 * count


def strongest_cell(window, key: tuple) -> tuple:
    """(range index, velocity index), not at the ends of the velocity axis, which a box does not go round."""
    level = window.session.parts[key].level(0, 0)[2:-2]
    velocity, distance = np.unravel_index(level.argmax(), level.shape)
    return int(distance), int(velocity) + 2


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
    cells = session.columns.cells
    assert np.array_equal(session.lit, cells.within((session.box.first_range, session.box.last_range),
                                                    (session.box.first_velocity, session.box.last_velocity)))
    qtbot.keyClick(window, Qt.Key.Key_Escape)
    assert session.box is None


# --- ray -> hits and cell ---

def project(window, point):
    clip = window.view3d.clip_from_world() @ np.append(point, 1.0)
    size = window.view3d.size()
    return QtCore.QPoint(round((0.5 + 0.5 * clip[0] / clip[3]) * size.width()),
                         round((0.5 - 0.5 * clip[1] / clip[3]) * size.height()))


@pytest.mark.parametrize("leg", [0, 1])
def test_a_click_on_a_projected_ray_selects_it(qtbot, window, leg):
    window.session.set_part(("route", "ghost"))
    window.session.set_filters(Filters(expression="T 'wall_*' 'walker' R"))  # without the same rays the other way round
    window.session.set_max_rays(3)
    settle(qtbot)
    segments = window.view3d.builder.rays.segments
    row = np.flatnonzero((segments.ray == 1) & (segments.bounce == leg))[0]
    begin, end = segments.points[segments.ends[row]].astype(float)
    # where the pictures of the other rays are farthest away
    spots = [project(window, begin + share * (end - begin)) for share in np.linspace(0.2, 0.8, 13)]
    others = [project(window, point) for other in np.flatnonzero(segments.ray != 1)
              for point in np.linspace(*segments.points[segments.ends[other]].astype(float), 60)]
    spot = max(spots, key=lambda at: min((at - other).manhattanLength() for other in others))
    qtbot.mouseClick(window.view3d, LEFT, pos=spot)
    settle(qtbot)
    path = int(segments.rays[1])
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
    assert counts == [f"{count:,}" for count in window.session.mesh_counts()[:2]]


# --- filters ---

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
    assert np.array_equal(window.session.visible, (columns.num_bounces >= 2) & (columns.power_dbm >= -140))
    qtbot.mouseClick(window.filter_box.reset_button, LEFT)
    assert window.session.visible.all() and window.filter_box.from_box.value() == 0


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
        assert word in text


def test_a_channel_is_chosen(qtbot, window, frame):
    window.map_area.channel_box.setCurrentIndex(3)
    window.map_area.channel_box.activated.emit(3)
    settle(qtbot)
    assert window.session.channel == (1, 1)
    level = 10 * np.log10(np.abs(frame.spectrum.values[1, 1]) ** 2 * 1e3)
    assert panel_of(window, WHOLE, WHOLE).level == pytest.approx(level, abs=1e-3)


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


# --- table ---

def test_the_table_is_sorted_and_copied(qtbot, window):
    window.table.view.sortByColumn(1, Qt.SortOrder.AscendingOrder)
    ranges = window.session.columns.cells.range[window.table.model.rays]
    assert np.all(np.diff(ranges) >= 0.0)
    window.table.view.selectRow(1)
    window.table.view.setFocus()
    qtbot.keyClick(window.table.view, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    heading, row = QtWidgets.QApplication.clipboard().text().split("\n")
    assert heading.split("\t")[0] == "Bounces" and row.split("\t")[1] == f"{ranges[1]:.3f}"


# --- camera, keys ---

def test_fewer_rays_are_drawn_while_the_camera_moves(qtbot, window):
    rays = window.view3d.builder.rays
    style = window.view3d.iren.interactor.GetInteractorStyle()
    style.InvokeEvent("StartInteractionEvent")
    moving = rays._rays.GetMapper().GetInput().GetNumberOfLines()
    style.InvokeEvent("EndInteractionEvent")
    still = rays._rays.GetMapper().GetInput().GetNumberOfLines()
    assert moving == rays.segments.num_segments_of(300) < still == rays.segments.num_segments


def test_keys_do_what_the_help_says(qtbot, window):
    qtbot.keyClick(window, Qt.Key.Key_T)
    top = np.array(window.view3d.camera.position) - window.view3d.camera.focal_point
    assert top[2] == pytest.approx(np.linalg.norm(top), rel=1e-6)
    qtbot.keyClick(window, Qt.Key.Key_S)
    side = np.array(window.view3d.camera.position) - window.view3d.camera.focal_point
    assert -side[1] == pytest.approx(np.linalg.norm(side), rel=1e-6)
    qtbot.keyClick(window, Qt.Key.Key_R)
    assert np.linalg.norm(np.array(window.view3d.camera.position) - window.session.antennas_at(0.0)[0]) < 1.0
    qtbot.keyClick(window, Qt.Key.Key_C)
    assert window.session.color_by == "mesh" and window.filter_box.colour_box.currentText() == "mesh"
    qtbot.keyClick(window, Qt.Key.Key_H)
    assert window.view3d.builder.show_hits
    chirp = window.session.chirp
    qtbot.keyClick(window, Qt.Key.Key_Right)
    assert window.session.chirp == chirp + 1
    qtbot.keyClick(window, "?")
    dialog = window.findChild(QtWidgets.QDialog)
    text = dialog.findChild(QtWidgets.QLabel).text()
    assert dialog.isVisible() and all(key in text and what in text for key, _, what in KEYS)
    assert all(hasattr(window, method) for _, method, _ in KEYS)


# --- files ---

def test_a_view_is_saved_and_loaded_with_its_camera(qtbot, window, tmp_path):
    window.filter_box.from_box.setValue(2)
    window.session.set_color_by("power")
    qtbot.keyClick(window, Qt.Key.Key_T)
    camera = window.view3d.camera_state()
    window.save_view(tmp_path / "view.json")
    qtbot.mouseClick(window.filter_box.reset_button, LEFT)
    qtbot.keyClick(window, Qt.Key.Key_F)
    window.load_view(tmp_path / "view.json")
    assert window.session.filters.min_bounces == 2 == window.filter_box.from_box.value()
    assert window.session.color_by == "power"
    for name, value in window.view3d.camera_state().items():
        assert value == pytest.approx(camera[name]), name


def test_a_picture_holds_the_scene_too(qtbot, window, tmp_path):
    window.screenshot(tmp_path / "window.png")
    image = QtGui.QImage(str(tmp_path / "window.png"))
    corner = window.view3d.mapTo(window, QtCore.QPoint(0, 0))
    colours = {image.pixel(corner.x() + x, corner.y() + y) for x in range(20, window.view3d.width() - 20, 5)
               for y in range(20, window.view3d.height() - 20, 5)}
    assert image.width() == window.width() and len(colours) > 10


def test_rays_and_meshes_are_exported_for_paraview(qtbot, window, frame, tmp_path, monkeypatch):
    window.session.set_part(("route", "ghost"))
    for method, name in (("export_rays_dialog", "rays.vtp"), ("export_meshes_dialog", "meshes.vtp")):
        monkeypatch.setattr(QtWidgets.QFileDialog, "getSaveFileName", lambda *_, name=name: (str(tmp_path / name), ""))
        getattr(window, method)()
    rays, meshes = pv.read(tmp_path / "rays.vtp"), pv.read(tmp_path / "meshes.vtp")
    assert rays.n_lines == window.view3d.builder.rays.segments.num_segments and rays.n_verts == 0
    path = rays.cell_data["path"]
    assert np.array_equal(rays.cell_data["num_bounces"], frame.paths.num_bounces[path])
    assert rays.cell_data["power_dbm"] == pytest.approx(window.session.columns.power_dbm[path])
    assert meshes.n_cells == sum(len(mesh.triangles) for mesh in frame.scene.meshes)
    assert list(meshes.field_data["mesh_names"]) == [mesh.name for mesh in frame.scene.meshes]
    monkeypatch.setattr(QtWidgets.QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "rays.stl"), ""))
    window.export_rays_dialog()
    assert window.banner.isVisible() and ".vtp" in window.banner.text()


@pytest.mark.parametrize("kind", ["missing", "text", "foreign", "cut"])
def test_a_file_that_cannot_be_shown_is_said_above_what_was_shown(qtbot, window, frame, tmp_path, kind):
    path = tmp_path / "frame.h5"
    if kind == "text":
        path.write_text("not HDF5")
    elif kind == "foreign":
        with h5py.File(path, "w") as file:
            file["x"] = 1.0
    elif kind == "cut":
        ep.save_frame(frame, path)
        path.write_bytes(path.read_bytes()[:path.stat().st_size // 2])
    session = window.session
    assert not window.open_file(path)
    assert window.banner.isVisible() and "frame.h5" in window.banner.text() and window.session is session
    qtbot.mouseClick(window.banner, LEFT)
    assert not window.banner.isVisible()


def test_a_frame_file_is_opened(qtbot, window, frame, tmp_path):
    ep.save_frame(frame, tmp_path / "frame.h5")
    assert window.open_file(tmp_path / "frame.h5")
    assert "frame.h5" in window.windowTitle() and window.session.paths.num_paths == frame.paths.num_paths


def test_a_script_opens_paths_with_parts_of_them(qtbot, frame):
    parts = ep.decompose(frame.paths, frame.radar, {"ghosts": "T 'wall_*' 'walker' R"})
    window = ep.view(frame.scene, frame.paths, parts, window="rect", block=False)
    qtbot.addWidget(window)
    window.session.set_part(("parts", "ghosts"))
    wanted = ep.range_doppler(parts["ghosts"], frame.radar, window="rect")
    assert np.array_equal(window.session.part.spectrum.values, wanted.values)
    assert window.session.visible.sum() == frame.paths.select("T 'wall_*' 'walker' R").num_paths
    window.close()


@pytest.mark.parametrize("arguments, keywords", [((3,), {}), ((), {"parts": {}}), ((None, None, None, None), {})])
def test_what_cannot_be_viewed_is_refused(arguments, keywords):
    with pytest.raises(TypeError, match="view"):
        ep.view(*arguments, **keywords)


# --- empty, closing ---

def test_without_a_frame_the_window_says_what_to_do(qtbot, frame):
    window = MainWindow()
    qtbot.addWidget(window)
    open_on_screen(qtbot, window)
    assert window.empty_page.isVisible() and not window.content.isVisible()
    for key in (Qt.Key.Key_C, Qt.Key.Key_Escape, Qt.Key.Key_Right, Qt.Key.Key_Space):
        qtbot.keyClick(window, key)
    window.show_input(from_frame(frame))
    assert window.content.isVisible() and not window.empty_page.isVisible()


def test_the_demo_is_simulated_on_the_spot(qtbot, monkeypatch):
    monkeypatch.setattr("echopath_viewer.window.demo.NUM_RAYS", 300)
    window = MainWindow()
    qtbot.addWidget(window)
    open_on_screen(qtbot, window)
    qtbot.mouseClick(window.empty_page.demo_button, LEFT)
    assert window.session is not None and "pedestrian/torso" in window.session.mesh_names
    window.close()


def test_opening_and_closing_five_times_leaves_nothing_behind(qtbot, frame):
    memory, gone = [], []
    for _ in range(5):
        window = MainWindow()
        window.show_input(from_frame(frame))
        open_on_screen(qtbot, window)
        assert window.view3d._fallback is None  # a context that pyvistaqt makes for what is drawn too early
        gone += [weakref.ref(window.session), weakref.ref(window.view3d.builder)]
        window.close()
        window.deleteLater()
        del window
        settle(qtbot)
        gc.collect()
        memory.append(peak_memory())
    assert [reference() for reference in gone] == [None] * len(gone)
    assert memory[-1] - memory[1] < LEAK_BYTES
