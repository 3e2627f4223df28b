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
from echopath.actors import shapes
signal.signal(signal.SIGINT, signal.default_int_handler)
scene = ep.Scene()
scene.add(shapes.sphere(0.4), name="ball", material=ep.Material(permittivity=4 - 0.2j, scattering=0.6), position=(6.0, 0.5, 0.2))
scene.add(shapes.wall(40.0, 6.0), name="wall", material=ep.Material(permittivity=5 - 0.3j, scattering=0.3, mirror=True),
          position=(10.0, 3.0, -2.0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=16,
                          chirp_interval=30e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0.0, 0.002 * k, 0.0)) for k in range(3)])
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
TRIES = 5         # of one work, as the machine may have other work


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
       broken="files written in place: 2")
def killed() -> float:
    return float(sum(killed_after(delay) for delay in (0.003, 0.023)))


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
scene.add(shapes.box(60.0), name="room", material=ep.Material(reflectivity=0.5, scattering=1.0))  # no ray gets out
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
paths = traced(30000)
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=512,
                          chirp_interval=4e-5)
wide = ep.Radar(chirps, transmitters=radar.transmitters, receivers=radar.receivers)
one = ep.Radar(chirps, transmitters=radar.transmitters, receivers=radar.receivers[:1])
spectrum = ep.range_doppler(ep.synthesize(traced(300), one), one)
works = {
    "trace": lambda: traced(30000000),
    "synthesis": lambda: ep.synthesize(paths, wide, method="direct"),
    "file": lambda: [paths.save(sys.argv[1] + str(k)) for k in range(10000)],
    "factors": lambda: ep.cfar(spectrum, one, guard_velocity=2, guard_range=2, training_velocity=12, training_range=31),
}
for name in sys.argv[2:]:
    try:
        print("ready", flush=True)
        works[name]()
        print("ended", flush=True)
    except KeyboardInterrupt:
        half_written = [name for name in os.listdir(os.path.dirname(sys.argv[1])) if name.startswith(".")]
        sys.stdout.write(f"stopped {len(half_written)}\\n")  # at once: nobody reads half a line
        sys.stdout.flush()
"""


@cases("Ctrl-C", "time from Ctrl-C to KeyboardInterrupt in trace, synthesis, factors of CFAR's largest windows and, three "
       "times, file writing; no half-written file is left; the least of up to five tries each, as the machine may have other "
       "work", bound=1.5, unit="s",
       broken="a job that cannot be cancelled: no answer within 10 s")
def ctrl_c() -> float:
    moments = [("trace", 0.1), ("synthesis", 0.1), ("factors", 0.1), ("file", 0.1), ("file", 0.14), ("file", 0.18)]
    best = [float("inf")] * len(moments)
    for _ in range(TRIES):
        late = [k for k, seconds in enumerate(best) if seconds > PROMISED]
        for k, seconds in zip(late, stopped_after([moments[k] for k in late])):
            if seconds == float("inf"):
                return seconds
            best[k] = min(best[k], seconds)
    return max(best)


def stopped_after(moments) -> list[float]:
    """Seconds that one process takes to stop each work after Ctrl-C, which comes a delay in s into it; infinity, the last
    one, where it did not or left something half written."""
    took: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        process = start(INTERRUPTED, Path(folder) / "paths.h5", *(work for work, _ in moments))
        for _, delay in moments:
            process.stdout.readline()
            time.sleep(delay)
            sent = time.perf_counter()
            process.send_signal(signal.SIGINT)
            is_heard, *_ = select.select([process.stdout], [], [], STUCK)
            took.append(time.perf_counter() - sent)
            if not is_heard or process.stdout.readline().split() != ["stopped", "0"]:
                took[-1] = float("inf")
                break
        process.kill()
        process.communicate(timeout=PATIENCE)
    return took
