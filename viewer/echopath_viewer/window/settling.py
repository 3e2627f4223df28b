"""Waiting until a window shows what it is to show."""
from __future__ import annotations

import time

from .ctrl_c import is_heard
from .qt import QtCore, QtWidgets

LOOK_MS = 500  # between looks where no event comes


def what_is_late(window) -> list[str]:
    """What does not show yet what the session of a MainWindow shows."""
    is_late = {"lists": window._listing.isActive(), "signals": window._pause.isActive(), "scene": window.view3d.is_behind(),
               "what makes the cell": window.contributions.work.is_running,
               "frame of the time line": window.time_line.is_busy,
               "frames of the strip": window.time_line.is_glancing,
               "rest of the file": window.is_to_load or window.loading.is_running,
               "orders and cells to be kept in the file": window.keeping.is_running}
    return [name for name, is_so in is_late.items() if is_so]


def settle(window, patience: float) -> None:
    """Handles events until nothing of a MainWindow is late; a picture of the scene that does not come is asked for again.

    Raises TimeoutError naming what is late after `patience` s, KeyboardInterrupt on Ctrl-C within `closing_on_ctrl_c`.
    """
    QtWidgets.QApplication.processEvents()
    deadline = time.monotonic() + patience
    look = QtCore.QTimer(interval=LOOK_MS)
    look.timeout.connect(lambda: window.view3d.update() if window.view3d.is_behind() else None)
    look.start()
    while late := what_is_late(window):
        if time.monotonic() > deadline:
            raise TimeoutError(f"window: must show all of its session within {patience:g} s, but late are: {', '.join(late)}")
        QtWidgets.QApplication.processEvents(QtCore.QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
        if is_heard():
            raise KeyboardInterrupt
    # Rows of tabs that docks no longer have are there until then.
    QtWidgets.QApplication.sendPostedEvents(None, QtCore.QEvent.Type.DeferredDelete)
