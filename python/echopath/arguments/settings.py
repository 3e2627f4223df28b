"""Settings of a simulation: the one home of what they are called, what they are unless given, and what they may be.

Settings objects go to what a simulation consists of: `trace`, `synthesize`, `decompose`, `annotate` and `annotate_frame` take
one as `settings=`, `annotate` that of its replay as `signal=`, `spectrogram` that of its labels as `labels=`, and `simulate` all
three as `trace=`, `signal=` and `labels=`.
Keywords of the call go before it. Other functions that share a keyword (`range_doppler`, `validity`, `effects`, `rcs`,
`check_signal`, `view`) take it alone, of a settings object `settings.window` for example.
"""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar, Literal, TypedDict, TypeVar, dataclass_transform

from .. import _core
from .checks import (
    COMMON,
    LARGEST_COUNT,
    MapWindow,
    Rule,
    count,
    flag,
    flag_or_auto,
    map_window as window_rule,
    number_or_auto,
    one_of,
    optional,
    positive,
    real,
    seed as seed_rule,
)
from .effects import Choices, effects_rule
from .keywords import known_keywords, refuse_unknown
from .objects import Objects, objects_rule

Polarization = Literal["auto", "scalar", "jones"]
Footprint = Literal["none", "first_order", "second_order", "edges"]
Sampler = Literal["lattice", "fibonacci", "r2", "random"]
Scatterers = Literal["auto", "rays", "surface"]
Edges = bool | Literal["auto"]
FaintPower = float | Literal["auto"]  # W
Method = Literal["auto", "direct", "recurrence", "nufft"]
Replay = Literal["material", "fermat"]
Evaluate = Literal["interpolated", "chirps", "samples"]
Retrace = Literal["never", "invalid", "always"]
Plane = Literal["range_doppler", "range_azimuth"]

MOST_BOUNCES = MOST_BATCHES = 64
MOST_RAYS: int = _core.MOST_RAYS
Kind = TypeVar("Kind", bound="Settings")


class Settings:
    """What the classes of settings have in common."""

    RULES: ClassVar[Mapping[str, Rule]]

    def __post_init__(self) -> None:
        for name, rule in self.RULES.items():
            object.__setattr__(self, name, rule(name, getattr(self, name)))

    def replace(self: Kind, **changes: object) -> Kind:
        """A copy with other values. changes: keywords of the class. Raises TypeError or ValueError naming the keyword."""
        refuse_unknown("replace", changes, self.RULES)
        return dataclasses.replace(self, **changes)  # type: ignore[type-var]

    def keywords(self) -> dict[str, object]:
        """{keyword: value}, as the functions take them."""
        return {name: getattr(self, name) for name in self.RULES}


@dataclass_transform(kw_only_default=True, frozen_default=True)
def settings_class(kind: type[Kind]) -> type[Kind]:
    """Decorator: a frozen dataclass of keywords, which refuses unknown ones with the nearest right one."""
    made = dataclasses.dataclass(frozen=True, kw_only=True)(kind)
    made.__init__ = known_keywords(made.__init__, made.__name__)  # type: ignore[method-assign]
    return made


def settings_among(kind: type[Kind], arguments: Mapping[str, object]) -> Kind:
    """The settings of a class among the arguments of a function, {keyword: value}: its `locals()`, which must have all."""
    return kind(**{name: arguments[name] for name in kind.RULES})


@settings_class
class TraceSettings(Settings):
    """How rays are shot: the keywords of `trace`, which tells what they mean.

    num_rays: a budget of rays, None: as many as 0.3 dB for each object asks for; max_bounces: 1 to 64
    seed: of the directions and random phases, 0 or more; start_time: s, first sample of the frame
    polarization, footprint, sampler: words; batches: 1 to 64 independent parts of the rays, None: 1
    target_error_db: dB, error of each echo until which rays are added, at most max_rays
    scatterers: of rough surfaces, a word; edges: whether echoes of sharp edges are looked for, or "auto"
    faint_power: W, the most that a diffuse path may carry which stands for others as well, 0: all are kept, or "auto"
    effects: {name of an effect of the weather: True, False or "auto"}, as pairs
    Raises TypeError or ValueError naming the keyword. Values are frozen; two with equal values are equal.
    """

    num_rays: int | float | None = None
    max_bounces: int = 4
    seed: int = 1
    start_time: float = 0.0
    polarization: Polarization = "auto"
    footprint: Footprint = "second_order"
    sampler: Sampler = "lattice"
    batches: int | None = None
    target_error_db: float | None = None
    max_rays: int | float = _core.DEFAULT_MAX_RAYS
    scatterers: Scatterers = "auto"
    edges: Edges = False
    faint_power: FaintPower = 0.0
    effects: Choices = ()

    RULES: ClassVar[Mapping[str, Rule]] = {
        "num_rays": optional(count(1, MOST_RAYS)), "max_bounces": count(1, MOST_BOUNCES), "seed": seed_rule,
        "start_time": real(unit="s"), "polarization": one_of(Polarization), "footprint": one_of(Footprint),
        "sampler": one_of(Sampler), "batches": optional(count(1, MOST_BATCHES)),
        "target_error_db": optional(positive("dB")), "max_rays": count(1, MOST_RAYS),
        "scatterers": one_of(Scatterers), "edges": flag_or_auto, "faint_power": number_or_auto(real(0.0, unit="W")),
        "effects": effects_rule}


