"""Axes and a scale over a corner of the 3-D view."""
from __future__ import annotations

import numpy as np

from ..maps.ticks import nice_below
from ..qt import Qt, QtCore, QtGui, QtWidgets

EDGE, SIZE, ARM = 10, QtCore.QSize(150, 84), 24.0  # pixels
BAR = 110.0  # pixels, at most
COLOURS = {"x": ("#cc3311", "#ff7d5c"), "y": ("#007a4d", "#33cc99"), "z": ("#0066cc", "#66aaff")}  # on light, on dark


class Compass(QtWidgets.QWidget):
    """The directions of the axes as the camera sees them, and how long a metre is at the point that it turns about."""

    def __init__(self, parent):
        super().__init__(parent)
        self.resize(SIZE)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.axes, self.metres, self.pixels = np.eye(3)[:, :2], 1.0, 0.0
        self.hide()

    def place(self) -> None:
        """In the lower left corner of its parent."""
        self.move(EDGE, max(self.parent().height() - self.height() - EDGE, 0))

    def follow(self, camera, height: int) -> None:
        """camera: pyvista.Camera; height: of the picture in pixels."""
        position, focus = np.array(camera.position), np.array(camera.focal_point)
        ahead = focus - position
        distance = float(np.linalg.norm(ahead))
        if not distance > 0.0 or height < 1:
            return
        right = np.cross(ahead, camera.up)
        right /= max(np.linalg.norm(right), 1e-12)
        upward = np.cross(right, ahead / distance)
        axes = np.stack([right, upward], axis=1)
        metre = height / (2.0 * distance * np.tan(0.5 * np.radians(camera.view_angle)))  # pixels
        metres = nice_below(BAR / metre)
        if not np.array_equal(axes, self.axes) or metres * metre != self.pixels:
            self.axes, self.metres, self.pixels = axes, metres, metres * metre
            self.update()
        self.place()
        self.setVisible(True)

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        origin = QtCore.QPointF(34.0, 30.0)
        is_dark = self.parent().palette().base().color().lightness() < 128
        for name, (across, up) in zip("xyz", self.axes):
            end = origin + QtCore.QPointF(ARM * across, -ARM * up)
            painter.setPen(QtGui.QPen(QtGui.QColor(COLOURS[name][is_dark]), 2))
            painter.drawLine(origin, end)
            painter.drawText(end + QtCore.QPointF(4.0 * across - 3.0, -5.0 * up + 4.0), name)
        painter.setPen(QtGui.QPen(self.parent().palette().windowText().color(), 1.5))
        left, bottom = 4.0, float(self.height() - 6)
        painter.drawPolyline(QtGui.QPolygonF([QtCore.QPointF(left, bottom - 4), QtCore.QPointF(left, bottom),
                                              QtCore.QPointF(left + self.pixels, bottom),
                                              QtCore.QPointF(left + self.pixels, bottom - 4)]))
        painter.drawText(QtCore.QPointF(left + 4, bottom - 8), f"{self.metres:g} m at the centre")
