"""How making a dataset grows with workers, and what memory each takes.

Growth is the processor time of one worker over that of the busiest of several for the same scenes: what the machine would show in
wall time if nothing else ran on it.
"""
from __future__ import annotations

import multiprocessing
import resource
import tempfile
import time
import uuid
from importlib.resources import as_file
from pathlib import Path

from ...base.process.threads import set_num_threads
from ...base.storage.data_folder import data_folder
from ...dataset.folder import prepare_folder
from ...dataset.template import Template
from ...dataset.workers import in_this_process, turned

SCENES, QUICK_SCENES = 12, 4
TEMPLATE = "crossing"
COUNTS = (1, 2, 4)
LEAST_GROWTH = 0.9               # of the number of workers
MOST_MEMORY = 1.5 * 2.0 ** 30    # bytes of a worker


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each number of workers: growth, processor seconds of a frame, start and peak memory of a worker."""
    scenes = QUICK_SCENES if quick else SCENES
    found: list[dict] = []
    with as_file(data_folder("datasets") / f"{TEMPLATE}.toml") as path:
        frames = Template(path).settings.frames
        for count in COUNTS[:2] if quick else COUNTS:
            workers = _run(path, scenes, count)
            busiest = max(one["seconds"] for one in workers)
            alone = found[0]["busiest"] if found else busiest
            found.append({"workers": count, "frames": scenes * frames, "busiest": busiest,
                          "seconds": sum(one["seconds"] for one in workers), "growth": alone / busiest,
                          "holds": alone / busiest >= LEAST_GROWTH * count,
                          "start": max(one["start"] for one in workers), "memory": max(one["memory"] for one in workers),
                          "memory_holds": max(one["memory"] for one in workers) <= MOST_MEMORY})
    return found


def describe(rows: list[dict]) -> list[str]:
    """Lines for people."""
    lines = [f"{'workers':<9}{'frames':>7}{'processor s':>13}{'busiest s':>11}{'growth':>8}{'start s':>9}{'MiB a worker':>14}"]
    for row in rows:
        least = f"  at least {LEAST_GROWTH * row['workers']:.1f}: {'holds' if row['holds'] else 'MISSED'}"
        growth = "" if row["workers"] == 1 else least
        memory = f"  at most {MOST_MEMORY / 2 ** 20:.0f} MiB: {'holds' if row['memory_holds'] else 'MISSED'}"
        lines.append(f"{row['workers']:<9}{row['frames']:7d}{row['seconds']:13.2f}{row['busiest']:11.2f}{row['growth']:8.2f}"
                     f"{row['start']:9.2f}{row['memory'] / 2 ** 20:14.0f}{growth}{memory}")
    return lines


def _run(path: Path, scenes: int, count: int) -> list[dict]:
    """Makes the first scenes of a template by so many processes of one thread; what each of them tells."""
    # What this process spawned would count its peak of memory as its own; what a small server forks does not.
    context = multiprocessing.get_context("forkserver")
    told = context.SimpleQueue()
    with tempfile.TemporaryDirectory() as folder:
        prepare_folder(Path(folder), Template(path))
        run = uuid.uuid4().hex
        processes = [context.Process(target=_work, args=(str(path), folder, turned(range(scenes), index, count), run, told))
                     for index in range(count)]
        for process in processes:
            process.start()
        for process in processes:
            process.join()
    if any(process.exitcode for process in processes):
        raise RuntimeError("dataset: a worker of the benchmark has failed, and said why")
    return [told.get() for _ in processes]


def _work(path: str, folder: str, scenes: list[int], run: str, told) -> None:
    start = time.process_time()  # of the interpreter and what it imported
    set_num_threads(1)
    template = Template(Path(path))
    for _, record in in_this_process(template, Path(folder), scenes, run):
        if record.state != "done":
            raise RuntimeError(f"a scene of the benchmark failed: {record.reason}")
    told.put({"start": start, "seconds": time.process_time() - start, "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
              * 1024})
