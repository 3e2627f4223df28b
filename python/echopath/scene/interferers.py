"""Other radars of a scene."""
from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from typing import ClassVar, Literal

from .. import _core
from ..arguments.checks import Rule, an, one_of, optional, real, refused
from ..arguments.frame_times import lifetime_rule, require_room
from ..arguments.settings import Settings, settings_class
from ..base.text.counts import counted
from .node import ALWAYS

Over = Literal["both", "direct", "paths"]


@settings_class
class Interferer(Settings):
    """Another FMCW radar in a scene, which sends into the receivers of the radar that is simulated (`Scene.interferers`).

    radar: that sends: its waveform, code, power, transmitters with their errors and that of its frequency (`Receiver`), place in
        m and motion count. Its motion covers the frames, and the direct way is at least a wavelength long
    offset: s, by which its frames begin later than at time 0; interval: s, from one of them to the next, at least the duration
        of a frame; None: they follow each other without a pause. A chirp is heard while its frequency is within the band of that
        of the radar; frames in which it sends warn of a radar that never is
    over: "both" the direct way, where nothing stands in it, and the paths of the scene; "direct" or "paths" alone
    lifetime: (begin, end) in s, either of which may be infinite: frames that do not lie wholly between them are without it, as
        those without the vehicle that carries it (`Trajectory.lifetime`); None: it sends in all
    Raises TypeError or ValueError naming the keyword. Values are frozen; two with equal values are equal.
    """

    radar: _core.Radar
    offset: float = 0.0
    interval: float | None = None
    over: Over = "both"
    lifetime: tuple[float, float] | None = None

    RULES: ClassVar[Mapping[str, Rule]] = {"radar": an(_core.Radar), "offset": real(unit="s"),
                                           "interval": optional(real(unit="s")), "over": one_of(Over),
                                           "lifetime": optional(lifetime_rule)}

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.interval is not None:
            require_room("interval", self.radar, self.interval)


def interferers_rule(argument: str, value) -> tuple[Interferer, ...]:
    """Some Interferer, as a tuple."""
    if not isinstance(value, (list, tuple)) or not all(isinstance(one, Interferer) for one in value):
        raise refused(TypeError, argument, "a list of Interferer", value)
    return tuple(value)


def interferers_of(scene) -> tuple[Interferer, ...]:
    """Of a scene; records keep scenes without."""
    return getattr(scene, "interferers", ())


def interferers_within(scene, begin: float, end: float) -> Iterator[tuple[int, Interferer]]:
    """(index, Interferer) of those of a scene that send all the time from begin to end in s."""
    rounding = sys.float_info.epsilon * max(abs(begin), abs(end))
    for index, one in enumerate(interferers_of(scene)):
        first, last = one.lifetime or ALWAYS
        if first <= begin + rounding and last >= end - rounding:
            yield index, one


def interferers_text(interferers) -> str:
    """How many other radars there are, in words."""
    return counted(len(interferers), "other radar") if interferers else "none"
