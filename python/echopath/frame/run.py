"""From the record of a frame to the frame: take the signal apart, add noise, transform, label, detect."""
from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from .. import _core
from ..arguments.checks import refused
from ..arguments.part_names import REST, require_names
from ..arguments.settings import LabelSettings, SignalSettings, TraceSettings
from ..base.process.stages import StageClock
from ..detections.checks import RULES as DETECTION_RULES, checked_keywords
from ..guard import check_planes, check_rays, check_signal, warn_of
from ..labels.annotate import label_frame, owners_of_cubes
from ..labels.family_pass import FamilyPass
from ..labels.request import Labelling, as_label_settings, labelling_of, make_request
from ..paths.families import check_objects
from ..paths.resolution import FamilyPowers
from ..paths.subset import part_of_path
from ..receiver.chain import transmitted_code
from ..receiver.channels import require_channels, require_drift
from ..scene.lifetimes import scene_in_frame
from ..signals.beside import cubes_beside
from ..signals.interference_of_frame import has_interference, interference_cube, require_interferers
from ..signals.part_pass import takes_a_pass
from ..signals.parts import ONLY_PARTITION, as_partitions, check_partitions, decompose
from ..signals.rain_echoes import has_rain_echoes, rain_cube
from ..signals.silence import warn_of_silence
from ..spectra.azimuth_map import checked_settings, sees_azimuth
from ..tracing.traces import keep_geometry
from ..transmit import coded_cube, is_coded, synthesize_slots
from ..transmit.signals import has_steps
from ..truth import truth_of_frame
from ..truth.asked import truth_keywords
from .detections import detect_frame
from .frame import Frame, with_spectra
from .memory import require_memory

# Keywords of `simulate` that may be dicts, and their keys, which are taken for its own.
WITHIN = {"labels": LabelSettings.RULES, "detections": DETECTION_RULES, "truth": ("objects",)}
_FAMILIES = object()  # a view that has the name of no partition


class Recorded(NamedTuple):
    """The record of a frame, and the clock of its stages."""

    paths: _core.Paths
    clock: StageClock


