"""Objects that are dragged in the window, while map and rays follow."""
from __future__ import annotations

import re
import threading

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox, from_frame
from echopath_viewer.model.frames.live_session import input_of_view, live_of
from echopath_viewer.model.session import Session
from echopath_viewer.window.live.live_control import RADAR
from echopath_viewer.window.live.live_panel import ALONE
from echopath_viewer.window.qt import Qt, QtCore, QtWidgets
from support import shapes
from support.window import LEFT, open_on_screen, project

PATIENCE_MS = 20_000
SAME = 1e-9  # of the largest sample, of a fresh scene


@pytest.fixture
def live_window(qtbot, shared_window, moving_sequence):
    scene = moving_sequence.scene
    scene["plate"].motion = None
    live = ep.Live(scene, moving_sequence.radar, num_rays=3000, max_bounces=2)
    window = shared_window
    window.show_input(input_of_view(live, live.update()))
    open_on_screen(qtbot, window)
    window.live_panel.attach(live, window.session)
    yield window
    window.live_panel.stop()


def settled(qtbot, window) -> None:
    """Waits until the window has the full view of the latest change: the watch has told it, and its events are handled."""
    qtbot.waitUntil(window.live.is_settled, timeout=PATIENCE_MS)
    QtWidgets.QApplication.processEvents()
    assert window.live_panel.state_label.text().startswith("full")


def middle_of_plate(window):
    """[3] m, where it is drawn."""
    return np.mean(window.view3d.builder.meshes.bounds_of([0])[0], axis=0)


def test_a_scene_that_becomes_live_is_traced_as_before(moving_sequence):
    traced = {"edges": True, "footprint": "first_order", "polarization": "jones", "scatterers": "surface", "max_bounces": 2}
    frame = ep.simulate(moving_sequence.scene, moving_sequence.radar, num_rays=500, guard=False, **traced)
    live = live_of(Session(from_frame(frame)), num_rays=500)
    live.update()
    found = live.paths().frame
    assert {name: getattr(found, name) for name in traced} == traced


@pytest.mark.parametrize("choices", [{}, {"attenuation by weather": False}])
def test_a_scene_that_becomes_live_stays_in_its_weather(tmp_path, choices):
    """Echoes in fog, of which records do not know the scene's weather, as loud as before, again after a stop and from a file."""
    scene = ep.Scene(weather=ep.Weather(fog_g_per_m3=10.0))
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(40.0, 0.0, 0.5), yaw=np.pi)
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=3e8, num_samples=128, sampling_rate=10e6, num_chirps=4,
                                chirp_interval=3e-5)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.0, 0.5))], receivers=[ep.Antenna((0.0, 0.01, 0.5))])
    frame = ep.simulate(scene, radar, num_rays=500, guard=False, noise_seed=None, effects=choices)
    ep.save_frame(frame, tmp_path / "frame.h5")
    for shown in (frame, ep.load_frame(tmp_path / "frame.h5")):
        live = live_of(Session(from_frame(shown)), num_rays=500)
        again = live_of(Session(input_of_view(live, live.update())), num_rays=500)
        for view in (live.update(), again.update()):
            assert np.abs(view.cube).max() == pytest.approx(np.abs(frame.cube).max(), rel=0.02)


def test_what_is_moved_by_numbers_is_that_of_a_fresh_scene(qtbot, live_window):
    window, panel = live_window, live_window.live_panel
    settled(qtbot, window)
    panel.choose("plate")
    panel.place_boxes[0].setValue(8.0)
    qtbot.waitUntil(lambda: abs(middle_of_plate(window)[0] - 14.0) < 1e-3, timeout=PATIENCE_MS)
    settled(qtbot, window)
    fresh = ep.Live(window.live.live.scene, window.live.live.radar, num_rays=3000, max_bounces=2).update()
    shown = window.session.parts.whole.spectrum.values
    assert np.abs(shown - fresh.map.values).max() < SAME * np.abs(fresh.map.values).max()
    assert window.session.paths.num_paths == window.session.columns.power.size > 0


def test_a_number_that_is_changed_leaves_the_others_as_they_are(qtbot, live_window):
    """The boxes show 1 mm, by half of which an echo would turn by up to 90 degrees."""
    window, panel = live_window, live_window.live_panel
    for name in ("plate", RADAR):
        panel.choose(name)
        window.live.move(name, (0.00044, 0.12345678, 1.0 / 3.0))
        settled(qtbot, window)
        panel.place_boxes[2].setValue(0.5)
        assert tuple(window.live.position(name)) == (0.00044, 0.12345678, 0.5)


