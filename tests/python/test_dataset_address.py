"""Datasets at addresses: what a connection that is lost, and a writer that is killed, leave of them."""
import json
import uuid

import pytest

import echopath as ep
from echopath import dataset
from echopath.dataset.address import Address
from support.scene_text import SMALL_WAVEFORM

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


@pytest.mark.parametrize("error", [TimeoutError("timed out"), ConnectionResetError("reset"), PermissionError("not yours")])
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
def test_a_put_that_is_cut_short_leaves_what_was_there(monkeypatch, tmp_path, kind, templates):
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
