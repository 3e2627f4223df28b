"""Runs cases of the fuzzers in a process of their own, which may crash or hang without ending the run."""
from __future__ import annotations

import dataclasses
import multiprocessing
import os
import resource
import sys
import time
import traceback
import warnings
from multiprocessing import forkserver
from pathlib import Path
from unittest.mock import patch

import echopath as ep

HANG = 10.0           # s that one case may compute
STARVED = 12.0        # times as long it may take without computing
PATIENCE = 300.0      # s to start a worker and make its seeds
MEMORY = 3 * 2**30    # bytes of address space of a worker and what it starts: what asks for more is refused, and told
PROCESSORS = 16       # at most that libraries see: the stacks of a thread for each of 256 would leave none of that memory


@dataclasses.dataclass(frozen=True)
class Finding:
    """A case that broke its promise: the target, the case's number, and what happened."""

    target: str
    number: int
    what: str


def run(target: str, numbers, seconds: float = float("inf"), make=None) -> tuple[int, list[Finding]]:
    """Runs the cases of one target, one after the other, for at most `seconds`.

    target: a name of `fuzz.targets.TARGETS`; numbers: of the cases, range. Each number is one case, always the same;
        make: what TARGETS has for the name, where it is no target there
    Returns how many ran, and the findings.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # of the workers: a second thread would wait at full speed
    begin, done, findings = time.monotonic(), 0, []
    context = multiprocessing.get_context("forkserver")
    _start_server()
    while numbers and time.monotonic() - begin < seconds:
        at, since = context.Value("q", -1, lock=False), context.Value("d", time.monotonic(), lock=False)
        results = context.SimpleQueue()
        left = seconds - (time.monotonic() - begin)
        process = context.Process(target=_work, args=(target, make, numbers, left, at, since, results), daemon=True)
        process.start()
        what = _watch(process, at, since, results, target, findings)
        last = at.value
        done += max(0, last + 1 - numbers[0])
        if what:
            findings.append(Finding(target, last, what))
        elif last != numbers[-1]:
            return done, findings  # the time is over
        if last < 0:
            return done, findings  # no case of this target would begin
        numbers = range(last + 1, numbers[-1] + 1)
    return done, findings


def _start_server() -> None:
    """Starts the process whose forks are the workers, unless it runs: it has imported what they need, and has no threads.

    It looks for that where this process does, as a variable tells it: Python 3.11 hands its path to the forks alone.
    """
    forkserver.set_forkserver_preload(["fuzz.targets", "scipy.interpolate"])
    with patch.dict(os.environ, PYTHONPATH=os.pathsep.join(filter(None, sys.path))):
        forkserver.ensure_running()


def _watch(process, at, since, results, target: str, findings: list) -> str:
    """Waits for the end of a worker; returns what went wrong with the whole of it, "" where it ended well."""
    number, cpu = at.value, 0.0
    while process.is_alive():
        process.join(0.05)
        while not results.empty():
            findings.append(Finding(target, *results.get()))
        if at.value != number:
            number, cpu = at.value, _cpu_time(process.pid)
        took = time.monotonic() - since.value
        most = HANG if number >= 0 else PATIENCE
        if took > most:  # on a busy machine others may have had the time
            took = max(_cpu_time(process.pid) - cpu, took / STARVED)
        if took > most:
            process.kill()
            process.join()
            return f"took more than {most:g} s"
    while not results.empty():
        findings.append(Finding(target, *results.get()))
    return "" if process.exitcode == 0 else f"ended the process with {process.exitcode}"


def _cpu_time(pid: int) -> float:
    """Seconds that a process has computed, 0 where it is gone."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _work(target: str, make, numbers, seconds: float, at, since, results) -> None:
    begin = time.monotonic()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:PROCESSORS])
    warnings.simplefilter("ignore")
    ep.set_num_threads(1)  # the cases are small, and results do not depend on it
    case = (make or _target(target))()
    for number in numbers:
        if time.monotonic() - begin > seconds:
            break
        since.value = time.monotonic()
        at.value = number
        try:
            case(number)
        except Exception as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            results.put((number, f"{type(error).__name__}: {error} ({last.name}, line {last.lineno})"))
    since.value = float("inf")  # the end of the process is no case


def _target(name: str):
    from fuzz.targets import TARGETS  # late: it makes no frames where only the worker is tried

    return TARGETS[name]
