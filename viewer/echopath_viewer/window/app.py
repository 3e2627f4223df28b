"""From what a view is asked for to an open window."""
from __future__ import annotations

import ctypes
import os
import sys
from pathlib import Path

import echopath as ep

from ..libraries import missing_library
from ..model import from_file, from_frame, from_paths
from ..model.frames.live_session import input_of_view
from ..model.frames.preview import preview_of
from ..model.frames.simulated_frames import SimulatedFrames
from ..model.frames.time_line import time_line_of
from ..model.view_state import load_state
from .ctrl_c import closing_on_ctrl_c
from .files.exporting import export
from .main_window import MainWindow
from .qt import Qt, QtCore, QtGui, QtWidgets

OTHER_WAY = "ep.plot_rays(scene, paths, off_screen=True, screenshot='rays.png') draws without one"


def view(*what, parts=None, block=True, state=None, picture=None, scale=1, **settings):
    """Opens a window on a frame file, a Frame, `scene, paths[, parts]`, or on frames in time: a folder, a pattern, a list of
    files, a Sequence, a StoredSequence or a Dataset; an empty one on nothing.

    parts, settings: of `model.from_paths`; block: returns when the window is closed, else at once with the window
    state: file of a saved view, which is shown; picture: file of what it shows, by its name as in `exporting.export`, whose
        window is closed then; scale: of a PNG
    Raises ep.FileError for a file that cannot be shown, before there is a window; OSError without a screen;
    ValueError for a state or a picture of nothing; KeyboardInterrupt on Ctrl-C, which closes all windows and ends what they
    compute.
    """
    early = preview_of(what[0]) if picture is None and len(what) == 1 and isinstance(what[0], (str, os.PathLike)) else None
    view_input, line = (early, None) if early is not None else read_input(*what, parts=parts, **settings)
    if view_input is None and (state is not None or picture is not None):
        raise ValueError("state and picture: must come with a frame or paths, got none")
    if state is not None:
        load_state(state)
    require_screen()
    application = QtWidgets.QApplication.instance() or QtWidgets.QApplication(["echopath"])
    _require_opengl()
    window = _opened(view_input, line, state if early is None else None, picture is None)
    if what and isinstance(what[0], ep.Live):
        window.open_panel("Live")
        window.live_panel.attach(what[0], window.session)
    if early is not None:
        _load_rest(window, what[0], state)
    if line is None and what and isinstance(what[0], (str, os.PathLike)):
        window.watch_file(what[0], view_input)
    if picture is not None:
        with closing_on_ctrl_c(application):
            return _save_picture(window, picture, scale)
    if not block:
        return window
    with closing_on_ctrl_c(application):
        application.exec()
    return None


def _opened(view_input, line, state, remembers: bool) -> MainWindow:
    """Pictures are the same on every machine: their window remembers nothing."""
    window = MainWindow(remembers)
    if view_input is not None:
        window.show_input(view_input, line)
    window.show()
    if state is not None:
        window.load_view(state)
    return window


def _load_rest(window: MainWindow, path, state) -> None:
    """The rays of a file whose map is on display, and then the saved view of them."""
    window.load_rest(path)
    if state is not None:
        once = Qt.ConnectionType.SingleShotConnection  # what is read anew later keeps the view of then
        window.loading.done.connect(lambda _: window.load_view(state), once)


def _save_picture(window: MainWindow, path, scale: int) -> None:
    try:
        window.settle()
        export(window, path, scale)
    finally:
        window.close()


def require_screen() -> None:
    """Raises OSError where there is none, or a library that draws on it is missing: Qt would end the program."""
    if sys.platform != "linux":
        return
    display, *others = (os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"))
    if any(others):
        return
    if display:
        _require_libraries()
        return
    raise OSError(f"the viewer needs a screen, and DISPLAY names none; {OTHER_WAY}")


def _require_opengl() -> None:
    """Raises OSError where windows of Qt cannot draw a scene, which a picture of it would wait for without an end."""
    if not QtGui.QOpenGLContext().create():
        raise OSError("the viewer needs a screen with OpenGL, which Qt's platform "
                      f"'{QtGui.QGuiApplication.platformName()}' does not bring here; {OTHER_WAY}")


def _require_libraries() -> None:
    """Loads Qt's plug-in for X, which wheels bring without the libraries of the system that it is linked with."""
    plugin = Path(QtCore.QLibraryInfo.path(QtCore.QLibraryInfo.LibraryPath.PluginsPath), "platforms", "libqxcb.so")
    try:
        if plugin.exists():
            ctypes.CDLL(str(plugin))
    except OSError as error:
        raise missing_library(error) from None


def read_input(*what, parts=None, **settings) -> tuple:
    """(ViewInput that the arguments of `view` describe, None for none; TimeLine whose first frame it is, None for one)."""
    if len(what) == 3:
        *what, parts = what
    if len(what) == 2:
        return from_paths(*what, parts, **settings), None
    if parts is not None or settings:
        raise TypeError("view: parts, window and zero_pad belong to scene and paths: view(scene, paths, parts=...)")
    if not what:
        return None, None
    if len(what) > 1:
        raise TypeError(f"view: takes a frame file, a Frame or (scene, paths, parts), got {what!r}")
    return _read_one(what[0])


def _read_one(what) -> tuple:
    if isinstance(what, ep.Frame):
        return from_frame(what), None
    if isinstance(what, ep.Live):
        return input_of_view(what, what.update()), None
    if isinstance(what, ep.Sequence):
        require_screen()  # before the work
        line = SimulatedFrames(what)
    else:
        line = time_line_of(what)
    if line is None:
        return from_file(what), None
    return line.read_first(), line
