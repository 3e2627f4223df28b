"""A line that says what is wrong, and what else stands around the views."""
from __future__ import annotations

from .qt import Qt, QtWidgets

BAR_STEPS = 1000


class ThinBar(QtWidgets.QProgressBar):
    """How far something is. One that only moves would have software paint the whole window at each step."""

    def __init__(self):
        super().__init__(textVisible=False, minimum=0, maximum=BAR_STEPS, visible=False)
        self.setFixedHeight(4)

    def begin(self) -> None:
        """From the left, seen from now on."""
        self.setValue(0)
        self.show()

    def advance(self, share: float) -> None:
        """share: of the work that is done, 0 to 1."""
        self.setValue(int(BAR_STEPS * share))


class Banner(QtWidgets.QLabel):
    """A line that says what is wrong, until it is clicked."""

    def __init__(self):
        super().__init__(visible=False, wordWrap=True, textFormat=Qt.TextFormat.PlainText)
        self.setStyleSheet("background: #fdecea; color: #7a1f14; padding: 8px; border-bottom: 1px solid #c0392b")
        self.setToolTip("Click to close")

    def mousePressEvent(self, _event):
        self.hide()
