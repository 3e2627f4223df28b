"""One call from a scene to a frame: trace, take the signal apart, add noise, transform."""
from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from . import _core
from .angles import range_azimuth
from .azimuth_map import checked_settings, sees_azimuth
from .checks import Progress, Window, anything, checked, flag, refused
from .detections.checks import checked_keywords
from .detections.of_frame import detect_frame
from .effects import of_paths
from .families import check_objects
from .families import families as find_families
from .guard import check_rays, check_signal, warn_of
from .labels.annotate import as_label_settings, label_frame, make_request
from .parts import ONLY_PARTITION, as_partitions, check_partitions, decompose
from .path_subset import part_of_path
from .resolution import mean_powers, unresolved_of
from .settings import (
    Evaluate, Footprint, LabelSettings, Method, Polarization, Replay, Retrace, Sampler, SignalSettings, TraceSettings,
)
from .signals import synthesize
from .stages import Stage, StageClock
from .tracing import trace as trace_scene

_FAMILIES, _WHOLE = object(), object()  # views that have the name of no partition


@dataclasses.dataclass(eq=False)
class Frame:
    """One simulated frame.

    scene, radar: what was simulated; paths: what every ray touched
    cube: complex [tx, rx, chirp, sample], sqrt(W), without noise; the sum of the parts of each partition
    parts: {partition: {part: cube}}, without noise, part "other" included; {} when none was asked for
    selections: {partition: {part: expression as text}}, without "other"
    part_of_path: {partition: u16 [P]}, index of the part of each path in the order of `parts`
    noise_seed: of the thermal noise, which is drawn from it and the start time of the frame (s); None: no noise
    replay, evaluate, retrace, keyframes: how the signal follows moving echoes, as in `synthesize`
    spectrum_settings: window and zero_pad of the maps; angle_settings: keywords of `range_azimuth` for its map
    spectrum: range-Doppler map of the cube with noise; part_spectra: {partition: {part: map}} without noise
    labels: {partition: Labels} of the cells of its map, of "parts" with the part "other" without partitions; {} when
        not asked for
    detections: Detections in its map, None when not asked for
    checks: list [C] of Check, what the guard of the run compared; [] when it was off
    stages: time and peak memory of each stage
    """

    scene: object
    radar: object
    paths: object
    cube: object
    parts: dict
    selections: dict
    part_of_path: dict
    noise_seed: int | None
    spectrum_settings: dict
    spectrum: object = None
    part_spectra: dict = dataclasses.field(default_factory=dict)
    angle_settings: dict = dataclasses.field(default_factory=dict)
    replay: str = "material"
    evaluate: str = "interpolated"
    retrace: str = "never"
    keyframes: int = 0
    labels: dict = dataclasses.field(default_factory=dict)
    detections: object = None
    checks: list = dataclasses.field(default_factory=list)
    stages: list[Stage] = dataclasses.field(default_factory=list)

    @property
    def noisy_cube(self):
        """The cube with thermal noise, complex [tx, rx, chirp, sample], sqrt(W): the same bits at every call.

        The noise is drawn from the noise seed and the start time of the frame (s): frames in a row differ.
        """
        if self.noise_seed is None:
            return self.cube
        return _core.add_noise(self.cube, self.radar, seed=self.noise_seed, start_time=self.paths.frame.start_time)

    def plot(self, *, ax=None, vmin=None, vmax=None, title="Received power, noise included"):
        """Draws the range-Doppler map with its noise, and the detections in it, where there are some, as points.

        ax: Matplotlib axes to draw in, None: new ones; vmin, vmax: ends of the colour scale in dBm; title: above the map
        Returns the axes: range in m across, radial velocity in m/s up (receding positive). Raises ValueError for a record of
        paths alone.
        """
        from .plots import draw_frame

        return draw_frame(self, ax=ax, vmin=vmin, vmax=vmax, title=title)

    def _repr_html_(self) -> str:
        from .notebook import frame_html

        return frame_html(self)

    @property
    def effects(self) -> list:
        """Which effects the frame models, which not, and why: list [E] of Effect, those of the paths and of the signal."""
        return of_paths(self.paths, replay=self.replay, evaluate=self.evaluate, retrace=self.retrace,
                        noise_seed=self.noise_seed)

    @cached_property
    def path_power(self):
        """Power of each path at the trace time for the first antennas, [P] in W."""
        return self.paths.power

    @cached_property
    def range_azimuth(self):
        """Range-azimuth map of the cube with noise, power [azimuth, range] in W; None where the radar sees no azimuth."""
        return self.range_azimuth_of(self.spectrum) if sees_azimuth(self.radar) else None

    def range_azimuth_of(self, spectrum, progress=None):
        """Range-azimuth map of a part by the settings of the frame, power [azimuth, range] in W.

        spectrum: RangeDoppler of the frame's radar; progress: callable (stage, fraction), True for bars, or None
        """
        return range_azimuth(spectrum, self.radar, **self.angle_settings, progress=progress)

    @cached_property
    def mean_power(self):
        """ep.ReceivedPower of all paths, in W: the mean over the random phases, with its interval."""
        return self._mean_powers.of_parts[_WHOLE][0]

    @cached_property
    def mean_part_powers(self) -> dict:
        """The same of each part, {partition: {part: ep.ReceivedPower}}, in W."""
        return {partition: dict(zip(self.parts[partition], self._mean_powers.of_parts[partition]))
                for partition in self.part_of_path}

    @cached_property
    def unresolved(self) -> list:
        """Objects, ghosts and surroundings above the noise whose mean power the rays do not know to 0.3 dB: list of
        Unresolved, as `ep.unresolved` gives them, with the noise of the radar."""
        return unresolved_of(self.paths, self._families, self._mean_powers.of_families,
                             least_power=_core.noise_power_in_cell(self.radar))

    @cached_property
    def _families(self):
        return find_families(self.paths)

    @cached_property
    def _mean_powers(self):
        """MeanPowers of the families, of each partition and, as the one part of _WHOLE, of all paths."""
        groups = {partition: (part_of_path, len(self.parts[partition]))
                  for partition, part_of_path in self.part_of_path.items()}
        groups[_WHOLE] = np.zeros(self.paths.num_paths, np.uint32), 1
        return mean_powers(self.paths, self._families, groups)

    def __repr__(self) -> str:
        partitions = ", ".join(self.parts) or "none"
        return f"Frame(paths={self.paths.num_paths}, cube={list(self.cube.shape)}, partitions: {partitions})"


