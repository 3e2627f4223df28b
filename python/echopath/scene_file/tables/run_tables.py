"""Tables of what is done with a scene: trace, replay, maps, labels, detections, sequences."""
from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from ...arguments.checks import MOST_NEIGHBOURS, map_window, window
from ...arguments.effects import effects_rule
from ...arguments.gates import gate
from ...arguments.settings import (
    MOST_BATCHES,
    MOST_BOUNCES,
    MOST_RAYS,
    Evaluate,
    Footprint,
    LabelSettings,
    Plane,
    Polarization,
    Replay,
    Retrace,
    Sampler,
    Scatterers,
    SignalSettings,
    TraceSettings,
)
from ...spectra.range_doppler import FALSE_ALARM_RATE, RANK, CfarMethod
from ...weather import Weather
from .table import Number, Positive, Table, Vector3, broken_rule, by_check, is_number

FOUND = "found"  # instead of names of objects: those of `find_objects`
Window = Annotated[Any, by_check(window)]
MapWindow = Annotated[Any, by_check(map_window)]


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
    edges: Annotated[Any, by_check(TraceSettings.RULES["edges"])] = Field(
        TraceSettings.edges, description="also find the echoes of sharp edges, or where they stand out of the noise")
    faint_power: Annotated[Any, by_check(TraceSettings.RULES["faint_power"])] = Field(
        TraceSettings.faint_power, description="W, the most of a diffuse path that stands for others; 0: all are kept")
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

    @model_validator(mode="after")
    def _keyframes_of_something(self):
        if self.keyframes and self.retrace == "never":
            raise broken_rule("keyframes", "needs retrace = \"invalid\" or \"always\"", self.keyframes)
        return self


class SpectrumTable(Table):
    window: MapWindow = Field(SignalSettings.window, description="a name or [\"chebyshev\", \"taylor\" or \"kaiser\", "
                                                                 "sidelobe level in dB] of both axes, or those of [range, "
                                                                 "velocity]")
    zero_pad: int = Field(SignalSettings.zero_pad, ge=1, description="length of the transforms over that of the data")


MOST_AZIMUTH_STEPS = 36_000  # a hundredth of a degree over all around


def _azimuths(value):
    if not (isinstance(value, list) and len(value) == 3 and all(map(is_number, value)) and value[2] > 0
            and -360 <= value[0] <= value[1] <= 360 and value[1] - value[0] <= MOST_AZIMUTH_STEPS * value[2]):
        raise ValueError("must be [first, last, step] in degrees, -360 <= first <= last <= 360, step > 0 and at most "
                         f"{MOST_AZIMUTH_STEPS} steps")
    return list(map(float, value))


def _elevations(value):
    elevations = value if isinstance(value, list) else [value]
    if not (elevations and all(map(is_number, elevations)) and elevations == sorted(set(elevations))
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
    velocity_neighbours: Annotated[int, Field(ge=0, le=MOST_NEIGHBOURS)] | None = Field(
        None, description="of capon, cells of velocity on each side in the covariance; none: 1")
    range_neighbours: int = Field(2, ge=0, le=MOST_NEIGHBOURS, description="of capon, cells on each side in the covariance")
    forward_backward: bool = Field(False, description="of capon, for arrays symmetric about their centre")

    @model_validator(mode="after")
    def _one_taper(self):
        if self.method == "capon" and self.window != "rect":
            raise broken_rule("window", "must be \"rect\" for capon, which finds its own weights", self.window)
        return self


class NoiseTable(Table):
    seed: int = Field(SignalSettings.noise_seed, ge=0, description="of the thermal noise, with the start time")


def _label_objects(value):
    if value == FOUND:
        return value
    globs = list(value.values()) if isinstance(value, dict) else [value]
    lists = [[glob] if isinstance(glob, str) else glob for glob in globs]
    if not all(isinstance(one, list) and one and all(isinstance(glob, str) and glob for glob in one) for one in lists):
        raise ValueError(f'must be globs in an array, a table of name = glob or name = [globs], or "{FOUND}"')
    return value


class LabelsTable(Table):
    plane: Plane = Field(LabelSettings.plane, description="whose cells are labelled")
    objects: Annotated[Any, AfterValidator(_label_objects)] | None = Field(
        LabelSettings.objects,
        description="globs, or name = glob or globs; none: the children of the scene's root that are no mirrors; \"found\": "
                    "these and the things in a town that is one object (`ep.find_objects`)")
    noise: bool = Field(LabelSettings.noise, description="cells must stand out of the noise")
    noise_margin_db: Number = Field(LabelSettings.noise_margin_db, description="dB, by so much")
    dynamic_range_db: Annotated[float, Field(ge=0, allow_inf_nan=False)] = Field(
        LabelSettings.dynamic_range_db, description="dB, cells may be so far below the peak of the echoes")
    errors: bool = Field(LabelSettings.errors, description="standard errors too; needs batches")


class DetectionsTable(Table):
    method: CfarMethod = Field("ca", description="average, ordered statistic, greatest or smallest of two halves")
    false_alarm_rate: Annotated[float, Field(ge=1e-15, le=0.5)] = Field(FALSE_ALARM_RATE, description="of one cell")
    guard_velocity: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: the window's main lobe")
    guard_range: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: the window's main lobe")
    training_velocity: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: 4 zero_pad")
    training_range: Annotated[int, Field(ge=0)] | None = Field(None, description="cells; none: 8 zero_pad")
    rank: Annotated[float, Field(gt=0, le=1)] = Field(RANK, description="of \"os\", share of the training cells")
    beams: bool = Field(False, description="tests cells in beams of the array instead of the sum of its channels")
    max_peaks: int = Field(1, ge=1, description="directions of a cell at most")
    folds: int = Field(0, ge=0, description="velocities beyond the map to either side that slots of transmitters tell apart")


def _frame_times(value):
    if not (isinstance(value, str) or isinstance(value, list) and value and all(map(is_number, value))):
        raise ValueError("must be a list of numbers in s, or the name of a text file of them, one in a line")
    return value


class TruthTable(Table):
    objects: Annotated[Any, AfterValidator(_label_objects)] | None = Field(
        None, description="globs, or name = glob or globs, or \"found\", as in [labels]; none: those of [labels]")


class SequenceTable(Table):
    frames: Annotated[int, Field(ge=1)] | None = Field(None, description="number of frames")
    interval: Positive | None = Field(None, description="s, from start to start")
    times: Annotated[Any, AfterValidator(_frame_times)] | None = Field(
        None, description="in the place of both: the start of each frame in s, or a text file of them, one in a line")
    keep: Literal["all", "maps", "labels"] = Field("all", description="what the file of each frame keeps")

    @model_validator(mode="after")
    def _starts(self):
        for key in ("frames", "interval"):
            if self.times is None and getattr(self, key) is None:
                raise broken_rule(key, "is missing, or times in the place of frames and interval", None)
            if self.times is not None and getattr(self, key) is not None:
                raise broken_rule(key, "must not be given with times, which tell the start of each frame", getattr(self, key))
        return self
