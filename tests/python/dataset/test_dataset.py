"""Datasets: every frame is there once, with the same bits, whoever makes it."""
import json
import pickle
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import echopath as ep
from echopath import dataset
from echopath.cli import main
from echopath.cli.dataset import lines_of
from echopath.cli.info import describe_file
from echopath.dataset import making
from echopath.dataset.classes import classes_of
from echopath.dataset.folder import SceneRecord, damaged_files, scene_folder, write_manifest
from echopath.dataset.unresolved import UnresolvedEchoes, summary, unresolved_in
from echopath.trajectories.files import rows
from echopath.trajectories.files.fcd import read_fcd
from support.files.small_dataset import HEAD, SCENE, bytes_of, make, written


@pytest.fixture
def path(tmp_path) -> Path:
    return written(tmp_path)


def test_frames_are_read_in_any_working_folder(small_dataset, tmp_path, monkeypatch):
    folder = small_dataset[1]
    monkeypatch.chdir(folder.parent)
    opened = dataset.open(folder.name)
    monkeypatch.chdir(tmp_path)
    assert opened[1].frame.labels == dataset.open(folder)[1].frame.labels


def test_files_of_a_template_that_is_a_link_are_beside_the_link(tmp_path, monkeypatch):
    """When the dataset is made and when its frames are made again, wherever that is."""
    for folder in ("shared", "project"):
        (tmp_path / folder).mkdir()
    (tmp_path / "project/plate.obj").write_text("v 3 -1 0\nv 3 1 0\nv 3 0 2\nf 1 3 2\n")
    objects = SCENE[SCENE.index("[[objects]]"):SCENE.index("[trace]")]
    plate = '[[objects]]\nname = "plate"\nmesh = "plate.obj"\nmaterial = "metal"\n'
    template = written(tmp_path / "shared", HEAD.replace("scenes = 6", "scenes = 1") + SCENE.replace(objects, plate))
    link = tmp_path / "project" / template.name
    link.symlink_to(template)
    monkeypatch.chdir(tmp_path / "project")
    assert [one.record.state for one in make(Path(link.name), tmp_path / "out")] == ["done"]
    monkeypatch.chdir(tmp_path)
    opened = dataset.open(tmp_path / "out")
    again, kept = (one[0].frame.labels["parts"].objects for one in (opened.remade(), opened))
    assert [one.power for one in again] == [one.power for one in kept] != []


def test_info_tells_what_a_folder_holds(small_dataset):
    told = "\n".join(describe_file(small_dataset[1]))
    assert "6, 6 done" in told and "12, 2 of each scene" in told and "labels" in told


def test_all_frames_are_there_and_open(small_dataset):
    path, folder = small_dataset
    opened = dataset.open(folder)
    assert len(opened) == 12 and opened.numbers == list(range(12)) and opened.scenes == list(range(6))
    assert len(opened.split("train")) + len(opened.split("test")) == 12 and len(opened[3:5]) == 2
    one = opened[-1]
    assert (one.number, one.scene, one.place, one.split) == (11, 5, 1, dataset.Template(path).split_of(5))
    with pytest.raises(IndexError, match="a dataset of 12 frames has no frame 12"):
        opened[12]
    with pytest.raises(IndexError, match="scene: must be from 0 to 5, got 6"):
        opened.drawn(6)
    assert one.frame == opened.sequence(5)[1] and set(one.frame.labels) == {"parts"}
    assert one.frame.labels["parts"].objects and opened.drawn(5) == dataset.Template(path).draw(5).values
    with pytest.raises(ValueError, match="name: must be 'train' or 'test', got 'val'"):
        opened.split("val")


def test_batches_of_places_are_datasets(small_dataset):
    opened = dataset.open(small_dataset[1])
    for places in ([5, 0, -1], np.array([5, 0, -1]), (5, 0, -1)):
        batch = opened[places]
        assert batch.numbers == [opened.numbers[place] for place in places] and [one.number for one in batch] == batch.numbers
    assert len(opened[[]]) == 0 and opened[np.int64(3)].number == opened.numbers[3]
    for wrong, error in (([99], IndexError), (99, IndexError), ([1.5], TypeError), ("a", TypeError), (1.5, TypeError)):
        with pytest.raises(error, match="place: must be|has no frame 99"):
            opened[wrong]