def test_a_number_is_taken_when_it_is_typed_whatever_views_arrive_meanwhile(qtbot, live_window):
    window, panel = live_window, live_window.live_panel
    settled(qtbot, window)
    panel.choose("plate")
    view, seen = window.live.live.update(), []
    window.live.live.change(lambda scene: setattr(scene["plate"], "position", (1.5, 0.0, 0.0)))
    for box, field in ((panel.place_boxes[0], lambda: window.live.position("plate")[0]),
                       (panel.yaw_box, lambda: np.degrees(window.live.yaw("plate")))):
        before = field()
        box.selectAll()
        for key in "5.25":
            qtbot.keyClicks(box, key)
            window.live.shown.emit(window.session, view)
            seen.append(field() - before)
        qtbot.keyClick(box, Qt.Key.Key_Return)
        assert field() == pytest.approx(5.25) and seen == [0.0] * len(seen)
        window.live.shown.emit(window.session, view)
        assert box.value() == 5.25
        qtbot.keyClick(box, Qt.Key.Key_Up)  # a step acts at once
        assert field() == pytest.approx(5.25 + box.singleStep())
    window.live.move("plate", (2.0, 0.0, 0.0))  # as the mouse does
    window.live.shown.emit(window.session, view)
    assert panel.place_boxes[0].value() == 2.0
    settled(qtbot, window)


def test_a_half_typed_number_is_not_that_of_the_object_chosen_next(qtbot, live_window):
    window, panel = live_window, live_window.live_panel
    settled(qtbot, window)
    panel.choose("plate")
    panel.place_boxes[1].selectAll()
    qtbot.keyClicks(panel.place_boxes[1], "7")
    panel.choose("wall")
    assert panel.place_boxes[1].value() == 0.0 == window.live.position("wall")[1] == window.live.position("plate")[1]


def test_the_panel_tells_how_many_rays_there_are_and_what_is_left_out(qtbot, live_window):
    settled(qtbot, live_window)
    assert live_window.live_panel.rays_box.value() == live_window.live.live.num_rays == 3000
    shot = int(re.search("([0-9,]+) rays", live_window.live_panel.state_label.text())[1].replace(",", ""))
    assert shot == pytest.approx(3000, rel=0.19)  # shares of rays are rounded (LiveView.num_rays)
    assert "without noise, rain and other radars" in live_window.live_panel.state_label.text()


def test_an_object_is_dragged_with_shift(qtbot, live_window):
    window, view = live_window, live_window.view3d
    settled(qtbot, window)
    window.look_fit()
    window.settle()
    before, middle = window.live.position("plate"), middle_of_plate(window)
    at = project(window, middle)
    at = next(spot for spot in (at + QtCore.QPoint(dx, dy) for dx in (0, 1, -1, 2, -2) for dy in (0, 3, -3, 6))
              if view.mesh_at(spot.x(), spot.y(), False) == 0)
    aim = project(window, middle + (2.0, 1.0, 0.0)) + (at - project(window, middle))
    qtbot.mousePress(view, LEFT, Qt.KeyboardModifier.ShiftModifier, pos=at)
    qtbot.mouseMove(view, aim)
    qtbot.mouseRelease(view, LEFT, Qt.KeyboardModifier.ShiftModifier, pos=aim)
    assert window.live.position("plate") - before == pytest.approx([2.0, 1.0, 0.0], rel=0, abs=0.15)
    settled(qtbot, window)


def test_steps_of_places_are_no_coarser_than_cells_of_range(qtbot, live_window, moving_sequence):
    window = live_window
    assert {box.singleStep() for box in window.live_panel.place_boxes} == {0.1}  # cells are 0.25 m
    fine = moving_sequence.radar.waveform.replace(bandwidth=6e9, num_samples=256)  # 25 mm
    live = ep.Live(moving_sequence.scene, moving_sequence.radar.replace(waveform=fine), num_rays=500, max_bounces=1)
    window.live_panel.stop()
    window.show_input(input_of_view(live, live.update()))
    window.live_panel.attach(live, window.session)
    assert {box.singleStep() for box in window.live_panel.place_boxes} == {0.02}


def test_names_stay_while_objects_move(qtbot, live_window):
    window = live_window
    settled(qtbot, window)
    window.layer_actions["names"].trigger()
    window.live.move("plate", (5.0, 0.5, 0.0))
    settled(qtbot, window)
    assert window.layer_actions["names"].isChecked() and window.session.layers == {"names"}
    window.layer_actions["names"].trigger()


