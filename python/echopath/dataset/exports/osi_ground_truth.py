"""What messages of ASAM OSI call ground truth: the host vehicle, which carries the radar, and the road users about it."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...base.numerics.rates import radar_rate
from ...base.numerics.rotations import angular_velocity
from ...truth.record import Truth
from ..classes import ClassName

SOURCE = "echopath"  # whose names of objects `source_reference` has
_OTHER, _VEHICLE, _PEDESTRIAN, _ANIMAL = 1, 2, 3, 4  # MovingObject.Type
_TYPES: dict[ClassName, int] = {"pedestrian": _PEDESTRIAN, "pedestrian_group": _PEDESTRIAN, "animal": _ANIMAL, "other": _OTHER}
_VEHICLES: dict[ClassName, int] = {"car": 4, "van": 6, "truck": 7, "motorcycle": 10, "cyclist": 11, "bus": 12, "train": 14}
_NO_VEHICLE_OF_THESE = 1  # VehicleClassification.Type, as the numbers of _VEHICLES are
_UPRIGHT = 1e-9  # cosine of the pitch below which something looks straight up or down: roll and yaw are then one turn


def set_host(host: Any, radar: Any, time: float) -> None:
    """Fills the MovingObject of the host vehicle, whose frame is that of the radar: a point at the origin of its axes."""
    world, rate = np.array(radar.world_from_radar(time)), radar_rate(radar, time)
    set_pose(host.base, world)
    _set_motion(host.base, world[:3, :3], rate[:3, 3], angular_velocity(world[:3, :3], rate[:3, :3]))
    _set_vector(host.vehicle_attributes.bbcenter_to_rear, np.zeros(3))
    host.type, host.vehicle_classification.type = _VEHICLE, _NO_VEHICLE_OF_THESE


def set_road_user(message: Any, name: str, kind: ClassName, truth: Truth | None) -> None:
    """Fills the MovingObject of an object. truth: of the object in the frame, a row, or none where it is not there; None: the
    template has no [truth]"""
    source = message.source_reference.add()
    source.type = SOURCE
    source.identifier.append(name)
    message.type = _TYPES.get(kind, _VEHICLE)
    if message.type == _VEHICLE:
        message.vehicle_attributes.SetInParent()
        message.vehicle_classification.type = _VEHICLES[kind]
    if truth is not None and len(truth):
        base = message.base
        base.dimension.length, base.dimension.width, base.dimension.height = truth.size[0].tolist()
        world = np.eye(4)
        world[:3, :3], world[:3, 3] = truth.rotation[0], truth.position[0]
        set_pose(base, world)
        _set_motion(base, truth.rotation[0], truth.velocity[0], truth.angular_velocity[0])


def set_pose(message: Any, pose: NDArray[np.float64]) -> None:
    """Sets position in m and the angles in rad of R = Rz(yaw) Ry(pitch) Rx(roll) of a [4, 4] pose."""
    _set_vector(message.position, pose[:3, 3])
    yaw, pitch, roll = _angles(pose[:3, :3])
    message.orientation.yaw, message.orientation.pitch, message.orientation.roll = yaw, pitch, roll


def _set_motion(base: Any, rotation: NDArray[np.float64], velocity: NDArray[np.float64],
                angular_velocity: NDArray[np.float64]) -> None:
    """Sets the velocity in m/s and the rates of the angles in rad/s; both vectors [3] in world axes."""
    _set_vector(base.velocity, velocity)
    yaw, pitch, _ = _angles(rotation)
    ahead = angular_velocity @ [np.cos(yaw), np.sin(yaw), 0.0]  # about the level axis below the object's own x
    roll_rate = float(ahead / np.cos(pitch)) if np.cos(pitch) > _UPRIGHT else 0.0
    base.orientation_rate.roll = roll_rate
    base.orientation_rate.pitch = float(angular_velocity @ [-np.sin(yaw), np.cos(yaw), 0.0])
    base.orientation_rate.yaw = float(angular_velocity[2] + np.sin(pitch) * roll_rate)


def _angles(rotation: NDArray[np.float64]) -> tuple[float, float, float]:
    """(yaw, pitch, roll) in rad; what looks straight up or down has the roll 0."""
    level = np.hypot(rotation[0, 0], rotation[1, 0])
    pitch = float(np.arctan2(-rotation[2, 0], level))
    if level < _UPRIGHT:
        return float(np.arctan2(-rotation[0, 1], rotation[1, 1])), pitch, 0.0
    return float(np.arctan2(rotation[1, 0], rotation[0, 0])), pitch, float(np.arctan2(rotation[2, 1], rotation[2, 2]))


def _set_vector(message: Any, values: NDArray[np.float64]) -> None:
    message.x, message.y, message.z = (float(value) for value in values)
