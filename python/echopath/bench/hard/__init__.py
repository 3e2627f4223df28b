"""`echopath bench hard`: what breaks ray tracers and coherent sums, each case with its bound and the value measured."""
from __future__ import annotations

import dataclasses
import time

from ...base.storage.files import write_texts
from ..machine import machine
from ..steps import json_text, told
from . import faults, geometry, heavy, materials, meshes, motions, oracle, places, repeat, scenes, signals
from .case import Case
from .page import page

GROUPS = (signals, geometry, meshes, places, materials, motions, repeat, faults, heavy, oracle)


@dataclasses.dataclass(frozen=True)
class Result:
    """What one case measured: value, whether it holds, seconds; error: why there is no value, "" where there is one."""

    case: Case
    value: float
    seconds: float
    error: str = ""

    @property
    def holds(self) -> bool:
        return not self.error and self.case.holds(self.value)


def all_cases(*, with_heavy: bool = True) -> list[Case]:
    """All cases in the order of the page; with_heavy: those that take too long for a test suite too."""
    return [case for group in GROUPS for case in group.cases if with_heavy or not case.is_heavy]


def measure(case: Case) -> Result:
    """Runs one case; what it raises becomes the error of its result."""
    began = time.perf_counter()
    try:
        value, error = float(case.measure()), ""
    except Exception as raised:  # a case that cannot be run has failed, and the others go on
        value, error = float("nan"), f"{type(raised).__name__}: {raised}"
    return Result(case, value, time.perf_counter() - began, error)


def run_hard(folder, *, quick: bool = False, progress=None) -> list[Result]:
    """Measures all cases, writes hard.md and hard.json into `folder` and returns the results.

    quick: without the heavy cases; progress: callable (stage, fraction) or None
    """
    results = [measure(case) for case in told(all_cases(with_heavy=not quick), "hard", progress)]
    rows = [{"group": one.case.group, "case": one.case.name, "bound": one.case.bound_text, "value": one.value,
             "holds": one.holds, "seen_to_fail": one.case.broken, "seconds": one.seconds, "error": one.error}
            for one in results]
    write_texts(folder, {"hard.md": page(results, described(machine())),
                         "hard.json": json_text({"machine": machine(), "cases": rows})})
    return results


def described(where: dict) -> str:
    """The machine of the figures in one line."""
    return f"{where['processor']}, {where['threads']} threads, Python {where['python']}, echopath {where['echopath']}"


def describe(results: list[Result]) -> list[str]:
    """Lines for the terminal: those that do not hold, then a count."""
    lines = [f"  {one.case.name}: {one.error or f'{one.value:.4g} {one.case.unit}'}, bound {one.case.bound_text}"
             for one in results if not one.holds]
    head = ["bounds that do not hold"] if lines else []
    holding, seconds = sum(one.holds for one in results), sum(one.seconds for one in results)
    return [*head, *lines, f"{holding} of {len(results)} hard cases hold, in {seconds:.0f} s"]
