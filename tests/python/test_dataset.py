"""Datasets: what a template draws, and that every frame is there once, with the same bits, however a run is ended."""
import base64
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from echopath import dataset
from echopath.cli.info import describe_file
from echopath.dataset.folder import scene_folder
from echopath.frame_file.maps import load_maps
from support.scene_text import SMALL_WAVEFORM

HEAD = """
[dataset]
scenes = 6
frames = 2
interval = 0.05
keep = "labels"
seed = 3
split = {train = 0.5, test = 0.5}
"""
SCENE = """
[radar]
noise_figure_db = 12.0
""" + SMALL_WAVEFORM + """\
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.01, 1.0]
[[objects]]
name = "plate"
count = {integer = [1, 3]}
apart = 0.5
actor = "plate"
parameters = {width = 0.2, height = {uniform = [0.1, 0.3]}}
position = [{uniform = [1.5, 4.0]}, {normal = [0.0, 0.4], within = [-1.5, 1.5]}, 1.0]
yaw_deg = 180.0
material = {choice = ["metal", "concrete"], weights = [1, 3]}
speed = {choice = [0.0, {log_uniform = [0.1, 4.0]}]}
[[objects]]
name = "wall"
chance = 0.5
actor = "wall"
parameters = {length = 6.0, height = 2.0}
material = "concrete"
position = [3.0, 2.0, 0.0]
[trace]
num_rays = 400
max_bounces = 2
[labels]
"""


@pytest.fixture
def path(tmp_path) -> Path:
    return written(tmp_path, HEAD + SCENE)


def written(folder: Path, text: str) -> Path:
    path = folder / "plates.toml"
    path.write_text(text)
    return path


def names_of(drawn) -> list[str]:
    return [one["name"] for one in drawn.table["objects"]]


def bytes_of(folder: Path) -> dict:
    """{path in the folder: digest} of all its files."""
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
            for file in sorted(folder.rglob("*")) if file.is_file()}


def make(path: Path, folder: Path, **options) -> list[dataset.MadeScene]:
    return [one for one in dataset.make(path, folder, **options) if isinstance(one, dataset.MadeScene)]


# --- what is drawn ---

def test_draws_have_their_distributions(path):
    drawn = [dataset.Template(path).draw(number) for number in range(600)]
    counts = np.bincount([sum(name.startswith("plate_") for name in names_of(one)) for one in drawn], minlength=4)
    assert counts[0] == 0 and all(abs(count - 200) < 4 * 12 for count in counts[1:])  # 4 standard deviations
    assert abs(sum("wall" in names_of(one) for one in drawn) - 300) < 4 * 12.3
    plates = [one.values for one in drawn]
    heights = np.array([values["objects.plate_1.parameters.height"] for values in plates])
    assert abs(heights.mean() - 0.2) < 4 * 0.2 / np.sqrt(12 * 600) and 0.1 <= heights.min() and heights.max() <= 0.3
    metal = np.mean([values["objects.plate_1.material"] == "metal" for values in plates])
    assert abs(metal - 0.25) < 4 * np.sqrt(0.25 * 0.75 / 600)
    speeds = np.array([one.table["objects"][0]["speed"] for one in drawn])
    moving = speeds[speeds > 0.0]
    assert abs(len(moving) - 300) < 4 * 12.3
    assert abs(np.median(moving) / np.sqrt(0.1 * 4.0) - 1.0) < 0.5  # of a log-uniform variable
    sides = np.array([one.table["objects"][0]["position"][1] for one in drawn])
    assert np.abs(sides).max() <= 1.5 and abs(sides.std() - 0.4) < 0.05
    shares = np.mean([dataset.Template(path).split_of(number) == "train" for number in range(600)])
    assert abs(shares - 0.5) < 4 * np.sqrt(0.25 / 600)


def test_objects_stand_apart_as_they_ask(path):
    for number in range(100):
        placed = [one["position"][:2] for one in dataset.Template(path).draw(number).table["objects"] if "plate" in one["name"]]
        for index, one in enumerate(placed):
            assert all(np.hypot(*np.subtract(one, other)) >= 1.0 for other in placed[:index])


