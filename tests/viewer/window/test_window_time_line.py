"""Frames in time in the window."""
from __future__ import annotations

import shutil
import threading

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox
from echopath_viewer.model.frames.overview import glance_at, level_image
from echopath_viewer.window.qt import Qt
from support.window import PATIENCE_MS, open_on_screen, settle

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def line_window(qtbot, shared_window, stored_run):
    shared_window.open_file(stored_run.path)
    open_on_screen(qtbot, shared_window)
    yield shared_window
    shared_window.time_line.show(None)


def wait_for(qtbot, window, place: int) -> None:
    control = window.time_line
    qtbot.waitUntil(lambda: control.place == place and not control.is_busy, timeout=PATIENCE_MS)


def test_keys_and_buttons_go_from_frame_to_frame(qtbot, line_window, stored_run):
    window = line_window
    camera = window.view3d.camera_state()
    for go, place in ((lambda: qtbot.keyClick(window, Qt.Key.Key_PageDown), 1),
                      (lambda: qtbot.mouseClick(window.frame_bar.on_button, LEFT), 2),
                      (lambda: qtbot.keyClick(window, Qt.Key.Key_PageUp), 1), (lambda: window.frame_bar.slider.setValue(0), 0)):
        go()
        wait_for(qtbot, window, place)
        assert window.session.paths.frame.start_time == stored_run.times[place]
        assert window.view3d.builder.session is window.session is window.map_area.session
        assert f"frame {place + 1} of 3" in window.frame_bar.label.text()
    assert window.view3d.camera_state() == camera


def test_colours_objects_and_cells_stay_selected(qtbot, line_window):
    window, session = line_window, line_window.session
    session.set_mesh_colour(0, (10, 200, 30))
    session.select_node("plate")
    session.select_cells(CellBox(3, 9, 2, 9))
    before = window.view3d.builder.meshes.actors[0]
    window.next_frame()
    wait_for(qtbot, window, 1)
    after = window.session
    assert after is not session and after.palette[0].tolist() == [10, 200, 30]
    assert after.node == "plate" and after.box == session.box
    actor = window.view3d.builder.meshes.actors[0]
    assert actor is before and actor.GetProperty().GetColor() == pytest.approx((10 / 255, 200 / 255, 30 / 255))
    assert actor.GetCenter()[0] == pytest.approx(6.0 - 4.0 * after.time, rel=0, abs=1e-4)


def test_undo_goes_back_over_frames(qtbot, line_window):
    window = line_window
    window.session.set_color_by("power")
    settle(qtbot)
    for place in (1, 2):
        window.next_frame()
        wait_for(qtbot, window, place)
        settle(qtbot)
    window.undo()
    assert window.session.color_by == "bounces" and window.time_line.place == 2
    window.redo()
    assert window.session.color_by == "power"


def test_the_film_goes_round(qtbot, line_window):
    window, seen = line_window, []
    window.time_line.read.connect(lambda session: seen.append(window.time_line.place))
    qtbot.keyClick(window, Qt.Key.Key_Space, Qt.KeyboardModifier.ShiftModifier)
    qtbot.waitUntil(lambda: len(seen) >= 4, timeout=2 * PATIENCE_MS)
    assert window._is_passing and window.view3d._pace is not None and window.view3d.builder.session is window.session
    assert window.map_area.session is window.session
    window.toggle_play_frames()
    assert seen[:4] == [1, 2, 0, 1] and not window.time_line.is_playing
    assert not window._is_passing and window.view3d._pace is None  # the frame at which it stopped is shown whole
    qtbot.waitUntil(lambda: not window.time_line.is_busy, timeout=PATIENCE_MS)
    counts = {node.name: count for node, count in zip(window.session.scene.nodes, window.session.node_counts())}
    assert {name: item.text(1) for name, item in window.tree._items.items()} == {
        name: f"{count:,}" for name, count in counts.items()}


def test_the_strip_has_all_frames_and_goes_to_one(qtbot, line_window):
    window, strip = line_window, line_window.frame_bar.strip
    qtbot.waitUntil(lambda: len(strip._glances) == 3, timeout=PATIENCE_MS)
    qtbot.mouseClick(strip, LEFT, pos=strip.rect().center() + (strip.rect().topRight() - strip.rect().center()) * 0.8)
    wait_for(qtbot, window, 2)
    lines = window.view3d.builder.tracks._actor
    assert strip.tracks.num_tracks >= 1 and lines.GetVisibility()
    levels = [strip.places[strip.tracks.track == number, 2].mean() for number in np.unique(strip.tracks.track)]
    assert lines.GetBounds()[4:] == pytest.approx([min(levels), max(levels)], abs=1e-5)
    for number in (1, 0):
        window.frame_bar.axis_box.setCurrentIndex(number)
        assert strip._image is not None and not strip.grab().isNull()


