"""The panels around the 3-D view: docks that are moved, closed and opened again."""
from __future__ import annotations

from .maps.compare_panel import ComparePanel
from .maps.side_panels import AzimuthPanel, BeatPanel, ElevationPanel, SpectrogramPanel
from .qt import Qt, QtCore, QtWidgets

LEFT, RIGHT = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea
CONTENT_PAGE, EMPTY_PAGE = 0, 1
LEFT_WIDTH, RIGHT_WIDTH = 300, 610  # pixels
MAP_HEIGHT, TABLE_HEIGHT = 600, 280


class Panels:
    """Part of MainWindow: which panel stands where at first."""

    def arrange(self) -> None:
        self.setDockNestingEnabled(True)
        self.setTabPosition(Qt.DockWidgetArea.AllDockWidgetAreas, QtWidgets.QTabWidget.TabPosition.North)
        self.setCentralWidget(self._centre())
        self.docks = {}
        for area, name, widget in ((LEFT, "Scene", self.scene_box), (LEFT, "Rays shown", self.filter_box),
                                   (RIGHT, "Range-Doppler", self.map_area), (RIGHT, "What makes the cell", self.contributions),
                                   (RIGHT, "Rays", self.table)):
            self.add_panel(area, name, widget)
        self.side_panels = {"Range-azimuth": AzimuthPanel(), "Range-elevation": ElevationPanel(),
                            "Spectrogram": SpectrogramPanel(), "Beat signal": BeatPanel(), "Compare": ComparePanel()}
        self.add_panel(LEFT, "Live", self.live_panel)
        self.tabifyDockWidget(self.docks["Rays shown"], self.docks["Live"])
        self.docks["Rays shown"].raise_()
        for name, panel in self.side_panels.items():
            self.add_panel(RIGHT, name, panel)
            self.docks[name].visibilityChanged.connect(panel.set_seen)
            self.docks[name].hide()
            self.docks[name].toggleViewAction().triggered.connect(lambda is_on, name=name: is_on and self.open_panel(name))
        self.docks["Range-Doppler"].raise_()
        self.tabifyDockWidget(self.docks["What makes the cell"], self.docks["Rays"])
        self.docks["What makes the cell"].visibilityChanged.connect(self.contributions.set_seen)
        self.docks["What makes the cell"].raise_()
        self.reset_sizes()

    def _centre(self) -> QtWidgets.QWidget:
        self.content = QtWidgets.QWidget()
        column = QtWidgets.QVBoxLayout(self.content)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.view3d, 1)
        for bar in (self.time_bar, self.frame_bar):
            column.addWidget(bar)
        self.pages = QtWidgets.QStackedWidget()
        self.pages.addWidget(self.content)
        self.pages.addWidget(self.empty_page)
        page = QtWidgets.QWidget()
        column = QtWidgets.QVBoxLayout(page)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.loading_bar)
        column.addWidget(self.banner)
        column.addWidget(self.pages, 1)
        return page

    def add_panel(self, area, name: str, widget) -> None:
        """A dock; the menu of panels opens it again when it was closed."""
        dock = QtWidgets.QDockWidget(name, self)
        dock.setObjectName(name)
        dock.setWidget(widget)
        self.addDockWidget(area, dock)
        self.window_menu.addAction(dock.toggleViewAction())
        self.docks[name] = dock

    def open_panel(self, name: str) -> None:
        """In front of those that it shares its place with; one that was never opened beside the map."""
        dock = self.docks[name]
        if name in self.side_panels and not dock.isFloating() and not self.tabifiedDockWidgets(dock):
            self.tabifyDockWidget(self.docks["Range-Doppler"], dock)
        dock.show()
        self.docks[name].raise_()
        self._show_whole_titles()

    def _show_whole_titles(self) -> None:
        """Rows of tabs scroll where there is no room for all: shortened titles would be alike."""
        for bar in self.findChildren(QtWidgets.QTabBar):
            bar.setUsesScrollButtons(True)
            bar.setElideMode(Qt.TextElideMode.ElideNone)

    def reset_sizes(self) -> None:
        docks = self.docks
        self.resizeDocks([docks["Scene"], docks["Range-Doppler"]], [LEFT_WIDTH, RIGHT_WIDTH], Qt.Orientation.Horizontal)
        self.resizeDocks([docks["Range-Doppler"], docks["Rays"]], [MAP_HEIGHT, TABLE_HEIGHT], Qt.Orientation.Vertical)

    def show_content(self, is_shown: bool) -> None:
        """The views of a frame, or the page that says how to open one."""
        self.pages.setCurrentIndex(CONTENT_PAGE if is_shown else EMPTY_PAGE)
        if is_shown and not self._had_content:
            for dock in self._shown_docks:
                dock.show()
        elif not is_shown:
            self._shown_docks = [dock for dock in self.docks.values() if not dock.isHidden()]
            for dock in self._shown_docks:
                dock.hide()
        self._had_content = is_shown
        QtCore.QTimer.singleShot(0, self._show_whole_titles)
        for action in self._needs_frame:
            action.setEnabled(is_shown)
