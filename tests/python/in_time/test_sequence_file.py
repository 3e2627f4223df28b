"""All frames of a sequence in one file: whole frames at any time, the same bits however often the run was broken off."""
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from echopath.frame.maps import maps_of
from echopath.frame_file import changing as changes
from echopath.frame_file.changing import changing, work_folder
from echopath.frame_file.h5_items import library
from support.cut_off import NEW, OLD, Killed, cut_off, numbers_in, write_old
from support.frames_in_time import KILL_SOON, make_sequence, make_walk, signal_of

TESTS = Path(__file__).parents[2]
WAIT = 60.0  # s, for a process on a busy machine
MANY = 5     # frames: more than a process makes before it is killed


@pytest.fixture(scope="module")
def simulated() -> list[bytes]:
    return [signal_of(frame) for frame in make_sequence()]


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> ep.StoredSequence:
    return make_sequence().save(tmp_path_factory.mktemp("one") / "drive.h5")


def test_a_path_that_ends_in_h5_is_one_file_of_all_frames(whole, simulated):
    assert whole.path.is_file() and list(whole.path.parent.iterdir()) == [whole.path]
    assert [signal_of(frame) for frame in whole] == simulated and whole.is_done.all()
    again = ep.load_sequence(whole.path)
    assert signal_of(again[-1]) == simulated[-1] and again.radar == make_sequence().radar and len(again[1:3]) == 2
    with library().File(whole.path) as file:  # as any program reads it
        assert list(file["frames"]) == ["000000", "000001", "000002", "000003"]
        assert file["frames/000002/signal/cube"].shape == (1, 1, 32, 64)


def test_a_frame_in_the_file_is_named_as_if_it_lay_below_it(whole, simulated):
    assert whole.paths_of_files[2] == whole.path / "frames" / "000002"
    assert signal_of(ep.load_frame(whole.paths_of_files[2])) == simulated[2]
    assert list(ep.load_labels(whole.paths_of_files[2])) == ["parts"]
    with pytest.raises(ep.FileError, match="000009: .*no such group"):
        ep.load_frame(whole.path / "frames" / "000009")
    with pytest.raises(ep.FileError, match="is a sequence, not a single frame: .*/frames/000000' is its first frame"):
        ep.load_frame(whole.path)


def test_a_frame_of_a_file_is_read_without_a_look_at_the_names_of_the_others(whole, simulated, monkeypatch):
    listed, names_in = [], library().Group.__iter__
    monkeypatch.setattr(library().Group, "__iter__", lambda group: listed.append(group.name) or names_in(group))
    assert signal_of(whole[2]) == simulated[2] and "/frames" not in listed
    assert whole.is_there.all() and "/frames" in listed


@pytest.mark.parametrize("keep", ["maps", "labels"])
def test_small_frames_are_those_of_a_folder(tmp_path, keep):
    file, folder = (make_sequence(truth=True).save(tmp_path / name, keep=keep) for name in ("drive.h5", "drive"))
    for mine, theirs in zip(file, folder):
        assert mine == theirs
    assert file.truth == folder.truth


KILLED = """
from support.cut_off import NEW, OLD, Killed, cut_off, numbers_in, write_old
from support.frames_in_time import make_sequence, make_walk
""" + KILL_SOON


def test_a_run_that_is_killed_keeps_its_frames_and_goes_on_with_the_same_bits(tmp_path):
    path = tmp_path / "drive.h5"
    there = done_when_killed(f"make_sequence(frames={MANY}).save({str(path)!r}, progress=kill_soon)", path)
    resumed = list(make_sequence(frames=MANY).save_frames(path))
    assert [one.seconds is None for one in resumed] == there.tolist()
    assert [signal_of(frame) for frame in ep.load_sequence(path)] == [signal_of(frame) for frame in make_sequence(frames=MANY)]
    assert not work_folder(path).exists()


def done_when_killed(call: str, path: Path) -> np.ndarray:
    """Which frames a process that was killed in a call has written."""
    process = subprocess.Popen([sys.executable, "-c", f"{KILLED}{call}\n"], cwd=TESTS)
    assert process.wait(WAIT) == -signal.SIGKILL
    there = ep.load_sequence(path).is_done
    assert 2 <= there.sum() < MANY and there[:there.sum()].all()
    return there


@pytest.mark.parametrize("name", ["walk.h5", "walk"])
def test_speckle_maps_and_truth_of_a_person_go_on_after_a_kill(tmp_path, name):
    path, walk = tmp_path / name, make_walk(MANY)
    there = done_when_killed(f"make_walk({MANY}).save({str(path)!r}, keep='maps', progress=kill_soon)", path)
    stored = walk.save(path, keep="maps")
    assert stored.is_done.all() and there.sum() >= 2
    for place in (MANY - 1, 0, int(there.sum())):  # the first behind the kill, and in any order
        frame, kept = walk[place], stored[place]
        assert np.any(frame.paths.diffuse) and kept.power.max() > 0.0
        assert kept == maps_of(frame, with_power=True) and kept.kept_truth == kept.truth == frame.truth
    assert len(stored.truth) == MANY and np.diff(stored.truth.position[:, 0]).max() < 0.0


