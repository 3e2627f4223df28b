"""The keys of a scene file: one class per table, units in the description of each field.

Strict: unknown keys, numbers given as text and non-finite numbers are errors. Lengths in m, times in s, angles in
degrees only where the key says so (`yaw_deg`).
"""
from __future__ import annotations

import difflib
import sys
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from .. import _core
from ..arguments.checks import Rule, map_window, positive, window
from ..arguments.effects import effects_rule
from ..arguments.gates import gate
from ..arguments.settings import (
    MOST_BATCHES, MOST_BOUNCES, MOST_RAYS, Edges, Evaluate, Footprint, LabelSettings, Plane, Polarization, Replay, Retrace,
    Sampler,
    Scatterers, SignalSettings, TraceSettings,
)
from ..arguments.shown import writable
from ..receiver.settings import receiver_rule
from ..scene.interferers import Over
from ..signals.parts import are_tables
from ..spectra.range_doppler import FALSE_ALARM_RATE, RANK, CfarMethod
from ..trajectories.arguments import checked_points, checked_stops, checked_times
from ..trajectories.trajectory import ACCELERATION, DECELERATION
from ..weather import Weather

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Pitch = Annotated[float, Field(ge=-90, le=90, allow_inf_nan=False)]
Vector3 = Annotated[list[Number], Field(min_length=3, max_length=3)]
Quaternion = Annotated[list[Number], Field(min_length=4, max_length=4)]
Matrix4 = Annotated[list[Quaternion], Field(min_length=4, max_length=4)]


def nearest_key(key: str, candidates) -> str:
    """What to say about an unknown key: the nearest known one, or all of them when none is near."""
    candidates = list(candidates)
    near = _core.meant_name(writable(key), candidates) or next(
        iter(difflib.get_close_matches(key.lower(), candidates, n=1, cutoff=0.5)), "")
    if near:
        return f"did you mean '{near}'?"
    return "known keys: " + ", ".join(candidates)


def _is_number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def _permittivity(value):
    pair = isinstance(value, list) and len(value) == 2 and all(map(_is_number, value))
    if not (pair or _is_number(value)):
        raise ValueError("must be a number eps' or a pair [eps', eps''] for eps' - j eps''")
    if pair and value[1] < 0:
        raise ValueError("is [eps', eps''] for eps' - j eps'': eps'' must not be negative")
    return value


def by_check(check: Rule) -> AfterValidator:
    """Holds a value to the rule of an argument, and says of a wrong one what the call would, behind the key."""
    def checked(value):
        try:
            return check("", value)
        except (TypeError, ValueError) as error:
            raise PydanticCustomError("refused", "{told}", {"told": str(error)}) from None
    return AfterValidator(checked)


Permittivity = Annotated[Any, AfterValidator(_permittivity)]
Window = Annotated[Any, by_check(window)]
MapWindow = Annotated[Any, by_check(map_window)]


