"""All maps with what is set for them."""
from __future__ import annotations

from html import escape

from echopath.plots.maps import signal_extent
from echopath.signals.measures import for_pictures

from ...model import CellBox
from ...model.maps.layers import TWINS
from ...model.maps.part_set import MESH_GROUP, WHOLE, level_text
from ..busy import waiting_cursor
from ..qt import Qt, QtCore, QtGui, QtWidgets
from .colour_bar import ColourBar
from .map_grid import MapGrid
from .map_panel import MapPanel, extent_of
from .ticks import place_text

MIN_DYNAMIC_RANGE_DB, MAX_DYNAMIC_RANGE_DB = 10, 140
MARKER_WORDS = {"object": "&#9679;&nbsp;object", "ghost": "&#9675;&nbsp;ghost", "truth": "+&nbsp;true centre",
                "detection": "detections: &#9679;&nbsp;echo, &#9675;&nbsp;ghost, by object"}
NO_MAP = "no map: the file keeps labels alone"
TWIN_WORDS = "ghosts in the scene by object, way and (type/order)"
HINT = "Click or drag: the rays of cells. Wheel: zoom, right button: move, double click: what moves or all."


class MapArea(QtWidgets.QWidget):
    """One large map, or the whole and all parts side by side, on one colour scale."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.session = self._before_pick = self._brought = None
        self.panels: dict[tuple, MapPanel] = {}
        self.view, self.near_view, self.whole_view = (QtCore.QRectF() for _ in range(3))
        self.layout_box, self.part_box, self.partition_box = (QtWidgets.QComboBox() for _ in range(3))
        self.layout_box.addItems(["all parts", "one map"])
        self.channel_box, self._channels = QtWidgets.QComboBox(), {}
        self.reach_box = QtWidgets.QSpinBox(minimum=0, maximum=50, prefix="± ", suffix=" cells")
        self.layout_box.setToolTip("The maps of all parts beside each other, or a large one (M)")
        self.partition_box.setToolTip("By which partition the signal is taken apart")
        self.part_box.setToolTip("Whose rays and map are shown")
        self.channel_box.setToolTip("Transmitter and receiver whose map and rays are shown")
        self.reach_box.setToolTip("How far from a clicked cell rays are taken. Half a resolution cell unless set otherwise.")
        self.range_slider = QtWidgets.QSlider(Qt.Orientation.Horizontal)
        self.range_slider.setMinimumWidth(60)
        self.range_slider.setToolTip("Dynamic range of the colours, below the peak that is in view.")
        self.range_slider.setRange(MIN_DYNAMIC_RANGE_DB, MAX_DYNAMIC_RANGE_DB)
        self.by_label = QtWidgets.QLabel("by")
        self.range_label, self.read_out = QtWidgets.QLabel(), QtWidgets.QLabel(HINT)
        self.layer_legend = QtWidgets.QLabel(wordWrap=True, visible=False, textFormat=Qt.TextFormat.RichText)
        self.grid, self.colour_bar = MapGrid(), ColourBar()
        self._arrange()
        self._connect()

    def _arrange(self) -> None:
        for box in (self.part_box, self.partition_box, self.channel_box):
            box.setSizeAdjustPolicy(QtWidgets.QComboBox.SizeAdjustPolicy.AdjustToContents)
            box.setMinimumWidth(70)
            box.setMaximumWidth(190)
        first, second = QtWidgets.QHBoxLayout(), QtWidgets.QHBoxLayout()
        for row, items in ((first, ("Maps:", self.layout_box, self.by_label, self.partition_box, "Part:", self.part_box)),
                           (second, (self.channel_box, self.reach_box,
                                     self.range_slider, self.range_label))):
            for item in items:
                row.addWidget(QtWidgets.QLabel(item) if isinstance(item, str) else item)
        first.addStretch()
        maps = QtWidgets.QHBoxLayout()
        maps.addWidget(self.grid, 1)
        maps.addWidget(self.colour_bar)
        self.read_out.setWordWrap(True)
        self.read_out.setFixedHeight(2 * self.fontMetrics().lineSpacing() + 4)  # the maps must not move with the text
        self.read_out.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        for layout, stretch in ((first, 0), (second, 0), (maps, 1)):
            column.addLayout(layout, stretch)
        column.addWidget(self.layer_legend)
        column.addWidget(self.read_out)

    def _connect(self) -> None:
        self.layout_box.currentIndexChanged.connect(lambda _: self.rebuild())
        self.part_box.activated.connect(lambda _: self.session.set_part(self.part_box.currentData()))
        self.partition_box.activated.connect(lambda _: self.session.set_partition(self.partition_box.currentText()))
        self.channel_box.activated.connect(self._choose_channel)
        self.range_slider.valueChanged.connect(self._range_moved)

    def _choose_channel(self, _index: int) -> None:
        with waiting_cursor():
            self.session.set_channel(*self.channel_box.currentData())

    # --- session ---

    def show_session(self, session) -> None:
        self.session = session
        self.reach_box.setValue(int(session.signals.spectrum_settings.get("zero_pad", 1)) // 2)
        self._find_views()
        self.view = QtCore.QRectF(self.near_view)
        self.rebuild()

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame of the same time line: what is seen of the maps stays, unless their axes are others.

        is_passing: the next one comes at once, and where there is signal is not looked for
        """
        before, view = self.session.parts.whole.spectrum, self.view
        after = session.parts.whole.spectrum
        if before.values.shape != after.values.shape or before.range[-1] != after.range[-1]:
            self.show_session(session)
            return
        self.session = session
        if not is_passing:
            self._find_views()
        self.view = view
        self.rebuild()

    def update_topics(self, topics: set) -> None:
        if topics & {"maps", "layers"}:
            self.rebuild()
        elif "selection" in topics:
            self._show_marks()

    def show_one(self, is_one: bool) -> None:
        """One large map, or all side by side."""
        self.layout_box.setCurrentIndex(int(is_one))

    def shown_parts(self) -> list:
        """The parts whose maps are on display; "other" only where some of it reaches the colour scale."""
        if self.layout_box.currentIndex() == 1:
            return [self.session.part]
        session = self.session
        floor = session.map_limits()[0]
        return [part for part in session.parts.shown_beside(session.partition)
                if part.name != "other" or part is session.part or part.level(*session.channel).max() > floor]

    def rebuild(self) -> None:
        """Panels, lists and colours anew."""
        if self.session is None:
            return
        self._fill_boxes()
        parts = self.shown_parts()
        if list(self.panels) != [part.key for part in parts]:
            self._place_panels(parts)
        limits = self._limits()
        for part in parts:
            level = part.level(*self.session.channel)
            title = title_of(part) if self.session.has_map else NO_MAP
            self.panels[part.key].show_map(title, level, part.spectrum, limits, self.view,
                                           is_current=part.key == self.session.part_key)
        self.colour_bar.show_limits(*limits)
        self.colour_bar.setVisible(self.session.has_map)
        self._bring_current()
        self._show_layers()
        self._show_marks()

    def _bring_current(self) -> None:
        """Scrolls to the part that was chosen last, once: what scrolls on stays."""
        key = self.session.part_key
        if key != self._brought and key in self.panels:
            self.grid.bring(self.panels[key])
        self._brought = key

    def _show_layers(self) -> None:
        """Over the map of everything, or over the only one there is; the legend stands below."""
        image, rows, markers = self.session.map_layers()
        for key, panel in self.panels.items():
            has_layers = key == (WHOLE, WHOLE) or len(self.panels) == 1
            panel.show_layers(image if has_layers else None, markers if has_layers else [])
        words = [f"<span style='color:{QtGui.QColor(*map(int, rgb)).name()}'>&#9632;</span>&nbsp;{escape(name)}"
                 for name, rgb in rows]
        kinds = [text for kind, text in MARKER_WORDS.items() if any(marker.kind == kind for marker in markers)]
        kinds += [TWIN_WORDS] if TWINS in self.session.layers else []
        self.layer_legend.setText(" &nbsp; ".join(words + kinds))
        self.layer_legend.setVisible(bool(words or kinds))

    def _fill_boxes(self) -> None:
        session = self.session
        with blocked(self.part_box, self.partition_box, self.channel_box, self.range_slider):
            self.part_box.clear()
            for part in session.parts.shown_beside(session.partition):
                self.part_box.addItem(title_of(part), part.key)
            self.part_box.setCurrentIndex(self.part_box.findText(title_of(session.part)))
            self.partition_box.clear()
            self.partition_box.addItems(session.parts.partitions or ["-"])
            self.partition_box.setCurrentText(session.partition or "-")
            for widget in (self.by_label, self.partition_box):  # the others need the room
                widget.setVisible(bool(session.parts.partitions))
            if session.channels != self._channels:
                self._channels = session.channels
                self.channel_box.clear()
                for words, channel in self._channels.items():
                    self.channel_box.addItem(words, channel)
            self.channel_box.setCurrentText(session.channel_name)
            self.range_slider.setValue(round(session.dynamic_range_db))
        self.range_label.setText(f"{session.dynamic_range_db:.0f} dB")

    def _place_panels(self, parts) -> None:
        self.panels = {part.key: self._new_panel(part.key) for part in parts}
        self.grid.place(list(self.panels.values()))
        self._brought = None

    def _new_panel(self, key: tuple) -> MapPanel:
        panel = MapPanel()
        panel.cell_clicked.connect(lambda *cell: self._pick(key, CellBox.around(*cell, self.reach_box.value()), cell))
        panel.detection_clicked.connect(lambda index: self._pick_detection(key, index))
        panel.click_undone.connect(self._undo_pick)
        panel.box_dragged.connect(lambda box: self._pick(key, box))
        panel.hovered.connect(lambda *at: self._read(key, *at))
        panel.left.connect(lambda: self.read_out.setText(HINT))
        panel.view_changed.connect(self.set_view)
        panel.view_reset.connect(self.next_view)
        return panel

    def _pick(self, key: tuple, box: CellBox, cell: tuple | None = None) -> None:
        self._before_pick = self.session, self.session.part_key, self.session.selection()
        if key != self.session.part_key:
            self.session.set_part(key)
        self.session.select_cells(box, cell)

    def _pick_detection(self, key: tuple, index: int) -> None:
        self._before_pick = self.session, self.session.part_key, self.session.selection()
        if key != self.session.part_key:
            self.session.set_part(key)
        self.session.select_detection(index, self.reach_box.value())

    def _undo_pick(self) -> None:
        session, key, selection = self._before_pick
        if session is not self.session or key not in session.parts:
            return
        session.set_part(key)
        session.select_again(selection)

    def _read(self, key: tuple, distance: float, velocity: float, level: float) -> None:
        title = title_of(self.session.parts[key]) if self.session.has_map else NO_MAP
        place = place_text(self.session.parts[key].spectrum, distance, velocity).replace(", ", "   ")
        self.read_out.setText(for_pictures(f"{place}   {level_text(level)}   ({title})"))

    def set_view(self, view: QtCore.QRectF) -> None:
        """What all maps show: a rectangle of range in m and velocity in m/s."""
        self.view = QtCore.QRectF(view)
        for panel in self.panels.values():
            panel.set_view(self.view)
        if self.session is not None and self._limits() != self.colour_bar.limits:
            self.rebuild()

    def _limits(self) -> tuple:
        """Of the colours in dBm: what lies outside of the view sets none."""
        view = self.view
        return self.session.map_limits((view.left(), view.right()), (view.top(), view.bottom()))

    def _show_marks(self) -> None:
        session = self.session
        ray_cell = None if session.ray is None else session.cell_of(session.ray)
        for panel in self.panels.values():
            panel.show_marks(session.box, ray_cell)

    def _range_moved(self, decibels: int) -> None:
        if self.session is not None:
            self.session.set_dynamic_range(decibels)

    def _extent(self, spectra, is_moving_meant: bool) -> QtCore.QRectF:
        """Where there is signal, or the whole map where there is none."""
        spectrum = self.session.parts.whole.spectrum
        everything = extent_of(spectrum.range, spectrum.velocity)
        near = signal_extent(spectra, self.session.map_limits()[0], is_moving_meant)
        if near is None:
            return everything
        return everything.intersected(QtCore.QRectF(QtCore.QPointF(near[0], near[2]), QtCore.QPointF(near[1], near[3])))

    def _find_views(self) -> None:
        """All that is received, and as far as something moves, its surroundings."""
        whole = self.session.parts.whole.spectrum
        parts = [part.spectrum for part in self.session.parts.shown_beside(self.session.partition)[1:]]
        self.whole_view = self._extent([whole], False)
        self.near_view = self._extent(parts or [whole], True)

    def next_view(self) -> None:
        """From any view to what moves, and from there to all that is received."""
        self.set_view(self.whole_view if self.view == self.near_view else self.near_view)


def title_of(part) -> str:
    """What a part is called in the window."""
    if part.group == WHOLE:
        return "everything received"
    if part.group == MESH_GROUP:
        return f"over {part.name}"
    return part.name if part.name != "other" else "other: all the rest"


class blocked:
    """Context in which widgets tell nobody of their changes."""

    def __init__(self, *widgets):
        self._blockers = [QtCore.QSignalBlocker(widget) for widget in widgets]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for blocker in self._blockers:
            blocker.unblock()
