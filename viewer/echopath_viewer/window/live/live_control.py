"""A live scene in the window: what is dragged is traced again, preview first, then in full quality."""
from __future__ import annotations

from collections import deque

import numpy as np

from echopath.base.text.mesh_names import object_of

from ...model.frames.live_session import live_of, session_of_view, show_state
from ..qt import QtCore, Signal

RADAR = "radar (TX/RX)"  # as an object that is moved; none has a name with a slash
BUDGET = 0.05    # s, that a preview may take


class LiveControl(QtCore.QObject):
    """Watches an ep.Live; tells sessions of its views in the thread of the window, the latest alone where that is slower."""

    shown, failed, stopped = Signal(object, object), Signal(str), Signal()  # Session, LiveView
    _made, _broken = Signal(), Signal(object)  # ep.Live

    def __init__(self, state_now, parent=None):
        """state_now: callable () -> state of the view, to be taken over"""
        super().__init__(parent)
        self._state_now, self._state, self.live, self._watch = state_now, None, None, None
        self._first_materials = {}  # {name of a mesh: Material} of the objects that have got others
        self._latest = deque(maxlen=1)  # (Session, LiveView, state that it was made for) that the window has not taken yet
        self._made.connect(self._tell)  # in the thread of the window, as this object lives there
        self._broken.connect(self._end)

    @property
    def is_on(self) -> bool:
        """Whether a scene is live."""
        return self.live is not None

    def start(self, session, num_rays: int, live=None) -> None:
        """Makes the scene of a session live. live: ep.Live to be watched in place of a new one. Raises ValueError."""
        self.stop()
        self._first_materials = {}
        self._settings = session.signals.spectrum_settings
        self._state = self._state_now()
        self.live = watched = live_of(session, num_rays) if live is None else live
        self._watch = watched.watch(self._show, budget=BUDGET, failed=lambda error: self._broken.emit(watched))

    def stop(self) -> None:
        """Ends the watch; the view that was shown last stays."""
        watch, self._watch, self.live = self._watch, None, None
        if watch is not None:
            try:
                watch.stop()
            except Exception as error:  # what had ended it before
                self.failed.emit(f"The live view has ended: {str(error) or type(error).__name__}")
            self._latest.clear()
            self.stopped.emit()

    def is_settled(self) -> bool:
        """Whether the full view of the latest change was shown."""
        return self._watch is None or self._watch.wait(1e-3)

    def _end(self, live) -> None:
        """Tells what has ended the watch, unless another scene is live by now."""
        if live is self.live:
            self.stop()

    # --- changes ---

    def objects(self) -> list[str]:
        """What can be moved: the radar and the children of the root."""
        return [RADAR, *dict.fromkeys(object_of(mesh.name) for mesh in self.live.scene.meshes)]

    def position(self, name: str):
        """[3] m."""
        return np.array(self.live.radar.position if name == RADAR else self.live.scene[name].position, float)

    def yaw(self, name: str) -> float:
        """rad"""
        return 0.0 if name == RADAR else float(self.live.scene[name].yaw)

    def materials(self, name: str) -> list:
        """Of the meshes of an object; the radar has none."""
        return [] if name == RADAR else [mesh.material for mesh in self.live.scene[name].meshes]

    def move(self, name: str, position) -> None:
        """To a position in m."""
        if name == RADAR:
            self._try(lambda: setattr(self.live, "radar", self.live.radar.replace(position=tuple(map(float, position)))))
        else:
            self._change(name, "position", tuple(map(float, position)))

    def turn(self, name: str, yaw: float) -> None:
        """To a yaw in rad."""
        self._change(name, "yaw", yaw)

    def set_material(self, name: str, material) -> None:
        """Of all meshes of an object. Flagged mirrors, as of `ep.mark_mirrors`, stay such unless the material lets rays pass."""
        self._remember_materials(name)

        def change(scene):
            for mesh in scene[name].meshes:
                is_mirror = self._first_materials[mesh.name].mirror and not material.layers
                scene[mesh.name].material = material.replace(mirror=is_mirror or material.mirror)

        self._try(lambda: self.live.change(change))

    def restore_materials(self, name: str) -> None:
        """Each mesh of an object gets the material that it had when the scene became live."""
        def change(scene):
            for mesh in scene[name].meshes:
                scene[mesh.name].material = self._first_materials.get(mesh.name, mesh.material)

        self._try(lambda: self.live.change(change))

    def _remember_materials(self, name: str) -> None:
        if name in self.live.scene:
            self._first_materials = {mesh.name: mesh.material for mesh in self.live.scene[name].meshes} | self._first_materials

    def roughen(self, name: str, height: float) -> None:
        """Each mesh of an object keeps its material, with an rms roughness height in m in place of a share that it scatters."""
        self._remember_materials(name)

        def change(scene):
            for mesh in scene[name].meshes:
                scene[mesh.name].material = mesh.material.replace(scattering=None, roughness_height=height)

        self._try(lambda: self.live.change(change))

    def _change(self, name: str, field: str, value) -> None:
        self._try(lambda: self.live.change(lambda scene: setattr(scene[name], field, value)))

    def _try(self, work) -> None:
        self._state = self._state_now()
        try:
            work()
        except (ValueError, TypeError, KeyError) as error:
            self.failed.emit(str(error))

    def _show(self, view) -> None:
        """In the thread of the watch."""
        live = self.live
        if live is None:
            return
        state = self._state
        self._latest.append((session_of_view(live, view, state, self._settings), view, state))
        self._made.emit()

    def _tell(self) -> None:
        if not (self._latest and self.is_on):
            return
        session, view, made_for = self._latest.pop()
        self._state = self._state_now()
        show_state(session, self._state, made_for)
        self.shown.emit(session, view)
