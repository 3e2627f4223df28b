"""Opens a stage in a process of its own first: some damaged binary files end the process that opens them by USD's own library,
fill its memory, or keep it busy for minutes."""
from __future__ import annotations

import functools
import mmap
import os
import signal
import subprocess
import sys
from multiprocessing.spawn import get_executable
from pathlib import Path

from ... import _core

MOST_SECONDS = 100.0  # that opening may take, and one more for each MiB of the file
THREAD_BYTES = 2**28  # of addresses of each of USD's threads, beside half as many as the machine has bytes of memory
REFUSED = 3           # what the process returns where it can say what is wrong, which it prints

_OPEN = f"""
import resource, sys
for kind, most in ((resource.RLIMIT_AS, int(sys.argv[2])), (resource.RLIMIT_CORE, 0)):
    hard = resource.getrlimit(kind)[1]
    resource.setrlimit(kind, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))
from pxr import Tf, Usd
try:
    Usd.Stage.Open(sys.argv[1])
except MemoryError:
    print("it needs more memory than there is")
    sys.exit({REFUSED})
except Tf.ErrorException as error:
    if error.args:
        print(error.args[0].commentary[:1000])
        sys.exit({REFUSED})
"""


def refuse_what_ends_usd(path: Path) -> None:
    """Raises FileError for a file on which USD crashes or takes minutes, and for what it refuses so.

    Returns for others, be they stages or not. Text that refers to no other file is not tried: USD reads or refuses all of it.
    """
    if _has_python() and path.is_file() and not _is_text_alone(path):
        told = path.stat()
        _try(path, told.st_size, told.st_mtime_ns)


@functools.lru_cache(1000)  # of those that opened, which the scenes of a dataset read again and again
def _try(path: Path, size: int, changed: int) -> None:
    """Raises as `refuse_what_ends_usd`. size, changed: bytes and ns, by which a file is known to be another one by then"""
    longest = MOST_SECONDS + size / 2**20
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2 + THREAD_BYTES * (os.cpu_count() or 1)
    try:
        done = _opened_apart(path, longest, memory)
    except subprocess.TimeoutExpired:
        raise unreadable(path, f"USD takes more than {longest:.0f} s to open it") from None
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
        raise unreadable(path, f"USD crashes on it by {name}, or needs more than {memory / 2**30:.0f} GiB")
    if done.returncode == REFUSED:
        raise unreadable(path, first_line(done.stdout))


def unreadable(path: Path, why: str) -> _core.FileError:
    """The error of a file that USD cannot read."""
    return _core.FileError(f"{path}: is no USD stage that can be read ({why})")


def first_line(text: str) -> str:
    """The first line of what USD says, short enough to be shown."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return (lines[0] if lines else "no reason given")[:300]


def _has_python() -> bool:
    """Whether there is a program of Python: none in one that holds Python itself."""
    return bool(get_executable()) and not getattr(sys, "frozen", False)


def _opened_apart(path: Path, seconds: float, memory: int) -> subprocess.CompletedProcess:
    searched = os.pathsep.join(folder for folder in sys.path if folder)
    return subprocess.run([get_executable(), "-S", "-c", _OPEN, path, str(memory)],
                          env=os.environ | {"PYTHONPATH": searched}, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True, errors="replace", timeout=seconds, check=False)


def _is_text_alone(path: Path) -> bool:
    with path.open("rb") as file:
        if file.read(5) != b"#usda":
            return False
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
            return content.find(b"@") < 0
