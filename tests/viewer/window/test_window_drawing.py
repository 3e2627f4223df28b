"""What is drawn when, and keys and drops that reach the right widget."""
from __future__ import annotations

import time

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox, Filters, Legend, from_paths
from echopath_viewer.window.qt import Qt, QtCore, QtGui, QtWidgets
from echopath_viewer.window.scene.filter_box import ErrorLabel
from echopath_viewer.window.scene.legend_box import LegendBox
from echopath_viewer.window.scene.name_box import NameBox
from echopath_viewer.window.scene.pace import Smoothing
from support.window import PATIENCE_MS, panel_of, settle

SLOW_PICTURE = 0.12  # s: longer than a step of the film
WHOLE_KEY = ("whole", "whole")


@pytest.fixture
def pictures(window):
    """A list that grows with each picture that VTK draws."""
    drawn, renderer = [], window.view3d.renderer
    tag = renderer.AddObserver("EndEvent", lambda *_: drawn.append(window.session.chirp))
    yield drawn
    renderer.RemoveObserver(tag)


def wait_for_pictures(qtbot, window) -> None:
    qtbot.waitUntil(lambda: not window.view3d.is_behind() and not window._listing.isActive(), timeout=PATIENCE_MS)
    settle(qtbot)


def test_each_change_is_drawn_once(qtbot, window, pictures):
    wait_for_pictures(qtbot, window)
    pictures.clear()
    window.session.set_chirp(3)
    wait_for_pictures(qtbot, window)
    assert pictures == [3]


def test_a_turn_of_the_camera_is_drawn_once(qtbot, window, pictures):
    wait_for_pictures(qtbot, window)
    pictures.clear()
    window.view3d.iren.interactor.Render()  # what VTK's styles call
    wait_for_pictures(qtbot, window)
    assert len(pictures) == 1


def widest_loss(view) -> float:
    """Pixels between the ends of any leg of the rays that are drawn and those of the drawn leg that is most like it."""
    segments, clip = view.builder.rays.segments, view.clip_from_world()

    def on_screen(points):
        at = np.column_stack([points, np.ones(len(points))]) @ clip.T
        return (at[:, :2] / at[:, 3:] * (view.width() / 2, view.height() / 2)).reshape(-1, 2, 2)
    wanted = on_screen(segments.points[segments.ends[:segments.num_segments_of(view._pace.num_rays)]].reshape(-1, 3))
    drawn = on_screen(view.builder.rays._rays.GetMapper().GetInput().points)
    both = np.concatenate([drawn, drawn[:, ::-1]])
    return max(np.abs(both - leg).max(axis=(1, 2)).min() for leg in wanted)


def test_near_legs_are_told_apart_while_the_camera_moves_and_looks_far_away(qtbot, window, monkeypatch):
    view, camera = window.view3d, window.view3d.camera
    wait_for_pictures(qtbot, window)
    pace = view._turning
    monkeypatch.setattr(pace, "follow", lambda *_: False)
    monkeypatch.setattr(pace, "begin", lambda: None)
    pace.num_rays, pace.coarseness = 500, 3
    counts = []
    for position in ((-400.0, 10.0, 2.0), (-5.0, 0.0, 0.5), (-2.0, 0.3, 0.5), (2.0, 0.0, 0.2)):
        camera.position, camera.focal_point, camera.view_angle = position, (500.0, 0.0, 0.0), 30.0
        if view._pace is None:
            view.set_moving(pace)
        view.reset_camera_clipping_range()
        view.render_soon()  # as while a button is held: no motion begins or ends
        wait_for_pictures(qtbot, window)
        counts.append(view.builder.rays._rays.GetMapper().GetInput().n_lines)
        if position[0] < 0.0:
            assert widest_loss(view) <= pace.coarseness
    segments = view.builder.rays.segments
    legs = segments.points[segments.ends[:segments.num_segments_of(500)]].tolist()
    assert counts == sorted(counts) and counts[0] < counts[-1] == len({frozenset(map(tuple, leg)) for leg in legs})
    view.set_moving(None)
    window.look_fit()


