"""Maps beside range-Doppler, each in a panel of its own, linked with it."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np

import echopath as ep
from echopath.base.radar.antennas import mixes_polarisations
from echopath.signals.measures import for_pictures

from ...model import CellBox
from ...model.maps.angle_maps import (
    beat_signal,
    kept_azimuth_map,
    range_azimuth_map,
    range_elevation_map,
    require_signals,
    spectrogram_map,
)
from ...model.maps.part_set import level_text, upper_end
from ..background_work import BackgroundWork
from ..banner import ThinBar
from ..qt import QtCore, QtWidgets
from .colour_bar import ColourBar
from .curve import CurveView
from .map_area import title_of
from .map_panel import RANGE_LABEL, VELOCITY_LABEL, MapPanel, extent_of, nearest_index
from .ticks import step_of

SEVERAL_PAIRS = ("The channels have several pairs of polarisations, which beams add as if they had one: echoes may cancel, as VV "
                 "and HH of a dihedral do.")
AZIMUTH_LABEL, ELEVATION_LABEL, TIME_LABEL = "Azimuth in degrees (left: +)", "Elevation in degrees", "Time in ms"


class SeenPanel(QtWidgets.QWidget):
    """Shows something of a session, `refresh`, which makes nothing where nobody looks."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.session, self._is_seen = None, False

    def show_session(self, session) -> None:
        self.session = session
        self.refresh()

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame. is_passing: the next one comes at once, and nothing is made of this one."""
        self.session = session
        if not is_passing:
            self.refresh()

    def set_seen(self, is_seen: bool) -> None:
        """Whether anyone looks."""
        self._is_seen = is_seen
        self.refresh()

    def refresh(self) -> None:
        """Shows what the session has now."""
        raise NotImplementedError

    def stop(self) -> None:
        """Ends the work, where there is any."""


class SidePanel(SeenPanel):
    """A map that is made in a thread when somebody looks, and again when what it is made of has changed."""

    x_label, y_label = RANGE_LABEL, VELOCITY_LABEL

    def __init__(self, parent=None):
        super().__init__(parent)
        self.map, self._made_of = None, None
        self.panel, self.note = MapPanel(x_label=self.x_label, y_label=self.y_label), QtWidgets.QLabel(wordWrap=True)
        self.bar, self.colour_bar, self.work = ThinBar(), ColourBar(), BackgroundWork(self)
        self.colour_bar.hide()
        row, column = QtWidgets.QHBoxLayout(), QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        row.addWidget(self.panel, 1)
        row.addWidget(self.colour_bar)
        column.addWidget(self.bar)
        column.addLayout(row, 1)
        column.addWidget(self.note)
        self.work.advanced.connect(self.bar.advance)
        self.work.done.connect(self._take)
        self.work.failed.connect(self._fail)
        self.panel.cell_clicked.connect(self.pick)
        self.panel.view_changed.connect(self.panel.set_view)
        self.panel.view_reset.connect(lambda: self.panel.set_view(extent_of(self.map.x, self.map.y)))
        self.panel.hovered.connect(lambda *at: self.note.setText(self.words_of(*at)))
        self.panel.left.connect(lambda: self.map is not None and self.note.setText(self.caution()))

    # --- of each kind ---

    def made_of(self, session) -> tuple:
        """What the map depends on."""
        return session.part.spectrum, session.radar

    def work_of(self, session):
        """Callable (progress) -> SideMap; touches no session, which goes on meanwhile. Raises ValueError where there is none."""
        raise NotImplementedError

    def pick(self, x_index: int, y_index: int) -> None:
        """Selects in the session what a cell of the map is."""
        raise NotImplementedError

    def marks(self) -> tuple:
        """(CellBox or None, cell or None) of what is selected."""
        raise NotImplementedError

    def words_of(self, x: float, y: float, level: float) -> str:
        """Of the cell under the mouse."""
        raise NotImplementedError

    def caution(self) -> str:
        """What whoever reads the map should know of it, in words."""
        return ""

    # --- session ---

    def update_topics(self, topics: set) -> None:
        if topics & {"maps", "rays"}:
            self.refresh()
        elif topics & {"selection", "time"}:
            self.show_marks()

    def refresh(self) -> None:
        """Makes the map where it is of something else now."""
        if self.session is None or not self._is_seen:
            return
        made_of = self.made_of(self.session)
        if self._made_of is not None and all(one is other for one, other in zip(made_of, self._made_of)):
            if self.map is not None and self.colour_bar.limits != self._limits():
                self._show_map(self.panel.view)
            self.show_marks()
            return
        self._made_of = made_of
        try:
            work = self.work_of(self.session)
        except ValueError as error:
            self.work.stop()
            self._fail(str(error))
            return
        self.bar.begin()
        self.work.start(work)

    def _take(self, found) -> None:
        self.bar.hide()
        self.note.setText(self.caution())
        is_same = self.map is not None and np.array_equal(self.map.x, found.x) and np.array_equal(self.map.y, found.y)
        self.map = found
        self._show_map(self.panel.view if is_same else extent_of(found.x, found.y))
        self.show_marks()

    def _show_map(self, view: QtCore.QRectF) -> None:
        axes, limits = SimpleNamespace(range=self.map.x, velocity=self.map.y), self._limits()
        self.panel.show_map(self.map.title, self.map.level, axes, limits, view, is_current=False)
        self.colour_bar.show_limits(*limits)
        self.colour_bar.show()

    def _limits(self) -> tuple:
        """Of the colours in dBm."""
        highest = upper_end(float(self.map.level.max()))
        return highest - self.session.dynamic_range_db, highest

    def _fail(self, text: str) -> None:
        self.bar.hide()
        self.map = None
        self.panel.show_nothing()
        self.colour_bar.hide()
        self.note.setText(f"There is no map to show: {text}.")

    def show_marks(self) -> None:
        """Where the selection of the session is in this map."""
        if self.session is not None and self.map is not None:
            self.panel.show_marks(*self.marks())

    def stop(self) -> None:
        """Ends the work."""
        self.work.stop()


class _AnglePanel(SidePanel):
    """Range and an angle: a click selects the beam there, and of the velocities in the map the strongest."""

    def caution(self) -> str:
        return SEVERAL_PAIRS if mixes_polarisations(self.session.radar) else ""

    def marks(self) -> tuple:
        session = self.session
        if session.box is None or not self._has_ranges_of(session):
            return None, None
        box = CellBox(session.box.first_range, session.box.last_range, 0, len(self.map.y) - 1)
        angle = None if session.beam is None else np.degrees(session.beam[self.axis])
        cell = None if angle is None else (session.cell[0], nearest_index(self.map.y, angle))
        return box, cell

    def _has_ranges_of(self, session) -> bool:
        """Whether indices of ranges mean the same: the map may still be that of the frame before."""
        ranges = np.asarray(session.parts.whole.spectrum.range)
        return len(self.map.x) == len(ranges) and bool(np.allclose(self.map.x, ranges))

    def pick(self, x_index: int, y_index: int) -> None:
        if self._has_ranges_of(self.session):
            self._pick_beam(x_index, float(np.radians(self.map.y[y_index])))

    def _pick_beam(self, range_index: int, angle: float) -> None:
        """Selects what the map has at a range and an angle in rad."""
        raise NotImplementedError

    def words_of(self, x: float, y: float, level: float) -> str:
        return for_pictures(f"{x:.2f} m   {y:+z.1f}\u00b0   {level_text(level)}")


class AzimuthPanel(_AnglePanel):
    """Range-azimuth map of the part on display."""

    y_label, axis = AZIMUTH_LABEL, 0

    def work_of(self, session):
        maps, note = session.kept_maps, session.note
        if maps is not None:
            return lambda progress: kept_azimuth_map(maps, note)
        spectrum, radar, name, angles = session.part.spectrum, session.radar, title_of(session.part), session.angles
        return lambda progress: range_azimuth_map(spectrum, radar, name, progress, angles=angles)

    def _pick_beam(self, range_index: int, angle: float) -> None:
        velocities = len(self.session.part.spectrum.velocity)
        rows = self.map.rows if self.map.rows is not None and len(self.map.rows) == velocities else None  # of a frame before
        self.session.select_beam(range_index, angle, self.map.elevations, rows=rows)


class ElevationPanel(_AnglePanel):
    """Range-elevation map of the part on display, where the antennas look."""

    y_label, axis = ELEVATION_LABEL, 1

    def work_of(self, session):
        require_signals(session)
        spectrum, radar, name = session.part.spectrum, session.radar, title_of(session.part)
        return lambda progress: range_elevation_map(spectrum, radar, name, progress)

    def _pick_beam(self, range_index: int, angle: float) -> None:
        self.session.select_beam(range_index, ep.virtual_array(self.session.radar).boresight, angle)


class SpectrogramPanel(SidePanel):
    """Power over the time of the frame: a click goes to its chirp and selects all ranges of its velocity."""

    x_label = TIME_LABEL

    def made_of(self, session) -> tuple:
        return session.cube, session.columns

    def work_of(self, session):
        require_signals(session)
        cube, radar, channel = session.cube, session.radar, session.channel
        return lambda progress: spectrogram_map(cube, radar, channel, progress)

    def marks(self) -> tuple:
        session, box = self.session, None
        if session.box is not None:
            velocity = session.parts.whole.spectrum.velocity
            slow, fast = (nearest_index(self.map.y, float(velocity[index]))
                          for index in (session.box.first_velocity, session.box.last_velocity))
            box = CellBox(0, len(self.map.x) - 1, slow, fast)
        time = 1e3 * (session.time - session.paths.frame.start_time)
        middle = int(np.abs(self.map.y).argmin()) if box is None else box.first_velocity
        return box, (nearest_index(self.map.x, time), middle)

    def pick(self, x_index: int, y_index: int) -> None:
        session, spectrum = self.session, self.session.parts.whole.spectrum
        half = 0.5 * step_of(self.map.y)
        slow, fast = (nearest_index(np.asarray(spectrum.velocity), float(self.map.y[y_index]) + sign * half) for sign in (-1, 1))
        session.select_cells(CellBox(0, len(spectrum.range) - 1, slow, fast))
        radar, tx = session.radar, session.channel[0]
        times = np.array([radar.chirp_time(tx, chirp) for chirp in range(radar.waveform.num_chirps)])  # which need not be even
        session.set_chirp(int(np.abs(times - 1e-3 * float(self.map.x[x_index])).argmin()))

    def words_of(self, x: float, y: float, level: float) -> str:
        return for_pictures(f"{x:.2f} ms   {y:+z.2f} m/s   {level_text(level)}")


class BeatPanel(SeenPanel):
    """The beat signal of the chirp on display: real and, of complex samples, imaginary part over its samples."""

    def __init__(self, parent=None):
        super().__init__(parent)
        self.curves = CurveView("Time in \u00b5s", "\u221aW")
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(2, 2, 2, 2)
        column.addWidget(self.curves)

    def update_topics(self, topics: set) -> None:
        if topics & {"time", "maps"}:
            self.refresh()

    def refresh(self) -> None:
        """The samples of the chirp and channel of the session."""
        if self.session is None or not self._is_seen:
            return
        session = self.session
        if session.kept_maps is not None:
            self.curves.show_curves("the file keeps no signals", (), {})
            return
        times, samples = beat_signal(session.cube, session.radar, session.channel, session.chirp)
        title = "beat signal of chirp {}, TX {}, RX {}".format(session.chirp + 1, *session.channel)
        quadrature = {} if session.radar.waveform.real else {"imaginary": samples.imag}
        self.curves.show_curves(title, 1e6 * times, {"real": samples.real} | quadrature)
