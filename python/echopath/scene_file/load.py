"""Scene files: TOML -> a scene, a radar and the settings of a simulation."""
from __future__ import annotations

import dataclasses
import math
import tomllib
from pathlib import Path
from shlex import quote
from typing import NamedTuple

from .. import _core
from ..arguments.checks import refused
from ..arguments.objects import named_globs
from ..arguments.settings import LabelSettings, SignalSettings, TraceSettings
from ..base.storage.data_folder import data_folder
from ..base.storage.files import bytes_of, named_file
from ..frame_file.opening import SUFFIXES as FRAME_SUFFIXES
from ..readers.load import is_foreign
from ..readers.options import ReadOptions
from ..receiver.channels import require_channels
from ..scene.adapted_materials import adapt_materials
from ..scene.found_objects import find_objects
from ..scene.interferers import Interferer
from ..scene.large_planes import mark_mirrors
from ..scene.scene import Scene
from ..sensor_files import load_radar
from ..sensor_files.antennas import load_antenna
from ..signals.parts import check_partitions
from ..spectra.azimuth_map import checked_settings
from ..trajectories import Trajectory
from ..trajectories.files.rows import KeptRows
from .errors import ToldValueError, blamed, validated
from .foreign import foreign_scene
from .frame_starts import first_start, read_starts
from .lines import with_lines
from .objects import build_scene, motion_of
from .scene_file import SceneFile
from .tables.radar_tables import RadarTable
from .tables.run_tables import FOUND, AngleTable
from .tables.schema import SceneTable
from .tables.table import yaw_of
from .trajectories import Trajectories


def read_scene(path: Path, options: ReadOptions) -> SceneFile:
    """What `load_scene` returns; options: of a foreign scene."""
    if is_foreign(path):
        return _foreign(path, options)
    for field in dataclasses.fields(options):
        value = getattr(options, field.name)
        if value != getattr(ReadOptions(), field.name):
            raise refused(ValueError, field.name, "left out for a scene file, whose objects say it", value)
    text = text_of(path)
    table = parsed(text, path)
    if "dataset" in table:
        raise ValueError(f"{path}: a template of a dataset, where a scene file is asked for; `echopath dataset "
                         f"{quote(str(path))} --out DIR` makes its frames")
    try:
        return scene_file_of(table, path)
    except _core.FileError as error:
        raise _core.FileError(with_lines(error, path, text)) from None
    except ValueError as error:
        raise ValueError(with_lines(error, path, text)) from None


def scene_file_of(table: dict, path: Path, folder: Path | None = None, rows: KeptRows | None = None) -> SceneFile:
    """What a scene file says, of its table; path: of the file, for messages; folder: of what it names, None: that of the file;
    rows: of files of trajectories that it names, None: they are read.

    Raises ValueError as `load_scene` does.
    """
    try:
        settings = validated(SceneTable, table)
        folder = folder or path.parent
        trajectories = Trajectories(folder, settings.traffic, rows or KeptRows())
        scene = build_scene(settings, folder, trajectories)
        trajectories.traffic.add_to(scene)
        carriers = _Carriers(trajectories, scene)
        scene.interferers = _build_interferers(settings, folder, carriers)
        radar = _build_radar(settings.radar, folder, carriers)
        if settings.adapt_materials:
            adapt_materials(scene, radar)
        sequence = _sequence(settings, folder)
        start_time = first_start(settings.trace, sequence)
        if settings.mark_mirrors:
            mark_mirrors(scene, radar, time=start_time)
        scene_file = SceneFile(path=path, title=settings.title, scene=scene, radar=radar, trace=_trace(settings),
                               signal=_signal(settings), angle=settings.angle, parts=dict(settings.parts),
                               detections=settings.detections, guard=settings.guard, sequence=sequence,
                               **_tables_of_objects(settings, scene, radar, start_time))
        with blamed("angle"):
            checked_settings(scene_file.radar, scene_file.angle_settings(), zero_pad=scene_file.signal.zero_pad)
        check_partitions(scene_file.partitions(), scene_file.scene)
        _check_objects(scene_file)
        return scene_file
    except _core.FileError as error:  # of a file that it names
        raise _core.FileError(f"{path}: {error}") from None
    except ValueError as error:
        raise ValueError("\n".join(_with_file(path, line) for line in str(error).splitlines())) from None


