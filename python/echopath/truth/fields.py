"""The fields of Truth: names of their columns in tables, units, and dimensions of their arrays."""
from __future__ import annotations

from typing import NamedTuple

XYZ = ("x", "y", "z")
SIDES = ("length", "width", "height")


class Field(NamedTuple):
    """columns: in tables; unit: "" of what is none; dims: those of its arrays beside frame and object."""

    columns: tuple[str, ...]
    unit: str = ""
    dims: tuple[str, ...] = ()


def _vector(columns, unit: str = "") -> Field:
    return Field(columns, unit, ("axis",))


def _rotation(prefix: str) -> Field:
    return Field(tuple(f"{prefix}_{row}{column}" for row in XYZ for column in XYZ), "", ("axis", "side"))


# In the order of the columns of a table.
FIELDS = {
    "frame": Field(("frame",)), "time": Field(("time",), "s"), "name": Field(("name",)),
    "position": _vector(XYZ, "m"), "velocity": _vector(("vx", "vy", "vz"), "m/s"), "heading": Field(("heading",), "rad"),
    "size": Field(SIDES, "m", ("side",)), "yaw": Field(("yaw",), "rad"),
    "angular_velocity": _vector(("angular_velocity_x", "angular_velocity_y", "angular_velocity_z"), "rad/s"),
    "origin": _vector(("origin_x", "origin_y", "origin_z"), "m"),
    "position_in_radar": _vector(("radar_x", "radar_y", "radar_z"), "m"),
    "velocity_in_radar": _vector(("radar_vx", "radar_vy", "radar_vz"), "m/s"), "yaw_in_radar": Field(("radar_yaw",), "rad"),
    "range": Field(("range",), "m"), "azimuth": Field(("azimuth",), "rad"), "elevation": Field(("elevation",), "rad"),
    "radial_velocity": Field(("radial_velocity",), "m/s"), "visible_share": Field(("visible_share",)),
    "received": Field(("received",), "W"), "rcs": Field(("rcs",), "m^2"), "rcs_low": Field(("rcs_low",), "m^2"),
    "rcs_high": Field(("rcs_high",), "m^2"), "rotation": _rotation("rotation"), "rotation_in_radar": _rotation("radar_rotation"),
    "direction_in_radar": _vector(("radar_direction_x", "radar_direction_y", "radar_direction_z"))}
UNITS = {column: field.unit for field in FIELDS.values() for column in field.columns if field.unit}
