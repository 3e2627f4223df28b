"""Folders of frames: the same bits however often the run was broken off, refused where they are of another sequence."""
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import echopath as ep
from echopath import dataset
from echopath.sequence import folder_lock
from support.frames_in_time import INTERVAL, KILL_SOON, make_radar, make_scene, make_sequence

KEEPS = ["all", "maps", "labels"]
TESTS = Path(__file__).parents[2]
WAIT = 60.0  # s, for a process on a busy machine
MANY = 5     # frames: more than a process makes before it is killed


def contents_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory) -> dict[str, Path]:
    """{keep: folder of a run without a break}"""
    folders = {keep: tmp_path_factory.mktemp(keep) for keep in KEEPS}
    for keep, folder in folders.items():
        make_sequence().save(folder, keep=keep)
    return folders


@pytest.mark.parametrize("keep", KEEPS)
def test_a_second_run_changes_nothing(unbroken, keep):
    before = {path: path.stat().st_mtime_ns for path in unbroken[keep].glob("frame_*")}
    contents = contents_of(unbroken[keep])
    make_sequence().save(unbroken[keep], keep=keep)
    assert contents_of(unbroken[keep]) == contents
    assert {path: path.stat().st_mtime_ns for path in unbroken[keep].glob("frame_*")} == before


KILLED = """
from support.frames_in_time import make_sequence
""" + KILL_SOON


@pytest.mark.parametrize("keep", ["all", "labels"])
def test_a_run_that_is_killed_goes_on_with_the_same_bits(tmp_path, keep):
    """Killed in the midst of its work by SIGKILL, which nothing can catch, however busy the machine is."""
    broken, whole = tmp_path / "broken", tmp_path / "whole"
    script = KILLED + f"make_sequence(frames={MANY}).save({str(broken)!r}, keep={keep!r}, progress=kill_soon)\n"
    process = subprocess.Popen([sys.executable, "-c", script], cwd=TESTS)
    assert process.wait(WAIT) == -signal.SIGKILL
    there = {path: path.stat().st_mtime_ns for path in broken.glob("frame_*")}
    assert 2 <= len(there) < MANY and ep.load_sequence(broken).is_done.sum() == len(there)

    resumed = list(make_sequence(frames=MANY).save_frames(broken, keep=keep))
    assert [one.seconds is None for one in resumed] == [True] * len(there) + [False] * (MANY - len(there))
    make_sequence(frames=MANY).save(whole, keep=keep)
    assert contents_of(broken) == contents_of(whole)
    assert all(path.stat().st_mtime_ns == written for path, written in there.items())


