"""Scenes that are changed while their map is watched."""
from __future__ import annotations

import dataclasses
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import NoReturn

from .. import _core
from ..arguments.checks import MapWindow, Progress, an, anything, checked, count, flag, positive, refused
from ..arguments.settings import (
    MOST_RAYS,
    Edges,
    Evaluate,
    FaintPower,
    Footprint,
    Method,
    Polarization,
    Replay,
    Sampler,
    Scatterers,
    SignalSettings,
    TraceSettings,
)
from ..base.classes.known_attributes import known_attributes
from ..base.text.counts import counted
from ..scene.lifetimes import scene_in_frame
from ..scene.scene import Scene
from ..signals.parts import as_partition
from ..tracing.edges import looks_for_edges
from .changes import Changes
from .edited_scene import EditedScene
from .kept_signal import KeptSignal
from .remarks import warn_of_scene, warn_of_update
from .view import LiveView
from .watch import Watch

DEFAULT_RAYS = 100_000
_RULES = TraceSettings.RULES | SignalSettings.RULES


@dataclasses.dataclass(frozen=True)
class _Seen:
    """The scene, which is a copy, the radar and the map that a view is made of, by the number of the last change."""

    scene: Scene
    radar: _core.Radar
    window: MapWindow
    zero_pad: int
    number: int