def test_classes_of_objects_are_told_by_their_names(tmp_path):
    """Two copies of an actor, what the template's classes name, and what is no road user."""
    objects = """
[[objects]]
name = "rider"
count = 2
actor = "cyclist"
position = [{uniform = [5.0, 6.0]}, 0.0, 0.0]
[[objects]]
name = "box"
actor = "box"
parameters = {size = [1.0, 1.0, 1.0]}
material = "metal"
"""
    head = HEAD.replace('keep = "labels"', 'keep = "labels"\nclasses = {"box*" = "truck"}')
    folder = tmp_path / "out"
    make(written(tmp_path, head.replace("scenes = 6", "scenes = 1") + objects + SCENE), folder)
    opened = dataset.open(folder)
    known = opened.classes(0)
    assert {name: known[name] for name in ("rider_1", "rider_2", "box")} == {"rider_1": "cyclist", "rider_2": "cyclist",
                                                                              "box": "truck"}
    assert set(known.values()) == {"cyclist", "truck", "static"}
    assert {one.name for one in opened[0].frame.labels["parts"].objects} <= set(known)
    with pytest.raises(TypeError, match="scene: must be a whole number, got '0'"):
        opened.sequence("0")
    with pytest.raises(IndexError, match="scene: must be from 0 to 0, got 1"):
        opened.classes(1)


def test_classes_of_traffic_are_told_by_its_types(tmp_path):
    kinds = {"ego": "passenger", "a/1": "pt_bus", "b": "truck_heavy", "c": "bike", "d": "tram", "e": "taxi", "f": "x",
             "a*1": "bike", "g": "model_bike"}
    rows = [f'<vehicle id="{name}" type="{kind}" x="{{0}}" y="{10 * place}" angle="90"/>'
            for place, (name, kind) in enumerate(kinds.items())]
    steps = "".join(f'<timestep time="{time}">{"".join(rows).format(5 * time)}</timestep>' for time in (0, 1))
    (tmp_path / "fcd.xml").write_text(f"<fcd-export>{steps}</fcd-export>")
    (tmp_path / "taxi.obj").write_text("v -2.15 0 0\nv 2.15 -1 0\nv 2.15 1 0\nf 1 2 3\n")
    traffic = """
[[traffic]]
file = "fcd.xml"
exclude = ["ego"]
actors = {x = false, truck_heavy = "van", taxi = {model = "taxi.obj"}, "m*" = {model = "taxi.obj"}}
position = [{uniform = [20.0, 30.0]}, 0.0, 0.0]
"""
    carried = '[[objects]]\nname = "b"\nparent = "plate_1"\ngroup = true\n'  # has the name of a truck, and another place
    scene = SCENE.replace("[trace]", carried + "[trace]")
    path = written(tmp_path, HEAD.replace("scenes = 6", "scenes = 2") + traffic + scene)
    template = dataset.Template(path)
    assert dataset.Template(str(path)).objects(1) == template.objects(1)
    known = classes_of(template.objects(1), {})
    assert {name: known[name] for name in ("a_1", "a_1_2", "b", "c", "d", "e", "g")} == {
        "a_1": "bus", "a_1_2": "cyclist", "b": "van", "c": "cyclist", "d": "train", "e": "car", "g": "cyclist"}
    assert not {"ego", "f"} & set(known)
    assert set(known) == {name for name in template.scene_file(1).scene if "/" not in name}
    begins = [template.scene_file(number).scene["e"].motion.at(0.0)[0, 3] for number in (0, 1)]
    assert all(20.0 < begin + 2.15 < 30.0 for begin in begins) and begins[0] != begins[1]  # by the front of a car of 4.3 m


