"""Complex contributions as arrows, head to tail."""
from __future__ import annotations

import numpy as np

from ..qt import Qt, QtCore, QtGui, QtWidgets

MAX_ARROWS = 8
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d1f", "#7f7f7f")  # Okabe and Ito
MARGIN, HEAD = 12, 7.0  # pixels


class PhasorDiagram(QtWidgets.QWidget):
    """The contributions to a cell, turned so that their sum points to the right: what points to the left takes away."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setMinimumSize(110, 90)
        self.setToolTip("Complex contributions, head to tail, strongest first; the thick arrow is their sum, the cell's value.")
        self.steps = np.zeros(0, complex)

    def show_values(self, values, total: complex) -> None:
        """values: complex [N], strongest first, which add up to `total`; beyond the first ones they are one arrow."""
        values = np.asarray(values, complex)
        turned = values * np.exp(-1j * np.angle(total))
        first, rest = turned[:MAX_ARROWS - 1], turned[MAX_ARROWS - 1:]
        self.steps = np.append(first, rest.sum()) if len(rest) else first
        self.update()

    def corners(self):
        """Complex [N + 1], where the arrows begin and end."""
        return np.concatenate([[0.0], np.cumsum(self.steps)])

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), self.palette().base())
        corners = self.corners()
        if len(corners) < 2 or not np.abs(corners).max() > 0.0:
            return
        points = self._pixels(corners)
        ink = self.palette().text().color()
        _draw_arrow(painter, points[0], points[-1], QtGui.QPen(ink, 3.5))
        for number, (begin, end) in enumerate(zip(points[:-1], points[1:])):
            _draw_arrow(painter, begin, end, QtGui.QPen(QtGui.QColor(COLOURS[number]), 2.0))
        painter.setPen(ink)
        corner = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignTop
        painter.drawText(self.rect().adjusted(4, 2, -4, -2), corner, "sum: thick")

    def _pixels(self, corners) -> list:
        """The whole figure in the middle, as large as it fits."""
        low, high = complex(corners.real.min(), corners.imag.min()), complex(corners.real.max(), corners.imag.max())
        width, height = max(self.width() - 2 * MARGIN, 1), max(self.height() - 2 * MARGIN, 1)
        span = high - low
        scale = min(width / max(span.real, 1e-300), height / max(span.imag, 1e-300))
        middle = 0.5 * (low + high)
        return [QtCore.QPointF(0.5 * self.width() + scale * (corner - middle).real,
                               0.5 * self.height() - scale * (corner - middle).imag) for corner in corners]


def _draw_arrow(painter, begin, end, pen) -> None:
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    painter.setPen(pen)
    painter.drawLine(begin, end)
    line = QtCore.QLineF(end, begin)
    if line.length() < 1.0:
        return
    for turn in (25.0, -25.0):
        barb = QtCore.QLineF(line)
        barb.setLength(min(HEAD + pen.widthF(), line.length()))
        barb.setAngle(line.angle() + turn)
        painter.drawLine(barb)
