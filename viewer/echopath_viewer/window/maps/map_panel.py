"""One range-Doppler map."""
from __future__ import annotations

import functools

import numpy as np

from echopath.plots.style import MAP_COLOURS

from ...model.colours import colour_table, levels_of
from ...model.maps.cell_index import CellBox
from ..qt import Qt, QtCore, QtGui, QtWidgets, Signal
from .map_mouse import MapMouse
from .ticks import axis_ticks, step_of, tick_text

LEFT, RIGHT, TOP, BOTTOM = 46, 8, 20, 32  # pixels around the map
MARKER_REACH, MARKER_RADIUS = 8, 4.0     # pixels
NAME_ASIDE = 8.0, 2.0  # pixels from a marker to its name, across and down
FILE_SCALE = 4.0  # pixels of maps in files to one of the screen
BOX_COLOUR, RAY_COLOUR = QtGui.QColor("#56b4e9"), QtGui.QColor("#7bff7b")
RANGE_LABEL, VELOCITY_LABEL = "Range in m", "Radial velocity in m/s"


class MapPanel(MapMouse, QtWidgets.QWidget):
    """Paints power in dBm over range and velocity and tells what is clicked, dragged and hovered."""

    cell_clicked = Signal(int, int)      # range index, velocity index
    click_undone = Signal()              # the last one was the first half of a double click
    box_dragged = Signal(object)         # CellBox
    hovered = Signal(float, float, float)  # m, m/s, dBm
    left = Signal()
    view_changed = Signal(object)        # QRectF: range, velocity
    view_reset = Signal()
    detection_clicked = Signal(int)

    def __init__(self, parent=None, *, x_label=RANGE_LABEL, y_label=VELOCITY_LABEL, colours=MAP_COLOURS,
                 outside: int = 0):
        """x_label, y_label: of the axes; colours: name of the colour map; outside: its colour beyond the map, 0 to 255."""
        super().__init__(parent)
        self.x_label, self.y_label, self._colours, self._outside = x_label, y_label, colours, outside
        self.setMouseTracking(True)
        self.setMinimumSize(140, 110)
        self.title, self.is_current = "", False
        self.box, self.ray_cell = None, None
        self.markers, self._overlay = [], None
        self.level = self.image = None
        self.range_axis = self.velocity_axis = np.zeros(1)
        self.view = QtCore.QRectF()
        self._changes, self._painted_looks, self._painted = 0, None, None
        self._press = self._pan_from = self._drag = None
        self._is_clicked = False

    def show_map(self, title: str, level, spectrum, limits, view: QtCore.QRectF, *, is_current: bool) -> None:
        """level: dBm [velocity, range]; spectrum: for its axes; limits: of the colours in dBm; view: what is seen of it."""
        self.title, self.is_current, self.view = title, is_current, view
        self._changes += 1
        self.level, self.limits = level, limits
        self.range_axis, self.velocity_axis = np.asarray(spectrum.range), np.asarray(spectrum.velocity)
        self._pixels = np.ascontiguousarray(levels_of(level[::-1], limits))
        height, width = self._pixels.shape
        self.image = QtGui.QImage(self._pixels.data, width, height, width, QtGui.QImage.Format.Format_Indexed8)
        self.image.setColorTable(_colour_list(self._colours))
        self.update()

    def show_nothing(self) -> None:
        """There is no map."""
        self.image = None
        self._changes += 1
        self.update()

    def show_layers(self, image, markers: list) -> None:
        """image: RGBA u8 [velocity, range, 4] over the map or None; markers: model.layers.Marker"""
        self.markers, self._overlay = markers, None
        self._changes += 1
        if image is not None:
            # Grey, below colours that mean other things.
            self.image.setColorTable([QtGui.qRgb(level, level, level) for level in range(256)])
            self._overlay_pixels = np.ascontiguousarray(image[::-1])
            height, width = image.shape[:2]
            self._overlay = QtGui.QImage(self._overlay_pixels.data, width, height, 4 * width,
                                         QtGui.QImage.Format.Format_RGBA8888)
        self.update()

    def marker_at(self, at: QtCore.QPointF, kind: str | None = None):
        """The marker nearest to a pixel, of one kind or of all, None where none is near."""
        near = [((self.to_pixel(marker.range, marker.velocity) - at).manhattanLength(), number)
                for number, marker in enumerate(self.markers) if kind in (None, marker.kind)]
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

    def _rect_of(self, box: CellBox | None) -> QtCore.QRectF:
        cells = extent_of(self.range_axis, self.velocity_axis, box)
        return QtCore.QRectF(self.to_pixel(cells.left(), cells.bottom()), self.to_pixel(cells.right(), cells.top()))

    # --- painting ---

    def paintEvent(self, _event):
        """Marks over a picture of the map, which is painted anew only when something else has changed."""
        painter = QtGui.QPainter(self)
        looks = self._changes, self.size(), QtCore.QRectF(self.view), self.devicePixelRatioF(), self.palette().cacheKey()
        if looks != self._painted_looks:
            self._painted_looks, self._painted = looks, QtGui.QPixmap(self.size() * self.devicePixelRatioF())
            self._painted.setDevicePixelRatio(self.devicePixelRatioF())
            base = QtGui.QPainter(self._painted)
            base.setFont(self.font())
            self._paint_base(base)
            base.end()
        painter.drawPixmap(0, 0, self._painted)
        self._paint_over(painter)

    def paint(self, painter) -> None:
        """Draws the panel with the painter of a file."""
        self._paint_base(painter, is_file=True)
        self._paint_over(painter)

    def _paint_over(self, painter) -> None:
        if self.image is None or self.view.isEmpty():
            return
        painter.save()
        painter.setClipRect(self.plot_rect())
        self._paint_markers(painter)
        self._paint_marks(painter)
        painter.restore()

    def _paint_base(self, painter, is_file: bool = False) -> None:
        painter.fillRect(self.rect(), self.palette().window())
        if self.image is None or self.view.isEmpty():
            return
        rect = self.plot_rect()
        painter.fillRect(rect, QtGui.QColor(*map(int, colour_table(self._colours)[self._outside])))
        painter.save()
        painter.setClipRect(rect)
        self._paint_image(painter, rect, self.image, is_file)
        if self._overlay is not None:
            self._paint_image(painter, rect, self._overlay, is_file)
        painter.restore()
        self._paint_axes(painter, rect)

    def _paint_image(self, painter, rect, image, is_file: bool) -> None:
        """What is seen of it. is_file: cut out before, as painters of SVG files draw whole images."""
        everything = self._rect_of(None)
        seen = everything.intersected(rect)
        across, down = image.width() / everything.width(), image.height() / everything.height()
        source = QtCore.QRectF((seen.left() - everything.left()) * across, (seen.top() - everything.top()) * down,
                               seen.width() * across, seen.height() * down)
        if is_file:
            painter.drawImage(seen, _cut_out(image, source, seen.size()))
        else:
            painter.drawImage(seen, image, source)

    def _paint_markers(self, painter) -> None:
        seen = self.plot_rect()
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        for marker in self.markers:
            at, colour = self.to_pixel(marker.range, marker.velocity), QtGui.QColor(*map(int, marker.rgb))
            if not seen.contains(at):
                continue
            painter.setBrush(colour if marker.is_filled else Qt.BrushStyle.NoBrush)
            rim = QtGui.QColor("white") if marker.is_filled else colour
            for pen_colour, width in ((QtGui.QColor("black"), 3.5), (rim, 1.5)):
                painter.setPen(QtGui.QPen(pen_colour, width))
                if marker.kind == "truth":
                    painter.drawLine(at + QtCore.QPointF(-6, 0), at + QtCore.QPointF(6, 0))
                    painter.drawLine(at + QtCore.QPointF(0, -6), at + QtCore.QPointF(0, 6))
                else:
                    painter.drawEllipse(at, MARKER_RADIUS, MARKER_RADIUS)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QtGui.QColor("white"))
        for text, rect in self.names_of_objects(painter.fontMetrics()):
            painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, text)

    def names_of_objects(self, metrics) -> list:
        """(text, QRectF) of the names beside the markers of objects, within the map; those that would stand on others are told by
        the mouse."""
        seen, found = self.plot_rect(), []
        for marker in self.markers:
            at = self.to_pixel(marker.range, marker.velocity)
            if marker.kind != "object" or not seen.contains(at):
                continue
            rect = _beside(at, QtCore.QSizeF(metrics.size(0, marker.text)), seen)
            if not any(rect.intersects(other) for _, other in found):
                found.append((marker.text, rect))
        return found

    def _paint_marks(self, painter) -> None:
        if self.box is not None:
            painter.setPen(QtGui.QPen(BOX_COLOUR, 2))
            painter.drawRect(self._rect_of(self.box).adjusted(-2, -2, 2, 2).intersected(self.plot_rect()))
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
        for value in axis_ticks(self.range_axis, self.view.left(), self.view.right(), rect.width() / 42):
            x = self.to_pixel(value, 0.0).x()
            painter.drawLine(QtCore.QPointF(x, rect.bottom()), QtCore.QPointF(x, rect.bottom() + 4))
            box = QtCore.QRectF(x - 30, rect.bottom() + 3, 60, 14)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, tick_text(value))
        most = max(rect.height() / 32, min(3.0, rect.height() / 12))
        for value in axis_ticks(self.velocity_axis, self.view.top(), self.view.bottom(), most):
            y = self.to_pixel(0.0, value).y()
            painter.drawLine(QtCore.QPointF(rect.left() - 4, y), QtCore.QPointF(rect.left(), y))
            box = QtCore.QRectF(12, y - 8, rect.left() - 18, 16)
            painter.drawText(box, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, tick_text(value))
        box = QtCore.QRectF(rect.left(), rect.bottom() + 15, rect.width(), 16)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, self.x_label)
        painter.save()
        painter.translate(8, rect.center().y())
        painter.rotate(-90)
        painter.drawText(QtCore.QRectF(-90, -8, 180, 14), Qt.AlignmentFlag.AlignCenter, self.y_text(painter.fontMetrics()))
        painter.restore()
        self._paint_title(painter, font, rect)

    def y_text(self, metrics) -> str:
        """The label of the vertical axis, its unit alone where there is no room for more; metrics: of its font."""
        middle = self.plot_rect().center().y()
        has_room = metrics.horizontalAdvance(self.y_label) <= 2.0 * min(middle, self.height() - middle)
        return self.y_label if has_room else self.y_label.rpartition(" in ")[2]

    def _paint_title(self, painter, font, rect) -> None:
        font.setPointSizeF(font.pointSizeF() + 1.0)
        font.setBold(self.is_current)
        painter.setFont(font)
        # Names of parts and frames differ at their ends.
        title = painter.fontMetrics().elidedText(self.title, Qt.TextElideMode.ElideMiddle, int(rect.width()))
        painter.drawText(QtCore.QRectF(rect.left(), 2, rect.width(), 16), Qt.AlignmentFlag.AlignCenter, title)
        painter.setPen(QtGui.QPen(BOX_COLOUR if self.is_current else painter.pen().color(), 2 if self.is_current else 1))
        painter.drawRect(rect)