def test_files_of_traffic_are_read_once_for_all_scenes(tmp_path, monkeypatch):
    """Until they change: then scenes are as the new file says."""
    def write(x):
        steps = "".join(f'<timestep time="{time}"><vehicle id="a" type="car" x="{x + 5 * time}" y="0" angle="90"/></timestep>'
                        for time in (0, 1))
        (tmp_path / "fcd.xml").write_text(f"<fcd-export>{steps}</fcd-export>")

    reads = []
    monkeypatch.setattr(rows, "read_fcd", lambda path: reads.append(path) or read_fcd(path))
    write(20)
    traffic = '[[traffic]]\nfile = "fcd.xml"\nposition = [{uniform = [1.0, 2.0]}, 0.0, 0.0]\n'
    template = dataset.Template(written(tmp_path, HEAD.replace("scenes = 6", "scenes = 3") + traffic + SCENE))
    fronts = [template.scene_file(number).scene["a"].motion.at(0.0)[0, 3] + 2.15 for number in range(3)]
    assert template.classes(1)["a"] == "car" and len(reads) == 1
    assert all(21.0 < front < 22.0 for front in fronts) and len(set(fronts)) == 3
    write(400)
    assert template.scene_file(0).scene["a"].motion.at(0.0)[0, 3] == pytest.approx(fronts[0] - 2.15 + 380.0)
    assert len(reads) == 2 and pickle.loads(pickle.dumps(template)).classes(1) == template.classes(1)


def test_frames_are_those_of_the_drawn_scene(small_dataset):
    path, folder = small_dataset
    assert dataset.open(folder)[7].frame.start_time == 0.05
    alone = dataset.Template(path).sequence(3)[1]
    theirs = dataset.open(folder)[7].frame
    assert np.array_equal(theirs.labels["parts"].mask, alone.labels["parts"].mask)
    assert theirs.seed == alone.paths.frame.seed


@pytest.mark.parametrize("options", [[{"shard": (2, 3)}, {"shard": (1, 3)}, {"shard": (3, 3)}], [{"frames": (3, 6)}, {}]])
def test_bytes_are_the_same_from_shards_and_pieces(small_dataset, tmp_path, options):
    path, folder = small_dataset
    for one in options:
        make(path, tmp_path, **one)
    assert bytes_of(tmp_path) == bytes_of(folder)


@pytest.mark.parametrize("workers", [1, 2])
def test_damaged_and_missing_frames_are_made_again(small_dataset, tmp_path, workers):
    path, folder = small_dataset
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
    with pytest.warns(RuntimeWarning, match="is not as it was written: it is made again") as said:
        made = [one.scene for one in make(path, copied, workers=workers) if not one.was_there]
    assert {damaged.name, "sequence.h5"} <= {str(one.message).split(":")[0].split("/")[-1] for one in said}
    assert sorted(made) == [1, 2, 4, 5] and bytes_of(copied) == bytes_of(folder)


@pytest.mark.parametrize("content", [
    "[" * 50_000, '{"state": "odd"}', '{"state": []}', '{"state": "done", "files": [["a", "b"]]}',
    '{"state": "done", "files": {"a": 3}}'],
    ids=["nested", "odd", "list", "pairs", "number"])
def test_a_record_that_no_run_writes_is_none(small_dataset, tmp_path, content):
    """A scene whose record says nothing is still to be made."""
    copied = tmp_path / "copy"
    shutil.copytree(small_dataset[1], copied)
    (scene_folder(copied, 1) / "record.json").write_text(content)
    opened = dataset.open(copied)
    assert opened.scenes == [0, 2, 3, 4, 5]
    write_manifest(copied, opened.template)
    assert json.loads((copied / "manifest.json").read_text())["count"] == {"done": 5, "failed": 0, "to do": 1}


def test_a_file_that_no_folder_can_have_is_damaged(tmp_path):
    (path,) = damaged_files(tmp_path, 0, SceneRecord("done", {"a\0b": "0" * 64}))
    assert path.name == "a\0b"


@pytest.mark.parametrize("content", [b"", b"3", b"[" * 50_000, b'{"num_rays": Infinity, "echoes": []}'],
                         ids=["empty", "number", "nested", "inf"])
def test_what_nobody_wrote_of_unresolved_echoes_says_nothing(content):
    assert unresolved_in(content) is None


@pytest.mark.parametrize("content", ["[" * 50_000, "[1]", "3"], ids=["nested", "list", "number"])
def test_drawn_values_that_are_none_are_told_by_their_file(small_dataset, tmp_path, content):
    copied = tmp_path / "copy"
    shutil.copytree(small_dataset[1], copied)
    (scene_folder(copied, 1) / "drawn.json").write_text(content)
    with pytest.raises(ep.FileError, match="drawn.json: (cannot be read|must hold an object)"):
        dataset.open(copied).drawn(1)


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


