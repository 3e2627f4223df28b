"""What the mouse does to a map."""
from __future__ import annotations

from ...model.maps.cell_index import CellBox
from ..qt import Qt, QtCore
from .ticks import step_of

CLICK_REACH = 4  # pixels that a click may move
ZOOM_STEP = 1.25


class MapMouse:
    """Part of MapPanel: clicks, rectangles, moving and zooming, which it tells by its signals."""

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
        if not self._is_over_cell(event.position()):
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
            marker = self.marker_at(press, "detection")  # whatever stands over it
            if marker is not None:
                self.detection_clicked.emit(marker.detection)
            elif self._is_over_cell(press):
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
        across = _limited(factor, self.view.width(), self.range_axis)
        along = _limited(factor, self.view.height(), self.velocity_axis)
        distance, velocity = self.to_value(event.position())
        self.view_changed.emit(QtCore.QRectF(distance - across * (distance - self.view.left()),
                                             velocity - along * (velocity - self.view.top()),
                                             across * self.view.width(), along * self.view.height()))

    def _is_over_cell(self, at) -> bool:
        """Whether a pixel shows the map and not what lies beyond its ends."""
        return self.plot_rect().contains(at) and all(
            axis[0] - 0.5 * step_of(axis) <= value <= axis[-1] + 0.5 * step_of(axis)
            for value, axis in zip(self.to_value(at), (self.range_axis, self.velocity_axis)))

    def _is_drag(self, at) -> bool:
        return self._drag is not None or (at - self._press).manhattanLength() > CLICK_REACH

    def _pan(self, at) -> None:
        start, view = self._pan_from
        rect = self.plot_rect()
        self.view_changed.emit(view.translated((start.x() - at.x()) / rect.width() * view.width(),
                                               (at.y() - start.y()) / rect.height() * view.height()))


def _limited(factor: float, length: float, axis) -> float:
    """A factor of the length that is seen of an axis: from a cell to all of it, where its ticks can be told apart."""
    cell = step_of(axis)
    return min(max(factor, min(cell / length, 1.0)), max(len(axis) * cell / length, 1.0))
