"""What the colours of rays mean, over a corner of the 3-D view."""
from __future__ import annotations

from ...model.colours import colour_table
from ..maps.ticks import nice_ticks, tick_text
from ..qt import Qt, QtCore, QtGui, QtWidgets, Signal

EDGE, MARGIN, SWATCH = 10, 8, 12   # pixels
SCALE_WIDTH, BAR_HEIGHT = 240, 12
MOST_SHARE = 0.45                  # of the width of the view: longer names are cut in their middle
PAPER_ALPHA = 225                  # of 255: rays behind it are seen a little
HINT = "Click an object: show it alone, again: show all"


class LegendBox(QtWidgets.QWidget):
    """Rows of colours or a scale in the lower right corner of its parent, in the colours of the theme."""

    row_clicked = Signal(str)

    def __init__(self, parent):
        super().__init__(parent)
        self.legend = None
        self.hide()

    def show(self, legend=None) -> None:
        """legend: model.Legend; None: the one of before."""
        if legend is not None and legend != self.legend:
            self.legend = legend
            self.setToolTip(HINT if legend.rows and "Object" in legend.title else "")
            self.place()
            self.update()
        self.setVisible(self.legend is not None and bool(self.legend.rows or self.legend.clim))

    def place(self) -> None:
        """In its size, in its corner."""
        if self.legend is None:
            return
        self.resize(self._size())
        self.move(max(self.parent().width() - self.width() - EDGE, 0), max(self.parent().height() - self.height() - EDGE, 0))

    def _line(self) -> int:
        return self.fontMetrics().height() + 2

    def _size(self) -> QtCore.QSize:
        width = self.fontMetrics().horizontalAdvance
        if self.legend.clim is not None:
            height = 2 * MARGIN + 2 * self._line() + BAR_HEIGHT
            return QtCore.QSize(max(SCALE_WIDTH, width(self.legend.title)) + 4 * MARGIN, height)
        widest = max([width(self.legend.title), *(width(text) + SWATCH + 6 for text in self.legend.texts())])
        most = max(int(MOST_SHARE * self.parent().width()), width(self.legend.title) + 2 * MARGIN)
        return QtCore.QSize(min(widest + 2 * MARGIN, most), 2 * MARGIN + self._line() * (1 + len(self.legend.texts())))

    def mousePressEvent(self, event):
        row = (int(event.position().y()) - MARGIN) // self._line() - 1
        if self.legend.clim is None and 0 <= row < len(self.legend.rows):
            self.row_clicked.emit(self.legend.rows[row][0])

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        paper = self.palette().base().color()
        paper.setAlpha(PAPER_ALPHA)
        painter.fillRect(self.rect(), paper)
        painter.setPen(self.palette().text().color())
        painter.drawText(QtCore.QRect(MARGIN, MARGIN, self.width(), self._line()), Qt.AlignmentFlag.AlignLeft, self.legend.title)
        if self.legend.clim is None:
            self._paint_rows(painter)
        else:
            self._paint_scale(painter)

    def _paint_rows(self, painter) -> None:
        line = self._line()
        for number, text in enumerate(self.legend.texts()):
            top, left = MARGIN + line * (number + 1), MARGIN
            if number < len(self.legend.rows):
                square = QtCore.QRect(left, top + (line - SWATCH) // 2 - 1, SWATCH, SWATCH)
                painter.fillRect(square, QtGui.QColor(*self.legend.rows[number][1]))
                painter.drawRect(square)
            room = QtCore.QRect(left + SWATCH + 6, top, self.width() - 2 * MARGIN - SWATCH - 6, line)
            shown = self.fontMetrics().elidedText(text, Qt.TextElideMode.ElideMiddle, room.width())  # names differ at their ends
            painter.drawText(room, Qt.AlignmentFlag.AlignLeft, shown)

    def _paint_scale(self, painter) -> None:
        low, high = self.legend.clim
        bar = QtCore.QRectF(2 * MARGIN, MARGIN + self._line() + 2, self.width() - 4 * MARGIN, BAR_HEIGHT)
        gradient = QtGui.QLinearGradient(bar.topLeft(), bar.topRight())
        for step, rgb in enumerate(colour_table(self.legend.cmap)):
            gradient.setColorAt(step / 255.0, QtGui.QColor(*map(int, rgb)))
        painter.fillRect(bar, gradient)
        for value in nice_ticks(low, high, bar.width() / 55.0):
            x = bar.left() + (value - low) / max(high - low, 1e-12) * bar.width()
            box = QtCore.QRectF(x - 30, bar.bottom() + 1, 60, self._line())
            painter.drawText(box, Qt.AlignmentFlag.AlignHCenter, tick_text(value))
