"""The record and the signal of a scene, brought up to date by what differs."""
from __future__ import annotations

import dataclasses
import time
from typing import Any

import numpy as np

from .. import _core
from ..signals.parts import ONLY_PARTITION, Parts, check_partitions
from ..tracing.faint_paths import faint_power_of
from ..tracing.polarization import chosen_model
from ..transmit.signals import decompose_slots, synthesize_slots
from ..weather.weather import attenuation_of

# Signals that are added and taken away round to about ROUNDING of the largest sample that there is then. All is summed anew
# where this adds up to more than MOST_ROUNDING of the largest sample: after 256 changes, or one that takes away what was so much
# stronger than the rest.
ROUNDING, MOST_ROUNDING = 1e-15, 2.56e-13


@dataclasses.dataclass(frozen=True)
class Update:
    """What an update did.

    num_rays: of the record; num_rays_shot, num_paths_changed: counts; trace, signal: s that they took; new_record: Paths of a
    record that was made as a whole, None where it was brought up to date
    """

    num_rays: int
    num_rays_shot: int
    num_paths_changed: int
    trace: float
    signal: float
    new_record: _core.Paths | None


class KeptSignal:
    """The record and the cubes of the scene of the last update. An update that was ended is made up for by the next one.

    trace, signal: {keyword: value} of `_core.LiveTrace.update` without the number of rays, and of `synthesize_slots`
    selections: {name: selection} of the parts that have cubes of their own, None: none
    """

    def __init__(self, num_rays: int, trace: dict[str, Any], signal: dict[str, Any], selections: dict | None = None):
        self.num_rays = num_rays
        self._trace_keywords, self._signal_keywords, self._selections = trace, signal, selections
        self._record = _core.LiveTrace(whole_scenes=selections is not None)
        self._radar: _core.Radar | None = None  # that of the cubes
        self._cubes: dict[str, np.ndarray] = {}  # by part, whose sum `_cube` is; that alone where there are no parts
        self._cube: np.ndarray | None = None
        self._whole: _core.Paths | None = None  # of which the cubes are to be made anew
        self._pending: list[tuple[float, _core.Paths]] = []  # what is still to be added to the cube, and its sign
        self._largest = 0.0   # sqrt(W), real or imaginary part of a sample of any cube
        self._rounding = 0.0  # sqrt(W), of the cubes since they were summed anew
        # The whole record where an update has made it, so that `paths` need not: held until `paths` gives it or the next update
        # begins, beside the parts of which it was made, whether or not anyone asks.
        self._made: _core.Paths | None = None

    @property
    def cube(self) -> np.ndarray:
        """[tx, rx, chirp, sample] in sqrt(W), read-only."""
        assert self._cube is not None, "an update comes first"
        return self._cube

    @property
    def parts(self) -> Parts | None:
        """The cubes of the parts, None where none are asked for."""
        return None if self._selections is None else Parts(self._cubes, self._selections, self._radar)

    def update(self, scene: _core.Scene, radar: _core.Radar, progress=None) -> Update:
        """Brings record and cube to this scene and radar. progress: callable (stage, fraction), True for bars, or None"""
        try:
            return self._updated(scene, radar, progress)
        except Exception:
            raise
        except BaseException:  # Ctrl-C, which may come between any two steps: what the cube lacks may not have been noted
            self._cube = None
            raise

    def _updated(self, scene, radar, progress) -> Update:
        begin, self._made = time.perf_counter(), None
        if self._selections is not None:
            check_partitions({ONLY_PARTITION: self._selections}, scene)
        keywords = self._trace_keywords | {"polarization": self._model(scene, radar),
                                           "attenuation": attenuation_of(scene, radar),
                                           "faint_power": faint_power_of(self._trace_keywords["faint_power"], radar)}
        change = self._record.update(scene, radar, num_rays=self.num_rays, progress=progress, **keywords)
        self._note(change)
        if self._whole is None and radar != self._radar:
            self._whole = self._record.paths(progress)
        middle = time.perf_counter()
        try:
            num_changed = self._bring_up(radar, progress)
        except ValueError:  # of echoes that are no numbers, say: what is still to be added must not be asked for again
            self._whole, self._pending = self._record.paths(), []
            raise
        return Update(change["num_rays"], change["num_rays_shot"], num_changed, middle - begin, time.perf_counter() - middle,
                      change["added"] if change["is_whole"] else None)

    def _note(self, change: dict) -> None:
        """Notes what the cube lacks of the record."""
        if change["is_whole"] or self._cube is None:
            self._whole, self._pending = change["added"] if change["is_whole"] else self._record.paths(), []
        elif self._whole is not None:
            self._whole = self._record.paths()
        else:
            self._pending += [(sign, paths) for sign, paths in ((1.0, change["added"]), (-1.0, change["removed"]))
                              if paths.num_paths]

    def _bring_up(self, radar, progress) -> int:
        """Brings the cube to the record; returns the number of paths that this took."""
        num_paths = 0 if self._whole is None else self._sum_anew(radar, progress)
        while self._pending:
            sign, paths = self._pending[-1]
            num_paths += paths.num_paths
            change, before = self._signals_of(paths, radar, progress), self._largest
            self._set_cubes({name: cube + change[name] if sign > 0.0 else cube - change[name]
                             for name, cube in self._cubes.items()})
            self._pending.pop()
            self._rounding += ROUNDING * max(before, self._largest)
        if self._rounding > MOST_ROUNDING * self._largest:
            self._whole = self._record.paths(progress)
            num_paths += self._sum_anew(radar, progress)
        return num_paths

    def _sum_anew(self, radar, progress) -> int:
        """Makes the cubes of the whole record; returns the number of its paths."""
        assert self._whole is not None
        self._set_cubes(self._signals_of(self._whole, radar, progress))
        self._made = self._whole
        self._radar, self._whole, self._pending, self._rounding = radar, None, [], 0.0
        return self._made.num_paths

    def _signals_of(self, paths: _core.Paths, radar: _core.Radar, progress) -> dict[str, np.ndarray]:
        """{part: cube}"""
        if self._selections is None:
            return {"": synthesize_slots(paths, radar, progress=progress, **self._signal_keywords)}
        grouping = _core.Grouping.selections(list(self._selections.items()))
        return decompose_slots(paths, radar, [grouping], progress=progress, **self._signal_keywords)[0]

    def _set_cubes(self, cubes: dict[str, np.ndarray]) -> None:
        self._cubes = cubes
        self._cube = next(iter(cubes.values())) if len(cubes) == 1 else np.sum(list(cubes.values()), axis=0)
        for cube in (self._cube, *cubes.values()):
            cube.flags.writeable = False
        numbers = [cube.view(np.float64) for cube in cubes.values()]
        self._largest = max(max(float(part.max()), -float(part.min())) for part in numbers)

    def paths(self, progress=None) -> _core.Paths:
        """The whole record, Paths."""
        made, self._made = self._made, None
        return self._record.paths(progress) if made is None else made

    def _model(self, scene: _core.Scene, radar: _core.Radar) -> str:
        wavelength = _core.speed_of_light / radar.waveform.start_frequency
        middle = radar.middle_of_frame(self._trace_keywords["start_time"])
        return chosen_model(self._trace_keywords["polarization"], scene, wavelength, radar, middle)
