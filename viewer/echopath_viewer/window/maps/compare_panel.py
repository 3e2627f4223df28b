"""Two frames, radars, channels or parts side by side, and their difference."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np

import echopath as ep
from echopath.signals.measures import for_pictures

from ...model import CellBox, Session, from_file
from ...model.maps.comparison import difference, kept_map
from ...model.maps.part_set import level_text
from ..files.kinds import FRAMES
from ..qt import QtCore, QtWidgets
from .colour_bar import ColourBar
from .map_area import title_of
from .map_panel import MapPanel, extent_of, nearest_index
from .side_panels import SeenPanel
from .ticks import place_text

DIFFERENCE_COLOURS, DIFFERENCE_SPAN_DB = "coolwarm", 20.0
NO_CHANGE = 127  # the colour of it
NOT_THERE = "not in the map that was kept"
HINT = "Keep a map, then go to another frame, channel or part: it is shown beside it. Or compare with the map of a file."


class ComparePanel(SeenPanel):
    """A map that was kept, that of now, and how much higher the latter is; a click in any selects the cell now."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.kept = None
        self.keep_button = QtWidgets.QPushButton("Keep this map")
        self.file_button = QtWidgets.QPushButton("Compare with a file ...")
        self.note = QtWidgets.QLabel(HINT, wordWrap=True)
        self.panels = {"kept": MapPanel(), "now": MapPanel(),
                       "difference": MapPanel(colours=DIFFERENCE_COLOURS, outside=NO_CHANGE)}
        self._arrange()
        self.keep_button.clicked.connect(self.keep)
        self.file_button.clicked.connect(self._ask)
        for panel in self.panels.values():
            panel.view_changed.connect(self._set_view)
            panel.view_reset.connect(self._reset_view)
            panel.cell_clicked.connect(self._pick)
            panel.hovered.connect(self._read)

    def _arrange(self) -> None:
        self.keep_button.setToolTip("Keeps the map of the part and channel on display to compare others with")
        self.file_button.setToolTip("Keeps the map of a frame file, maybe of another radar, to compare with")
        row, maps = QtWidgets.QHBoxLayout(), QtWidgets.QGridLayout()
        for button in (self.keep_button, self.file_button):
            row.addWidget(button)
        row.addStretch()
        for panel, place in zip(self.panels.values(), ((0, 0, 1, 1), (0, 1, 1, 1), (1, 0, 1, 2))):
            maps.addWidget(panel, *place)
        self.level_bar, self.change_bar = ColourBar(), ColourBar(colours=DIFFERENCE_COLOURS, unit="dB")
        for line, bar in enumerate((self.level_bar, self.change_bar)):
            maps.addWidget(bar, line, 2)
            bar.hide()
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        column.addLayout(row)
        column.addLayout(maps, 1)
        column.addWidget(self.note)

    def update_topics(self, topics: set) -> None:
        if topics & {"maps", "rays", "selection"}:
            self.refresh()

    def keep(self) -> None:
        """Keeps the map that is on display now."""
        self.kept = kept_map(self.session, self._title())
        self.refresh()

    def keep_file(self, path) -> None:
        """Keeps the map of a frame file. Says below what is wrong with it."""
        try:
            other = Session(from_file(path))
        except (ep.FileError, ValueError) as error:
            self.note.setText(str(error))
            return
        self.kept = kept_map(other, str(path).rpartition("/")[2])
        self.refresh()

    def _ask(self) -> None:
        path, _ = QtWidgets.QFileDialog.getOpenFileName(self, "Compare with", "", FRAMES)
        if path:
            self.keep_file(path)

    def _title(self) -> str:
        """What tells it from others first: there is room for few words above a map."""
        session = self.session
        name = str(session.title).rpartition("/")[2] or "paths"
        return f"{name}, {session.paths.frame.start_time:.3f} s, {title_of(session.part)}, {session.channel_name}"

    def refresh(self) -> None:
        """All three maps."""
        if self.session is None or self.kept is None or not self._is_seen:
            return
        now, limits = kept_map(self.session, self._title()), self.session.map_limits()
        change = difference(self.kept, now)
        shown, view = self.panels["now"], self.panels["now"].view
        if not (np.array_equal(shown.range_axis, now.range) and np.array_equal(shown.velocity_axis, now.velocity)):
            view = extent_of(now.range, now.velocity)
        for name, one, level, ends in (("kept", self.kept, self.kept.level, limits), ("now", now, now.level, limits),
                                       ("difference", now, np.nan_to_num(change), (-DIFFERENCE_SPAN_DB, DIFFERENCE_SPAN_DB))):
            axes = SimpleNamespace(range=one.range, velocity=one.velocity)
            title = f"{name}: {one.title}" if name != "difference" else "now minus kept"
            self.panels[name].show_map(title, level, axes, ends, view, is_current=False)
            self.panels[name].setToolTip(title)
            if name != "kept":
                self.panels[name].show_marks(self.session.box, None)
        self.change = change
        for bar, ends in ((self.level_bar, limits), (self.change_bar, (-DIFFERENCE_SPAN_DB, DIFFERENCE_SPAN_DB))):
            bar.show_limits(*ends)
            bar.show()
        self._tell_cell()

    def _tell_cell(self) -> None:
        cell = self.session.cell
        told = "Click a cell: its change in dB." if cell is None else f"the selected cell: {self._change_at(cell[1], cell[0])}"
        self.note.setText(for_pictures(told))

    def _change_at(self, velocity_index: int, range_index: int) -> str:
        change = self.change[velocity_index, range_index]
        return f"{change:+z.1f} dB" if np.isfinite(change) else NOT_THERE

    def _reset_view(self) -> None:
        spectrum = self.session.parts.whole.spectrum
        self._set_view(extent_of(spectrum.range, spectrum.velocity))

    def _set_view(self, view) -> None:
        for panel in self.panels.values():
            panel.set_view(QtCore.QRectF(view))

    def _pick(self, range_index: int, velocity_index: int) -> None:
        panel = self.sender()
        spectrum = self.session.parts.whole.spectrum
        if panel is self.panels["kept"]:  # of another radar, maybe: the cell of now that is nearest
            range_index = int(np.abs(np.asarray(spectrum.range) - self.kept.range[range_index]).argmin())
            velocity_index = int(np.abs(np.asarray(spectrum.velocity) - self.kept.velocity[velocity_index]).argmin())
        self.session.select_cells(CellBox.around(range_index, velocity_index), (range_index, velocity_index))

    def _read(self, distance: float, velocity: float, level: float) -> None:
        panel, told = self.sender(), level_text(level)
        if panel is self.panels["difference"]:
            told = self._change_at(nearest_index(panel.velocity_axis, velocity), nearest_index(panel.range_axis, distance))
        place = place_text(self.session.parts.whole.spectrum, distance, velocity).replace(", ", "   ")
        self.note.setText(for_pictures(f"{place}   {told}"))
