"""Wrong calls of the command line, drawn at random: one line that names what is wrong, exit code 2, no traceback."""
import io
import os
import random
import sys

import pytest

from echopath.cli import main

NUM_CALLS = 200
FILES = ["empty.h5", "junk.h5", "empty.toml", "junk.toml", "empty.obj", "junk.obj", "junk.ply", "folder.h5", "folder.toml",
         "loop.toml", "missing.h5", "missing.toml", "", ".", "-", "a\0b.h5", "a\udce9.toml", "a" * 300 + ".h5", "/dev/null"]
FOLDERS = ["out", "junk.obj", "junk.obj/out", "", "/proc/out", "/dev/null", "a\0b", "a" * 300, "loop.toml", "out\udce9"]
NUMBERS = ["0", "-1", "nan", "inf", "1e400", "1.5", "", "0x10", "1e18", "\u0665", "9" * 400]
PARTS = ["", "a", "=", "=b", "a=(", "a=power > nan", "a\0=T . R", "other=T . R", "a=\udce9", "\udce9=T . R", "a=T .{1,99999} R"]
OPTIONS = {
    "run": {"--rays": NUMBERS, "--seed": NUMBERS, "--batches": NUMBERS, "--part": PARTS},
    "labels": {"--part": PARTS, "--object": PARTS, "--plane": ["", "x"], "--noise-margin": NUMBERS,
               "--false-alarm-rate": NUMBERS, "--cfar": ["", "ca", "\udce9"]},
    "info": {"--select": ["", "T", "(", "power > nan", "T '\udce9' R", "\0"]},
    "view": {"--state": ["junk.toml", "missing.json", "a\0"], "--picture": FOLDERS},
    "bench": {"--rays-max": NUMBERS, "--scenes": NUMBERS, "--seeds": NUMBERS},
    "nonsense": {"--rays": NUMBERS},
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Files that are no scenes, frames or meshes."""
    monkeypatch.chdir(tmp_path)
    draw = random.Random(1)
    for name in ("h5", "toml", "obj"):
        (tmp_path / f"empty.{name}").write_bytes(b"")
    for name in ("junk.h5", "junk.toml", "junk.obj", "junk.ply"):
        (tmp_path / name).write_bytes(draw.randbytes(300))
    for name in ("folder.h5", "folder.toml"):
        (tmp_path / name).mkdir()
    os.symlink("loop.toml", tmp_path / "loop.toml")
    return tmp_path


def draw_call(draw) -> list:
    verb = draw.choice(list(OPTIONS))
    call = [verb, draw.choice(["", "nope", "Physics"] if verb == "bench" else FILES)]
    if verb in ("run", "labels", "bench"):
        call += ["--out", draw.choice(FOLDERS)]
    for option, values in OPTIONS[verb].items():
        call += [option, draw.choice(values)] if draw.random() < 0.4 else []
    return call + draw.choice([[], [], [], ["--bogus"], ["--part"]])


def outcome_of(call, monkeypatch) -> tuple:
    """Exit code of the command and what it writes to standard error, which is as Python makes it."""
    stream = io.TextIOWrapper(io.BytesIO(), "utf-8", "backslashreplace", write_through=True)
    monkeypatch.setattr(sys, "stderr", stream)
    try:
        code = main(call)
    except SystemExit as end:  # of the parser, which prints the usage first
        code = end.code
    return code, stream.buffer.getvalue().decode()


def test_wrong_calls_are_told_of_in_one_line(folder, monkeypatch):
    draw = random.Random(2)
    for call in [draw_call(draw) for _ in range(NUM_CALLS)]:
        code, told = outcome_of(call, monkeypatch)
        lines = [line for line in told.splitlines() if not line.startswith(("usage:", " "))]
        assert code == 2, call
        assert len(lines) == 1 and lines[0].startswith("echopath"), (call, told)
        assert "Traceback" not in told and "incompatible" not in told and "Unable to cast" not in told, (call, told)
        assert len(lines[0]) > len("echopath: x: must"), (call, told)
    assert sorted(path.name for path in folder.iterdir() if path.is_dir()) == ["folder.h5", "folder.toml"]  # nothing is begun
