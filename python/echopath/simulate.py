"""One call from a scene to a frame: trace, take the signal apart, add noise, transform."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import _core
from .azimuth_map import checked_settings, sees_azimuth
from .checks import Progress, Window, anything, checked, flag, refused
from .detections.checks import checked_keywords
from .detections.of_frame import detect_frame
from .families import check_objects
from .families import families as find_families
from .frame import Frame, with_spectra
from .guard import check_rays, check_signal, warn_of
from .labels.annotate import as_label_settings, label_frame, make_request, owners_of_cubes
from .labels.family_pass import FamilyPass
from .parts import ONLY_PARTITION, as_partitions, check_partitions, decompose
from .path_subset import part_of_path
from .settings import (
    Evaluate, Footprint, LabelSettings, Method, Polarization, Replay, Retrace, Sampler, Scatterers, SignalSettings,
    TraceSettings,
)
from .signals import synthesize
from .stages import StageClock
from .tracing import trace as trace_scene

_FAMILIES = object()  # a view that has the name of no partition


@checked({"trace": TraceSettings, "signal": SignalSettings}, **TraceSettings.RULES, **SignalSettings.RULES, parts=anything,
         angles=anything, labels=anything, detections=anything, guard=flag)
def simulate(scene: _core.Scene, radar: _core.Radar, *, num_rays: int | float | None = TraceSettings.num_rays,
             max_bounces: int = TraceSettings.max_bounces, seed: int = TraceSettings.seed,
             start_time: float = TraceSettings.start_time, polarization: Polarization = TraceSettings.polarization,
             footprint: Footprint = TraceSettings.footprint, sampler: Sampler = TraceSettings.sampler,
             batches: int | None = TraceSettings.batches, target_error_db: float | None = TraceSettings.target_error_db,
             max_rays: int | float = TraceSettings.max_rays, scatterers: Scatterers = TraceSettings.scatterers,
             parts: Mapping[str, Any] | None = None,
             tolerance: float = SignalSettings.tolerance, method: Method = SignalSettings.method,
             replay: Replay = SignalSettings.replay, evaluate: Evaluate = SignalSettings.evaluate,
             phase_tolerance: float = SignalSettings.phase_tolerance, retrace: Retrace = SignalSettings.retrace,
             keyframes: int = SignalSettings.keyframes, noise_seed: int | None = SignalSettings.noise_seed,
             window: Window = SignalSettings.window, zero_pad: int = SignalSettings.zero_pad,
             angles: Mapping[str, Any] | None = None, labels: bool | LabelSettings | Mapping[str, Any] | None = None,
             detections: bool | Mapping[str, Any] | None = None, guard: bool = True, trace: TraceSettings | None = None,
             signal: SignalSettings | None = None, progress: Progress = None) -> Frame:
    """Simulates one frame of a radar in a scene.

    scene: what is traced; radar: that looks at it
    num_rays, max_bounces, seed, start_time (s), polarization, footprint, sampler, batches, target_error_db (dB),
        max_rays, scatterers: as in `trace`
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
    guard: whether the signal is held against slower ways at a few places, and halves and batches of the rays against each
        other: see `Frame.checks`
    trace, signal: TraceSettings and SignalSettings that give the keywords which the call leaves out, or None
    progress: callable (stage, fraction), True for bars, or None
    Returns a Frame. Raises TypeError or ValueError naming the argument, KeyboardInterrupt on Ctrl-C. Warns (GuardWarning)
    where a check disagrees by more than is promised.
    """
    tracing = TraceSettings(num_rays=num_rays, max_bounces=max_bounces, seed=seed, start_time=start_time,
                            polarization=polarization, footprint=footprint, sampler=sampler, batches=batches,
                            target_error_db=target_error_db, max_rays=max_rays, scatterers=scatterers)
    signals = SignalSettings(tolerance=tolerance, method=method, replay=replay, evaluate=evaluate,
                             phase_tolerance=phase_tolerance, retrace=retrace, keyframes=keyframes, noise_seed=noise_seed,
                             window=window, zero_pad=zero_pad)
    return _simulated(scene, radar, tracing, signals, parts, angles, labels, detections, guard, progress)


def _simulated(scene, radar, tracing: TraceSettings, signals: SignalSettings, parts, angles, labels, detections, guard,
               progress) -> Frame:
    partitions, angle_settings = as_partitions(parts), checked_settings(radar, angles)
    check_partitions(partitions, scene)
    of_map = {"window": signals.window, "zero_pad": signals.zero_pad}
    request = _label_request(scene, radar, as_label_settings(labels), tracing.batches or 1, of_map, angle_settings)
    detect_keywords = _detect_keywords(scene, radar, detections, request, of_map)
    clock = StageClock()
    with clock("trace"):
        paths = trace_scene(scene, radar, settings=tracing, progress=progress)
    with clock("synthesis"):
        settings = signals.of_replay() | {"progress": progress}
        probe = _core.SignalProbe(seed=tracing.seed) if guard else None
        families = find_families(paths, request.objects) if request else None
        cubes, whole, owners = _cubes(paths, radar, partitions, families, request, settings, probe)
    with clock("parts of paths"):
        group_of_path = {partition: part_of_path(paths, group) for partition, group in partitions.items()}
    frame = Frame(scene=scene, radar=radar, paths=paths, cube=whole, parts=cubes, selections=_as_text(partitions),
                  part_of_path=group_of_path, noise_seed=signals.noise_seed, spectrum_settings=of_map,
                  angle_settings=angle_settings, replay=signals.replay, evaluate=signals.evaluate, retrace=signals.retrace,
                  keyframes=signals.keyframes, checks=_checks(whole, probe, signals, paths.frame) if guard else [],
                  stages=clock.stages)
    warn_of(frame.checks, stacklevel=4)  # past _simulated, simulate and what checks its arguments
    with clock("spectra"):
        with_spectra(frame)
    if sees_azimuth(radar):
        with clock("angles"):
            frame.range_azimuth = frame.range_azimuth_of(frame.spectrum, progress)
    if request:
        with clock("labels of cells"):
            parts_of = cubes or {ONLY_PARTITION: {"other": whole}}
            frame.labels = label_frame(request, paths, families, parts_of, owners, partitions, settings)
    if detect_keywords is not None:
        with clock("detections"):
            frame.detections = detect_frame(frame, progress=progress, **detect_keywords)
    return frame


def _cubes(paths, radar, partitions: dict, families, request, settings: dict, probe):
    """{partition: {part: cube}}, the whole, and what finds the owners of cells, as `label_frame` takes it.

    families, request: None: no labels, and no owners
    """
    if not partitions and families is None:
        return {}, synthesize(paths, radar, **settings, probe=probe), None
    if families is None or settings["retrace"] != "never":
        return _decomposed(paths, radar, partitions, families, request, settings | {"probe": probe})
    if not partitions:
        signals = FamilyPass(paths, radar, families, request, settings, adds_up=True, probe=probe)
        return {}, signals.whole(), signals.settle
    cubes, whole, _ = _decomposed(paths, radar, partitions, None, None, settings | {"probe": probe})
    return cubes, whole, FamilyPass(paths, radar, families, request, settings, adds_up=False).settle


def _decomposed(paths, radar, partitions: dict, families, request, settings: dict):
    """`_cubes` with the cubes of all parts, and of all families where there are any, from one pass."""
    views = partitions if families is None else {**partitions, _FAMILIES: families}
    cubes = decompose(paths, radar, views, **settings)
    whole = sum(next(iter(cubes.values())).values())
    owners = None if families is None else owners_of_cubes(request, cubes[_FAMILIES])
    return {partition: cubes[partition] for partition in partitions}, whole, owners


def _checks(cube, probe, signals: SignalSettings, trace_frame) -> list:
    found = check_signal(cube, probe, tolerance=signals.tolerance, phase_tolerance=signals.phase_tolerance)
    return found + check_rays(probe, trace_frame)


def _label_request(scene, radar, settings: LabelSettings | None, num_batches: int, of_map: dict, angles: dict):
    """How to label, checked; None: not at all."""
    if settings is None:
        return None
    check_objects(scene, settings.objects)
    return make_request(radar, num_batches, settings, **of_map, angles=angles if settings.plane == "range_azimuth" else None)


def _detect_keywords(scene, radar, detections, request, of_map: dict):
    """Keywords of `detect_frame`, checked before the long work; None: no detections."""
    if detections is None or detections is False:
        return None
    if not (detections is True or isinstance(detections, Mapping)):
        raise refused(TypeError, "detections", "True, False or a dict of keywords of detect_frame", detections)
    keywords = {} if detections is True else dict(detections)
    return checked_keywords(scene, radar, of_map, ({"objects": request.objects} if request else {}) | keywords)


def _as_text(partitions: dict) -> dict:
    return {partition: {name: str(selection) for name, selection in group.items()}
            for partition, group in partitions.items()}
