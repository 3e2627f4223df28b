"""The fields of Truth: names of their columns in tables, units, and dimensions of their arrays."""
from __future__ import annotations

from typing import NamedTuple

XYZ = ("x", "y", "z")
SIDES = ("length", "width", "height")


class Field(NamedTuple):
    """columns: in tables; unit: "" of what is none; dims: those of its arrays beside frame and object; meaning: in few words."""

    columns: tuple[str, ...]
    unit: str = ""
    dims: tuple[str, ...] = ()
    meaning: str = ""


def _number(column: str, unit: str, meaning: str) -> Field:
    return Field((column,), unit, (), meaning)


def _vector(columns, unit: str, meaning: str) -> Field:
    return Field(columns, unit, ("axis",), meaning)


def _rotation(prefix: str, meaning: str) -> Field:
    return Field(tuple(f"{prefix}_{row}{column}" for row in XYZ for column in XYZ), "", ("axis", "side"), meaning)


# In the order of the columns of a table.
FIELDS = {
    "frame": Field(("frame",)), "time": Field(("time",), "s"), "name": Field(("name",)),
    "position": _vector(XYZ, "m", "centre of the box, in the world"),
    "velocity": _vector(("vx", "vy", "vz"), "m/s", "velocity of the box, in the world"),
    "heading": _number("heading", "rad", "direction of the horizontal velocity, left positive from the world's x"),
    "size": Field(SIDES, "m", ("side",), "sides of the box along its own axes"),
    "yaw": _number("yaw", "rad", "where the box's own x points, left positive from the world's x"),
    "angular_velocity": _vector(("angular_velocity_x", "angular_velocity_y", "angular_velocity_z"), "rad/s",
                                "turning of the box's axes, in the world"),
    "origin": _vector(("origin_x", "origin_y", "origin_z"), "m", "the object's own origin, in the world"),
    "position_in_radar": _vector(("radar_x", "radar_y", "radar_z"), "m", "centre of the box, in the radar's frame"),
    "velocity_in_radar": _vector(("radar_vx", "radar_vy", "radar_vz"), "m/s", "rate of the centre, in the radar's frame"),
    "yaw_in_radar": _number("radar_yaw", "rad", "where the box's own x points, left positive from the radar's x"),
    "range": _number("range", "m", "of the box's centre from between transmitters and receivers"),
    "azimuth": _number("azimuth", "rad", "of the box's centre, left positive from the radar's x"),
    "elevation": _number("elevation", "rad", "of the box's centre, up positive from the radar's xy-plane"),
    "radial_velocity": _number("radial_velocity", "m/s", "rate of the range, receding positive"),
    "visible_share": _number("visible_share", "", "of the solid angle alone, what nothing hides"),
    "received": _number("received", "W", "mean power of the direct echoes"),
    "rcs": _number("rcs", "m^2", "radar cross section as seen"),
    "rcs_low": _number("rcs_low", "m^2", "lower end of the 95 % interval of rcs"),
    "rcs_high": _number("rcs_high", "m^2", "upper end of the 95 % interval of rcs"),
    "rotation": _rotation("rotation", "world_from_box"), "rotation_in_radar": _rotation("radar_rotation", "radar_from_box"),
    "direction_in_radar": _vector(("radar_direction_x", "radar_direction_y", "radar_direction_z"), "",
                                  "unit vector of the velocity over ground, in the radar's frame")}
UNITS = {column: field.unit for field in FIELDS.values() for column in field.columns if field.unit}
