"""Colours in rows of lists."""
from __future__ import annotations

from .qt import QtGui

SIZE = 12  # pixels


def swatch(colour: QtGui.QColor) -> QtGui.QIcon:
    """A square of one colour, as an icon."""
    pixmap = QtGui.QPixmap(SIZE, SIZE)
    pixmap.fill(colour)
    return QtGui.QIcon(pixmap)
