"""Datasets made by the workers of a Dask scheduler, which die and join: the same bytes as of one process."""
import hashlib
import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from echopath import dataset
from echopath.cli.dataset import _forecast_line
from support.files.scene_text import SMALL_RADAR

pytest.importorskip("distributed")
TEMPLATE = """
[dataset]
scenes = 4
keep = "labels"
seed = 3
""" + SMALL_RADAR + """\
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
DASK = [sys.executable, "-m", "dask"]


class Cluster:
    """A scheduler and workers of this machine, each a process."""

    def __init__(self, folder: Path):
        self._folder, self._workers = folder, []
        self.start()

    def start(self) -> None:
        told = self._folder / "scheduler.json"
        told.unlink(missing_ok=True)
        self._scheduler = subprocess.Popen(
            [*DASK, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--dashboard-address", "127.0.0.1:0",
             "--scheduler-file", told], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (told.exists() and told.stat().st_size):
            assert self._scheduler.poll() is None
            time.sleep(0.05)
        self.address = json.loads(told.read_text())["address"]

    def join(self) -> None:
        self._workers.append(subprocess.Popen(
            [*DASK, "worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--host", "127.0.0.1",
             "--local-directory", self._folder / "work"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            cwd=self._folder, start_new_session=True))

    def kill_worker(self) -> None:
        _kill(self._workers.pop(0))

    def kill_scheduler(self) -> None:
        _kill(self._scheduler)

    def end(self) -> None:
        for process in (*self._workers, self._scheduler):
            _kill(process)
        self._workers = []


def _kill(process: subprocess.Popen) -> None:
    process.send_signal(signal.SIGKILL)
    process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    made = Cluster(tmp_path_factory.mktemp("dask"))
    made.join()
    yield made
    made.end()


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """(template, folder) that one process made."""
    folder = tmp_path_factory.mktemp("alone")
    (folder / "plates.toml").write_text(TEMPLATE)
    list(dataset.make(folder / "plates.toml", folder / "out"))
    return folder / "plates.toml", folder / "out"


def bytes_of(folder: Path) -> dict:
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
            for file in sorted(folder.rglob("*")) if file.is_file() and file.name != ".claim"}


def made_by(cluster, path, folder, **options) -> list:
    return [one for one in dataset.make(path, folder, scheduler=cluster.address, **options)
            if isinstance(one, dataset.MadeScene)]


def test_a_worker_that_is_killed_is_replaced_by_one_that_joins(cluster, alone, tmp_path):
    path, folder = alone
    run = dataset.make(path, tmp_path / "out", scheduler=cluster.address)
    made = [next(run), next(run)]  # the forecast and a scene
    assert made[0].frames == 4 and made[0].seconds is None  # workers join and leave
    assert "in a time that depends on the workers" in _forecast_line(made[0])
    cluster.kill_worker()
    cluster.join()
    made += run
    assert sorted(one.scene for one in made[1:]) == list(range(4)) and bytes_of(tmp_path / "out") == bytes_of(folder)


def test_workers_find_a_relative_folder_from_where_they_run(cluster, alone, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert [one.record.state for one in made_by(cluster, alone[0], "out", frames=(0, 1))] == ["done"]
    assert len(dataset.open(tmp_path / "out")) == 1


def test_an_address_gets_the_same_files_and_what_is_damaged_is_made_again(cluster, alone, tmp_path):
    path, folder = alone
    same = {name: content for name, content in bytes_of(folder).items() if name != "origin.json"}  # of folders alone
    address = f"file://{tmp_path / 'out'}"
    assert all(one.record.state == "done" for one in made_by(cluster, path, address))
    assert bytes_of(tmp_path / "out") == same
    damaged = tmp_path / "out" / "scenes" / "000003" / "frame_0000.h5"
    damaged.write_bytes(damaged.read_bytes()[:-1] + b"?")
    assert [one.scene for one in made_by(cluster, path, address) if not one.was_there] == [3]
    assert bytes_of(tmp_path / "out") == same
    (tmp_path / "other.toml").write_text(TEMPLATE.replace("num_rays = 400", "num_rays = 500"))
    with pytest.raises(ValueError, match=r"folder: must be new, or of this template \(trace.num_rays is 400 there\)"):
        made_by(cluster, tmp_path / "other.toml", address)


def test_a_scheduler_that_is_killed_ends_the_call_and_another_goes_on(cluster, alone, tmp_path):
    path, folder = alone
    run = dataset.make(path, tmp_path / "out", scheduler=cluster.address)
    next(run), next(run)
    cluster.kill_scheduler()
    with pytest.raises(ConnectionError, match="scheduler: must answer as long as scenes are made"):
        list(run)
    cluster.end()
    cluster.start()
    cluster.join()
    assert sorted(one.scene for one in made_by(cluster, path, tmp_path / "out")) == list(range(4))
    assert bytes_of(tmp_path / "out") == bytes_of(folder)


@pytest.mark.parametrize("folder, options, told", [
    ("s3://bucket/x", {}, "folder: must be no address where there is no scheduler"),
    ("x", {"scheduler": "tcp://127.0.0.1:1", "workers": 2}, "workers: must be 1 where there is a scheduler"),
    ("nosuch://x", {"scheduler": "tcp://127.0.0.1:1"}, "folder: must be a folder, or an address that fsspec knows")])
def test_wrong_places_are_named(alone, monkeypatch, tmp_path, folder, options, told):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=told):
        dataset.make(alone[0], folder, **options)
