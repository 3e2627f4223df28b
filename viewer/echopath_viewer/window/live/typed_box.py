"""A box for a number that others change, too."""
from __future__ import annotations

from ..qt import QtWidgets


class TypedBox(QtWidgets.QDoubleSpinBox):
    """Tells a number that is typed at Enter or when the focus leaves, not the numbers that its first digits make; arrows and
    the wheel tell each step."""

    def __init__(self, **properties):
        """properties: of QDoubleSpinBox"""
        super().__init__(keyboardTracking=False, **properties)
        self.editingFinished.connect(lambda: self.lineEdit().setModified(False))

    def follow(self, value: float) -> None:
        """Shows a value from elsewhere, unless another one is being typed."""
        if not self.lineEdit().isModified():
            self.setValue(value)
