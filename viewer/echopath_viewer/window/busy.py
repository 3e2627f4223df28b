"""Long work with a progress bar that can be cancelled."""
from __future__ import annotations

from contextlib import contextmanager

from .ctrl_c import is_heard, long_work
from .qt import Qt, QtWidgets

PATIENCE_MS = 400  # before a bar appears


class Cancelled(Exception):
    """The user has had enough."""


@contextmanager
def waiting_cursor():
    """The mouse shows meanwhile that the window is at work: for what takes a second where there are many paths."""
    QtWidgets.QApplication.setOverrideCursor(Qt.CursorShape.WaitCursor)
    try:
        yield
    finally:
        QtWidgets.QApplication.restoreOverrideCursor()


def run_with_progress(parent, title: str, work):
    """Calls work(progress) and returns its result; None where it was cancelled.

    progress: callable (stage, fraction), which keeps the window alive meanwhile.
    """
    dialog = QtWidgets.QProgressDialog(title, "Cancel", 0, 100, parent)
    dialog.setWindowModality(Qt.WindowModality.WindowModal)
    dialog.setMinimumDuration(PATIENCE_MS)
    dialog.setAutoReset(False)

    def progress(stage: str, fraction: float) -> None:
        if is_heard():
            raise Cancelled
        dialog.setLabelText(f"{title}: {stage}")
        dialog.setValue(int(99.0 * min(max(fraction, 0.0), 1.0)))  # pumps events while the dialog is shown
        if dialog.wasCanceled():
            raise Cancelled

    try:
        with long_work():
            return work(progress)
    except Cancelled:
        return None
    except KeyboardInterrupt:
        if not is_heard():
            raise
        return None
    finally:
        dialog.close()
        dialog.deleteLater()
