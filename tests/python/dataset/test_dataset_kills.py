"""Datasets whose making is ended by a kill or a full disk: every frame is there once, with the same bits."""
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from echopath.cli import main
from echopath.dataset.folder import scene_folder, write_record
from support.files.small_dataset import bytes_of, make


def command(path: Path, folder: Path, *options: str) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-m", "echopath", "dataset", path, "--out", folder, *options],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)


@pytest.mark.parametrize("workers", ["1", "2"])
def test_a_killed_command_is_gone_on_with(small_dataset, tmp_path, capsys, workers):
    path, folder = small_dataset
    killed = command(path, tmp_path, "--workers", workers)
    killed.stdout.readline()
    while killed.poll() is None and not any(tmp_path.rglob("frame_*.h5")):
        time.sleep(0.01)
    os.killpg(killed.pid, signal.SIGKILL)
    killed.communicate()
    assert main(["dataset", str(path), "--out", str(tmp_path), "--workers", "1"]) == 0
    assert "6 scenes" in capsys.readouterr().out
    assert bytes_of(tmp_path) == bytes_of(folder)


def test_workers_of_a_killed_command_end_in_silence(small_dataset, tmp_path):
    """With a word neither of a pipe that nobody reads nor of semaphores that nobody removes."""
    killed = command(small_dataset[0], tmp_path, "--workers", "2")
    killed.stdout.readline()
    while killed.poll() is None and not any(tmp_path.rglob(".begun")):
        time.sleep(0.01)
    killed.kill()
    assert killed.communicate(timeout=120)[1] == ""


def test_a_worker_that_is_killed_is_replaced(small_dataset, monkeypatch, tmp_path):
    """Libraries of a worker, too, have its share of the processors."""
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    path, folder = small_dataset
    running = command(path, tmp_path, "--workers", "2")
    running.stdout.readline()
    children = Path(f"/proc/{running.pid}/task/{running.pid}/children")
    workers: list[int] = []
    while running.poll() is None and not workers:
        workers = [int(one) for one in children.read_text().split()
                   if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()]
    share = f"OPENBLAS_NUM_THREADS={max(1, (os.cpu_count() or 1) // 2)}".encode()
    assert all(share in Path(f"/proc/{one}/environ").read_bytes().split(b"\0") for one in workers)
    for one in workers:
        os.kill(one, signal.SIGKILL)
    running.communicate(timeout=120)
    assert workers and running.returncode == 0 and bytes_of(tmp_path) == bytes_of(folder)


def test_the_record_of_a_scene_is_the_last_that_is_written(small_dataset, monkeypatch, tmp_path):
    """The call that waits for records ends its workers when the last is there."""
    there = []

    def write(folder, scene, record):
        there.append({path.name for path in scene_folder(folder, scene).iterdir()} - {".claim"} - record.files.keys())
        write_record(folder, scene, record)

    monkeypatch.setattr("echopath.dataset.scene_work.write_record", write)
    make(small_dataset[0], tmp_path, frames=(0, 4))
    assert there == [set(), set()]


def test_what_a_killed_worker_left_is_removed_by_the_next(small_dataset, tmp_path):
    path, folder = small_dataset
    make(path, tmp_path, frames=(0, 2))
    for scene in (0, 1):  # killed behind the record of the first, and before that of the second
        own = scene_folder(tmp_path, scene)
        own.mkdir(exist_ok=True)
        for name in (".begun", ".record-abc.json", ".drawn-abc.json", ".frame_0001-abc.h5"):
            (own / name).write_text("half")
    make(path, tmp_path)
    assert bytes_of(tmp_path) == bytes_of(folder)


FILLED = """
import os, sys
from pathlib import Path
from echopath import FileError, dataset

if __name__ == "__main__":
    path, folder, workers = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
    run = dataset.make(path, folder, workers=workers)
    next(run)
    free = os.statvfs(folder)
    (folder / "filler").write_bytes(bytes(free.f_bavail * free.f_bsize - 500_000))
    try:
        for made in run:
            assert made.record.state == "done"
    except FileError as error:
        print("told:", error)
    (folder / "filler").unlink()
"""


@pytest.mark.parametrize("workers", [1, 2])
def test_a_disk_that_fills_ends_the_run_and_another_goes_on(small_dataset, tmp_path, workers):
    path, folder = small_dataset
    (tmp_path / "small").mkdir()
    (tmp_path / "fill.py").write_text(FILLED)
    mounted = 'mount -t tmpfs -o size=4m none "$1" && "$2" "$3" "$4" "$1" "$5" && cp -a "$1/." "$6"'
    done = subprocess.run(["unshare", "--mount", "--map-root-user", "sh", "-c", mounted, "sh", tmp_path / "small", sys.executable,
                           tmp_path / "fill.py", path, str(workers), tmp_path], capture_output=True, text=True)
    if "unshare" in done.stderr or "mount" in done.stderr:
        pytest.skip("nothing may be mounted here")
    assert "No space left" in done.stdout, done.stderr
    (tmp_path / "fill.py").unlink()
    assert len(list((tmp_path / "scenes").glob("*/frame_*.h5"))) < 12
    make(path, tmp_path)
    (tmp_path / "small").rmdir()
    assert bytes_of(tmp_path) == bytes_of(folder)


def test_a_script_that_each_worker_would_run_anew_is_told_so_at_once(small_dataset, tmp_path):
    """Without a guard of its main module; as many workers as scenes and more were started, one after the other."""
    script = tmp_path / "unguarded.py"
    script.write_text("import sys\nfrom echopath import dataset\nlist(dataset.make(sys.argv[1], sys.argv[2], workers=2))\n")
    done = subprocess.run([sys.executable, script, small_dataset[0], tmp_path / "out"], capture_output=True, text=True)
    assert done.stderr.splitlines()[-1].startswith("ChildProcessError: workers: end before they begin, as each reads the script")
    assert done.stderr.count("Traceback") <= 3 and "semaphore" not in done.stderr
