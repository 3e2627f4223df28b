"""Python's search for garbage, kept to the thread of the windows."""
from __future__ import annotations

import gc

from .qt import QtCore

LOOK_MS = 200
RARELY = 200_000  # objects more than there were, before threads look for garbage on their own: where no event comes for long

_running = set()  # Collectors
_usual = ()       # thresholds before the first one began


class Collector(QtCore.QTimer):
    """While one runs, garbage is found in its thread, between events.

    Any thread that makes objects would else find that of others, too, and what a scene was drawn with may be let go by no thread
    but that which drew it.
    """

    def __init__(self, parent=None):
        """Runs from now on."""
        global _usual
        super().__init__(parent, interval=LOOK_MS)
        if not _running:
            _usual = gc.get_threshold()
            gc.set_threshold(max(RARELY, _usual[0]), *_usual[1:])
        _running.add(self)
        self.timeout.connect(_collect)
        self.start()

    def end(self) -> None:
        """Python's own search comes back with the end of the last one."""
        self.stop()
        if self not in _running:
            return
        _running.remove(self)
        if not _running:
            gc.set_threshold(*_usual)


def _collect() -> None:
    """As Python would by itself: the oldest generation that has grown by enough, and those before."""
    for generation, count in reversed(list(enumerate(gc.get_count()))):
        if count > _usual[generation]:
            gc.collect(generation)
            return
