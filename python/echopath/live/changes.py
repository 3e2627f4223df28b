"""The changes of a live scene, counted, one at a time."""
from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager


class Changes:
    """How many changes were made; threads make them one at a time and wait for them."""

    def __init__(self) -> None:
        self.number = 0
        self._lock, self._made = threading.RLock(), threading.Condition()
        self._depth, self._has_edited = 0, False  # of the change that is made now

    @contextmanager
    def one(self) -> Iterator[None]:
        """Makes one; those within it are parts of it. It counts when it has gone well, or a part of it has."""
        with self._lock:
            self._depth += 1
            try:
                yield
                self._has_edited = True
            finally:
                self._depth -= 1
                if self._depth == 0 and self._has_edited:
                    self._has_edited = False
                    self._count()

    def _count(self) -> None:
        with self._made:
            self.number += 1
            self._made.notify_all()

    def still(self) -> threading.RLock:
        """The lock that keeps changes away."""
        return self._lock

    def wait_for_other(self, number: int, timeout: float) -> bool:
        """Waits until the last change is another than `number`, for timeout s at most. Returns whether it is."""
        with self._made:
            return self._made.wait_for(lambda: self.number != number, timeout)
