"""Frames and records of paths in HDF5 files."""
from __future__ import annotations

import dataclasses
import json
import os
from typing import get_args

import numpy as np

from .. import _core
from ..arguments.checks import an, anything, checked, real, refused
from ..arguments.keywords import parameters_of
from ..arguments.part_names import REST
from ..arguments.settings import Evaluate, Replay, Retrace
from ..base.process.interrupts import keeps_interrupts
from ..detections.uneven_fields import echo_fields
from ..frame.frame import Frame, with_spectra
from ..scene.scene import Scene
from ..signals.parts import Parts
from ..spectra.angles import range_azimuth
from ..spectra.azimuth_map import checked_settings
from ..transmit import is_coded, signal_shape
from .checks import read_checks, write_checks
from .container import file_with_paths, new_file
from .detections import read_detections, write_detections
from .h5 import (
    blames_group,
    blaming,
    length_of,
    read_array,
    read_attribute,
    read_group,
    read_texts,
    write_array,
    write_attribute,
    write_stack,
    write_texts,
)
from .labels import read_all_labels, write_all_labels
from .paths import read_paths, write_paths
from .radar import read_radar, write_radar
from .scene import KeptMeshes, read_scene, write_scene
from .scene.interferers import read_interferers, write_interferers
from .scene.weather import read_effect_choices, scene_in_weather, write_weather
from .seeds import read_optional_seed, write_seed
from .settings import write_setting
from .truth import truth_in, write_truth

# Settings of a signal and the values that each may have.
SIGNAL_SETTINGS = {"replay": get_args(Replay), "evaluate": get_args(Evaluate), "retrace": get_args(Retrace)}
SPECTRUM_KEYS = ("window", "zero_pad")
BESIDE = ("rain_cube", "interference_cube")  # signals that no path makes
ANGLE_KEYS = parameters_of(range_azimuth)[2:-1]  # all but spectrum, radar and progress


@dataclasses.dataclass(frozen=True)
class LeftOut:
    """Paths that a file does not hold: min_power (W) of those it does, num_paths and summed power (W) of the others."""

    min_power: float
    num_paths: int
    power: float


@keeps_interrupts
@checked(paths=anything, min_power=real(0.0, unit="W"))
def save_paths(paths, path, min_power: float) -> LeftOut:
    """Writes paths with their scene and radar to an HDF5 file.

    path: of the file, written whole or not at all; min_power: in W at the trace time for the first antennas, paths
    below it are left out and counted. Returns what was left out. Raises ep.FileError when the file cannot be written.
    """
    with new_file(path) as file:
        return _write_record(file, paths, paths.effects, min_power)[0]


@checked()
@keeps_interrupts
def load_paths(path):
    """Reads the paths of a frame file at `path`: the same bits that were written. Raises ep.FileError."""
    with file_with_paths(path) as file:
        return _read_record(file)


@checked(frame=an(Frame), min_power=real(0.0, unit="W"))
@keeps_interrupts
def save_frame(frame: Frame, path: str | os.PathLike[str], min_power: float = 0.0) -> LeftOut:
    """Writes a frame to an HDF5 file; path, min_power (W) and what is returned are as in `Paths.save`.

    The cubes hold all paths, also those that the record leaves out. Raises ep.FileError when the file cannot be written,
    ValueError for a frame without signals, as of a file that holds a record alone: its `paths.save` writes that.
    """
    if frame.cube is None:
        raise refused(ValueError, "frame", "a frame with its signals (frame.paths.save writes the record alone)", frame)
    with new_file(path) as file:
        missing, is_kept = _write_record(file, frame.paths, frame.effects, min_power, frame.path_power)
        write_interferers(file, frame.scene)
        write_weather(file["scene"], frame)
        _write_signal(file, frame)
        write_checks(file.create_group("checks"), frame.checks)
        _write_spectra(file, frame)
        _write_range_azimuth(file, frame)
        _write_partitions(file, frame, is_kept)
        if frame.labels:
            write_all_labels(file.create_group("labels"), frame.labels)
        if frame.detections is not None:
            write_detections(file.create_group("detections"), frame.detections)
        if frame.kept_truth is not None:
            write_truth(file.create_group("truth"), frame.kept_truth)
    return missing


@checked()
def load_frame(path: str | os.PathLike[str]) -> Frame:
    """Reads the frame file at `path`: the same bits that were written. Raises ep.FileError.

    A file of `Paths.save` gives a frame whose cube and spectrum are None.
    """
    return read_frame(path)