class FrameRun:
    """How frames of a radar in a scene are made of their records, checked before the long work.

    scene, radar: of the frames; trace, signal: TraceSettings and SignalSettings; parts, angles, labels, detections, truth,
    guard: as in `simulate`. Raises TypeError or ValueError naming the argument.
    """

    def __init__(self, scene, radar, trace: TraceSettings, signal: SignalSettings, parts, angles, labels, detections,
                 truth, guard: bool):
        self.scene, self.radar, self.trace, self.signal, self.guard = scene, radar, trace, signal, guard
        check_receiver(radar, trace.start_time, trace.start_time + radar.frame_duration)
        require_memory(radar, signal.zero_pad, signal.noise_seed is not None)
        if signal.retrace != "never" and signal.keyframes > radar.waveform.num_chirps:
            raise refused(ValueError, "keyframes", f"at most the {radar.waveform.num_chirps} chirps of the frame",
                          signal.keyframes)
        self.partitions, self.angle_settings = as_partitions(parts), checked_settings(radar, angles, zero_pad=signal.zero_pad)
        check_partitions(self.partitions, scene)
        require_names(self.partitions)
        has_rain_echoes(scene, trace.effects)  # raises
        require_interferers(scene, radar, trace.effects, trace.start_time, trace.start_time + radar.frame_duration)
        self.map_settings = {"window": signal.window, "zero_pad": signal.zero_pad}
        self._advised: set[str] = set()   # names of checks, and
        self._silences: set[str] = set()  # reasons why nothing is heard, that were told of a frame
        self.label_settings = as_label_settings(labels)
        self._request = _label_request(scene, radar, self.label_settings, trace.batches or 1, self.map_settings,
                                       self.angle_settings)
        self.detect_keywords = _detect_keywords(scene, radar, detections, self._request, self.map_settings)
        self.truth_keywords = truth_keywords(scene, truth, self._request.objects if self._request else None)

    def frame_of(self, record: Callable[[], _core.Paths], progress=None) -> Frame:
        """The frame of what `record()` returns, Paths of the scene and the radar; progress: as in `simulate`."""
        return self.frame_of_record(self.recorded(record), progress)

    def recorded(self, record: Callable[[], _core.Paths]) -> Recorded:
        """What `record()` returns, and how long it took."""
        clock = StageClock()
        with clock("trace"):
            if self._request or self.truth_keywords:
                keep_geometry(self.scene)
            return Recorded(record(), clock)

    def frame_of_record(self, recorded: Recorded, progress=None) -> Frame:
        """The rest of the work on a frame; progress: as in `simulate`."""
        paths, clock = recorded
        with clock("synthesis"):
            settings = self.signal.of_replay() | {"progress": progress}
            probe = _core.SignalProbe(seed=self.trace.seed) if self.guard and not has_steps(self.radar) else None
            work = labelling_of(self._request, paths, self.partitions, settings) if self._request else None
            cubes, whole, owners = self._cubes(paths, work, settings, probe)
        warn_of_silence(paths, self.radar, whole, self._silences)
        with clock("parts of paths"):
            groups = {partition: part_of_path(paths, group) for partition, group in self.partitions.items()}
        frame = self._bare_frame(paths, whole, cubes, groups, probe, clock.stages)
        if work is not None and work.request.objects is None:
            frame._keep_powers(FamilyPowers(work.families, work.mean.of_families))
        frame.rain_cube = self._rain_cube(paths, clock)
        frame.interference_cube = self._interference_cube(paths, clock, progress)
        if is_coded(self.radar):
            with clock("code of the transmitters"):
                frame.coded_cube = coded_cube(paths, self.radar, whole, code=transmitted_code(self.radar),
                                              **self.signal.of_replay())
        with clock("spectra"):
            with_spectra(frame)
        if sees_azimuth(self.radar, self.angle_settings):
            with clock("angles"):
                frame.range_azimuth = frame.range_azimuth_of(frame.spectrum, progress)
        if self._request:
            with clock("labels of cells"):
                parts_of = cubes or {ONLY_PARTITION: {REST: whole}}
                frame.labels = label_frame(work, owners, parts_of, cubes_beside(frame))
        if self.detect_keywords is not None:
            with clock("detections"):
                frame.detections = detect_frame(frame, progress=progress, **self.detect_keywords)
        if self.truth_keywords is not None:
            with clock("truth"):
                frame.kept_truth = truth_of_frame(frame, **self.truth_keywords)
        return frame

    def warn_of(self, frame: Frame) -> None:
        """Warns of the checks of a frame of this run that do not agree; gives the advice of each once."""
        warn_of(frame.checks, self._advised)

    def _cubes(self, paths, work: Labelling | None, settings: dict, probe):
        """{partition: {part: cube}}, the whole, and what finds the owners of cells, as `label_frame` takes it.

        work: None: no labels, and no owners
        """
        if not self.partitions and work is None:
            return {}, synthesize_slots(paths, self.radar, **settings, probe=probe), None
        if work is None or not takes_a_pass(self.radar, settings):
            return self._decomposed(paths, work, settings | {"probe": probe})
        if not self.partitions:
            signals = FamilyPass(work, adds_up=True, probe=probe)
            return {}, signals.whole(), signals.assign_cells
        cubes, whole, _ = self._decomposed(paths, None, settings | {"probe": probe})
        return cubes, whole, FamilyPass(work, adds_up=False).assign_cells

    def _decomposed(self, paths, work: Labelling | None, settings: dict):
        """`_cubes` with the cubes of all parts, and of all families where there are any, from one pass."""
        views = self.partitions if work is None else {**self.partitions, _FAMILIES: work.families}
        cubes = decompose(paths, self.radar, views, **settings)
        whole = sum(next(iter(cubes.values())).values())
        owners = None if work is None else owners_of_cubes(work.request, cubes[_FAMILIES])
        return {partition: cubes[partition] for partition in self.partitions}, whole, owners

    def _bare_frame(self, paths, whole, cubes: dict, groups: dict, probe, stages: list) -> Frame:
        """A frame without maps and what is made of them."""
        signal = self.signal
        return Frame(scene=self._scene_of(paths), radar=self.radar, paths=paths, cube=whole, parts=cubes,
                     selections=self.selections, part_of_path=groups, noise_seed=signal.noise_seed,
                     spectrum_settings=dict(self.map_settings),
                     angle_settings=dict(self.angle_settings), replay=signal.replay, evaluate=signal.evaluate,
                     retrace=signal.retrace, keyframes=signal.keyframes,
                     effect_choices=self.trace.effects,
                     checks=_checks(whole, probe, signal, paths) if probe else [], stages=stages)

    def _rain_cube(self, paths, clock):
        """The signal of the rain of the scene, None where it has none."""
        if not has_rain_echoes(self.scene, self.trace.effects):
            return None
        with clock("rain"):
            return rain_cube(self._scene_of(paths), self.radar, start_time=paths.frame.start_time, seed=self.trace.seed,
                             effects=self.trace.effects, polarization=paths.frame.polarization)

    def _interference_cube(self, paths, clock, progress):
        """The signal of the other radars of the scene, None where it has none."""
        if not has_interference(self.scene, self.trace.effects):
            return None
        with clock("interference"):
            timed = self.trace.replace(start_time=paths.frame.start_time, scatterers=paths.frame.scatterers)
            return interference_cube(self._scene_of(paths), self.radar, timed, self.signal.replay, progress)

    def _scene_of(self, paths):
        """The scene of the frame of a record."""
        return scene_in_frame(self.scene, self.radar, paths.frame.start_time)

    @property
    def selections(self) -> dict:
        """{partition: {part: selection as text}}"""
        return {partition: {name: str(selection) for name, selection in group.items()}
                for partition, group in self.partitions.items()}


def check_receiver(radar, begin: float, end: float) -> None:
    """Raises ValueError, before the long work, for what no frame of a radar can have. begin, end: s, of all frames"""
    require_channels(radar.receiver, radar)
    require_drift(radar.receiver, begin, end)


def _checks(cube, probe, signals: SignalSettings, paths) -> list:
    found = check_signal(cube, probe, tolerance=signals.tolerance, phase_tolerance=signals.phase_tolerance)
    return found + check_rays(probe, paths.frame) + check_planes(paths, signals.window)


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
