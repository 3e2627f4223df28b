"""What was shown before, to go back to."""
from __future__ import annotations

MOST_STATES = 100


class History:
    """States of a view in order, with the one that is shown now."""

    def __init__(self):
        self._states, self._at = [], -1

    def record(self, state: dict) -> None:
        """Takes a state down where it is another one than that shown last; what was undone is forgotten then."""
        if self._at >= 0 and state == self._states[self._at]:
            return
        self._states = [*self._states[:self._at + 1], state][-MOST_STATES:]
        self._at = len(self._states) - 1

    def back(self) -> dict | None:
        """The state before, None at the first."""
        return self._move(-1)

    def forward(self) -> dict | None:
        """The state that was undone last, None where there is none."""
        return self._move(1)

    def _move(self, step: int) -> dict | None:
        if not 0 <= self._at + step < len(self._states):
            return None
        self._at += step
        return self._states[self._at]
