"""A hard case: what is expected, the bound, and a function that measures the value."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable


@dataclasses.dataclass(frozen=True)
class Case:
    """One hard case.

    name: unique; group: heading of the page; expected: what must hold, in words
    bound: of the measured value, in `unit`, largest or (at_least) smallest
    measure: callable () -> value; is_heavy: too long for a test suite
    broken: how the case was seen to fail: what was taken out of the program, and the value that came out
    """

    name: str
    group: str
    expected: str
    bound: float
    unit: str
    measure: Callable[[], float]
    broken: str
    at_least: bool = False
    is_heavy: bool = False

    def holds(self, value: float) -> bool:
        """Whether a measured value keeps to the bound; NaN does not."""
        return value >= self.bound if self.at_least else value <= self.bound

    @property
    def bound_text(self) -> str:
        return f"{'>=' if self.at_least else '<='} {self.bound:.5g} {self.unit}".rstrip()


class Cases(list):
    """Cases of one group, filled by a decorator: @cases("name", "expected", bound=1e-6, unit="m", broken="...")."""

    def __init__(self, group: str):
        super().__init__()
        self.group = group

    def __call__(self, name: str, expected: str, *, bound: float, broken: str, unit: str = "", at_least: bool = False,
                 heavy: bool = False):
        def keep(measure):
            self.append(Case(name, self.group, expected, bound, unit, measure, broken, at_least, heavy))
            return measure

        return keep
