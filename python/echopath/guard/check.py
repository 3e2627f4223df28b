"""What the guard of a run says: how far apart two ways to one result are, and a warning where that is too far."""
from __future__ import annotations

import dataclasses

from ..base.classes.made_by import made_by
from ..base.process.callers import warn_user


class GuardWarning(UserWarning):
    """A result disagrees with a slower way to it by more than the run promises."""


@made_by("ep.check_rays and ep.check_signal")
@dataclasses.dataclass(frozen=True)
class Check:
    """One comparison of the guard.

    name: what was compared with what; error: how far they are apart, in `unit`; promise: the most that is promised
    unit: "rad", "dB" or what the error is relative to; count: how many places were compared
    advice: a sentence that says what is wrong and what to do about it, "" for none; files of frames do not hold it
    """

    name: str
    error: float
    promise: float
    unit: str
    count: int
    advice: str = dataclasses.field(default="", compare=False)

    @property
    def agrees(self) -> bool:
        """Whether the error is no larger than promised."""
        return self.error <= self.promise

    def __str__(self) -> str:
        verdict, digits = "" if self.agrees else ": TOO MUCH", 2
        while self.error > self.promise and f"{self.error:.{digits}g}" == f"{self.promise:.{digits}g}":
            digits += 1
        return f"{self.error:.{digits}g} {self.unit}, promised {self.promise:.{digits}g}{verdict} ({self.count:,} compared)"


def warn_of(checks, advised: set[str] | None = None) -> None:
    """Warns (GuardWarning) of each of the `checks` that does not agree: by its advice, or by how far it is off.

    advised: names of checks whose advice was given already, which is not given again; new ones are added
    """
    advised = set() if advised is None else advised
    for check in checks:
        if check.agrees or check.name in advised:
            continue
        if check.advice:
            advised.add(check.name)
        warn_user(check.advice or f"{check.name}: {check}", GuardWarning)
