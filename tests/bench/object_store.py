"""Datasets in an object store on this machine: calls, workers and the store itself are killed, and the bytes compared.

    pip install moto[s3,server] s3fs; python tests/bench/object_store.py

Prints a line for each case; those of an undisturbed run in a folder are the bytes that all must have. Ends with 1 where one has
not.
"""
from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import fsspec

from echopath import dataset

PORT = 5599
TEMPLATE = """
[dataset]
scenes = 8
keep = "labels"
seed = 3
[radar.waveform]
start_frequency = 77e9
bandwidth = 1e9
num_samples = 32
sampling_rate = 1e6
num_chirps = 8
chirp_interval = 1e-4
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.01, 1.0]
[[objects]]
name = "plate"
actor = "plate"
parameters = {width = 0.2, height = {uniform = [0.1, 0.3]}}
position = [{uniform = [1.5, 4.0]}, 0.0, 1.0]
yaw_deg = 180.0
material = "metal"
[trace]
num_rays = 400
"""
os.environ |= {"AWS_ACCESS_KEY_ID": "none", "AWS_SECRET_ACCESS_KEY": "none", "AWS_DEFAULT_REGION": "us-east-1",
               "AWS_ENDPOINT_URL": f"http://127.0.0.1:{PORT}"}


class Machines:
    """The store, a scheduler and two workers: processes of this machine."""

    def __init__(self, folder: Path):
        self._folder, self._processes = folder, []
        self.store = self._start("-c", f"from moto.server import main; main(['-H', '127.0.0.1', '-p', '{PORT}'])")
        told = folder / "scheduler.json"
        self._start("-m", "dask", "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--dashboard-address",
                    "127.0.0.1:0", "--scheduler-file", str(told))
        while not (told.exists() and told.stat().st_size):
            time.sleep(0.1)
        self.scheduler = json.loads(told.read_text())["address"]
        self.workers = [self.join(), self.join()]

    def join(self) -> subprocess.Popen:
        return self._start("-m", "dask", "worker", self.scheduler, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--host",
                           "127.0.0.1", "--local-directory", str(self._folder / "work"))

    def call(self, place: str) -> subprocess.Popen:
        """A call of the command that makes the dataset at a place of the store."""
        own = ("-m", "echopath", "dataset", str(self._folder / "plates.toml"), "--out", f"s3://bucket/{place}")
        return self._start(*own, "--scheduler", self.scheduler, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def end(self) -> None:
        for process in self._processes:
            process.kill()
            process.wait()

    def _start(self, *words: str, **options) -> subprocess.Popen:
        options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL} | options
        self._processes.append(subprocess.Popen([sys.executable, *words], cwd=self._folder, **options))
        return self._processes[-1]


class Place:
    """A dataset in the store."""

    def __init__(self, machines: Machines, name: str):
        self.machines, self.name, self.files = machines, name, fsspec.filesystem("s3", use_listings_cache=False)
        self.root = f"bucket/{name}"

    def made(self) -> None:
        self.machines.call(self.name).communicate()

    def bytes(self) -> dict[str, str]:
        return {path[len(self.root) + 1:]: hashlib.sha256(self.files.cat_file(path)).hexdigest()
                for path in self.files.find(self.root)}

    def wait_for_a_frame(self) -> None:
        while not any("frame_" in path for path in self.files.find(self.root)):
            time.sleep(0.05)


def undisturbed(place: Place) -> None:
    place.made()


def damaged(place: Place) -> None:
    place.made()
    place.files.pipe_file(f"{place.root}/scenes/000003/frame_0000.h5", b"broken")
    place.files.rm_file(f"{place.root}/scenes/000005/drawn.json")
    place.made()


def killed(place: Place) -> None:
    """The call and a worker."""
    call = place.machines.call(place.name)
    place.wait_for_a_frame()
    place.machines.workers.pop().kill()
    call.kill()
    place.machines.workers.append(place.machines.join())
    place.made()


def two_at_once(place: Place) -> None:
    for call in [place.machines.call(place.name) for _ in range(2)]:
        call.communicate()


CASES: tuple[Callable[[Place], None], ...] = (undisturbed, damaged, killed, two_at_once)


def main() -> int:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "plates.toml").write_text(TEMPLATE)
        list(dataset.make(folder / "plates.toml", folder / "here"))
        want = {str(path.relative_to(folder / "here")): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in (folder / "here").rglob("*") if path.is_file() and path.name != ".claim"}
        machines = Machines(folder)
        try:
            return max([_told(case, Place(machines, case.__name__), want) for case in CASES] + [_store_gone(machines)])
        finally:
            machines.end()


def _told(case: Callable[[Place], None], place: Place, want: dict[str, str]) -> int:
    case(place)
    found = place.bytes()
    print(f"{case.__name__}: {len(found)} files, {'equal' if found == want else 'NOT equal'}", flush=True)
    return int(found != want)


def _store_gone(machines: Machines) -> int:
    machines.store.kill()
    call = machines.call("gone")
    said = call.communicate()[0].splitlines()[-1]
    print(f"store gone: ends with {call.returncode}: {said}")
    return int(call.returncode == 0 or "cannot be read" not in said)


if __name__ == "__main__":
    sys.exit(main())
