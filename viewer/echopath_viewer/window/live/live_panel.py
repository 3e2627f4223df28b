"""Objects, antennas and materials that are changed while scene, rays and map follow."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...model.frames.live_session import DEFAULT_RAYS, TITLE
from ..maps.ticks import nice_below, step_of
from ..qt import Qt, QtCore, QtWidgets, Signal
from .live_control import RADAR
from .typed_box import TypedBox

STEP, FARTHEST = 0.1, 1e4    # m; less where cells of range are finer
ROUGHEST, NUM_STEPS = 5e-3, 100  # m, of the slider, and its steps
ALONE = "echoes of the scene alone, without noise, rain and other radars"
FIRST = "as at the start"  # of the materials
STATE_LINES = 4      # of what is told of a view: numbers above it keep their height
HINT = "Start, then drag an object in the scene with Shift held, or change the numbers."


class LivePanel(QtWidgets.QWidget):
    """Tells the control what is to change, and shows whether what is seen is a preview."""

    begins = Signal()  # a frame is about to become live

    def __init__(self, control, parent=None):
        """control: LiveControl"""
        super().__init__(parent)
        self.control, self.session, self._is_filling = control, None, False
        self.start_button = QtWidgets.QPushButton("Start", checkable=True)
        self.rays_box = QtWidgets.QSpinBox(minimum=1, maximum=1_000_000_000, singleStep=10_000, suffix=" rays")
        self.rays_box.setValue(DEFAULT_RAYS)
        self.object_box, self.material_box = QtWidgets.QComboBox(), QtWidgets.QComboBox()
        self.material_box.addItems([FIRST, *ep.materials])
        limits = {"minimum": -FARTHEST, "maximum": FARTHEST, "singleStep": STEP, "decimals": 3, "suffix": " m"}
        self.place_boxes = [TypedBox(prefix=f"{axis} ", **limits) for axis in "xyz"]
        self.yaw_box = TypedBox(minimum=-360.0, maximum=360.0, singleStep=1.0, prefix="yaw ", suffix="\u00b0")
        self.rough_slider = QtWidgets.QSlider(Qt.Orientation.Horizontal, maximum=NUM_STEPS)
        self.rough_label, self.state_label = QtWidgets.QLabel(), QtWidgets.QLabel(HINT, wordWrap=True)
        self.state_label.setMinimumHeight(STATE_LINES * self.fontMetrics().lineSpacing())
        self._arrange()
        self._connect()
        self._enable(False)

    def _arrange(self) -> None:
        for widget, text in ((self.start_button, "Trace the scene again after each change"),
                             (self.rays_box, "Of the full view, which follows each preview"),
                             (self.object_box, "What is moved, turned or given another material"),
                             (self.yaw_box, "Turned to the left"), (self.material_box, "Of all meshes of the object"),
                             (self.rough_slider, "Rms roughness height of its surfaces, which makes echoes diffuse"),
                             *((box, "Position in the world") for box in self.place_boxes)):
            widget.setToolTip(text)
        form = QtWidgets.QFormLayout(self)
        form.setContentsMargins(4, 4, 4, 4)
        place, rough = QtWidgets.QVBoxLayout(), QtWidgets.QHBoxLayout()
        for box in self.place_boxes:
            place.addWidget(box)
        for widget in (self.rough_slider, self.rough_label):
            rough.addWidget(widget)
        for label, item in (("", self.start_button), ("Quality", self.rays_box), ("Object", self.object_box), ("Place", place),
                            ("Turn", self.yaw_box), ("Material", self.material_box), ("Roughness", rough)):
            form.addRow(label, item)
        form.addRow(self.state_label)

    def _connect(self) -> None:
        self.start_button.toggled.connect(self._toggle)
        self.object_box.currentTextChanged.connect(lambda _: self._show_object())
        for axis, box in enumerate(self.place_boxes):
            box.valueChanged.connect(lambda value, axis=axis: self._move(axis, value))
        self.yaw_box.valueChanged.connect(self._turn)
        self.material_box.activated.connect(self._choose_material)
        self.rough_slider.valueChanged.connect(self._roughen)
        self.control.shown.connect(lambda _, view: self._tell(view))
        self.control.stopped.connect(lambda: self.start_button.setChecked(False))

    def show_session(self, session) -> None:
        """Another frame: what was live is not any more."""
        self.session = session
        if session.title != TITLE:
            self.start_button.setChecked(False)

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame of a time line, or another view of what is live."""
        self.show_session(session)

    def update_topics(self, topics: set) -> None:
        """Nothing of it depends on what is shown."""

    def stop(self) -> None:
        """Ends the watch."""
        self.start_button.setChecked(False)
        self.control.stop()

    def attach(self, live, session) -> None:
        """Watches an ep.Live, whose view the session is."""
        self.session = session
        self._begin(live)

    def _toggle(self, is_on: bool) -> None:
        self.start_button.setText("Stop" if is_on else "Start")
        if not is_on:
            self.control.stop()
            self._enable(False)
            self.state_label.setText(HINT)
        elif not self.control.is_on:
            self.begins.emit()
            self._begin(None)

    def _begin(self, live) -> None:
        try:
            self.control.start(self.session, self.rays_box.value(), live)
        except (ValueError, TypeError) as error:
            self.state_label.setText(str(error))
            self.start_button.setChecked(False)
            return
        with QtCore.QSignalBlocker(self.object_box):
            self.object_box.clear()
            self.object_box.addItems(self.control.objects())
            self.object_box.setCurrentIndex(min(1, self.object_box.count() - 1))
        cell = step_of(self.session.parts.whole.spectrum.range)
        for box in self.place_boxes:
            box.setSingleStep(min(STEP, nice_below(cell)))
        self.rays_box.setValue(self.control.live.num_rays)
        self.start_button.setChecked(True)
        self._enable(True)
        self._show_object()

    def _enable(self, is_on: bool) -> None:
        for widget in (self.object_box, *self.place_boxes, self.yaw_box, self.material_box, self.rough_slider):
            widget.setEnabled(is_on)
        self.rays_box.setEnabled(not is_on)

    def read(self, keeps_typed: bool = False) -> None:
        """Takes over where the object is; keeps_typed: but for a box whose number is being typed."""
        name = self.object_box.currentText()
        if not self.control.is_on or not name:
            return
        self._is_filling = True
        values = [*self.control.position(name), np.degrees(self.control.yaw(name))]
        for box, value in zip((*self.place_boxes, self.yaw_box), values):
            (box.follow if keeps_typed else box.setValue)(value)
        for widget in (self.yaw_box, self.material_box, self.rough_slider):
            widget.setEnabled(name != RADAR)
        self._is_filling = False

    def _show_object(self) -> None:
        """Takes over where the object that was chosen is, and what it is made of."""
        self.read()
        name = self.object_box.currentText()
        if not self.control.is_on or not name:
            return
        self._show_roughness()
        self.material_box.setCurrentIndex(0)

    def _show_roughness(self) -> None:
        if not self.control.is_on:
            return
        name = self.object_box.currentText()
        heights = {material.roughness_height if material.scattering is None else None  # else a share of power tells
                   for material in self.control.materials(name)}
        height = heights.pop() if len(heights) == 1 else None
        with QtCore.QSignalBlocker(self.rough_slider):
            self.rough_slider.setValue(0 if height is None else round(NUM_STEPS * height / ROUGHEST))
        self.rough_label.setText("" if height is None else f"{1e3 * height:.2f} mm")

    def choose(self, name: str) -> None:
        """An object of the scene."""
        self.object_box.setCurrentText(name)

    def _move(self, axis: int, value: float) -> None:
        """Along one axis alone: the boxes of the others show what is rounded to 1 mm, a quarter of a wavelength."""
        def change(name: str) -> None:
            position = self.control.position(name)
            position[axis] = value
            self.control.move(name, position)

        self._change(change)

    def _turn(self, degrees: float) -> None:
        self._change(lambda name: self.control.turn(name, float(np.radians(degrees))))

    def _change(self, change) -> None:
        if self.control.is_on and not self._is_filling:
            change(self.object_box.currentText())

    def _choose_material(self, number: int) -> None:
        if number:
            material = ep.materials[self.material_box.currentText()]
            self._change(lambda name: self.control.set_material(name, material))
        else:
            self._change(self.control.restore_materials)
        self._show_roughness()

    def _roughen(self, step: int) -> None:
        height = ROUGHEST * step / NUM_STEPS
        self.rough_label.setText(f"{1e3 * height:.2f} mm")
        self._change(lambda name: self.control.roughen(name, height))

    def _tell(self, view) -> None:
        """Takes over, too, where the object was dragged to: not at each step of the mouse, as each change of a widget has the
        whole window composed anew, which takes software as long as a picture."""
        self.read(keeps_typed=True)
        words = "preview, full quality follows" if view.is_preview else "full quality"
        shot = f"{view.num_rays:,} rays, {view.num_rays_shot:,} shot anew"
        self.state_label.setText(f"{words}: {shot}, {1e3 * view.seconds:.0f} ms; {ALONE}")
