"""The 3-D view."""
from __future__ import annotations

import time

import numpy as np
import pyvista as pv
from pyvistaqt import QtInteractor

from ...scene_builder import SceneBuilder
from ..qt import Qt, QtCore, Signal
from .coarse_pixels import coarse_pixels
from .compass import Compass
from .legend_box import LegendBox
from .name_box import NameBox
from .pace import FEW_RAYS, MANY_RAYS, Pace, Smoothing
from .picks import CLICK_REACH, Picks
from .pixel_size import pixel_at, pixels_per_radian

GL_COLOR_BUFFER_BIT = 0x4000
LONGEST_WAIT_MS = 2000  # for a picture, of what is to come after it
COARSEST = 3  # pixels while the camera is turned, of the screen's
ONE_PLACE = 0.5  # of a pixel, as wide as it is at the nearest ray: ends so close are one while the camera moves


class View3D(Picks, QtInteractor):
    """Draws a session; tells what is clicked: a ray, else the body under the cursor; with Ctrl always the mesh."""

    ray_clicked = Signal(int)
    mesh_clicked = Signal(int)
    nothing_clicked = Signal()
    mesh_dragged = Signal(int, object)  # with Shift: the mesh, [3] m on the horizontal plane through where it was taken
    _in_paint = False  # of pyvistaqt, which sets it in its constructor

    def __init__(self, parent=None):
        self.builder = None  # a resize may come before the constructor has ended
        # Multisampling takes most of the time where there is no graphics card: Smoothing begins it elsewhere.
        self._is_behind = self._is_fresh = False
        super().__init__(parent, auto_update=False, multi_samples=0)
        self._afterwards = None
        self._press, self._drag = None, None
        self.name_box, self.legend_box = NameBox(self), LegendBox(self)  # which stands over the names
        self.clock, self._turning, self._passing = time.perf_counter, Pace(COARSEST, MANY_RAYS), Pace(1, FEW_RAYS)
        self._pace = None  # of the two, while the camera turns or frames pass
        self._drawn_as = None  # number of rays and cell, while that is so
        self._smoothing = Smoothing()
        self.compass = Compass(self)
        self.setAcceptDrops(False)  # what is dropped here is the window's: pyvistaqt would read it with VTK
        # VTK draws in paintGL alone: a drawing of its own, at each turn of the camera, would come on top of that.
        self.iren.interactor.EnableRenderOff()
        self.iren.interactor.AddObserver("RenderEvent", lambda *_: self.render_soon())
        style = self.iren.interactor.GetInteractorStyle()
        style.AddObserver("StartInteractionEvent", lambda *_: self.set_moving(self._turning))
        style.AddObserver("EndInteractionEvent", lambda *_: self.set_moving(None))

    def show_session(self, session) -> None:
        """Replaces what is drawn; nothing moves any more. What was drawn is thrown away as it is."""
        self._pace = self._drawn_as = None
        self.clear()
        self.name_box.forget()
        self.enable_3_lights()
        self.builder = SceneBuilder(self, session, legend=self.legend_box, names=self.name_box,
                                    background=self.background(), is_quick=True)
        self._is_fresh = True
        QtCore.QTimer.singleShot(0, self._first_look)

    def follow_session(self, session, is_passing: bool = False) -> None:
        """Another frame of the same time line: the camera stays where it is. is_passing: the next one comes at once, and there
        are only as many rays as while the camera moves."""
        self.builder.show_session(session)
        self.set_moving(self._passing if is_passing else None)
        self.render_soon()

    def background(self) -> str:
        """White, or near black in a dark theme."""
        return "white" if self.palette().base().color().lightness() >= 128 else "#17181a"

    def changeEvent(self, event):
        super().changeEvent(event)
        if event.type() == QtCore.QEvent.Type.PaletteChange and self.builder is not None:
            self.builder.set_background(self.background())
            self.builder.update({"rays"})
            self.render_soon()

    def _first_look(self) -> None:
        """Once the window has its size."""
        if self.builder is not None and self._is_fresh:
            self.look("fit")

    def update_topics(self, topics: set) -> None:
        self.builder.update(topics)
        self.render_soon()

    def look(self, view: str) -> None:
        self._is_fresh = False
        self.builder.look(view)
        self.render_soon()

    def render(self) -> None:
        """What pyvista calls after changes; they are drawn with the next picture."""
        self._rendered = True  # pyvista asks for it
        self.render_soon()

    def render_soon(self) -> None:
        """Once, when all changes of this turn of the event loop are made."""
        if not self._in_paint:
            self._is_behind = True
            self.update()

    def is_behind(self) -> bool:
        """Whether changes are still to be drawn."""
        return self._is_behind and self.isVisible() and not self.window().isMinimized()

    def when_drawn(self, work) -> None:
        """Calls `work` after the next picture of what is shown, or after a while where none is drawn, as of a minimised window;
        once. None: not any more."""
        self._afterwards = work
        if work is not None:
            QtCore.QTimer.singleShot(LONGEST_WAIT_MS, lambda: self._go_on(work))

    def _go_on(self, work) -> None:
        if work is self._afterwards:
            self._afterwards = None
            work()

    def paintGL(self):
        """Draws, once; changes that are made from now on ask for another picture. Nothing before the first look."""
        if self._is_fresh:
            self._clear()
            return
        self._draw()
        work = self._afterwards
        if work is not None:
            QtCore.QTimer.singleShot(0, lambda: self._go_on(work))

    def _clear(self) -> None:
        functions = self.context().functions()
        functions.glClearColor(*pv.Color(self.background()).float_rgb, 1.0)
        functions.glClear(GL_COLOR_BUFFER_BIT)

    def _draw(self) -> None:
        if self._pace is not None and self.builder is not None:
            self._show_moving()
        self._is_behind, begin = False, self.clock()
        interactor = self.iren.interactor
        interactor.EnableRenderOn()
        try:
            with coarse_pixels(self.render_window, 1 if self._pace is None else self._pace.coarseness):
                super().paintGL()
        finally:
            interactor.EnableRenderOff()
        if self.builder is not None:  # a picture may come after the window was closed
            self._learn(self.clock() - begin)
            self.compass.follow(self.camera, self.height())
            self.name_box.follow(self.clip_from_world())

    def _learn(self, seconds: float) -> None:
        """How much the next pictures may have, from what one took."""
        if self._pace is not None:
            self._pace.follow(seconds, len(self.builder.rays.segments.rays))
        if self._smoothing.follow(seconds):
            self.render_window.SetMultiSamples(self._smoothing.samples)
            self.render_soon()

    def camera_state(self) -> dict:
        camera = self.camera
        return {"position": list(camera.position), "focal_point": list(camera.focal_point), "up": list(camera.up),
                "view_angle": camera.view_angle}

    def set_camera_state(self, state: dict) -> None:
        self._is_fresh = False
        for name in ("position", "focal_point", "up", "view_angle"):
            setattr(self.camera, name, state[name])
        self.reset_camera_clipping_range()
        self.render_soon()

    def set_moving(self, pace: Pace | None) -> None:
        """Fewer rays and coarser pixels as long as the camera moves, where all take too long; None: it does not any more."""
        if self.builder is None:
            return
        if pace not in (None, self._pace):
            pace.begin()
        self._pace, self._drawn_as = pace, None
        if pace is not None:
            self._show_moving()
            return
        self.builder.show_first_rays(None)
        self.builder.show_quick_meshes(None)
        self.render_soon()

    def _show_moving(self) -> None:
        """As many rays as the pace allows; of those that no pixel tells apart the first."""
        seen = self.camera.view_angle, self.render_window.GetSize()[1]
        self.builder.show_quick_meshes(pixels_per_radian(*seen) / self._pace.coarseness)
        pixel = pixel_at(self.builder.nearest_ray(), *seen)
        drawn_as = self._pace.num_rays, ONE_PLACE * self._pace.coarseness * pixel
        if drawn_as != self._drawn_as:
            self._drawn_as = drawn_as
            self.builder.show_first_rays(*drawn_as)

    # --- picking ---

    def _click(self, x: float, y: float, wants_mesh: bool) -> None:
        ray = None if wants_mesh else self.ray_at(x, y)
        mesh = self.mesh_at(x, y, wants_mesh) if ray is None else None
        if ray is not None:
            self.ray_clicked.emit(ray)
        elif mesh is not None:
            self.mesh_clicked.emit(mesh)
        else:
            self.nothing_clicked.emit()

    # --- Qt ---

    def resizeEvent(self, event):
        super().resizeEvent(event)
        if self.builder is not None:
            self.builder.resized()
            self.compass.place()
            self.render_soon()

    def _take_hold(self, at) -> bool:
        """Of the mesh under the cursor, to drag its object."""
        mesh = self.mesh_at(at.x(), at.y(), False)
        if mesh is None:
            return False
        height = float(self.builder.meshes.bounds_of([mesh])[0][:, 2].mean())
        self._drag = mesh, height, self.world_at(at.x(), at.y(), height)
        if self._drag[2] is None:
            self._drag = None
            return False
        self.mesh_dragged.emit(mesh, np.zeros(3))
        return True

    def mouseMoveEvent(self, event):
        if self._drag is None:
            super().mouseMoveEvent(event)
            return
        mesh, height, begin = self._drag
        at = self.world_at(event.position().x(), event.position().y(), height)
        if at is not None:
            self.mesh_dragged.emit(mesh, at - begin)

    def mousePressEvent(self, event):
        is_hold = event.button() == Qt.MouseButton.LeftButton and event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if is_hold and self.builder is not None and self._take_hold(event.position()):
            return
        self._press = event.position() if event.button() == Qt.MouseButton.LeftButton else None
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event):
        if self._drag is not None:
            self._drag = None
            return
        super().mouseReleaseEvent(event)
        press, self._press = self._press, None
        if press is None or self.builder is None:
            return
        if (event.position() - press).manhattanLength() <= CLICK_REACH:
            at = event.position()
            self._click(at.x(), at.y(), bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier))

    def keyPressEvent(self, event):
        """Keys are the window's: VTK's own would quit or change to wire frames."""
        event.ignore()

    def keyReleaseEvent(self, event):
        event.ignore()