@checked({"trace": TraceSettings, "signal": SignalSettings}, **TraceSettings.RULES, **SignalSettings.RULES, parts=anything,
         angles=anything, labels=anything, detections=anything, guard=flag)
def simulate(scene: _core.Scene, radar: _core.Radar, *, num_rays: int | float | None = TraceSettings.num_rays,
             max_bounces: int = TraceSettings.max_bounces, seed: int = TraceSettings.seed,
             start_time: float = TraceSettings.start_time, polarization: Polarization = TraceSettings.polarization,
             footprint: Footprint = TraceSettings.footprint, sampler: Sampler = TraceSettings.sampler,
             batches: int | None = TraceSettings.batches, target_error_db: float | None = TraceSettings.target_error_db,
             max_rays: int | float = TraceSettings.max_rays, parts: Mapping[str, Any] | None = None,
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
        max_rays: as in `trace`
    parts: {name: selection} for one partition (called "parts"), {partition: {name: selection}} for several, or None
    tolerance, method, replay, evaluate, phase_tolerance (rad), retrace, keyframes: as in `synthesize`; window, zero_pad: as
        in `range_doppler`
    noise_seed: of the thermal noise, which only the whole gets; None: no noise. Noise is drawn from it and start_time: frames
        in a row have noise of their own, and each the same whether it is simulated alone or not
    angles: keywords of `range_azimuth` for the map of a radar with an array, None: {"combine": "peak"}
    labels: True, LabelSettings or a dict of their keywords (plane, objects, noise, noise_margin_db in dB, dynamic_range_db in
        dB, errors): the frame carries the labels of its map, from the same pass, with the cubes of all families in memory;
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
                            target_error_db=target_error_db, max_rays=max_rays)
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
        cubes, whole, family_cubes = _cubes(paths, radar, partitions, families, settings | {"probe": probe})
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
            frame.labels = label_frame(request, paths, families, parts_of, family_cubes, partitions, settings)
    if detect_keywords is not None:
        with clock("detections"):
            frame.detections = detect_frame(frame, progress=progress, **detect_keywords)
    return frame


def with_spectra(frame: Frame) -> Frame:
    """Fills in the range-Doppler maps of a frame: with noise of the whole, without noise of its parts."""
    def spectrum(cube):
        return _core.range_doppler(cube, frame.radar, **frame.spectrum_settings)

    frame.spectrum = spectrum(frame.noisy_cube)
    frame.part_spectra = {partition: {name: spectrum(cube) for name, cube in cubes.items()}
                          for partition, cubes in frame.parts.items()}
    return frame


def _cubes(paths, radar, partitions: dict, families, settings: dict):
    """{partition: {part: cube}}, the whole, and {Family: cube} ({} without families), from one pass."""
    if not partitions and families is None:
        return {}, synthesize(paths, radar, **settings), {}
    views = partitions if families is None else {**partitions, _FAMILIES: families}
    cubes = decompose(paths, radar, views, **settings)
    whole = sum(next(iter(cubes.values())).values())
    return {partition: cubes[partition] for partition in partitions}, whole, cubes.get(_FAMILIES, {})


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
