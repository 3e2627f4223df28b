"""The window of the viewer."""
from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

import echopath as ep
from echopath.files import written_whole
from echopath.origin import origin_texts

from ..model import COLOUR_MODES, Session, from_file, from_frame
from ..model.history import History
from ..model.layers import DETECTIONS, LABELS, LAYERS, OBJECTS, TRUTH
from ..model.view_state import apply_state, load_state, save_state, state_of
from ..scene_builder import VIEWS, export_meshes, export_rays
from .busy import run_with_progress
from .contributions import ContributionsPanel
from .demo import simulate_demo
from .empty_page import EmptyPage
from .filter_box import FilterBox
from .keys import KEYS, help_dialog, uses_key
from .map_area import MapArea
from .qt import Qt, QtCore, QtGui, QtWidgets
from .ray_table import RayTable
from .remembered import recent_files, remember_file, remember_layout, restore_layout
from .scene_tree import SceneTree
from .time_bar import TimeBar
from .view3d import View3D

TITLE = "Echopath"
SIZE = (1600, 960)
VIEW_TITLES = {"radar": "Radar's eye", "top": "Top", "side": "Side", "fit": "Fit"}
LAYER_WORDS = {LABELS: "Cells of the map by the part that dominates", OBJECTS: "Cells of objects and of their ghosts",
               DETECTIONS: "Detections in the map and, with directions, in the scene",
               TRUTH: "True centres in the map, true boxes in the scene"}
CONTENT_PAGE, EMPTY_PAGE = 0, 1
SIGNAL_PAUSE_MS = 250  # without changes, before signals of what is chosen are made: longer work than a step of a box


