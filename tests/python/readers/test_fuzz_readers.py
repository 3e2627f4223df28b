"""A short run of the fuzzers of the readers in Python; a long one: `./bootstrap.sh fuzz`."""
import os
import time
from pathlib import Path
from random import Random

import numpy as np
import pytest

import echopath as ep
from echopath.readers.usd import trial
from fuzz import targets, usd_trials, worker
from fuzz.feeds.foreign_seeds import seeds_of
from fuzz.mutate import damaged
from fuzz.seeds import frames

CASES = {"frame_bytes": 40, "frame_structure": 40, "arrays": 150, "scene": 300, "antenna": 300,
         "gltf_bytes": 300, "gltf_json": 300, "gltf_bin": 200, "frames_folder": 200, "mtl": 200, "serialized": 300, "xml": 300,
         "usda": 100, "usdc": 100, "usdz": 100, "npz": 200, "bvh": 40, "obj": 200, "stl": 200, "off": 200,
         "table": 100, "sumo": 100, "gpx": 100, "sensor": 200, "template": 200, "sequence": 40}


def test_each_target_has_a_short_run():
    assert CASES.keys() == targets.TARGETS.keys()


def test_an_empty_seed_is_damaged_by_bytes_that_come():
    assert all(damaged(b"", Random(number)) for number in range(20))


@pytest.mark.hard
@pytest.mark.parametrize("target", CASES)
def test_readers_refuse_or_read_whatever_comes(target):
    count, findings = worker.run(target, range(CASES[target]))
    assert count == CASES[target] and findings == []


def _ends(path):
    """How a new process ends that opens a stage, and how a fork does."""
    return tuple(opened(path, 60.0, 2 ** 33) for opened in (trial._opened_apart, usd_trials.opened_by_fork))


@pytest.mark.hard
@pytest.mark.parametrize("name, code", [("whole", 0), ("cut off", 1), ("crash", -1)])
def test_a_fork_ends_on_a_stage_as_a_new_process_does(name, code, tmp_path, monkeypatch):
    pytest.importorskip("pxr", reason="usd-core, of the extra 'usd', is not installed")
    whole = seeds_of(".usdc")[0]
    path = tmp_path / "stage.usdc"
    path.write_bytes(whole[:600] if name == "cut off" else whole)
    if name == "crash":
        monkeypatch.setattr(trial, "_OPEN", "import os\nprint('before', flush=True)\nos.kill(os.getpid(), 11)")
    new, forked = _ends(path)
    assert (forked.returncode, forked.stdout) == (new.returncode, new.stdout)
    assert np.sign(new.returncode) == code


@pytest.mark.hard
def test_a_stage_that_crashes_usd_ends_no_process_but_its_own():
    """USD reads beyond its memory there: what lies behind it decides whether the process is ended or the stage refused."""
    pytest.importorskip("pxr", reason="usd-core, of the extra 'usd', is not installed")
    ends = _ends(Path(targets.__file__).parent / "corpus" / "usdc" / "crashes_usd_26.11.usdc")
    assert all(end.returncode != 0 for end in ends)


def _faulty():
    """Breaks its promise in case 1, ends its process in case 2, hangs in case 3."""
    def case(number):
        if number == 1:
            raise KeyError("mesh")
        if number == 2:
            os._exit(3)
        if number == 3:
            time.sleep(60)

    return case


@pytest.mark.hard
def test_a_worker_tells_errors_crashes_and_hangs_and_goes_on(monkeypatch):
    monkeypatch.setattr(worker, "HANG", 0.5)
    monkeypatch.setattr(worker, "STARVED", 4.0)
    count, findings = worker.run("faulty", range(6), make=_faulty)
    assert count == 6
    assert [finding.number for finding in findings] == [1, 2, 3]
    assert [finding.what[:12] for finding in findings] == ["KeyError: 'm", "ended the pr", "took more th"]


def columns_of(paths) -> dict:
    """Keywords of Paths.from_arrays that give the same paths."""
    names = ("hits", "offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "scene", "radar", "frame")
    return {name: getattr(paths, name) for name in names} | {
        name: getattr(paths, name) for name in ("jones", "curved_cell") if len(getattr(paths, name))}


def test_columns_of_paths_give_the_same_paths(plates_and_wall):
    paths = plates_and_wall[0]
    assert np.array_equal(ep.Paths.from_arrays(**columns_of(paths)).amplitude, paths.amplitude)


@pytest.mark.parametrize("offset", [2**63 - 1, -2**63, -1])
def test_an_offset_that_leads_nowhere_is_refused_by_name(plates_and_wall, offset):
    paths = plates_and_wall[0]
    columns = columns_of(paths)
    columns["offsets"] = paths.offsets.copy()
    columns["offsets"][0] = offset
    with pytest.raises(ValueError, match=f"offsets: must lead to hits, got {offset}"):
        ep.Paths.from_arrays(**columns)


@pytest.mark.parametrize("hits", [np.array([None]), np.zeros(4, "V16"), np.zeros((2, 4), np.float32), np.zeros(3)])
def test_hits_of_another_type_are_refused_by_name(plates_and_wall, hits):
    with pytest.raises(TypeError, match="hits: must be an array .H. of .mesh_id, triangle_id, u, v."):
        ep.Paths.from_arrays(**columns_of(plates_and_wall[0]) | {"hits": hits})


def test_seeds_of_frame_files_have_what_comes_beside_the_paths():
    made = frames()
    for name in ("interference_cube", "rain_cube"):
        assert any(getattr(frame, name) is not None for frame in made), name
    for name in ("interferers", "weather"):
        assert any(getattr(frame.scene, name) for frame in made), name