def test_a_scene_that_fails_is_told_and_tried_again_on_request(small_dataset, tmp_path, monkeypatch):
    path, folder = small_dataset
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


def test_a_dataset_grows_and_is_not_mixed_with_another(small_dataset, tmp_path):
    _, folder = small_dataset
    smaller = written(tmp_path, (HEAD + SCENE).replace("scenes = 6", "scenes = 4"))
    make(smaller, tmp_path / "out")
    larger = written(tmp_path)
    assert [one.scene for one in make(larger, tmp_path / "out") if not one.was_there] == [4, 5]
    assert json.loads((tmp_path / "out" / "origin.json").read_text()) == {"template": str(larger)}
    grown, at_once = (bytes_of(one) for one in (tmp_path / "out", folder))
    assert grown.keys() == at_once.keys() and {name for name in grown if grown[name] != at_once[name]} == {"origin.json"}
    other = written(tmp_path, HEAD.replace("seed = ", "seed = 1") + SCENE)
    with pytest.raises(ValueError, match=r"folder: must be new, or of this template \(dataset.seed is \d+ there\)"):
        make(other, tmp_path / "out")
    other = written(tmp_path, HEAD + SCENE.replace("num_rays = 400", "num_rays = 500"))
    with pytest.raises(ValueError, match=r"folder: must be new, or of this template \(trace.num_rays is 400 there\)"):
        make(other, tmp_path / "out")
    assert bytes_of(tmp_path / "out") == grown


def test_scenes_of_files_that_were_edited_are_not_mixed(tmp_path):
    """A plate is edited between two scenes: nothing is made, a scene that is made again says so, and the old plate goes on."""
    plate = tmp_path / "plate.obj"
    plate.write_text("v 3 -1 0\nv 3 1 0\nv 3 0 2\nf 1 3 2\n")
    objects = SCENE[SCENE.index("[[objects]]"):SCENE.index("[trace]")]
    named = '[[objects]]\nname = "plate"\nmesh = "plate.obj"\nmaterial = "metal"\n'
    path = written(tmp_path, HEAD.replace("scenes = 6", "scenes = 2") + SCENE.replace(objects, named))
    make(path, tmp_path / "out", frames=(0, 1))
    made, before = plate.read_text(), bytes_of(tmp_path / "out")
    plate.write_text(made.replace("v 3 0 2", "v 3 0 1"))
    with pytest.raises(ValueError, match=r"folder: must be new, or .*scene 0 was made of others, .*meshes/0/vertices differs"):
        make(path, tmp_path / "out")
    with pytest.warns(RuntimeWarning, match=r"scene 0: made again, it is another .*scene/meshes/0/vertices differs"):
        dataset.open(tmp_path / "out").remade()[0]
    assert bytes_of(tmp_path / "out") == before
    plate.write_text(made)
    assert [one.scene for one in make(path, tmp_path / "out") if not one.was_there] == [1]


def test_the_forecast_is_near_what_is_made(small_dataset, tmp_path):
    path, folder = small_dataset
    forecast = next(dataset.make(path, tmp_path))
    size = sum(file.stat().st_size for file in folder.rglob("*.h5"))
    assert forecast.frames == 12 and 0.8 * size < forecast.bytes < 1.6 * size  # scenes differ


def test_the_time_left_does_not_count_the_start_of_workers_for_each_scene(path, tmp_path, monkeypatch):
    """Workers of 6 scenes, 1 s each by the forecast, take 10 s more before the first one."""
    moments = iter([0.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0])
    monkeypatch.setattr(making, "time", SimpleNamespace(perf_counter=lambda: next(moments)))
    monkeypatch.setattr(making, "_forecast", lambda *_: making.Forecast(12, 6.0, 0))
    monkeypatch.setattr(making, "in_processes", lambda path, folder, scenes, *_: [(one, SceneRecord("done")) for one in scenes])
    made = list(dataset.make(path, tmp_path / "out", workers=2))[1:]
    assert [scene.seconds_left for scene in made] == pytest.approx([5.0, 4.0, 3.0, 2.0, 1.0, 0.0], abs=1e-12)


