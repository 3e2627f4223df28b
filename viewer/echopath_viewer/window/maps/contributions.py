"""What makes the selected cell: a table of families, their phasors, and the level without each thing."""
from __future__ import annotations

from html import escape

import numpy as np

from echopath.base.numerics.decibels import SMALLEST_POWER, in_dbm
from echopath.signals.measures import for_pictures

from ...model.maps.attribution import Attribution
from ...model.maps.part_set import level_text
from ..background_work import BackgroundWork
from ..banner import ThinBar
from ..qt import Qt, QtGui, QtWidgets
from ..swatch import swatch
from .phasors import COLOURS, MAX_ARROWS, PhasorDiagram
from .ticks import place_text

HINT = "Click a cell of the map: which echoes make it?"
PLAYING_HINT = "Pause the frames to see what makes the cell."
MOVING_HINT = "What makes the cell is told when nothing moves any more."
COLUMNS = ("Echoes (ghost type/order)", "dBm", "Without", "Own peak at")
SHOWN_BELOW_DB = 60.0   # the strongest: weaker rows are told as one
NOTHING_LEFT_DB = -290.0  # what rounding leaves of a level
LEAST_CHANGE_DB = 0.05  # of a level, that is told
MOST_ROWS = 40
WIDE = 540              # pixels, from which on there is room for the last column, whose text the tool tips have, too


