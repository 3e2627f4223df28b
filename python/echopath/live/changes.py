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

    @contextmanager
    def one(self) -> Iterator[None]:
        """Makes one; it counts when it has gone well."""
        with self._lock:
            yield
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