@settings_class
class SignalSettings(Settings):
    """How paths become a signal and its map: the keywords of `synthesize`, of the noise and of `range_doppler`.

    tolerance: rms error of the samples, relative; method, replay, evaluate, retrace: words
    phase_tolerance: rad, of moving echoes; keyframes: number of stretches of the frame, 0: as many as `validity` suggests
    noise_seed: of the thermal noise, None: no noise; window, zero_pad: of the map
    `synthesize` and `decompose` take of it neither noise nor map, `annotate` no noise; `range_doppler` and others that share
    a keyword take that alone.
    Raises TypeError or ValueError naming the keyword. Values are frozen; two with equal values are equal.
    """

    tolerance: float = 1e-7
    method: Method = "auto"
    replay: Replay = "material"
    evaluate: Evaluate = "interpolated"
    phase_tolerance: float = _core.PHASE_TOLERANCE
    retrace: Retrace = "never"
    keyframes: int = 0
    noise_seed: int | None = 1
    window: MapWindow = "hann"
    zero_pad: int = 1

    RULES: ClassVar[Mapping[str, Rule]] = {
        "tolerance": real(1e-13, 0.1), "method": one_of(Method), "replay": one_of(Replay), "evaluate": one_of(Evaluate),
        "phase_tolerance": positive("rad"), "retrace": one_of(Retrace), "keyframes": count(0, LARGEST_COUNT),
        "noise_seed": optional(seed_rule), "window": window_rule, "zero_pad": COMMON["zero_pad"]}

    def of_replay(self) -> ReplayKeywords:
        """The keywords of `synthesize` and `decompose` alone."""
        return ReplayKeywords(tolerance=self.tolerance, method=self.method, replay=self.replay, evaluate=self.evaluate,
                              phase_tolerance=self.phase_tolerance, retrace=self.retrace, keyframes=self.keyframes)


class ReplayKeywords(TypedDict):
    """The keywords of `synthesize` and `decompose`; tolerance: relative; phase_tolerance: rad."""

    tolerance: float
    method: Method
    replay: Replay
    evaluate: Evaluate
    phase_tolerance: float
    retrace: Retrace
    keyframes: int


LEAST_MARGIN_DB = -300.0  # of labels over the noise: far below anything
FRAME_KEYWORDS = ("replay", "evaluate", "retrace", "keyframes")  # of SignalSettings, those that a Frame keeps


@settings_class
class LabelSettings(Settings):
    """How the cells of a map are labelled: the keywords of `annotate` that no frame settles.

    plane: "range_doppler" or "range_azimuth", whose cells; objects: what to report on, as in `families`, kept as pairs of a
        name and its globs
    noise: whether cells must stand out of the noise, noise_margin_db: dB from -300 to 300, by so much
    dynamic_range_db: dB, cells may be so far below the peak of the echoes, None: no limit; errors: standard errors too
    Raises TypeError or ValueError naming the keyword. Values are frozen; two with equal values are equal.
    """

    plane: Plane = "range_doppler"
    objects: Objects = None
    noise: bool = True
    noise_margin_db: float = 10.0
    dynamic_range_db: float | None = 60.0
    errors: bool = False

    RULES: ClassVar[Mapping[str, Rule]] = {
        "plane": one_of(Plane), "objects": objects_rule, "noise": flag, "noise_margin_db": real(LEAST_MARGIN_DB, 300.0, "dB"),
        "dynamic_range_db": optional(real(0.0, unit="dB")), "errors": flag}

    @property
    def margin_db(self) -> float:
        """noise_margin_db, minus infinity where no cell need stand out of the noise."""
        return self.noise_margin_db if self.noise else -math.inf
