"""Frames in time, simulated when they are asked for."""
from __future__ import annotations

import functools
import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from ..arguments.checks import (
    ArrayLike,
    MapWindow,
    Progress,
    anything,
    array,
    checked,
    count,
    flag,
    one_of,
    optional,
    path as path_rule,
    real,
    refused,
)
from ..arguments.effects import Choices
from ..arguments.frame_times import require_motion
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
from ..base.process.progress import automatic_bars
from ..base.process.work_at_hand import at_work_on
from ..base.text.counts import counted
from ..frame.frame import Frame
from ..frame.run import WITHIN, FrameRun, Recorded, check_receiver
from ..scene.lifetimes import warn_of_absence, warn_of_the_unseen
from ..scene.scene import Scene
from ..signals.interference_of_frame import require_interferers, warn_of_absent_interferers
from ..signals.parts import Selections
from ..tracing.traces import keep_geometry
from ..weather.weather import weather_of
from .ahead import one_ahead
from .contents import TIMES, Contents
from .ends import warn_of_ends
from .folder import NAME
from .keep import Keep
from .one_file import store_of
from .record import record_of
from .row import Row
from .saving import SavedFrame, Shard, places_of, saved_frames, shard_rule
from .starts import LONGEST, Starts, starts_and_count
from .stored import StoredSequence
from .unused_memory import MemoryOfFrames, give_back_memory


