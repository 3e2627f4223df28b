"""Pipes that have a name: nobody may ever write into them, so that no reader waits there."""
import os
import signal

import pytest

import echopath as ep

READERS = {"load_mesh": "a.obj", "load_meshes": "a.stl", "load_model": "a.glb", "load_scene": "a.toml", "load_frame": "a.h5",
           "load_labels": "a.h5", "load_sequence": "a.h5", "read_trajectories": "a.csv", "load_antenna": "a.csv",
           "load_radar": "a.cfg"}


@pytest.fixture
def in_time():
    """Ends what waits; in the test itself nothing is measured."""
    signal.alarm(20)
    yield
    signal.alarm(0)


@pytest.mark.parametrize("reader, name", READERS.items())
def test_no_reader_waits_at_a_pipe(tmp_path, in_time, reader, name):
    os.mkfifo(tmp_path / name)
    with pytest.raises(ep.FileError, match=f"{name}: is no regular file"):
        getattr(ep, reader)(tmp_path / name)


def test_raw_data_and_captures_are_no_pipes(tmp_path, in_time, written):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ep.FileError, match="pipe: is no regular file"):
        ep.load_raw(tmp_path / "pipe", ep.load_radar(written()))
    with pytest.raises(ep.FileError, match="pipe.bvh: is no regular file"):
        (tmp_path / "pipe").rename(tmp_path / "pipe.bvh")
        ep.actors.captured_pedestrian(tmp_path / "pipe.bvh")
