"""Tables of objects and their materials."""
from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag, model_validator

from ...arguments.checks import carrier, positive
from ...trajectories.arguments import Outside
from .actor_keywords import has_parameter
from .motion_tables import GoesOn, MotionTable, TrajectoryValue, one_motion
from .table import Lifetime, Matrix4, Name, NotNegative, Number, Positive, Table, Vector3, broken_rule, by_check, is_number


def _permittivity(value):
    pair = isinstance(value, list) and len(value) == 2 and all(map(is_number, value))
    if not (pair or is_number(value)):
        raise ValueError("must be a number eps' or a pair [eps', eps''] for eps' - j eps''")
    if pair and value[1] < 0:
        raise ValueError("is [eps', eps''] for eps' - j eps'': eps'' must not be negative")
    return value


Permittivity = Annotated[Any, AfterValidator(_permittivity)]


class LayerTable(Table):
    thickness: Positive = Field(description="m")
    permittivity: Permittivity = Field(description="relative; eps' or [eps', eps''] for eps' - j eps''")
    conductivity: NotNegative = Field(0.0, description="S/m")


class MaterialTable(Table):
    conductor: bool = Field(False, description="perfect conductor")
    permittivity: Permittivity | None = Field(None, description="relative; eps' or [eps', eps''] for eps' - j eps''")
    conductivity: NotNegative = Field(0.0, description="S/m")
    reflectivity: Annotated[float, Field(ge=0, le=1)] | None = Field(
        None, description="share of power, at every angle")
    layers: list[LayerTable] = Field(
        (), min_length=1, description="of a sheet that waves pass, from the side of the surface's normals on")
    roughness_height: NotNegative = Field(0.0, description="m, rms")
    scattering: Annotated[float, Field(ge=0, le=1)] | None = Field(
        None, description="S; S^2 is the diffuse share of reflected power")
    cross_polarization: Annotated[float, Field(ge=0, le=0.5)] = Field(
        0.0, description="share of diffuse power in the cross polarisation")
    mirror: bool = Field(False, description="a plane larger than its Fresnel zone, treated by images")
    lobe_exponent: Annotated[int, Field(ge=0, le=100)] = Field(0, description="of the diffuse lobe; 0: Lambert's")
    backscatter_share: Annotated[float, Field(ge=0, le=1)] = Field(0.0, description="of the lobe")
    backscatter_exponent: Annotated[int, Field(ge=0, le=100)] = Field(0, description="of that part; 0: as lobe_exponent")
    base: str | None = Field(None, description="name of a known material that gives the other keys")
    frequency: Annotated[Any, by_check(carrier)] | None = Field(None, description="Hz, of the values of the base; none: 77 GHz")

    @model_validator(mode="after")
    def _frequency_has_a_base(self):
        if self.frequency is not None and self.base is None:
            raise broken_rule("frequency", "needs a base, whose values it chooses", self.frequency)
        return self


MaterialValue = Annotated[
    Annotated[str, Tag("<name>")] | Annotated[MaterialTable, Tag("<table>")],
    Discriminator(lambda value: "<name>" if isinstance(value, str) else "<table>")]


# arguments of load_model that are keys of an object
MODEL_KEYS = ("unit", "up", "animation", "loop", "offset", "smooth", "frequency")


def _way(argument: str, value):
    return value if value == "auto" else positive("m, or \"auto\"")(argument, value)


class ModelKeys(Table):
    """How a foreign file is read and played, where a table names one."""

    model: str | None = Field(None, description="foreign scene or object, what load_model reads, relative to the scene file")
    unit: Positive | None = Field(None, description="m, length of one unit of mesh or model; none: 1, or as the model says")
    up: Literal["x", "y", "z"] | None = Field(None, description="vertical axis of the model; none: as it says")
    materials: dict[str, MaterialValue] = Field({}, description="names in the model, or patterns of them = material")
    animation: str | None = Field(None, description="of the model, by its name; none: the first, \"\": at rest")
    loop: bool | None = Field(None, description="whether the animation begins anew at its end; none: it does not")
    offset: Number | None = Field(None, description="s, time of the animation at time 0 of the scene; none: 0")
    frequency: Annotated[Any, by_check(carrier)] | None = Field(None, description="Hz, of the materials of a model; none: 77 GHz")
    way: Annotated[Any, by_check(_way)] | None = Field(
        None, description="m of the trajectory in which a looped animation is played once, \"auto\": as its feet or itself say")
    smooth: bool | None = Field(None, description="the mesh stands for a curved surface; none: it does not, a model as it says")


class ObjectTable(ModelKeys):
    name: Name = Field(description="its name in path expressions")
    mesh: str | None = Field(None, description="OBJ, PLY, STL or OFF file, relative to the scene file")
    actor: str | None = Field(None, description="a ready-made object: a function of echopath.actors")
    group: bool = Field(False, description="true, instead: no shape of its own, it carries those that name it as parent")
    parameters: dict = Field({}, description="keywords of the actor")
    material: MaterialValue | None = Field(None, description="a known name or a table")
    position: Vector3 | None = Field(None, description="m")
    yaw_deg: Number | None = Field(None, description="degrees about z")
    transform: Matrix4 | None = Field(None, description="4 x 4, instead of position and yaw_deg")
    motion: MotionTable | None = Field(None, description="in the axes of the parent; none: it stands still")
    speed: Number | None = Field(None, description="m/s straight ahead, along its own +x, instead of motion")
    trajectory: TrajectoryValue | None = Field(None, description="a table or a file, instead of motion")
    id: str | None = Field(None, description="of the object of the file; none: its only one")
    goes_on: GoesOn | None = Field(None, description="s, straight on before the begin and after the end of that; none: 0")
    outside: Outside | None = Field(None, description="likewise: it \"stands\" or is absent; none: absent")
    parent: str | None = Field(None, description="full name of the node that carries it; none: the scene")
    visible: bool = Field(True, description="false: it takes no part in anything until it is shown")
    lifetime: Lifetime | None = Field(None, description="[begin, end] s, of the frames that it is in; none: all")

    @classmethod
    def _advice(cls, key: str, data: dict) -> str:
        if key in ("file", "path"):
            return "an object names its file by mesh (OBJ, PLY, STL, OFF) or model"
        return f"actors have it in parameters = {{{key} = ...}}" if has_parameter(data.get("actor"), key) else ""

    @model_validator(mode="after")
    def _one_shape(self):
        if [self.mesh, self.model, self.actor, self.group or None].count(None) != 3:
            raise broken_rule("mesh", "exactly one of mesh, model, actor and group must be given", self.mesh)
        for key in ("material", "smooth"):
            if self.group and getattr(self, key) is not None:
                raise broken_rule(key, "must not be given for a group, whose parts have theirs", getattr(self, key))
        if self.way is not None and (self.model is None or self.trajectory is None):
            raise broken_rule("way", "needs a model with a trajectory", self.way)
        if self.unit is not None and self.mesh is None and self.model is None:
            raise broken_rule("unit", "needs a mesh or a model", self.unit)
        for key in ("up", "materials", "animation", "loop", "offset", "frequency"):
            if self.model is None and getattr(self, key) not in (None, {}):
                raise broken_rule(key, "needs a model", getattr(self, key))
        if self.parameters and self.actor is None:
            raise broken_rule("parameters", "needs an actor", self.parameters)
        return self

    @model_validator(mode="after")
    def _one_placement(self):
        if self.transform is not None and (self.position is not None or self.yaw_deg is not None):
            raise broken_rule("transform", "must not stand beside position or yaw_deg", self.transform)
        return self

    _one_motion = model_validator(mode="after")(one_motion)
