"""Processes that make the scenes of a dataset beside each other."""
from __future__ import annotations

import multiprocessing
import os
import signal
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from .. import _core
from ..base.process.callers import warn_user
from ..base.process.threads import set_num_threads
from .folder import RECORD, SceneRecord, read_record, scene_folder
from .scene_work import claimed, make_scene, tidy
from .template import Template

PAUSE = 0.2  # s between looks for what others have made
_THREADS_OF_LIBRARIES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

Done = tuple[int, SceneRecord]


def in_this_process(template: Template, folder: Path, scenes: Sequence[int], run: str) -> Iterator[Done]:
    """Makes the scenes that nobody else makes, then waits for those that others have claimed, and takes over what they leave.

    Raises ep.FileError where files cannot be written.
    """
    waiting = list(scenes)
    while waiting:
        claimed_by_others = []
        for scene in waiting:
            with claimed(folder, scene) as is_mine:
                if not is_mine:
                    claimed_by_others.append(scene)
                    continue
                record = read_record(folder, scene)
                if record.state == "to do":
                    record = make_scene(template, folder, scene, run)
                else:
                    tidy(folder, scene)
            yield scene, record
        waiting = claimed_by_others
        if waiting:
            time.sleep(PAUSE)


def turned(scenes: Sequence[int], index: int, count: int) -> list[int]:
    """The scenes in the order of worker `index` of `count`: each begins elsewhere, so that they meet no sooner than they must."""
    return [scene for other in range(count) for scene in scenes[(index + other) % count::count]]


def in_processes(path: Path, folder: Path, scenes: Sequence[int], run: str, count: int) -> Iterator[Done]:
    """The same by `count` processes with an equal share of the processors each. One that dies is replaced.

    path: of the template. Warns as they do, of each text once. Raises ep.FileError where one of them cannot write a file,
    ChildProcessError where they go on dying, or end before they begin, as in a script without a guard of its main module.
    """
    context = multiprocessing.get_context("spawn")
    threads = max(1, (os.cpu_count() or 1) // count)
    listener = _Listener()

    def start(index: int) -> Any:
        said, saying = context.Pipe(duplex=False)
        args = (str(path), str(folder), turned(scenes, index, count), run, threads, saying, os.getpid())
        process = context.Process(target=_work, args=args, daemon=True)
        with saying, _libraries_take(threads):
            process.start()
        listener.hear(said)
        return process

    processes = [start(index) for index in range(count)]
    try:
        yield from _watched(folder, scenes, processes, start, listener)
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            process.join()


@contextmanager
def _libraries_take(threads: int) -> Iterator[None]:
    """Processes that begin in the block have so many threads in NumPy's libraries, too, unless the caller's environment says how
    many: theirs wait for each other with the processor running."""
    added = [name for name in _THREADS_OF_LIBRARIES if name not in os.environ]
    os.environ |= dict.fromkeys(added, str(threads))
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]


class _Listener:
    """Repeats what workers say: warnings once for each text, and errors. have_begun: whether any has said (None) that it works

    Each worker has a pipe of its own. One queue for all has locks: a worker that is killed while it speaks would hold them for
    ever, and named semaphores of killed processes stay in the system.
    """

    def __init__(self) -> None:
        self._pipes: list[Connection] = []
        self._heard: set[str] = set()
        self.have_begun = False

    def hear(self, pipe: Connection) -> None:
        """Repeats from now on what comes through the pipe, too."""
        self._pipes.append(pipe)

    def repeat(self) -> None:
        """Repeats all that has been said since."""
        while ready := wait(self._pipes, timeout=0):
            for pipe in ready:
                self._repeat_next(pipe)

    def _repeat_next(self, pipe: Any) -> None:
        try:
            said = pipe.recv()
        except (EOFError, OSError):  # its worker has ended, or was killed within a word
            self._pipes.remove(pipe)
            pipe.close()
            return
        self.have_begun = True
        if said is None:
            return
        if not isinstance(said, Warning):
            raise said
        if str(said) not in self._heard:
            self._heard.add(str(said))
            warn_user(str(said), type(said))


def _watched(folder: Path, scenes: Sequence[int], processes: list[Any], start: Callable[[int], Any],
             listener: _Listener) -> Iterator[Done]:
    """What the processes make, as it comes."""
    missing, deaths = list(scenes), 0
    most_deaths = 3 * len(processes) + len(scenes)
    while missing:
        time.sleep(PAUSE)
        ended = [process.exitcode is not None for process in processes]
        listener.repeat()
        for scene in list(missing):
            record = read_record(folder, scene)
            if record.state != "to do":
                missing.remove(scene)
                yield scene, record
        for index, process in enumerate(processes):
            if missing and ended[index]:
                deaths += process.exitcode != 0
                if process.exitcode > 0 and not listener.have_begun:  # it was not killed
                    raise ChildProcessError("workers: end before they begin, as each reads the script that asks for them: what "
                                            "calls make there belongs below if __name__ == '__main__':")
                if deaths > most_deaths:
                    raise ChildProcessError(f"workers: {deaths} of them died, the last with exit code {process.exitcode}")
                processes[index] = start(index)
    listener.repeat()


def _work(path: str, folder: str, scenes: list[int], run: str, threads: int, saying: Connection,
          parent: int) -> None:
    def say(what: Warning | _core.FileError | None) -> None:
        """What stands here: a warning, the error of a file that cannot be written, or None, that it works."""
        with suppress(BrokenPipeError):  # the command was killed
            saying.send(what)

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started this one
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    set_num_threads(threads)
    say(None)
    warnings.showwarning = lambda message, *place: say(message)
    try:
        for _ in in_this_process(Template(Path(path)), Path(folder), scenes, run):
            if os.getppid() != parent:  # the command was killed
                return
    except _core.FileError as error:
        say(error)


def forget(folder: Path, scenes: Sequence[int]) -> None:
    """Makes scenes that failed to do again."""
    for scene in scenes:
        (scene_folder(folder, scene) / RECORD).unlink(missing_ok=True)
