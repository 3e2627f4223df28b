"""Names that stand in the scene, over the 3-D view."""
from __future__ import annotations

import numpy as np

from ..qt import Qt, QtCore, QtGui, QtWidgets

MARGIN, ABOVE = 3, 4  # pixels: around a name, and between its place and its box
MOST_SHARE = 0.4      # of the width of the view: longer names are cut in their middle
PAPER_ALPHA = 205     # of 255: what is behind a name is seen a little
CHOSEN = "chosen"     # the layer of the ray that is chosen


class NameBox(QtWidgets.QWidget):
    """Names of all layers, in the colours of the theme and in whatever letters Qt has, inside of the view.

    Those that would stand on others are left out: the hits of the chosen ray come first, then what is nearest to the camera. A
    name of two layers stands once.
    """

    def __init__(self, parent):
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.boxes = []  # (QRect in pixels, text as it is shown) of what stands there
        self.forget()
        self.hide()

    def forget(self) -> None:
        """There are no names, as of another scene."""
        self._of_layer = {CHOSEN: []}

    def set_names(self, layer: str, points, texts: list) -> None:
        """The names of a layer in place of those that it had, shown with the next picture. points: [N, 3] m; texts: N"""
        self._of_layer[layer] = list(zip(np.asarray(points, float).reshape(-1, 3), texts))

    def follow(self, clip_from_world) -> None:
        """Puts all names where their places are in a picture of the camera. clip_from_world: [4, 4]"""
        self.resize(self.parent().size())
        boxes = self._laid_out(clip_from_world)
        if boxes != self.boxes:
            self.boxes = boxes
            self.update()
        self.setVisible(bool(boxes))

    def _laid_out(self, clip_from_world) -> list:
        places = {}
        for named in self._of_layer.values():
            for point, text in named:
                places.setdefault(text, point)
        if not places:
            return []
        clip = np.column_stack([list(places.values()), np.ones(len(places))]) @ clip_from_world.T
        distance, across, up = clip[:, 3], *(clip[:, :2] / np.where(clip[:, 3:] > 0.0, clip[:, 3:], np.nan)).T
        is_seen, texts, boxes = np.maximum(np.abs(across), np.abs(up)) <= 1.0, list(places), []
        for number in np.lexsort((distance, np.arange(len(places)) >= len(self._of_layer[CHOSEN]))):
            if is_seen[number]:
                box = self._box_of(texts[number], across[number], up[number])
                if not any(box[0].intersects(other) for other, _ in boxes):
                    boxes.append(box)
        return boxes

    def _box_of(self, text: str, across: float, up: float) -> tuple:
        """(QRect, text that has room in it) of a name above its place: -1 to 1 across and upwards of the view."""
        letters = self.fontMetrics()
        shown = letters.elidedText(text, Qt.TextElideMode.ElideMiddle, int(MOST_SHARE * self.width()))
        width, height = letters.horizontalAdvance(shown) + 2 * MARGIN, letters.height() + 2
        left = 0.5 * (1.0 + across) * self.width() - 0.5 * width
        top = 0.5 * (1.0 - up) * self.height() - height - ABOVE
        left, top = max(min(left, self.width() - width), 0.0), max(min(top, self.height() - height), 0.0)
        return QtCore.QRect(round(left), round(top), width, height), shown

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        paper = self.palette().base().color()
        paper.setAlpha(PAPER_ALPHA)
        painter.setPen(self.palette().text().color())
        for box, text in self.boxes:
            painter.fillRect(box, paper)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextSingleLine, text)