def _foreign(path: Path, options: ReadOptions) -> SceneFile:
    return SceneFile(path=path, title=path.stem, scene=foreign_scene(path, options), radar=None, trace=TraceSettings(),
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


def _tables_of_objects(settings: SceneTable, scene: Scene, radar: _core.Radar, start_time: float) -> dict:
    """`labels` and `truth` of a SceneFile, with the names of objects that are to be found in its scene in the middle of the first
    frame, as usual objects are."""
    found = {}
    for key in ("labels", "truth"):
        table = getattr(settings, key)
        is_asked = table is not None and table.objects == FOUND
        if is_asked:
            table = table.model_copy(update={"objects": find_objects(scene, radar, time=radar.middle_of_frame(start_time))})
        found[key] = table
    if found["labels"] is not None:
        with blamed("labels"):
            found["labels"] = LabelSettings(**found["labels"].model_dump())
    return found


def _check_objects(scene_file: SceneFile) -> None:
    """Raises ValueError for objects that are not in the scene: before a long trace."""
    for key, table in (("labels", scene_file.labels), ("truth", scene_file.truth)):
        with blamed(f"{key}.objects"):
            for _, globs in named_globs(table and table.objects) or []:
                for glob in globs:
                    _core.hits(glob).check(scene_file.scene)


def _with_file(path: Path, line: str) -> str:
    """A line of a message, the file before it; not before a text that is quoted with a caret below."""
    return line if line.startswith("  ") else f"{path}: {line}"


def parse(path: Path) -> dict:
    """The table of a TOML file. Raises ep.FileError, ValueError naming the file and the line."""
    return parsed(text_of(path), path)


def text_of(path: Path) -> str:
    """The text of a TOML file. Raises ep.FileError, ValueError naming the file."""
    try:
        return bytes_of(path).decode("utf-8-sig")  # with a byte-order mark, too
    except _core.FileError as error:
        raise _core.FileError(f"{error}{_one_that_comes_along(path)}") from None
    except UnicodeDecodeError as error:
        if path.suffix.lower() in FRAME_SUFFIXES:
            raise ValueError(f"{path}: a frame file, where a scene file (.toml) is asked for; `echopath info "
                             f"{quote(str(path))}` says what it holds") from None
        raise ValueError(f"{path}: is not UTF-8 text (byte {error.start})") from None


def _one_that_comes_along(path: Path) -> str:
    """Of a file that is not there: where the scene or template of its name is that comes with echopath, "" if none does."""
    there = (data_folder(folder) / f"{path.stem}.toml" for folder in ("scenes", "datasets"))
    return next((f"; the one that comes with echopath is {file}" for file in there if not path.exists() and file.is_file()), "")


def parsed(text: str, path: Path) -> dict:
    """The table of a text in TOML; path: of its file. Raises ValueError naming the file and the line."""
    if text.lstrip().startswith("{"):  # which no TOML does
        raise ValueError(f"{path}: must be TOML, which begins with a key or a [table], but begins with a brace, as JSON does")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError(f"{path}: its tables or arrays are nested too deeply") from None
    except ValueError as error:  # of the syntax, or a number of too many digits
        raise ValueError(f"{path}: {error}") from None


_BESIDE_SENSOR = ("transmit_power", "noise_figure_db", "receiver")  # of the table, instead of those of the sensor


class _Carriers(NamedTuple):
    """What radars ride on: the trajectories of the file, and its scene without other radars."""

    trajectories: Trajectories
    scene: Scene


def _build_radar(table: RadarTable, folder: Path, carriers: _Carriers, key: str = "radar"):
    radar = _radar_of(table, folder, carriers, key)
    with blamed(key):
        require_channels(radar.receiver, radar)
    return radar


def _radar_of(table: RadarTable, folder: Path, carriers: _Carriers, key: str):
    if table.sensor is not None:
        with blamed(key, file="sensor"):
            radar = load_radar(named_file(folder, table.sensor), table.board, subframe=table.subframe)
            given = {name: getattr(table, name) for name in _BESIDE_SENSOR if name in table.model_fields_set}
            return radar.replace(**given, **_place(table, carriers, key))
    with blamed(f"{key}.waveform"):
        waveform = _core.ChirpSequence(**table.waveform.model_dump())
    antennas = {}
    for side in ("transmitters", "receivers"):
        antennas[side] = []
        for index, antenna in enumerate(getattr(table, side)):
            place = f"{key}.{side}[{index}]"
            pattern = _pattern(antenna.pattern or table.pattern, folder, place if antenna.pattern else key)
            with blamed(place):
                antennas[side].append(_antenna(antenna, table, pattern))
    with blamed(key):
        return _core.Radar(waveform, **antennas, transmit_power=table.transmit_power,
                           noise_figure_db=table.noise_figure_db, multiplexing=table.multiplexing,
                           empty_slots=table.empty_slots, code_phases=table.code_phases, receiver=table.receiver,
                           **_place(table, carriers, key))


def _sequence(settings: SceneTable, folder: Path):
    """The table of the frames in time, with the starts of a file that it names in the place of its name; None without one."""
    table = settings.sequence
    if table is None or not isinstance(table.times, str):
        return table
    try:
        return table.model_copy(update={"times": read_starts(named_file(folder, table.times))})
    except _core.FileError as error:
        raise _core.FileError(f"sequence.times: {error}") from None


def _build_interferers(settings: SceneTable, folder: Path, carriers: _Carriers) -> list[Interferer]:
    found = []
    for index, table in enumerate(settings.interferers):
        radar = _build_radar(table, folder, carriers, f"interferers[{index}]")
        carried = _trajectory(table, carriers.trajectories, f"interferers[{index}]")
        with blamed(f"interferers[{index}]"):
            found.append(Interferer(radar=radar, offset=table.offset, interval=table.interval, over=table.over,
                                    lifetime=table.lifetime or (carried.lifetime if carried is not None else None)))
    return found


def _trajectory(table: RadarTable, trajectories: Trajectories, key: str) -> Trajectory | None:
    """That of the traffic that carries a radar, or of the radar itself."""
    if table.during is not None:
        return None
    if table.rides_on is not None:
        return trajectories.traffic.of(table.rides_on, f"{key}.rides_on")
    return trajectories.of(table, key)


def _place(table: RadarTable, carriers: _Carriers, key: str) -> dict:
    """Keywords of Radar that say where it is and how it moves."""
    position = tuple(table.position)
    if table.rides_on is None:
        motion = motion_of(table.motion, f"{key}.motion") or _trajectory(table, carriers.trajectories, key)
    else:
        motion = _way_on(table.rides_on, position, table.during, carriers, key)
        position = (0.0, 0.0, 0.0)
    return {"position": position, "yaw": yaw_of(table.yaw_deg), "pitch": math.radians(table.pitch_deg),
            "motion": motion} | ({} if table.speed is None else {"speed": table.speed})


def _way_on(name: str, position, during, carriers: _Carriers, key: str) -> _core.CurveMotion:
    """The motion of a place [3] in m in the axes of what carries it: an object of the scene during a time, else traffic."""
    if during is None:
        return carriers.trajectories.traffic.mount(name, position, f"{key}.rides_on")
    if name not in carriers.scene:
        raise refused(ToldValueError, f"{key}.rides_on", "the full name of an object, beside `during`", name)
    with blamed(key):
        return carriers.scene[name].carried(position, during=during)


def _antenna(antenna, radar: RadarTable, pattern):
    direction = {"orientation": tuple(antenna.orientation)} if antenna.orientation is not None else {
        "yaw": yaw_of(antenna.yaw_deg), "pitch": math.radians(antenna.pitch_deg or 0.0)}
    return _core.Antenna(tuple(antenna.position), **direction,
                         pattern=pattern, polarization=tuple(antenna.polarization or radar.polarization))


def _pattern(table, folder: Path, key: str):
    """The pattern of a table; key: of the antenna or the radar that has it."""
    if table is None:
        return _core.Isotropic()
    with blamed(f"{key}.pattern", file="file"):
        if table.kind == "isotropic":
            return _core.Isotropic(gain=table.gain)
        if table.kind == "table":
            return load_antenna(named_file(folder, table.file), normalize=table.normalize, boresight=table.boresight)
        if table.kind == "gaussian_beam":
            return _core.GaussianBeam(azimuth=math.radians(table.azimuth_deg), elevation=math.radians(table.elevation_deg),
                                      peak_gain=table.peak_gain)
        return _core.CosinePower(table.exponent, peak_gain=table.peak_gain)
