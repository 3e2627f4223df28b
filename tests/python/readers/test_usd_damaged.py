"""USD: files on which its own library crashes or takes too long, and values of other types than its schema has."""
from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from pxr import Usd, UsdGeom

import echopath as ep
from echopath.readers.usd import trial

DAMAGED = Path(__file__).parents[2] / "fuzz/corpus/usdc/crashes_usd_26.11.usdc"
HEAD = "#usda 1.0\n(\n    metersPerUnit = 1\n    timeCodesPerSecond = 10\n)\n"
TRIANGLE = """    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
"""
POINTS = "    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n"


def binary_stage(folder: Path) -> Path:
    stage = Usd.Stage.CreateNew(str(folder / "ball.usdc"))
    UsdGeom.Sphere.Define(stage, "/ball")
    stage.GetRootLayer().Save()
    return folder / "ball.usdc"


def notes_of(folder: Path, text: str) -> str:
    (folder / "stage.usda").write_text(HEAD + text)
    return " ".join(ep.load_model(folder / "stage.usda").notes)


def test_a_file_that_crashes_the_library_of_usd_is_refused():
    code = ("import sys, echopath as ep\ntry:\n    ep.load_model(sys.argv[1])\n"
            "except ep.FileError as error:\n    print(error)")
    done = subprocess.run([sys.executable, "-c", code, DAMAGED], capture_output=True, text=True)
    assert done.returncode == 0
    assert done.stdout.startswith(f"{DAMAGED}: is no USD stage that can be read (")


@pytest.mark.parametrize("binary", [True, False])
def test_the_crash_of_what_opens_a_stage_is_told(tmp_path, monkeypatch, binary):
    path = binary_stage(tmp_path)
    if not binary:
        path = tmp_path / "town.usda"
        path.write_text('#usda 1.0\ndef "a" (references = @ball.usdc@)\n{\n}\n')
    monkeypatch.setattr(trial, "_OPEN", "import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)")
    with pytest.raises(ep.FileError) as told:
        ep.load_model(path)
    crash = "is no USD stage that can be read (USD crashes on it by SIGSEGV, or needs more than"
    assert str(told.value).startswith(f"{path}: {crash}")


def test_a_stage_that_takes_too_long_is_refused(tmp_path, monkeypatch):
    path = binary_stage(tmp_path)
    monkeypatch.setattr(trial, "_OPEN", "import time\ntime.sleep(600)")
    monkeypatch.setattr(trial, "MOST_SECONDS", 0.2)
    with pytest.raises(ep.FileError, match=r"ball.usdc: .*\(USD takes more than 0 s to open it\)"):
        ep.load_model(path)


def test_a_stage_that_asks_for_more_memory_than_there_is_is_refused(tmp_path, monkeypatch):
    path = binary_stage(tmp_path)
    monkeypatch.setattr(trial, "_OPEN", trial._OPEN.replace("Usd.Stage.Open(sys.argv[1])", "bytes(2**60)"))
    with pytest.raises(ep.FileError, match=r"ball.usdc: .*\(it needs more memory than there is\)"):
        ep.load_model(path)


def test_what_usd_refuses_it_says_in_its_own_words(tmp_path):
    path = binary_stage(tmp_path)
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(ep.FileError) as told:
        ep.load_model(path)
    with pytest.raises(Exception) as own:
        Usd.Stage.Open(str(path))
    assert own.value.args[0].commentary.splitlines()[0].strip()[:100] in str(told.value)


def test_a_stage_that_opened_is_tried_again_only_once_it_has_changed(tmp_path, monkeypatch):
    tried, opened_apart = [], trial._opened_apart
    monkeypatch.setattr(trial, "_opened_apart", lambda *asked: tried.append(asked) or opened_apart(*asked))
    path = binary_stage(tmp_path)
    ep.load_model(path)
    ep.load_model(path)
    assert len(tried) == 1
    path.write_bytes(path.read_bytes()[:-40])
    for _ in range(2):
        with pytest.raises(ep.FileError):
            ep.load_model(path)
    assert len(tried) == 3


def test_text_that_refers_to_no_file_is_not_tried(tmp_path, monkeypatch):
    monkeypatch.setattr(trial, "_opened_apart", None)
    assert "is no USD stage" not in notes_of(tmp_path, 'def Sphere "ball"\n{\n}\n')


@pytest.mark.parametrize("samples", ["float3[] xformOp:rotateXYZ.timeSamples = {0: [(1, 2, 3)], 10: [(1, 2, 3), (4, 5, 6)]}",
                                     "float3[] xformOp:rotateXYZ.timeSamples = {0: [(1, 2, 3)], 10: []}",
                                     'string xformOp:rotateXYZ.timeSamples = {0: "a", 10: "b"}'])
def test_rotations_by_what_is_no_angle_are_refused(tmp_path, samples):
    (tmp_path / "stage.usda").write_text(HEAD + f'def Sphere "ball"\n{{\n    {samples}\n'
                                         '    uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]\n}\n')
    with pytest.raises(ep.FileError, match=r"stage.usda: .*Invalid combination of opType"):
        ep.load_model(tmp_path / "stage.usda")


def test_indices_of_instances_that_are_no_list_leave_them_out(tmp_path):
    text = ('def PointInstancer "trees"\n{\n    rel prototypes = </trees/tree>\n    int protoIndices = 3\n'
            '    point3f[] positions = [(0, 0, 0)]\n    def Sphere "tree"\n    {\n    }\n}\n')
    with pytest.raises(ep.FileError, match="holds no surface; the point instancer /trees is left out: it has protoIndices of "
                                           "another type than the schema of USD"):
        notes_of(tmp_path, text)


def test_points_over_time_that_are_no_points_stay(tmp_path):
    notes = notes_of(tmp_path, f'def Mesh "a"\n{{\n{TRIANGLE}{POINTS}'
                               '    point3f[] points.timeSamples = {0: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], 10: [(0, 0, 1)]}\n}\n')
    assert "change in number over time" in notes