class ContributionsPanel(QtWidgets.QWidget):
    """Follows the selected cell; the signals of the families are made in a thread when the first one is asked for."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.session, self._rows, self._cell, self._told = None, [], None, []
        self._cell_told = None  # its level and what makes most of it, in words
        self._is_seen = self._is_passing = False
        self.is_playing = lambda: False  # frames
        self.title, self.without = QtWidgets.QLabel(HINT), QtWidgets.QLabel()
        for label in (self.title, self.without):
            label.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Fixed)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.bar = ThinBar()
        self.table, self.phasors = QtWidgets.QTableWidget(0, len(COLUMNS)), PhasorDiagram()
        self.work = BackgroundWork(self)
        self._arrange()
        self.work.done.connect(self._take)
        self.work.failed.connect(self._fail)
        self.work.advanced.connect(self.bar.advance)
        self.table.itemSelectionChanged.connect(self._row_chosen)

    def _arrange(self) -> None:
        self.table.setHorizontalHeaderLabels(COLUMNS)
        self.table.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setSelectionMode(QtWidgets.QAbstractItemView.SelectionMode.SingleSelection)
        self.table.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setToolTip("Choose a row: its paths light up, wherever they lie.")
        self.table.setWordWrap(False)
        self.table.setTabKeyNavigation(False)
        self.table.setTextElideMode(Qt.TextElideMode.ElideLeft)  # ways differ at their ends
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(20)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QtWidgets.QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(0, QtWidgets.QHeaderView.ResizeMode.Stretch)
        header.setTextElideMode(Qt.TextElideMode.ElideRight)  # else its begin is cut off, too, in a narrow window
        both = QtWidgets.QHBoxLayout()
        both.addWidget(self.table, 4)
        both.addWidget(self.phasors, 1)
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        for widget in (self.bar, self.title, self.without):
            column.addWidget(widget)
        column.addLayout(both, 1)

    def show_session(self, session) -> None:
        self.work.stop()
        self.bar.hide()
        self.session, self._is_passing = session, False
        self._show_nothing(HINT)  # whoever looks or not: rows of another frame have no paths in this one
        self.refresh()

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame. is_passing: the next one comes at once, and nothing is told: nobody reads then what takes seconds to
        make, and what was is of another frame."""
        if not is_passing:
            self.show_session(session)
            return
        self.work.stop()
        self.bar.hide()
        self.session, was_passing, self._is_passing = session, self._is_passing, True
        if not was_passing:
            self._cell = None
            self.refresh()

    def refresh(self) -> None:
        """Tells of the cell that is selected now, if anyone looks."""
        session = self.session
        if session is None or not self._is_seen or (session.lit_by and (session.cell, session.beam) == self._cell):
            return
        if session.cell is None:
            self._show_nothing(HINT)
        elif session.attribution is not None:
            self._show(session.cell_attribution())
        elif session.note:
            self._show_nothing(session.note)
        elif self._is_passing:
            self._show_nothing(PLAYING_HINT if self.is_playing() else MOVING_HINT)
        elif not self.work.is_running:
            self._show_nothing("The signals of all families of paths are made, once ...")
            self.bar.begin()
            signals, objects = session.signals, session.told_objects
            self.work.start(lambda progress: Attribution(signals, objects(), progress))

    def resizeEvent(self, event):
        super().resizeEvent(event)
        self.table.setColumnHidden(len(COLUMNS) - 1, self.width() < WIDE)
        self._break_lines()
        self._break_title()

    def _break_title(self) -> None:
        """In two lines where there is no room for one."""
        if self._cell_told is None:
            return
        level, kind = self._cell_told
        bold = self.title.font()
        bold.setBold(True)
        width = QtGui.QFontMetrics(bold).horizontalAdvance(f"{level}, {kind}")
        self.title.setText(f"<b>{level}</b>,{' ' if width < self.width() - 16 else '<br>'}{escape(kind)}")

    def _break_lines(self) -> None:
        """What is told of the level, in lines as wide as the panel: a layout gives a label that wraps by itself too few."""
        lines, room = [""], self.width() - 16
        for item in self._told:
            joined = f"{lines[-1]} \u00b7 {item}" if lines[-1] else item
            if lines[-1] and self.fontMetrics().horizontalAdvance(joined) > room:
                lines.append(item)
            else:
                lines[-1] = joined
        self.without.setText("\n".join(lines))
        self.without.setVisible(bool(self._told))

    def set_seen(self, is_seen: bool) -> None:
        """Whether anyone looks: a panel behind another one need tell nothing."""
        self._is_seen = is_seen
        self.refresh()

    def _take(self, attribution) -> None:
        self.bar.hide()
        self.session.attribution = attribution
        self.refresh()

    def _fail(self, text: str) -> None:
        self.bar.hide()
        self._show_nothing(text)

    def _show_nothing(self, text: str) -> None:
        self._cell = self._cell_told = None
        self.title.setText(text)
        self._told = []
        self._break_lines()
        self._fill([])
        self.phasors.show_values([], 1.0)

    def _show(self, cell) -> None:
        """cell: CellAttribution."""
        spectrum, (distance, velocity) = self.session.parts.whole.spectrum, self.session.cell
        place = place_text(spectrum, spectrum.range[distance], spectrum.velocity[velocity])
        if self.session.beam is not None:
            place += ", beam at {:+z.1f}\u00b0, {:+z.1f}\u00b0".format(*np.degrees(self.session.beam))
        level = level_text(cell.level_dbm)
        self._cell_told = (for_pictures(f"{place}: {level}"), for_pictures(f"mostly {kind_of(cell.strongest)}"))
        self._break_title()
        self._told = [for_pictures(f"without {name} {change_text(change)}") for name, change in cell.without
                      if abs(change) >= LEAST_CHANGE_DB]
        self._break_lines()
        self._cell = self.session.cell, self.session.beam
        self._fill(self._chosen(cell))
        self.phasors.show_values([one.value for one in sorted(cell.contributions, key=lambda one: -abs(one.value))], cell.value)

    @staticmethod
    def _chosen(cell) -> list:
        """(contribution, phase relative to the sum) of the rows, strongest first."""
        ordered = sorted(cell.contributions, key=lambda one: -abs(one.value))
        least = abs(ordered[0].value) * 10.0 ** (-SHOWN_BELOW_DB / 20.0)
        kept = [one for one in ordered if abs(one.value) > least or one is ordered[0]][:MOST_ROWS]
        return [(one, float(np.degrees(np.angle(one.value / cell.value))) if cell.value else 0.0) for one in kept]

    def _fill(self, rows: list) -> None:
        self.table.blockSignals(True)
        self._rows = [one for one, _ in rows]
        self.table.clearSelection()
        self.table.setRowCount(len(rows))
        spectrum = None if self.session is None else self.session.parts.whole.spectrum
        for number, (one, phase) in enumerate(rows):
            level = float(in_dbm(abs(one.value) ** 2, SMALLEST_POWER))
            peak = "" if one.group is None else place_text(spectrum, one.group.peak_range, one.group.peak_velocity, is_rough=True)
            texts = (one.name, f"{level:.1f}", change_text(one.without_db), peak)
            for column, text in enumerate(texts):
                item = QtWidgets.QTableWidgetItem(text if column == 0 else for_pictures(text))
                item.setToolTip(item.text())
                if column:
                    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.table.setItem(number, column, item)
            self.table.item(number, 0).setIcon(swatch(QtGui.QColor(COLOURS[min(number, MAX_ARROWS - 1)])))
            self.table.item(number, 0).setToolTip(f"{one.name}: {phase:+z.0f}° from the sum; own peak at {peak or 'no place'}")
        self.table.blockSignals(False)

    def _row_chosen(self) -> None:
        rows = {index.row() for index in self.table.selectedIndexes()}
        if self.session is not None and len(rows) == 1:
            self.session.select_family(self._rows[rows.pop()].group)


def change_text(change_db: float) -> str:
    """How a level changes without something."""
    return f"{change_db:+z.1f} dB" if change_db > NOTHING_LEFT_DB else "-\u221e dB"


def kind_of(contribution) -> str:
    """What a contribution is, in words for whoever sees the panel for the first time."""
    family = None if contribution.group is None else contribution.group.family
    if family is None or not (family.object and family.is_ghost):
        return contribution.name
    return f"a ghost: {family.object} by way of {' and '.join(family.via)}"
