"""Detections of datasets as messages of ASAM OSI, the Open Simulation Interface (asam.net/standards/detail/osi)."""
from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import Any

import numpy as np

from ...arguments.checks import checked, path as folder_rule
from ...base.process.libraries import load_whole, needed_module
from ...base.radar.antennas import centre_of
from ...base.storage.files import written_whole
from ...detections.detections import Detections
from ..opened import Dataset, dataset_rule
from . import are_echoes, cross_sections_dbsm, detections_of, exported
from .osi_ground_truth import set_host, set_pose, set_road_user

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
    The host vehicle's frame is that of the radar. Each message has
    mounting_position, also in the header of the sensor: in the host vehicle's frame, between transmitters and receivers, from
        where detections count (`Detections.centre`), with the radar's axes
    feature_data.radar_sensor: one, with measurement_time in the middle of the frame, cycle_counter the place of the frame, and
        detections: position (distance m, azimuth and elevation rad, left and up positive, in the sensor's frame),
        radial_velocity (m/s, as measured, approaching positive, as OSI has it), rcs (dBsm, by the radar equation with the gains
        of the first antennas, NaN of leakage and nearer than a wavelength), snr (dB), object_id (of a road user of the ground
        truth, the same in all frames of a scene; 2^64 - 1: the surroundings or noise), existence_probability 0 of noise and of
        what comes in beside the echoes (interference, rain, leakage, residue), 1 of echoes; classification OTHER of real
        echoes, INVALID of ghosts, CLUTTER of what has probability 0. number_of_valid_detections: those that are not INVALID
    sensor_view.global_ground_truth: the host vehicle (host_vehicle_id; place, angles and their rates in the world, a point)
        and all road users of the scene: id (place in `Dataset.classes`), type and vehicle_classification by their classes,
        source_reference.identifier with the name of the object, and where the template has [truth], base with the box, its
        place, angles and motion in the world, for those that are there in the frame
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
    return needed_module(f"osi3.osi_{name}_pb2", "write_osi", library="osi-python", extra="osi")


def _protobuf() -> str:
    return "".join(load_whole("google.protobuf").__version__.split("."))


def _version_text(version: Any) -> str:
    return f"{version.version_major}{version.version_minor}{version.version_patch}"


def _frame(messages: Any, dataset: Dataset, scene: int, one: Any, numbers: dict[str, int]) -> Any:
    """The SensorData of one frame. numbers: of the road users of its scene"""
    found, stored = detections_of(dataset, one), dataset.sequence(scene)
    time = stored.radar.middle_of_frame(float(stored.times[one.place]))
    mount = np.eye(4)
    mount[:3, 3] = centre_of(stored.radar)
    message = messages.SensorData()
    radar, view = message.feature_data.radar_sensor.add(), message.sensor_view.add()
    for own in (message, view):
        _set_version(own.version)
        _set_time(own.timestamp, time)
        own.sensor_id.value = SENSOR
    for mounted in (message, view, radar.header):
        set_pose(mounted.mounting_position, mount)
    _set_time(message.last_measurement_time, time)
    _set_time(radar.header.measurement_time, time)
    radar.header.cycle_counter, radar.header.sensor_id.value = one.place, SENSOR
    radar.header.data_qualifier = 2  # available
    _add_detections(radar, found, cross_sections_dbsm(found, stored.radar, time), numbers)
    radar.header.number_of_valid_detections = sum(each.classification != _INVALID for each in radar.detection)
    _set_ground_truth(view, dataset, scene, one, numbers, time)
    return message


def _set_ground_truth(view: Any, dataset: Dataset, scene: int, one: Any, numbers: dict[str, int], time: float) -> None:
    """Fills global_ground_truth of a SensorView, whose version and time are set."""
    classes, truth, known = dataset.classes(scene), one.frame.kept_truth, view.global_ground_truth
    known.version.CopyFrom(view.version)
    known.timestamp.CopyFrom(view.timestamp)
    host = known.moving_object.add()
    set_host(host, dataset.sequence(scene).radar, time)
    for identifier in (view.host_vehicle_id, known.host_vehicle_id, host.id):
        identifier.value = len(classes)  # the first number that no object has
    for name, number in numbers.items():
        user = known.moving_object.add()
        user.id.value = number
        is_told = truth is not None and name in truth.name
        set_road_user(user, name, classes[name], truth.of_object(name) if is_told else None)


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
        one.radial_velocity, one.rcs = -float(found.velocity[index]), float(cross_sections[index])
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