class Table(BaseModel):
    """A TOML table: only known keys, strict types."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, arbitrary_types_allowed=True)

    @model_validator(mode="before")
    @classmethod
    def _know_every_key(cls, data):
        if isinstance(data, dict):
            known = cls.model_fields
            for key in data:
                if key not in known:
                    advice = nearest_key(key, known)
                    raise PydanticCustomError("unknown_key", "unknown key; {advice}", {"key": key, "advice": advice})
        return data


def broken_rule(key: str, rule: str, value=None) -> PydanticCustomError:
    """An error of several keys together, reported at `key` of the table that raises it."""
    return PydanticCustomError("broken_rule", "{rule}", {"key": key, "rule": rule, "value": value})


def by_kind(kind: str):
    """Chooses the table of a union by its key `kind`."""
    def tag(data):
        return f"<{data.get(kind)}>" if isinstance(data, dict) else None
    return tag


def _name(value: str) -> str:
    if "\0" in value:
        raise ValueError("must not hold a NUL character")
    return value


Name = Annotated[str, Field(min_length=1), AfterValidator(_name)]


class WaveformTable(Table):
    start_frequency: Positive = Field(description="Hz, at the first sample")
    bandwidth: Positive = Field(description="Hz, what the samples of one chirp sweep")
    num_samples: int = Field(ge=1, description="per chirp")
    sampling_rate: Positive = Field(description="Hz")
    num_chirps: int = Field(ge=1, description="per transmitter")
    chirp_interval: Positive = Field(description="s, between neighbouring slots")
    real: bool = Field(False, description="real instead of complex samples")
    extra_idle: list[NotNegative] = Field([], description="s, after each slot, repeated over the slots")
    frequency_steps: list[Number] = Field([], description="Hz, of each slot, likewise")
    bandwidth_steps: list[Number] = Field([], description="Hz, of each slot, likewise")


class IsotropicTable(Table):
    kind: Literal["isotropic"] = Field(description="the same gain in every direction")
    gain: Positive = Field(1.0, description="power gain, linear")


class CosinePowerTable(Table):
    kind: Literal["cosine_power"] = Field(description="gain ~ cos^exponent of the angle from boresight, 0 behind")
    exponent: NotNegative = Field(description="of the power gain")
    peak_gain: Positive | None = Field(None, description="power gain, linear; none: of a lossless antenna")


class GainFileTable(Table):
    kind: Literal["table"] = Field(description="gain, and phase where given, sampled over direction")
    file: str = Field(min_length=1, description="CSV file (echopath.load_antenna), relative to the scene file")
    normalize: bool = Field(False, description="scales the gain to a mean of 1 over the sphere, as without losses")


PatternTable = Annotated[
    Annotated[IsotropicTable, Tag("<isotropic>")] | Annotated[CosinePowerTable, Tag("<cosine_power>")] |
    Annotated[GainFileTable, Tag("<table>")],
    Discriminator(by_kind("kind"))]


class AntennaTable(Table):
    position: Vector3 = Field(description="m, in the radar's frame")
    orientation: Quaternion | None = Field(None, description="quaternion w, x, y, z; boresight is its +x")
    yaw_deg: Number | None = Field(None, description="degrees about z, left positive, instead of orientation")
    pitch_deg: Pitch | None = Field(None, description="degrees, up positive, instead of orientation")
    pattern: PatternTable | None = Field(None, description="none: that of [radar]")
    polarization: Vector3 | None = Field(None, description="in the antenna's frame; none: that of [radar]")

    @model_validator(mode="after")
    def _one_direction(self):
        for key in ("yaw_deg", "pitch_deg"):
            if self.orientation is not None and getattr(self, key) is not None:
                raise broken_rule(key, "must not stand beside orientation", getattr(self, key))
        return self


class LinearMotionTable(Table):
    kind: Literal["linear"] = Field(description="constant velocity and rotation")
    velocity: Vector3 = Field([0.0, 0.0, 0.0], description="m/s")
    angular_velocity: Vector3 = Field([0.0, 0.0, 0.0], description="rad/s, right-handed about its direction")


class KeyframeMotionTable(Table):
    kind: Literal["keyframes"] = Field(description="sampled positions and orientations")
    times: list[Number] = Field(min_length=2, description="s, ascending")
    translations: list[Vector3] | None = Field(None, description="m, one per time")
    rotations: list[Quaternion] | None = Field(None, description="quaternions w, x, y, z, one per time")
    interpolation: Literal["cubic", "linear"] = Field("cubic", description="between the times")


MotionTable = Annotated[
    Annotated[LinearMotionTable, Tag("<linear>")] | Annotated[KeyframeMotionTable, Tag("<keyframes>")],
    Discriminator(by_kind("kind"))]


class TrajectoryTable(Table):
    points: Annotated[Any, by_check(checked_points)] = Field(description="m, an array of [x, y] or [x, y, z]")
    speed: Any = Field(None, description="m/s, or an array of [m or s, m/s]; with times: m/s, one per time")
    times: Annotated[Any, by_check(checked_times)] | None = Field(None, description="s, one per point, ascending")
    yaw_deg: list[Number] | None = Field(None, description="degrees, one per time; none: along the path")
    turn_radius: Positive | None = Field(None, description="m, straight lines joined by arcs; none: a spline")
    stops: Annotated[Any, by_check(checked_stops)] = Field((), description="an array of [m, waiting time in s]")
    acceleration: Positive = Field(ACCELERATION, description="m/s^2, by which it leaves its stops")
    deceleration: Positive = Field(DECELERATION, description="m/s^2, by which it reaches them")
    lateral_acceleration: Positive | None = Field(None, description="m/s^2, at most, in curves; none: any")
    speed_over: Literal["distance", "time"] = Field("distance", description="what the first column of speed counts")
    start_time: Number = Field(0.0, description="s, at the first point")
    goes_on: NotNegative = Field(0.0, description="s, straight on before its begin and after its end")
    pitch: bool = Field(False, description="its nose follows the slope of the path")


TrajectoryValue = Annotated[
    Annotated[str, Tag("<file>")] | Annotated[TrajectoryTable, Tag("<table>")],
    Discriminator(lambda value: "<file>" if isinstance(value, str) else "<table>")]


def one_motion(table):
    """Raises where a table has several motions, or an id without a file to look it up in."""
    given = [key for key in ("motion", "speed", "trajectory") if getattr(table, key) is not None]
    if len(given) > 1:
        raise broken_rule(given[1], f"must not stand beside {given[0]}", getattr(table, given[1]))
    if table.id is not None and not isinstance(table.trajectory, str):
        raise broken_rule("id", "needs a trajectory that is a file", table.id)
    return table


class RadarTable(Table):
    sensor: str | None = Field(None, description="configuration of a TI sensor, instead of waveform and antennas")
    board: str | None = Field(None, description="whose antennas the sensor has; none: as its file says")
    subframe: int = Field(0, ge=0, description="of the sensor")
    waveform: WaveformTable | None = Field(None, description="none: that of the sensor")
    transmitters: list[AntennaTable] | None = Field(None, min_length=1, description="at least one")
    receivers: list[AntennaTable] | None = Field(None, min_length=1, description="at least one")
    pattern: PatternTable | None = Field(None, description="of antennas without their own; none: isotropic")
    polarization: Vector3 = Field([0.0, 0.0, 1.0], description="of antennas without their own")
    transmit_power: Positive = Field(0.01, description="W, per transmitter; of a sensor that of its board")
    noise_figure_db: Number = Field(12.0, description="dB; of a sensor that of its board")
    multiplexing: Literal["tdm", "bpm", "ddm", "cdm"] = Field("tdm", description="how transmitters share the chirps")
    empty_slots: int = Field(1, ge=1, description="of \"ddm\": shares of the Doppler axis without a transmitter")
    code_phases: list[list[Number]] | None = Field(None, description="rad, of \"cdm\", a row for each transmitter")
    receiver: Annotated[Any, by_check(receiver_rule)] | None = Field(None, description="its faults; none: ideal")
    position: Vector3 = Field([0.0, 0.0, 0.0], description="m, in the world")
    yaw_deg: Number = Field(0.0, description="degrees about z, left positive")
    pitch_deg: Pitch = Field(0.0, description="degrees, up positive")
    motion: MotionTable | None = Field(None, description="of the placed radar, in world axes; none: it stands still")
    speed: Number | None = Field(None, description="m/s, level and ahead as yaw_deg turns it, instead of motion")
    trajectory: TrajectoryValue | None = Field(None, description="a table or a file, instead of motion")
    id: str | None = Field(None, description="of the object of the file; none: its only one")

    _one_motion = model_validator(mode="after")(one_motion)

    @model_validator(mode="after")
    def _one_source(self):
        own = ("waveform", "transmitters", "receivers")
        if self.sensor is None:
            for key in own:
                if getattr(self, key) is None:
                    raise broken_rule(key, "must be given, or a sensor", None)
            return self
        beside = {*own, "pattern", "polarization", "multiplexing", "empty_slots", "code_phases"}
        for key in beside & self.model_fields_set:
            raise broken_rule(key, "must not stand beside sensor", key)
        return self


class InterfererTable(RadarTable):
    """A radar that sends: its receivers, where it has none, are its transmitters."""

    offset: Number = Field(0.0, description="s, by which its frames begin later than at time 0")
    over: Over = Field("both", description="the direct way, the paths of the scene, or both")

    @model_validator(mode="before")
    @classmethod
    def _receivers(cls, table):
        if isinstance(table, dict) and "sensor" not in table and "receivers" not in table and "transmitters" in table:
            return table | {"receivers": table["transmitters"]}
        return table


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


MaterialValue = Annotated[
    Annotated[str, Tag("<name>")] | Annotated[MaterialTable, Tag("<table>")],
    Discriminator(lambda value: "<name>" if isinstance(value, str) else "<table>")]


MODEL_KEYS = ("unit", "up", "animation", "loop", "offset")  # arguments of load_model that are keys of an object


def _way(argument: str, value):
    return value if value == "auto" else positive("m, or \"auto\"")(argument, value)


class ObjectTable(Table):
    name: Name = Field(description="its name in path expressions")
    mesh: str | None = Field(None, description="OBJ, PLY, STL or OFF file, relative to the scene file")
    model: str | None = Field(None, description="foreign scene or object, a file that load_model reads, likewise")
    unit: Positive | None = Field(None, description="m, length of one unit of mesh or model; none: 1, or as the model says")
    up: Literal["x", "y", "z"] | None = Field(None, description="vertical axis of the model; none: as it says")
    materials: dict[str, MaterialValue] = Field({}, description="names in the model, or patterns of them = material")
    animation: str | None = Field(None, description="of the model, by its name; none: the first, \"\": at rest")
    loop: bool | None = Field(None, description="whether the animation begins anew at its end; none: it does not")
    offset: Number | None = Field(None, description="s, time of the animation at time 0 of the scene; none: 0")
    way: Annotated[Any, by_check(_way)] | None = Field(
        None, description="m of the trajectory in which a looped animation is played once, \"auto\": as its feet or itself say")
    actor: str | None = Field(None, description="a ready-made object: a function of echopath.actors")
    parameters: dict = Field({}, description="keywords of the actor")
    material: MaterialValue | None = Field(None, description="a known name or a table")
    position: Vector3 | None = Field(None, description="m")
    yaw_deg: Number | None = Field(None, description="degrees about z")
    transform: Matrix4 | None = Field(None, description="4 x 4, instead of position and yaw_deg")
    motion: MotionTable | None = Field(None, description="in the axes of the parent; none: it stands still")
    speed: Number | None = Field(None, description="m/s straight ahead, along its own +x, instead of motion")
    trajectory: TrajectoryValue | None = Field(None, description="a table or a file, instead of motion")
    id: str | None = Field(None, description="of the object of the file; none: its only one")
    parent: str | None = Field(None, description="full name of the node that carries it; none: the scene")
    smooth: bool = Field(False, description="the mesh stands for a curved surface")
    visible: bool = Field(True, description="false: it takes no part in anything until it is shown")

    @model_validator(mode="after")
    def _one_shape(self):
        if [self.mesh, self.model, self.actor].count(None) != 2:
            raise broken_rule("mesh", "exactly one of mesh, model and actor must be given", self.mesh)
        if self.way is not None and (self.model is None or self.trajectory is None):
            raise broken_rule("way", "needs a model with a trajectory", self.way)
        if self.unit is not None and self.mesh is None and self.model is None:
            raise broken_rule("unit", "needs a mesh or a model", self.unit)
        for key in ("up", "materials", "animation", "loop", "offset"):
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


class TraceTable(Table):
    num_rays: Annotated[int, Field(ge=1, le=MOST_RAYS)] | None = Field(
        TraceSettings.num_rays, description="a budget; none: as many as 0.3 dB for each object asks for, 1 000 000 at most")
    max_bounces: int = Field(TraceSettings.max_bounces, ge=1, le=MOST_BOUNCES, description="hits of a path, mirrors included")
    seed: int = Field(TraceSettings.seed, ge=0, description="of the directions and random phases")
    start_time: Number = Field(TraceSettings.start_time, description="s, first sample of the frame")
    polarization: Polarization = Field(
        TraceSettings.polarization, description="field vectors, one coefficient a hit, or whichever the scene asks for")
    footprint: Footprint = Field(TraceSettings.footprint, description="filter of a ray's footprint")
    sampler: Sampler = Field(TraceSettings.sampler, description="how rays are spread over the cone of an object")
    batches: Annotated[int, Field(ge=1, le=MOST_BATCHES)] | None = Field(
        TraceSettings.batches, description="independent parts of the rays, which give standard errors; none: 1")
    target_error_db: Positive | None = Field(
        TraceSettings.target_error_db, description="dB, error of each echo until which rays are added, from num_rays on")
    max_rays: int = Field(TraceSettings.max_rays, ge=1, le=MOST_RAYS, description="at most, with target_error_db")
    scatterers: Scatterers = Field(
        TraceSettings.scatterers, description="of rough surfaces: where rays meet them, points that are the same in every frame, "
                                              "or these for frames in a row alone")
    edges: Edges = Field(
        TraceSettings.edges, description="also find the echoes of sharp edges, or where they stand out of the noise")
    effects: Annotated[Any, by_check(effects_rule)] = Field(
        TraceSettings.effects, description="name of an effect of the weather = true, false or \"auto\"")


class WeatherTable(Table):
    rain_mm_per_hour: float = Field(Weather.rain_mm_per_hour, ge=0, le=300, description="mm/h")
    fog_g_per_m3: float = Field(Weather.fog_g_per_m3, ge=0, le=10, description="g/m^3 of water")
    temperature: float = Field(Weather.temperature, ge=200, le=340, description="K")
    pressure: float = Field(Weather.pressure, ge=1e4, le=1.2e5, description="Pa")
    humidity: float = Field(Weather.humidity, ge=0, le=1, description="share of saturation")
    wind: Vector3 = Field(list(Weather.wind), description="m/s, world axes")
    turbulence: float = Field(Weather.turbulence, ge=0, le=100, description="m/s, of the drops about it")


class ReplayTable(Table):
    replay: Replay = Field(SignalSettings.replay, description="points of reflection on surfaces that are no mirrors: frozen, "
                                                              "or moved by a Newton step")
    evaluate: Evaluate = Field(SignalSettings.evaluate, description="polynomials over the frame, every chirp, or every sample "
                                                                    "of fast rotors")
    retrace: Retrace = Field(SignalSettings.retrace, description="what is renewed at keyframes: nothing, shadows and points "
                                                                 "of reflection, the whole trace")
    keyframes: int = Field(SignalSettings.keyframes, ge=0, description="stretches of the frame; 0: as many as validity "
                                                                       "suggests")


class SpectrumTable(Table):
    window: MapWindow = Field(SignalSettings.window, description="a name or [\"chebyshev\", sidelobe level in dB] of both "
                                                                 "axes, or those of [range, velocity]")
    zero_pad: int = Field(SignalSettings.zero_pad, ge=1, description="length of the transforms over that of the data")


MOST_AZIMUTH_STEPS = 36_000  # a hundredth of a degree over all around


def _azimuths(value):
    if not (isinstance(value, list) and len(value) == 3 and all(map(_is_number, value)) and value[2] > 0
            and -180 <= value[0] <= value[1] <= 180 and value[1] - value[0] <= MOST_AZIMUTH_STEPS * value[2]):
        raise ValueError("must be [first, last, step] in degrees, -180 <= first <= last <= 180, step > 0 and at most "
                         f"{MOST_AZIMUTH_STEPS} steps")
    return list(map(float, value))


def _elevations(value):
    elevations = value if isinstance(value, list) else [value]
    if not (elevations and all(map(_is_number, elevations)) and elevations == sorted(set(elevations))
            and -90 <= elevations[0] and elevations[-1] <= 90):
        raise ValueError("must be a number or an ascending list of numbers in [-90, 90] degrees")
    return value


class AngleTable(Table):
    method: Literal["bartlett", "capon"] = Field("bartlett", description="how beams are formed")
    azimuth_deg: Annotated[Any, AfterValidator(_azimuths)] | None = Field(
        None, description="[first, last, step] in degrees, to the left; none: what the array tells apart")
    elevation_deg: Annotated[Any, AfterValidator(_elevations)] = Field(
        0.0, description="degrees, or a list: the largest power over them")
    velocity: Number | None = Field(None, description="m/s, of the cells shown; none: all")
    velocity_gate: Annotated[Any, by_check(gate)] | None = Field(None, description="m/s, [lowest, highest] of all velocities")
    combine: Literal["sum", "peak"] = Field("peak", description="of all velocities: the largest, or their sum")
    window: Window = Field("rect", description="over the array, of bartlett; others than rect for grids of equal steps")
    diagonal_loading: Annotated[float, Field(ge=1e-9, le=1e3)] = Field(
        0.01, description="of capon, relative to the mean power of the elements")
    range_neighbours: int = Field(2, ge=0, le=64, description="of capon, cells on each side in the covariance")
    forward_backward: bool = Field(False, description="of capon, for arrays symmetric about their centre")

    @model_validator(mode="after")
    def _one_taper(self):
        if self.method == "capon" and self.window != "rect":
            raise broken_rule("window", "must be \"rect\" for capon, which finds its own weights", self.window)
        return self


class NoiseTable(Table):
    seed: int = Field(SignalSettings.noise_seed, ge=0, description="of the thermal noise, with the start time")


def _label_objects(value):
    globs = list(value.values()) if isinstance(value, dict) else [value]
    lists = [[glob] if isinstance(glob, str) else glob for glob in globs]
    if not all(isinstance(one, list) and one and all(isinstance(glob, str) and glob for glob in one) for one in lists):
        raise ValueError("must be globs in an array, or a table of name = glob or name = [globs]")
    return value


class LabelsTable(Table):
    plane: Plane = Field(LabelSettings.plane, description="whose cells are labelled")
    objects: Annotated[Any, AfterValidator(_label_objects)] | None = Field(
        LabelSettings.objects,
        description="globs, or name = glob or globs; none: the children of the scene's root that are no mirrors")
    noise: bool = Field(LabelSettings.noise, description="cells must stand out of the noise")
    noise_margin_db: Number = Field(LabelSettings.noise_margin_db, description="dB, by so much")
    dynamic_range_db: Annotated[float, Field(ge=0, allow_inf_nan=False)] = Field(
        LabelSettings.dynamic_range_db, description="dB, cells may be so far below the peak")
    errors: bool = Field(LabelSettings.errors, description="standard errors too; needs batches")


class DetectionsTable(Table):
    method: CfarMethod = Field("ca", description="cell averaging, or an ordered statistic")
    false_alarm_rate: Annotated[float, Field(ge=1e-15, le=0.5)] = Field(FALSE_ALARM_RATE, description="of one cell")
    guard_velocity: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: the window's main lobe")
    guard_range: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: the window's main lobe")
    training_velocity: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: 4 zero_pad")
    training_range: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: 8 zero_pad")
    rank: Annotated[float, Field(gt=0, le=1)] = Field(RANK, description="of \"os\", share of the training cells")
    max_peaks: int = Field(1, ge=1, description="directions of a cell at most")


class TruthTable(Table):
    objects: Annotated[Any, AfterValidator(_label_objects)] | None = Field(
        None, description="globs, or name = glob or globs; none: those of [labels]")


class SequenceTable(Table):
    frames: int = Field(ge=1, description="number of frames")
    interval: Annotated[float, Field(gt=0, allow_inf_nan=False)] = Field(description="s, from start to start")
    keep: Literal["all", "maps", "labels"] = Field("all", description="what the file of each frame keeps")


PartsValue = Annotated[
    Annotated[dict[Name, str], Tag("<partition>")] | Annotated[str, Tag("<expression>")],
    Discriminator(lambda value: "<partition>" if isinstance(value, dict) else "<expression>")]


def _one_kind_of_parts(argument: str, value: dict) -> dict:
    are_tables(value, called=argument)
    return value


class SceneTable(Table):
    title: str = Field("", description="one line about the scene")
    guard: bool = Field(True, description="whether a run is held against slower ways at a few random places")
    radar: RadarTable
    objects: list[ObjectTable] = Field([], description="in the order of their mesh IDs")
    weather: WeatherTable | None = Field(None, description="air, fog and rain; none: empty space")
    interferers: list[InterfererTable] = Field([], description="other radars that send into the receivers")
    trace: TraceTable = TraceTable()
    replay: ReplayTable = ReplayTable()
    spectrum: SpectrumTable = SpectrumTable()
    angle: AngleTable = AngleTable()
    noise: NoiseTable = NoiseTable()
    parts: Annotated[dict[Name, PartsValue], by_check(_one_kind_of_parts)] = Field(
        {}, description="name = path expression: one partition; tables of these: several")
    labels: LabelsTable | None = Field(None, description="labels of the map; none: they are not made")
    detections: DetectionsTable | None = Field(None, description="detections in the map; none: they are not made")
    truth: TruthTable | None = Field(None, description="place, motion and box of each object; none: not kept")
    sequence: SequenceTable | None = Field(None, description="frames in time; none: one frame")

