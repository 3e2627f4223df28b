"""Tables of traffic: files of many trajectories, and what goes along them."""
from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, Discriminator, Field, Tag, model_validator

from ...trajectories.arguments import GOES_ON, Outside
from ...trajectories.files.track_file import length_rule
from .object_tables import ModelKeys
from .table import Name, NotNegative, Number, Table, Vector3, broken_rule, by_check


class TrafficActorTable(Table):
    actor: str = Field(description="a function of echopath.actors that takes a trajectory")
    parameters: dict = Field({}, description="keywords of the actor")


class TrafficModelTable(ModelKeys):
    """A foreign file that goes along trajectories: its meshes are shared by all that are of the type."""

    model: str = Field(description="a file that load_model reads, relative to the scene file")
    position: Vector3 = Field((0.0, 0.0, 0.0), description="m, of its origin from the middle of what goes along, x ahead")
    yaw_deg: Number = Field(0.0, description="degrees about z, so that it looks ahead")


def _value_kind(value) -> str:
    if isinstance(value, (str, bool)):
        return "<name>" if isinstance(value, str) else "<none>"
    is_model = isinstance(value, TrafficModelTable) or isinstance(value, dict) and "model" in value
    return "<model>" if is_model else "<table>"


TrafficActorValue = Annotated[
    Annotated[str, Tag("<name>")] | Annotated[bool, Tag("<none>")] | Annotated[TrafficActorTable, Tag("<table>")] | Annotated[
        TrafficModelTable, Tag("<model>")], Discriminator(_value_kind)]


def _no_true(value):
    if value is True:
        raise ValueError("must be the name of an actor, a table of an actor or a model, or false: no object")
    return value


class TrafficTable(Table):
    file: str = Field(min_length=1, description="of trajectories, as read_trajectories reads it, relative to the scene file")
    exclude: list[Name] = Field([], description="globs of ids that are left out, such as the car that carries the radar")
    during: list[Number] | None = Field(
        None, min_length=2, max_length=2,
        description="s, [begin, end]: who is on its way at no time of it is left out; none: all")
    actors: dict[Name, Annotated[TrafficActorValue, AfterValidator(_no_true)]] = Field(
        {}, description="globs of the types of the file = actor or model, or false: no object; others as usual")
    position: Vector3 = Field([0.0, 0.0, 0.0], description="m, of the origin of the file")
    yaw_deg: Number = Field(0.0, description="degrees about z, of the +x of the file")
    origin: list[Number] | None = Field(None, description="[latitude, longitude] in degrees, or with a height in m; none: the "
                                                          "first position")
    smoothing: NotNegative = Field(0.0, description="m, rms, by which positions may be moved")
    vehicle_length: Annotated[Any, by_check(length_rule)] | None = Field(
        None, description="m, or {type = m}, by half of which fronts are before middles; none: those of the usual actors")
    goes_on: Annotated[Any, by_check(GOES_ON)] = Field(0.0, description="s, straight on before the begin and after the end")
    outside: Outside = Field("absent", description="nobody is there before and after that, or \"stands\"")

    @model_validator(mode="after")
    def _in_order(self):
        if self.during is not None and self.during[0] > self.during[1]:
            raise broken_rule("during", "must be [begin, end] in s, the end not before the begin", self.during)
        return self
