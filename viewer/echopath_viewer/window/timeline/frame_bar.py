"""Frames in time: slider, film, and all frames at a glance."""
from __future__ import annotations

import numpy as np

from echopath.plots.style import MAP_COLOURS

from ...model.colours import colour_table, levels_of
from ...model.frames.overview import AXES, has_map, level_image, track_places, track_values, tracks_of
from ...model.palette import track_colour
from ..maps.ticks import nice_ticks, tick_text
from ..qt import Qt, QtCore, QtGui, QtWidgets, Signal

HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 104, 46, 8, 4, 18  # pixels
OVER_NOISE_DB = 5.0  # over the middle level of all columns, which is noise: where there is signal
UNITS = {"velocity": "m/s", "range": "m"}


class FrameBar(QtWidgets.QWidget):
    """Which frame of a time line is shown; tells which one is wanted."""

    wanted, stepped, play_toggled = Signal(int), Signal(int), Signal(bool)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.play_button = QtWidgets.QPushButton("Play frames", checkable=True)
        self.back_button, self.on_button = QtWidgets.QToolButton(text="\u25c0"), QtWidgets.QToolButton(text="\u25b6")
        self.slider, self.label = QtWidgets.QSlider(Qt.Orientation.Horizontal), QtWidgets.QLabel()
        self.follow_check = QtWidgets.QCheckBox("Newest")
        self.axis_box = QtWidgets.QComboBox()
        self.axis_box.addItems(AXES)
        self.strip = TimeStrip()
        self._arrange()
        self._connect()

    def _arrange(self) -> None:
        for widget, text in ((self.play_button, "Play or pause the frames (Shift+Space)"),
                             (self.back_button, "The frame before (PgUp)"), (self.on_button, "The next frame (PgDown)"),
                             (self.slider, "Which frame is shown"),
                             (self.follow_check, "Go to each frame as soon as it is written"),
                             (self.axis_box, "What the strip below has a column of for each frame, with the tracks")):
            widget.setToolTip(text)
        self.label.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Preferred)
        self.slider.setMinimumWidth(40)
        row = QtWidgets.QHBoxLayout()
        for widget in (self.play_button, self.back_button, self.on_button, self.follow_check, self.axis_box):
            row.addWidget(widget)
        row.insertWidget(3, self.slider, 1)
        row.insertWidget(4, self.label, 2)  # names of frames of a dataset are long
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        column.addLayout(row)
        column.addWidget(self.strip)

    def _connect(self) -> None:
        self.slider.valueChanged.connect(self.wanted)
        self.back_button.clicked.connect(lambda: self.stepped.emit(-1))
        self.on_button.clicked.connect(lambda: self.stepped.emit(1))
        self.play_button.toggled.connect(self._play)
        self.strip.frame_clicked.connect(self.slider.setValue)
        self.axis_box.currentIndexChanged.connect(lambda number: self.strip.show_axis(AXES[number]))

    def _play(self, is_on: bool) -> None:
        self.play_button.setText("Pause frames" if is_on else "Play frames")
        self.play_toggled.emit(is_on)

    def show_place(self, place: int, moments, expected: int | None) -> None:
        """place: of the frame on display; moments: of the time line; expected: how many there will be, None: unknown."""
        with QtCore.QSignalBlocker(self.slider):
            self.slider.setRange(0, max(len(moments) - 1, 0))
            self.slider.setValue(place)
        count = str(len(moments)) if expected in (None, len(moments)) else f"{len(moments)} so far, {expected} in all"
        name = moments[place].name
        number = "" if name == f"frame {place}" else f" ({name})"
        text = f"frame {place + 1} of {count}{number}, {moments[place].start_time:.3f} s"
        self.label.setText(text)
        self.label.setToolTip(text)
        self.follow_check.setVisible(expected != len(moments))
        self.strip.mark(place)