@keeps_interrupts
def read_frame(path, meshes: KeptMeshes | None = None) -> Frame:
    """What `load_frame` reads; meshes: of the file that was read before, which are shared where this one has the same."""
    with file_with_paths(path) as file:
        paths = _read_record(file, meshes)
        of_scene = read_group(file, "scene")
        frame = Frame(scene=scene_in_weather(of_scene, paths.scene), radar=paths.radar, paths=paths, cube=None, parts={},
                      selections={}, part_of_path={}, noise_seed=None, spectrum_settings={},
                      effect_choices=read_effect_choices(of_scene))
        if "signal" not in file:
            return frame
        _read_signal(file, frame)
        others = read_interferers(file)
        frame.scene = Scene(frame.scene, interferers=others) if others else frame.scene
        frame.checks = read_checks(read_group(file, "checks"))
        _read_partitions(file, frame)
        with blaming(read_group(file, "spectra")):
            with_spectra(frame)
        if "labels" in file:
            frame.labels = read_all_labels(read_group(file, "labels"))
        frame.kept_truth = truth_in(file)
        if "detections" in file:
            frame.detections = read_detections(read_group(file, "detections"), frame.spectrum.values.shape[2:],
                                               seed=paths.frame.seed, noise_seed=frame.noise_seed,
                                               echoes=echo_fields(paths, frame.spectrum))
    return frame


@keeps_interrupts
def left_out(path) -> LeftOut:
    """What a frame file does not hold. Raises ep.FileError."""
    with file_with_paths(path) as file:
        return _left_out(read_group(file, "record"))


def _write_record(file, paths, effects, min_power: float, power=None):
    write_scene(file.create_group("scene"), paths.scene)
    write_radar(file.create_group("radar"), paths.radar)
    group = file.create_group("record")
    _write_effects(group.create_group("effects"), effects)
    is_kept = write_paths(group, paths, min_power, power)
    return _left_out(group), is_kept


def _write_effects(group, effects) -> None:
    """For whoever reads the file without this program, which infers them from scene, radar and settings."""
    write_texts(group, "name", [effect.name for effect in effects])
    write_array(group, "modelled", np.array([effect.modelled for effect in effects], np.uint8))
    write_texts(group, "reason", [effect.reason for effect in effects])


def _read_record(file, meshes: KeptMeshes | None = None):
    scene, radar = read_scene(read_group(file, "scene"), meshes), read_radar(read_group(file, "radar"))
    return read_paths(read_group(file, "record"), scene, radar)


@blames_group
def _left_out(group) -> LeftOut:
    return LeftOut(min_power=read_attribute(group, "min_power", float),
                   num_paths=read_attribute(group, "num_left_out", int),
                   power=read_attribute(group, "power_left_out", float))


def _write_signal(file, frame: Frame) -> None:
    group = file.create_group("signal")
    write_array(group, "cube", frame.cube, unit="sqrt(W)")
    write_array(group, "noisy_cube", frame.noisy_cube, unit="sqrt(W)")
    for name in BESIDE:
        if getattr(frame, name) is not None:
            write_array(group, name, getattr(frame, name), unit="sqrt(W)")
    if frame.coded_cube is not None:
        write_array(group, "coded_cube", frame.coded_cube, unit="sqrt(W)")
    for name in SIGNAL_SETTINGS:
        write_attribute(group, name, getattr(frame, name))
    write_attribute(group, "keyframes", frame.keyframes)
    write_seed(group, "noise_seed", frame.noise_seed)


def _write_spectra(file, frame: Frame) -> None:
    group = file.create_group("spectra")
    write_setting(group, "settings", frame.spectrum_settings)
    write_array(group, "velocity", frame.spectrum.velocity, unit="m/s")
    write_array(group, "range", frame.spectrum.range, unit="m")
    write_array(group, "values", frame.spectrum.values, unit="sqrt(W)")


def _write_range_azimuth(file, frame: Frame) -> None:
    if frame.range_azimuth is None:
        return
    group = file.create_group("range_azimuth")
    write_setting(group, "settings", frame.angle_settings)
    for name in ("azimuth", "elevation"):
        write_array(group, name, getattr(frame.range_azimuth, name), unit="rad")
    write_array(group, "range", frame.range_azimuth.range, unit="m")
    write_array(group, "power", frame.range_azimuth.power, unit="W")


