"""Curves over one axis."""
from __future__ import annotations

import numpy as np

from echopath.plots.style import CURVE_COLOURS

from ..qt import Qt, QtCore, QtGui, QtWidgets
from .ticks import nice_ticks, scientific_text, tick_text

LEFT, RIGHT, TOP, BOTTOM = 62, 8, 20, 34  # pixels around the curves


class CurveView(QtWidgets.QWidget):
    """Paints some curves with their names, on one scale."""

    def __init__(self, x_label: str, unit: str, parent=None):
        """x_label: below; unit: of the values, left of them."""
        super().__init__(parent)
        self.setMinimumSize(180, 110)
        self._x_label, self._unit = x_label, unit
        self.title, self.x, self.curves = "", np.zeros(0), {}

    def show_curves(self, title: str, x, curves: dict) -> None:
        """x: [N] ascending; curves: {name: [N]}"""
        self.title, self.x, self.curves = title, np.asarray(x), curves
        self.update()

    def paintEvent(self, _event):
        self.paint(QtGui.QPainter(self))

    def paint(self, painter) -> None:
        """Draws the curves with a painter of the screen, or of a file."""
        rect = QtCore.QRectF(LEFT, TOP, max(self.width() - LEFT - RIGHT, 1), max(self.height() - TOP - BOTTOM, 1))
        painter.fillRect(rect, self.palette().base())
        painter.setPen(self.palette().windowText().color())
        painter.drawText(QtCore.QRectF(LEFT, 2, rect.width(), 16), Qt.AlignmentFlag.AlignCenter, self.title)
        if len(self.x) < 2:
            return
        largest = max(float(np.abs(values).max()) for values in self.curves.values()) or 1.0
        self._paint_axes(painter, rect, largest)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        for number, (name, values) in enumerate(self.curves.items()):
            colour = QtGui.QColor(CURVE_COLOURS[number])
            across = rect.left() + (self.x - self.x[0]) / (self.x[-1] - self.x[0]) * rect.width()
            down = rect.center().y() - values / largest * 0.45 * rect.height()
            painter.setPen(QtGui.QPen(colour, 1.2))
            painter.drawPolyline(QtGui.QPolygonF([QtCore.QPointF(*at) for at in zip(across.tolist(), down.tolist())]))
            at = QtCore.QPointF(rect.left() + 6 + 90 * number, rect.top() + 10)
            painter.fillRect(QtCore.QRectF(at.x() - 3, rect.top() + 1, 88, 18), self.palette().base())
            painter.setPen(QtGui.QPen(colour, 3.0))
            painter.drawLine(at, at + QtCore.QPointF(14, 0))
            painter.setPen(self.palette().text().color())
            painter.drawText(QtCore.QRectF(at.x() + 19, rect.top() + 2, 70, 16), Qt.AlignmentFlag.AlignLeft, name)

    def _paint_axes(self, painter, rect, largest: float) -> None:
        for value in nice_ticks(float(self.x[0]), float(self.x[-1]), rect.width() / 50.0):
            x = rect.left() + (value - self.x[0]) / (self.x[-1] - self.x[0]) * rect.width()
            painter.drawLine(QtCore.QPointF(x, rect.bottom()), QtCore.QPointF(x, rect.bottom() + 4))
            painter.drawText(QtCore.QRectF(x - 30, rect.bottom() + 3, 60, 14), Qt.AlignmentFlag.AlignCenter, tick_text(value))
        for share in (-1, 0, 1):
            y = rect.center().y() - share * 0.45 * rect.height()
            painter.drawText(QtCore.QRectF(0, y - 8, LEFT - 6, 16), Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter,
                             "0" if share == 0 else scientific_text(share * largest))
        painter.drawText(QtCore.QRectF(2, 2, LEFT, 16), Qt.AlignmentFlag.AlignLeft, self._unit)
        painter.drawText(QtCore.QRectF(rect.left(), rect.bottom() + 17, rect.width(), 16), Qt.AlignmentFlag.AlignCenter,
                         self._x_label)