def test_radar_material_and_turns_follow(qtbot, live_window):
    window, panel = live_window, live_window.live_panel
    settled(qtbot, window)
    level = window.session.parts.whole.level(0, 0).max()
    panel.choose("wall")
    panel.material_box.setCurrentText("metal")
    panel.material_box.activated.emit(panel.material_box.currentIndex())
    settled(qtbot, window)
    assert window.session.parts.whole.level(0, 0).max() > level + 3.0
    panel.material_box.setCurrentIndex(0)
    panel.material_box.activated.emit(0)  # as at the start
    settled(qtbot, window)
    assert window.session.parts.whole.level(0, 0).max() == pytest.approx(level, rel=0, abs=1e-9)
    window.live.set_material("wall", ep.Material(permittivity=5.0, scattering=0.5))
    panel.rough_slider.setValue(10)  # takes the place of the share that it scattered
    settled(qtbot, window)
    assert window.live.live.scene["wall"].meshes[0].material.roughness_height == pytest.approx(5e-4)
    panel.yaw_box.setValue(5.0)
    panel.choose(RADAR)
    panel.place_boxes[1].setValue(0.5)
    settled(qtbot, window)
    assert window.session.radar.position[1] == 0.5 and window.live.yaw("wall") == pytest.approx(np.radians(5.0))


def test_an_object_that_is_called_radar_is_moved_and_not_the_radar(qtbot, live_window):
    window, scene = live_window, live_window.live.live.scene
    scene.add(shapes.plate((9.0, 2.0, 0.0), (-1.0, 0.0, 0.0), 0.2), name="radar", material="metal")
    window.live.move("radar", (1.0, 0.0, 0.0))
    assert tuple(scene["radar"].position) == (1.0, 0.0, 0.0)
    assert np.array_equal(window.live.live.radar.position, (0.0, 0.0, 0.0))
    assert {RADAR, "radar"} <= set(window.live.objects())


def test_flagged_mirrors_stay_such_in_another_material(qtbot, live_window):
    """A house of metal had no ghosts over it."""
    window, scene = live_window, live_window.live.live.scene
    scene["wall"].material = ep.materials["concrete"].replace(mirror=True)
    scene.add(shapes.plate((11.9, 0.0, 0.0), (-1.0, 0.0, 0.0), 0.2), name="windows", parent="wall", material="concrete")
    for material, is_mirror in (("metal", True), ("glass_pane", False), ("brick", True)):  # a pane lets rays pass
        window.live.set_material("wall", ep.materials[material])
        assert [one.mirror for one in window.live.materials("wall")] == [is_mirror, False]
        assert window.live.materials("wall")[0] == ep.materials[material].replace(mirror=is_mirror)
    window.live.restore_materials("wall")
    assert window.live.materials("wall")[0] == ep.materials["concrete"].replace(mirror=True)


def test_material_and_roughness_are_those_of_the_object_that_is_chosen(qtbot, live_window):
    window, panel = live_window, live_window.live_panel
    settled(qtbot, window)
    window.live.set_material("wall", ep.Material(permittivity=5.0, roughness_height=1e-3))
    window.live.set_material("plate", ep.Material.metal())
    panel.choose("plate")
    panel.choose("wall")
    assert panel.rough_slider.value() == 20 and panel.rough_label.text() == "1.00 mm"
    panel.rough_slider.setValue(60)
    panel.material_box.setCurrentText("glass")
    panel.choose("plate")
    assert (panel.rough_slider.value(), panel.rough_label.text()) == (0, "0.00 mm") and panel.material_box.currentIndex() == 0
    panel.choose("wall")
    assert (panel.rough_slider.value(), panel.rough_label.text()) == (60, "3.00 mm")
    assert window.live.materials("plate")[0] == ep.Material.metal()  # a slider that only shows changes nothing
    window.live.set_material("wall", ep.Material(permittivity=5.0, scattering=0.5))  # says how rough it is in another way
    panel.choose("plate")
    panel.choose("wall")
    assert panel.rough_label.text() == ""
    settled(qtbot, window)


def test_each_mesh_of_an_object_keeps_what_it_is_made_of_when_it_is_roughened(qtbot, live_window):
    window, panel = live_window, live_window.live_panel
    settled(qtbot, window)
    made_of = {"a": ep.Material(permittivity=5.0, scattering=0.5), "b": ep.Material.metal()}

    def add(scene):
        scene.add(None, name="pair")
        for number, (name, material) in enumerate(made_of.items()):
            scene.add(shapes.plate((4.0, 2.0 + number, 0.0), (-1.0, 0.0, 0.0), 0.5), name=name, parent="pair", material=material)

    window.live.live.change(add)
    settled(qtbot, window)
    panel.object_box.addItem("pair")
    panel.choose("pair")
    panel.rough_slider.setValue(20)
    settled(qtbot, window)
    assert window.live.materials("pair") == [material.replace(scattering=None, roughness_height=1e-3)
                                             for material in made_of.values()]


