"""The tree of the scene with what finds its rows."""
from __future__ import annotations

from ..qt import Qt, QtCore, QtWidgets

PAUSE_MS = 150  # from the last letter, before rows are looked for: thousands take as long as a picture


class FindEdit(QtWidgets.QLineEdit):
    """A line whose text goes with Esc, which is a shortcut of the window where there is none."""

    def __init__(self):
        super().__init__(placeholderText="Find", clearButtonEnabled=True)
        self.setToolTip("Rows with this in their names alone (Ctrl+F); Enter: to the first of them, Esc: all rows")

    def event(self, event):
        if event.type() == QtCore.QEvent.Type.ShortcutOverride and event.key() == Qt.Key.Key_Escape and self.text():
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event):
        if event.key() == Qt.Key.Key_Escape:
            self.clear()
        else:
            super().keyPressEvent(event)


class SceneBox(QtWidgets.QWidget):
    """A tree below a line for a part of the names that are to be found."""

    def __init__(self, tree, parent=None):
        """tree: SceneTree"""
        super().__init__(parent)
        self.tree, self.find_edit = tree, FindEdit()
        self._pause = QtCore.QTimer(self, singleShot=True, interval=PAUSE_MS)
        self._pause.timeout.connect(self._find)
        self.find_edit.textChanged.connect(lambda _: self._pause.start())
        self.find_edit.returnPressed.connect(self._go)
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        for widget in (self.find_edit, tree):
            column.addWidget(widget)

    def begin(self) -> None:
        """Has the next letters typed into the line."""
        self.find_edit.setFocus()
        self.find_edit.selectAll()

    def _find(self) -> None:
        self._pause.stop()
        self.tree.show_found(self.find_edit.text())

    def _go(self) -> None:
        """To the first row that was found, where Enter makes its map."""
        self._find()
        found = self.tree.first_found()
        if found is not None:
            self.tree.setCurrentItem(found)
            self.tree.setFocus()
