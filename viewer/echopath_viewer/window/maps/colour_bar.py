"""The colour scale of the maps."""
from __future__ import annotations

from echopath.plots.style import MAP_COLOURS

from ...model.colours import colour_table
from ..qt import Qt, QtCore, QtGui, QtWidgets
from .ticks import nice_ticks, tick_text


class ColourBar(QtWidgets.QWidget):
    """The one colour scale of some maps."""

    def __init__(self, parent=None, *, colours: str = MAP_COLOURS, unit: str = "dBm"):
        """colours: name of the map; unit: of the levels"""
        super().__init__(parent)
        self.setFixedWidth(66)
        self._colours, self._unit = colours, unit
        self.limits = (0.0, 1.0)

    def show_limits(self, low: float, high: float) -> None:
        self.limits = (low, high)
        self.update()

    def paintEvent(self, _event):
        self.paint(QtGui.QPainter(self))

    def paint(self, painter) -> None:
        """Draws the scale with a painter of the screen, or of a file."""
        painter.fillRect(self.rect(), self.palette().window())
        bar = QtCore.QRectF(8, 20, 14, max(self.height() - 52, 1))
        gradient = QtGui.QLinearGradient(bar.bottomLeft(), bar.topLeft())
        table = colour_table(self._colours)
        for step in range(0, 256, 15):
            gradient.setColorAt(step / 255.0, QtGui.QColor(*map(int, table[step])))
        painter.fillRect(bar, gradient)
        painter.setPen(self.palette().windowText().color())
        low, high = self.limits
        for value in nice_ticks(low, high, bar.height() / 30.0):
            y = bar.bottom() - (value - low) / max(high - low, 1e-9) * bar.height()
            painter.drawText(QtCore.QRectF(26, y - 8, 40, 16), Qt.AlignmentFlag.AlignVCenter, tick_text(value))
        painter.drawText(QtCore.QRectF(4, 2, 60, 16), Qt.AlignmentFlag.AlignLeft, self._unit)
