"""One range-Doppler map."""
from __future__ import annotations

import numpy as np

from echopath.plots.style import MAP_COLOURS

from ..model.cell_index import CellBox
from ..model.colours import colour_table, levels_of
from .qt import Qt, QtCore, QtGui, QtWidgets, Signal
from .ticks import nice_ticks, tick_text

LEFT, RIGHT, TOP, BOTTOM = 46, 8, 20, 32  # pixels around the map
CLICK_REACH = 4                           # pixels that a click may move
MARKER_REACH, MARKER_RADIUS = 8, 4.0     # pixels
ZOOM_STEP = 1.25
BOX_COLOUR, RAY_COLOUR = QtGui.QColor("#56b4e9"), QtGui.QColor("#7bff7b")
RANGE_LABEL, VELOCITY_LABEL = "Range in m", "Radial velocity in m/s"


class MapPanel(QtWidgets.QWidget):
    """Paints power in dBm over range and velocity and tells what is clicked, dragged and hovered."""

    cell_clicked = Signal(int, int)      # range index, velocity index
    click_undone = Signal()              # the last one was the first half of a double click
    box_dragged = Signal(object)         # CellBox
    hovered = Signal(float, float, float)  # m, m/s, dBm
    left = Signal()
    view_changed = Signal(object)        # QRectF: range, velocity
    view_reset = Signal()
    detection_clicked = Signal(int)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setMouseTracking(True)
        self.setMinimumSize(140, 110)
        self.title, self.is_current = "", False
        self.box, self.ray_cell = None, None
        self.markers, self._overlay = [], None
        self.level = self.image = None
        self.range_axis = self.velocity_axis = np.zeros(1)
        self.view = QtCore.QRectF()
        self._press = self._pan_from = self._drag = None
        self._is_clicked = False

    def show_map(self, title: str, level, spectrum, limits, view: QtCore.QRectF, *, is_current: bool) -> None:
        """level: dBm [velocity, range]; spectrum: for its axes; limits: of the colours in dBm; view: what is seen of it."""
        self.title, self.is_current, self.view = title, is_current, view
        self.level, self.limits = level, limits
        self.range_axis, self.velocity_axis = np.asarray(spectrum.range), np.asarray(spectrum.velocity)
        self._pixels = np.ascontiguousarray(levels_of(level[::-1], limits))
        height, width = self._pixels.shape
        self.image = QtGui.QImage(self._pixels.data, width, height, width, QtGui.QImage.Format.Format_Indexed8)
        self.image.setColorTable([QtGui.qRgb(*map(int, rgb)) for rgb in colour_table(MAP_COLOURS)])
        self.update()

    def show_layers(self, image, markers: list) -> None:
        """image: RGBA u8 [velocity, range, 4] over the map or None; markers: model.layers.Marker"""
        self.markers, self._overlay = markers, None
        if image is not None:
            # Grey, below colours that mean other things.
            self.image.setColorTable([QtGui.qRgb(level, level, level) for level in range(256)])
            self._overlay_pixels = np.ascontiguousarray(image[::-1])
            height, width = image.shape[:2]
            self._overlay = QtGui.QImage(self._overlay_pixels.data, width, height, 4 * width,
                                         QtGui.QImage.Format.Format_RGBA8888)
        self.update()

    def marker_at(self, at: QtCore.QPointF):
        """The marker nearest to a pixel, None where none is near."""
        near = [((self.to_pixel(marker.range, marker.velocity) - at).manhattanLength(), number)
                for number, marker in enumerate(self.markers)]
        distance, number = min(near, default=(MARKER_REACH + 1, 0))
        return self.markers[number] if distance <= MARKER_REACH else None

    def show_marks(self, box, ray_cell) -> None:
        """box: CellBox or None; ray_cell: (range index, velocity index) or None."""
        self.box, self.ray_cell = box, ray_cell
        self.update()

    def set_view(self, view: QtCore.QRectF) -> None:
        self.view = view
        self.update()

    # --- coordinates ---

    def plot_rect(self) -> QtCore.QRectF:
        return QtCore.QRectF(LEFT, TOP, max(self.width() - LEFT - RIGHT, 1), max(self.height() - TOP - BOTTOM, 1))

    def to_pixel(self, distance: float, velocity: float) -> QtCore.QPointF:
        rect = self.plot_rect()
        return QtCore.QPointF(rect.left() + (distance - self.view.left()) / self.view.width() * rect.width(),
                              rect.bottom() - (velocity - self.view.top()) / self.view.height() * rect.height())

    def to_value(self, at: QtCore.QPointF) -> tuple:
        """(range in m, velocity in m/s) at a pixel."""
        rect = self.plot_rect()
        return (self.view.left() + (at.x() - rect.left()) / rect.width() * self.view.width(),
                self.view.top() + (rect.bottom() - at.y()) / rect.height() * self.view.height())

    def cell_at(self, at: QtCore.QPointF) -> tuple:
        """(range index, velocity index) of the cell nearest to a pixel."""
        distance, velocity = self.to_value(at)
        return (nearest_index(self.range_axis, distance), nearest_index(self.velocity_axis, velocity))

    def _rect_of(self, box: CellBox) -> QtCore.QRectF:
        half_range, half_velocity = 0.5 * step_of(self.range_axis), 0.5 * step_of(self.velocity_axis)
        corner = self.to_pixel(self.range_axis[box.first_range] - half_range,
                               self.velocity_axis[box.last_velocity] + half_velocity)
        opposite = self.to_pixel(self.range_axis[box.last_range] + half_range,
                                 self.velocity_axis[box.first_velocity] - half_velocity)
        return QtCore.QRectF(corner, opposite)

    # --- painting ---

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        painter.fillRect(self.rect(), self.palette().window())
        if self.image is None or self.view.isEmpty():
            return
        rect = self.plot_rect()
        painter.fillRect(rect, QtGui.QColor(*map(int, colour_table(MAP_COLOURS)[0])))
        painter.save()
        painter.setClipRect(rect)
        everything = self._rect_of(CellBox(0, len(self.range_axis) - 1, 0, len(self.velocity_axis) - 1))
        painter.drawImage(everything, self.image)
        if self._overlay is not None:
            painter.drawImage(everything, self._overlay)
        self._paint_markers(painter)
        self._paint_marks(painter)
        painter.restore()
        self._paint_axes(painter, rect)

    def _paint_markers(self, painter) -> None:
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        for marker in self.markers:
            at, colour = self.to_pixel(marker.range, marker.velocity), QtGui.QColor(*map(int, marker.rgb))
            painter.setBrush(colour if marker.is_filled else Qt.BrushStyle.NoBrush)
            rim = QtGui.QColor("white") if marker.is_filled else colour
            for pen_colour, width in ((QtGui.QColor("black"), 3.5), (rim, 1.5)):
                painter.setPen(QtGui.QPen(pen_colour, width))
                if marker.kind == "truth":
                    painter.drawLine(at + QtCore.QPointF(-6, 0), at + QtCore.QPointF(6, 0))
                    painter.drawLine(at + QtCore.QPointF(0, -6), at + QtCore.QPointF(0, 6))
                else:
                    painter.drawEllipse(at, MARKER_RADIUS, MARKER_RADIUS)
            if marker.kind == "object":
                painter.setPen(QtGui.QColor("white"))
                painter.drawText(at + QtCore.QPointF(8, 14), marker.text)
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _paint_marks(self, painter) -> None:
        if self.box is not None:
            painter.setPen(QtGui.QPen(BOX_COLOUR, 2))
            painter.drawRect(self._rect_of(self.box).adjusted(-2, -2, 2, 2))
        if self.ray_cell is not None:
            at = self.to_pixel(self.range_axis[self.ray_cell[0]], self.velocity_axis[self.ray_cell[1]])
            painter.setPen(QtGui.QPen(RAY_COLOUR, 2))
            painter.drawEllipse(at, 6, 6)
        if self._drag is not None:
            painter.setPen(QtGui.QPen(BOX_COLOUR, 1, Qt.PenStyle.DashLine))
            painter.drawRect(QtCore.QRectF(self._press, self._drag).normalized())

    def _paint_axes(self, painter, rect) -> None:
        font = self.font()
        font.setPointSizeF(max(font.pointSizeF() - 1.5, 6.5))
        painter.setFont(font)
        painter.setPen(self.palette().windowText().color())
        for value in nice_ticks(self.view.left(), self.view.right(), rect.width() / 42):
            x = self.to_pixel(value, 0.0).x()
            painter.drawLine(QtCore.QPointF(x, rect.bottom()), QtCore.QPointF(x, rect.bottom() + 4))
            box = QtCore.QRectF(x - 30, rect.bottom() + 3, 60, 14)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, tick_text(value))
        for value in nice_ticks(self.view.top(), self.view.bottom(), rect.height() / 32):
            y = self.to_pixel(0.0, value).y()
            painter.drawLine(QtCore.QPointF(rect.left() - 4, y), QtCore.QPointF(rect.left(), y))
            box = QtCore.QRectF(12, y - 8, rect.left() - 18, 16)
            painter.drawText(box, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, tick_text(value))
        box = QtCore.QRectF(rect.left(), rect.bottom() + 15, rect.width(), 16)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, RANGE_LABEL)
        painter.save()
        painter.translate(8, rect.center().y())
        painter.rotate(-90)
        painter.drawText(QtCore.QRectF(-80, -8, 160, 14), Qt.AlignmentFlag.AlignCenter, VELOCITY_LABEL)
        painter.restore()
        self._paint_title(painter, font, rect)

    def _paint_title(self, painter, font, rect) -> None:
        font.setPointSizeF(font.pointSizeF() + 1.0)
        font.setBold(self.is_current)
        painter.setFont(font)
        title = painter.fontMetrics().elidedText(self.title, Qt.TextElideMode.ElideRight, int(rect.width()))
        painter.drawText(QtCore.QRectF(rect.left(), 2, rect.width(), 16), Qt.AlignmentFlag.AlignCenter, title)
        painter.setPen(QtGui.QPen(BOX_COLOUR if self.is_current else painter.pen().color(), 2 if self.is_current else 1))
        painter.drawRect(rect)

    # --- mouse ---

    def mousePressEvent(self, event):
        self._is_clicked = False
        if self.image is None or not self.plot_rect().contains(event.position()):
            return
        if event.button() == Qt.MouseButton.LeftButton:
            self._press = event.position()
        else:
            self._pan_from = event.position(), QtCore.QRectF(self.view)

    def mouseMoveEvent(self, event):
        if self.image is None:
            return
        if self._pan_from is not None:
            self._pan(event.position())
        elif self._press is not None and self._is_drag(event.position()):
            self._drag = event.position()
            self.update()
        if not self.plot_rect().contains(event.position()):
            self.left.emit()
            return
        marker = self.marker_at(event.position())
        self.setToolTip("" if marker is None else marker.text)
        range_index, velocity_index = self.cell_at(event.position())
        self.hovered.emit(float(self.range_axis[range_index]), float(self.velocity_axis[velocity_index]),
                          float(self.level[velocity_index, range_index]))

    def mouseReleaseEvent(self, event):
        press, self._press, self._drag, self._pan_from = self._press, None, None, None
        if press is None or self.image is None:
            return
        if (event.position() - press).manhattanLength() <= CLICK_REACH:
            self._is_clicked = True
            marker = self.marker_at(press)
            if marker is not None and marker.detection is not None:
                self.detection_clicked.emit(marker.detection)
            else:
                self.cell_clicked.emit(*self.cell_at(press))
            return
        first, last = self.cell_at(press), self.cell_at(event.position())
        (near, far), (slow, fast) = sorted((first[0], last[0])), sorted((first[1], last[1]))
        self.box_dragged.emit(CellBox(near, far, slow, fast))

    def mouseDoubleClickEvent(self, event):
        """Its first click has selected a cell at once, as no click waits for a second one: that is taken back."""
        self._press = None
        if self._is_clicked:
            self.click_undone.emit()
        if self.plot_rect().contains(event.position()):
            self.view_reset.emit()

    def leaveEvent(self, _event):
        self.left.emit()

    def wheelEvent(self, event):
        if self.image is None:
            return
        factor = ZOOM_STEP ** (-event.angleDelta().y() / 120.0)
        distance, velocity = self.to_value(event.position())
        self.view_changed.emit(QtCore.QRectF(distance - factor * (distance - self.view.left()),
                                             velocity - factor * (velocity - self.view.top()),
                                             factor * self.view.width(), factor * self.view.height()))

    def _is_drag(self, at) -> bool:
        return self._drag is not None or (at - self._press).manhattanLength() > CLICK_REACH

    def _pan(self, at) -> None:
        start, view = self._pan_from
        rect = self.plot_rect()
        self.view_changed.emit(view.translated((start.x() - at.x()) / rect.width() * view.width(),
                                               (at.y() - start.y()) / rect.height() * view.height()))


def step_of(axis) -> float:
    return float(axis[1] - axis[0]) if len(axis) > 1 else 1.0


def nearest_index(axis, value: float) -> int:
    """Of an evenly spaced ascending axis, within its ends."""
    return int(np.clip(round((value - float(axis[0])) / step_of(axis)), 0, len(axis) - 1))