class TimeStrip(QtWidgets.QWidget):
    """A column of power for each frame, the tracks over it, and the frame on display marked."""

    frame_clicked = Signal(int)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setFixedHeight(HEIGHT)
        self.axis, self._glances, self._place, self._image = AXES[0], [], 0, None
        self.tracks, self.places = None, None  # [N, 3] m, of the rows of tracks in the world
        self.setToolTip("All frames: click or drag to go to one. Lines are tracks of the detections.")

    def show_glances(self, glances: list) -> None:
        """glances: model.overview.Glance of each frame, in order; those to come are missing."""
        self._glances, self.tracks = glances, tracks_of(glances) if glances else None
        self.places = None if self.tracks is None else track_places(self.tracks, glances)
        self._make_image()

    def show_axis(self, axis: str) -> None:
        """axis: a name of AXES."""
        self.axis = axis
        self._make_image()

    def mark(self, place: int) -> None:
        self._place = place
        self.update()

    def _make_image(self) -> None:
        self._image = None
        if any(map(has_map, self._glances)):
            level, self._values = level_image(self._glances, self.axis)
            highest, noise = float(np.nanmax(level)), float(np.nanmedian(level))
            self._rows = _rows_with_signal(level, noise + OVER_NOISE_DB)
            self._pixels = np.ascontiguousarray(levels_of(np.nan_to_num(level, nan=-1e3)[self._rows][::-1],
                                                          (noise, max(highest, noise + OVER_NOISE_DB))))
            height, width = self._pixels.shape
            self._image = QtGui.QImage(self._pixels.data, width, height, width, QtGui.QImage.Format.Format_Indexed8)
            self._image.setColorTable([QtGui.qRgb(*map(int, rgb)) for rgb in colour_table(MAP_COLOURS)])
        self.update()

    def _rect(self) -> QtCore.QRectF:
        return QtCore.QRectF(LEFT, TOP, max(self.width() - LEFT - RIGHT, 1), HEIGHT - TOP - BOTTOM)

    def x_of(self, place: float) -> float:
        """Pixel of the middle of the column of a frame."""
        return self._rect().left() + (place + 0.5) / max(len(self._glances), 1) * self._rect().width()

    def _y_of(self, value: float) -> float:
        values, rect = self._values[self._rows], self._rect()
        step = values[1] - values[0] if len(values) > 1 else 1.0
        return rect.bottom() - (value - values[0] + 0.5 * step) / (len(values) * step) * rect.height()

    def mousePressEvent(self, event):
        self.mouseMoveEvent(event)

    def mouseMoveEvent(self, event):
        if self._glances and event.buttons() & Qt.MouseButton.LeftButton:
            share = (event.position().x() - self._rect().left()) / self._rect().width()
            self.frame_clicked.emit(int(np.clip(share * len(self._glances), 0, len(self._glances) - 1)))

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        rect, ink = self._rect(), self.palette().windowText().color()
        painter.setPen(ink)
        if self._image is None:
            text = "the frames hold no maps" if self._glances else "the frames are read ..."
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, text)
            return
        painter.drawImage(rect, self._image)
        self._paint_axes(painter, rect)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        painter.setClipRect(rect)
        self._paint_tracks(painter)
        width = rect.width() / len(self._glances)
        painter.setPen(QtGui.QPen(QtGui.QColor("#56b4e9"), 2))
        painter.drawRect(QtCore.QRectF(self.x_of(self._place) - 0.5 * width, rect.top() + 1, width, rect.height() - 2))

    def _paint_axes(self, painter, rect) -> None:
        font = self.font()
        font.setPointSizeF(max(font.pointSizeF() - 1.5, 6.5))
        painter.setFont(font)
        values = self._values[self._rows]
        for value in nice_ticks(float(values[0]), float(values[-1]), rect.height() / 24.0):
            box = QtCore.QRectF(0, self._y_of(value) - 8, LEFT - 6, 16)
            painter.drawText(box, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, tick_text(value))
        painter.drawText(QtCore.QRectF(0, rect.bottom() + 2, LEFT - 6, 16), Qt.AlignmentFlag.AlignRight, UNITS[self.axis])
        last, times = -1e9, np.array([one.time for one in self._glances])
        ascend = bool(np.all(np.diff(times) > 0.0))  # they begin anew in each scene of a dataset
        for place in range(len(self._glances)):  # times need not be even: each stands under its own column
            if self.x_of(place) - last > 70.0:
                last = self.x_of(place)
                painter.drawText(QtCore.QRectF(last - 34, rect.bottom() + 2, 68, 16), Qt.AlignmentFlag.AlignHCenter,
                                 f"{tick_text(round(times[place], 4))} s" if ascend else f"frame {place + 1}")

    def _paint_tracks(self, painter) -> None:
        if self.tracks is None or not self.tracks.num_tracks:
            return
        values = track_values(self.tracks, self._glances, self.axis)
        for number in np.unique(self.tracks.track):
            rows = np.flatnonzero((self.tracks.track == number) & np.isfinite(values))
            line = QtGui.QPolygonF([QtCore.QPointF(self.x_of(int(self.tracks.frame[row])), self._y_of(values[row]))
                                    for row in rows])
            for colour, width in ((QtGui.QColor("white"), 3.5), (QtGui.QColor(track_colour(number)), 1.8)):
                painter.setPen(QtGui.QPen(colour, width))
                painter.drawPolyline(line)


def _rows_with_signal(level, floor: float) -> slice:
    """The rows from the first to the last that come over the floor, with a margin."""
    rows = np.flatnonzero((level > floor).any(axis=1))
    if not len(rows):
        return slice(0, level.shape[0])
    margin = max(2, (rows[-1] - rows[0]) // 10)
    return slice(max(int(rows[0]) - margin, 0), min(int(rows[-1]) + margin + 1, level.shape[0]))
