"""Pictures of the window in any resolution, and its maps as drawings of lines."""
from __future__ import annotations

import numpy as np

from ..qt import Qt, QtCore, QtGui, QtWidgets

MAX_SCALE = 8
POINTS_PER_PIXEL = 0.75  # of a PDF page, whose unit is 1/72 inch


def picture_of(window, scale: int) -> QtGui.QImage:
    """The window with `scale` times as many pixels along each axis: text and maps drawn anew, the scene rendered anew."""
    if not 1 <= scale <= MAX_SCALE:
        raise ValueError(f"scale: must be 1 to {MAX_SCALE}, got {scale}")
    if scale == 1:
        return window.grab().toImage()
    image = QtGui.QImage(window.size() * scale, QtGui.QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(scale)
    window.render(image)
    if window.session is not None:
        _paint_scene(window, image, scale)
    return image


def _paint_scene(window, image, scale: int) -> None:
    """Over what the widget has in its own resolution."""
    from ...scene_builder.still import still_of

    view, strip = window.view3d, window.frame_bar.strip
    pixels = np.ascontiguousarray(still_of(window.session, (view.width(), view.height()), scale, camera=view.camera,
                                           show_hits=view.builder.show_hits, background=view.background(),
                                           tracks=strip.tracks, places=strip.places))
    height, width = pixels.shape[:2]
    still = QtGui.QImage(pixels.data, width, height, 3 * width, QtGui.QImage.Format.Format_RGB888)
    painter = QtGui.QPainter(image)
    corner = view.mapTo(window, QtCore.QPoint(0, 0))
    painter.drawImage(QtCore.QRectF(QtCore.QPointF(corner), QtCore.QSizeF(view.size())), still)
    painter.end()
    for box in (view.name_box, view.legend_box, view.compass):
        if box.isVisible():
            box.render(image, box.mapTo(window, QtCore.QPoint(0, 0)), renderFlags=QtWidgets.QWidget.RenderFlag.DrawChildren)


def png_of(picture: QtGui.QImage) -> bytes:
    """The picture as a file, in memory: Qt tells nobody of a disk that is full."""
    file = QtCore.QBuffer()
    file.open(QtCore.QIODevice.OpenModeFlag.WriteOnly)
    if not picture.save(file, "PNG"):
        raise ValueError(f"picture: {picture.width()} x {picture.height()} pixels cannot be written as PNG")
    return file.data().data()


def drawing_of(map_area, kind: str) -> bytes:
    """A file, in memory, of all maps that are on display with the colour scale: text and axes are lines, the cells an image.

    kind: ".svg" or ".pdf"
    """
    file = QtCore.QBuffer()
    file.open(QtCore.QIODevice.OpenModeFlag.WriteOnly)
    _draw_maps(map_area, file, kind)
    return file.data().data()


def _draw_maps(map_area, file, kind: str) -> None:
    widgets = [*map_area.panels.values(), map_area.colour_bar]
    frame = QtCore.QRect()
    for widget in widgets:
        frame = frame.united(QtCore.QRect(widget.mapTo(map_area, QtCore.QPoint(0, 0)), widget.size()))
    device, factor = (_svg if kind == ".svg" else _pdf)(file, frame.size())
    before, light = map_area.palette(), _light_palette()
    painter = QtGui.QPainter(device)
    painter.scale(factor, factor)
    try:
        for widget in widgets:
            widget.setPalette(light)
            corner = widget.mapTo(map_area, QtCore.QPoint(0, 0)) - frame.topLeft()
            painter.save()
            painter.translate(corner)
            widget.paint(painter)
            painter.restore()
    finally:
        painter.end()
        for widget in widgets:
            widget.setPalette(before)


def _svg(file, size):
    from PySide6.QtSvg import QSvgGenerator

    device = QSvgGenerator()
    device.setOutputDevice(file)
    device.setSize(size)
    device.setViewBox(QtCore.QRect(QtCore.QPoint(0, 0), size))
    device.setTitle("Maps of Echopath")
    return device, 1.0


def _pdf(file, size):
    device = QtGui.QPdfWriter(file)
    page = QtGui.QPageSize(QtCore.QSizeF(size) * POINTS_PER_PIXEL, QtGui.QPageSize.Unit.Point)
    device.setPageSize(page)
    device.setPageMargins(QtCore.QMarginsF(0, 0, 0, 0))
    return device, device.width() / size.width()


def _light_palette() -> QtGui.QPalette:
    """Black on white: files go onto paper."""
    palette = QtGui.QPalette(Qt.GlobalColor.white)
    for role in (QtGui.QPalette.ColorRole.WindowText, QtGui.QPalette.ColorRole.Text):
        palette.setColor(role, Qt.GlobalColor.black)
    palette.setColor(QtGui.QPalette.ColorRole.Window, Qt.GlobalColor.white)
    palette.setColor(QtGui.QPalette.ColorRole.Base, Qt.GlobalColor.white)
    return palette
