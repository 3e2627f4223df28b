"""Menus, tool bar and toggles of the window."""
from __future__ import annotations

from ..model.maps.layers import DETECTIONS, LABELS, LAYERS, NAMES, OBJECTS, TRUTH, TWINS
from ..scene_builder import VIEWS
from .files.remembered import recent_files
from .keys import KEYS, MENUS, NEEDS_NO_FRAME
from .qt import QtCore, QtGui

VIEW_TITLES = {"radar": "Radar's eye", "top": "Top", "side": "Side", "fit": "Fit"}
BAR_TITLES = {"open_dialog": "Open", "save_view_dialog": "Save view", "load_view_dialog": "Load view",
              "screenshot_dialog": "Picture", "export_rays_dialog": "Export rays"}
LAYER_WORDS = {LABELS: "Cells of the map by the part that dominates", OBJECTS: "Cells of objects and of their ghosts",
               DETECTIONS: "Detections in the map and, with directions, in the scene",
               TRUTH: "True centres in the map, true boxes in the scene",
               TWINS: "The strongest ghosts in the scene: objects, translucent, where their echoes seem to come from",
               NAMES: "Names of the objects in the scene"}


class Menus:
    """Part of MainWindow: an action for each row of KEYS, a toggle for each layer."""

    def add_menus(self) -> None:
        self.actions_by_name = {method: self._action(key, method, text) for key, method, text in KEYS}
        self._needs_frame = [action for method, action in self.actions_by_name.items() if method not in NEEDS_NO_FRAME]
        for title, methods in MENUS.items():
            menu = self.menuBar().addMenu(f"&{title}")
            for method in methods:
                menu.addAction(self.actions_by_name[method])
            if title == "File":
                self._add_recent(menu)
            if title == "View":
                self._add_layers()
                self.window_menu = self.menuBar().addMenu("&Panels")
        self._fill_bar()

    def _action(self, key: str, method: str, text: str):
        action = QtGui.QAction(text, self)
        if key:
            action.setShortcut(QtGui.QKeySequence(key))
        action.setToolTip(f"{text} ({key})" if key else text)
        action.triggered.connect(lambda _=False: getattr(self, method)())
        self.addAction(action)
        return action

    def _add_recent(self, menu) -> None:
        self.recent_menu = menu.addMenu("Recent frames")
        self.recent_menu.aboutToShow.connect(self._fill_recent)
        menu.addAction(self.actions_by_name["quit"])

    def _fill_recent(self) -> None:
        self.recent_menu.clear()
        for name in recent_files():
            self.recent_menu.addAction(name.replace("&", "&&"), lambda name=name: self.open_file(name))

    def _add_layers(self) -> None:
        """A toggle for each layer, in a menu of its own."""
        self.layer_actions, menu = {}, self.menuBar().addMenu("&Layers")
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
        self.show_layer_checks()

    def show_layer_checks(self) -> None:
        """Takes over which layers the session shows."""
        for layer, action in self.layer_actions.items():
            with QtCore.QSignalBlocker(action):
                action.setChecked(layer in self.session.layers)

    def _fill_bar(self) -> None:
        bar, actions = self.addToolBar("Main"), self.actions_by_name
        bar.setObjectName("main bar")
        bar.setMovable(False)
        for name, text in BAR_TITLES.items():
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
