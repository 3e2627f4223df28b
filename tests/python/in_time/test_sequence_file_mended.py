"""One file of all frames whose writer was killed or hindered: no other file suffers, and whoever reads finds whole frames."""
import errno
import os
import shutil

import numpy as np
import pytest

import echopath as ep
from echopath.frame_file import changing as changes
from echopath.frame_file.changing import changing, has_journal, mend, work_folder
from echopath.frame_file.container import kind_of
from echopath.frame_file.h5_items import library
from echopath.frame_file.opening import reading
from echopath.sequence import folder_lock
from echopath.sequence.folder_lock import writing_to
from support.cut_off import NEW, OLD, Killed, cut_off, numbers_in, write_old
from support.frames_in_time import make_sequence, signal_of


@pytest.fixture
def path(tmp_path):
    write_old(tmp_path / "numbers.h5")
    return tmp_path / "numbers.h5"


def numbers_read(path) -> dict:
    """As readers of Echopath see them."""
    with reading(path) as file:
        return {name: file[name][()].sum() for name in file}


def test_a_change_that_readers_do_not_let_in_leaves_nothing(tmp_path, monkeypatch):
    path = tmp_path / "drive.h5"
    make_sequence(frames=1).save(path)
    before = ep.load_sequence(path)[0]
    monkeypatch.setattr(changes, "PATIENCE", 0.1)
    with library().File(path) as file:
        size = file.id.get_filesize()
        with pytest.raises(ep.FileError, match="drive.h5: cannot be changed .another program keeps it open"):
            make_sequence(frames=2).save(path)
    assert list(tmp_path.iterdir()) == [path] and path.stat().st_size == size
    assert signal_of(ep.load_sequence(path)[0]) == signal_of(before)


@pytest.mark.parametrize("is_new_inode", [True, False])
def test_a_file_that_is_put_in_the_place_of_another_is_not_changed(path, is_new_inode):
    other = path.with_name("other.h5")
    with library().File(other, "w", libver=changes.LAYOUT) as file:
        file["other"] = np.arange(20000.0)
    cut_off(path, "_carry_out")
    if is_new_inode:
        path.rename(path.with_name("moved.h5"))
    shutil.copyfile(other, path)
    assert has_journal(path) and numbers_read(path) == {"other": 199990000.0}
    assert not has_journal(path) and path.read_bytes() == other.read_bytes()


def test_a_journal_without_its_file_is_dropped(path):
    cut_off(path, "_carry_out")
    path.unlink()
    with pytest.raises(ep.FileError, match="no such file"):
        numbers_read(path)
    assert not has_journal(path) and not path.exists()


def test_a_file_that_was_changed_since_is_not_changed_back(path):
    cut_off(path, "_carry_out")
    with library().File(path, "r+", libver=changes.LAYOUT) as file:  # by another program, which knows of no journal
        file["more"] = np.arange(5)
    assert numbers_read(path) == OLD | {"more": 10} and not has_journal(path)


def test_what_was_carried_out_but_for_its_end_is_carried_out_again(path):
    cut_off(path, "_drop_journal")
    assert has_journal(path) and numbers_in(path) == NEW
    assert numbers_read(path) == NEW and not has_journal(path)


def test_a_journal_that_is_damaged_is_told_by_its_name(path):
    cut_off(path, "_carry_out")
    journal = work_folder(path) / "journal.npz"
    journal.write_bytes(journal.read_bytes()[:-100])
    with pytest.raises(ep.FileError, match="numbers.h5: has changes of a run .*journal.npz is damaged"):
        numbers_read(path)
    with pytest.raises(ep.FileError, match="numbers.h5: cannot be changed .*journal.npz is damaged"), changing(path):
        pass
    assert numbers_in(path) == OLD


@pytest.mark.parametrize("read", [kind_of, lambda path: ep.load_frame(path / "frames" / "000000"), ep.load_sequence])
def test_whoever_reads_mends(tmp_path, monkeypatch, read):
    def killed(*arguments):
        raise Killed

    path = tmp_path / "drive.h5"
    make_sequence(frames=1).save(path)
    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr(changes, "_carry_out", killed)
        make_sequence(frames=2).save(path)
    assert has_journal(path) and read(path) is not None and not has_journal(path)
    assert make_sequence(frames=2).save(path).is_done.all() and not work_folder(path).exists()


def test_a_link_has_the_folder_and_the_journal_of_its_file(tmp_path, path):
    link = tmp_path / "elsewhere" / "link.h5"
    link.parent.mkdir()
    link.symlink_to(path)
    cut_off(path, "_carry_out")
    assert work_folder(link) == work_folder(path) and numbers_read(link) == NEW


def test_two_runs_do_not_write_to_one_file_by_a_link(tmp_path):
    path, link = tmp_path / "drive.h5", tmp_path / "elsewhere" / "link.h5"
    link.parent.mkdir()
    link.symlink_to(path)
    first = make_sequence(frames=2).save_frames(link)  # of a file that is not there yet
    next(first)
    with pytest.raises(ValueError, match="^path: must be one that no other run is writing to"):
        make_sequence(frames=2).save(path)
    first.close()
    assert link.is_symlink() and path.is_file() and make_sequence(frames=2).save(link).is_done.all()
    assert sorted(tmp_path.rglob("*")) == [path, link.parent, link]


def test_a_work_folder_that_goes_meanwhile_is_done(path, monkeypatch):
    monkeypatch.setattr(changes, "has_journal", lambda path: True)
    mend(path)
    assert numbers_in(path) == OLD


def test_a_folder_that_another_run_removes_before_it_is_locked_is_made_again(tmp_path, monkeypatch):
    folder, enter, removed = tmp_path / "work", folder_lock._enter, []

    def remove_first(*arguments):
        if not removed:
            removed.append(folder.rmdir())
        return enter(*arguments)

    monkeypatch.setattr(folder_lock, "_enter", remove_first)
    with writing_to(folder, False, lambda is_alone: None):
        with pytest.raises(ValueError, match="no other run is writing"), writing_to(folder, False, lambda is_alone: None):
            pass
    assert removed and folder.is_dir()


def test_what_a_change_that_fails_wrote_is_taken_away(path, monkeypatch):
    before, size = path.read_bytes(), 1 << 24

    def full(handle, at, num_bytes):
        os.ftruncate(handle, at + num_bytes // 2)
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(ZeroDivisionError), changing(path, size) as file:
        file["new"] = np.arange(100000)
        raise ZeroDivisionError
    assert path.read_bytes() == before
    monkeypatch.setattr(changes.os, "posix_fallocate", full)
    with pytest.raises(ep.FileError, match="No space left"), changing(path, size):
        pass
    assert path.read_bytes() == before


def test_a_change_that_makes_a_file_shorter_is_not_there_before_its_journal(path, monkeypatch):
    with changing_alone(path) as file:
        file["new"] = np.arange(100000)
    before = path.read_bytes()

    def look(*arguments):
        assert path.read_bytes()[:len(before)] == before
        return write(*arguments)

    write = changes._write_journal
    monkeypatch.setattr(changes, "_write_journal", look)
    with changing_alone(path) as file:
        del file["new"]
    assert numbers_in(path) == OLD and path.stat().st_size < len(before)


def changing_alone(path):
    work_folder(path).mkdir(exist_ok=True)
    return changing(path)


def test_a_file_of_an_older_layout_is_refused_and_left(path):
    write_old(path, layout="earliest")
    before = path.read_bytes()
    with pytest.raises(ep.FileError, match="not in the layout of HDF5 1.10"), changing(path):
        pass
    assert path.read_bytes() == before
