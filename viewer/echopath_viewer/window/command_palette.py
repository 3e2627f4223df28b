"""Everything that the window can do, found by typing a few letters of it."""
from __future__ import annotations

from .qt import Qt, QtCore, QtWidgets


class CommandPalette(QtWidgets.QDialog):
    """A list of actions that a text narrows; Enter does the first."""

    def __init__(self, parent, actions):
        """actions: QAction, those that can be done now are listed"""
        super().__init__(parent)
        self.setWindowTitle("Commands")
        self.resize(440, 380)
        self.edit, self.list = QtWidgets.QLineEdit(placeholderText="Type what you want to do"), QtWidgets.QListWidget()
        self.edit.setToolTip("Letters of a command; Enter does the first one that is listed")
        self.list.setToolTip("Click a command to do it")
        column = QtWidgets.QVBoxLayout(self)
        column.addWidget(self.edit)
        column.addWidget(self.list)
        self._actions = [action for action in actions if action.isEnabled() and action.text()]
        self.edit.textChanged.connect(self._narrow)
        self.edit.returnPressed.connect(lambda: self._do(self.list.currentItem()))
        self.list.itemClicked.connect(self._do)
        self._narrow("")

    def _narrow(self, text: str) -> None:
        """To those that have all words of a text."""
        self.list.clear()
        for action in self._actions:
            if all(word in action.text().lower() for word in text.lower().split()):
                keys = action.shortcut().toString()
                item = QtWidgets.QListWidgetItem(f"{action.text()}   {keys}".rstrip())
                item.setData(Qt.ItemDataRole.UserRole, action)
                self.list.addItem(item)
        self.list.setCurrentRow(0)

    def _do(self, item) -> None:
        if item is None:
            return
        self.accept()
        QtCore.QTimer.singleShot(0, item.data(Qt.ItemDataRole.UserRole).trigger)

    def keyPressEvent(self, event):
        """Arrows move through the list while the text has the focus."""
        step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(event.key())
        if step is None:
            super().keyPressEvent(event)
        else:
            self.list.setCurrentRow(min(max(self.list.currentRow() + step, 0), self.list.count() - 1))
