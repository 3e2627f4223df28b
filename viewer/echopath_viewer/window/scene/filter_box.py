"""Which rays are shown and how."""
from __future__ import annotations

from ...model import COLOUR_MODES, SAMPLINGS, FilterError, Filters
from ...model.rays.filters import MAX_BOUNCES
from ...model.session import ALL_VELOCITIES
from ..qt import QtCore, QtGui, QtWidgets, Signal

TYPING_PAUSE_MS = 350
COUNT_LINES = 3
LEVEL_DECIMALS = 6  # of dBm, which saved views have as they were set
UNKNOWN_PATHS = "Which paths are behind this map is not known: its signal was given without selections."
ERROR_WIDTH, MIN_ERROR_WIDTH = 34, 160  # letters, pixels
EXAMPLE = "T .* 'wall*' .* R"
EXPRESSION_HELP = """Path expression: T and R are the radar, between them each hit is . (any), a quoted mesh 'pedestrian/*',
S, D or E (specular, diffuse, on an edge); operators * + ? | ( ) {m,n}; expressions and power > 1e-15 (W) are joined by & | ~.
T . R: direct echoes.   T .{2,} R: multipath.   T .* 'wall*' .* R: by way of a wall."""


class FilterBox(QtWidgets.QWidget):
    """Filters, the name of a new part, colours and number of rays; what is wrong with a text is shown below it."""

    part_named = Signal(str)
    hits_toggled = Signal(bool)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.session = None
        self.from_box = QtWidgets.QSpinBox(minimum=0, maximum=MAX_BOUNCES)
        self.to_box = QtWidgets.QSpinBox(minimum=0, maximum=MAX_BOUNCES)
        self.power_check = QtWidgets.QCheckBox("at least")
        self.power_box = _LevelBox(minimum=-400.0, maximum=100.0, decimals=LEVEL_DECIMALS, singleStep=5.0, suffix=" dBm")
        self.mesh_box = QtWidgets.QComboBox(editable=True)
        self.expression_edit = QtWidgets.QLineEdit(placeholderText=EXAMPLE, clearButtonEnabled=True)
        self.expression_edit.setToolTip(EXPRESSION_HELP)
        self.expression_edit.setAcceptDrops(False)  # a file that is dropped here is the window's
        self.mesh_box.lineEdit().setAcceptDrops(False)
        self.mesh_error, self.expression_error, self.name_error = ErrorLabel(), ErrorLabel(), ErrorLabel()
        self.name_edit = QtWidgets.QLineEdit(placeholderText="name what is shown", clearButtonEnabled=True)
        self.name_edit.setAcceptDrops(False)
        self.name_edit.setToolTip("The rays that are shown now become a part with a map of its own.")
        self.add_button, self.reset_button = QtWidgets.QPushButton("Add"), QtWidgets.QPushButton("Show all")
        self.count_label = QtWidgets.QLabel(wordWrap=True)
        self.count_label.setMinimumHeight(COUNT_LINES * self.fontMetrics().lineSpacing())
        self.colour_box = QtWidgets.QComboBox()
        self.colour_box.addItems(COLOUR_MODES)
        self.limit_box = QtWidgets.QSpinBox(minimum=1, maximum=5_000_000, singleStep=500, groupSeparatorShown=True)
        self.limit_box.setStepType(QtWidgets.QAbstractSpinBox.StepType.AdaptiveDecimalStepType)
        self.sampling_box = QtWidgets.QComboBox()
        self.sampling_box.addItems(SAMPLINGS)
        self.sampling_box.setToolTip("Which rays are drawn: some of every object and part, or the strongest.")
        self.hits_check = QtWidgets.QCheckBox("hit points")
        self._pause = QtCore.QTimer(self, singleShot=True, interval=TYPING_PAUSE_MS)
        self._arrange()
        self._connect()

    def _explain(self) -> None:
        for widget, text in ((self.from_box, "Fewest hits of a ray that is shown"),
                             (self.to_box, "Most hits of a ray that is shown"),
                             (self.power_check, "Leave out weaker rays"), (self.power_box, "Power that a ray must have"),
                             (self.mesh_box, "A mesh, object or pattern that a ray must hit"),
                             (self.add_button, "Name what is shown"), (self.reset_button, "No filter"),
                             (self.colour_box, "What the colours of rays mean (C)"), (self.limit_box, "How many rays are drawn"),
                             (self.hits_check, "A dot at each hit (H)")):
            widget.setToolTip(text)

    def _arrange(self) -> None:
        self._explain()
        form = QtWidgets.QFormLayout(self)
        form.setContentsMargins(4, 4, 4, 4)
        form.setFieldGrowthPolicy(QtWidgets.QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        form.addRow("Colour by", _row(self.colour_box, self.hits_check))
        form.addRow("Draw", _row(self.limit_box, self.sampling_box))
        form.addRow("Bounces", _row(self.from_box, QtWidgets.QLabel("to"), self.to_box, self.reset_button))
        form.addRow("Power", _row(self.power_check, self.power_box))
        form.addRow("Over mesh", self.mesh_box)
        form.addRow(self.mesh_error)
        form.addRow("Path", self.expression_edit)
        form.addRow(self.expression_error)
        form.addRow("New part", _row(self.name_edit, self.add_button))
        form.addRow(self.name_error)
        form.addRow(self.count_label)

    def _connect(self) -> None:
        self._pause.timeout.connect(self.apply)
        for box in (self.from_box, self.to_box, self.power_box):
            box.valueChanged.connect(lambda _: self.apply())
        self.power_check.toggled.connect(lambda _: self.apply())
        self.mesh_box.editTextChanged.connect(lambda _: self._pause.start())
        self.mesh_box.activated.connect(lambda _: self.apply())
        self.expression_edit.textChanged.connect(lambda _: self._pause.start())
        self.expression_edit.returnPressed.connect(self.apply)
        self.add_button.clicked.connect(lambda: self.part_named.emit(self.name_edit.text()))
        self.name_edit.returnPressed.connect(lambda: self.part_named.emit(self.name_edit.text()))
        self.reset_button.clicked.connect(self._show_all)
        self.colour_box.currentTextChanged.connect(lambda mode: self.session and self.session.set_color_by(mode))
        self.limit_box.valueChanged.connect(lambda count: self.session and self.session.set_max_rays(count))
        self.sampling_box.activated.connect(lambda _: self.session.set_sampling(self.sampling_box.currentText()))
        self.hits_check.toggled.connect(self.hits_toggled)

    # --- session ---

    def show_session(self, session) -> None:
        self.session = None
        self.mesh_box.clear()
        self.mesh_box.addItems(["", *(node.name for node in session.scene.nodes)])
        power = session.columns.power
        self.power_box.setValue(round(float(session.columns.power_dbm(power.argmax())) - 40.0) if len(power) else -100.0)
        self.read(session)

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame. is_passing: the next one comes at once, and what is told stays."""
        if is_passing:
            self.session = session
        else:
            self.show_session(session)

    def read(self, session) -> None:
        """Takes over what the session shows, telling nobody."""
        self.session = None
        filters = session.filters
        self.from_box.setValue(filters.min_bounces)
        longest = int(session.columns.num_bounces.max(initial=1))
        self.to_box.setValue(min(filters.max_bounces, longest))
        self.power_check.setChecked(filters.min_power_dbm is not None)
        if filters.min_power_dbm is not None:
            self.power_box.setValue(filters.min_power_dbm)
        self.mesh_box.setCurrentText(filters.mesh)
        self.expression_edit.setText(filters.expression)
        self.colour_box.setCurrentText(session.color_by)
        self.limit_box.setValue(session.max_rays)
        self._pause.stop()
        self.session = session
        self._longest = longest
        self._show_errors({})
        self.show_counts()

    def filters(self) -> Filters:
        """As they are set in the box."""
        highest = self.to_box.value()
        return Filters(min_bounces=self.from_box.value(), max_bounces=MAX_BOUNCES if highest >= self._longest else highest,
                       min_power_dbm=self.power_box.value() if self.power_check.isChecked() else None,
                       mesh=self.mesh_box.currentText(), expression=self.expression_edit.text())

    def apply(self) -> None:
        """Filters the rays, or shows below the text what is wrong with it and leaves the rays as they are."""
        self._pause.stop()
        if self.session is None:
            return
        try:
            if self.filters() != self.session.filters:
                self.session.set_filters(self.filters())
            self._show_errors({})
        except FilterError as error:
            self._show_errors({error.field: str(error)})

    def show_name_error(self, text: str) -> None:
        self.name_error.setText(text)

    def show_counts(self) -> None:
        """How many rays pass, and how many are drawn."""
        session = self.session
        visible = int(session.visible.sum())
        with QtCore.QSignalBlocker(self.colour_box), QtCore.QSignalBlocker(self.limit_box):
            self.colour_box.setCurrentText(session.color_by)
            self.limit_box.setValue(session.max_rays)
            self.sampling_box.setCurrentText(session.sampling)
        if not session.part.is_known:
            self.count_label.setText(UNKNOWN_PATHS)
            return
        text = f"{visible:,} of {session.paths.num_paths:,} paths"
        if session.box is not None:
            text += f", {int(session.lit.sum()):,} of them {session.where_lit()}"
        drawn = len(session.shown_rays() if session.box is None else session.lit_rays())
        why = session.why_no_rays()
        told = why or f"{drawn:,} are drawn"
        if session.box is not None and not session.lit_by and why != ALL_VELOCITIES and session.has_echoes_at_all_velocities():
            told += f"; {ALL_VELOCITIES}"
        self.count_label.setText(f"{text}; {told}")

    def _show_all(self) -> None:
        self.session.set_filters(Filters())
        self.read(self.session)

    def _show_errors(self, errors: dict) -> None:
        fields = (("mesh", self.mesh_error, self.mesh_box),
                  ("expression", self.expression_error, self.expression_edit))
        for field, label, edit in fields:
            text = errors.get(field, "")
            label.setText(text)
            edit.setStyleSheet("border: 1px solid #c0392b" if text else "")


class _LevelBox(QtWidgets.QDoubleSpinBox):
    """A level with as many digits as it has."""

    def textFromValue(self, value: float) -> str:
        return self.locale().toString(value, "g", 9)


def _row(*widgets) -> QtWidgets.QWidget:
    row = QtWidgets.QWidget()
    layout = QtWidgets.QHBoxLayout(row)
    layout.setContentsMargins(0, 0, 0, 0)
    for widget in widgets:
        layout.addWidget(widget)
    return row


class ErrorLabel(QtWidgets.QWidget):
    """What is wrong with a text, and in a fixed pitch the place with a caret below it; hidden where nothing is wrong."""

    def __init__(self):
        super().__init__(visible=False)
        self._lines = []
        self._what, self._where = QtWidgets.QLabel(wordWrap=True), QtWidgets.QLabel()
        self._where.setFont(QtGui.QFontDatabase.systemFont(QtGui.QFontDatabase.SystemFont.FixedFont))
        self._where.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Fixed)
        self.setStyleSheet("color: #c0392b")
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self._what)
        column.addWidget(self._where)

    def resizeEvent(self, event):
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        """The message in as many lines as it needs, the place in as many letters as there is room for."""
        width = max(self.width(), MIN_ERROR_WIDTH)
        letters = max(int(width * ERROR_WIDTH / self._where.fontMetrics().horizontalAdvance("m" * ERROR_WIDTH)) - 1, 8)
        self._where.setText("\n".join(around_caret(*self._lines, letters)) if len(self._lines) == 2 else "")
        self._what.setMinimumHeight(self._what.heightForWidth(width) if self._what.text() else 0)

    def text(self) -> str:
        return f"{self._what.text()}\n{self._where.text()}".strip("\n")

    def setText(self, text: str) -> None:
        """text: a message; where it has a line with a caret below, the part around the caret is shown."""
        what, *where = text.split("\n")
        self._what.setText(what.removeprefix("path expression: "))
        self._lines = where[-2:]
        self._fit()
        self._where.setVisible(len(where) >= 2)
        self.setVisible(bool(text))


def around_caret(line: str, caret: str, width: int = ERROR_WIDTH) -> tuple:
    """The part of a line, `width` letters at most, that the caret in the next line stands under, and that line."""
    begin = max(0, min(caret.find("^") - width // 2, len(line) - width))
    return line[begin:begin + width], caret[begin:begin + width]