def test_a_frame_becomes_live_and_another_one_ends_it(qtbot, window, frame):
    window.live_panel.rays_box.setValue(2000)
    window.live_panel.start_button.setChecked(True)
    settled(qtbot, window)
    assert window.session.title == "live" and window.live_panel.object_box.currentText() == "walker"
    window.show_input(from_frame(frame, title="frame"))
    assert not window.live.is_on and not window.live_panel.start_button.isChecked()


@pytest.fixture
def preview_window(qtbot, live_window, monkeypatch):
    """A window that shows the preview of a plate moved by 3 m; the full view comes once `window.released` is set."""
    window, live, window.released = live_window, live_window.live.live, threading.Event()
    settled(qtbot, window)
    full_update = live.update

    def update(progress):
        while not window.released.wait(0.01):
            progress("trace", 0.0)  # raises where the watch was stopped
        return full_update(progress=progress)

    monkeypatch.setattr(live, "update", update)
    window.live._watch._full_seconds = 1.0  # as of a scene that takes long
    window.level_before = window.session.parts.whole.level(0, 0)
    window.live_panel.choose("plate")
    window.live_panel.place_boxes[0].setValue(3.0)
    qtbot.waitUntil(lambda: window.live_panel.state_label.text().startswith("preview"), timeout=PATIENCE_MS)
    yield window
    window.released.set()


def test_scene_rays_and_map_follow_a_preview_before_the_full_view(qtbot, preview_window):
    window, drawn = preview_window, preview_window.view3d.builder
    assert middle_of_plate(window)[0] == pytest.approx(9.0, abs=0.01)
    assert drawn.session is window.session is window.map_area.session
    assert all(panel.session is window.session for panel in (window.tree, window.filter_box, window.contributions,
                                                             *window.side_panels.values(), window.live_panel))
    on_plate = drawn.rays.segments.points[drawn.rays.segments.hits[drawn.rays.segments.hit_mesh == 0]]
    assert len(on_plate) and np.abs(on_plate[:, 0] - 9.0).max() < 0.3
    assert not np.array_equal(window.session.parts.whole.level(0, 0), window.level_before)
    window.table.view.selectRow(0)  # a row of the preview, whose paths are others
    assert window.session.ray is not None
    window.released.set()
    settled(qtbot, window)


def test_a_preview_that_is_stopped_stays_and_is_where_the_next_start_begins(qtbot, preview_window):
    window, drawn = preview_window, preview_window.view3d.builder.rays
    window.live_panel.start_button.setChecked(False)
    shown = window.session
    assert shown.title == "live" and shown._listeners.count(window._changed) == 1
    assert drawn._rays.GetMapper().GetInput() is drawn._lines and len(drawn.segments.rays) == len(shown.shown_rays())
    window.live_panel.start_button.setChecked(True)
    assert window.live.position("plate")[0] == pytest.approx(3.0)
    settled(qtbot, window)
    assert middle_of_plate(window)[0] == pytest.approx(9.0, abs=0.01)


def test_what_ends_the_watch_is_told_at_once(qtbot, live_window):
    window = live_window
    settled(qtbot, window)
    window.live.live.change(lambda scene: setattr(scene["plate"], "position", (1e30, 0.0, 0.0)))
    qtbot.waitUntil(lambda: not window.live.is_on, timeout=PATIENCE_MS)
    assert window.banner.text().startswith("The live view has ended: ") and "plate" in window.banner.text()
    assert not window.live_panel.start_button.isChecked() and not window.live_panel.state_label.text().startswith("preview")
    window.show_message("")


def test_what_is_chosen_while_the_full_view_is_traced_stays(qtbot, preview_window):
    window = preview_window
    window.session.select_cells(CellBox(3, 9, 2, 9))
    window.session.set_color_by("mesh")
    window.session.set_dynamic_range(35.0)
    window.released.set()
    settled(qtbot, window)
    assert window.session.box == CellBox(3, 9, 2, 9) and window.session.color_by == "mesh"
    assert window.session.dynamic_range_db == 35.0 and window.filter_box.colour_box.currentText() == "mesh"


def test_boxes_of_numbers_are_as_high_as_their_text(qtbot, live_window):
    """What is told of a view takes lines of its own."""
    window, panel = live_window, live_window.live_panel
    before = window.size()
    window.resize(1232, 630)
    window.docks["Live"].raise_()
    panel.state_label.setText(f"preview, full quality follows: 48,498 rays, 48,498 shot anew, 286 ms; {ALONE}")
    qtbot.wait(60)
    assert all(box.height() >= box.minimumSizeHint().height() for box in (*panel.place_boxes, panel.yaw_box))
    window.resize(before)
