"""Detections of datasets as messages of ASAM OSI, the Open Simulation Interface (asam.net/standards/detail/osi)."""
from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import Any

import numpy as np

from ...arguments.checks import checked, path as folder_rule
from ...base.process.libraries import needed_module
from ...base.radar.antennas import middle_of_antennas
from ...base.storage.files import written_whole
from ...detections.detections import Detections
from ..opened import Dataset, dataset_rule
from . import are_echoes, cross_sections_dbsm, detections_of, exported

FOLDER = "traces"
SENSOR = 1
NO_OBJECT = 2 ** 64 - 1                # as the interface has it
_NAME = "19700101T000000Z_sd_{version}_{protobuf}_{frames}_scene_{scene:06d}.osi"
_LENGTH = struct.Struct("<I")          # before each message of a trace file
_OTHER, _INVALID, _CLUTTER = 1, 2, 3   # DetectionClassification of real echoes, ghosts, what is none


@checked(dataset=dataset_rule, folder=folder_rule)
def write_osi(dataset: Dataset, folder: str | os.PathLike[str]) -> None:
    """Writes the detections of a dataset as trace files of ASAM OSI, one for each scene: a SensorData message for each frame.

    dataset: as of `open`, of a template with an array that tells azimuths apart and [detections]; else with keep = "all", or
        its `remade()`: then detections are those of `ep.detect_frame`
    folder: new or empty; it gets the folder traces, whole or not at all: after a kill, the same call writes it anew. Names of
        files are those of the interface, with time 0 of the scene.
    feature_data.radar_sensor has one sensor: header (measurement_time in the middle of the frame, cycle_counter the place of
    the frame, mounting_position in the world at that time: between transmitters and receivers, from where detections count
    (`Detections.centre`), with the radar's axes) and detections: position (distance m, azimuth and elevation rad, in the
    sensor's frame), radial_velocity (m/s, as measured, receding positive), rcs (dBsm, by the radar equation with the gains of
    the first antennas, not finite for leakage at 0 m), snr (dB), object_id (place in `Dataset.classes`; 2^64 - 1: the
    surroundings or noise), existence_probability 0 of noise and of what comes in beside the echoes (interference, rain,
    leakage, residue), 1 of echoes; classification OTHER of real echoes, INVALID of ghosts, CLUTTER of what has probability 0.
    Raises ValueError naming `dataset` where it has no frames, or no detections with azimuths, and naming `folder` where that has
    a folder traces; ModuleNotFoundError without osi-python (extra `osi`), ep.FileError where files cannot be written.
    """
    messages = _module("sensordata")
    with exported(dataset, folder, FOLDER) as traces:
        for scene in dataset.scenes:
            numbers = _numbers(dataset, scene)
            _write_trace([_frame(messages, dataset, scene, one, numbers) for one in dataset.of_scene(scene)], scene, traces)


def _write_trace(written: list[Any], scene: int, folder: Path) -> None:
    name = _NAME.format(version=_version_text(written[0].version), protobuf=_protobuf(), frames=len(written), scene=scene)
    with written_whole(folder / name) as temporary, open(temporary, "wb") as file:
        for message in written:
            content = message.SerializeToString(deterministic=True)
            file.write(_LENGTH.pack(len(content)) + content)


def _module(name: str) -> Any:
    """A module of messages. Raises ModuleNotFoundError that says what to install."""
    try:
        return needed_module(f"osi3.osi_{name}_pb2", "write_osi")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError("write_osi needs the messages of OSI, which are not installed: pip install osi-python",
                                  name=error.name) from None


def _protobuf() -> str:
    return "".join(needed_module("google.protobuf", "write_osi").__version__.split("."))


def _version_text(version: Any) -> str:
    return f"{version.version_major}{version.version_minor}{version.version_patch}"


def _frame(messages: Any, dataset: Dataset, scene: int, one: Any, numbers: dict[str, int]) -> Any:
    """The SensorData of one frame. numbers: of the road users of its scene"""
    found, stored = detections_of(dataset, one), dataset.sequence(scene)
    time = stored.radar.middle_of_frame(float(stored.times[one.place]))
    message = messages.SensorData()
    _set_version(message.version)
    _set_time(message.timestamp, time)
    message.sensor_id.value = SENSOR
    radar = message.feature_data.radar_sensor.add()
    world = np.array(stored.radar.world_from_radar(time))
    world[:3, 3] = middle_of_antennas(stored.radar, time)
    for header in (message, radar.header):
        _set_pose(header.mounting_position, world)
    _set_time(radar.header.measurement_time, time)
    radar.header.cycle_counter, radar.header.number_of_valid_detections = one.place, len(found)
    radar.header.sensor_id.value = SENSOR
    radar.header.data_qualifier = 2  # available
    _add_detections(radar, found, cross_sections_dbsm(found, stored.radar, time), numbers)
    return message


def _numbers(dataset: Dataset, scene: int) -> dict[str, int]:
    """{name: place} of the road users among the objects of a scene."""
    classes = dataset.classes(scene)
    return {name: place for place, (name, kind) in enumerate(classes.items()) if kind != "static"}


def _add_detections(radar: Any, found: Detections, cross_sections: np.ndarray, numbers: dict[str, int]) -> None:
    """cross_sections: [D] dBsm; numbers: {name: place} of the objects that have one"""
    for index, is_echo in enumerate(are_echoes(found).tolist()):
        one = radar.detection.add()
        one.position.distance, one.position.azimuth = float(found.range[index]), float(found.azimuth[index])
        one.position.elevation = float(np.nan_to_num(found.elevation[index]))
        one.radial_velocity, one.rcs = float(found.velocity[index]), float(cross_sections[index])
        one.snr = float(found.snr_db[index])
        one.object_id.value = numbers.get(str(found.object[index]), NO_OBJECT)
        one.existence_probability = 1.0 if is_echo else 0.0
        one.classification = _CLUTTER if not is_echo else _INVALID if found.ghost_type[index] else _OTHER


def _set_version(version: Any) -> None:
    module = _module("version")
    version.CopyFrom(module.DESCRIPTOR.GetOptions().Extensions[module.current_interface_version])


def _set_time(timestamp: Any, time: float) -> None:
    nanoseconds = round(time * 1e9)
    timestamp.seconds, timestamp.nanos = divmod(nanoseconds, 10 ** 9)


def _set_pose(position: Any, world: np.ndarray) -> None:
    """Sets a MountingPosition: origin in m, and the angles of R = Rz(yaw) Ry(pitch) Rx(roll) in rad."""
    position.position.x, position.position.y, position.position.z = (float(value) for value in world[:3, 3])
    position.orientation.yaw = float(np.arctan2(world[1, 0], world[0, 0]))
    position.orientation.pitch = float(np.arcsin(np.clip(-world[2, 0], -1.0, 1.0)))
    position.orientation.roll = float(np.arctan2(world[2, 1], world[2, 2]))
