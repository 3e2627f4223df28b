"""One call from a scene to a frame: trace, take the signal apart, add noise, transform."""
from __future__ import annotations

from collections.abc import Mapping

from .. import _core
from ..arguments.checks import MapWindow, Progress, anything, checked, flag
from ..arguments.effects import Choices
from ..arguments.settings import (
    Edges,
    Evaluate,
    FaintPower,
    Footprint,
    LabelSettings,
    Method,
    Polarization,
    Replay,
    Retrace,
    Sampler,
    Scatterers,
    SignalSettings,
    TraceSettings,
    settings_among,
)
from ..signals.interference_of_frame import warn_of_absent_interferers
from ..signals.parts import Selections
from ..tracing.traces import trace as trace_scene
from .frame import Frame
from .run import WITHIN, FrameRun


@checked({"trace": TraceSettings, "signal": SignalSettings}, WITHIN, **TraceSettings.RULES, **SignalSettings.RULES,
         parts=anything, angles=anything, labels=anything, detections=anything, truth=anything, guard=flag)
def simulate(scene: _core.Scene, radar: _core.Radar, *, num_rays: int | float | None = TraceSettings.num_rays,
             max_bounces: int = TraceSettings.max_bounces, seed: int = TraceSettings.seed,
             start_time: float = TraceSettings.start_time, polarization: Polarization = TraceSettings.polarization,
             footprint: Footprint = TraceSettings.footprint, sampler: Sampler = TraceSettings.sampler,
             batches: int | None = TraceSettings.batches, target_error_db: float | None = TraceSettings.target_error_db,
             max_rays: int | float = TraceSettings.max_rays, scatterers: Scatterers = TraceSettings.scatterers,
             edges: Edges = TraceSettings.edges, faint_power: FaintPower = TraceSettings.faint_power,
             effects: Choices = TraceSettings.effects,
             parts: Selections | None = None,
             tolerance: float = SignalSettings.tolerance, method: Method = SignalSettings.method,
             replay: Replay = SignalSettings.replay, evaluate: Evaluate = SignalSettings.evaluate,
             phase_tolerance: float = SignalSettings.phase_tolerance, retrace: Retrace = SignalSettings.retrace,
             keyframes: int = SignalSettings.keyframes, noise_seed: int | None = SignalSettings.noise_seed,
             window: MapWindow = SignalSettings.window, zero_pad: int = SignalSettings.zero_pad,
             angles: Mapping[str, object] | None = None, labels: bool | LabelSettings | Mapping[str, object] | None = None,
             detections: bool | Mapping[str, object] | None = None, truth: bool | Mapping[str, object] | None = None,
             guard: bool = True, trace: TraceSettings | None = None, signal: SignalSettings | None = None,
             progress: Progress = None) -> Frame:
    """Simulates one frame of a radar in a scene.

    scene: what is traced; radar: that looks at it
    num_rays, max_bounces, seed, start_time (s), polarization, footprint, sampler, batches, target_error_db (dB),
        max_rays, scatterers, edges, faint_power (W), effects: as in `trace`; the map also has the echoes of the rain in
        `Scene.weather`
    parts: {name: selection} for one partition (called "parts"), {partition: {name: selection}} for several, or None
    tolerance, method, replay, evaluate, phase_tolerance (rad), retrace, keyframes: as in `synthesize`; window, zero_pad: as
        in `range_doppler`
    noise_seed: of the thermal noise, which only the whole gets; None: no noise. Noise is drawn from it and start_time: frames
        in a row have noise of their own, and each the same whether it is simulated alone or not
    angles: keywords of `range_azimuth` for the map of a radar with an array, None: {"combine": "peak"}
    labels: True, LabelSettings or a dict of their keywords (plane, objects, noise, noise_margin_db in dB, dynamic_range_db in
        dB, errors): the frame carries the labels of its map, from the same pass;
        {}: as True; None or False: none, and nothing is spent on them
    detections: True, or keywords of `detect_frame`: the frame carries the detections in its map, of the objects of its
        labels unless told otherwise; {}: as True; None or False: none
    truth: True, or keywords of `truth` (objects): the frame and its files carry the Truth of its objects, those of its labels
        unless told otherwise; {}: as True; None or False: not made here, and `Frame.truth` makes it when it is asked for
    guard: whether the signal is held against slower ways at a few places, halves and batches of the rays against each other,
        and single rays that stand for the image of a surface in an unflagged plane against the noise: see `Frame.checks`
    trace, signal: TraceSettings and SignalSettings that give the keywords which the call leaves out, or None
    progress: callable (stage, fraction), True for bars, or None
    Returns a Frame. Raises TypeError or ValueError naming the argument, KeyboardInterrupt on Ctrl-C. Warns (GuardWarning)
    where a check disagrees by more than is promised.
    """
    tracing, signals = settings_among(TraceSettings, locals()), settings_among(SignalSettings, locals())
    run = FrameRun(scene, radar, tracing, signals, parts, angles, labels, detections, truth, guard)
    warn_of_absent_interferers(scene, radar, tracing.effects, tracing.start_time, tracing.start_time + radar.frame_duration)
    frame = run.frame_of(lambda: trace_scene(scene, radar, settings=tracing, progress=progress), progress)
    run.warn_of(frame)
    return frame
