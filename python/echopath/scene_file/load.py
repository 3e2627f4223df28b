"""Scene files: TOML -> a scene, a radar and the settings of a simulation."""
from __future__ import annotations

import dataclasses
import math
import os
import tomllib
from pathlib import Path

import numpy as np
from .. import _core
from ..antennas import load_antenna
from ..azimuth_map import checked_settings
from ..checks import checked
from ..families import named_globs
from ..parts import as_partitions, check_partitions
from ..readers.load import is_foreign
from ..settings import LabelSettings, SignalSettings, TraceSettings
from .errors import blamed, validated
from .foreign import foreign_scene
from .objects import build_scene, motion_of
from .schema import AngleTable, DetectionsTable, RadarTable, SceneTable


@dataclasses.dataclass(frozen=True)
class SceneFile:
    """What a scene file says.

    path: of the file; title: one line; scene, radar: ready to trace, radar None of a foreign scene, which has none; parts:
    {name: expression} (one partition), {name: {name: expression}} (several) or {}; trace: TraceSettings, signal:
    SignalSettings, labels: LabelSettings or None: none are asked for; angle, detections: tables of the file, as keywords by
    `angle_settings()` and `detection_settings()`; guard: of `ep.simulate`.
    """

    path: Path
    title: str
    scene: object
    radar: object
    trace: TraceSettings
    signal: SignalSettings
    angle: AngleTable
    parts: dict
    labels: LabelSettings | None = None
    detections: DetectionsTable | None = None
    guard: bool = True

    def angle_settings(self) -> dict:
        """Keywords of `ep.range_azimuth`, angles in rad; those without a value are left out."""
        settings = self.angle.model_dump(exclude={"azimuth_deg", "elevation_deg"}, exclude_none=True)
        settings["elevation"] = np.radians(self.angle.elevation_deg).tolist()
        if self.angle.azimuth_deg is not None:
            first, last, step = self.angle.azimuth_deg
            settings["azimuth"] = np.radians(first + step * np.arange(math.floor((last - first) / step + 1e-9) + 1)).tolist()
        return settings

    def detection_settings(self) -> dict | None:
        """`detections` of `ep.simulate`: keywords of `ep.detect_frame`, None: no detections."""
        if self.detections is None:
            return None
        objects = None if self.labels is None else self.labels.objects
        return self.detections.model_dump() | {"objects": objects}

    def partitions(self) -> dict:
        """`parts` as {partition: {name: expression}}."""
        return as_partitions(self.parts)


@checked()
def load_scene(path: str | os.PathLike[str]) -> SceneFile:
    """Reads a scene file (keys and units: data/README.md), or what load_model reads as the content of a scene.

    path: of the TOML file, or of a foreign scene in one of the formats of load_model, by its suffix
    Returns a SceneFile; that of a foreign scene has its content below one object, named after the file, the settings of an
    empty scene file, and no radar. `[[objects]]` with `model` put it into a scene file.
    Raises ep.FileError when the file cannot be read; ValueError naming the file, the dotted path of the key, the rule
    and the value for each fault of its content, or the line of a fault of its syntax.
    """
    path = Path(path)
    if is_foreign(path):
        return _foreign(path)
    table = _parse(path)
    try:
        settings = validated(SceneTable, table)
        scene_file = SceneFile(path=path, title=settings.title, scene=build_scene(settings, path.parent),
                               radar=_build_radar(settings.radar, path.parent), trace=_trace(settings),
                               signal=_signal(settings), angle=settings.angle, parts=dict(settings.parts),
                               labels=_labels(settings), detections=settings.detections, guard=settings.guard)
        with blamed("angle"):
            checked_settings(scene_file.radar, scene_file.angle_settings())
        check_partitions(scene_file.partitions(), scene_file.scene)
        _check_labels(scene_file)
        return scene_file
    except ValueError as error:
        raise ValueError("\n".join(_with_file(path, line) for line in str(error).splitlines())) from None


def _foreign(path: Path) -> SceneFile:
    return SceneFile(path=path, title=path.stem, scene=foreign_scene(path), radar=None, trace=TraceSettings(),
                     signal=SignalSettings(), angle=AngleTable(), parts={})


def _trace(settings: SceneTable) -> TraceSettings:
    with blamed("trace"):
        return TraceSettings(**settings.trace.model_dump())


def _signal(settings: SceneTable) -> SignalSettings:
    with blamed("replay"):
        replayed = SignalSettings(**settings.replay.model_dump())
    with blamed("noise"):
        noisy = replayed.replace(noise_seed=settings.noise.seed)
    with blamed("spectrum"):
        return noisy.replace(window=settings.spectrum.window, zero_pad=settings.spectrum.zero_pad)


def _labels(settings: SceneTable) -> LabelSettings | None:
    with blamed("labels"):
        return None if settings.labels is None else LabelSettings(**settings.labels.model_dump())


def _check_labels(scene_file: SceneFile) -> None:
    """Raises ValueError for objects that are not in the scene: before a long trace."""
    with blamed("labels.objects"):
        for _, globs in named_globs(scene_file.labels and scene_file.labels.objects) or []:
            for glob in globs:
                _core.hits(glob).check(scene_file.scene)


def _with_file(path: Path, line: str) -> str:
    """A line of a message, the file before it; not before a text that is quoted with a caret below."""
    return line if line.startswith("  ") else f"{path}: {line}"


def _parse(path: Path) -> dict:
    try:
        return tomllib.loads(path.read_bytes().decode("utf-8-sig"))  # with a byte-order mark, too
    except OSError as error:
        raise _core.FileError(f"{path}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: is not UTF-8 text (byte {error.start})") from None
    except RecursionError:
        raise ValueError(f"{path}: its tables or arrays are nested too deeply") from None
    except ValueError as error:  # of the syntax, or a number of too many digits
        raise ValueError(f"{path}: {error}") from None


def _build_radar(table: RadarTable, folder: Path):
    with blamed("radar.waveform"):
        waveform = _core.ChirpSequence(**table.waveform.model_dump())
    antennas = {}
    for side in ("transmitters", "receivers"):
        antennas[side] = []
        for index, antenna in enumerate(getattr(table, side)):
            with blamed(f"radar.{side}[{index}]"):
                antennas[side].append(_antenna(antenna, table, folder))
    with blamed("radar"):
        return _core.Radar(waveform, **antennas, transmit_power=table.transmit_power,
                           noise_figure_db=table.noise_figure_db, multiplexing=table.multiplexing,
                           position=tuple(table.position), yaw=math.radians(table.yaw_deg),
                           pitch=math.radians(table.pitch_deg),
                           motion=motion_of(table.motion, "radar.motion"), speed=table.speed)


def _antenna(antenna, radar: RadarTable, folder: Path):
    direction = {"orientation": tuple(antenna.orientation)} if antenna.orientation is not None else {
        "yaw": math.radians(antenna.yaw_deg or 0.0), "pitch": math.radians(antenna.pitch_deg or 0.0)}
    return _core.Antenna(tuple(antenna.position), **direction,
                         pattern=_pattern(antenna.pattern or radar.pattern, folder),
                         polarization=tuple(antenna.polarization or radar.polarization))


def _pattern(table, folder: Path):
    if table is None:
        return _core.Isotropic()
    if table.kind == "isotropic":
        return _core.Isotropic(gain=table.gain)
    if table.kind == "table":
        return load_antenna(folder / table.file, normalize=table.normalize)
    return _core.CosinePower(table.exponent, peak_gain=table.peak_gain)
