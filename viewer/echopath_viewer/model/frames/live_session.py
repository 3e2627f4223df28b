"""Sessions of a scene that is changed while it is watched."""
from __future__ import annotations

import echopath as ep

from ..maps.layers import NAMES
from ..maps.part_set import PartSet
from ..maps.signals import Signals
from ..view_state import apply_state
from .carried import make_ready, session_like
from .inputs import ViewInput, whole_part

DEFAULT_RAYS, TITLE = 50_000, "live"
# of the record that a live scene goes on from; rays are shot anew, in one batch
AS_TRACED = ("max_bounces", "start_time", "seed", "faint_power", "polarization", "footprint", "sampler", "scatterers", "edges")


def live_of(session, num_rays: int = DEFAULT_RAYS):
    """ep.Live of scene, weather, radar and start of the frame of a session; signals are made as its own, and maps have its
    window and zero_pad."""
    frame = session.paths.frame
    as_traced = {name: getattr(frame, name) for name in AS_TRACED}
    scene = ep.Scene(session.scene, weather=session.weather)
    signals = session.signals
    return ep.Live(scene, session.radar, num_rays=num_rays, evaluate=signals.evaluate, replay=signals.replay, **as_traced,
                   **signals.spectrum_settings)


def session_of_view(live, view, state, spectrum_settings: dict):
    """A session of the latest ep.LiveView, preview or full, ready to be drawn, which shows what another one did.

    state: as of `state_of`, or None
    """
    shown = input_of_view(live, view, spectrum_settings)
    return make_ready(session_like(None if state is None else _without_parts(state), shown), view.is_preview)


def show_state(session, state: dict, made_for: dict) -> None:
    """Has a session of `session_of_view` show what was chosen since it was made.

    state: as of `state_of`; made_for: the one then
    """
    kept = {"frame": session.title, "ray": None}  # whose rays are others
    if _without_parts(state) | kept != _without_parts(made_for) | kept:
        apply_state(session, _without_parts(state) | kept)


def input_of_view(live, view, spectrum_settings: dict | None = None) -> ViewInput:
    """What the latest view of a live scene shows; spectrum_settings: window and zero_pad of its map, None: as the map tells."""
    settings = {"window": view.map.window, "zero_pad": view.map.zero_pad} if spectrum_settings is None else spectrum_settings
    paths = live.paths(preview=view.is_preview)
    signals = Signals(paths, settings, **{name: live._signal[name] for name in ("evaluate", "replay")})
    return ViewInput(paths, PartSet(whole_part(view.map)), signals, view.cube, TITLE, weather=live.scene.weather)


def _without_parts(state: dict) -> dict:
    """Parts take synthesis and layers but for names their own time, which would slow down what is dragged."""
    whole, layers = ["whole", "whole"], [layer for layer in state["layers"] if layer == NAMES]
    return state | {"part": whole, "partition": None, "own_parts": {}, "node": None, "node_base": whole, "layers": layers}
