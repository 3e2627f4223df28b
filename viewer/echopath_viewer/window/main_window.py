"""The window of the viewer."""
from __future__ import annotations

import math

import numpy as np

from echopath.base.text.mesh_names import object_of

from ..model import Session
from ..model.history import History
from ..model.view_state import state_of
from .background_work import BackgroundWork
from .banner import Banner, ThinBar
from .busy import run_with_progress
from .choices import Choices
from .collector import Collector
from .empty_page import EmptyPage
from .files.file_actions import FileActions
from .files.file_watch import FileWatch
from .files.opening import Opening
from .files.remembered import remember_layout, restore_layout
from .keys import uses_key
from .live.live_control import LiveControl
from .live.live_panel import LivePanel
from .maps.contributions import ContributionsPanel
from .maps.map_area import MapArea
from .menus import Menus
from .panels import Panels
from .qt import QtCore, QtWidgets
from .scene.filter_box import FilterBox
from .scene.own_window import give_own_window
from .scene.ray_table import RayTable
from .scene.scene_box import SceneBox
from .scene.scene_tree import SceneTree
from .scene.view3d import View3D
from .settling import settle
from .timeline.frame_bar import FrameBar
from .timeline.time_bar import TimeBar
from .timeline.time_control import TimeControl
from .view_actions import ViewActions

TITLE = "Echopath"
SIZE = (1600, 960)
SIGNAL_PAUSE_MS = 250  # without changes, before signals of what is chosen are made: longer work than a step of a box


