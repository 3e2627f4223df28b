"""Maps beside each other, which scroll where there are too many for the window."""
from __future__ import annotations

from ..qt import Qt, QtWidgets

MOST_ROWS = 3   # that the window makes room for, whatever the screen; more scroll
SPACING = 2     # pixels


class MapGrid(QtWidgets.QScrollArea):
    """As large as all of its panels need, as far as there is room."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setWidgetResizable(True)
        self.setFrameShape(QtWidgets.QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._content = QtWidgets.QWidget()
        self._layout = QtWidgets.QGridLayout(self._content)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setSpacing(SPACING)
        self.setWidget(self._content)

    def place(self, panels) -> None:
        """Shows panels in place of those before, which are let go."""
        while self._layout.count():
            before = self._layout.takeAt(0).widget()
            before.hide()
            before.deleteLater()
        columns = 1 if len(panels) == 1 else 2 if len(panels) <= 6 else 3
        for number, panel in enumerate(panels):
            self._layout.addWidget(panel, number // columns, number % columns)
        rows, least = -(-len(panels) // columns), panels[0].minimumSize()
        beside = self.verticalScrollBar().sizeHint().width() if rows > MOST_ROWS else 0
        self.setMinimumSize(_extent(columns, least.width()) + beside, _extent(min(rows, MOST_ROWS), least.height()))

    def bring(self, panel) -> None:
        """Scrolls to a panel that is out of sight."""
        self._layout.activate()
        self.ensureWidgetVisible(panel, 0, 0)


def _extent(count: int, size: int) -> int:
    """Pixels of so many panels in a row."""
    return count * size + (count - 1) * SPACING
