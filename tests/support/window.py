"""Helpers of tests that click in the window of the viewer."""
from __future__ import annotations

from contextlib import contextmanager

import numpy as np

from echopath_viewer.window.qt import Qt, QtCore

PATIENCE_MS = 5000
NEVER_MS = 10**7
LEFT = Qt.MouseButton.LeftButton


def open_on_screen(qtbot, window) -> None:
    with qtbot.waitActive(window):  # shortcuts belong to the active window
        window.show()
        window.activateWindow()
    settle(qtbot)


def settle(qtbot) -> None:
    """Until timers of zero length and the lists have had their turn."""
    qtbot.wait(60)


@contextmanager
def held(*timers):
    """Timers that run do not end within the block, however long the machine takes for it."""
    before = [timer.interval() for timer in timers]
    for timer in timers:
        timer.setInterval(NEVER_MS)
    try:
        yield
    finally:
        for timer, interval in zip(timers, before):
            timer.setInterval(interval)


def panel_of(window, *key):
    return window.map_area.panels[key]


def click_cell(qtbot, window, key: tuple, range_index: int, velocity_index: int) -> None:
    panel, spectrum = panel_of(window, *key), window.session.parts[key].spectrum
    middle = QtCore.QPointF(spectrum.range[range_index], spectrum.velocity[velocity_index])
    window.map_area.set_view(QtCore.QRectF(middle.x() - 1.0, middle.y() - 1.0, 2.0, 2.0))  # cells of many pixels
    at = panel.to_pixel(spectrum.range[range_index], spectrum.velocity[velocity_index])
    assert panel.plot_rect().contains(at)
    qtbot.mouseClick(panel, LEFT, pos=at.toPoint())
    settle(qtbot)


def strongest_cell(window, key: tuple) -> tuple:
    """(range index, velocity index), not at the ends of the velocity axis, which a box does not go round."""
    level = window.session.parts[key].level(0, 0)[2:-2]
    velocity, distance = np.unravel_index(level.argmax(), level.shape)
    return int(distance), int(velocity) + 2


def project(window, point):
    clip = window.view3d.clip_from_world() @ np.append(point, 1.0)
    size = window.view3d.size()
    return QtCore.QPoint(round((0.5 + 0.5 * clip[0] / clip[3]) * size.width()),
                         round((0.5 - 0.5 * clip[1] / clip[3]) * size.height()))
