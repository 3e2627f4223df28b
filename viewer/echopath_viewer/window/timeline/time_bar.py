"""Time within the frame: play, slider, and the signal from chirp to chirp."""
from __future__ import annotations

import numpy as np

from echopath.signals.measures import for_pictures

from ...model.maps.part_set import level_text
from ..qt import Qt, QtCore, QtGui, QtWidgets, Signal

TICK_MS = 50
TICKS_PER_FRAME = 64  # of the film: a frame of milliseconds takes seconds to watch


class TimeBar(QtWidgets.QWidget):
    """Moves scene and rays through the chirps; the current chirp is marked in the slow-time power."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.session = None
        self.is_behind = lambda: False  # whether the last step is still to be drawn: the film waits for it
        self.play_button = QtWidgets.QPushButton("Play", checkable=True)
        self.slider = QtWidgets.QSlider(Qt.Orientation.Horizontal)
        self.play_button.setToolTip("Play or pause the chirps of the frame (Space)")
        self.slider.setToolTip("The chirp at whose middle the scene and its rays are shown")
        self.label = QtWidgets.QLabel()
        self.strip = SlowTimeStrip()
        self._timer = QtCore.QTimer(self, interval=TICK_MS)
        row = QtWidgets.QHBoxLayout()
        for widget in (self.play_button, self.slider, self.label):
            row.addWidget(widget)
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        column.addLayout(row)
        column.addWidget(self.strip)
        self.slider.valueChanged.connect(self._moved)
        self.strip.chirp_clicked.connect(self.slider.setValue)
        self.play_button.toggled.connect(self._play)
        self._timer.timeout.connect(self._step)

    def show_session(self, session) -> None:
        self.play_button.setChecked(False)
        self.follow_session(session)

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame of the same time line: what plays goes on."""
        self.session = None
        self.slider.setRange(0, session.radar.waveform.num_chirps - 1)
        self.session = session
        self.read(session)

    def read(self, session) -> None:
        """Takes over the chirp of the session."""
        with QtCore.QSignalBlocker(self.slider):
            self.slider.setValue(session.chirp)
        after = 1e3 * (session.time - session.paths.frame.start_time)
        self.label.setText(f"chirp {session.chirp + 1} of {session.radar.waveform.num_chirps}, {after:.2f} ms")
        self.strip.mark(session.chirp)

    def show_power(self, power_dbm, title: str) -> None:
        """power_dbm: [chirps]."""
        self.strip.show_power(power_dbm, title)

    def stop(self) -> None:
        self._timer.stop()

    def _moved(self, chirp: int) -> None:
        if self.session is not None:
            self.session.set_chirp(chirp)

    def _play(self, is_on: bool) -> None:
        self.play_button.setText("Pause" if is_on else "Play")
        (self._timer.start if is_on else self._timer.stop)()

    def _step(self) -> None:
        if self.is_behind():
            return
        count = self.slider.maximum() + 1
        self.slider.setValue((self.slider.value() + max(1, count // TICKS_PER_FRAME)) % count)


class SlowTimeStrip(QtWidgets.QWidget):
    """Power by chirp with the current chirp marked."""

    chirp_clicked = Signal(int)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setFixedHeight(58)
        self._power, self._title, self._chirp = np.zeros(0), "", 0

    def show_power(self, power_dbm, title: str) -> None:
        self._power, self._title = np.asarray(power_dbm), title
        self.update()

    def mark(self, chirp: int) -> None:
        self._chirp = chirp
        self.update()

    def _rect(self) -> QtCore.QRectF:
        return QtCore.QRectF(6, 15, max(self.width() - 12, 1), self.height() - 19)

    def x_of(self, chirp: float) -> float:
        rect = self._rect()
        return rect.left() + chirp / max(len(self._power) - 1, 1) * rect.width()

    def mousePressEvent(self, event):
        self.mouseMoveEvent(event)

    def mouseMoveEvent(self, event):
        if len(self._power) and event.buttons() & Qt.MouseButton.LeftButton:
            share = (event.position().x() - self._rect().left()) / self._rect().width()
            self.chirp_clicked.emit(int(np.clip(round(share * (len(self._power) - 1)), 0, len(self._power) - 1)))

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        rect = self._rect()
        painter.fillRect(rect, self.palette().base())
        painter.setPen(self.palette().windowText().color())
        painter.drawText(QtCore.QRectF(6, 0, rect.width(), 14), Qt.AlignmentFlag.AlignLeft, self._text())
        if not len(self._power):
            return
        low, high = float(self._power.min()), float(self._power.max())
        middle, span = 0.5 * (low + high), max(high - low, 1.0)
        points = [QtCore.QPointF(self.x_of(chirp), rect.center().y() - (value - middle) / span * 0.9 * rect.height())
                  for chirp, value in enumerate(self._power)]
        painter.setPen(QtGui.QPen(QtGui.QColor("#0072b2"), 1.2))
        painter.drawPolyline(QtGui.QPolygonF(points))
        painter.setPen(QtGui.QPen(QtGui.QColor("#d55e00"), 1.5))
        painter.drawLine(QtCore.QLineF(self.x_of(self._chirp), rect.top(), self.x_of(self._chirp), rect.bottom()))

    def _text(self) -> str:
        value = f": {level_text(self._power[self._chirp])}" if self._chirp < len(self._power) else ""
        return for_pictures(f"{self._title}{value}")
