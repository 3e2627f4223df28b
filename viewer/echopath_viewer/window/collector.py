"""Python's search for garbage, kept to the thread of the windows."""
from __future__ import annotations

import functools
import gc
import itertools
import time

from .qt import QtCore

LOOK_MS = 200
BETWEEN_WHOLE = 10.0  # s at least between searches through all objects, which take as long as a picture
# A thread looks for garbage of its own accord when there are so many objects more than at the last search: where no event comes
# for long, so that nobody else looks.
RARELY = 200_000

_numbers = itertools.count()
_running = set()           # numbers of Collectors
_usual = ()                # thresholds before the first one began
_last_whole = -float("inf")  # s


class Collector(QtCore.QTimer):
    """While one runs, garbage is found in its thread, between events.

    Any thread that makes objects would else find that of others, too, and what a scene was drawn with may be let go by no thread
    but that which drew it.
    """

    def __init__(self, parent=None):
        """Runs from now on, until `end` or until it is destroyed with its parent."""
        super().__init__(parent, interval=LOOK_MS)
        self._number = next(_numbers)
        _begin(self._number)
        self.destroyed.connect(functools.partial(_end, self._number))
        self.timeout.connect(_collect)
        self.start()

    def end(self) -> None:
        """Python's own search comes back with the end of the last one."""
        self.stop()
        _end(self._number)


def _begin(number: int) -> None:
    global _usual
    if not _running:
        _usual = gc.get_threshold()
        if _usual[0] > 0:  # 0: nobody is to look
            gc.set_threshold(max(RARELY, _usual[0]), *_usual[1:])
    _running.add(number)


def _end(number: int, *_) -> None:
    if number not in _running:
        return
    _running.remove(number)
    if not _running:
        gc.set_threshold(*_usual)


def _collect() -> None:
    """The oldest generation that has grown by as much as Python waits for, and those before."""
    global _last_whole
    if not gc.isenabled() or _usual[0] == 0:
        return
    young, middle, old = (count > most for count, most in zip(gc.get_count(), _usual))
    if old and time.monotonic() - _last_whole > BETWEEN_WHOLE:
        gc.collect()
        _last_whole = time.monotonic()
    elif middle or young:
        gc.collect(1 if middle else 0)
