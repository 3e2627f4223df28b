"""Frames in time on the command line: lines, resumption, Ctrl-C, the keys of a scene file."""
from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import echopath as ep
from echopath.cli import main, run_sequence
from echopath.sequence.pictures import drive_of
from support.background import heed_ctrl_c
from support.files.scene_text import ANTENNAS, WAVEFORM

WAIT = 60.0  # s, for a process on a busy machine
SCENE = """
title = "a plate"
guard = false
""" + WAVEFORM + ANTENNAS + """\
[[objects]]
name = "plate"
actor = "plate"
parameters = {width = 1.0, height = 1.0}
material = "metal"
position = [5.0, 0.0, 0.0]
speed = 2.0
[trace]
num_rays = 500
"""
IN_TIME = '[sequence]\nframes = 2\ninterval = 0.1\nkeep = "maps"\n'


@pytest.fixture
def scene_path(tmp_path) -> Path:
    path = tmp_path / "plate.toml"
    path.write_text(SCENE)
    return path


def run(scene: Path, out: Path, *options) -> int:
    return main(["run", str(scene), "--out", str(out), *map(str, options)])


@pytest.mark.usefixtures("blank_pictures")
def test_a_run_tells_of_each_frame_and_goes_on(scene_path, tmp_path, capsys):
    out = tmp_path / "out"
    assert run(scene_path, out, "--frames", 2, "--interval", 0.1) == 0
    first = capsys.readouterr().out.splitlines()
    assert run(scene_path, out, "--frames", 4, "--interval", 0.1) == 0
    lines = [re.sub(r"\d+\.\d s", "# s", line) for line in capsys.readouterr().out.splitlines()]
    assert first[1].startswith("frame 1 of 2 at 0 s: ") and first[1].endswith(" left")
    assert lines[1] == "frame 1 of 4 at 0 s: is there" and lines[2] == "frame 2 of 4 at # s: is there"
    assert lines[4] == "frame 4 of 4 at # s: # s"
    assert lines[5].startswith("wrote StoredSequence(") and "4 done" in lines[5]
    assert lines[6:8] == [f"wrote {out / name}" for name in ("overview.png", "film.gif")]
    assert "resolved to 0.3 dB" in lines[8] and "in 2 frames that were made" in lines[8]
    scene_file = ep.load_scene(scene_path)
    alone = ep.simulate(scene_file.scene, scene_file.radar, trace=scene_file.trace.replace(start_time=3 * 0.1), guard=False)
    assert (ep.load_sequence(out)[3].noisy_cube == alone.noisy_cube).all()


@pytest.mark.usefixtures("blank_pictures")
def test_a_run_ends_with_what_its_rays_do_not_resolve_in_some_frame(scene_path, tmp_path, capsys):
    """The last lines, of the frames that were made; those that were there are not asked."""
    plate = 'actor = "plate"\nparameters = {width = 1.0, height = 1.0}\nmaterial = "metal"'
    scene_path.write_text(SCENE.replace(plate, 'actor = "pedestrian"'))
    out, options = tmp_path / "out", ("--frames", 2, "--interval", 0.1, "--rays", 200)
    assert run(scene_path, out, *options) == 0
    told = capsys.readouterr().out
    assert "\nNOT resolved to 0.3 dB (95 % interval) in 2 frames that were made\n" in told
    frames = [ep.load_sequence(out)[place] for place in range(2)]
    missing = [{one.title for one in frame.unresolved} for frame in frames]
    for title in missing[0] | missing[1]:
        assert f"  {title} " in told and f" {sum(title in some for some in missing)} of 2, at worst " in told
    assert run(scene_path, out, *options) == 0
    assert "resolved to" not in capsys.readouterr().out


@pytest.mark.usefixtures("plain_pictures")
def test_frames_are_read_once_for_their_pictures_whose_failure_is_a_warning(scene_path, tmp_path, capsys, monkeypatch):
    def full(*given, **more):
        raise MemoryError

    asked, out = [], tmp_path / "out"
    monkeypatch.setattr(run_sequence, "drive_of", lambda stored: asked.append(stored) or drive_of(stored))
    assert run(scene_path, out, "--frames", 2, "--interval", 0.1, "--keep", "maps") == 0
    assert len(asked) == 1 and (out / "overview.png").exists() and (out / "film.gif").exists()
    (out / "film.gif").unlink()
    monkeypatch.setattr(run_sequence, "write_film_of", full)
    capsys.readouterr()
    assert run(scene_path, out, "--frames", 2, "--interval", 0.1, "--keep", "maps") == 0
    told = capsys.readouterr()
    assert told.err == "warning: the frames are written, but not all of their pictures: MemoryError\n"
    assert told.out.splitlines()[-1] == f"wrote {out / 'overview.png'}"
    assert ep.load_sequence(out).is_done.all()


