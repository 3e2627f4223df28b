"""Work in a thread of its own while the window stays alive."""
from __future__ import annotations

import threading

from .qt import QtCore, Signal


class _Stopped(Exception):
    """Nobody wants the result any more."""


class BackgroundWork(QtCore.QObject):
    """One piece of work at a time; a new one, or `stop`, makes the one before end without a word.

    The program waits at its end for work that is running: threads that Python stops in the middle of a file or of the core may
    hold what its end needs, and it would hang or crash.
    """

    done = Signal(object)
    failed = Signal(str)
    advanced = Signal(float)  # share of the work, 0 to 1
    _ended = Signal(int, object, str)

    def __init__(self, parent=None):
        super().__init__(parent)
        self._number, self.is_running = 0, False
        self._ended.connect(self._tell)  # in the thread of the window, as this object lives there

    def start(self, work) -> None:
        """work: callable (progress) -> result, which may raise ValueError or OSError; progress: callable (stage, fraction)."""
        self._number += 1
        self.is_running = True
        threading.Thread(target=self._run, args=(self._number, work)).start()

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