@known_attributes
class Live:
    """A scene whose map follows its changes: `live.scene["car"].position += (0.1, 0, 0)`, then `view = live.update()`.

    It keeps the record, the signal and the map. After a change of an object (place, motion, material, shape; one that comes,
    goes, hides or appears) only those rays are shot again that the change may touch: rays remember through which space their
    queries went. Only the paths that differ are taken from the signal and added to it. Where an object comes or goes, some
    others get another share of the rays. A change of power, array (about the same middle), bandwidth, chirps or window shoots
    no ray that sees the scene as before. Where a change concerns all rays (the radar's place, its start frequency, the half of
    space into which its patterns look, the first transmitter's polarisation, a flagged mirror, a scene that grows beyond the next
    power of two of metres), all are shot again. Either way the view is that of a new Live of the changed scene, to 1e-12 of the
    largest sample. What no path makes is not in it: noise, echoes of rain, other radars, faults of the receiver and what
    `demultiplex` leaves of the codes of transmitters, which `simulate` has.
    scene: is copied; radar: that looks at it, which may be set to another one at any time
    num_rays: 1 to 1e10, shared evenly among objects, their images and the field of view; the shares do not go by errors or by
        what moves as those of `trace` do, because these change with every change of the scene, and are rounded, so that
        the record has about as many rays (LiveView.num_rays)
    max_bounces, seed, start_time (s), polarization, footprint, sampler, edges, faint_power (W): as in `trace`; "auto" edges
        as the scene is at first
    scatterers: "rays" (also for "auto"), or "surface" as in `trace`, so that the speckle of what is moved goes on; most rays
        are then shot again
    tolerance, replay, evaluate, phase_tolerance (rad): as in `synthesize`; method: likewise, where "auto" is "nufft" whatever
        the number of paths
    window, zero_pad: as in `range_doppler`
    parts: {name: selection} as in `decompose`: views have a cube of each part and of "other", which add up to that of the
        scene and follow changes in the same way; every selection must name something in the scene, hidden or not, at each update
    Raises TypeError or ValueError naming the argument.
    """

    @checked(**_RULES | {"self": anything, "num_rays": count(1, MOST_RAYS), "parts": as_partition})
    def __init__(self, scene: _core.Scene, radar: _core.Radar, *, num_rays: int | float = DEFAULT_RAYS,
                 max_bounces: int = TraceSettings.max_bounces, seed: int = TraceSettings.seed,
                 start_time: float = TraceSettings.start_time, polarization: Polarization = TraceSettings.polarization,
                 footprint: Footprint = TraceSettings.footprint, sampler: Sampler = TraceSettings.sampler,
                 scatterers: Scatterers = TraceSettings.scatterers, edges: Edges = TraceSettings.edges,
                 faint_power: FaintPower = TraceSettings.faint_power, tolerance: float = SignalSettings.tolerance,
                 method: Method = SignalSettings.method, replay: Replay = SignalSettings.replay,
                 evaluate: Evaluate = SignalSettings.evaluate, phase_tolerance: float = SignalSettings.phase_tolerance,
                 window: MapWindow = SignalSettings.window, zero_pad: int = SignalSettings.zero_pad,
                 parts: Mapping[str, _core.Selection | str] | None = None):
        self._trace = {"max_bounces": max_bounces, "seed": seed, "start_time": start_time, "polarization": polarization,
                       "footprint": footprint, "sampler": sampler,
                       "scatterers": "rays" if scatterers == "auto" else scatterers,
                       "edges": looks_for_edges(edges, scene, radar, start_time), "faint_power": faint_power}
        self._signal = {"tolerance": tolerance, "method": "nufft" if method == "auto" else method, "replay": replay,
                        "evaluate": evaluate, "phase_tolerance": phase_tolerance}
        self._window, self._zero_pad = window, zero_pad
        self._changes = Changes()
        self._scene, self._radar = EditedScene(scene, self._changes), radar
        self._busy = threading.Lock()  # held while a signal is brought up to date
        self._busy_thread: int | None = None  # which one holds it
        self._selections = parts
        self._full = self._kept(num_rays)
        self._quick: KeptSignal | None = None

    @property
    def scene(self) -> Scene:
        """The scene, to be read and changed: each edit of it is a change by itself, which a Watch shows.

        Edits that belong together, or hang on what they read (`position += ...` beside other threads), are made in `change`
        or `changing`.
        """
        return self._scene

    @property
    def radar(self) -> _core.Radar:
        """The radar that looks at it; set it to change it."""
        return self._radar

    @radar.setter
    def radar(self, radar: _core.Radar) -> None:
        with self.changing():
            self._radar = an(_core.Radar)("radar", radar)

    @property
    def num_rays(self) -> int:
        """Rays that are asked for."""
        return self._full.num_rays

    @property
    def number(self) -> int:
        """How many changes were made: edits of `scene`, settings of `radar`, `set_map`, `change` and `changing`."""
        return self._changes.number

    @contextmanager
    def changing(self) -> Iterator[Scene]:
        """`with live.changing() as scene:` changes the scene as one change, whatever other threads do meanwhile.

        What is raised within the block leaves the edits that were made before it, which are a change.
        """
        with self._changes.one():
            yield self._scene

    @checked(self=anything, function=anything)
    def change(self, function: Callable[[Scene], object]) -> None:
        """Calls a function with the scene as one change, however much it edits; a Watch begins to show it at once.

        function: callable (Scene). Raises TypeError unless it can be called, and what it raises: the edits that it had made by
        then stay, as one change.
        """
        if not callable(function):
            raise refused(TypeError, "function", "callable with a Scene", function)
        with self.changing() as scene:
            function(scene)

    @checked(self=anything, window=_RULES["window"], zero_pad=_RULES["zero_pad"])
    def set_map(self, *, window: MapWindow = SignalSettings.window, zero_pad: int = SignalSettings.zero_pad) -> None:
        """Has the next views use this window and zero_pad, as in `range_doppler`; neither rays nor signals change.

        Raises TypeError or ValueError naming the argument.
        """
        with self.changing():
            self._window, self._zero_pad = window, zero_pad

    @checked(self=anything)
    def update(self, *, progress: Progress = None) -> LiveView:
        """The view of the scene as it is now.

        progress: callable (stage, fraction), True for bars, or None; what it raises ends the update and is raised here
        Raises ValueError as `trace` does, and RuntimeError where a progress callable of this Live asks for it. Nothing is lost
        then: the next update shows what the scene is by then. Warns as `trace` of the scene, and of rays, mirrors and objects
        that are left out where all rays are shot; as `simulate` where nothing is heard; and (RuntimeWarning) of rain, other
        radars and faults of the receiver, which views do not have.
        """
        seen = self._snapshot()
        with self._alone():
            return self._view_of(self._full, seen, is_preview=False, progress=progress)

    @checked(self=anything, num_rays=count(1, MOST_RAYS))
    def preview(self, *, num_rays: int | float, progress: Progress = None) -> LiveView:
        """The view with fewer rays, which are kept beside the others. Raises as `update`, and does not warn.

        num_rays: 1 to 1e10; as long as it stays the same, a preview after a change shoots only what that touches
        progress: as in `update`
        """
        seen = self._snapshot()
        with self._alone():
            if self._quick is None or self._quick.num_rays != num_rays:
                self._quick = self._kept(int(num_rays))
            return self._view_of(self._quick, seen, is_preview=True, progress=progress)

    @checked(self=anything, preview=flag)
    def paths(self, *, preview: bool = False, progress: Progress = None) -> _core.Paths:
        """The record of the last update, Paths as of `trace`: for labels, parts, selections, files.

        preview: of the last `preview` instead, which has fewer rays; progress: as in `update`
        Raises ValueError before the first update or preview.
        """
        with self._alone():
            kept = self._quick if preview else self._full
            if kept is None:
                raise ValueError("preview: no preview was made yet")
            return kept.paths(progress)

    @checked(self=anything, show=anything, budget=positive("s"), failed=anything)
    def watch(self, show: Callable[[LiveView], object], *, budget: float = 0.05,
              failed: Callable[[Exception], object] | None = None) -> Watch:
        """Shows the scene, and each change from now on, from a thread of its own until the Watch is stopped.

        show: callable (LiveView), called in that thread; budget: s, that a preview may take; failed: callable (error), called in
        that thread with what has ended the watch, None: only `wait` and `stop` raise it. Raises TypeError unless show and failed
        can be called.
        """
        if not callable(show):
            raise refused(TypeError, "show", "callable with a LiveView", show)
        if failed is not None and not callable(failed):
            raise refused(TypeError, "failed", "callable with an exception or None", failed)
        return Watch(self, self._changes, show, budget, failed)

    def _kept(self, num_rays: int) -> KeptSignal:
        return KeptSignal(num_rays, self._trace, self._signal, self._selections)

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Waits until no other thread brings a signal up to date. Raises RuntimeError where this thread is at it."""
        if self._busy_thread == threading.get_ident():
            raise RuntimeError("Live: must not be asked for views or paths by what is called while one of its views is made, "
                               "as progress is")
        with self._busy:
            self._busy_thread = threading.get_ident()
            try:
                yield
            finally:
                self._busy_thread = None

    def _snapshot(self) -> _Seen:
        """What is to be seen now. It is taken before `_busy`, which a change that is being made may wait for."""
        with self._changes.still():
            scene = scene_in_frame(Scene(self._scene), self._radar, self._trace["start_time"])
            return _Seen(scene, self._radar, self._window, self._zero_pad, self.number)

    def _view_of(self, kept: KeptSignal, seen: _Seen, *, is_preview: bool, progress) -> LiveView:
        if not is_preview:
            warn_of_scene(seen.scene, seen.radar, self._trace["start_time"])
        done = kept.update(seen.scene, seen.radar, progress)
        if not is_preview:
            warn_of_update(kept, done, seen.radar)
        begin = time.perf_counter()
        spectrum = _core.range_doppler(kept.cube, seen.radar, seen.window, seen.zero_pad)
        stages = {"trace": done.trace, "signal": done.signal, "map": time.perf_counter() - begin}
        return LiveView(seen.number, kept.cube, spectrum, done.num_rays, done.num_rays_shot, done.num_paths_changed, is_preview,
                        stages, kept.parts)

    def __reduce__(self) -> NoReturn:
        raise TypeError("Live: holds locks of its threads and cannot be pickled or copied; pickle or copy its scene and radar, "
                        "and make a Live of them")

    def __repr__(self) -> str:
        return f"Live({counted(len(self._scene), 'object')}, {counted(self.num_rays, 'ray')}, change {self.number})"
