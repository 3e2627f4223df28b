"""Scene files: TOML -> a scene, a radar and the settings of a simulation."""
from __future__ import annotations

import dataclasses
import functools
import inspect
import math
import os
import tomllib
import typing
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from pydantic import create_model

from .. import _core, actors
from ..antennas import load_antenna
from ..azimuth_map import checked_settings
from ..checks import checked
from ..families import named_globs
from ..materials import materials
from ..parts import as_partitions, check_partitions
from ..scene import Scene
from ..settings import LabelSettings, SignalSettings, TraceSettings
from .errors import validated
from .schema import AngleTable, DetectionsTable, ObjectTable, RadarTable, SceneTable, Table, nearest_key


@dataclasses.dataclass(frozen=True)
class SceneFile:
    """What a scene file says.

    path: of the file; title: one line; scene, radar: ready to trace; parts: {name: expression} (one partition), {name: {name:
    expression}} (several) or {}; trace: TraceSettings, signal: SignalSettings, labels: LabelSettings or None: none are asked
    for; angle, detections: tables of the file, as keywords by `angle_settings()` and `detection_settings()`; guard: of
    `ep.simulate`.
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
    """Reads a scene file (keys and units: data/README.md).

    path: of the TOML file. Returns a SceneFile.
    Raises ep.FileError when the file cannot be read; ValueError naming the file, the dotted path of the key, the rule
    and the value for each fault of its content, or the line of a fault of its syntax.
    """
    path = Path(path)
    table = _parse(path)
    try:
        settings = validated(SceneTable, table)
        scene_file = SceneFile(path=path, title=settings.title, scene=_build_scene(settings, path.parent),
                               radar=_build_radar(settings.radar, path.parent), trace=_trace(settings),
                               signal=_signal(settings), angle=settings.angle, parts=dict(settings.parts),
                               labels=_labels(settings), detections=settings.detections, guard=settings.guard)
        with _blame("angle"):
            checked_settings(scene_file.radar, scene_file.angle_settings())
        check_partitions(scene_file.partitions(), scene_file.scene)
        _check_labels(scene_file)
        return scene_file
    except ValueError as error:
        raise ValueError("\n".join(_with_file(path, line) for line in str(error).splitlines())) from None


def _trace(settings: SceneTable) -> TraceSettings:
    with _blame("trace"):
        return TraceSettings(**settings.trace.model_dump())


def _signal(settings: SceneTable) -> SignalSettings:
    with _blame("replay"):
        replayed = SignalSettings(**settings.replay.model_dump())
    with _blame("noise"):
        noisy = replayed.replace(noise_seed=settings.noise.seed)
    with _blame("spectrum"):
        return noisy.replace(window=settings.spectrum.window, zero_pad=settings.spectrum.zero_pad)


def _labels(settings: SceneTable) -> LabelSettings | None:
    with _blame("labels"):
        return None if settings.labels is None else LabelSettings(**settings.labels.model_dump())


def _check_labels(scene_file: SceneFile) -> None:
    """Raises ValueError for objects that are not in the scene: before a long trace."""
    with _blame("labels.objects"):
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


@contextmanager
def _blame(key: str):
    """Prefixes what the core refuses with the dotted path of the key it came from."""
    try:
        yield
    except (ValueError, TypeError, KeyError) as error:
        text = str(error.args[0]) if error.args else str(error)
        raise ValueError(f"{key}: {text}") from None


def _build_radar(table: RadarTable, folder: Path):
    with _blame("radar.waveform"):
        waveform = _core.ChirpSequence(**table.waveform.model_dump())
    antennas = {}
    for side in ("transmitters", "receivers"):
        antennas[side] = []
        for index, antenna in enumerate(getattr(table, side)):
            with _blame(f"radar.{side}[{index}]"):
                antennas[side].append(_antenna(antenna, table, folder))
    with _blame("radar"):
        return _core.Radar(waveform, **antennas, transmit_power=table.transmit_power,
                           noise_figure_db=table.noise_figure_db, multiplexing=table.multiplexing,
                           position=tuple(table.position), yaw=math.radians(table.yaw_deg),
                           pitch=math.radians(table.pitch_deg),
                           motion=_motion(table.motion, "radar.motion"), speed=table.speed)


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


def _motion(table, key: str):
    if table is None:
        return None
    with _blame(key):
        if table.kind == "linear":
            return _core.LinearMotion(velocity=tuple(table.velocity), angular_velocity=tuple(table.angular_velocity))
        return _core.KeyframeMotion(times=table.times, translations=table.translations, rotations=table.rotations,
                                    interpolation=table.interpolation)


def _material(value, key: str):
    """The material of an object: None, an ep.Material, or a known name (which must be known)."""
    if value is None:
        return None
    with _blame(key):
        if isinstance(value, str):
            return materials[value]
        given = value.model_dump(exclude_unset=True)
        base = given.pop("base", None)
        if isinstance(given.get("permittivity"), list):
            real, loss = given["permittivity"]
            given["permittivity"] = complex(real, -loss)
        return materials[base].replace(**given) if base is not None else _core.Material(**given)


def _build_scene(settings: SceneTable, folder: Path):
    scene = Scene()
    meshes_of_file = functools.cache(_core.load_meshes)  # objects that name one file share its meshes
    for index, table in enumerate(settings.objects):
        key = f"objects[{index}]"
        placement = {"transform": table.transform} if table.transform is not None else {
            "position": tuple(table.position or (0.0, 0.0, 0.0)), "yaw": math.radians(table.yaw_deg or 0.0)}
        material = _material(table.material, f"{key}.material")
        shape, material = _shape(table, folder, key, material, meshes_of_file)
        motion = _motion(table.motion, f"{key}.motion")
        with _blame(key):
            scene.add(shape, name=table.name, material=material, motion=motion, speed=table.speed, parent=table.parent,
                      smooth=table.smooth, visible=table.visible, **placement)
    return scene


def _shape(table: ObjectTable, folder: Path, key: str, material, meshes_of_file):
    """The object's mesh, group of meshes or actor, and the material still to be given to it."""
    if table.mesh is not None:
        with _blame(f"{key}.mesh"):
            meshes = meshes_of_file(str(folder / table.mesh), unit=table.unit or 1.0)
        return (meshes[0][1] if len(meshes) == 1 else meshes), material
    factory = _actor_factory(table.actor, f"{key}.actor")
    model = _parameter_table(table.actor, factory)
    parameters = validated(model, table.parameters, (*_as_location(key), "parameters")).model_dump(exclude_unset=True)
    if material is not None and "material" in _parameters(factory):
        parameters["material"], material = material, None
    with _blame(f"{key}.parameters"):
        return factory(**parameters), material


def _as_location(key: str) -> tuple:
    """'objects[3]' -> ('objects', 3)."""
    name, _, index = key.rstrip("]").partition("[")
    return (name, int(index))


def actor_names() -> list[str]:
    """Names of the ready-made objects: the public functions of echopath.actors."""
    return [name for name in actors.__all__ if inspect.isfunction(getattr(actors, name))]


def _actor_factory(name: str, key: str):
    if name not in actor_names():
        raise ValueError(f"{key}: unknown actor '{name}'; {nearest_key(name, actor_names()).replace('keys', 'actors')}")
    return getattr(actors, name)


@functools.cache
def _parameters(factory) -> dict:
    return dict(inspect.signature(factory).parameters)


@functools.cache
def _parameter_table(name: str, factory) -> type[Table]:
    """The keywords of an actor as a table: its signature is their only home, their values it checks itself."""
    fields = {parameter.name: (typing.Any, ... if parameter.default is parameter.empty else parameter.default)
              for parameter in _parameters(factory).values() if parameter.name != "material"}
    return create_model(f"{name}_parameters", __base__=Table, **fields)