def test_other_keys_and_more_scenes_change_no_draw(path, tmp_path):
    before = dataset.Template(path).draw(4)
    post = 'name = "post"\nactor = "plate"\nparameters = {width = 1, height = 1}\nposition = [{uniform = [1, 2]}, 9, 0]\n'
    more = SCENE.replace('[[objects]]\nname = "plate"', f'[[objects]]\n{post}[[objects]]\nname = "plate"')
    after = dataset.Template(written(tmp_path, HEAD.replace("scenes = 6", "scenes = 60") + more)).draw(4)
    assert {name: after.values[name] for name in before.values} == before.values
    assert after.table["trace"]["seed"] == before.table["trace"]["seed"] != dataset.Template(path).draw(5).table["trace"]["seed"]
    other = dataset.Template(written(tmp_path, HEAD.replace("seed = 3", "seed = 4") + SCENE)).draw(4)
    assert other.values != before.values


@pytest.mark.parametrize("before, after, told", [
    ("scenes = 6", "scenes = 0", "dataset.scenes: must be at least 1, got 0"),
    ("scenes = 6", "scenes = 6\nframe = 2", "dataset.frame: unknown key; did you mean 'frames'?"),
    ("interval = 0.05\n", "", "dataset.interval: is missing, in s"),
    ("test = 0.5", "test = 0.6", "dataset.split: must be name = share, whose sum is 1"),
    ("[labels]", "[labels]\n[sequence]\nframes = 2\ninterval = 1.0", "sequence: must not stand in a template"),
    ("{uniform = [0.1, 0.3]}", "{uniform = [0.3, 0.1]}",
     "scene 0: objects.plate_1.parameters.height.uniform: must be [lowest, highest], got [0.3, 0.1]"),
    ("weights = [1, 3]", "weights = [1]", "objects.plate_1.material.weights: must be 2 numbers of at least 0"),
    ("{integer = [1, 3]}", "{integer = [1.5, 3]}", "objects.plate.count.integer: must be [lowest, highest], whole numbers"),
    ("{integer = [1, 3]}", "-1", "objects.plate.count: must be a whole number of at least 0, got -1"),
    ("chance = 0.5", "chance = 2.0", "objects.wall.chance: must be a number from 0 to 1, got 2.0"),
    ("apart = 0.5", "apart = 9.0", "apart: must leave a free place within 1000 tries, got 9.0"),
    ("within = [-1.5, 1.5]", "within = [90, 91]", "must be a distribution with a good share of its values within [90, 91]"),
    ('"metal", "concrete"', '"metal", "cheese"', "unknown material 'cheese'"),
    ('actor = "wall"', 'actor = "wal"', "did you mean 'wall'"),
    ("height = 2.0", "heigth = 2.0", "heigth"),
    ("speed = {choice = [0.0, {log_uniform = [0.1, 4.0]}]}",
     'motion = {kind = "keyframes", times = [0.0, 0.01], translations = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]}',
     "scene 0: frames: must all lie within the motions"),
])
def test_faults_of_a_template_are_told_before_the_first_frame(tmp_path, before, after, told):
    text = HEAD + SCENE
    assert before in text
    path = written(tmp_path, text.replace(before, after))
    with pytest.raises(ValueError) as caught:
        list(dataset.make(path, tmp_path / "out"))
    assert told in str(caught.value) and str(path) in str(caught.value)
    assert not (tmp_path / "out").exists()


# --- what is made ---

@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> tuple[Path, Path]:
    """(template, folder) of a dataset that one process made without a break."""
    folder = tmp_path_factory.mktemp("whole")
    path = written(folder, HEAD + SCENE)
    make(path, folder / "out")
    return path, folder / "out"


def test_info_tells_what_a_folder_holds(whole):
    told = "\n".join(describe_file(whole[1]))
    assert "6, 6 done" in told and "12, 2 of each scene" in told and "labels" in told