@pytest.mark.usefixtures("blank_pictures")
def test_a_scene_file_may_ask_for_frames_in_time(scene_path, tmp_path, capsys):
    scene_path.write_text(SCENE + IN_TIME)
    table = ep.load_scene(scene_path).sequence
    assert (table.frames, table.interval, table.keep) == (2, 0.1, "maps")
    assert run(scene_path, tmp_path / "a") == 0
    assert run(scene_path, tmp_path / "b", "--frames", 3, "--keep", "labels") == 0
    a, b = ep.load_sequence(tmp_path / "a"), ep.load_sequence(tmp_path / "b")
    assert (len(a), a.keep, len(b), b.keep) == (2, "maps", 3, "labels")
    assert b[0].labels["parts"].objects[0].status == "seen"  # asked for by what is kept


FAULTS = {"sequence.frames: must be at least 1, got 0": "[sequence]\nframes = 0\ninterval = 0.1\n",
          "sequence.interval: must be greater than 0, got 0": "[sequence]\nframes = 2\ninterval = 0.0\n",
          "sequence.interval: is missing": "[sequence]\nframes = 2\n",
          "sequence.keep: must be": "[sequence]\nframes = 2\ninterval = 0.1\nkeep = \"some\"\n",
          "sequence.frame: unknown key": "[sequence]\nframe = 2\ninterval = 0.1\n"}


@pytest.mark.parametrize("told, table", FAULTS.items())
def test_faults_of_the_table_are_told_by_their_place(scene_path, told, table):
    scene_path.write_text(SCENE + table)
    with pytest.raises(ValueError, match=re.escape(told)):
        ep.load_scene(scene_path)


@pytest.mark.parametrize("options, told", [(("--interval", 0.1), "--interval: belongs to frames in time"),
                                           (("--keep", "maps"), "--keep: belongs to frames in time"),
                                           (("--frames", 2), "--interval: must be given"),
                                           (("--frames", 2, "--interval", 1e-6), "--interval: must be at least")])
def test_wrong_options_are_named(scene_path, tmp_path, capsys, options, told):
    assert run(scene_path, tmp_path / "out", *options) == 2
    assert capsys.readouterr().err.startswith(f"echopath: {told}")


@pytest.mark.usefixtures("blank_pictures")
def test_another_scene_is_refused_by_the_folder(scene_path, tmp_path, capsys):
    out = tmp_path / ("out" * 20)  # longer than messages repeat it
    assert run(scene_path, out, "--frames", 1, "--interval", 0.1) == 0
    scene_path.write_text(SCENE.replace("speed = 2.0", "speed = 3.0"))
    assert run(scene_path, out, "--frames", 1, "--interval", 0.1) == 2
    assert capsys.readouterr().err.startswith("echopath: --out: must be new, or of this sequence (scene/motions/0")


def test_ctrl_c_leaves_a_folder_that_goes_on(scene_path, tmp_path):
    out = tmp_path / "out"
    command = [sys.executable, "-m", "echopath", "run", scene_path, "--out", out, "--interval", "0.1", "--frames"]
    process = subprocess.Popen([*command, "2000"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               preexec_fn=heed_ctrl_c)
    told = [process.stdout.readline() for _ in range(3)]
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=WAIT)[1]
    assert process.returncode == 130 and f"the same command goes on in {out}" in said
    assert "no file was left half written" in said and "Traceback" not in said
    assert not list(out.glob(".*")) and told[1].startswith("frame 1 of 2000 at 0 s: ")
    assert ep.load_sequence(out)[1].cube is not None


@pytest.mark.parametrize("says_where", [subprocess.PIPE, subprocess.STDOUT])
def test_a_run_whose_lines_nobody_reads_any_more_says_that_it_is_not_done(scene_path, tmp_path, says_where):
    """As behind `| head -3`: other programs end by SIGPIPE there, which shells report as 141."""
    out = tmp_path / "out"
    command = [sys.executable, "-m", "echopath", "run", scene_path, "--out", out, "--interval", "0.1", "--frames", "2000"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=says_where, text=True)
    told = [process.stdout.readline() for _ in range(3)]
    process.stdout.close()
    said = process.stderr.read() if process.stderr else ""
    assert process.wait(timeout=WAIT) == 141 and told[1].startswith("frame 1 of 2000 at 0 s: ")
    assert not said or said == f"echopath: stopped, as nobody reads its output any more; the same command goes on in {out}\n"
    assert 2 <= ep.load_sequence(out).is_done.sum() < 2000


def test_ctrl_c_while_a_line_is_printed_says_so_too(scene_path, tmp_path, monkeypatch, capsys):
    def print_until_stopped(text, **keywords):
        print(text, **keywords)
        if text.startswith("frame 1 of 3"):
            raise KeyboardInterrupt

    monkeypatch.setattr("echopath.cli.resumable.print", print_until_stopped, raising=False)
    assert run(scene_path, tmp_path / "out", "--frames", 3, "--interval", 0.1) == 130
    assert f"the same command goes on in {tmp_path / 'out'}" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "out").glob("frame*")] == ["frame_0000.h5"]