@pytest.mark.parametrize("step, is_there", [("_write_journal", False), ("_carry_out", True)])
def test_a_change_that_is_cut_off_is_not_there_or_is_mended(tmp_path, step, is_there):
    path = tmp_path / "numbers.h5"
    write_old(path)
    before = path.read_bytes()
    cut_off(path, step)
    assert path.read_bytes()[:len(before)] == before and numbers_in(path) == OLD
    changes.mend(path)
    assert numbers_in(path) == (NEW if is_there else OLD)
    with changing(path) as file:
        del file["old"]
        file["last"] = np.arange(10)
    assert numbers_in(path) == ({"new": 4999950000} if is_there else {}) | {"last": 45}


def test_pages_that_were_written_in_part_are_written_again(tmp_path, monkeypatch):
    path, written = tmp_path / "numbers.h5", []
    with library().File(path, "w", libver=changes.LAYOUT) as file:
        for number in range(300):
            file[f"{number}"] = np.full(20, number)
    work_folder(path).mkdir()

    def half(handle, page, at):
        if at < path.stat().st_size and len(written) == 2:
            raise Killed
        written.append(at)
        return os.pwrite(handle, page, at)

    with pytest.raises(Killed), changing(path) as file:
        for number in range(300, 600):
            file[f"{number}"] = np.full(20, number)
        file.flush()
        draft_is_whole = len(file)
        written.clear()
        monkeypatch.setattr(changes, "os", type("half", (), {**vars(os), "pwrite": staticmethod(half)}))
    monkeypatch.undo()
    assert draft_is_whole == 600
    changes.mend(path)
    assert numbers_in(path) == {f"{number}": 20 * number for number in range(600)}


def test_readers_wait_while_the_file_is_changed_and_changes_wait_for_readers(tmp_path, monkeypatch):
    path = tmp_path / "drive.h5"
    stored = make_sequence(frames=1).save(path)
    monkeypatch.setattr(changes, "PATIENCE", 0.1)
    with library().File(path):
        with pytest.raises(ep.FileError, match="another program keeps it open"):
            make_sequence(frames=2).save(path)
        assert stored[0].cube is not None
    assert make_sequence(frames=2).save(path).is_done.all() and len(ep.load_sequence(path)) == 2


def test_a_frame_that_is_damaged_is_made_again(tmp_path, simulated):
    path = tmp_path / "drive.h5"
    make_sequence().save(path)
    data = bytearray(path.read_bytes())
    place = data.find(make_sequence()[1].cube.tobytes()[:64])  # a value, which HDF5 itself does not check
    data[place + 5] ^= 1
    path.write_bytes(data)
    told = list(make_sequence().save_frames(path))
    assert [one.seconds is None for one in told] == [True, False, True, True]
    assert [signal_of(frame) for frame in ep.load_sequence(path)] == simulated


def test_a_file_grows_with_its_sequence_and_refuses_others(tmp_path, simulated):
    path = tmp_path / "drive.h5"
    make_sequence(frames=2).save(path)
    told = list(make_sequence().save_frames(path))
    assert [one.seconds is None for one in told] == [True, True, False, False]
    assert [signal_of(frame) for frame in ep.load_sequence(path)] == simulated
    with pytest.raises(ValueError, match="^path: must be new, or of this sequence .frames is 4 there and 3 here"):
        make_sequence(frames=3).save(path)
    with pytest.raises(ValueError, match="^path: must be new, or of this sequence .seed is 1 there and 5 here"):
        make_sequence(seed=5).save(path)
    assert list(tmp_path.iterdir()) == [path]
    ep.save_frame(make_sequence()[0], tmp_path / "frame.h5")
    with pytest.raises(ValueError, match="^path: must be new, .*is a single frame, not a sequence: ep.load_frame"):
        make_sequence().save(tmp_path / "frame.h5")


def test_what_one_file_cannot_be_is_refused_by_name(tmp_path):
    with pytest.raises(ValueError, match="^shard: must be None for one file"):
        make_sequence().save(tmp_path / "drive.h5", shard=(1, 2))
    with pytest.raises(ValueError, match="^path: must be a folder or a file of another name than sequence.h5"):
        make_sequence().save(tmp_path / "sequence.h5")
    first = make_sequence().save_frames(tmp_path / "drive.h5")
    next(first)
    with pytest.raises(ValueError, match="^path: must be one that no other run is writing to"):
        make_sequence().save(tmp_path / "drive.h5")
    first.close()
    (tmp_path / "old.h5").mkdir()
    assert make_sequence().save(tmp_path / "old.h5").paths_of_files[0].name == "frame_0000.h5"  # a folder stays one
