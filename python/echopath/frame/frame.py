"""What one simulated frame is: its paths, signals and maps."""
from __future__ import annotations

import dataclasses
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..arguments.settings import SignalSettings
from ..base.classes.by_partition import ByPartition
from ..base.classes.known_attributes import known_attributes
from ..base.classes.made_by import made_by
from ..base.process.stages import Stage
from ..base.text.counts import counted
from ..effects import of_paths
from ..paths.families import families as find_families
from ..paths.resolution import FamilyPowers, family_powers, mean_powers, unresolved_of
from ..receiver.chain import reception
from ..signals.beside import cubes_beside
from ..spectra.angles import range_azimuth
from ..spectra.azimuth_map import sees_azimuth
from ..transmit import demultiplex
from ..truth import truth_of_frame
from .received import received_parts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..arguments.checks import Progress
    from ..base.classes.foreign_types import Axes, Page
    from ..detections.detections import Detections
    from ..effects import Effect
    from ..frame_file import LeftOut
    from ..guard import Check
    from ..labels.labels import Labels
    from ..paths.resolution import Unresolved
    from ..receiver.chain import Reception
    from ..truth import Truth

    Cube = NDArray[np.complex128]
    # `| Any` stands for what is None unless it was asked for: who did so needs no check for None.

_WHOLE = object()  # a partition of one part, beside those that have names


