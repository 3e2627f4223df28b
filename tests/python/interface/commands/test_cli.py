"""The command line as a user meets it: exit codes, one line for each fault, Ctrl-C."""
from __future__ import annotations

import io
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import redirect_stderr, redirect_stdout, suppress
from types import SimpleNamespace

import pytest

import echopath as ep
from echopath.base.storage.data_folder import data_folder
from echopath.base.storage.files import require_writable
from echopath.cli import main
from echopath.scene_file import load_scene
from support.background import heed_ctrl_c, heed_signals
from support.files.scene_text import ANTENNAS, WAVEFORM
from support.pictures import plain

STOP_SECONDS = 15.0  # half a second is promised; the rest is for a machine with other work
MANY_RAYS = "50_000_000"  # more than a machine traces while the test waits
SCENE = """
title = "a plate"
""" + WAVEFORM + ANTENNAS + """\
[[objects]]
name = "plate"
mesh = "plate.obj"
material = {reflectivity = 0.27, scattering = 1.0}
position = [5.0, 0.0, 0.0]
motion = {kind = "linear", velocity = [-2.0, 0.0, 0.0]}
[trace]
num_rays = 2000
[parts.route]
direct = "T . R"
"""
PLATE = "v 0 -0.5 -0.5\nv 0 0.5 -0.5\nv 0 0.5 0.5\nv 0 -0.5 0.5\nf 1 2 3 4\n"


@pytest.fixture
def scene_path(tmp_path):
    (tmp_path / "plate.obj").write_text(PLATE)
    path = tmp_path / "plate.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture(scope="module")