class MainWindow(QtWidgets.QMainWindow):
    """Scene tree and filters, 3-D view with its time bar, maps and table: all views of one session."""

    def __init__(self, remembers: bool = True):
        """remembers: whether its sizes are those of the last time, and those of the next."""
        super().__init__()
        self.session, self._remembers = None, remembers
        self.setWindowTitle(TITLE)
        self.resize(*SIZE)
        self.setAcceptDrops(True)
        self.tree, self.filter_box, self.view3d = SceneTree(), FilterBox(), View3D(self)
        self.time_bar, self.map_area, self.table = TimeBar(), MapArea(), RayTable()
        self.contributions, self.tabs = ContributionsPanel(), QtWidgets.QTabWidget()
        self.time_bar.is_behind = self.view3d.is_behind
        self.banner, self.empty_page = Banner(), EmptyPage()
        self._listing = QtCore.QTimer(self, singleShot=True, interval=0)
        self._pause = QtCore.QTimer(self, singleShot=True, interval=SIGNAL_PAUSE_MS)
        self._stale, self._signal_of = set(), None
        self._arrange()
        self._add_actions()
        self._connect()
        self._set_content_shown(False)
        if remembers:
            restore_layout(self, self._splitters)

    # --- frames ---

    def open_file(self, path) -> bool:
        """Shows a frame file, or says above what was shown before what is wrong with it."""
        try:
            self.show_input(from_file(path))
        except (ep.FileError, ValueError) as error:
            self.show_message(str(error))
            return False
        remember_file(path)
        return True

    def show_input(self, view_input) -> None:
        """Shows what `model.inputs` has read, and the window: there is no drawing into one that was never shown."""
        self.session, self.history = Session(view_input), History()
        self.show_message("")
        self._set_content_shown(True)
        self.show()
        for part in (self.tree, self.filter_box, self.map_area, self.time_bar):
            part.show_session(self.session)
        self.view3d.show_session(self.session)
        self.view3d.builder.set_show_hits(self.filter_box.hits_check.isChecked())
        self.table.show_session(self.session)
        self.contributions.show_session(self.session)
        self._show_layer_checks()
        self.view3d.setFocus()  # so that the arrow keys step through the chirps
        self._show_slow_time()
        self.session.listen(self._changed)
        self.history.record(state_of(self.session))
        self.setWindowTitle(f"{self.session.title or 'paths'} - {TITLE}")

    def show_message(self, text: str) -> None:
        """Shows a line above everything until it is clicked away; "" takes it away."""
        self.banner.setText(text)
        self.banner.setVisible(bool(text))

    def _simulate_demo(self) -> None:
        frame = run_with_progress(self, "Street demo", simulate_demo)
        if frame is not None:
            self.show_input(from_frame(frame, title="street demo"))

    # --- following the session ---

    def _changed(self, topics: set) -> None:
        """At once for what moves with the mouse; lists and counts when this turn of the event loop is over."""
        self.view3d.update_topics(topics)
        self.map_area.update_topics(topics)
        if "time" in topics:
            self.time_bar.read(self.session)
        self._stale |= topics
        self._listing.start()

    def _refresh_lists(self) -> None:
        stale, self._stale = self._stale, set()
        if stale & {"rays", "meshes"}:
            self.tree.refresh()
        if stale & {"rays", "selection"}:
            self.table.show_session(self.session)
        if "selection" in stale:
            self.contributions.refresh()
        if stale & {"rays", "selection", "colours"}:
            self.filter_box.show_counts()
        if stale & {"selection", "rays"}:
            self._pause.start()
        if not self.time_bar.play_button.isChecked():
            self.history.record(state_of(self.session))

    def _refresh_signals(self) -> None:
        """What takes synthesis: the map of the selected mesh, and the slow-time signal where it is of other rays now."""
        self._work_on_node(f"Map of {self.session.node}", self.session.refresh_node)
        lit, channel, of = self.session.lit, self.session.channel, self._signal_of
        if of is None or of[1] != channel or not _same_rays(of[0], lit):
            self._show_slow_time()

    def _show_slow_time(self) -> None:
        session = self.session
        self._signal_of = session.lit, session.channel
        title = f"Power by chirp, {'everything' if session.box is None else 'the selected rays'}"
        try:
            power = run_with_progress(self, "Signal of the selected rays", session.slow_time_power)
        except ValueError as error:
            power, title = [], str(error)
        if power is not None:
            self.time_bar.show_power(power, title)

    def _choose_node(self, name: str) -> None:
        wanted = None if name == self.session.node else name
        self._work_on_node(f"Map of {name}", lambda progress: self.session.select_node(wanted, progress))

    def _work_on_node(self, title: str, work) -> None:
        try:
            run_with_progress(self, title, work)
        except ValueError as error:
            self.show_message(str(error))

    def _isolate(self, name: str) -> None:
        """Shows the object of a row of the legend alone, or everything where it is alone already."""
        session = self.session
        meshes = {mesh for mesh, full_name in enumerate(session.mesh_names) if f"{full_name}/".startswith(f"{name}/")}
        others = set(range(len(session.mesh_names))) - meshes
        if not meshes:
            return
        is_alone = session.hidden_meshes == others
        session.set_mesh_visible(others, is_alone)
        session.set_mesh_visible(meshes, True)

    def _name_part(self, name: str) -> None:
        self.filter_box.apply()
        try:
            part = run_with_progress(self, f"Map of {name}", lambda progress: self.session.add_part(name, progress))
        except ValueError as error:
            self.filter_box.show_name_error(str(error))
            return
        self.filter_box.show_name_error("")
        if part is not None:
            self.filter_box.name_edit.clear()

    def _only_over(self, name: str) -> None:
        self.session.set_filters(dataclasses.replace(self.session.filters, mesh=name))
        self.filter_box.read(self.session)

    # --- actions, by the names in keys.py ---

    def look_fit(self) -> None:
        self.view3d.look("fit")

    def look_radar(self) -> None:
        self.view3d.look("radar")

    def look_top(self) -> None:
        self.view3d.look("top")

    def look_side(self) -> None:
        self.view3d.look("side")

    def toggle_hits(self) -> None:
        self.filter_box.hits_check.toggle()

    def next_colour(self) -> None:
        box = self.filter_box.colour_box
        box.setCurrentIndex((box.currentIndex() + 1) % len(COLOUR_MODES))

    def toggle_layout(self) -> None:
        self.map_area.show_one(self.map_area.layout_box.currentIndex() == 0)

    def toggle_play(self) -> None:
        self.time_bar.play_button.toggle()

    def previous_chirp(self) -> None:
        self.session.set_chirp(self.session.chirp - 1)

    def next_chirp(self) -> None:
        self.session.set_chirp(self.session.chirp + 1)

    def remove_part(self) -> None:
        try:
            self.session.remove_part(self.session.part_key)
        except ValueError as error:
            self.show_message(str(error))

    def clear_selection(self) -> None:
        self.session.select_cells(None)
        if self.session.node is not None:
            self.session.select_node(None)

    def undo(self) -> None:
        self._restore(self.history.back())

    def redo(self) -> None:
        self._restore(self.history.forward())

    def _restore(self, state: dict | None) -> None:
        if state is None:
            return
        try:
            misfits = apply_state(self.session, state)
        except ValueError as error:
            misfits = [str(error)]
        self.filter_box.read(self.session)
        self.show_message("; ".join(misfits))

    def show_help(self) -> None:
        help_dialog(self).show()

    def quit(self) -> None:
        self.close()

    def open_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getOpenFileName, "Open a frame", "frame.h5", "Frames (*.h5 *.hdf5)", self.open_file)

    def save_view_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getSaveFileName, "Save this view", "view.json", "Views (*.json)", self.save_view)

    def load_view_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getOpenFileName, "Load a view", "view.json", "Views (*.json)", self.load_view)

    def screenshot_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getSaveFileName, "Save a picture", "echopath.png", "PNG (*.png)", self.screenshot)

    def export_rays_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getSaveFileName, "Export the rays", "rays.vtp", "VTK polydata (*.vtp)",
                  lambda path: export_rays(self.session, path))

    def export_meshes_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getSaveFileName, "Export the meshes", "meshes.vtp", "VTK polydata (*.vtp)",
                  lambda path: export_meshes(self.session, path))

    def _ask(self, dialog, title: str, name: str, kinds: str, work) -> None:
        path, _ = dialog(self, title, name, kinds)
        if not path:
            return
        try:
            work(path)
        except (ep.FileError, ValueError) as error:
            self.show_message(str(error))

    def save_view(self, path) -> None:
        """Writes what is shown, camera included, as JSON."""
        looks = {"camera": self.view3d.camera_state(), "show_hits": self.filter_box.hits_check.isChecked(),
                 "one_map": self.map_area.layout_box.currentIndex() == 1, "map_view": list(self.map_area.view.getRect())}
        save_state(state_of(self.session) | looks, path)

    def load_view(self, path) -> None:
        """Shows what was saved, as far as it fits the frame. Raises ep.FileError."""
        state = load_state(path)
        misfits = apply_state(self.session, state)
        self.filter_box.read(self.session)
        self.filter_box.hits_check.setChecked(bool(state.get("show_hits", False)))
        self.map_area.show_one(bool(state.get("one_map", False)))
        if "map_view" in state:
            self.map_area.set_view(QtCore.QRectF(*state["map_view"]))
        if "camera" in state:
            self.view3d.set_camera_state(state["camera"])
        self.show_message("This view is of another frame. " + "; ".join(misfits) if misfits else "")

    def settle(self) -> None:
        """Returns when lists, signals and the scene show what the session shows now."""
        QtWidgets.QApplication.processEvents()
        while (self._listing.isActive() or self._pause.isActive() or self.view3d.is_behind()
               or self.contributions.work.is_running):
            QtWidgets.QApplication.processEvents(QtCore.QEventLoop.ProcessEventsFlag.WaitForMoreEvents)

    def screenshot(self, path) -> None:
        """Writes a picture of the window. Raises ep.FileError."""
        picture = self.grab().toImage()
        for keyword, text in origin_texts(self.session.paths.frame.seed if self.session else None).items():
            picture.setText(keyword, text)
        with written_whole(Path(path).with_suffix(".png")) as temporary:
            picture.save(str(temporary), "PNG")

    # --- making ---

    def _arrange(self) -> None:
        left = _splitter(Qt.Orientation.Vertical, (self.tree, 1), (self.filter_box, 0))
        middle = QtWidgets.QWidget()
        column = QtWidgets.QVBoxLayout(middle)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.view3d, 1)
        column.addWidget(self.time_bar)
        self.tabs.addTab(self.contributions, "What makes the cell")
        self.tabs.addTab(self.table, "Rays")
        right = _splitter(Qt.Orientation.Vertical, (self.map_area, 3), (self.tabs, 1))
        self.content = _splitter(Qt.Orientation.Horizontal, (left, 0), (middle, 3), (right, 2))
        self.content.setSizes([300, 690, 610])
        self._splitters = {"columns": self.content, "left": left, "right": right}
        right.setSizes([600, 280])
        self.pages = QtWidgets.QStackedWidget()
        self.pages.addWidget(self.content)
        self.pages.addWidget(self.empty_page)
        page = QtWidgets.QWidget()
        column = QtWidgets.QVBoxLayout(page)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.banner)
        column.addWidget(self.pages, 1)
        self.setCentralWidget(page)

    def _add_actions(self) -> None:
        bar = self.addToolBar("Main")
        bar.setMovable(False)
        actions = {}
        for key, method, text in KEYS:
            action = QtGui.QAction(text, self)
            action.setShortcut(QtGui.QKeySequence(key))
            action.setToolTip(f"{text} ({key})")
            action.triggered.connect(lambda _=False, method=method: getattr(self, method)())
            self.addAction(action)
            actions[method] = action
        meshes = QtGui.QAction("Export the meshes (VTK)", self, triggered=lambda: self.export_meshes_dialog())
        self._needs_frame = [action for method, action in actions.items() if method not in ("open_dialog", "show_help", "quit")]
        self._needs_frame.append(meshes)
        file_menu = self.menuBar().addMenu("File")
        for name in ("open_dialog", "save_view_dialog", "load_view_dialog", "screenshot_dialog", "export_rays_dialog"):
            file_menu.addAction(actions[name])
        file_menu.addAction(meshes)
        self.recent_menu = file_menu.addMenu("Recent frames")
        self.recent_menu.aboutToShow.connect(self._fill_recent)
        file_menu.addAction(actions["quit"])
        look_menu = self.menuBar().addMenu("View")
        for name in ("undo", "redo", "look_fit", "look_radar", "look_top", "look_side", "toggle_hits", "next_colour",
                     "toggle_layout", "toggle_play", "previous_chirp", "next_chirp", "remove_part", "clear_selection"):
            look_menu.addAction(actions[name])
        self._add_layers()
        self.menuBar().addMenu("Help").addAction(actions["show_help"])
        self._fill_bar(bar, actions)

    def _fill_recent(self) -> None:
        self.recent_menu.clear()
        for name in recent_files():
            self.recent_menu.addAction(name, lambda name=name: self.open_file(name))

    def _add_layers(self) -> None:
        """A toggle for each layer, in a menu of its own."""
        self.layer_actions, menu = {}, self.menuBar().addMenu("Layers")
        for number, layer in enumerate(LAYERS):
            action = QtGui.QAction(layer.capitalize(), self, checkable=True)
            action.setShortcut(QtGui.QKeySequence(str(number + 1)))
            action.setToolTip(f"{LAYER_WORDS[layer]} ({number + 1})")
            action.toggled.connect(lambda is_on, layer=layer: self._toggle_layer(layer, is_on))
            menu.addAction(action)
            self.addAction(action)
            self.layer_actions[layer] = action
            self._needs_frame.append(action)
        menu.setToolTipsVisible(True)

    def _toggle_layer(self, layer: str, is_on: bool) -> None:
        if self.session is None or (layer in self.session.layers) == is_on:
            return
        self._work_on_node(layer.capitalize(), lambda progress: self.session.set_layer(layer, is_on, progress))
        self._show_layer_checks()

    def _show_layer_checks(self) -> None:
        for layer, action in self.layer_actions.items():
            with QtCore.QSignalBlocker(action):
                action.setChecked(layer in self.session.layers)

    def _fill_bar(self, bar, actions: dict) -> None:
        for name, text in (("open_dialog", "Open"), ("save_view_dialog", "Save view"), ("load_view_dialog", "Load view"),
                           ("screenshot_dialog", "Picture"), ("export_rays_dialog", "Export rays")):
            actions[name].setIconText(text)
            bar.addAction(actions[name])
        bar.addSeparator()
        for view in reversed(VIEWS):
            actions[f"look_{view}"].setIconText(VIEW_TITLES[view])
            bar.addAction(actions[f"look_{view}"])
        bar.addSeparator()
        actions["clear_selection"].setIconText("Select nothing")
        bar.addAction(actions["clear_selection"])
        actions["show_help"].setIconText("Keys (?)")
        bar.addAction(actions["show_help"])

    def _connect(self) -> None:
        self._listing.timeout.connect(self._refresh_lists)
        self._pause.timeout.connect(self._refresh_signals)
        self.tree.node_clicked.connect(self._choose_node)
        self.tree.rays_wanted.connect(self._only_over)
        self.filter_box.part_named.connect(self._name_part)
        self.filter_box.hits_toggled.connect(self._show_hits)
        self.view3d.ray_clicked.connect(lambda ray: self.session.select_ray(ray))
        self.view3d.nothing_clicked.connect(lambda: self.session.select_ray(None))
        self.view3d.mesh_clicked.connect(lambda mesh: self._choose_node(self.session.mesh_names[mesh]))
        self.view3d.legend_box.row_clicked.connect(self._isolate)
        self.table.ray_chosen.connect(lambda ray: self.session.select_ray(ray))
        self.empty_page.open_wanted.connect(self.open_dialog)
        self.empty_page.demo_wanted.connect(self._simulate_demo)

    def _show_hits(self, is_shown: bool) -> None:
        if self.view3d.builder is not None:
            self.view3d.builder.set_show_hits(is_shown)
            self.view3d.render_soon()

    def _set_content_shown(self, is_shown: bool) -> None:
        self.pages.setCurrentIndex(CONTENT_PAGE if is_shown else EMPTY_PAGE)
        for action in self._needs_frame:
            action.setEnabled(is_shown)

    # --- Qt ---

    def event(self, event):
        """A key that the widget in focus uses itself is no shortcut of the window: Space on a check box checks it."""
        if event.type() == QtCore.QEvent.Type.ShortcutOverride and uses_key(QtWidgets.QApplication.focusWidget(), event):
            event.accept()
            return True
        return super().event(event)

    def dragEnterEvent(self, event):
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    def dropEvent(self, event):
        self.open_file(event.mimeData().urls()[0].toLocalFile())

    def closeEvent(self, event):
        if self._remembers:
            remember_layout(self, self._splitters)
        self.time_bar.stop()
        self.contributions.work.stop()
        self._listing.stop()
        self._pause.stop()
        self.session = None
        self.view3d.builder = None
        self.view3d.close()
        super().closeEvent(event)


def _same_rays(before, after) -> bool:
    """bool [P] or None: none are chosen."""
    return before is after or (before is not None and after is not None and np.array_equal(before, after))


def _splitter(orientation, *widgets) -> QtWidgets.QSplitter:
    splitter = QtWidgets.QSplitter(orientation)
    for index, (widget, stretch) in enumerate(widgets):
        splitter.addWidget(widget)
        splitter.setStretchFactor(index, stretch)
    splitter.setChildrenCollapsible(False)
    return splitter


class Banner(QtWidgets.QLabel):
    """A line that says what is wrong, until it is clicked."""

    def __init__(self):
        super().__init__(visible=False, wordWrap=True)
        self.setStyleSheet("background: #fdecea; color: #7a1f14; padding: 8px; border-bottom: 1px solid #c0392b")
        self.setToolTip("Click to close")

    def mousePressEvent(self, _event):
        self.hide()
