"""What a view keeps in a large file for the next one: never another result, and never a reason not to open it."""
from __future__ import annotations

import os
from pathlib import Path

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.files import file_state
from echopath.frame_file import kept
from echopath.frame_file.h5 import write_array
from echopath_viewer.model import CellBox, Filters, Session, from_file, from_frame
from echopath_viewer.model.frames import inputs, kept_orders, preview
from echopath_viewer.model.frames.kept_orders import COLUMNS, ORDERS, keep_orders

BOXES = ((0, 40, 0, 20), (3, 9, 2, 9), (20, 90, 12, 31))


@pytest.fixture
def kept_file(frame, tmp_path, monkeypatch):
    """A frame file after its first view."""
    monkeypatch.setattr(kept_orders, "FEWEST_PATHS", 1)
    ep.save_frame(frame, tmp_path / "frame.h5")
    assert keep_orders(tmp_path / "frame.h5", Session(from_file(tmp_path / "frame.h5")))
    return tmp_path / "frame.h5"


def held(path):
    """The arrays in a file, None: none that belong to it."""
    return kept.kept_arrays(path, file_state(path), "viewer", kept_orders.VERSION, kept_orders.ARRAYS)


def write_next_frame(path) -> None:
    """Another frame of as many paths and cells: each path has four times the power."""
    with h5py.File(path, "a") as file:
        values = 2.0 * file["record/paths/weight"][...]
        del file["record/paths/weight"]
        write_array(file["record/paths"], "weight", values)


def shown(session) -> list:
    """All that columns and orders decide."""
    found = [session.shown_rays(), session.node_counts(), session.listed_rays(), session.columns.power]
    session.set_filters(Filters(min_power_dbm=-130.0))
    found += [session.shown_rays(), session.visible]
    return found + [session.index.mask_of(CellBox(*box)) for box in BOXES]


def assert_shows_the_same(path, frame, *, is_kept: bool) -> None:
    session = Session(from_file(path))
    assert session.is_kept == is_kept
    fresh = Session(from_frame(frame))
    for one, other in zip(shown(session), shown(fresh), strict=True):
        assert np.array_equal(one, other)
    for view in (session, fresh):
        view.set_channel(1, 1)  # which is not kept
    assert np.array_equal(session.shown_rays(), fresh.shown_rays())


def test_the_next_view_reads_it_and_shows_the_same(kept_file, frame):
    assert_shows_the_same(kept_file, frame, is_kept=True)


def test_the_frame_in_the_file_is_the_same(kept_file, frame):
    again = ep.load_frame(kept_file)
    assert np.array_equal(again.noisy_cube, frame.noisy_cube) and np.array_equal(again.paths.hits, frame.paths.hits)
    with h5py.File(kept_file) as file:
        assert set(file["viewer"]) == {*COLUMNS, *ORDERS, "group_power"}


def test_what_is_deleted_or_damaged_is_made_anew(kept_file, frame):
    good = kept_file.read_bytes()
    for item in (*COLUMNS, *ORDERS, "group_power"):
        for damage in (delete, change_a_value, hold_a_number):
            kept_file.write_bytes(good)
            with h5py.File(kept_file, "a") as file:
                damage(file["viewer"], item)
            assert held(kept_file) is None
    for damage in (delete, hold_a_number):
        kept_file.write_bytes(good)
        with h5py.File(kept_file, "a") as file:
            damage(file, "viewer")
        assert_shows_the_same(kept_file, frame, is_kept=False)


def delete(group, item) -> None:
    del group[item]


def change_a_value(group, item) -> None:
    group[item][0] += 1


def hold_a_number(group, item) -> None:
    del group[item]
    group[item] = 3


@pytest.mark.parametrize("key", [None, 3, "another"])
def test_without_its_key_nothing_is_read(kept_file, key):
    with h5py.File(kept_file, "a") as file:
        del file["viewer"].attrs["key"]
        if key is not None:
            file["viewer"].attrs["key"] = key
    assert from_file(kept_file).kept is None


@pytest.mark.parametrize("part", ["scene/placement", "record/paths/weight", "record/hits/mesh_id", "spectra/range"])
def test_what_another_record_has_left_is_not_read(kept_file, part):
    with h5py.File(kept_file, "a") as file:
        file[part].attrs["crc32"] = np.uint32(1)
    assert held(kept_file) is None