def test_the_viewer_takes_a_folder_or_several_files(monkeypatch):
    opened = []
    monkeypatch.setattr("echopath.view", lambda *what, **keywords: opened.append(what))
    for given, viewed in (([], ()), (["out"], ("out",)), (["a.h5", "b.h5"], (["a.h5", "b.h5"],))):
        assert main(["view", *given]) == 0 and opened.pop() == viewed


@pytest.mark.usefixtures("blank_pictures")
def test_info_tells_of_a_folder_and_small_files_say_what_they_lack(scene_path, tmp_path, capsys):
    out = tmp_path / "out"
    run(scene_path, out, "--frames", 3, "--interval", 0.1, "--keep", "maps")
    (out / "frame_0002.h5").unlink()
    for what in (out, out / "sequence.h5"):
        capsys.readouterr()
        assert main(["info", str(what)]) == 0
        told = " ".join(capsys.readouterr().out.split())
        assert "frames 3, 2 done" in told and "starts 0 to 0.2 s, every 0.1 s" in told and "kept maps" in told
    small = out / "frame_0001.h5"
    assert main(["info", str(small)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert f"{small} maps and labels of a frame, without its paths start 0.1 s" in told and "with their powers" in told
    assert "dBm at 5." in told and "no objects" not in told
    for command in (["view", str(small)], ["labels", str(small), "--out", str(tmp_path / "labels")]):
        assert main(command) == 2
        assert "frame_0001.h5: holds no paths, only maps or labels of a frame" in capsys.readouterr().err
    assert main(["labels", str(out), "--out", str(tmp_path / "labels")]) == 2
    assert f"{out}: a folder, where a frame file (.h5) is asked for" in capsys.readouterr().err


@pytest.mark.parametrize("vehicles, shows_parts", [(1, True), (7, False)])
def test_info_names_objects_or_their_parts_and_tells_which_move(tmp_path, capsys, vehicles, shows_parts):
    cars = "".join(f"[[objects]]\nname = \"car_{k}\"\nactor = \"car\"\nposition = [{8.0 * (k + 1)}, 4.0, 0.0]\n"
                   for k in range(vehicles))
    (tmp_path / "street.toml").write_text(SCENE.replace("[trace]", cars + "[trace]"))
    assert main(["info", str(tmp_path / "street.toml")]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["plate", "2", "triangles,", "metal,", "moving"] in lines
    of_cars = [line for line in lines if line and line[0].startswith("car_0")]
    assert of_cars and "moving" not in sum(of_cars, [])
    assert all(("/" in line[0]) == shows_parts for line in of_cars)


@pytest.mark.usefixtures("blank_pictures")
def test_one_file_of_all_frames_is_written_goes_on_and_is_told_of(scene_path, tmp_path, capsys):
    out = tmp_path / "drive.h5"
    for frames in (1, 2):
        assert run(scene_path, out, "--frames", frames, "--interval", 0.1, "--keep", "maps", "--truth") == 0
    assert out.is_file() and (tmp_path / "drive_truth.csv").read_text().count("\n") == 3
    capsys.readouterr()
    assert main(["info", str(out)]) == 0
    assert "frames 2, 2 done" in " ".join(capsys.readouterr().out.split())
    assert main(["info", str(out / "frames" / "000001")]) == 0
    assert "000001 maps and labels of a frame" in " ".join(capsys.readouterr().out.split())


def test_a_shard_of_the_frames_says_which_it_made(scene_path, tmp_path, capsys):
    out = tmp_path / "out"
    assert run(scene_path, out, "--frames", 4, "--interval", 0.1, "--shard", "2/2") == 0
    told = capsys.readouterr().out.splitlines()
    assert [line[:12] for line in told if line.startswith("frame")] == ["frame 2 of 4", "frame 4 of 4"]
    assert "2 done" in told[-2] and "in 2 frames that were made" in told[-1]


@pytest.mark.parametrize("shard", ["0/2", "3/2", "1", "a/b", "1/2/3", "-1/2", ""])
def test_wrong_shards_are_refused_on_the_command_line(scene_path, tmp_path, capsys, shard):
    with pytest.raises(SystemExit):
        run(scene_path, tmp_path / "out", "--frames", 4, "--interval", 0.1, f"--shard={shard}")
    assert "must be K/N, the K-th of N shards, K from 1 to N" in capsys.readouterr().err


def test_a_shard_belongs_to_frames_in_time(scene_path, tmp_path, capsys):
    assert run(scene_path, tmp_path / "out", "--shard", "1/2") == 2
    assert "--shard: belongs to frames in time, give --frames too, got 1/2" in capsys.readouterr().err


@pytest.mark.usefixtures("blank_pictures")
def test_warnings_are_lines_that_name_the_frame(scene_path, tmp_path, capsys):
    """A plate that goes beyond the last range: after 100 s it is heard no longer."""
    assert run(scene_path, tmp_path / "out", "--frames", 2, "--interval", 100) == 0
    told = capsys.readouterr().err
    assert re.fullmatch(r"warning: first in frame 2: no signal of [0-9,]+ paths: they lie beyond the last range .*\n", told)