def test_a_disk_that_is_too_small_is_told_before_the_first_frame(path, tmp_path, monkeypatch):
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr("echopath.dataset.making.shutil.disk_usage", lambda folder: usage._replace(free=1000))
    with pytest.raises(ep.FileError, match=r"folder: must have 0\.\d MiB for 12 frames, got 0\.0 MiB"):
        list(dataset.make(path, tmp_path / "out"))
    assert not list((tmp_path / "out").rglob("frame_*"))


def test_a_folder_without_a_dataset_is_told(tmp_path):
    with pytest.raises(ep.FileError, match="is no dataset, it has no dataset.toml"):
        dataset.open(tmp_path)
    with pytest.raises(ep.FileError, match="nowhere: is no dataset, there is no such folder$"):
        dataset.open(tmp_path / "nowhere")


def test_a_scene_file_is_no_template(tmp_path):
    (tmp_path / "scene.toml").write_text("title = 'a ball'\n")
    with pytest.raises(ValueError, match=r"scene.toml: dataset: is missing, which a template has; .*`echopath run`"):
        list(dataset.make(tmp_path / "scene.toml", tmp_path / "out"))


@pytest.mark.parametrize("options, told", [
    ({"workers": 0}, "workers"), ({"shard": (3, 2)}, "shard"), ({"frames": (5, 5)}, "frames"), ({"frames": (0, 13)}, "frames"),
    ({"only_failed": 1}, "only_failed")])
def test_wrong_arguments_are_named(path, tmp_path, options, told):
    with pytest.raises((TypeError, ValueError), match=f"^{told}: must be"):
        list(dataset.make(path, tmp_path / "out", **options))


def test_the_command_ends_with_what_the_rays_do_not_resolve(small_dataset, tmp_path, capsys):
    """400 rays know next to nothing; a run that finds all frames there tells the same."""
    path, folder = small_dataset
    made = make(path, folder)
    first = dataset.open(folder).remade()[0].frame
    assert made[0].unresolved.num_rays == first.paths.frame.statistics.num_rays == 400
    echoes = {f"ghosts of {one.name}" if one.via else one.name for one in first.unresolved}
    assert set(made[0].unresolved.echoes) == echoes != set()
    for out in (tmp_path / "new", folder):
        main(["dataset", str(path), "--out", str(out)])
        told = capsys.readouterr().out.splitlines()[-1]
        doubtful = sum(bool(one.unresolved.echoes) for one in made)
        assert told.startswith(f"{doubtful} of the first frames of 6 scenes have echoes above the noise that 400 rays do not "
                               "resolve to 0.3 dB: ")
    own = scene_folder(tmp_path / "new", 0)
    for name in ("unresolved.json", "record.json"):
        (own / name).unlink()
    assert make(path, tmp_path / "new")[-1].unresolved == made[0].unresolved and bytes_of(tmp_path / "new") == bytes_of(folder)


def test_the_end_of_the_command_does_not_depend_on_which_worker_is_first(monkeypatch):
    """Two scenes with an object each, which are as often unresolved as each other."""
    scenes = [making.MadeScene(number, "train", SceneRecord("done"), False, 1, 2, None, UnresolvedEchoes(400, (name,)))
              for number, name in enumerate(("walker", "car"))]
    ends = []
    for order in (scenes, scenes[::-1]):
        monkeypatch.setattr("echopath.cli.dataset.make", lambda *_, order=order, **__: iter(order))
        ends.append(list(lines_of(SimpleNamespace(template="", out="", workers=2, shard=None, frames=None, only_failed=False,
                                                   scheduler=None)))[2:])
    assert ends[0] == ends[1] and "walker (1)" in ends[0][-1]


def test_a_summary_of_what_is_resolved_is_one_line():
    assert summary([]) == []
    some = [UnresolvedEchoes(1000, ("car", "ghosts of car")), UnresolvedEchoes(2000, ("car",)), UnresolvedEchoes(1000, ())]
    assert summary(some) == ["2 of the first frames of 3 scenes have echoes above the noise that 1,000 to 2,000 rays do not "
                             "resolve to 0.3 dB: car (2), ghosts of car (1); more num_rays of [trace] do"]
    (alone,) = summary(some[2:])
    assert alone == "the first frame of 1 scene: 1,000 rays resolve every object and ghost above the noise to 0.3 dB"