@known_attributes
@made_by("ep.simulate and ep.load_frame")
@dataclasses.dataclass(eq=False)
class Frame:
    """One simulated frame.

    scene, radar: what was simulated; paths: what every ray touched
    cube: complex [tx, rx, chirp, sample], sqrt(W), each transmitter alone, without noise and faults of the receiver; the sum
        of the parts of each partition
    coded_cube: [1, rx, slots, sample], sqrt(W), what receivers have of transmitters that send at once, without noise; None
        where they take turns
    parts: {partition: {part: cube}}, without noise, part "other" included; {} when none was asked for
    selections: {partition: {part: expression as text}}, without "other"
    part_of_path: {partition: u16 [P]}, index of the part of each path in the order of `parts`
    rain_cube: as coded_cube where there is one, else as cube, of the rain in the scene's weather, which only the map of the
        whole gets, as it gets the noise; None: none
    interference_cube: likewise, of the other radars of the scene (`Scene.interferers`); None: none
    noise_seed: of the thermal noise, which is drawn from it and the start time of the frame (s); None: no noise
    replay, evaluate, retrace, keyframes: how the signal follows moving echoes, as in `synthesize`
    effect_choices: pairs (name, True, False or "auto") of `effects` as in `trace`
    spectrum_settings: window and zero_pad of the maps; angle_settings: keywords of `range_azimuth` for its map
    spectrum: range-Doppler map of the cube with noise; part_spectra: {partition: {part: map}} without noise
    labels: {partition: Labels} of the cells of its map, of "parts" with the part "other" without partitions; {} when
        not asked for
    detections: Detections in its map, None when not asked for
    kept_truth: Truth of the objects that files of the frame keep, None when not asked for: `truth` then follows from the paths
    checks: list [C] of Check, what the guard of the run compared; [] when it was off
    stages: time and peak memory of each stage
    """

    scene: _core.Scene
    radar: _core.Radar
    paths: _core.Paths
    cube: Cube
    parts: dict[str, dict[str, Cube]]
    selections: dict[str, dict[str, str]]
    part_of_path: dict[str, NDArray[np.uint16]]
    noise_seed: int | None
    spectrum_settings: dict
    rain_cube: Cube | Any = None
    interference_cube: Cube | Any = None
    coded_cube: Cube | Any = None
    spectrum: _core.RangeDoppler | Any = None
    part_spectra: dict[str, dict[str, _core.RangeDoppler]] = dataclasses.field(default_factory=dict)
    angle_settings: dict = dataclasses.field(default_factory=dict)
    replay: str = SignalSettings.replay
    evaluate: str = SignalSettings.evaluate
    retrace: str = SignalSettings.retrace
    keyframes: int = SignalSettings.keyframes
    effect_choices: tuple[tuple[str, bool | str], ...] = ()
    labels: dict[str, Labels] = dataclasses.field(default_factory=dict)
    detections: Detections | Any = None
    kept_truth: Truth | None = None
    checks: list[Check] = dataclasses.field(default_factory=list)
    stages: list[Stage] = dataclasses.field(default_factory=list)

    def __post_init__(self) -> None:
        for name in ("parts", "selections", "part_of_path", "part_spectra", "labels"):
            setattr(self, name, ByPartition(getattr(self, name)))

    @property
    def start_time(self) -> float:
        """s, first sample of the frame; it and the next ones are called as in `ep.FrameMaps`, which small files keep."""
        return self.paths.frame.start_time

    @property
    def seed(self) -> int:
        """Seed of the rays."""
        return self.paths.frame.seed

    @property
    def velocity(self) -> NDArray[np.float64] | Any:
        """[V] m/s, receding positive: axis of the range-Doppler map; None of a record of paths alone, which has none."""
        return None if self.spectrum is None else np.asarray(self.spectrum.velocity)

    @property
    def range(self) -> NDArray[np.float64] | Any:
        """[R] m: axis of the range-Doppler map; None of a record of paths alone."""
        return None if self.spectrum is None else np.asarray(self.spectrum.range)

    @property
    def power(self) -> NDArray[np.float32] | Any:
        """f32 [V, R] W of the range-Doppler map with its noise, mean over channels; None of a record of paths alone."""
        return None if self.spectrum is None else power_of_map(self.spectrum.values)

    @property
    def azimuth(self) -> NDArray[np.float64] | Any:
        """[A] rad, left positive: axis of the range-azimuth map; None where the radar sees no azimuth."""
        return None if self.range_azimuth is None else np.asarray(self.range_azimuth.azimuth)

    @property
    def azimuth_power(self) -> NDArray[np.float32] | Any:
        """f32 [A, R] W of the range-azimuth map; None where the radar sees no azimuth."""
        return None if self.range_azimuth is None else self.range_azimuth.power.astype(np.float32)

    @property
    def noisy_cube(self) -> Cube:
        """The cube with rain, interference, thermal noise and the faults of the receiver, complex [tx, rx, chirp, sample],
        sqrt(W): the same bits at every call. Codes of transmitters are undone (`demultiplex`).

        The noise is drawn from the noise seed and the start time of the frame (s): frames in a row differ. Raises ValueError
        for a record of paths alone.
        """
        received = self.received.cube
        return received if self.coded_cube is None else demultiplex(received, self.radar)

    @property
    def received(self) -> Reception:
        """Reception: what the converter of the receiver gives, before `demultiplex`, made anew at every call.

        Raises ValueError for a record of paths alone.
        """
        return reception(self._arriving_cube, self.radar, self.noise_seed, self.paths.frame.start_time,
                         self.interference_cube)

    @property
    def received_parts(self) -> dict[str, dict[str, Cube]]:
        """What the receiver makes of each part: {partition: {part: cube}} in the shape of `received.cube`, sqrt(W), which add up
        to it, made anew at every call; "parts" with the part "other" without partitions.

        Beside the parts of the paths stand those that no path makes, where there are some: "rain", "interference", "leakage",
        "noise" (thermal), "offset" and "converter" (rounding and saturation); see `ep.receive_parts`. Raises ValueError for a
        record of paths alone.
        """
        self._require_signals()
        return received_parts(self)

    def _require_signals(self) -> None:
        if self.cube is None:
            raise ValueError("frame: must have signals, got a record of paths alone")

    @property
    def _arriving_cube(self):
        """Echoes that come to the receivers, without noise: of transmitters that send at once their sum."""
        self._require_signals()
        cube = self.cube if self.coded_cube is None else self.coded_cube
        return cube if self.rain_cube is None else cube + self.rain_cube

    def save(self, path: str | os.PathLike[str], min_power: float = 0.0) -> LeftOut:
        """Writes the frame to an HDF5 file, which `ep.load_frame` reads: what `ep.save_frame` does.

        path, min_power (W) and what is returned are as in `Paths.save`. Raises ep.FileError when the file cannot be written,
        ValueError for a frame without signals.
        """
        from ..frame_file import save_frame

        return save_frame(self, path, min_power)

    def save_raw(self, path: str | os.PathLike[str]) -> int:
        """Writes what the converter gives as a DCA1000 would: signed 16-bit words, I0 I1 Q0 Q1, slot by slot.

        path: of the file, which is written whole or not at all. Returns the number of bytes. Raises what `ep.save_raw`
        raises, which writes several frames.
        """
        from ..sensor_files import save_raw

        return save_raw(self, path)

    def plot(self, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None,
             title: str | None = None) -> Axes:
        """Draws the range-Doppler map with its noise, and the detections in it, where there are some, as points.

        ax: Matplotlib axes to draw in, None: new ones; vmin, vmax: ends of the colour scale in dBm
        title: above the map, None: what it shows, with noise or without
        Returns the axes: range in m across, radial velocity in m/s up (receding positive). Raises ValueError for a record of
        paths alone.
        """
        from ..plots import draw_frame

        return draw_frame(self, ax=ax, vmin=vmin, vmax=vmax, title=title)

    def show(self, *, selection: str | _core.Selection = "", num_rays: int = 300, color_by: str = "bounces") -> Page:
        """The scene and some rays as an interactive picture for notebooks, whose `save(path)` writes one HTML file.

        The mouse turns it; rays and bodies say what they are, and a click on a ray shows all of it.
        selection: path expression or Selection of the rays that are drawn, "": all; num_rays: at most, some of every object
        color_by: str, one of "bounces", "mesh", "power", "range" and "speed"
        Returns a page with `_repr_html_` and `save`. Raises ValueError naming the argument, ModuleNotFoundError where the
        viewer or plotly is not installed.
        """
        from echopath_viewer import page_of

        return page_of(self, selection=selection, num_rays=num_rays, color_by=color_by)

    def _repr_html_(self) -> str:
        from ..presentation.notebook import frame_html

        return frame_html(self)

    @property
    def effects(self) -> list[Effect]:
        """Which effects the frame models, which not, and why: list [E] of Effect, those of the paths and of the signal."""
        return of_paths(self.paths, replay=self.replay, evaluate=self.evaluate, retrace=self.retrace,
                        noise_seed=self.noise_seed, effects=self.effect_choices, surroundings=self.scene,
                        rain_cube=self.rain_cube, interference_cube=self.interference_cube)

    @cached_property
    def beside_spectra(self) -> dict[str, _core.RangeDoppler]:
        """Range-Doppler maps of what no path makes, without noise: {"interference", "rain", "leakage" (of the transmitters
        into the receivers) or "residue" (what codes of "cdm", and of "ddm" and "bpm" whose chirps differ, leave of other
        transmitters' echoes): RangeDoppler}, values in sqrt(W); {} where there is nothing of it."""
        return {name: _core.range_doppler(cube, self.radar, **self.spectrum_settings)
                for name, cube in cubes_beside(self).items()}

    @cached_property
    def path_power(self) -> NDArray[np.float64]:
        """Power of each path at the trace time for the first antennas, [P] in W."""
        return self.paths.power

    @cached_property
    def range_azimuth(self) -> _core.RangeAzimuth | Any:
        """Range-azimuth map of the cube with noise, power [azimuth, range] in W; None where the radar sees no azimuth."""
        return self.range_azimuth_of(self.spectrum) if sees_azimuth(self.radar, self.angle_settings) else None

    def range_azimuth_of(self, spectrum: _core.RangeDoppler, progress: Progress = None) -> _core.RangeAzimuth:
        """Range-azimuth map of a part by the settings of the frame, power [azimuth, range] in W.

        spectrum: RangeDoppler of the frame's radar; progress: callable (stage, fraction), True for bars, or None
        Raises TypeError or ValueError naming the argument, also for arrays that see no azimuth.
        """
        return range_azimuth(spectrum, self.radar, **self.angle_settings, progress=progress)

    @cached_property
    def mean_power(self) -> _core.ReceivedPower:
        """ep.ReceivedPower of all paths, in W: the mean over the random phases, with its interval."""
        return self._mean_powers.of_parts[_WHOLE][0]

    @cached_property
    def mean_part_powers(self) -> dict[str, dict[str, _core.ReceivedPower]]:
        """The same of each part, {partition: {part: ep.ReceivedPower}}, in W."""
        return ByPartition({partition: dict(zip(self.parts[partition], self._mean_powers.of_parts[partition]))
                            for partition in self.part_of_path})

    @cached_property
    def unresolved(self) -> list[Unresolved]:
        """Objects, ghosts and surroundings above the noise whose mean power the rays do not know to 0.3 dB: list of
        Unresolved, as `ep.unresolved` gives them, with the noise of the radar."""
        return unresolved_of(self.paths, self._family_powers, least_power=_core.noise_power_in_cell(self.radar))

    @cached_property
    def truth(self) -> Truth:
        """ep.Truth of the objects in the middle of the frame: places in m, velocities in m/s, boxes, cross sections in m^2."""
        return truth_of_frame(self) if self.kept_truth is None else self.kept_truth

    @cached_property
    def _families(self):
        return find_families(self.paths)

    @cached_property
    def _family_powers(self) -> FamilyPowers:
        return FamilyPowers(self._families, self._mean_powers.of_families)

    def _powers_of(self, objects=None, progress=None) -> FamilyPowers:
        """Of the families of the paths; objects: as in `families`; progress: as in `simulate`."""
        return self._family_powers if objects is None else family_powers(self.paths, objects, progress)

    def _keep_powers(self, found: FamilyPowers) -> None:
        """Keeps those of the objects of the scene, which took a pass over the paths."""
        self._families, self._family_powers = found.families, found

    @cached_property
    def _mean_powers(self):
        """MeanPowers of the families, of each partition and, as the one part of _WHOLE, of all paths."""
        groups = {partition: (part_of_path, len(self.parts[partition]))
                  for partition, part_of_path in self.part_of_path.items()}
        groups[_WHOLE] = np.zeros(self.paths.num_paths, np.uint32), 1
        return mean_powers(self.paths, self._families, groups)

    def __repr__(self) -> str:
        partitions = ", ".join(self.parts) or "none"
        cube = None if self.cube is None else list(self.cube.shape)
        labels = f", labels: {', '.join(self.labels)}" if self.labels else ""
        found = "" if self.detections is None else f", {counted(len(self.detections), 'detection')}"
        return f"Frame(paths={self.paths.num_paths}, cube={cube}, partitions: {partitions}{labels}{found})"


def power_of_map(values: NDArray[np.complex128]) -> NDArray[np.float32]:
    """Power of a map [tx, rx, V, R] in sqrt(W), mean over channels: f32 [V, R] in W."""
    return np.mean(values.real ** 2 + values.imag ** 2, axis=(0, 1)).astype(np.float32)


def with_spectra(frame: Frame) -> Frame:
    """Fills in the range-Doppler maps of a frame: with noise of the whole, without noise of its parts."""
    def spectrum(cube):
        return _core.range_doppler(cube, frame.radar, **frame.spectrum_settings)

    frame.spectrum = spectrum(frame.noisy_cube)
    frame.part_spectra = ByPartition({partition: {name: spectrum(cube) for name, cube in cubes.items()}
                                      for partition, cubes in frame.parts.items()})
    return frame
