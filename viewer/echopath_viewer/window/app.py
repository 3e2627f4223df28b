"""From what a view is asked for to an open window."""
from __future__ import annotations

import os
import signal
import sys
import threading

import echopath as ep

from ..model import from_file, from_frame, from_paths
from .main_window import MainWindow
from .qt import QtCore, QtWidgets

SIGNAL_CHECK_MS = 200


def view(*what, parts=None, block=True, **settings):
    """Opens a window on a frame file, a Frame, or `scene, paths[, parts]`; an empty one on nothing.

    parts, settings: of `model.from_paths`; block: returns when the window is closed, else at once with the window
    Raises ep.FileError for a file that cannot be shown, before there is a window; OSError without a screen.
    """
    view_input = read_input(*what, parts=parts, **settings)
    require_screen()
    application = QtWidgets.QApplication.instance() or QtWidgets.QApplication(["echopath"])
    window = MainWindow()
    if view_input is not None:
        window.show_input(view_input)
    window.show()
    if not block:
        return window
    _run(application)
    return None


def require_screen() -> None:
    """Raises OSError where there is none: Qt would end the program."""
    if sys.platform != "linux" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")):
        return
    raise OSError("the viewer needs a screen, and DISPLAY names none; ep.plot_rays(scene, paths, off_screen=True, "
                  "screenshot='rays.png') draws without one")


def _run(application) -> None:
    """Until all windows are closed. Ctrl-C closes them and is raised as KeyboardInterrupt."""
    if threading.current_thread() is not threading.main_thread():
        application.exec()
        return
    interrupted = []
    before = signal.signal(signal.SIGINT, lambda *_: interrupted.append(True))
    # Python sees signals only while it runs; and what it sees in the middle of drawing must wait for its end.
    watch = QtCore.QTimer(interval=SIGNAL_CHECK_MS)
    watch.timeout.connect(lambda: application.closeAllWindows() if interrupted else None)
    watch.start()
    try:
        application.exec()
    finally:
        watch.stop()
        signal.signal(signal.SIGINT, before)
    if interrupted:
        raise KeyboardInterrupt


def read_input(*what, parts=None, **settings):
    """The ViewInput that the arguments of `view` describe, None for none."""
    if len(what) == 3:
        *what, parts = what
    if len(what) == 2:
        return from_paths(*what, parts, **settings)
    if parts is not None or settings:
        raise TypeError("view: parts, window and zero_pad belong to scene and paths: view(scene, paths, parts=...)")
    if not what:
        return None
    if len(what) == 1 and isinstance(what[0], (str, os.PathLike)):
        return from_file(what[0])
    if len(what) == 1 and isinstance(what[0], ep.Frame):
        return from_frame(what[0])
    raise TypeError(f"view: takes a frame file, a Frame or (scene, paths, parts), got {what!r}")
