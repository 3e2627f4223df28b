"""Tables of motions and trajectories, which radars and objects have."""
from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ...trajectories.arguments import GOES_ON, NEAREST, SPACING, Outside, checked_points, checked_stops, checked_times
from ...trajectories.trajectory import ACCELERATION, DECELERATION
from .table import Number, Positive, Quaternion, Table, Vector3, broken_rule, by_check, by_kind


class LinearMotionTable(Table):
    kind: Literal["linear"] = Field(description="constant velocity and rotation")
    velocity: Vector3 = Field([0.0, 0.0, 0.0], description="m/s")
    angular_velocity: Vector3 = Field([0.0, 0.0, 0.0], description="rad/s, right-handed about its direction")


class KeyframeMotionTable(Table):
    kind: Literal["keyframes"] = Field(description="sampled positions and orientations")
    times: list[Number] = Field(min_length=2, description="s, ascending")
    translations: list[Vector3] | None = Field(None, description="m, one per time")
    rotations: list[Quaternion] | None = Field(None, description="quaternions w, x, y, z, one per time")
    interpolation: Literal["cubic", "linear", "monotone"] = Field("cubic", description="between the times")


MotionTable = Annotated[
    Annotated[LinearMotionTable, Tag("<linear>")] | Annotated[KeyframeMotionTable, Tag("<keyframes>")],
    Discriminator(by_kind("kind"))]


GoesOn = Annotated[Any, by_check(GOES_ON)]
OF_FILE = ("id", "goes_on", "outside")  # keys beside a trajectory that is a file


class TrajectoryTable(Table):
    points: Annotated[Any, by_check(checked_points)] = Field(description="m, an array of [x, y] or [x, y, z]")
    speed: Any = Field(None, description="m/s, or an array of [m or s, m/s]; with times: m/s, one per time")
    times: Annotated[Any, by_check(checked_times)] | None = Field(None, description="s, one per point, ascending")
    yaw_deg: list[Number] | None = Field(None, description="degrees, one per time; none: along the path")
    spacing: Annotated[Any, by_check(SPACING)] = Field(NEAREST, description="m, with times: of points that near only the first "
                                                                           "tells where the path goes")
    turn_radius: Positive | None = Field(None, description="m, straight lines joined by arcs; none: a spline")
    stops: Annotated[Any, by_check(checked_stops)] = Field((), description="an array of [m, waiting time in s]")
    acceleration: Positive = Field(ACCELERATION, description="m/s^2, by which it leaves its stops")
    deceleration: Positive = Field(DECELERATION, description="m/s^2, by which it reaches them")
    lateral_acceleration: Positive | None = Field(None, description="m/s^2, at most, in curves; none: any")
    speed_over: Literal["distance", "time"] = Field("distance", description="what the first column of speed counts")
    start_time: Number = Field(0.0, description="s, at the first point")
    goes_on: GoesOn = Field(0.0, description="s, straight on before its begin and after its end")
    outside: Outside = Field("stands", description="whether it stands there or is \"absent\" before and after that")
    pitch: bool = Field(False, description="its nose follows the slope of the path")


TrajectoryValue = Annotated[
    Annotated[str, Tag("<file>")] | Annotated[TrajectoryTable, Tag("<table>")],
    Discriminator(lambda value: "<file>" if isinstance(value, str) else "<table>")]


def one_motion(table):
    """Raises where a table has several motions, or keys of a trajectory of a file without a file."""
    given = [key for key in ("motion", "speed", "trajectory", "rides_on") if getattr(table, key, None) is not None]
    if len(given) > 1:
        raise broken_rule(given[1], f"must not stand beside {given[0]}", getattr(table, given[1]))
    for key in OF_FILE:
        if getattr(table, key, None) is not None and not isinstance(table.trajectory, str):
            raise broken_rule(key, "needs a trajectory that is a file", getattr(table, key))
    return table
