"""What the keys and menus read and write."""
from __future__ import annotations

from pathlib import Path

import echopath as ep

from ...model.view_state import apply_state, load_state, save_state, state_of
from ...scene_builder import export_meshes, export_rays
from ..busy import run_with_progress, waiting_cursor
from ..qt import QtCore, QtWidgets
from .exporting import export
from .kinds import FRAMES, VIEWS

# What the dialog offers: suffix, and how many times the pixels of the screen.
PICTURES = {"Picture (*.png)": (".png", 1), "Picture, twice the resolution (*.png)": (".png", 2),
            "Picture, 4 times the resolution (*.png)": (".png", 4), "Maps (*.svg)": (".svg", 1), "Maps (*.pdf)": (".pdf", 1),
            "Film (*.gif)": (".gif", 1), "Film (*.mp4)": (".mp4", 1), "Page with the scene (*.html)": (".html", 1)}


class FileActions:
    """Part of MainWindow: actions, by the names in keys.py, that read and write files."""

    def open_dialog(self) -> None:
        names, _ = QtWidgets.QFileDialog.getOpenFileNames(self, "Open a frame, or several as a time line", "", FRAMES)
        if names:
            self.open_file(names[0] if len(names) == 1 else names)

    def open_folder_dialog(self) -> None:
        folder = QtWidgets.QFileDialog.getExistingDirectory(self, "Open a folder of frames: a sequence or a dataset")
        if folder:
            self.open_file(folder)

    def save_view_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getSaveFileName, "Save this view", "view.json", VIEWS, self.save_view)

    def load_view_dialog(self) -> None:
        self._ask(QtWidgets.QFileDialog.getOpenFileName, "Load a view", "view.json", VIEWS, self.load_view)

    def screenshot_dialog(self) -> None:
        """A picture, maps, a film or a page, by the kind that is chosen."""
        path, kind = QtWidgets.QFileDialog.getSaveFileName(self, "Save a picture, maps, a film or a page", "echopath.png",
                                                           ";;".join(PICTURES))
        if not path:
            return
        suffix, scale = PICTURES.get(kind, (".png", 1))
        path = path if Path(path).suffix else path + suffix
        try:
            with waiting_cursor():
                run_with_progress(self, "Export", lambda progress: export(self, path, scale, progress))
        except (ep.FileError, ValueError, ModuleNotFoundError) as error:
            self.show_message(str(error))

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
        self.show_layer_checks()
        self.filter_box.hits_check.setChecked(bool(state.get("show_hits", False)))
        self.map_area.show_one(bool(state.get("one_map", False)))
        if "map_view" in state:
            self.map_area.set_view(QtCore.QRectF(*state["map_view"]))
        if "camera" in state:
            self.view3d.set_camera_state(state["camera"])
        self.show_message("This view is of another frame. " + "; ".join(misfits) if misfits else "")

    def screenshot(self, path, scale: int = 1) -> None:
        """Writes a picture of the window with `scale` times its pixels along each axis. Raises ep.FileError."""
        export(self, Path(path).with_suffix(".png"), scale)
