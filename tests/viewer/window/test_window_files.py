"""Camera, keys, files, and windows opened and closed."""
from __future__ import annotations

import gc
import json
import resource
import sys
import weakref

import h5py
import numpy as np
import pytest
import pyvista as pv

import echopath as ep
from echopath.cli import main
from echopath_viewer.model import CellBox, from_frame
from echopath_viewer.window import MainWindow
from echopath_viewer.window.files.exporting import export
from echopath_viewer.window.keys import KEYS
from echopath_viewer.window.qt import Qt, QtCore, QtGui, QtWidgets
from support.window import LEFT, open_on_screen, settle

LEAK_BYTES = 40e6    # a window with this frame takes more; caches of fonts and of the driver take less


def num_distinct(segments) -> int:
    """Of those between the same points only one is drawn."""
    return len({frozenset(map(tuple, ends)) for ends in segments.points[segments.ends].tolist()})


# --- camera, keys ---

def test_fewer_rays_are_drawn_while_the_camera_moves(qtbot, window):
    window.view3d._turning.num_rays = 300  # as slow pictures make it
    rays = window.view3d.builder.rays
    style = window.view3d.iren.interactor.GetInteractorStyle()
    style.InvokeEvent("StartInteractionEvent")
    moving = rays._rays.GetMapper().GetInput().GetNumberOfLines()
    style.InvokeEvent("EndInteractionEvent")
    still = rays._rays.GetMapper().GetInput().GetNumberOfLines()
    assert 0 < moving <= rays.segments.num_segments_of(300) < still == num_distinct(rays.segments)


def test_keys_do_what_the_help_says(qtbot, window):
    qtbot.keyClick(window, Qt.Key.Key_T)
    top = np.array(window.view3d.camera.position) - window.view3d.camera.focal_point
    assert top[2] == pytest.approx(np.linalg.norm(top), rel=1e-6, abs=0)
    qtbot.keyClick(window, Qt.Key.Key_S)
    side = np.array(window.view3d.camera.position) - window.view3d.camera.focal_point
    assert -side[1] == pytest.approx(np.linalg.norm(side), rel=1e-6, abs=0)
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
    assert dialog.isVisible() and all(key in text and what in text for key, _, what in KEYS if key)
    assert all(hasattr(window, method) for _, method, _ in KEYS)


def test_fewer_lit_rays_are_drawn_while_the_camera_moves(qtbot, window):
    window.view3d._turning.num_rays = 300
    window.session.select_cells(CellBox(0, 127, 0, 31))
    settle(qtbot)
    lit = window.view3d.builder.lit
    counts = []
    for event in ("StartInteractionEvent", "EndInteractionEvent"):
        window.view3d.iren.interactor.GetInteractorStyle().InvokeEvent(event)
        counts.append(lit._rays.GetMapper().GetInput().GetNumberOfLines())
    assert 0 < counts[0] <= lit.segments.num_segments_of(300) and counts[0] < counts[1] == num_distinct(lit.segments)


# --- files ---

def test_a_view_is_saved_and_loaded_with_its_camera(qtbot, window, tmp_path):
    window.filter_box.from_box.setValue(2)
    window.session.set_color_by("power")
    qtbot.keyClick(window, Qt.Key.Key_T)
    camera = window.view3d.camera_state()
    window.save_view(tmp_path / "view.json")
    assert json.loads((tmp_path / "view.json").read_text())["seed"] == window.session.paths.frame.seed
    qtbot.mouseClick(window.filter_box.reset_button, LEFT)
    qtbot.keyClick(window, Qt.Key.Key_F)
    window.load_view(tmp_path / "view.json")
    assert window.session.filters.min_bounces == 2 == window.filter_box.from_box.value()
    assert window.session.color_by == "power"
    for name, value in window.view3d.camera_state().items():
        assert value == pytest.approx(camera[name]), name


def test_a_picture_holds_the_scene_too_and_the_seed(qtbot, window, frame, tmp_path):
    window.screenshot(tmp_path / "window.png")
    image = QtGui.QImage(str(tmp_path / "window.png"))
    corner = window.view3d.mapTo(window, QtCore.QPoint(0, 0))
    colours = {image.pixel(corner.x() + x, corner.y() + y) for x in range(20, window.view3d.width() - 20, 5)
               for y in range(20, window.view3d.height() - 20, 5)}
    assert image.width() == window.width() and len(colours) > 10
    assert image.text("Seed") == str(frame.paths.frame.seed) and image.text("Software").endswith(ep.__version__)