def test_the_film_shows_every_step_however_slow_its_pictures_are(qtbot, window, pictures):
    wait_for_pictures(qtbot, window)
    tag = window.view3d.renderer.AddObserver("StartEvent", lambda *_: time.sleep(SLOW_PICTURE))
    window.time_bar.slider.setValue(0)
    pictures.clear()
    window.time_bar.play_button.setChecked(True)
    try:
        qtbot.waitUntil(lambda: window.session.chirp >= 4, timeout=PATIENCE_MS)
    finally:
        window.time_bar.play_button.setChecked(False)
        window.view3d.renderer.RemoveObserver(tag)
    assert {1, 2, 3} <= set(pictures)


def test_the_film_waits_for_the_picture_of_its_last_step(qtbot, window):
    wait_for_pictures(qtbot, window)
    window.session.set_chirp(3)
    assert window.view3d.is_behind()
    window.time_bar._timer.timeout.emit()
    assert window.session.chirp == 3
    wait_for_pictures(qtbot, window)
    window.time_bar._timer.timeout.emit()
    assert window.session.chirp > 3


def test_a_step_in_time_selects_no_paths_anew(qtbot, window, monkeypatch):
    window.session.select_cells(CellBox(0, 60, 0, 31))
    window.session.select_ray(int(window.session.lit_rays(1)[0]))
    copied = []
    monkeypatch.setattr("echopath_viewer.model.rays.segments.subset", lambda *_: copied.append(True))
    window.session.set_chirp(7)
    assert not copied


@pytest.mark.filterwarnings("ignore:.*QDragEnterEvent:DeprecationWarning")
def test_a_file_dropped_on_the_scene_is_opened_by_the_window(qtbot, window, monkeypatch, tmp_path):
    opened = []
    monkeypatch.setattr(window, "open_file", lambda path: opened.append(path))
    (tmp_path / "frame.h5").touch()  # pyvistaqt would take what is a file
    data = QtCore.QMimeData()
    data.setUrls([QtCore.QUrl.fromLocalFile(str(tmp_path / "frame.h5"))])
    for widget in (window.view3d, window.filter_box.expression_edit, panel_of(window, *WHOLE_KEY)):
        at = QtCore.QPointF(widget.mapTo(window, widget.rect().center()))
        for kind in (QtGui.QDragEnterEvent, QtGui.QDropEvent):
            place = at.toPoint() if kind is QtGui.QDragEnterEvent else at
            event = kind(place, Qt.DropAction.CopyAction, data, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)
            QtWidgets.QApplication.sendEvent(window.windowHandle(), event)
    assert opened == [str(tmp_path / "frame.h5")] * 3


def test_a_change_of_another_widget_does_not_touch_the_scene(qtbot, window):
    """Else it has the whole window composed with OpenGL, as slow as a picture where there is no graphics card."""
    if QtGui.QGuiApplication.platformName() != "xcb":
        pytest.skip("the scene has a window of its own on X11 alone")
    wait_for_pictures(qtbot, window)
    swapped = []
    window.view3d.frameSwapped.connect(lambda: swapped.append(True))
    for value in range(20, 60, 5):
        window.filter_box.hits_check.setText(str(value))
        settle(qtbot)
    window.filter_box.hits_check.setText("hit points")
    assert not swapped
    window.view3d.render_soon()
    wait_for_pictures(qtbot, window)
    assert swapped


def test_space_on_a_check_box_checks_it(qtbot, window):
    check = window.filter_box.hits_check
    check.setFocus()
    qtbot.keyClick(check, Qt.Key.Key_Space)
    assert check.isChecked() and not window.time_bar.play_button.isChecked()
    window.view3d.setFocus()  # which has no use for it itself
    qtbot.keyClick(window.view3d, Qt.Key.Key_Space)
    assert window.time_bar.play_button.isChecked()
    window.time_bar.play_button.setChecked(False)


def test_the_tree_is_opened_and_its_meshes_are_chosen_by_keys(qtbot, window):
    tree, chirp = window.tree, window.session.chirp
    walker = tree.topLevelItem(0)
    tree.setFocus()
    tree.setCurrentItem(walker)
    for key, is_open in ((Qt.Key.Key_Left, False), (Qt.Key.Key_Right, True)):
        qtbot.keyClick(tree, key)
        assert walker.isExpanded() == is_open and window.session.chirp == chirp
    qtbot.keyClick(tree, Qt.Key.Key_Down)
    qtbot.keyClick(tree, Qt.Key.Key_Return)
    assert window.session.node == "walker/head"
    window.session.select_node(None)
    window.view3d.setFocus()