class MainWindow(Opening, Panels, Menus, ViewActions, FileActions, Choices, QtWidgets.QMainWindow):
    """Scene tree and filters, 3-D view with its time bars, maps and tables: all views of one session."""

    def __init__(self, remembers: bool = True):
        """remembers: whether its sizes are those of the last time, and those of the next."""
        super().__init__()
        self.session, self._remembers, self._had_content = None, remembers, True
        self._collector = Collector(self)
        self.setWindowTitle(TITLE)
        self.resize(*SIZE)
        self.setAcceptDrops(True)
        self.tree, self.filter_box, self.view3d = SceneTree(), FilterBox(), View3D(self)
        self.scene_box = SceneBox(self.tree)
        self.time_bar, self.map_area, self.table = TimeBar(), MapArea(), RayTable()
        self.contributions, self.frame_bar = ContributionsPanel(), FrameBar()
        self.time_bar.is_behind = self.view3d.is_behind
        self.time_line = TimeControl(self.frame_bar, lambda: state_of(self.session), self.view3d.is_behind)
        self.contributions.is_playing = lambda: self.time_line.is_playing
        self.live = LiveControl(lambda: state_of(self.session), self)
        self.live_panel = LivePanel(self.live)
        self.frame_bar.hide()
        self.banner, self.empty_page, self.loading_bar = Banner(), EmptyPage(), ThinBar()
        self.loading, self.keeping, self.file_watch = BackgroundWork(self), BackgroundWork(self), FileWatch(self)
        self._listing = QtCore.QTimer(self, singleShot=True, interval=0)
        self._pause = QtCore.QTimer(self, singleShot=True, interval=SIGNAL_PAUSE_MS)
        self._stale, self._signal_of, self.is_to_load, self._is_passing = set(), None, False, False
        self.add_menus()
        self.arrange()
        self._connect()
        if remembers:
            restore_layout(self)
        self.show_content(False)
        give_own_window(self.view3d)

    # --- frames ---

    def show_input(self, view_input, line=None) -> None:
        """Shows what `model.inputs` has read, and the window: there is no drawing into one that was never shown.

        line: TimeLine whose first frame that can be read it is, None: it stands alone
        """
        self.loading.stop()
        self.keeping.stop()
        self.view3d.when_drawn(None)
        self.is_to_load = False
        self.file_watch.watch(None)
        self._show_session(Session(view_input), line)

    def _show_session(self, session, line) -> None:
        self.session, self.history, self._is_passing = session, History(), False
        session.listen(self._changed)
        self.show_message("")
        self.show_content(True)
        self.show()
        for part in (self.tree, self.filter_box, self.map_area, self.time_bar, self.view3d, self.table, self.contributions,
                     *self.side_panels.values(), self.live_panel):
            part.show_session(self.session)
        self.view3d.builder.set_show_hits(self.filter_box.hits_check.isChecked())
        self.view3d.setFocus()  # so that the arrow keys step through the chirps
        self._show_slow_time()
        self._begin()
        self.time_line.show(line)

    def _begin(self) -> None:
        """Follows the session that all views show by now."""
        self.show_layer_checks()
        self.history.record(self._view_state())
        self.setWindowTitle(f"{self.session.title or 'paths'} - {TITLE}")

    def _view_state(self) -> dict:
        """What undo goes back to: the view, whatever the frame; rays are those of one frame."""
        left_out = ("frame", "seed") if self.time_line.line is None else ("frame", "seed", "ray")
        return {key: value for key, value in state_of(self.session).items() if key not in left_out}

    def _follow(self, session) -> None:
        """Another frame of the time line, which shows what the one before did."""
        self._take(session)
        self._signal_of = None
        self._begin()
        self._pause.start()

    def _take(self, session, is_passing: bool = False) -> None:
        """All views go on with another frame. is_passing: the next one comes at once, and only what is quick is made."""
        if session is not self.session:
            session.listen(self._changed)
        self.session, self._is_passing = session, is_passing
        for part in (self.view3d, self.map_area, self.time_bar, self.tree, self.filter_box, self.table, self.contributions,
                     *self.side_panels.values(), self.live_panel):
            part.follow_session(session, is_passing)

    def _show_tracks(self) -> None:
        strip = self.frame_bar.strip
        self.view3d.builder.show_tracks(strip.tracks, strip.places)
        self.view3d.render_soon()

    def _take_live(self, session, view) -> None:
        """Scene, rays, map and table follow each preview; what takes longer follows the full view."""
        if view.is_preview:
            self._take(session, is_passing=True)
        else:
            self._follow(session)

    def _take_read(self, session) -> None:
        """Of a film that plays, what is quick and the maps that are looked at; the rest when it stops."""
        if not self.time_line.is_playing:
            self._follow(session)
            return
        self._take(session, is_passing=True)
        for panel in self.side_panels.values():
            panel.follow_session(session)

    def _end_passing(self) -> None:
        """What no other view follows at once any more is shown whole."""
        if self._is_passing:
            self._follow(self.session)

    def _drag_mesh(self, mesh: int, way) -> None:
        """way: [3] m from where the object was when it was taken hold of; [0, 0, 0] then."""
        if not self.live.is_on:
            self.show_message("Start the panel Live to move objects.")
            return
        name = object_of(self.session.mesh_names[mesh])
        if not np.any(way):
            self.live_panel.choose(name)
            self._dragged_from = self.live.position(name)
            return
        self.live.move(name, self._dragged_from + way)

    def show_message(self, text: str) -> None:
        """Shows a line above everything until it is clicked away; "" takes it away."""
        self.banner.setText(text)
        self.banner.setVisible(bool(text))

    def take_back(self, text: str) -> None:
        """Takes a message away that no longer is so, unless another one has come."""
        if self.banner.text() == text:
            self.show_message("")

    # --- following the session ---

    def _changed(self, topics: set) -> None:
        """At once for what moves with the mouse; lists and counts when this turn of the event loop is over."""
        self.view3d.update_topics(topics)
        for part in (self.map_area, *self.side_panels.values()):
            part.update_topics(topics)
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
            self.history.record(self._view_state())

    def _refresh_signals(self) -> None:
        """What takes synthesis: the map of the selected mesh, and the slow-time signal where it is of other rays now."""
        self._work_on_node(f"Map of {self.session.node}", self.session.refresh_node)
        lit, channel, of = self.session.lit, self.session.channel, self._signal_of
        if of is None or of[1] != channel or not _same_rays(of[0], lit):
            self._show_slow_time()

    def _show_slow_time(self) -> None:
        session = self.session
        self._signal_of = session.lit, session.channel
        title = f"Power by chirp, {'all echoes' if session.box is None else 'the selected rays'}"
        try:
            power = run_with_progress(self, "Signal of the selected rays", session.slow_time_power)
        except ValueError as error:
            power, title = [], str(error)
        if power is not None:
            self.time_bar.show_power(power, title)

    def _show_hits(self, is_shown: bool) -> None:
        if self.view3d.builder is not None:
            self.view3d.builder.set_show_hits(is_shown)
            self.view3d.render_soon()

    def settle(self, patience: float = math.inf) -> None:
        """Returns when lists, signals and the scene show what the session shows now. Raises TimeoutError after `patience` s."""
        settle(self, patience)

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
        self.file_watch.changed.connect(lambda _: self.reload())
        self.loading.advanced.connect(self.loading_bar.advance)
        self.loading.done.connect(self._take_rest)
        self.loading.failed.connect(self._end_loading)
        self.keeping.done.connect(self._take_kept)
        self.time_line.read.connect(self._take_read)
        self.time_line.stopped.connect(self._end_passing)
        self.live_panel.begins.connect(self.time_line.hold)  # the next frame of a film would end it at once
        self.live.shown.connect(self._take_live)
        self.live.failed.connect(self.show_message)
        self.live.stopped.connect(self._end_passing)
        self.view3d.mesh_dragged.connect(self._drag_mesh)
        self.time_line.glanced.connect(self._show_tracks)
        self.time_line.failed.connect(self.show_message)
        self.time_line.mended.connect(self.take_back)
        self.empty_page.open_wanted.connect(self.open_dialog)
        self.empty_page.demo_wanted.connect(self._simulate_demo)

    # --- Qt ---

    def event(self, event):
        """A key that the widget in focus uses itself is no shortcut of the window: Space on a check box checks it."""
        if event.type() == QtCore.QEvent.Type.ShortcutOverride and uses_key(QtWidgets.QApplication.focusWidget(), event):
            event.accept()
            return True
        return super().event(event)

    def closeEvent(self, event):
        self._collector.end()
        if self._remembers and self._had_content:
            remember_layout(self)
        for dock in filter(QtWidgets.QDockWidget.isFloating, self.docks.values()):  # they are windows of their own
            dock.hide()
        self.time_bar.stop()
        self.file_watch.watch(None)
        self._is_passing = False
        self.time_line.stop()
        for work in (self.contributions.work, self.loading, self.keeping, self.live_panel):
            work.stop()
        for panel in self.side_panels.values():
            panel.stop()
        self._listing.stop()
        self._pause.stop()
        self.session = None
        self.view3d.builder = None
        self.view3d.when_drawn(None)
        self.view3d.close()
        super().closeEvent(event)


def _same_rays(before, after) -> bool:
    """bool [P] or None: none are chosen."""
    return before is after or (before is not None and after is not None and np.array_equal(before, after))
