"""What goes wrong around the program: killed, no space, no rights, no memory, Ctrl-C. Each in a process of its own."""
from __future__ import annotations

import select
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import echopath as ep

from .case import Cases

cases = Cases("Faults")
BEGIN = """
import os, resource, signal, sys
from pathlib import Path
import echopath as ep
from echopath.bench.hard.repeat import small_street
signal.signal(signal.SIGINT, signal.default_int_handler)
scene, radar = small_street()
def traced(num_rays, **settings):
    return ep.trace(scene, radar, num_rays=num_rays, **settings)
def error_of(work):
    try:
        work()
    except Exception as error:
        return type(error).__name__ + ": " + str(error)
    return "no error"
"""
PATIENCE = 120.0  # s
PROMISED = 0.5  # s, from Ctrl-C to its KeyboardInterrupt
STUCK = 10.0      # s after which nobody has heard Ctrl-C


def start(code: str, *arguments):
    """A Python process that runs `code` behind BEGIN."""
    return subprocess.Popen([sys.executable, "-c", BEGIN + code, *map(str, arguments)], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def run(code: str, *arguments) -> list[str]:
    """Lines that the process printed; raises RuntimeError where it failed."""
    process = start(code, *arguments)
    printed, errors = process.communicate(timeout=PATIENCE)
    if process.returncode != 0:
        raise RuntimeError(f"the process ended with {process.returncode}: {errors[-500:]}")
    return printed.splitlines()


WRITE_FOR_EVER = """
records = [traced(6000, seed=seed) for seed in (1, 2)]
records[0].save(sys.argv[1])
print("ready", flush=True)
while True:
    for paths in records:
        paths.save(sys.argv[1])
"""


@cases("kill -9 while a file is written", "files that are neither the old nor the new one", bound=0.0, unit="files",
       broken="files written in place: 4")
def killed() -> float:
    return float(sum(killed_after(delay) for delay in (0.003, 0.011, 0.023, 0.05)))


def killed_after(delay: float) -> bool:
    """Whether a process that is killed `delay` s into its writing leaves a file that is neither the old nor the new one."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "paths.h5"
        process = start(WRITE_FOR_EVER, path)
        process.stdout.readline()
        time.sleep(delay)
        process.kill()
        process.communicate(timeout=PATIENCE)
        try:
            return ep.Paths.load(path).frame.seed not in (1, 2)
        except OSError:
            return True


NO_SPACE = """
paths = traced(6000, seed=1)
path = Path(sys.argv[1])
paths.save(path)
before = path.read_bytes()
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, resource.RLIM_INFINITY))
print(error_of(lambda: traced(6000, seed=2).save(path)))
resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
print(path.read_bytes() == before, len(list(path.parent.iterdir())), len(os.listdir("/proc/self/fd")))
paths.save(path)
print(path.read_bytes() == before, len(list(path.parent.iterdir())), len(os.listdir("/proc/self/fd")))
"""


@cases("no space left", "a file error that names the file; the old file stays, nothing else is left behind, and the next "
       "write works (of these five, broken)", bound=0.0, unit="promises",
       broken="files written in place: 1; errors of the system passed on: 2")
def no_space() -> float:
    with tempfile.TemporaryDirectory() as folder:
        error, after, later = run(NO_SPACE, Path(folder) / "paths.h5")
    (same, count, handles), (_, count_later, handles_later) = after.split(), later.split()
    promises = [error.startswith("FileError: "), "paths.h5" in error, same == "True", count == count_later == "1",
                handles == handles_later]
    return float(len(promises) - sum(promises))


@cases("a folder that cannot be written", "a file error that names the file", bound=0.0, unit="promises broken",
       broken="errors of the system passed on: FileExistsError")
def unwritable() -> float:
    from .repeat import small_street

    scene, radar = small_street(2)
    paths = ep.trace(scene, radar, num_rays=200)
    broken = 0
    with tempfile.NamedTemporaryFile() as file:
        for path in (Path(file.name) / "paths.h5", Path("/proc/echopath/paths.h5"), Path("/proc/self/paths.h5")):
            try:
                paths.save(path)
                broken += 1
            except ep.FileError as error:
                broken += "paths.h5" not in str(error)
    return float(broken)


NO_MEMORY = """
traced(1000)
pages = [int(word) for word in open("/proc/self/statm").read().split()[:2]]
limit, before = pages[0] * resource.getpagesize() + (300 << 20), pages[1] * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))
print(error_of(lambda: traced(3000000, max_bounces=16)))
resident = int(open("/proc/self/statm").read().split()[1]) * resource.getpagesize()
print((resident - before) >> 20)
print(traced(1000).num_paths > 0)
"""


@cases("memory exceeded",
       "300 MiB for a record of a gigabyte: MemoryError, what was made is given back (but for the room that "
       "threads keep, less than half) and the next trace works (of these three, broken)", bound=0.0, unit="promises",
       broken="blocks of rays kept after the failure: 1")
def no_memory() -> float:
    error, kept, works = run(NO_MEMORY)
    promises = [error.startswith("MemoryError"), int(kept) < 150, works == "True"]
    return float(len(promises) - sum(promises))


INTERRUPTED = """
work = {
    "trace": lambda: traced(30000000),
    "synthesis": lambda: ep.synthesize(paths, wide, method="direct"),
    "file": lambda: [paths.save(sys.argv[1] + str(k)) for k in range(10000)],
    "factors": lambda: ep.cfar(spectrum, wide, guard_velocity=2, guard_range=2, training_velocity=12,
                               training_range=31),
}[sys.argv[2]]
if sys.argv[2] != "trace":
    paths = traced(30000)
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=512,
                              chirp_interval=4e-5)
    wide = ep.Radar(chirps, transmitters=radar.transmitters, receivers=radar.receivers)