def test_rays_and_meshes_are_exported_for_paraview(qtbot, window, frame, tmp_path, monkeypatch):
    window.session.set_part(("route", "ghost"))
    for method, name in (("export_rays_dialog", "rays.vtp"), ("export_meshes_dialog", "meshes.vtp")):
        monkeypatch.setattr(QtWidgets.QFileDialog, "getSaveFileName", lambda *_, name=name: (str(tmp_path / name), ""))
        getattr(window, method)()
    rays, meshes = pv.read(tmp_path / "rays.vtp"), pv.read(tmp_path / "meshes.vtp")
    assert rays.n_lines == window.view3d.builder.rays.segments.num_segments and rays.n_verts == 0
    path = rays.cell_data["path"]
    assert np.array_equal(rays.cell_data["num_bounces"], frame.paths.num_bounces[path])
    assert rays.cell_data["power_dbm"] == pytest.approx(window.session.columns.power_dbm(path))
    assert meshes.n_cells == sum(len(mesh.triangles) for mesh in frame.scene.meshes)
    assert [list(file.field_data["seed"]) for file in (rays, meshes)] == [[str(frame.paths.frame.seed)]] * 2
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


def test_the_command_draws_a_saved_view_when_it_is_complete(qtbot, window, frame, tmp_path, monkeypatch):
    window.session.set_part(("route", "ghost"))
    window.session.select_cells(CellBox(0, 127, 0, 31))
    window.session.set_chirp(3)
    window.save_view(tmp_path / "view.json")
    ep.save_frame(frame, tmp_path / "frame.h5")
    drawn = []
    monkeypatch.setattr("echopath_viewer.window.app.export", lambda window, path, scale: (
        drawn.append((window, window.session, window.time_bar.strip._title)), export(window, path, scale)))
    command = ["view", str(tmp_path / "frame.h5"), "--state", str(tmp_path / "view.json")]
    assert main([*command, "--picture", str(tmp_path / "window.png")]) == 0
    (found, session, title), = drawn
    assert (session.part_key, session.chirp) == (("route", "ghost"), 3) and not found.isVisible()
    assert "the selected rays" in title  # their signal comes last
    assert QtGui.QImage(str(tmp_path / "window.png")).width() == found.width()


def test_a_picture_of_nothing_or_of_no_view_is_refused_before_there_is_a_window(frame, tmp_path, monkeypatch):
    monkeypatch.setattr("echopath_viewer.window.app.MainWindow", None)
    with pytest.raises(ValueError, match="state and picture: must come with a frame"):
        ep.view(picture=tmp_path / "window.png")
    (tmp_path / "view.json").write_text("{}")
    with pytest.raises(ep.FileError, match="view.json: no view of echopath"):
        ep.view(frame, state=tmp_path / "view.json", picture=tmp_path / "window.png")
    assert not (tmp_path / "window.png").exists()


@pytest.mark.parametrize("arguments, keywords", [((3,), {}), ((), {"parts": {}}), ((None, None, None, None), {})])
def test_what_cannot_be_viewed_is_refused(arguments, keywords):
    with pytest.raises(TypeError, match="view"):
        ep.view(*arguments, **keywords)


def test_a_damaged_view_is_said_and_changes_nothing(qtbot, window, tmp_path, monkeypatch):
    window.save_view(tmp_path / "view.json")
    state = json.loads((tmp_path / "view.json").read_text()) | {"color_by": "power", "camera": {}}
    (tmp_path / "view.json").write_text(json.dumps(state))
    monkeypatch.setattr(QtWidgets.QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "view.json"), ""))
    window.load_view_dialog()
    assert window.banner.isVisible() and "camera: must be" in window.banner.text()
    assert window.session.color_by == "bounces"


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
    monkeypatch.setattr("echopath_viewer.window.files.demo.NUM_RAYS", 300)
    window = MainWindow()
    qtbot.addWidget(window)
    open_on_screen(qtbot, window)
    qtbot.mouseClick(window.empty_page.demo_button, LEFT)
    assert window.session is not None and "pedestrian/torso" in window.session.mesh_names
    window.close()


@pytest.mark.skipif(sys.platform != "linux", reason="the memory held now is read from /proc")
def test_opening_and_closing_again_and_again_leaves_nothing_behind(qtbot, frame):
    memory, gone = [], []
    for _ in range(4):
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
        memory.append(resident_memory())
    assert [reference() for reference in gone] == [None] * len(gone)
    assert memory[-1] - memory[1] < LEAK_BYTES


def resident_memory() -> int:
    """Bytes that the process holds now."""
    with open("/proc/self/statm", encoding="ascii") as pages:
        return int(pages.read().split()[1]) * resource.getpagesize()
