"""From a file, a folder or a drop to what the window shows."""
from __future__ import annotations

import gc

import echopath as ep
from echopath.sequence.unused_memory import give_back_memory

from ...model import from_file, from_frame
from ...model.frames.carried import read_session
from ...model.frames.kept_orders import keep_orders
from ...model.frames.preview import preview_of
from ...model.frames.time_line import time_line_of
from ...model.view_state import apply_state, state_of
from ..busy import run_with_progress, waiting_cursor
from ..qt import QtCore
from .demo import simulate_demo
from .remembered import remember_file

REST_MS = 1000  # after a file was read, until lists and signals are made of it


def _give_back() -> None:
    """What reading has left, and the session before: the next file would come on top of it."""
    gc.collect()
    give_back_memory()


class Opening:
    """Part of MainWindow: reads frames, large ones in a thread, and reads them anew."""

    _why_unread = ""  # what the last reading in a thread has failed with

    def open_file(self, path) -> bool:
        """Shows a frame file, or the time line of a folder, a pattern or a list of files, or says above what was shown before
        what is wrong with it."""
        try:
            with waiting_cursor():
                line = time_line_of(path)
                early = preview_of(path) if line is None else None
                view_input = early or (from_file(path) if line is None else line.read_first())
        except (ep.FileError, ValueError) as error:
            self.show_message(str(error))
            return False
        self.show_input(view_input, line)
        self.watch_file(path if line is None else None, view_input)
        if early is not None:
            self.load_rest(path)
        if not isinstance(path, list):
            remember_file(path)
        return True

    def watch_file(self, path, view_input) -> None:
        """From now on, for other contents than those of view_input, which was read from there; path: None: none is watched."""
        self.file_watch.watch(path)
        if path is not None and view_input.file_state is not None:
            self.file_watch.accept(path, view_input.file_state)

    def load_rest(self, path) -> None:
        """Reads all of a file of which a preview is shown, in a thread, once that is drawn."""
        self.loading_bar.begin()
        self.is_to_load, self._begun_with = True, state_of(self.session)
        self.view3d.when_drawn(lambda: self._load(path, None))

    def _load(self, path, state: dict | None) -> None:
        self.is_to_load, self._path_read = False, path
        self.loading_bar.begin()
        self.loading.start(lambda progress: read_session(path, state, progress))

    def reload(self) -> None:
        """Reads the file on display anew, or the frame of a time line; what is shown stays, as far as it fits."""
        self.time_line.reload()
        path, state = self.file_watch.path, state_of(self.session)
        if path is not None:
            self._begun_with = state
            self._load(path, state)

    def _end_loading(self, text: str = "") -> None:
        self.loading_bar.hide()
        self._why_unread = text
        if text:
            self.show_message(text)

    def _take_rest(self, session) -> None:
        self.take_back(self._why_unread)  # as of a file that was being written
        self._end_loading()
        self.file_watch.accept(self._path_read, session.file_state)
        self._go_on_with_choices(session)
        self._follow(session)
        QtCore.QTimer.singleShot(REST_MS, _give_back)
        if self._remembers and not session.is_kept:
            path = self._path_read
            self.keeping.start(lambda progress: (path, keep_orders(path, session)))

    def _take_kept(self, kept: tuple) -> None:
        """kept: (path, state) of a file that this window has written: there is nothing new in it. state: None: it has not"""
        path, state = kept
        if state is not None:
            self.file_watch.accept(path, state)

    def _go_on_with_choices(self, session) -> None:
        """What was chosen since the reading began is chosen in the session that was read, too; rays are others."""
        chosen = {name: value for name, value in state_of(self.session).items() if value != self._begun_with[name]}
        if chosen:
            apply_state(session, state_of(session) | chosen | {"frame": session.title, "ray": None})

    def _simulate_demo(self) -> None:
        frame = run_with_progress(self, "Street demo", simulate_demo)
        if frame is not None:
            self.show_input(from_frame(frame, title="street demo"))

    def dragEnterEvent(self, event):
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    def dropEvent(self, event):
        names = [url.toLocalFile() for url in event.mimeData().urls()]
        self.open_file(names[0] if len(names) == 1 else names)
