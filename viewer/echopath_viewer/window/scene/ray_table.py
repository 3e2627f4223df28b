"""The rays of a selection as a table."""
from __future__ import annotations

from html import escape

import numpy as np

from echopath.signals.measures import for_pictures

from ..qt import Qt, QtCore, QtGui, QtWidgets, Signal

COLUMNS = ("Bounces", "Range in m", "Speed in m/s", "Power in dBm", "Hits")
DECIMALS = {1: "{:.3f}", 2: "{:+z.3f}", 3: "{:.1f}"}
POWER = 3
STRONGEST_FIRST = (POWER, Qt.SortOrder.DescendingOrder)
BESIDE_HEADING = 26  # pixels, of margins and the arrow of the order
HITS = len(COLUMNS) - 1


class RayTableModel(QtCore.QAbstractTableModel):
    """Rows are paths; their texts are made when they are seen."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.session = None
        self.rays = self._strongest_first = np.zeros(0, np.int64)
        self._order = STRONGEST_FIRST

    def show_rays(self, session, rays) -> None:
        """rays: indices of paths, strongest first, shown in the order that was asked for."""
        self.beginResetModel()
        self.session, self._strongest_first = session, np.asarray(rays)
        self._sort(*self._order)
        self.endResetModel()

    def rowCount(self, parent=QtCore.QModelIndex()):  # noqa: B008
        return 0 if parent.isValid() else len(self.rays)

    def columnCount(self, parent=QtCore.QModelIndex()):  # noqa: B008
        return 0 if parent.isValid() else len(COLUMNS)

    def headerData(self, section, orientation, role=Qt.ItemDataRole.DisplayRole):
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        return COLUMNS[section] if orientation == Qt.Orientation.Horizontal else str(section + 1)

    def data(self, index, role=Qt.ItemDataRole.DisplayRole):
        if role == Qt.ItemDataRole.DisplayRole:
            text = self.text(index.row(), index.column())
            return text if index.column() == HITS else for_pictures(text)
        if role == Qt.ItemDataRole.TextAlignmentRole and index.column() != HITS:
            return int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        return None

    def text(self, row: int, column: int) -> str:
        """What a cell of the table shows."""
        path = self.rays[row]
        if column == HITS:
            return " > ".join(self.session.mesh_names[mesh] for mesh in self.session.columns.meshes_of(path))
        return DECIMALS.get(column, "{}").format(self._values(column, path))

    def _values(self, column: int, paths):
        """Of one path, or of some [N]."""
        columns = self.session.columns
        if column == POWER:
            return columns.power_dbm(paths)
        return (columns.num_bounces, columns.range, columns.velocity)[column][paths]

    def sort(self, column, order=Qt.SortOrder.AscendingOrder):
        self._order = (column, order)
        if self.session is None:
            return
        self.layoutAboutToBeChanged.emit()
        before = self.rays
        self._sort(column, order)
        self._move_selected(before)
        self.layoutChanged.emit()

    def _move_selected(self, before) -> None:
        """Rows that are selected go with their rays; before: [N] the rays as they stood."""
        selected, by_path = self.persistentIndexList(), np.argsort(self.rays)
        rows = by_path[np.searchsorted(self.rays, before[[index.row() for index in selected]], sorter=by_path)]
        self.changePersistentIndexList(selected, [self.index(int(row), index.column()) for row, index in zip(rows, selected)])

    def _sort(self, column: int, order) -> None:
        self.rays = self._strongest_first
        if column < 0 or not len(self.rays) or (column, order) == STRONGEST_FIRST:
            return
        if column == HITS:
            keys = np.array([self.text(row, HITS) for row in range(len(self.rays))])
        else:
            keys = self._values(column, self.rays)
        ranks = np.argsort(keys, kind="stable")
        self.rays = self.rays[ranks if order == Qt.SortOrder.AscendingOrder else ranks[::-1]]


class RayTable(QtWidgets.QWidget):
    """A sortable table of rays and, below it, what the chosen ray is."""

    ray_chosen = Signal(int)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.model, self.view = RayTableModel(self), QtWidgets.QTableView()
        self.view.setModel(self.model)
        self.view.setSortingEnabled(True)
        self.view.sortByColumn(*STRONGEST_FIRST)
        self.view.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
        self.view.setAlternatingRowColors(True)
        self.view.setTabKeyNavigation(False)  # else Tab would go through thousands of cells
        self.view.verticalHeader().setDefaultSectionSize(20)
        self.view.verticalHeader().hide()
        self.view.setWordWrap(False)
        self.view.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        header = self.view.horizontalHeader()
        header.setStretchLastSection(True)
        header.setHighlightSections(False)  # bold headings would need more room
        for column in range(HITS):
            self.view.setColumnWidth(column, header.fontMetrics().horizontalAdvance(COLUMNS[column]) + BESIDE_HEADING)
        self.view.selectionModel().currentRowChanged.connect(self._row_changed)
        self.title = QtWidgets.QLabel()
        self.details = QtWidgets.QLabel("Click a ray or a row: its hits and its cell.", wordWrap=True)
        self.details.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        for widget in (self.title, self.view, self.details):
            column.addWidget(widget)
        self.view.installEventFilter(self)
        copy = QtGui.QShortcut(QtGui.QKeySequence.StandardKey.Copy, self.view, self.copy_rows)
        copy.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)

    def show_session(self, session) -> None:
        """The rays that are listed now, and the one that is chosen."""
        self.model.show_rays(session, session.listed_rays())
        total = int(session.visible.sum() if session.box is None else session.lit.sum())
        if session.box is None:
            self.title.setText(f"{len(self.model.rays):,} drawn, of {total:,} rays")
        else:
            self.title.setText(f"{len(self.model.rays):,} strongest of {total:,} rays {session.where_lit()}")
        self._show_chosen(session)

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame: rows that lie before the eye follow each."""
        self.show_session(session)

    def _show_chosen(self, session) -> None:
        rows = np.flatnonzero(self.model.rays == session.ray) if session.ray is not None else []
        selection = self.view.selectionModel()
        with QtCore.QSignalBlocker(selection):
            self.view.clearSelection()
            if len(rows):
                self.view.selectRow(int(rows[0]))
        self.view.viewport().update()
        self._scroll_to_chosen()
        lines = [] if session.ray is None else session.explain(session.ray)
        self.details.setText("   ".join(f"<b>{label}</b> {escape(text)}" for label, text in lines) or
                             "Click a ray or a row: its hits and its cell.")

    def _scroll_to_chosen(self) -> None:
        chosen = self.view.selectionModel().selectedRows()
        if len(chosen) == 1:
            self.view.scrollTo(chosen[0])

    def eventFilter(self, watched, event):
        """The rows get another height with the text below them, or when their panel comes to the front."""
        if event.type() == QtCore.QEvent.Type.Resize:
            QtCore.QTimer.singleShot(0, self._scroll_to_chosen)
        return super().eventFilter(watched, event)

    def _row_changed(self, current, _previous) -> None:
        if current.isValid():
            self.ray_chosen.emit(int(self.model.rays[current.row()]))

    def copy_rows(self) -> None:
        """The selected rows, or all when none is, as text with tabs, for a spreadsheet."""
        rows = sorted({index.row() for index in self.view.selectionModel().selectedRows()}) or range(len(self.model.rays))
        texts = [[self.model.text(row, column) for column in range(len(COLUMNS))] for row in rows]
        QtWidgets.QApplication.clipboard().setText("\n".join("\t".join(line) for line in [COLUMNS, *texts]))
