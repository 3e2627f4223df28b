"""Tables of radars, their antennas and waveforms, and of radars that interfere."""
from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from ...receiver.settings import receiver_rule
from ...scene.interferers import Over
from ...trajectories.arguments import Outside
from .motion_tables import GoesOn, MotionTable, TrajectoryValue, one_motion
from .table import Lifetime, NotNegative, Number, Pitch, Positive, Quaternion, Table, Vector3, broken_rule, by_check, by_kind


class WaveformTable(Table):
    start_frequency: Positive = Field(description="Hz, at the first sample")
    bandwidth: Number = Field(description="Hz, what the samples of one chirp sweep, negative where chirps fall")
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


class GaussianBeamTable(Table):
    kind: Literal["gaussian_beam"] = Field(description="a beam known by its widths, 0 behind")
    azimuth_deg: Number = Field(gt=0.0, le=180.0, description="degrees, whole width at half the power")
    elevation_deg: Number = Field(gt=0.0, le=180.0, description="degrees, likewise")
    peak_gain: Positive | None = Field(None, description="power gain, linear; none: of a lossless antenna")


class GainFileTable(Table):
    kind: Literal["table"] = Field(description="gain, and phase where given, sampled over direction")
    file: str = Field(min_length=1, description="file that echopath.load_antenna reads, relative to the scene file")
    normalize: bool = Field(False, description="scales the gain to a mean of 1 over the sphere, as without losses")
    boresight: Literal["x", "y", "z"] | None = Field(None, description="axis of a file over theta and phi; none: z")


PatternTable = Annotated[
    Annotated[IsotropicTable, Tag("<isotropic>")] | Annotated[CosinePowerTable, Tag("<cosine_power>")] |
    Annotated[GaussianBeamTable, Tag("<gaussian_beam>")] | Annotated[GainFileTable, Tag("<table>")],
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
    goes_on: GoesOn | None = Field(None, description="s, straight on before the begin and after the end of that; none: 0")
    rides_on: str | None = Field(None, description="id of the traffic, or an object, in whose axes its place is; none: nothing")
    during: Lifetime | None = Field(None, description="[begin, end] s, in which it rides on an object; none: it is traffic")

    _one_motion = model_validator(mode="after")(one_motion)

    @model_validator(mode="after")
    def _rides_on_something(self):
        if self.during is not None and self.rides_on is None:
            raise broken_rule("during", "needs rides_on, the name of an object", list(self.during))
        return self

    @model_validator(mode="after")
    def _one_source(self):
        own = ("waveform", "transmitters", "receivers")
        if self.sensor is None:
            for key in own:
                if getattr(self, key) is None:
                    raise broken_rule(key, "must be given, or a sensor", None)
            return self
        for key in (*own, "pattern", "polarization", "multiplexing", "empty_slots", "code_phases"):
            if key in self.model_fields_set:
                raise broken_rule(key, "must not stand beside sensor", getattr(self, key))
        return self


class InterfererTable(RadarTable):
    """A radar that sends: its receivers, where it has none, are its transmitters."""

    offset: Number = Field(0.0, description="s, by which its frames begin later than at time 0")
    interval: Number | None = Field(None, description="s, from frame to frame; none: they follow without a pause")
    outside: Outside | None = Field(None, description="of the file of its trajectory: it \"stands\" or is absent; none: absent")
    lifetime: Lifetime | None = Field(None, description="[begin, end] s, of the frames that it sends in; none: all")
    over: Over = Field("both", description="the direct way, the paths of the scene, or both")

    @model_validator(mode="before")
    @classmethod
    def _receivers(cls, table):
        if isinstance(table, dict) and "sensor" not in table and "receivers" not in table and "transmitters" in table:
            return table | {"receivers": table["transmitters"]}
        return table
