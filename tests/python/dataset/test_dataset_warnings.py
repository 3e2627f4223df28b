"""What the workers of a dataset warn of is said where the run was asked for, once."""
import warnings

import pytest

from echopath import dataset
from echopath.cli import main
from support.files.gltf_files import rig_file
from support.files.small_dataset import HEAD, SCENE, written

WORDS = "a figure with a skeleton of 200 m is hardly right"


@pytest.fixture
def path(tmp_path):
    """A template whose scenes hold a giant, so that each of them warns when it is drawn."""
    file = rig_file()
    file.json["nodes"] += [{"name": "figure", "children": [0, 1], "scale": [100.0] * 3}]
    file.json["scenes"] = [{"nodes": [3]}]
    (tmp_path / "giant.glb").write_bytes(file.glb())
    model = '[[objects]]\nname = "giant"\nmodel = "giant.glb"\nposition = [500.0, 0.0, 0.0]\n'
    return written(tmp_path, HEAD.replace("scenes = 6", "scenes = 4") + SCENE.replace("[trace]", model + "[trace]"))


def test_workers_warn_at_the_line_of_the_caller_once(path, tmp_path):
    run = dataset.make(path, tmp_path / "out", workers=2)
    next(run)  # the forecast, of scenes that this process has looked at
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        assert len(list(run)) == 4
    told = [one for one in said if WORDS in str(one.message)]
    assert [(one.category, one.filename) for one in told] == [(RuntimeWarning, __file__)]


@pytest.mark.parametrize("workers", ["1", "2"])
def test_the_command_says_it_in_one_line(path, tmp_path, capfd, workers):
    assert main(["dataset", str(path), "--out", str(tmp_path / "out"), "--workers", workers]) == 0
    told = capfd.readouterr().err
    assert [line[:9] for line in told.splitlines() if WORDS in line] == ["warning: "] and "multiprocessing" not in told


def test_globs_of_classes_that_take_no_object_are_told(tmp_path):
    """Of an object that is there by chance, of a copy and of what labels name, nothing is said."""
    def told(classes: str, more: str = "") -> list[str]:
        head = HEAD.replace("scenes = 6", "scenes = 1") + f"[dataset.classes]\n{classes}\n"
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            dataset.make(written(tmp_path, head + SCENE + more), tmp_path / str(len(classes)))
        assert all(one.filename == __file__ for one in said if "classes" in str(one.message))
        return [str(one.message) for one in said if "classes" in str(one.message)]

    assert told('"plate_3" = "car"\n"wal?" = "static"\n"*_9*" = "van"') == []
    (of_set,) = told('"who" = "car"\n"plate_[1]" = "van"', 'objects = {who = ["plate_*"]}')  # no globs know sets of letters
    assert of_set.startswith("dataset.classes: 'plate_[1]'")
    assert told('"who" = "car"', 'objects = {who = ["plate_*"]}') == []
    assert told('"plaet*" = "car"\nwall = "static"') == ["dataset.classes: 'plaet*' takes no object of the template"]
    assert told('"plate" = "car"\n"x" = "van"') == ["dataset.classes: 'plate', 'x' take no object of the template"]