def test_files_that_are_not_whole_are_made_again(tmp_path, unbroken):
    make_sequence().save(tmp_path)
    cut, flipped, swapped = (tmp_path / f"frame_000{place}.h5" for place in (0, 1, 2))
    cut.write_bytes(cut.read_bytes()[:cut.stat().st_size // 2])
    data = bytearray(flipped.read_bytes())
    place = data.find(make_sequence()[1].cube.tobytes()[:64])  # a value, which HDF5 itself does not check
    data[place + 5] ^= 1
    flipped.write_bytes(data)
    swapped.write_bytes((tmp_path / "frame_0003.h5").read_bytes())
    (tmp_path / ".frame_0001-abcdefgh.h5").write_bytes(b"of a process that was killed")
    told = list(make_sequence().save_frames(tmp_path))
    assert [one.seconds is None for one in told] == [False, False, False, True]
    assert contents_of(tmp_path) == contents_of(unbroken["all"])


def test_a_folder_in_the_place_of_a_frame_is_no_frame(tmp_path):
    make_sequence(frames=2).save(tmp_path, keep="maps")
    (tmp_path / "frame_0001.h5").unlink()
    (tmp_path / "frame_0001.h5").mkdir()
    assert ep.load_sequence(tmp_path).is_done.tolist() == [True, False]


def test_frames_are_saved_one_by_one_behind_bars(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("echopath.base.process.progress.DELAY", 0.0)  # quick ones show, too
    assert len(list(make_sequence(frames=2).save_frames(tmp_path, progress=True))) == 2
    assert capsys.readouterr().err.count("\rtrace ") >= 2


def test_a_folder_grows_with_its_sequence(tmp_path, unbroken):
    make_sequence(frames=2).save(tmp_path)
    told = list(make_sequence().save_frames(tmp_path))
    assert [one.seconds is None for one in told] == [True, True, False, False]
    assert [one.path.name for one in told] == [f"frame_000{place}.h5" for place in range(4)]
    assert contents_of(tmp_path) == contents_of(unbroken["all"])


def test_the_time_left_is_that_of_the_frames_that_are_missing(tmp_path):
    make_sequence()[:1].save(tmp_path)
    told = list(make_sequence().save_frames(tmp_path))
    assert told[0].seconds_left is None and told[3].seconds_left == 0.0
    assert told[1].seconds_left == pytest.approx(2.0 * told[1].seconds, rel=0.1)
    assert told[2].seconds_left == pytest.approx(0.5 * (told[1].seconds + told[2].seconds), rel=0.1)


OTHERS = {"interval is 0.1 there and 0.2 here": {"interval": 0.2}, "seed is 1 there and 5 here": {"seed": 5},
          "start_time is 0.0 there and 1.0 here": {"start_time": 1.0}, "frames is 4 there and 3 here": {"frames": 3},
          "parts is": {"parts": {"plate": "T 'pla*' R"}}, "labels is": {"labels": {"noise_margin_db": 6.0}}}


@pytest.mark.parametrize("told, keywords", OTHERS.items())
def test_a_folder_of_another_sequence_is_refused_by_name(unbroken, told, keywords):
    before = contents_of(unbroken["all"])
    with pytest.raises(ValueError, match=f"^path: must be new, or of this sequence .{told}"):
        make_sequence(**keywords).save(unbroken["all"])
    assert contents_of(unbroken["all"]) == before


def test_another_scene_or_radar_is_refused_by_name(unbroken):
    settings = {"frames": 4, "interval": INTERVAL, "num_rays": 500, "guard": False, "labels": True, "detections": True,
                "parts": {"plate": "T 'plate' R"}}
    with pytest.raises(ValueError, match="^path: .*scene/motions/0.* differs"):
        ep.Sequence(make_scene(speed=2.0), make_radar(), **settings).save(unbroken["all"])
    with pytest.raises(ValueError, match="^path: .*radar transmit_power differs"):
        ep.Sequence(make_scene(), make_radar(transmit_power=0.5), **settings).save(unbroken["all"])
    with pytest.raises(ValueError, match="^path: .*keep is 'all' there and 'maps' here"):
        make_sequence().save(unbroken["all"], keep="maps")


def test_frames_of_nothing_are_not_taken_over(tmp_path):
    (tmp_path / "frame_0000.h5").write_bytes(b"a user's own")
    with pytest.raises(ValueError, match="^path: .*frame_0000.h5 and no sequence.h5"):
        make_sequence().save(tmp_path)
    assert (tmp_path / "frame_0000.h5").read_bytes() == b"a user's own"


def test_two_runs_into_one_folder_are_refused(tmp_path):
    first = make_sequence().save_frames(tmp_path)
    next(first)
    with pytest.raises(ValueError, match="^path: must be one that no other run is writing to"):
        make_sequence().save(tmp_path)
    first.close()
    make_sequence().save(tmp_path)


def test_wrong_arguments_are_named(tmp_path):
    with pytest.raises(ValueError, match="^keep: must be 'all', 'maps' or 'labels', got 'map'"):
        make_sequence().save(tmp_path, keep="map")
    with pytest.raises(ValueError, match="^keep: must be 'all' or 'maps' for a sequence without labels"):
        make_sequence(labels=False).save(tmp_path, keep="labels")
    with pytest.raises(ValueError, match="^frames: must be at least 1"):
        make_sequence()[4:].save(tmp_path)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ep.FileError, match="sequence.h5: no such file"):
        ep.load_sequence(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(ep.FileError, match="^path: "):
        make_sequence().save(tmp_path / "file")


def test_progress_is_the_share_of_the_frames(tmp_path):
    told = []
    make_sequence().save(tmp_path, progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told == [("frames", 0.25), ("frames", 0.5), ("frames", 0.75), ("frames", 1.0)]


def shard_process(folder: Path, shard) -> subprocess.Popen:
    script = ("from support.frames_in_time import make_sequence\n"
              f"make_sequence(frames={MANY}).save({str(folder)!r}, shard={shard})\n")
    return subprocess.Popen([sys.executable, "-c", script], cwd=TESTS, stderr=subprocess.PIPE, text=True)


def test_processes_that_share_a_folder_by_shards_make_the_frames_of_one(tmp_path):
    shared, alone = tmp_path / "shared", tmp_path / "alone"
    processes = [shard_process(shared, (k, 2)) for k in (1, 2)]
    assert [(process.communicate(timeout=WAIT)[1], process.returncode) for process in processes] == [("", 0)] * 2
    make_sequence(frames=MANY).save(alone)
    assert contents_of(shared) == contents_of(alone)


def test_a_shard_makes_every_nth_frame_and_tells_of_these_alone(tmp_path, unbroken):
    shares = []
    stored = make_sequence().save(tmp_path, shard=(2, 3), progress=lambda stage, fraction: shares.append(fraction))
    assert stored.is_done.tolist() == [False, True, False, False] and shares == [1.0]
    assert [one.place for one in make_sequence().save_frames(tmp_path, shard=(1, 3))] == [0, 3]
    assert list(make_sequence().save_frames(tmp_path, shard=(9, 9))) == []
    make_sequence().save(tmp_path)
    assert contents_of(tmp_path) == contents_of(unbroken["all"])


def test_shards_do_not_wait_for_each_other_and_refuse_who_wants_the_folder_alone(tmp_path):
    first = make_sequence().save_frames(tmp_path, shard=(1, 2))
    next(first)
    leftover = tmp_path / ".frame_0000-abcdefgh.h5"
    leftover.write_bytes(b"of the first, which is writing it")
    assert make_sequence().save(tmp_path, shard=(2, 2)).is_done.tolist() == [True, True, False, True]
    assert leftover.exists()
    with pytest.raises(ValueError, match="^path: must be one that no other run is writing to, or all by shards"):
        make_sequence().save(tmp_path)
    with pytest.raises(ValueError, match="^path: must be new, or of this sequence"):
        make_sequence(seed=9).save(tmp_path, shard=(2, 2))
    first.close()
    make_sequence().save(tmp_path)
    assert not leftover.exists()


def test_a_shard_does_not_enter_where_one_run_wants_to_be_alone(tmp_path, monkeypatch):
    monkeypatch.setattr(folder_lock, "PATIENCE", 0.1)
    first = make_sequence().save_frames(tmp_path)
    next(first)
    with pytest.raises(ValueError, match="^path: must be one that no other run is writing to"):
        make_sequence().save(tmp_path, shard=(2, 2))


@pytest.mark.parametrize("shard, error", [((0, 2), ValueError), ((3, 2), ValueError), ((1, 2, 3), ValueError),
                                          ((0.5, 2), TypeError), ("1/2", TypeError), (2, ValueError)])
def test_wrong_shards_are_refused_by_name(tmp_path, shard, error):
    with pytest.raises(error, match="^shard: must be"):
        make_sequence().save(tmp_path, shard=shard)


@pytest.mark.parametrize("name, damaged", [("frames", "frames/sequence.h5"), ("drive.h5", "drive.h5")])
@pytest.mark.parametrize("share", [0.0, 0.6])
def test_a_damaged_head_is_named_with_what_to_do(tmp_path, name, damaged, share):
    """The file itself, and not the hidden one that is compared with it."""
    make_sequence(frames=1).save(tmp_path / name)
    whole = (tmp_path / damaged).read_bytes()
    (tmp_path / damaged).write_bytes(whole[:int(share * len(whole))])
    with pytest.raises(ValueError, match="^path: must be new, or of this sequence") as told:
        make_sequence(frames=1).save(tmp_path / name)
    words = str(told.value)
    assert f"({tmp_path / damaged}: damaged or not an HDF5 file" in words and "move what is there away" in words
    assert "/." not in words.replace(str(tmp_path), "")


def test_who_reads_a_folder_is_told_to_those_who_ask_it_for_something_else(tmp_path):
    """Of frames in time, of a dataset and of a run; that of anything else has nothing to tell."""
    made, other, empty = tmp_path / "frames", tmp_path / "dataset", tmp_path / "empty"
    make_sequence(frames=1).save(made, keep="maps")
    for folder in (other, empty):
        folder.mkdir()
    (other / "dataset.toml").write_text("[dataset]\nscenes = 1\n")
    reads_frames = "; the folder holds frames in time, which ep.load_sequence reads"
    with pytest.raises(ep.FileError, match=f"^path: must be the name of a file, not of a folder{reads_frames}, got"):
        ep.load_frame(made)
    with pytest.raises(ep.FileError, match=f"is no dataset, it has no dataset.toml{reads_frames}$"):
        dataset.open(made)
    with pytest.raises(ep.FileError, match="no such file; the folder holds a dataset, which echopath.dataset.open reads$"):
        ep.load_sequence(other)
    with pytest.raises(ep.FileError, match="sequence.h5: no such file$"):
        ep.load_sequence(empty)
    with pytest.raises(ep.FileError, match="not a sequence: ep.load_frame reads it; the folder holds frames in time, which"):
        ep.load_sequence(made / "frame_0000.h5")
