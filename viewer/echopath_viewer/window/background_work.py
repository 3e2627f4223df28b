"""Work in a thread of its own while the window stays alive."""
from __future__ import annotations

import threading

from .qt import QtCore, Signal


class _Stopped(Exception):
    """Nobody wants the result any more."""


class BackgroundWork(QtCore.QObject):
    """One piece of work at a time; a new one, or `stop`, makes the one before end without a word."""

    done = Signal(object)
    failed = Signal(str)
    advanced = Signal(float)  # share of the work, 0 to 1
    _ended = Signal(int, object, str)

    def __init__(self, parent=None, *, ends_first: bool = False):
        """ends_first: whether the program waits at its end for work that is running."""
        super().__init__(parent)
        self._number, self._is_daemon = 0, not ends_first
        self.is_running = False
        self._ended.connect(self._tell)  # in the thread of the window, as this object lives there

    def start(self, work) -> None:
        """work: callable (progress) -> result, which may raise ValueError or OSError; progress: callable (stage, fraction)."""
        self._number += 1
        self.is_running = True
        threading.Thread(target=self._run, args=(self._number, work), daemon=self._is_daemon).start()

    def stop(self) -> None:
        self._number += 1
        self.is_running = False

    def _run(self, number: int, work) -> None:
        def progress(_stage: str, fraction: float) -> None:
            if number != self._number:
                raise _Stopped
            self.advanced.emit(fraction)

        result, told = None, ""
        try:
            result = work(progress)
        except _Stopped:
            return
        except (ValueError, OSError) as error:
            told = str(error)
        except Exception as error:  # whatever else went wrong must not leave the window waiting
            told = f"{type(error).__name__}: {error}"
        try:
            self._ended.emit(number, result, told)
        except RuntimeError:  # the window is gone
            return

    def _tell(self, number: int, result, error: str) -> None:
        if number != self._number:
            return
        self.is_running = False
        if error:
            self.failed.emit(error)
        else:
            self.done.emit(result)