def _write_partitions(file, frame: Frame, is_kept) -> None:
    """One group per partition: names, expressions, cubes, spectra and the part of each path that was written."""
    folder = file.create_group("partitions")
    for index, (partition, cubes) in enumerate(frame.parts.items()):
        group = folder.create_group(str(index))
        write_attribute(group, "name", partition)
        selections = frame.selections[partition]
        write_texts(group, "part", list(cubes))
        write_texts(group, "expression", [selections.get(part, "") for part in cubes])
        write_stack(group, "cubes", list(cubes.values()), unit="sqrt(W)")
        spectra = frame.part_spectra[partition].values()
        write_stack(group, "spectra", [spectrum.values.astype(np.complex64) for spectrum in spectra], unit="sqrt(W)")
        write_array(group, "part_of_path", frame.part_of_path[partition][is_kept], compress=True)


def _read_signal(file, frame: Frame) -> None:
    group = read_group(file, "signal")
    frame.cube = read_array(group, "cube", np.complex128, _cube_shape(frame.radar))
    for name in BESIDE:
        if name in group:
            setattr(frame, name, read_array(group, name, np.complex128, signal_shape(frame.radar)))
    if is_coded(frame.radar):
        frame.coded_cube = read_array(group, "coded_cube", np.complex128, signal_shape(frame.radar))
    frame.noise_seed = read_optional_seed(group, "noise_seed")
    for name, known in SIGNAL_SETTINGS.items():
        setattr(frame, name, _one_of(group, name, known))
    frame.keyframes = read_attribute(group, "keyframes", int)
    frame.spectrum_settings = _read_settings(read_group(file, "spectra"), SPECTRUM_KEYS)
    _check_spectrum_size(read_group(file, "spectra"), frame)
    if "range_azimuth" in file:
        frame.angle_settings = _read_angle_settings(read_group(file, "range_azimuth"), frame.radar)


def _one_of(group, name: str, known: tuple) -> str:
    value = read_attribute(group, name, str)
    if value not in known:
        raise _core.FileError(f"{group.name}: attribute '{name}' must be one of {', '.join(known)}, is {value!r}")
    return value


@blames_group
def _read_settings(group, known: tuple) -> dict:
    """Keywords of a map, all of which must be known."""
    settings = json.loads(read_attribute(group, "settings", str))
    if not isinstance(settings, dict) or not set(settings) <= set(known):
        raise _core.FileError(f"{group.name}: attribute 'settings' must have no keys but {', '.join(known)}, is {settings!r}")
    return settings | {"window": without_lists(settings["window"])} if "window" in settings else settings


def without_lists(value):
    """Lists of JSON as the tuples that they were."""
    return tuple(map(without_lists, value)) if isinstance(value, list) else value


@blames_group
def _read_angle_settings(group, radar) -> dict:
    return checked_settings(radar, _read_settings(group, ANGLE_KEYS))


def _check_spectrum_size(group, frame: Frame) -> None:
    """The map is computed again: before that, its settings must give the one that the file has."""
    zero_pad, length = frame.spectrum_settings.get("zero_pad"), length_of(group, "velocity")
    if not isinstance(zero_pad, int) or zero_pad * frame.radar.waveform.num_chirps != length:
        raise _core.FileError(f"{group.name}: attribute 'settings' must make a map of {length} velocities, has zero_pad "
                              f"{zero_pad!r}")


def partition_names(file) -> list[str]:
    """The names of the partitions of a file that is open. Raises ep.FileError."""
    folder = read_group(file, "partitions")
    return [read_attribute(read_group(folder, str(index)), "name", str) for index in range(len(folder))]


@blames_group
def _read_partitions(file, frame: Frame) -> None:
    folder = read_group(file, "partitions")
    for index in range(len(folder)):
        group = read_group(folder, str(index))
        partition, names = read_attribute(group, "name", str), read_texts(group, "part")
        cubes = read_array(group, "cubes", np.complex128, (len(names), *_cube_shape(frame.radar)))
        expressions = read_texts(group, "expression", len(names))
        frame.selections[partition] = {name: text for name, text in zip(names, expressions) if name != REST}
        frame.parts[partition] = Parts(dict(zip(names, cubes)), frame.selections[partition], frame.radar)
        frame.part_of_path[partition] = _read_part_of_path(group, frame.paths.num_paths, len(names))


def _read_part_of_path(group, num_paths: int, num_parts: int):
    parts = read_array(group, "part_of_path", np.uint16, (num_paths,))
    if len(parts) and parts.max() >= num_parts:
        raise _core.FileError(f"{group.name}/part_of_path: must be below {num_parts}, the number of parts")
    return parts


def _cube_shape(radar) -> tuple:
    return len(radar.transmitters), len(radar.receivers), radar.waveform.num_chirps, radar.waveform.num_samples