def test_all_frames_are_there_and_open(whole):
    path, folder = whole
    opened = dataset.open(folder)
    assert len(opened) == 12 and opened.numbers == list(range(12)) and opened.scenes == list(range(6))
    assert len(opened.split("train")) + len(opened.split("test")) == 12 and len(opened[3:5]) == 2
    one = opened[-1]
    assert (one.number, one.scene, one.place, one.split) == (11, 5, 1, dataset.Template(path).split_of(5))
    assert one.frame == opened.sequence(5)[1] and set(one.frame.labels) == {"parts"}
    assert one.frame.labels["parts"].objects and opened.drawn(5) == dataset.Template(path).draw(5).values
    with pytest.raises(ValueError, match="name: must be 'train' or 'test', got 'val'"):
        opened.split("val")


def test_frames_are_those_of_the_drawn_scene(whole):
    path, folder = whole
    assert dataset.open(folder)[7].frame.start_time == 0.05
    alone = dataset.Template(path).sequence(3)[1]
    theirs = dataset.open(folder)[7].frame
    assert np.array_equal(theirs.labels["parts"].mask, alone.labels["parts"].mask)
    assert theirs.seed == alone.paths.frame.seed


@pytest.mark.parametrize("options", [[{"workers": 2}], [{"shard": (2, 3)}, {"shard": (1, 3)}, {"shard": (3, 3)}],
                                     [{"frames": (3, 6)}, {}]])
def test_bytes_are_the_same_from_workers_shards_and_pieces(whole, tmp_path, options):
    path, folder = whole
    for one in options:
        make(path, tmp_path, **one)
    assert bytes_of(tmp_path) == bytes_of(folder)


def command(path: Path, folder: Path, *options: str) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-m", "echopath", "dataset", path, "--out", folder, *options],
                            stdout=subprocess.PIPE, text=True, start_new_session=True)


@pytest.mark.parametrize("workers", ["1", "2"])
def test_a_killed_command_is_gone_on_with(whole, tmp_path, workers):
    path, folder = whole
    killed = command(path, tmp_path, "--workers", workers)
    killed.stdout.readline()
    while killed.poll() is None and not any(tmp_path.rglob("frame_*.h5")):
        time.sleep(0.01)
    os.killpg(killed.pid, signal.SIGKILL)
    killed.communicate()
    again = command(path, tmp_path, "--workers", "1")
    assert "6 scenes" in again.communicate()[0] and again.returncode == 0
    assert bytes_of(tmp_path) == bytes_of(folder)


def test_a_worker_that_is_killed_is_replaced(whole, tmp_path):
    path, folder = whole
    running = command(path, tmp_path, "--workers", "2")
    running.stdout.readline()
    children = Path(f"/proc/{running.pid}/task/{running.pid}/children")
    workers: list[int] = []
    while running.poll() is None and not workers:
        workers = [int(one) for one in children.read_text().split()
                   if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()]
    for one in workers:
        os.kill(one, signal.SIGKILL)
    running.communicate(timeout=120)
    assert workers and running.returncode == 0 and bytes_of(tmp_path) == bytes_of(folder)


def test_what_a_killed_worker_left_is_removed_by_the_next(whole, tmp_path):
    path, folder = whole
    make(path, tmp_path, frames=(0, 2))
    for scene in (0, 1):  # killed behind the record of the first, and before that of the second
        own = scene_folder(tmp_path, scene)
        own.mkdir(exist_ok=True)
        for name in (".begun", ".record-abc.json", ".drawn-abc.json", ".frame_0001-abc.h5"):
            (own / name).write_text("half")
    make(path, tmp_path)
    assert bytes_of(tmp_path) == bytes_of(folder)