def test_what_another_core_has_made_is_not_read(kept_file, tmp_path, monkeypatch):
    core = tmp_path / "core.so"
    core.write_bytes(Path(kept.CORE[0]).read_bytes())
    monkeypatch.setattr(kept, "CORE", (str(core), file_state(core)))
    assert held(kept_file) is not None
    core.write_bytes(core.read_bytes() + b"0")
    monkeypatch.setattr(kept, "CORE", (str(core), file_state(core)))
    assert held(kept_file) is None


def test_a_core_that_was_built_anew_since_it_was_loaded_keeps_nothing(kept_file, tmp_path, monkeypatch):
    core = tmp_path / "core.so"
    core.write_bytes(b"another")
    monkeypatch.setattr(kept, "CORE", (str(core), (0, 0, 0)))
    assert not keep_orders(kept_file, Session(from_file(kept_file)))


def test_numbers_that_point_beyond_the_paths_are_not_used(kept_file, frame):
    session = Session(from_file(kept_file))
    session.index.order[0] = frame.paths.num_paths
    assert keep_orders(kept_file, session)
    assert_shows_the_same(kept_file, frame, is_kept=False)


def test_a_file_that_cannot_be_replaced_stays_as_it_is(kept_file, monkeypatch):
    session, before = Session(from_file(kept_file)), kept_file.read_bytes()
    os.link(kept_file, kept_file.with_name("other.h5"))
    assert not keep_orders(kept_file, session)
    kept_file.with_name("other.h5").unlink()
    with monkeypatch.context() as patch:
        patch.setattr(os, "access", lambda path, mode: False)
        assert not keep_orders(kept_file, session)

    def written_meanwhile(target, *_):
        os.utime(kept_file, ns=(1, 1))
    with monkeypatch.context() as patch:
        patch.setattr(kept, "write_array", written_meanwhile)
        assert not keep_orders(kept_file, session)

    def full(*_):
        raise OSError(28, "No space left on device")
    session = Session(from_file(kept_file))
    monkeypatch.setattr(kept, "reserve", full)
    assert not keep_orders(kept_file, session)
    assert kept_file.read_bytes() == before and os.listdir(kept_file.parent) == ["frame.h5"]


def test_what_is_made_of_the_frame_before_is_not_kept_with_the_next(kept_file):
    session = Session(from_file(kept_file))
    write_next_frame(kept_file)
    assert not keep_orders(kept_file, session) and from_file(kept_file).kept is None
    again = Session(from_file(kept_file))
    assert again.columns.power == pytest.approx(4.0 * session.columns.power, rel=1e-12)
    assert keep_orders(kept_file, again)


def test_what_is_kept_of_the_next_frame_is_not_read_to_the_one_before(kept_file, monkeypatch):
    power = Session(from_file(kept_file)).columns.power

    def load_and_write(path, meshes=None):
        frame = load(path)
        write_next_frame(path)
        assert keep_orders(path, Session(from_file_unwatched(path)))
        return frame

    def from_file_unwatched(path):
        with monkeypatch.context() as patch:
            patch.setattr(inputs, "read_frame", load)
            return from_file(path)

    load = inputs.read_frame
    monkeypatch.setattr(inputs, "read_frame", load_and_write)
    view_input = from_file(kept_file)
    assert view_input.kept is None and np.array_equal(Session(view_input).columns.power, power)


def test_a_stale_one_is_replaced_and_the_mode_of_the_file_kept(kept_file, frame):
    os.chmod(kept_file, 0o640)
    size = kept_file.stat().st_size
    with h5py.File(kept_file, "a") as file:
        file["viewer"].attrs["key"] = "another"
    assert keep_orders(kept_file, Session(from_file(kept_file)))
    assert kept_file.stat().st_mode & 0o777 == 0o640 and kept_file.stat().st_size <= 1.1 * size
    assert_shows_the_same(kept_file, frame, is_kept=True)


def test_a_window_keeps_them_once_and_does_not_read_its_own_file_anew(qapp, frame, tmp_path, monkeypatch):
    from echopath_viewer.window import MainWindow

    monkeypatch.setattr(kept_orders, "FEWEST_PATHS", 1)
    monkeypatch.setattr(preview, "LARGE", 1)
    path = tmp_path / "frame.h5"
    ep.save_frame(frame, path)
    states = []
    for _ in range(2):
        window = MainWindow()
        window.open_file(path)
        window.settle()
        states.append(path.stat().st_mtime_ns)
        for _ in range(3):
            window.file_watch.look()
        assert not window.loading.is_running and window.session.paths.num_paths == frame.paths.num_paths
        window.close()
    assert states[0] == states[1] and window.session is None
    assert_shows_the_same(path, frame, is_kept=True)