def test_a_window_is_at_rest_when_the_strip_has_all_frames(qtbot, shared_window, stored_run, monkeypatch):
    """However long they are read: a picture shows them, not that they are read."""
    may_end = threading.Event()

    def slow_glance(moment):
        may_end.wait(1e-3 * PATIENCE_MS)
        return glance_at(moment)

    monkeypatch.setattr("echopath_viewer.window.timeline.time_control.glance_at", slow_glance)
    shared_window.open_file(stored_run.path)
    open_on_screen(qtbot, shared_window)
    with pytest.raises(TimeoutError, match="late are: .*frames of the strip"):
        shared_window.settle(patience=0.1)
    may_end.set()
    shared_window.settle()
    strip = shared_window.frame_bar.strip
    assert [glance.time for glance in strip._glances] == list(stored_run.times) and strip.tracks.num_tracks >= 1
    shared_window.time_line.show(None)


def test_a_file_without_a_map_leaves_a_gap_in_the_strip(qtbot, shared_window, stored_run, tmp_path):
    """A file of paths alone, and one whose map is damaged, take no column from the others."""
    for number in range(3):
        shutil.copy(stored_run.paths_of_files[number], tmp_path / f"{number}.h5")
    stored_run[0].paths.save(tmp_path / "0.h5")
    with h5py.File(tmp_path / "1.h5", "r+") as file:
        del file["spectra/values"]
    shared_window.open_file(tmp_path)
    shared_window.settle()
    strip = shared_window.frame_bar.strip
    level, _ = level_image(strip._glances, "range")
    assert np.isfinite(level).all(axis=0).tolist() == [False, False, True] and strip._image is not None
    assert "1.h5" in shared_window.banner.text() and not strip.grab().isNull()
    shared_window.time_line.show(None)


def test_new_frames_come_and_damaged_ones_are_told(qtbot, shared_window, stored_run, tmp_path):
    window = shared_window
    for name in ("sequence.h5", "frame_0000.h5"):
        shutil.copy(stored_run.path / name, tmp_path / name)
    assert window.open_file(tmp_path)
    window.frame_bar.follow_check.setChecked(True)
    shutil.copy(stored_run.paths_of_files[1], tmp_path / "frame_0001.h5")
    window.time_line.look()
    wait_for(qtbot, window, 1)
    window.frame_bar.follow_check.setChecked(False)
    (tmp_path / "frame_0002.h5").write_bytes(b"no frame")
    window.time_line.look()
    window.next_frame()
    qtbot.waitUntil(lambda: "frame_0002.h5" in window.banner.text(), timeout=PATIENCE_MS)
    assert window.time_line.place == 1 and window.session.paths.frame.start_time == stored_run.times[1]
    window.show_message("")
    window.time_line.show(None)


@pytest.fixture
def damaged(stored_run, tmp_path):
    """Folder of a sequence that makes the frame at a place no frame."""
    shutil.copytree(stored_run.path, tmp_path / "run")

    def damage(place: int):
        (tmp_path / "run" / f"frame_{place:04d}.h5").write_bytes(b"no frame")
        return tmp_path / "run"

    return damage


def test_steps_and_films_go_over_a_frame_that_is_damaged(qtbot, shared_window, damaged):
    """Whoever stepped had come no farther, and a film had ended."""
    window, control = shared_window, shared_window.time_line
    assert window.open_file(damaged(1))
    for step, place in ((window.next_frame, 2), (window.previous_frame, 0)):
        window.show_message("")
        step()
        wait_for(qtbot, window, place)
        assert "frame_0001.h5" in window.banner.text() and f"frame {place + 1} of 3" in window.frame_bar.label.text()
    control.go(1)
    qtbot.waitUntil(lambda: not control.is_busy, timeout=PATIENCE_MS)
    assert control.place == 0
    damaged(2)
    window.next_frame()
    qtbot.waitUntil(lambda: "frame_0002.h5" in window.banner.text() and not control.is_busy, timeout=PATIENCE_MS)
    assert control.place == 0
    control.show(None)


def test_a_film_goes_over_damaged_frames_and_ends_where_there_is_no_other(qtbot, shared_window, damaged):
    window, control, seen = shared_window, shared_window.time_line, []
    assert window.open_file(damaged(2))
    control.read.connect(lambda _: seen.append(control.place))
    window.toggle_play_frames()
    qtbot.waitUntil(lambda: seen[:3] == [1, 0, 1], timeout=PATIENCE_MS)
    damaged(0)
    damaged(1)
    qtbot.waitUntil(lambda: not control.is_playing and not control.is_busy, timeout=PATIENCE_MS)
    control.show(None)