def test_rows_of_the_tree_are_found_by_a_part_of_their_names(qtbot, window):
    tree, edit = window.tree, window.scene_box.find_edit
    tree.collapseAll()
    rows = {name: tree._items[name] for name in ("walker", "walker/head", "walker/legs", "wall_left", "wall_right")}

    def shown() -> set:
        return {name for name, item in rows.items() if not item.isHidden()}

    qtbot.keyClick(window, Qt.Key.Key_F, Qt.KeyboardModifier.ControlModifier)
    assert edit.hasFocus()
    for text, found, is_open in (("LEG", {"walker", "walker/legs"}, True), ("wal", set(rows), False), ("none", set(), False),
                                 ("r/h", {"walker", "walker/head"}, True)):
        tree.collapseAll()
        edit.setText(text)
        qtbot.keyClick(edit, Qt.Key.Key_Return)
        assert shown() == found and rows["walker"].isExpanded() == is_open
    assert tree.hasFocus() and tree.currentItem() is rows["walker/head"]
    window.show_input(from_paths(None, window.session.paths))
    rows = {name: tree._items[name] for name in rows}
    assert shown() == {"walker", "walker/head"}  # those of the next frame, too
    edit.setFocus()
    qtbot.keyClick(edit, Qt.Key.Key_Escape)
    settle(qtbot)
    qtbot.waitUntil(lambda: shown() == set(rows), timeout=PATIENCE_MS)
    window.view3d.setFocus()


def test_the_mouse_tells_the_whole_name_of_a_row_of_the_tree(window):
    assert window.tree.topLevelItem(0).child(0).toolTip(0).startswith("walker/head\n")


def test_messages_of_the_path_field_are_shown_whole(qtbot):
    label = ErrorLabel()
    qtbot.addWidget(label)
    label.resize(190, 100)
    label.show()
    what = "there is no mesh that the glob takes, which is written in quotes; the nearest names are others " * 2
    label.setText(f"path expression: {what}\n{'T .* ' * 20}'nobody' R\n{' ' * 100}^")
    qtbot.wait(20)
    text = label._where
    assert text.fontMetrics().horizontalAdvance(text.text().split("\n")[0]) <= 190 and "^" in text.text()
    assert label._what.height() >= label._what.heightForWidth(label._what.width())


def test_rays_over_hidden_meshes_are_not_drawn(qtbot, window):
    session = window.session
    wall = session.mesh_names.index("wall_left")
    session.set_mesh_visible([wall], False)
    settle(qtbot)
    drawn = window.view3d.builder.rays.segments
    assert drawn.num_segments and wall not in drawn.hit_mesh
    over = np.asarray(ep.hits("wall_left").matches(session.paths))
    assert not over[session.shown_rays()].any() and session.visible[over].any()  # filters do not change
    session.set_mesh_visible([wall], True)
    assert over[session.shown_rays()].any()


def test_cells_without_rays_say_why(qtbot, window):
    session, text = window.session, window.filter_box.count_label.text
    empty = np.argwhere(np.array([[not session.index.mask_of(CellBox(r, r, v, v)).any() for r in range(0, 128, 9)]
                                  for v in range(0, 32, 5)]))[0]
    velocity, distance = int(empty[0]) * 5, int(empty[1]) * 9
    session.select_cells(CellBox(distance, distance, velocity, velocity))
    settle(qtbot)
    assert "no ray lies there" in text() and "side lobes" in text()
    session.set_part(("route", "ghost"))
    only_direct = np.flatnonzero((session.columns.cell >= 0) & ~session.part.mask)
    box = next(CellBox(*(cell[0],) * 2, *(cell[1],) * 2) for cell in map(session.cell_of, map(int, only_direct))
               if not (session.visible & session.index.mask_of(CellBox(*(cell[0],) * 2, *(cell[1],) * 2))).any())
    session.select_cells(box)
    settle(qtbot)
    assert "leave them out" in text()