def finished_run(tmp_path_factory):
    """(scene file, folder, what is told) of what `echopath run` makes of it; nobody changes them."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "plate.obj").write_text(PLATE)
    path = folder / "plate.toml"
    path.write_text(SCENE)
    with plain():
        done = call("run", path, "--out", folder / "out", "--rays", "500")
    assert done.returncode == 0, done.stderr
    return path, folder / "out", done


def command(*arguments) -> list:
    return [sys.executable, "-m", "echopath", *map(str, arguments)]


def call(*arguments) -> SimpleNamespace:
    """What the command returns and prints, within this process, which has loaded the package already."""
    printed, told = io.StringIO(), io.StringIO()
    with redirect_stdout(printed), redirect_stderr(told):
        try:
            code = main([str(argument) for argument in arguments])
        except SystemExit as end:
            code = end.code
    return SimpleNamespace(returncode=code or 0, stdout=printed.getvalue(), stderr=told.getvalue())


def test_version_is_that_of_the_package_and_needs_nothing_that_takes_time_to_load():
    done = subprocess.run([sys.executable, "-X", "importtime", *command("--version")[1:]], capture_output=True, text=True)
    assert done.stdout == call("--version").stdout == f"echopath {ep.__version__}\n"
    loaded = {line.rpartition("|")[2].strip() for line in done.stderr.splitlines()}
    assert "echopath._startup" in loaded and not loaded & {"numpy", "h5py", "pydantic", "matplotlib", "echopath._core"}


# Each would end in files beneath a file.
WRITERS = {"run": ["run", "plate.toml"], "demo": ["demo"], "bench": ["bench", "speed"], "labels": ["labels", "none.h5"]}


@pytest.mark.parametrize("verb", WRITERS)
def test_a_folder_that_cannot_be_written_is_named_before_the_work(verb, scene_path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(ep._core, "trace", None)  # no work begins
    (tmp_path / "file").write_text("")
    assert main([*WRITERS[verb], "--out", "file/out"]) == 2
    told = capsys.readouterr().err
    assert told == f"echopath: --out: must be a folder that can be written, got '{tmp_path / 'file/out'}' (Not a directory)\n"


@pytest.mark.parametrize("what, option, owner", [
    ("speed", "--rays-max", "physics"), ("crowd", "--scenes", "certificate"), ("certificate", "--seeds", "crowd"),
    ("worlds", "--suite", "measured"), ("live", "--cities", "worlds"), ("targets", "--models", "worlds")])
def test_an_option_of_another_benchmark_is_refused(what, option, owner, tmp_path, capsys):
    assert main(["bench", what, "--quick", option, "7", "--out", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err == f"echopath: {option}: belongs to `echopath bench {owner}`, got 7\n"
    assert not (tmp_path / "out").exists()


def test_a_file_in_the_place_of_the_folder_of_a_run_is_named_before_the_work(scene_path, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(ep._core, "trace", None)  # no work begins
    (tmp_path / "file.txt").write_text("mine")
    assert main(["run", str(scene_path), "--out", str(tmp_path / "file.txt")]) == 2
    assert "--out: must be a folder that can be written" in capsys.readouterr().err
    assert (tmp_path / "file.txt").read_text() == "mine"


@pytest.mark.parametrize("command", [["run", "plate.toml", "--out", "out", "--raw"], ["view", "frame.h5", "--picture"]])
def test_a_folder_in_the_place_of_a_file_is_named_before_the_work(scene_path, tmp_path, monkeypatch, capsys, command):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(ep._core, "trace", None)  # no work begins
    (tmp_path / "folder").mkdir()
    assert main([*command, "folder"]) == 2
    assert capsys.readouterr().err == f"echopath: {command[-1]}: must be the name of a file, not of a folder, got 'folder'\n"
    assert not (tmp_path / "out").exists()


def test_a_folder_that_is_tried_is_not_left_behind(tmp_path):
    require_writable(tmp_path / "a" / "b", "--out")
    assert list(tmp_path.iterdir()) == []


def test_run_writes_the_frame_and_its_pictures(finished_run):
    _, out, done = finished_run
    files = sorted(out.iterdir())
    assert [path.name for path in files] == ["frame.h5", "map.png", "overview.png", "route.png", "scene.png"]
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in files[1:])
    assert ep.Paths.load(out / "frame.h5").frame.statistics.num_rays == 500
    assert "rays                              500" in done.stdout
    assert done.stderr == ""  # no bar without a terminal


@pytest.mark.parametrize("encoding, errors, title", [("ascii", "strict", "M\\xfcll \\u2192 \\u7403"),
                                                     ("ascii", "surrogateescape", "M\\xfcll \\u2192 \\u7403"),  # of the locale C
                                                     ("latin-1", "strict", "M\xfcll \\u2192 \\u7403"),
                                                     ("utf-8", "strict", "M\xfcll \u2192 \u7403")])
@pytest.mark.usefixtures("blank_pictures")
def test_letters_that_the_output_does_not_have_are_no_end_of_a_run(scene_path, tmp_path, monkeypatch, encoding, errors, title):
    scene_path.write_text(SCENE.replace("a plate", "M\xfcll \u2192 \u7403"), encoding="utf-8")
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding=encoding, errors=errors))
    arguments = ["--rays", "200", "--frames", "1", "--interval", "0.1", "--keep", "labels", "--out", str(tmp_path / "out")]
    assert main(["run", str(scene_path), *arguments]) == 0
    sys.stdout.flush()
    assert sys.stdout.buffer.getvalue().decode(encoding).startswith(f"{title}: 1 frame")


@pytest.mark.usefixtures("blank_pictures")
def test_an_array_gives_a_picture_from_above(scene_path, tmp_path):
    second = "[[radar.receivers]]\nposition = [0.0, 0.012, 0.0]\n"
    scene_path.write_text(SCENE.replace("[[objects]]", second + "[[objects]]", 1))
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", "500")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "range_azimuth.png").exists()
    info = call("info", scene_path).stdout
    assert "2 elements, 2 across x 1 up, in steps of 0.517 wavelengths across" in info and "overlaps, gaps" in info


@pytest.mark.parametrize("seed", [2**53 + 1, 2**64 - 1])
@pytest.mark.usefixtures("blank_pictures")
def test_a_seed_is_taken_to_its_last_digit(scene_path, tmp_path, seed):
    """Which is more than a float holds; half of the seeds that are drawn from 64 bits are so large."""
    assert call("run", scene_path, "--out", tmp_path / "out", "--rays", "2e2", "--seed", seed).returncode == 0
    assert ep.Paths.load(tmp_path / "out" / "frame.h5").frame.seed == seed


@pytest.mark.usefixtures("blank_pictures")
def test_partitions_take_no_file_from_others_and_none_out_of_the_folder(scene_path, tmp_path):
    again = "".join(f'[parts."{name}"]\ndirect = "T . R"\n' for name in ("labels_a_b", "a b", "../b"))
    scene_path.write_text(SCENE.replace("parts.route", "parts.map") + again + "[labels]\n")
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", "500")
    assert done.returncode == 0, done.stderr
    told = [name for line in done.stdout.splitlines() if ".png" in line for name in line.strip().split(", ")]
    assert len(told) == len(set(told)) == 3 * 4 + 6  # three of each partition, six beside them
    found = [path.relative_to(tmp_path / "out") for path in tmp_path.rglob("*.png")]
    assert sorted(map(str, found)) == sorted(told)
    assert {"map.png", "parts_map.png", "parts_labels_a_b.png", "labels_a_b.png"} <= set(told)


@pytest.mark.hard
@pytest.mark.usefixtures("plain_pictures")
def test_run_twice_gives_the_same_bytes(finished_run, tmp_path):
    scene, first, _ = finished_run
    assert call("run", scene, "--out", tmp_path / "again", "--rays", "500").returncode == 0
    for name in ("frame.h5", "map.png", "overview.png", "route.png", "scene.png"):
        assert (first / name).read_bytes() == (tmp_path / "again" / name).read_bytes()


def test_info_tells_scenes_frames_and_meshes_apart(finished_run):
    scene, out, _ = finished_run
    assert "a plate" in call("info", scene).stdout
    told = call("info", out / "frame.h5").stdout
    assert "paths" in told and "95 % interval" in told
    assert call("info", out).stdout == told
    refused = call("run", out / "frame.h5", "--out", out)
    assert refused.returncode == 2 and "frame.h5: a frame file, where a scene file (.toml) is asked for" in refused.stderr
    assert "1 m^2, open" in call("info", scene.with_name("plate.obj")).stdout


def test_the_folder_that_one_is_in_has_a_name(tmp_path, monkeypatch, capsys):
    (tmp_path / "town").mkdir()
    (tmp_path / "town" / "plate.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    monkeypatch.chdir(tmp_path / "town")
    assert main(["info", "."]) == 0
    assert capsys.readouterr().out.startswith("town: OBJ")


@pytest.mark.usefixtures("blank_pictures")
def test_surfaces_on_each_other_are_told(scene_path, tmp_path):
    assert "surfaces on each other            none" in call("info", scene_path).stdout
    again = '[[objects]]\nname = "again"\nmesh = "plate.obj"\nmaterial = "metal"\nposition = [5.0, 0.25, 0.0]\n'
    (tmp_path / "double.obj").write_text("g a[1]\n" + PLATE + "g b\n" + PLATE.replace("f 1 2 3 4", "f 5 6 7 8"))
    scene_path.write_text(SCENE.replace("[trace]", again + "[trace]", 1).replace("[-2.0, 0.0, 0.0]", "[0.0, 0.0, 0.0]"))
    assert "plate and again                 4 triangles, 0.75 m^2" in call("info", scene_path).stdout
    assert "a[1] and b                      4 triangles, 1 m^2" in call("info", tmp_path / "double.obj").stdout
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", "500")
    for told in (done.stdout, call("info", tmp_path / "out" / "frame.h5").stdout):
        assert "surfaces on each other (rounding decides" in told
        assert "plate and again                 4 triangles, 0.75" in told


def test_surfaces_on_each_other_are_those_that_the_rays_see(scene_path):
    """In the middle of the frame, when a moving plate has come to one that stands still."""
    middle = 0.5 * load_scene(scene_path).radar.frame_duration
    again = ('[[objects]]\nname = "again"\nmesh = "plate.obj"\nmaterial = "metal"\n'
             f'position = [{5.0 - 2.0 * middle!r}, 0.0, 0.0]\n')
    scene_path.write_text(SCENE.replace("[trace]", again + "[trace]", 1))
    assert "plate and again                 4 triangles, 1 m^2" in call("info", scene_path).stdout


@pytest.mark.usefixtures("blank_pictures")
def test_parts_and_selections_of_the_command_line(scene_path, tmp_path):
    parts = ("--part", "strong = power > 1e-30 & T . R", "--part", "plate=T 'plate' R")
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", "500", *parts)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "choice.png").exists()
    frame = ep.load_frame(tmp_path / "out" / "frame.h5")
    assert list(frame.parts) == ["route", "choice"] and list(frame.parts["choice"]) == ["strong", "plate", "other"]
    told = call("info", tmp_path / "out" / "frame.h5", "--select", "T 'plate' R & ~(power < 0)", "--select", "T . . R")
    assert f"paths                             {frame.paths.num_paths:,} of {frame.paths.num_paths:,}" in told.stdout
    assert "dBm, T D'plate' R, " in told.stdout and told.stdout.endswith(f"0 of {frame.paths.num_paths:,}\n")


@pytest.mark.parametrize("arguments, message", [
    (("--part", "T . R"), "echopath: --part: must be NAME=SELECTION, as in "),
    (("--part", "a=T . R", "--part", "a=T R"), "echopath: --part: must have a name of its own, got a twice"),
    (("--part", "a=T 'plat' R"), "echopath: parts.choice.a: path expression: expected a glob that takes a mesh, got 'plat'; "
                                 "nearest names: plate\n  T 'plat' R\n    ^\n"),
    (("--part", "a=T . R & T"), "echopath: --part: a: path expression: expected a hit"),
])
def test_faults_of_parts_are_told_before_the_trace(scene_path, tmp_path, arguments, message):
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", MANY_RAYS, *arguments)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.startswith(message)


@pytest.mark.usefixtures("blank_pictures")
def test_a_run_takes_the_files_of_an_earlier_one_along(scene_path, tmp_path):
    """They would be taken for its own; what else is in the folder stays."""
    out, fresh = tmp_path / "out", tmp_path / "fresh"
    scene_path.write_text(SCENE + "[labels]\n[detections]\n")
    assert call("run", scene_path, "--out", out, "--rays", "500", "--truth", "--part", "strong=power > 1e-30").returncode == 0
    assert {"choice.png", "detections.csv", "truth.csv", "labels_choice.png", "label_maps"} <= {one.name for one in out.iterdir()}
    told = call("info", out / "frame.h5").stdout
    assert "cells labelled, choice" in told and re.search(r"^\d+ detections?$", told, re.MULTILINE) and "objects " in told
    (out / "notes.txt").write_text("mine")
    scene_path.write_text(SCENE)
    for folder in (out, fresh):
        assert call("run", scene_path, "--out", folder, "--rays", "500").returncode == 0
    left = {path.name for path in out.rglob("*")}
    assert left == {path.name for path in fresh.iterdir()} | {"notes.txt"}


@pytest.mark.parametrize("raw", ["out/frame.h5", "plate.toml", "out/MAP.PNG"])
def test_raw_data_takes_the_place_of_no_file_of_its_run(scene_path, tmp_path, monkeypatch, capsys, raw):
    monkeypatch.setattr(ep._core, "trace", None)  # no work begins
    text = scene_path.read_text()
    assert main(["run", str(scene_path), "--out", str(tmp_path / "out"), "--raw", str(tmp_path / raw)]) == 2
    assert capsys.readouterr().err.startswith("echopath: --raw: must be a file of raw data (.bin), of no kind that a run reads ")
    assert scene_path.read_text() == text and not (tmp_path / "out").exists()


def test_asking_for_truth_keeps_the_objects_that_the_scene_file_names(scene_path, tmp_path):
    scene_path.write_text(SCENE + '[truth]\nobjects = {sheet = "plate"}\n')
    tables = []
    for options in ((), ("--truth",)):
        out = tmp_path / f"out{len(tables)}"
        done = call("run", scene_path, "--out", out, "--rays", "200", "--frames", "1", "--interval", "0.1", "--keep", "labels",
                    *options)
        assert done.returncode == 0, done.stderr
        tables.append((out / "truth.csv").read_text())
    assert "sheet" in tables[0] and tables[1] == tables[0]


@pytest.mark.usefixtures("blank_pictures")
def test_a_picture_that_fails_is_a_warning_beside_the_report(scene_path, tmp_path, monkeypatch):
    def fail(*_, **__):
        raise MemoryError

    monkeypatch.setattr(ep.plots, "plot_partition", fail)
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", "500")
    assert done.returncode == 0 and (tmp_path / "out" / "frame.h5").is_file()
    assert done.stderr == "warning: the frame is written, but not all of its pictures: MemoryError\n"
    assert "received power, route" in done.stdout and "  scene.png, map.png\n" in done.stdout


def test_info_of_a_record_without_signals_is_told(scene_path, tmp_path):
    scene_file = ep.load_scene(scene_path)
    ep.trace(scene_file.scene, scene_file.radar, num_rays=100).save(tmp_path / "paths.h5")
    done = call("info", tmp_path / "paths.h5")
    assert done.returncode == 0 and "cube" not in done.stdout


BAD = {
    "missing scene": (("run", "nowhere.toml", "--out", "out"), "nowhere.toml: cannot be read"),
    "missing frame": (("info", "nowhere.h5"), "nowhere.h5: no such file"),
    "missing mesh": (("info", "nowhere.obj"), "nowhere.obj"),
    "missing folder": (("info", "nowhere"), "nowhere: no such file or folder"),
    "unknown kind of file": (("info", __file__), "must be a .toml or .h5 file, or one of .glb, .gltf, .vrm, .obj, .ply, .stl"),
    "selection of a mesh": (("info", "a.obj", "--select", "T . R"), "a.obj: must be a frame file (.h5) for --select"),
    "no rays": (("demo", "--rays", "0"), "must be a whole number of at least 1, got '0'"),
    "rays in words": (("demo", "--rays", "many"), "must be a whole number of at least 1, got 'many'"),
    "no name of a folder": (("run", "nowhere.toml", "--out", ""), "--out: must be the name of a file or folder, got ''"),
    "no command": ((), "required: COMMAND"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_gives_one_clear_line_and_code_2(name):
    arguments, message = BAD[name]
    done = call(*arguments)
    assert done.returncode == 2 and done.stdout == ""
    assert message in done.stderr.splitlines()[-1] and "Traceback" not in done.stderr


@pytest.mark.parametrize("arguments, message", [
    (("demo", "--rays", "1e11"), "--rays: must be a whole number from 1 to"),
    (("demo", "--batches", "65"), "--batches: must be a whole number from 1 to 64, got 65"),
    (("run", "SCENE", "--out", "out", "--frames", "2", "--interval", "1e-9"), "--interval: must be at least"),
    (("run", "SCENE", "--out", "SCENE", "--frames", "2", "--interval", "0.1"), "--out: must be a folder that can be written"),
    (("labels", "FRAME", "--out", "out", "--dynamic-range", "-3"), "--dynamic-range: must be a finite number"),
    (("labels", "FRAME", "--out", "out", "--object", "plate"), "--object: must be NAME=GLOB"),
    (("labels", "FRAME", "--out", "out", "--object", "a=plat"), "--object: must be globs that take meshes"),
    (("scene", "SCENE", "--out", "a.toml"), "FILE: must be a file of the kinds .glb"),
    (("scene", "MESH", "--out", "a.toml", "--unit", "-1"), "--unit: must be "),
    (("view", "FRAME", "--scale", "0"), "--scale: must be a whole number"),
    (("run", "a" * 300 + ".toml", "--out", "out"), "SCENE.toml: must be the name of a file that can be"),
    (("dataset", "a" * 300 + ".toml", "--out", "out"), "DATASET.toml: must be the name of a file that can be"),
    (("dataset", "TEMPLATE", "--out", "s3://bucket/out"), "--out: must be no address where there is no scheduler"),
    (("dataset-report", "a" * 300), "DIR: must be the name of a file that can be"),
    (("view", "a" * 300 + ".h5"), "FRAME.h5: must be the name of a file that can be"),
    (("info", "a" * 300 + ".h5"), "a" * 300 + ".h5: File name too long"),
])
def test_faults_name_what_was_typed(finished_run, tmp_path, monkeypatch, arguments, message):
    """And not what the functions behind the options call it."""
    scene, folder, _ = finished_run
    monkeypatch.chdir(tmp_path)
    files = {"SCENE": scene, "FRAME": folder / "frame.h5", "MESH": scene.parent / "plate.obj",
             "TEMPLATE": data_folder("datasets") / "ghosts.toml"}
    done = call(*(files.get(argument, argument) for argument in arguments))
    assert done.returncode == 2 and done.stderr.startswith(f"echopath: {message}"), done.stderr


def test_faults_of_a_scene_file_keep_their_names(scene_path, tmp_path):
    """Nobody typed an option for them."""
    scene_path.write_text(SCENE.replace("num_rays = 2000", "num_rays = 0"))
    done = call("run", scene_path, "--out", tmp_path / "out")
    assert done.returncode == 2 and "trace.num_rays: must be" in done.stderr and "--rays" not in done.stderr


@pytest.mark.parametrize("fault", [
    "[labels]\nerrors = true", "[labels]\nplane = 'range_azimuth'", "[detections]\nguard_range = 60",
    "[replay]\nretrace = 'always'\nkeyframes = 10000", "[sequence]\nframes = 2\ninterval = 1e-9",
])
def test_settings_that_a_run_refuses_are_told_by_file_and_line(scene_path, tmp_path, fault):
    """As those are that the file alone shows to be wrong."""
    scene_path.write_text(SCENE.replace("num_rays = 2000", "num_rays = 200") + fault)
    done = call("run", scene_path, "--out", tmp_path / "out")
    table, key, line = fault[1:].partition("]")[0], fault.split("\n")[-1].partition(" ")[0], (SCENE + fault).count("\n") + 1
    assert done.returncode == 2 and done.stderr.startswith(f"echopath: {scene_path}: line {line}: {table}.{key}: "), done.stderr


def test_settings_that_were_typed_are_told_as_such(scene_path, tmp_path):
    scene_path.write_text(SCENE + "[sequence]\nframes = 2\ninterval = 1.0\n")
    done = call("run", scene_path, "--out", tmp_path / "out", "--interval", "1e-9")
    assert done.returncode == 2 and done.stderr.startswith("echopath: --interval: must be at least")
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", "1e12")
    assert done.returncode == 2 and done.stderr.startswith("echopath: --rays: must be a whole number")


def test_one_frame_is_no_single_file(scene_path, tmp_path):
    """A folder of that name would be taken for the file that was asked for."""
    done = call("run", scene_path, "--out", tmp_path / "frame.h5", "--rays", MANY_RAYS)
    assert done.returncode == 2 and done.stderr.startswith("echopath: --out: must be a folder for one frame and its pictures")
    assert not (tmp_path / "frame.h5").exists()


def test_more_keyframes_than_chirps_are_told_before_the_trace(scene_path, tmp_path):
    scene_path.write_text(SCENE + "[replay]\nretrace = 'always'\nkeyframes = 10000\n")
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", MANY_RAYS)
    assert done.returncode == 2 and done.stdout == "" and "keyframes: must be at most the " in done.stderr


def test_a_fault_of_a_scene_file_is_one_line(scene_path, tmp_path):
    scene_path.write_text(SCENE.replace("bandwidth", "bandwith"))
    line = next(number for number, text in enumerate(SCENE.split("\n"), 1) if text.startswith("bandwidth"))
    done = call("run", scene_path, "--out", tmp_path / "out")
    assert done.returncode == 2
    assert done.stderr == (f"echopath: {scene_path}: line {line}: radar.waveform.bandwith: unknown key; did you mean 'bandwidth'?"
                           "\n")
    assert not (tmp_path / "out").exists()


def test_a_mistyped_option_gets_the_usage_of_its_command_and_the_nearest_one():
    done = call("run", "scene.toml", "--out", "x", "--ray", "100")  # no shortening of --rays
    assert done.returncode == 2 and done.stderr.startswith("usage: echopath run")
    assert "unrecognized arguments: --ray 100 (the nearest option is --rays)" in " ".join(done.stderr.split())
    for word, told in (("--num-rays=5", "(the nearest option is --rays)"), ("--qqqq", "--qqqq\n")):
        assert told in call("run", "scene.toml", "--out", "x", word).stderr


def test_a_scene_file_in_the_place_of_a_frame_is_told(scene_path, tmp_path):
    done = call("labels", scene_path, "--out", tmp_path / "out")
    assert done.returncode == 2 and "a scene file, where a frame file (.h5) is asked for" in done.stderr


def test_a_model_in_the_place_of_a_frame_is_told(tmp_path):
    (tmp_path / "car.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\n")
    done = call("labels", tmp_path / "car.obj", "--out", tmp_path / "out")
    words = " ".join(done.stderr.split())
    assert done.returncode == 2 and "car.obj: not a frame file (.h5); `echopath scene" in words


def rest_of(leader: int) -> bytes:
    """All that is left of a terminal whose program has ended: one read takes a line or 4096 bytes, as it comes."""
    drawn = b""
    with suppress(OSError):  # EIO: nobody holds the other end any more
        while some := os.read(leader, 4096):
            drawn += some
    return drawn


@pytest.mark.hard
def test_ctrl_c_stops_soon_and_leaves_nothing_half_written(scene_path, tmp_path):
    leader, follower = os.openpty()
    arguments = command("run", scene_path, "--out", tmp_path / "out", "--rays", MANY_RAYS)
    process = subprocess.Popen(arguments, stderr=follower, preexec_fn=heed_ctrl_c)
    os.close(follower)
    try:
        drawn = b""
        while b"trace" not in drawn or b"%" not in drawn:  # on a terminal a bar is drawn
            drawn += os.read(leader, 4096)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=30) == 130
        assert time.monotonic() - begin < STOP_SECONDS
    finally:
        process.kill()
    assert rest_of(leader).decode().strip().endswith("echopath: stopped; no file was left half written")
    os.close(leader)
    assert not (tmp_path / "out").exists() or list((tmp_path / "out").iterdir()) == []


def ignore_ctrl_c() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@pytest.mark.parametrize("number, ignored", [(signal.SIGTERM, False), (signal.SIGHUP, False), (signal.SIGTERM, True)],
                         ids=["SIGTERM", "SIGHUP", "SIGTERM in the background"])
def test_signals_of_batch_systems_and_terminals_leave_nothing_half_written(tmp_path, number, ignored):
    """The signal comes in the middle of a file; a shell lets programs in the background of scripts ignore Ctrl-C."""
    code = f"""
