"""What is made of objects, once of each."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any


class MadeOnce:
    """Keeps what was made of objects, and these themselves: else another one could get the id of one that nobody keeps."""

    def __init__(self):
        self._made: dict[tuple, tuple] = {}

    def of(self, given, make: Callable[[Any], Any], *key):
        """What `make` made of the object when it was first asked for with an equal key."""
        place = id(given), *key
        if place not in self._made:
            self._made[place] = given, make(given)
        return self._made[place][1]