def test_a_peak_beyond_the_view_sets_no_colours(qtbot, window):
    session, area = window.session, window.map_area
    level, spectrum = session.parts.whole.level(0, 0), session.parts.whole.spectrum
    column = len(spectrum.range) - 20  # far behind all echoes
    area.set_view(QtCore.QRectF(spectrum.range[column], spectrum.velocity[0], spectrum.range[-1] - spectrum.range[column],
                                spectrum.velocity[-1] - spectrum.velocity[0]))
    seen = float(level[:, column:].max())
    assert seen <= area.colour_bar.limits[1] < seen + 5.0 < level.max()
    assert panel_of(window, *WHOLE_KEY).limits == area.colour_bar.limits
    area.set_view(area.whole_view)


def test_a_click_on_a_row_of_the_legend_shows_that_object_alone(qtbot, window):
    session, legend = window.session, window.view3d.legend_box
    session.set_color_by("mesh")
    settle(qtbot)
    assert legend.isVisible() and [label for label, _ in legend.legend.rows] == ["walker", "wall_left", "wall_right"]
    line = legend._line()
    for shown in ({0, 1}, {0, 1, 2, 3}):
        qtbot.mouseClick(legend, Qt.MouseButton.LeftButton, pos=QtCore.QPoint(20, 8 + line + line // 2))
        assert set(range(4)) - session.hidden_meshes == shown


@pytest.mark.parametrize("mode", ["power", "range", "speed"])
def test_no_ray_has_no_scale(qtbot, window, mode):
    """One from 0 to 1, in colours of speeds towards and away, had stood beside rays without a colour."""
    window.session.set_color_by(mode)
    settle(qtbot)
    legend = window.view3d.legend_box
    assert legend.isVisible() and legend.legend.clim is not None
    window.session.set_filters(Filters(min_bounces=60))
    settle(qtbot)
    assert not legend.isVisible()
    window.session.set_filters(Filters())
    settle(qtbot)
    assert legend.isVisible()


def test_edges_are_smooth_on_a_quick_machine(qtbot, window, monkeypatch):
    wait_for_pictures(qtbot, window)
    coarse = shades_of(window)
    monkeypatch.setattr("echopath_viewer.window.scene.pace.INSTANT", 10.0)
    monkeypatch.setattr("echopath_viewer.window.scene.pace.QUICK", 10.0)
    window.view3d._smoothing = Smoothing()
    for _ in range(6):
        window.view3d.render_soon()
        wait_for_pictures(qtbot, window)
    assert window.view3d.render_window.GetMultiSamples() == 4 and shades_of(window) > 1.2 * coarse
    window.view3d.render_window.SetMultiSamples(0)
    window.view3d._smoothing = Smoothing()


def shades_of(window) -> int:
    """How many colours the scene has: smooth edges have those between two."""
    image = window.view3d.grab().toImage().convertToFormat(QtGui.QImage.Format.Format_RGB32)
    pixels = np.frombuffer(image.constBits(), np.uint32)
    return len(np.unique(pixels))


def test_the_title_of_a_scale_in_the_window_stands_over_none_of_its_labels(qtbot):
    parent, pictures = QtWidgets.QWidget(), []
    qtbot.addWidget(parent)
    box = LegendBox(parent)
    for title in (" ", "Power in dBm"):
        box.show(Legend(title, clim=(-140.0, -100.0), cmap="viridis"))
        image = box.grab().toImage().convertToFormat(QtGui.QImage.Format.Format_RGB888)
        rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
        pictures.append(rows[:, :3 * image.width()].reshape(image.height(), image.width(), 3).astype(int))
    is_title = np.abs(pictures[1] - pictures[0]).max(axis=-1) > 60
    assert is_title.sum() > 50 and pictures[0][is_title].min() > 200


def test_a_window_that_does_not_come_to_rest_says_what_is_late(window, monkeypatch):
    monkeypatch.setattr(window.view3d, "is_behind", lambda: True)
    with pytest.raises(TimeoutError, match=r"within 0.1 s, but late are: scene$"):
        window.settle(patience=0.1)


def test_a_picture_that_was_asked_for_in_vain_is_asked_for_again(window, monkeypatch):
    asked_for = []
    window.settle()
    monkeypatch.setattr(type(window.view3d), "update", lambda self: asked_for.append(self))
    window.view3d.render_soon()
    assert asked_for and window.view3d.is_behind()
    asked_for.clear()
    with pytest.raises(TimeoutError):
        window.settle(patience=1.0)
    assert asked_for


def test_the_legend_over_the_rays_is_dark_in_a_dark_theme(qtbot):
    for paper, ink in (("#ffffff", "#000000"), ("#19191c", "#ffffff")):
        parent = QtWidgets.QWidget()
        qtbot.addWidget(parent)
        palette = parent.palette()
        palette.setColor(palette.ColorRole.Base, QtGui.QColor(paper))
        palette.setColor(palette.ColorRole.Text, QtGui.QColor(ink))
        palette.setColor(palette.ColorRole.Window, QtGui.QColor(paper))
        parent.setPalette(palette)
        box = LegendBox(parent)
        box.show(Legend("Object", rows=(("wall", (200, 30, 30)),)))
        grey = box.grab().toImage().convertToFormat(QtGui.QImage.Format.Format_Grayscale8)
        levels = {grey.pixelColor(x, y).red() for x in range(grey.width()) for y in range(grey.height())}
        assert abs(grey.pixelColor(1, 1).red() - QtGui.QColor(paper).red()) < 8
        assert min(abs(level - QtGui.QColor(ink).red()) for level in levels) < 8


CLIP_FROM_WORLD = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0], [0, 0, -1, 2]])  # an eye at z = 2, which looks down