def test_a_sequence_whose_first_frame_is_damaged_opens_at_the_next_one(qtbot, shared_window, damaged):
    window, control = shared_window, shared_window.time_line
    assert window.open_file(damaged(0))
    assert control.place == 1 and "frame 2 of 3" in window.frame_bar.label.text()
    control.look()
    assert "frame_0000.h5" in window.banner.text()
    damaged(1)
    damaged(2)
    assert not window.open_file(damaged(0)) and "frame_0000.h5" in window.banner.text()
    control.show(None)


def test_the_newest_frame_is_shown_once_it_is_copied_to_the_end(qtbot, shared_window, stored_run, damaged):
    """It had been tried once, in the middle."""
    window, control = shared_window, shared_window.time_line
    folder = damaged(2)
    newest = folder / "frame_0002.h5"
    newest.unlink()
    assert window.open_file(folder)
    window.frame_bar.follow_check.setChecked(True)
    whole = stored_run.paths_of_files[2].read_bytes()
    newest.write_bytes(whole[:len(whole) // 2])
    control.look()
    qtbot.waitUntil(lambda: "frame_0002.h5" in window.banner.text() and not control.is_busy, timeout=PATIENCE_MS)
    control.look()
    assert not control.is_busy  # nothing new in it
    newest.write_bytes(whole)
    control.look()
    wait_for(qtbot, window, 2)
    window.settle()
    assert window.banner.isHidden()
    strip = window.frame_bar.strip  # nor does its column stay empty
    qtbot.waitUntil(lambda: np.isfinite(level_image(strip._glances, "range")[0]).all(axis=0).tolist() == [True, True, True],
                    timeout=PATIENCE_MS)
    window.frame_bar.follow_check.setChecked(False)
    control.show(None)


def test_f5_reads_the_frame_on_display_anew(qtbot, shared_window, stored_run, tmp_path):
    """A folder of frames, of which one is written anew."""
    window = shared_window
    for number, path in enumerate(stored_run.paths_of_files):
        shutil.copy(path, tmp_path / f"f{number}.h5")
    assert window.open_file(tmp_path)
    open_on_screen(qtbot, window)
    window.next_frame()
    wait_for(qtbot, window, 1)
    other = ep.simulate(window.session.paths.scene, window.session.radar, num_rays=100, start_time=stored_run.times[1])
    assert len(other.paths) != len(window.session.paths)
    ep.save_frame(other, tmp_path / "f1.h5")
    qtbot.keyClick(window, Qt.Key.Key_F5)
    qtbot.waitUntil(lambda: len(window.session.paths) == len(other.paths), timeout=PATIENCE_MS)
    assert window.time_line.place == 1
    window.time_line.show(None)


def test_one_file_has_no_frame_bar(qtbot, line_window, stored_run):
    assert line_window.frame_bar.isVisible()
    line_window.open_file(stored_run.paths_of_files[0])
    assert not line_window.frame_bar.isVisible() and line_window.time_line.line is None
    line_window.next_frame()  # there is none


def test_a_simulated_sequence_opens(qtbot, moving_sequence):
    window = ep.view(moving_sequence, block=False)
    folder = window.time_line.line.moments[0].path.parent
    try:
        assert window.frame_bar.isVisible() and window.time_line.line.expected == 3
    finally:
        window.close()
    assert not folder.exists()


def test_files_that_go_away_are_told_and_found_again(qtbot, shared_window, stored_run, tmp_path):
    window, control, folder, told = shared_window, shared_window.time_line, tmp_path / "frames", []
    folder.mkdir()
    for path in stored_run.paths_of_files:
        shutil.copy(path, folder)
    assert window.open_file(folder)
    control._poll.stop()
    control.failed.connect(told.append)
    control.go(1)
    wait_for(qtbot, window, 1)
    folder.rename(tmp_path / "elsewhere")
    for _ in range(2):
        control.look()
    assert len(told) == 1 and told[0].startswith(f"{folder}: its files are gone")
    control.step(1)
    window.toggle_play_frames()
    qtbot.waitUntil(lambda: not control.is_playing, timeout=PATIENCE_MS)
    assert control.place == 1 and "files are gone" in window.banner.text()
    (tmp_path / "elsewhere").rename(folder)
    control.look()
    assert control.place == 1 and len(control.line) == 3
    control.step(1)
    wait_for(qtbot, window, 2)
    control.failed.disconnect(told.append)
    window.show_message("")
    control.show(None)


def test_what_keeps_frames_from_being_found_is_told_once(qtbot, line_window, monkeypatch):
    control, told = line_window.time_line, []

    def refuse():
        raise ep.FileError("dataset.toml: cannot be read")

    monkeypatch.setattr(control.line, "_find", refuse)
    control.failed.connect(told.append)
    for _ in range(3):
        control.look()
    control.failed.disconnect(told.append)
    assert told == ["dataset.toml: cannot be read"] and control.place == 0
    line_window.show_message("")
