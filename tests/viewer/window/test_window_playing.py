"""What is done in the window while a time line plays: clicks, filters, other files, films."""
from __future__ import annotations

from contextlib import contextmanager

import pytest

import echopath as ep
from echopath_viewer.model import CellBox, Filters
from echopath_viewer.window.files.exporting import film_pictures
from support import shapes
from support.window import PATIENCE_MS, held, open_on_screen, settle


@pytest.fixture
def playing(qtbot, shared_window, stored_run):
    """Window whose time line plays; the second of three frames has passed and the film waits."""
    with played(qtbot, shared_window, stored_run.path) as window:
        yield window


@contextmanager
def played(qtbot, window, folder):
    """Window that plays a folder, None: that which is open; its second frame has passed; tests say when the next one comes."""
    if folder is not None:
        window.open_file(folder)
        open_on_screen(qtbot, window)
    control = window.time_line
    with held(control._film, control._rest):
        window.toggle_play_frames()
        try:
            pass_to(qtbot, window, 1)
            yield window
        finally:
            control.show(None)


def pass_to(qtbot, window, place: int) -> None:
    control = window.time_line
    control.go(place)
    qtbot.waitUntil(lambda: control.place == place and not control.is_busy, timeout=PATIENCE_MS)
    assert control.is_playing and window._is_passing and window.view3d._pace is not None
    assert not window.view3d.renderer.GetUseOIT()


def test_what_becomes_live_ends_the_film_and_stays(qtbot, playing):
    """The frame that is being read then had taken its place, and the panel had stopped without a word."""
    window, panel = playing, playing.live_panel
    panel.rays_box.setValue(500)
    window.time_line.go(2)
    panel.start_button.click()
    assert window.live.is_on and not window.time_line.is_playing and not window.time_line.is_busy
    settle(qtbot)
    assert window.live.is_on and panel.start_button.isChecked()
    panel.stop()


def test_another_file_that_is_opened_is_drawn_whole(playing, stored_run):
    playing.open_file(stored_run.paths_of_files[0])
    assert not playing.time_line.is_playing and playing.view3d._pace is None
    playing.settle()
    meshes = playing.view3d.builder.meshes
    assert all(actor.GetVisibility() for actor in meshes.actors) and not meshes._is_quick
    assert playing.view3d.renderer.GetUseOIT()


def test_rays_that_a_film_drew_are_not_drawn_whole_before_another_file(playing, stored_run):
    before = playing.view3d.builder
    before.show_first_rays(3, 0.0)
    drawn = before.rays._rays.GetMapper().GetInput()
    playing.open_file(stored_run.paths_of_files[0])
    playing.settle()
    assert playing.view3d.builder is not before and before.rays.segments.num_segments > drawn.n_lines
    assert before.rays._rays.GetMapper().GetInput() is drawn


def test_a_row_of_what_made_a_cell_is_not_there_for_another_frame(qtbot, shared_window, stored_run):
    window, panel = shared_window, shared_window.contributions
    window.open_file(stored_run.path)
    open_on_screen(qtbot, window)
    window.docks["What makes the cell"].raise_()
    window.session.select_cells(CellBox(3, 9, 2, 9))
    qtbot.waitUntil(lambda: window.session.attribution is not None and panel.table.rowCount() > 0, timeout=PATIENCE_MS)
    with played(qtbot, window, None):
        assert panel.table.rowCount() == 0 and panel._rows == [] and panel.title.text().startswith("Pause the frames")
        panel.table.selectRow(0)
        window.session.select_cells(CellBox(4, 8, 3, 8))  # another cell is not told of either
        settle(qtbot)
        assert panel._rows == [] and not panel.work.is_running
        window.toggle_play_frames()
        qtbot.waitUntil(lambda: panel.table.rowCount() > 0, timeout=PATIENCE_MS)
        window.session.attribution = None  # as of a preview of a live scene
        window._take(window.session, is_passing=True)
        assert panel._rows == [] and panel.title.text().startswith("What makes the cell is told when nothing moves")


@pytest.fixture(scope="module")
def other_scenes(moving_sequence, tmp_path_factory):
    """Folder of frames of four objects, of two others, and of the first of these alone."""
    folder = tmp_path_factory.mktemp("scenes")
    for number, names in enumerate((("a", "b", "c", "d"), ("e", "a"), ("e",))):
        scene = ep.Scene()
        for place, name in enumerate(names):
            scene.add(shapes.plate((5.0 + place, 2.0 * place - 3.0, 0.0), (-1.0, 0.0, 0.0), 0.8), name=name,
                      material=shapes.lambert(0.8))
        frame = ep.simulate(scene, moving_sequence.radar, num_rays=2000, max_bounces=1, seed=1, start_time=0.1 * number)
        frame.save(folder / f"frame_{number:04}.h5")
    return folder


def test_filters_that_change_while_other_scenes_pass_count_the_objects_of_the_frame(qtbot, shared_window, other_scenes):
    with played(qtbot, shared_window, other_scenes) as window:
        for place in (1, 2):
            pass_to(qtbot, window, place)
            window.session.set_filters(Filters(max_bounces=1))
            settle(qtbot)
            counts = {node.name: f"{count:,}" for node, count in zip(window.session.scene.nodes, window.session.node_counts())}
            assert {name: item.text(1) for name, item in window.tree._items.items()} == counts


def test_a_frame_whose_next_one_is_long_in_coming_is_shown_whole(qtbot, playing):
    window, control = playing, playing.time_line
    assert control._rest.isActive() and control._rest.isSingleShot()
    window.settle()
    control._rest.timeout.emit()
    assert control.is_playing and not window._is_passing and window.view3d._pace is None
    counts = {node.name: f"{count:,}" for node, count in zip(window.session.scene.nodes, window.session.node_counts())}
    assert {name: item.text(1) for name, item in window.tree._items.items()} == counts
    pass_to(qtbot, window, 2)
    window.toggle_play_frames()
    assert not control._rest.isActive() and not window._is_passing


def test_a_film_that_waits_tells_what_makes_the_cell(qtbot, playing):
    window, panel = playing, playing.contributions
    window.docks["What makes the cell"].raise_()
    window.session.select_cells(CellBox(3, 9, 2, 9))
    qtbot.waitUntil(lambda: panel.title.text().startswith("Pause the frames"), timeout=PATIENCE_MS)
    assert not panel.work.is_running
    window.time_line._rest.timeout.emit()
    qtbot.waitUntil(lambda: panel.table.rowCount() > 0, timeout=PATIENCE_MS)
    assert window.time_line.is_playing and "dBm" in panel.title.text()
    pass_to(qtbot, window, 2)
    assert panel.table.rowCount() == 0 and panel.title.text().startswith("Pause the frames") and not panel.work.is_running


def test_a_frame_that_is_still_to_be_drawn_does_not_rest(playing, monkeypatch):
    monkeypatch.setattr(playing.time_line, "_is_behind", lambda: True)
    playing.time_line._rest.stop()
    playing.time_line._rest.timeout.emit()
    assert playing._is_passing and playing.time_line._rest.isActive()


def test_an_exported_film_has_all_frames_whole_though_the_time_line_plays(playing):
    seen = []
    for _ in film_pictures(playing):
        seen.append((playing.time_line.place, playing._is_passing, playing.view3d._pace))
    assert seen == [(place, False, None) for place in range(3)]
    playing.settle()
    assert playing.time_line.place == 1 and not playing.time_line.is_playing
