"""Datasets at addresses: what a connection that is lost, and a writer that is killed, leave of them."""
import json
import uuid

import pytest

import echopath as ep
from echopath import dataset
from echopath.dataset.address import Address
from support.files.scene_text import SMALL_WAVEFORM

fsspec = pytest.importorskip("fsspec")
TEMPLATE = """
[dataset]
scenes = 1
seed = {seed}
""" + SMALL_WAVEFORM


@pytest.fixture
def templates(tmp_path):
    """Two templates that differ."""
    for seed in (1, 2):
        (tmp_path / f"{seed}.toml").write_text(TEMPLATE.format(seed=seed))
    return [dataset.Template(tmp_path / f"{seed}.toml") for seed in (1, 2)]


@pytest.fixture
def address():
    return Address(f"memory://{uuid.uuid4().hex}")


def failing(monkeypatch, address, method: str, error: Exception) -> None:
    def fail(*_, **__):
        raise error
    monkeypatch.setattr(type(address._files), method, fail)


class EndpointConnectionError(Exception):
    """As the library of an object store raises where that does not answer: no OSError."""


@pytest.mark.parametrize("error", [TimeoutError("timed out"), ConnectionResetError("reset"), PermissionError("not yours"),
                                   EndpointConnectionError("no answer")])
def test_a_file_that_cannot_be_read_is_not_taken_for_none(monkeypatch, address, templates, error):
    ours, other = templates
    address.prepare(ours)
    address.put("scenes/000000/record.json", b'{"state": "done"}')
    with monkeypatch.context() as patch:
        failing(patch, address, "cat_file", error)
        with pytest.raises(ep.FileError, match=f"{address.address}/dataset.toml: cannot be read .{error}"):
            address.prepare(other)
        with pytest.raises(ep.FileError, match=f"{address.address}/scenes/000000/record.json: cannot be read"):
            address.record(0)
    assert address.get("dataset.toml").decode() == ours.path.read_text() and address.record(0).state == "done"


def test_scenes_without_a_template_are_not_taken_over(monkeypatch, address, templates):
    address.put("scenes/000000/record.json", json.dumps({"state": "done"}).encode())
    with pytest.raises(ValueError, match=r"folder: must be new, or of this template \(it has scenes and no dataset.toml\)"):
        address.prepare(templates[0])
    assert not address.get("dataset.toml")
    failing(monkeypatch, address, "ls", TimeoutError("timed out"))
    with pytest.raises(ep.FileError, match=f"{address.address}/scenes: cannot be read .timed out"):
        address.prepare(templates[0])


@pytest.mark.parametrize("kind", ["memory", "file"])
def test_a_put_that_is_cut_short_leaves_what_was_there(monkeypatch, tmp_path, kind):
    address = Address(f"{kind}://{tmp_path / 'out'}")
    address.put("dataset.toml", b"before")
    whole = type(address._files).pipe_file

    def cut(self, path, value, *more, **options):
        whole(self, path, value[:3], *more, **options)
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(type(address._files), "pipe_file", cut)
        with pytest.raises(KeyboardInterrupt):
            address.put("dataset.toml", b"after")
    assert address.get("dataset.toml") == b"before"
    address.put("dataset.toml", b"after")
    assert address.get("dataset.toml") == b"after"


@pytest.mark.parametrize("kind", ["memory", "file"])
def test_what_a_killed_call_was_about_to_move_is_removed_and_nothing_else(tmp_path, kind):
    address = Address(f"{kind}://{tmp_path / 'out'}")
    left = f".frame_0000.h5-{uuid.uuid4().hex}"
    for name in ("record.json", "frame_0000.h5", ".claim", left):
        address.put(f"scenes/000004/{name}", b"some")
    address.put(f"scenes/000005/{left}", b"of another scene")
    address.tidy(4)
    assert [address.get(f"scenes/00000{place}") for place in (f"4/{left}", "4/.claim", "4/frame_0000.h5", "5/" + left)] == [
        b"", b"some", b"some", b"of another scene"]
    address.tidy(6)  # which is not there


def test_a_put_whose_file_another_call_takes_for_left_is_done_again(monkeypatch, address):
    move, taken = type(address._files).mv, []

    def tidied_before(self, path, *more, **options):
        if not taken:
            taken.append(path)
            self.rm_file(path)
        move(self, path, *more, **options)

    monkeypatch.setattr(type(address._files), "mv", tidied_before)
    address.put("scenes/000000/record.json", b"whole")
    assert taken and address.get("scenes/000000/record.json") == b"whole"


def test_an_address_is_copied_before_it_is_opened(address):
    with pytest.raises(ep.FileError, match=f"^{address.address}: is an address; copy it to a folder first"):
        dataset.open(address.address)
