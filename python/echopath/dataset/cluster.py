"""Scenes of a dataset made by the workers of a Dask scheduler, into a folder that all see or an address of fsspec."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ..base.process.libraries import needed_module
from ..base.process.threads import set_num_threads
from .address import Address, is_address
from .folder import RECORD, SceneRecord, absolute, record_text, scene_folder, scene_name
from .scene_work import make_scene
from .template import Template
from .workers import Done, in_this_process

_AHEAD = 2       # tasks for each thread of a worker that wait at the scheduler
_WAIT = "10s"    # for the scheduler to answer


def in_dask(scheduler: str, path: Path, folder: str, scenes: Sequence[int], run: str) -> Iterator[Done]:
    """Makes the scenes by the workers of a scheduler, one task each of one thread; workers may die and join.

    scheduler: its address; path: of the template; folder: of the dataset, or an address: the workers, wherever they run, see both
        under the same absolute names
    Raises ModuleNotFoundError without distributed, ConnectionError naming `scheduler` where that cannot be reached or goes away,
    ep.FileError where a worker cannot write.
    """
    distributed = needed_module("distributed", "scheduler", extra="cluster")
    try:
        client = distributed.Client(scheduler, set_as_default=False, timeout=_WAIT)
    except (OSError, ValueError) as error:
        raise _unreached(scheduler, error) from None
    where = folder if is_address(folder) else str(Path(folder).resolve())
    lost = (distributed.client.FutureCancelledError, distributed.comm.CommClosedError)
    try:
        yield from _as_they_come(distributed, client, str(absolute(path)), where, iter(scenes), run)
    except lost as error:
        raise _unreached(scheduler, error) from None
    finally:
        with suppress(RuntimeError):  # a client that has just lost its scheduler may stumble over timeouts of its own
            client.close()


def _unreached(scheduler: str, error: Exception) -> ConnectionError:
    reason = f"'{scheduler}' does not ({type(error).__name__}: {error}); the same call goes on"
    return ConnectionError(f"scheduler: must answer as long as scenes are made, {reason}")


def _as_they_come(distributed: Any, client: Any, path: str, folder: str, waiting: Iterator[int], run: str) -> Iterator[Done]:
    scene_of: dict[Any, int] = {}

    def room() -> int:
        try:
            return _AHEAD * max(1, sum(client.nthreads().values()))
        except OSError as error:
            raise distributed.comm.CommClosedError(str(error)) from None

    def submitted(count: int) -> list[Any]:
        futures = []
        for scene in islice(waiting, count):
            future = client.submit(make_as_worker, path, folder, scene, run, key=f"echopath-{run}-{scene}", pure=False)
            scene_of[future] = scene
            futures.append(future)
        return futures

    running = distributed.as_completed(submitted(room()), loop=client.loop)
    for future in running:
        try:
            record = SceneRecord(*future.result())
        except distributed.KilledWorker:
            record = SceneRecord("failed", reason="workers died at it")
        yield scene_of.pop(future), record
        running.update(submitted(room() - len(scene_of)))


def make_as_worker(path: str, folder: str, scene: int, run: str) -> tuple[Any, ...]:
    """Makes a scene, with one thread; returns the fields of its record. Raises ep.FileError."""
    set_num_threads(1)
    template = Template(Path(path))
    if is_address(folder):
        return tuple(_made_at(Address(folder), template, scene, run))
    (_, record), = in_this_process(template, Path(folder), [scene], run)
    return tuple(record)


def _made_at(address: Address, template: Template, scene: int, run: str) -> SceneRecord:
    """Makes a scene in a folder of its own and puts its files to an address, the record last."""
    with TemporaryDirectory(prefix="echopath-") as own:
        scene_folder(Path(own), scene).mkdir(parents=True)
        record = make_scene(template, Path(own), scene, run)
        for name in record.files:
            address.put(f"{scene_name(scene)}/{name}", (scene_folder(Path(own), scene) / name).read_bytes())
    address.put(f"{scene_name(scene)}/{RECORD}", record_text(record).encode())
    address.tidy(scene)
    return record