class Sequence(Row[Frame]):
    """Frames of a radar in a scene, one after the other: `for frame in sequence`, `sequence[k]`, `len(sequence)`.

    A frame is simulated when it is asked for, and kept by nobody. Frame k starts at start_time + k interval, or at times[k];
    all motions, that of the radar too, go on between the frames. It has the same bits alone, in order and in reverse. While
    the signal of one is made in a loop over frames, a thread traces the next, unless ep.set_num_threads(1) was called. A slice
    is a Sequence of frames of the same bits, `sequence[-1]` the last frame. Objects that have a lifetime
    (`SceneNode.lifetime`), as the vehicles of SUMO, take part in the frames that it covers wholly: others are as without them,
    and their scenes have them as not visible. Names tell objects for good; mesh IDs count what is there. What surrounds the
    antenna in frame 0 is no object of labels and truth in any frame (`families` tells the rule). Noise is that of the start
    time.
    scene: what is traced, as it is now: later changes of it do not matter; radar: that looks at it
    frames: number of frames K, 1 to 1e6; interval: s, from start to start, at least the duration of a frame
    start_time: s, of frame 0
    times: [K] s, in the place of frames, interval and start_time: the start of each frame, such as those of a recording, in
        order, each at least the duration of a frame after the one before
    num_rays, max_bounces, seed, polarization, footprint, sampler, batches, target_error_db (dB), max_rays, scatterers,
        edges, faint_power (W), effects: as in `trace`; the seed serves all frames, and "auto" scatterers are those of the
        surfaces, so that speckle goes on from frame to frame
    parts, tolerance, method, replay, evaluate, phase_tolerance (rad), retrace, keyframes, noise_seed, window, zero_pad, angles,
        labels, detections, truth, guard, trace, signal: as in `simulate`
    Raises TypeError or ValueError naming the argument, also where a motion does not cover all frames that its object is in. Warns
    (RuntimeWarning) of trajectories that begin or end within the frames, at some speed, of scenes of which nothing that has a
    lifetime is there, and of objects that come and go between frames. A frame raises and warns as that of `simulate` does; why
    nothing is heard is told once.
    """

    @checked({"trace": TraceSettings, "signal": SignalSettings}, WITHIN, **TraceSettings.RULES, **SignalSettings.RULES,
             self=anything, frames=optional(count(1, LONGEST)), interval=optional(real(unit="s")),
             times=optional(array("[K]", finite=True)), parts=anything, angles=anything,
             labels=anything, detections=anything, truth=anything, guard=flag)
    def __init__(self, scene: _core.Scene, radar: _core.Radar, *, frames: int | None = None,
                 interval: float | None = None, start_time: float = TraceSettings.start_time,
                 times: ArrayLike | None = None, num_rays: int | float | None = TraceSettings.num_rays,
                 max_bounces: int = TraceSettings.max_bounces, seed: int = TraceSettings.seed,
                 polarization: Polarization = TraceSettings.polarization, footprint: Footprint = TraceSettings.footprint,
                 sampler: Sampler = TraceSettings.sampler, batches: int | None = TraceSettings.batches,
                 target_error_db: float | None = TraceSettings.target_error_db,
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
                 guard: bool = True, trace: TraceSettings | None = None, signal: SignalSettings | None = None):
        tracing, signals = settings_among(TraceSettings, locals()), settings_among(SignalSettings, locals())
        starts, frames = starts_and_count(frames, interval, times, tracing.start_time, radar)
        tracing, start_time = tracing.replace(start_time=starts.first), starts.first
        end = _checked_end(scene, radar, starts, frames)
        check_receiver(radar, start_time, end)
        require_interferers(scene, radar, effects, start_time, end)
        self._run = FrameRun(Scene(scene), radar, tracing, signals, parts, angles, labels, detections, truth, guard)
        warn_of_ends(scene, radar, start_time, end)
        warn_of_absent_interferers(scene, radar, effects, start_time, end)
        if not warn_of_absence(scene, radar, start_time, end):
            warn_of_the_unseen(scene, radar, starts.of_all(range(frames)))
        self._numbers, self._starts = range(frames), starts
        self._still_rays = _core.KeptStillRays()

    @property
    def scene(self) -> Scene:
        """A copy of the scene that is simulated."""
        return self._run.scene.copy()

    @property
    def radar(self) -> _core.Radar:
        """The radar that looks at it."""
        return self._run.radar

    def _item(self, place: int, progress=None) -> Frame:
        """As Row has it; progress: as in `simulate`."""
        frame = self._finished(*self._recorded(place, progress), progress)
        give_back_memory()  # of the work on it: nobody tells whether another frame follows
        return frame

    def _items(self, places: Iterable[int], progress=None) -> Iterator[Frame]:
        """As Row has it; the record of the next frame is made while this one is used."""
        # The geometry of a frame is looked at when its objects are labelled, while that of the next is traced.
        geometries = itertools.cycle((_core.KeptGeometry(), _core.KeptGeometry()))
        memory = MemoryOfFrames()
        works = (functools.partial(self._recorded, place, geometry=geometry) for place, geometry in zip(places, geometries))
        try:
            for place, recorded in one_ahead(works, progress):
                frame = self._finished(place, recorded, progress)
                memory.end_frame()
                yield frame
                del recorded, frame  # of which none is kept while the next is made
        finally:
            give_back_memory()  # of frames that the user has let go since, and of one made ahead that nobody takes

    def _maps(self) -> tuple[int, Iterator[tuple], dict]:
        return len(self), self._levels(), self._run.map_settings

    def _levels(self) -> Iterator[tuple]:
        from ..plots import power_dbm

        for frame in self:
            spectrum = frame.spectrum
            yield (frame.paths.frame.start_time, power_dbm(spectrum), np.asarray(spectrum.velocity),
                   np.asarray(spectrum.range))

    def _finished(self, place: int, recorded: Recorded, progress) -> Frame:
        """The frame at a place, of its record."""
        with at_work_on(_name_of(place)):
            frame = self._run.frame_of_record(recorded, progress)
            self._run.warn_of(frame)
        return frame

    def _recorded(self, place: int, progress=None, geometry=None) -> tuple[int, Recorded]:
        """A place and the record of the frame there; geometry: KeptGeometry where that of the scene is kept, None: as before."""
        run, start_time = self._run, self._starts.of(self._numbers[place])
        if geometry is not None:
            keep_geometry(run.scene, geometry)
        with at_work_on(_name_of(place)):
            return place, run.recorded(lambda: record_of(run.scene, run.radar, run.trace, start_time=start_time,
                                                         still_rays=self._still_rays, progress=progress))

    @checked(self=anything, path=path_rule, keep=one_of(Keep), shard=shard_rule)
    def save(self, path: str | os.PathLike[str], *, keep: Keep = "all", shard: Shard | None = None,
             progress: Progress = None) -> StoredSequence:
        """Simulates all frames and writes each to a file of a folder, or all to one file.

        Each frame is written whole or not at all. Where the run was ended (Ctrl-C, kill, a power cut), the same call goes on:
        frames that are there and whole are not simulated again, and all have the same bits as without the break. So a
        folder or file grows, too, with a sequence of more frames. Processes that write to one folder take shards of it.
        path: new, or of this sequence. One that ends in .h5 or .hdf5 is one HDF5 file of all frames, unless a folder has that
            name; any other is a folder, with frame_0000.h5 and so on, and sequence.h5, which says of what
        keep: "all": frame files as of `save_frame`; "maps": range-Doppler map, labels and
            detections; "labels": labels and detections alone; see FrameMaps; each with its truth where the frames have it
        shard: (k, n), whole numbers, k from 1 to n: the k-th of n processes makes the frames at places k - 1, k - 1 + n,
            k - 1 + 2 n and so on; None: all; not for one file
        progress: callable (stage, fraction of the frames), True for bars with the time left in s, or None
        Returns the StoredSequence of `load_sequence`. Raises ValueError naming the path where it holds another sequence or
        another process writes to it, and naming `keep` where the sequence has no labels to be kept; ep.FileError when files
        cannot be written.
        """
        bars = automatic_bars() if progress is True else progress
        count = len(places_of(shard, len(self)))
        for done, _ in enumerate(self.save_frames(path, keep=keep, shard=shard), 1):
            if callable(bars):
                bars("frames", done / count)
        return StoredSequence(Path(path))

    @checked(self=anything, path=path_rule, keep=one_of(Keep), shard=shard_rule)
    def save_frames(self, path: str | os.PathLike[str], *, keep: Keep = "all", shard: Shard | None = None,
                    progress: Progress = None) -> Iterator[SavedFrame]:
        """`save` frame by frame: yields a SavedFrame as soon as it is there; what stops taking them stops the work.

        path, keep, shard (pair of whole numbers): as in `save`
        progress: of the stages of each frame, callable (stage, fraction), True for bars, or None
        Raises what `save` raises, with the first frame.
        """
        return self._save_frames(path, keep, shard, progress)

    def _save_frames(self, path, keep: Keep, shard: Shard | None = None, progress: Progress = None,
                     look: Callable[[Frame], None] | None = None) -> Iterator[SavedFrame]:
        """As `save_frames`; look: is called with each frame that is made, before it is written."""
        if keep == "labels" and self._run.label_settings is None:
            raise refused(ValueError, "keep", "'all' or 'maps' for a sequence without labels", keep)
        if len(self) == 0:
            raise refused(ValueError, "frames", "at least 1 to be saved", 0)
        if Path(path).name == NAME:
            raise refused(ValueError, "path", f"a folder or a file of another name than {NAME}, which a folder has", str(path))
        bars = automatic_bars() if progress is True else progress
        return saved_frames(self.times, store_of(path), keep, lambda places: _seen(self._items(places, bars), look),
                            self._contents(keep), shard)

    def _contents(self, keep: Keep) -> Contents:
        """What tells this sequence from another, beside its frames."""
        return Contents(self._run.scene, self._run.radar, self._settings() | {"keep": keep})

    def _settings(self) -> dict[str, Any]:
        """{keyword: value} of what makes the frames, and which of them are taken."""
        run, labels, weather = self._run, self._run.label_settings, weather_of(self._run.scene)
        placed = {"frames": len(self), "interval": self._starts.interval, TIMES: self._starts.given,
                  "first_number": self._numbers.start, "number_step": self._numbers.step}
        return placed | run.trace.keywords() | run.signal.keywords() | {
            "parts": run.selections, "angles": run.angle_settings, "guard": run.guard,
            "labels": None if labels is None else labels.keywords(), "detections": run.detect_keywords,
            "truth": run.truth_keywords, "weather": None if weather is None else weather.keywords()}

    def __repr__(self) -> str:
        return f"Sequence({counted(len(self), 'frame')} {self._span()}, {self._pace()})"

    def _repr_html_(self) -> str:
        from ..presentation.notebook import sequence_html

        return sequence_html(self, "Sequence", {})


def _seen(frames: Iterator[Frame], look: Callable[[Frame], None] | None) -> Iterator[Frame]:
    """The frames, each of which `look` is called with before."""
    with closing(frames):
        for frame in frames:
            if look is not None:
                look(frame)
            yield frame
            del frame  # none is kept while the next is made


def _name_of(place: int) -> str:
    return f"frame {place + 1}"


def _checked_end(scene, radar, starts: Starts, frames: int) -> float:
    """The end of the last frame in s. Raises ValueError naming the argument where frames leave the motions: before the long
    work."""
    end = starts.of(frames - 1) + radar.frame_duration
    try:
        scene.require_times(starts.first, end)
        require_motion("radar", radar, (starts.first, end))
    except ValueError as error:
        name, pace = ("frames", f" every {starts.interval:g} s") if starts.given is None else ("times", "")
        raise ValueError(f"{name}: must all lie within the motions, got {counted(frames, 'frame')}{pace}: {error}") from None
    return end
