"""Time and peak memory of the stages of a run."""
from __future__ import annotations

import dataclasses
import resource
import sys
import time
from contextlib import contextmanager


@dataclasses.dataclass(frozen=True)
class Stage:
    """One stage: name, seconds of wall time, peak_memory of the process during it in bytes, processor_seconds of all threads of
    the process, whatever they worked on."""

    name: str
    seconds: float
    peak_memory: int
    processor_seconds: float


class StageClock:
    """Keeps the stages of a run in their order: `with clock("trace"): ...`."""

    def __init__(self):
        self.stages: list[Stage] = []

    @contextmanager
    def __call__(self, name: str):
        _forget_peak_memory()
        begin, processor = time.perf_counter(), time.process_time()
        yield
        self.stages.append(Stage(name, time.perf_counter() - begin, peak_memory(), time.process_time() - processor))


def peak_memory() -> int:
    """Peak resident memory of the process in bytes, since the last stage began where the system can tell."""
    try:
        with open("/proc/self/status", encoding="ascii") as status:
            for line in status:
                if line.startswith("VmHWM:"):
                    return int(line.split()[1]) * 1024
    except OSError:
        pass
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def _forget_peak_memory() -> None:
    try:
        with open("/proc/self/clear_refs", "w", encoding="ascii") as control:
            control.write("5")
    except OSError:
        pass
