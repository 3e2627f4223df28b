"""A line that says what is wrong, and what else stands around the views."""
from __future__ import annotations

from .qt import QtWidgets


def thin_bar() -> QtWidgets.QProgressBar:
    """That something is under way, without a number."""
    bar = QtWidgets.QProgressBar(textVisible=False, minimum=0, maximum=0, visible=False)
    bar.setFixedHeight(4)
    return bar


class Banner(QtWidgets.QLabel):
    """A line that says what is wrong, until it is clicked."""

    def __init__(self):
        super().__init__(visible=False, wordWrap=True)
        self.setStyleSheet("background: #fdecea; color: #7a1f14; padding: 8px; border-bottom: 1px solid #c0392b")
        self.setToolTip("Click to close")

    def mousePressEvent(self, _event):
        self.hide()