@pytest.fixture
def name_box(qtbot):
    parent = QtWidgets.QWidget()
    qtbot.addWidget(parent)
    parent.resize(600, 400)
    parent.show()
    yield NameBox(parent)


def lay_out(box, **names) -> list:
    """What stands there of layers {name: place}."""
    for layer, places in names.items():
        box.set_names(layer, list(places.values()), list(places))
    box.follow(CLIP_FROM_WORLD)
    return [text for _, text in box.boxes]


def test_names_in_the_scene_stay_inside_of_it_and_keep_both_ends(name_box):
    """Long ones had run out of its right border."""
    shown = lay_out(name_box, objects={"Haus Süd 3 – Kastanienallee 17 (Gebäudemodell LoD3, Stand 2024)": (0.97, 0.0, 1.0),
                                       "car": (-1.0, 1.0, 1.0), "behind the eye": (0.0, 0.0, 3.0), "beside": (1.5, 0.0, 1.0)})
    assert all(name_box.parent().rect().contains(place) for place, _ in name_box.boxes)
    short, long = sorted(shown, key=len)
    assert short == "car" and long.startswith("Haus Süd") and long.endswith("2024)") and "…" in long


def test_names_in_any_letters_stand_in_the_scene(name_box):
    """Those of VTK are Latin, Greek and Cyrillic: others had been left out of names without a word."""
    assert lay_out(name_box, objects={"北側の家": (0.0, 0.0, 1.0)}) == ["北側の家"]
    grey = name_box.grab().toImage().convertToFormat(QtGui.QImage.Format.Format_Grayscale8)
    place = name_box.boxes[0][0]
    levels = [grey.pixelColor(x, y).red() for x in range(place.left(), place.right()) for y in range(place.top(), place.bottom())]
    assert max(levels) - min(levels) > 100  # letters, or the signs of a machine without such a font


def test_a_name_of_two_layers_stands_in_the_scene_once_and_on_no_other(name_box):
    objects = {"car": (0.0, 0.0, 1.0), "van": (0.0, 0.01, 1.2), "person": (0.5, 0.5, 1.0)}
    shown = lay_out(name_box, objects=objects, boxes={"car": (-0.5, -0.5, 1.0)})
    assert set(shown) == {"van", "person"}  # the van is nearer to the eye than the car
    assert set(lay_out(name_box, chosen={"1 wall": (0.0, 0.0, 0.0)})) == {"1 wall", "person"}
    name_box.forget()
    assert lay_out(name_box) == [] and name_box.isHidden()


def test_long_names_leave_room_beside_the_legend(qtbot):
    parent = QtWidgets.QWidget()
    qtbot.addWidget(parent)
    parent.resize(600, 400)
    legend = LegendBox(parent)
    names = [f"Basic Wall:Interior - 135mm Partition (2-hr):{number}:IfcWallStandardCase:long" * 2 for number in range(3)]
    legend.show(Legend("Object that the ray goes to", rows=tuple((name, (9, 99, 199)) for name in names)))
    assert legend.width() <= 0.5 * parent.width() and legend.geometry().right() <= parent.width()
    assert not legend.grab().isNull()