def _beside(at: QtCore.QPointF, size: QtCore.QSizeF, seen: QtCore.QRectF) -> QtCore.QRectF:
    """Where a name of that size stands: right below a marker, left or above where it would reach over the edge of the map."""
    rect = QtCore.QRectF(at + QtCore.QPointF(*NAME_ASIDE), size)
    if rect.right() > seen.right():
        rect.moveRight(at.x() - NAME_ASIDE[0])
    if rect.bottom() > seen.bottom():
        rect.moveBottom(at.y() - NAME_ASIDE[1])
    return rect


def _cut_out(image, source: QtCore.QRectF, size: QtCore.QSizeF) -> QtGui.QImage:
    """A part of an image, `size` large in pixels of the screen, whose cells are cut where the part ends."""
    part = QtGui.QImage((FILE_SCALE * size).toSize().expandedTo(QtCore.QSize(1, 1)), QtGui.QImage.Format.Format_ARGB32)
    part.fill(Qt.GlobalColor.transparent)
    painter = QtGui.QPainter(part)
    painter.drawImage(QtCore.QRectF(part.rect()), image, source)
    painter.end()
    return part


@functools.cache
def _colour_list(name: str) -> list:
    """Of a colour map, as images take it: kept, as making it takes longer than all else of a map."""
    return [QtGui.qRgb(*map(int, rgb)) for rgb in colour_table(name)]


def extent_of(x, y, box: CellBox | None = None) -> QtCore.QRectF:
    """From edge to edge of the cells of a box, or of all cells, in the units of both axes."""
    box = CellBox(0, len(x) - 1, 0, len(y) - 1) if box is None else box
    half = 0.5 * step_of(x), 0.5 * step_of(y)
    return QtCore.QRectF(QtCore.QPointF(x[box.first_range] - half[0], y[box.first_velocity] - half[1]),
                         QtCore.QPointF(x[box.last_range] + half[0], y[box.last_velocity] + half[1]))


def nearest_index(axis, value: float) -> int:
    """Of an evenly spaced ascending axis, within its ends."""
    return int(np.clip(round((value - float(axis[0])) / step_of(axis)), 0, len(axis) - 1))