@pytest.mark.parametrize("workers", [1, 2])
def test_damaged_and_missing_frames_are_made_again(whole, tmp_path, workers):
    path, folder = whole
    copied = tmp_path / "copy"
    shutil.copytree(folder, copied)
    assert all(one.was_there for one in make(path, copied))
    damaged, missing = (scene_folder(copied, scene) / f"frame_000{place}.h5" for scene, place in ((1, 0), (4, 1)))
    content = bytearray(damaged.read_bytes())
    content[len(content) // 2] ^= 1
    damaged.write_bytes(content)
    missing.unlink()
    (scene_folder(copied, 2) / "drawn.json").unlink()
    (scene_folder(copied, 5) / "sequence.h5").write_bytes(b"")
    made = [one.scene for one in make(path, copied, workers=workers) if not one.was_there]
    assert sorted(made) == [1, 2, 4, 5] and bytes_of(copied) == bytes_of(folder)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_scene_that_names_a_file_that_is_gone_fails_alone(tmp_path, workers):
    mesh = ('[[objects]]\nname = "car"\nmesh = {choice = ["car.obj", "car.obj", "gone.obj"]}\nmaterial = "metal"\n'
            'position = [4.0, 0.0, 1.0]\n')
    (tmp_path / "car.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    (tmp_path / "gone.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    path = written(tmp_path, HEAD + SCENE.replace("[trace]", mesh + "[trace]"))
    run = dataset.make(path, tmp_path / "out", workers=workers)
    (tmp_path / "gone.obj").unlink()
    template = dataset.Template(path)
    bad = {number for number in range(6) if "gone.obj" in str(template.draw(number).table)}
    if 0 in bad:
        pytest.fail("scene 0 is that of the forecast")
    records = {one.scene: one.record for one in run if isinstance(one, dataset.MadeScene)}
    assert {scene for scene, record in records.items() if record.state == "failed"} == bad != set()
    assert all("gone.obj" in records[scene].reason for scene in bad)


def test_a_scene_that_fails_is_told_and_tried_again_on_request(whole, tmp_path, monkeypatch):
    path, folder = whole
    sequence_of = dataset.Template.sequence_of

    def failing(self, scene):
        if scene.number == 2:
            raise ValueError("no such luck")
        return sequence_of(self, scene)

    monkeypatch.setattr("echopath.dataset.making._BUILT", 1)  # scene 0 alone is looked at before
    monkeypatch.setattr(dataset.Template, "sequence_of", failing)
    records = {one.scene: one.record for one in make(path, tmp_path)}
    assert records[2].state == "failed" and "no such luck" in records[2].reason and records[3].state == "done"
    assert len(dataset.open(tmp_path)) == 10 and "no such luck" in (tmp_path / "manifest.json").read_text()
    monkeypatch.setattr(dataset.Template, "sequence_of", sequence_of)
    assert all(one.was_there for one in make(path, tmp_path))
    assert [one.scene for one in make(path, tmp_path, only_failed=True)] == [2]
    assert bytes_of(tmp_path) == bytes_of(folder)


def test_a_dataset_grows_and_is_not_mixed_with_another(whole, tmp_path):
    _, folder = whole
    smaller = written(tmp_path, (HEAD + SCENE).replace("scenes = 6", "scenes = 4"))
    make(smaller, tmp_path / "out")
    larger = written(tmp_path, HEAD + SCENE)
    assert [one.scene for one in make(larger, tmp_path / "out") if not one.was_there] == [4, 5]
    assert bytes_of(tmp_path / "out") == bytes_of(folder)
    other = written(tmp_path, HEAD + SCENE.replace("num_rays = 400", "num_rays = 500"))
    with pytest.raises(ValueError, match=r"folder: must be new, or of this template \(\[trace\] differs\)"):
        make(other, tmp_path / "out")
    assert bytes_of(tmp_path / "out") == bytes_of(folder)


def test_the_forecast_is_near_what_is_made(whole, tmp_path):
    path, folder = whole
    forecast = next(dataset.make(path, tmp_path))
    size = sum(file.stat().st_size for file in folder.rglob("*.h5"))
    assert forecast.frames == 12 and 0.8 * size < forecast.bytes < 1.6 * size  # scenes differ


def test_a_disk_that_is_too_small_is_told_before_the_first_frame(path, tmp_path, monkeypatch):
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr("echopath.dataset.making.shutil.disk_usage", lambda folder: usage._replace(free=1000))
    with pytest.raises(ep.FileError, match=r"folder: must have 0\.\d MiB for 12 frames, got 0\.0 MiB"):
        list(dataset.make(path, tmp_path / "out"))
    assert not list((tmp_path / "out").rglob("frame_*"))


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
def test_a_disk_that_fills_ends_the_run_and_another_goes_on(whole, tmp_path, workers):
    path, folder = whole
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


def test_xarray_reads_the_frames_that_are_asked_for_and_no_others(tmp_path, monkeypatch):
    pytest.importorskip("xarray")
    folder = tmp_path / "out"
    make(written(tmp_path, HEAD.replace('keep = "labels"', 'keep = "maps"').replace("scenes = 6", "scenes = 3") + SCENE), folder)
    opened, read = dataset.open(folder), []
    monkeypatch.setattr("echopath.dataset.opened.read_frame",
                        lambda path, keep: read.append(path.name) or load_maps(path))
    arrays = opened.to_xarray()
    read.clear()
    assert arrays.power.dims == ("frame", "velocity", "range") and arrays.power.shape == arrays.cell.shape == (6, 8, 32)
    part = arrays.power.isel(frame=slice(3, 5), range=4)
    assert read == []
    values = part.values
    assert read == ["frame_0001.h5", "frame_0000.h5"]
    np.testing.assert_array_equal(values, [opened[place].frame.power[:, 4] for place in (3, 4)])
    labels = opened[2].frame.labels["parts"]
    np.testing.assert_array_equal(arrays.cell.sel(frame=2) > 0, labels.mask)
    names = arrays.kind.attrs["names"]
    assert {names[index] for index in np.unique(arrays.kind[2]) if index >= 0} == {"static"}
    assert list(arrays.split.values) == [one.split for one in opened] and list(arrays.scene.values) == [0, 0, 1, 1, 2, 2]


# --- what is told of it ---

class _Page(HTMLParser):
    """The texts of the cells of all rows, and the pictures."""

    def __init__(self, text: str):
        super().__init__()
        self.rows: list[list[str]] = []
        self.pictures: list[bytes] = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")
        elif tag == "img":
            kind, _, code = dict(attributes)["src"].partition(",")
            assert kind == "data:image/png;base64"
            self.pictures.append(base64.b64decode(code))

    def handle_data(self, data):
        if self.rows and self.rows[-1]:
            self.rows[-1][-1] += data.strip()


def test_the_report_counts_what_is_there(whole, tmp_path):
    _, folder = whole
    dataset.write_report(folder, tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    page = _Page(text)
    facts = {row[0]: row[1:] for row in page.rows if len(row) > 1}
    opened = dataset.open(folder)
    assert facts["scenes done"] == ["6 of 6"] and facts["frames done"] == ["12"]
    assert facts["frames of 'train'"] == [str(len(opened.split("train")))]
    labels = [one.frame.labels["parts"] for one in opened]
    assert int(facts["static"][-2]) == sum(one.cells for label in labels for one in label.objects) > 0
    assert sum(map(int, facts["static"][:2])) == sum(len(label.objects) for label in labels)
    assert len(page.pictures) == 6 and all(picture.startswith(b"\x89PNG") for picture in page.pictures)
    assert "http" not in text.replace("base64", "")


def test_the_command_writes_the_report_beside_the_frames(whole, tmp_path):
    copied = tmp_path / "copy"
    shutil.copytree(whole[1], copied)
    done = subprocess.run([sys.executable, "-m", "echopath", "dataset-report", copied], capture_output=True, text=True)
    assert done.returncode == 0 and "wrote" in done.stdout and (copied / "report.html").stat().st_size > 10_000


def test_a_folder_without_a_dataset_is_told(tmp_path):
    with pytest.raises(ep.FileError, match="is no dataset, it has no dataset.toml"):
        dataset.open(tmp_path)


@pytest.mark.parametrize("options, told", [
    ({"workers": 0}, "workers"), ({"shard": (3, 2)}, "shard"), ({"frames": (5, 5)}, "frames"), ({"frames": (0, 13)}, "frames"),
    ({"only_failed": 1}, "only_failed")])
def test_wrong_arguments_are_named(path, tmp_path, options, told):
    with pytest.raises((TypeError, ValueError), match=f"^{told}: must be"):
        list(dataset.make(path, tmp_path / "out", **options))