import os, sys
from pathlib import Path
import echopath.cli as cli
from echopath.base.storage.files import written_whole

def write(options):
    with written_whole(Path({str(tmp_path / "out" / "frame.h5")!r})) as temporary:
        temporary.write_bytes(b"half")
        os.kill(os.getpid(), {int(number)})
        while True:
            pass

cli.parser.work.info = write
sys.exit(cli.main(["info", "any"]))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60,
                          preexec_fn=ignore_ctrl_c if ignored else heed_signals)
    assert (done.returncode, done.stderr.strip()) == (128 + number, "echopath: stopped; no file was left half written")
    assert list((tmp_path / "out").iterdir()) == []


def test_signals_that_the_program_was_started_to_ignore_are_ignored():
    """As `nohup` has it."""
    code = """
import os, signal, sys
import echopath.cli as cli
signal.signal(signal.SIGHUP, signal.SIG_IGN)
cli.parser.work.info = lambda options: os.kill(os.getpid(), signal.SIGHUP)
sys.exit(cli.main(["info", "any"]))
"""
    done = subprocess.run([sys.executable, "-c", code], timeout=60)
    assert done.returncode == 0


def test_a_program_without_outputs_runs(finished_run, monkeypatch):
    """As a shell starts it with `>&- 2>&-`."""
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", None)
    assert main(["info", str(finished_run[0])]) == 0
    assert main(["info", "missing.h5"]) == 2
    assert sys.stdout is None and sys.stderr is None


def test_help_fits_a_terminal_of_80_columns(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    for verb in ("demo", "run", "view", "info", "scene", "labels", "dataset", "dataset-report", "bench"):
        assert max(map(len, call(verb, "--help").stdout.splitlines())) <= 80, verb


@pytest.mark.parametrize("there, arguments, kind", [
    ("sequence.h5", (), "frames in time (sequence.h5)"), ("dataset.toml", (), "a dataset (dataset.toml)"),
    ("frame.h5", ("--frames", "2", "--interval", "0.1"), "one frame (frame.h5)"),
    ("dataset.toml", ("--frames", "2", "--interval", "0.1"), "a dataset (dataset.toml)")])
def test_results_of_another_kind_are_not_written_beside(scene_path, tmp_path, there, arguments, kind):
    """`echopath view` and `info` of the folder would show the one or the other, which may be the older."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / there).write_text("")
    done = call("run", scene_path, "--out", tmp_path / "out", "--rays", MANY_RAYS, *arguments)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr == f"echopath: --out: must be another folder than that of {kind}, got '{tmp_path / 'out'}'\n"
    assert [path.name for path in (tmp_path / "out").iterdir()] == [there]
