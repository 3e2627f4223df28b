"""Whether the file on display was written anew."""
from __future__ import annotations

from pathlib import Path

from echopath.base.storage.files import file_state

from ..qt import QtCore, Signal

POLL_MS = 1000


class FileWatch(QtCore.QObject):
    """Tells when a file has other contents than when it was read, and no program is writing it any more."""

    changed = Signal(str)

    def __init__(self, parent=None):
        super().__init__(parent)
        self._path, self._shown, self._seen = None, None, None
        self._timer = QtCore.QTimer(self, interval=POLL_MS)
        self._timer.timeout.connect(self.look)

    def watch(self, path) -> None:
        """Another file from now on; None: none."""
        self._path = None if path is None else Path(path)
        self._shown = self._seen = self._state()
        (self._timer.stop if path is None else self._timer.start)()

    @property
    def path(self):
        """The file that is watched, or None."""
        return self._path

    def accept(self, path, state: tuple | None) -> None:
        """What a file holds in a state (`file_state`) is known, if it is the one watched; what it holds since is not."""
        if self._path is not None and self._path == Path(path):
            self._shown = state

    def look(self) -> None:
        """Once at rest for one turn, a file that differs is told of."""
        state = self._state()
        if state is not None and state == self._seen and state != self._shown:
            self._shown = state
            self.changed.emit(str(self._path))
        self._seen = state

    def _state(self):
        return None if self._path is None else file_state(self._path)