if sys.argv[2] == "factors":
    spectrum = ep.range_doppler(ep.synthesize(paths, wide), wide)
print("ready", flush=True)
try:
    work()
    print("ended")
except KeyboardInterrupt:
    half_written = [name for name in os.listdir(os.path.dirname(sys.argv[1])) if name.startswith(".")]
    sys.stdout.write(f"stopped {len(half_written)}\\n")  # at once: nobody reads half a line
"""


@cases("Ctrl-C", "time from Ctrl-C to KeyboardInterrupt in trace, synthesis, factors of CFAR's largest windows and, three "
       "times, file writing; no half-written file is left; the least of up to five tries each, as the machine may have other "
       "work", bound=1.5, unit="s",
       broken="a job that cannot be cancelled: no answer within 10 s")
def ctrl_c() -> float:
    moments = (("trace", 0.3), ("synthesis", 0.3), ("factors", 0.3), ("file", 0.3), ("file", 0.4), ("file", 0.5))
    return max(least_of_tries(work, delay) for work, delay in moments)


def least_of_tries(work: str, delay: float) -> float:
    """`stopped_after`, of a try that keeps the promise or the best of five; infinity as soon as one does not stop."""
    found: list[float] = []
    while len(found) < 5 and (not found or PROMISED < min(found) and max(found) < float("inf")):
        found.append(stopped_after(work, delay))
    return max(found) if max(found) == float("inf") else min(found)


def stopped_after(work: str, delay: float) -> float:
    """Seconds that a process takes to stop after Ctrl-C; infinity where it did not or left something half written."""
    with tempfile.TemporaryDirectory() as folder:
        process = start(INTERRUPTED, Path(folder) / "paths.h5", work)
        process.stdout.readline()
        time.sleep(delay)
        sent = time.perf_counter()
        process.send_signal(signal.SIGINT)
        select.select([process.stdout], [], [], STUCK)
        took = time.perf_counter() - sent
        process.kill()
        answer = process.communicate(timeout=PATIENCE)[0].split()
    return took if answer == ["stopped", "0"] else float("inf")
