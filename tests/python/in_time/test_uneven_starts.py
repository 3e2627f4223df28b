"""Frames in time that begin when a recording's did: places, bits, files, and pictures."""
import re

import numpy as np
import pytest

import echopath as ep
from echopath.cli import main
from support.files.scene_text import ANTENNAS, WAVEFORM
from support.frames_in_time import DISTANCE, SETTINGS, SPEED, make_radar, make_scene, make_sequence, signal_of

TIMES = (0.3, 0.41, 0.45, 0.9)  # s
RANGE_TOLERANCE = 0.008         # m: as of even frames


def make_uneven(times=TIMES, **keywords) -> ep.Sequence:
    return ep.Sequence(make_scene(), make_radar(), times=times, **SETTINGS | keywords)


@pytest.fixture(scope="module")
def in_order() -> list[bytes]:
    return [signal_of(frame) for frame in make_uneven()]


def test_frames_start_when_they_were_told_to(in_order):
    sequence = make_uneven()
    assert sequence.times.tolist() == list(TIMES) and len(sequence) == 4 and sequence.interval is None
    assert repr(sequence) == "Sequence(4 frames from 0.3 to 0.9 s, 0.04 to 0.45 s apart)"
    for time, frame in zip(TIMES, sequence):
        assert frame.start_time == time
        middle = time + 0.5 * frame.radar.frame_duration
        assert frame.detections.range[0] == pytest.approx(DISTANCE + SPEED * middle, abs=RANGE_TOLERANCE)


def test_frames_alone_in_reverse_and_of_slices_have_the_bits_of_those_in_order(in_order):
    sequence = make_uneven()
    assert [signal_of(frame) for frame in sequence[::-1]] == in_order[::-1]
    assert signal_of(sequence[1:][::2][1]) == in_order[3] and sequence[::-2].times.tolist() == [0.9, 0.41]


def test_even_times_have_the_bits_of_an_interval():
    """The object that fills the sky in frame 0 and all random numbers are those of the first start."""
    even = make_sequence(frames=2, start_time=0.2)
    assert [signal_of(frame) for frame in make_uneven(even.times)] == [signal_of(frame) for frame in even]


@pytest.mark.parametrize("name", ["drive", "drive.h5"])
def test_saved_frames_go_on_with_further_times_and_with_no_others(in_order, tmp_path, name):
    path = tmp_path / name
    make_uneven(TIMES[:2]).save(path)
    stored = make_uneven().save(path)
    assert stored.times.tolist() == list(TIMES) and stored.interval is None and stored.is_done.all()
    assert stored.settings["times"] == list(TIMES) and stored.settings["interval"] is None
    assert [signal_of(frame) for frame in stored] == in_order
    assert stored[::-1].times.tolist() == list(TIMES[::-1])
    assert stored.to_xarray().time.values.tolist() == list(TIMES)
    with pytest.raises(ValueError, match=r"^path: .*times is \[0.3, 0.41, .* there and \[0.3, 0.42, "):
        make_uneven((0.3, 0.42, 0.5, 0.9)).save(path)
    with pytest.raises(ValueError, match="^path: .*(interval|frames|times) is"):
        make_sequence(frames=4, start_time=0.3).save(path)


def test_a_slice_is_saved_with_its_own_times(tmp_path):
    stored = make_uneven()[::-2].save(tmp_path / "back")
    assert stored.times.tolist() == [0.9, 0.41] and [frame.start_time for frame in stored] == [0.9, 0.41]


def test_a_hundred_thousand_times_are_kept(tmp_path):
    """More than an attribute of HDF5 holds."""
    times = np.cumsum(np.linspace(0.01, 0.02, 100_000))
    sequence = make_uneven(times)
    next(iter(sequence.save_frames(tmp_path / "long.h5", keep="labels")))
    assert np.array_equal(ep.load_sequence(tmp_path / "long.h5").times, times)


def test_maps_over_time_follow_the_clock():
    frames = list(make_uneven((0.0, 0.05, 0.2, 0.25, 0.5, 0.55, 0.8), truth=True))
    over_time = ep.range_time(frames)
    peaks = over_time.range[over_time.power.argmax(axis=1)]
    assert np.abs(peaks - (DISTANCE + SPEED * over_time.times)).max() < 0.31  # m, of cells of 0.3 m


@pytest.mark.parametrize("step", [1, -1])
def test_pictures_leave_gaps_between_uneven_frames_blank_in_either_order(step):
    figure = make_uneven((0.0, 0.05, 0.08, 0.4, 0.45))[::step].plot()
    mesh = next(axes for axes in figure.subfigs[1].axes if axes.get_xlabel() == "Time in s").collections[0]
    across, level = mesh.get_coordinates()[0, :, 0], np.ma.filled(mesh.get_array().astype(float), np.nan)
    for time in (0.0, 0.05, 0.08, 0.2, 0.3, 0.4, 0.45):
        column = np.flatnonzero((across[:-1] <= time) & (time < across[1:]))
        assert len(column) == 1 and np.isnan(level[:, column]).all() == (time in (0.2, 0.3))


def test_films_of_uneven_frames_are_as_fast_as_their_median(tmp_path):
    from PIL import Image

    make_uneven((0.0, 0.1, 0.3, 0.4)).film(tmp_path / "drive.gif")
    with Image.open(tmp_path / "drive.gif") as film:
        assert film.info["duration"] == 100  # ms


@pytest.mark.parametrize("keywords, error, told", [
    ({}, TypeError, "^frames: must be how many there are, with `interval`, or None with `times`, got None"),
    ({"frames": 2}, TypeError, "^interval: must be in s .*or None with `times`, got None"),
    ({"interval": 0.1}, TypeError, "^frames: "),
    ({"times": TIMES, "frames": 4}, ValueError, "^frames: must be None with `times`, .*got 4"),
    ({"times": TIMES, "interval": 0.1}, ValueError, "^interval: must be None with `times`, .*got 0.1"),
    ({"times": TIMES, "start_time": 0.3}, ValueError, "^start_time: must be 0.0 with `times`, .*got 0.3"),
    ({"times": []}, ValueError, "^times: "), ({"times": [0.0, np.nan]}, ValueError, "^times: "),
    ({"times": [[0.0, 1.0]]}, ValueError, "^times: "), ({"times": ["soon"]}, TypeError, "^times: "),
    ({"times": [0.0, 0.3, 0.2]}, ValueError,
     r"^times: must be at least 0\.0015563 s apart.* got times\[1\] = 0\.3 s and times\[2\] = 0\.2 s"),
    ({"times": [0.0, 0.001, 0.2]}, ValueError,
     r"^times: must be at least 0\.0015563 s apart, .*got times\[0\] = 0 s and times\[1\] = 0\.001 s"),
])
def test_wrong_starts_are_refused_by_name(keywords, error, told):
    with pytest.raises(error, match=told):
        ep.Sequence(make_scene(), make_radar(), **keywords)


def test_times_beyond_the_motions_are_refused_before_the_work():
    scene = ep.Scene()
    motion = ep.KeyframeMotion([0.0, 1.0], [[0, 0, 0], [1, 0, 0]])
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(5.0, 0.0, 0.0), motion=motion)
    with pytest.raises(ValueError, match="^times: must all lie within the motions, got 2 frames: .*node plate"):
        ep.Sequence(scene, make_radar(), times=[0.1, 1.5])


def test_what_comes_and_goes_between_uneven_frames_is_told():
    scene = make_scene()
    scene["plate"].lifetime = (0.5, 0.7)
    with pytest.warns(RuntimeWarning, match="'plate' comes and goes between the starts of frames"):
        ep.Sequence(scene, make_radar(), times=(0.3, 0.45, 0.9))
    assert len(ep.Sequence(scene, make_radar(), times=(0.3, 0.6, 0.9))) == 3


SCENE = WAVEFORM + ANTENNAS + """\
[[objects]]
name = "plate"
actor = "plate"
parameters = {width = 1.0, height = 1.0}
material = "metal"
position = [5.0, 0.0, 0.0]
[trace]
num_rays = 200
[sequence]
keep = "labels"
"""


@pytest.fixture
def scene_path(tmp_path):
    """A scene file of frames that begin at the times of a text file."""
    (tmp_path / "stamps.txt").write_text("# s\n0.0\n\n0.05\n0.2\n")
    path = tmp_path / "plate.toml"
    path.write_text(SCENE + 'times = "stamps.txt"\n')
    return path


def test_scene_files_name_times_or_have_them(scene_path):
    assert ep.load_scene(scene_path).sequence.times == [0.0, 0.05, 0.2]
    scene_path.write_text(SCENE + "times = [0, 0.25]\n")
    assert ep.load_scene(scene_path).sequence.times == [0.0, 0.25]


def test_runs_begin_their_frames_at_the_times_of_the_scene_file(scene_path, tmp_path, capsys):
    assert main(["run", str(scene_path), "--out", str(tmp_path / "some"), "--frames", "2"]) == 0
    assert capsys.readouterr().out.splitlines()[0].endswith(": 2 frames 0.05 s apart")
    assert main(["run", str(scene_path), "--out", str(tmp_path / "some")]) == 0
    assert ep.load_sequence(tmp_path / "some").times.tolist() == [0.0, 0.05, 0.2]
    assert main(["run", str(scene_path), "--out", str(tmp_path / "even"), "--frames", "2", "--interval", "0.1"]) == 0
    assert ep.load_sequence(tmp_path / "even").times.tolist() == [0.0, 0.1]


def test_info_tells_the_times(scene_path, tmp_path, capsys):
    sequence = ep.Sequence(make_scene(), make_radar(), times=[0.0, 0.05, 0.2], num_rays=200, labels=True, guard=False)
    sequence.save(tmp_path / "frames", keep="labels")
    for path in (scene_path, tmp_path / "frames"):
        assert main(["info", str(path)]) == 0
        told = " ".join(capsys.readouterr().out.split())
        assert "0.05 to 0.15 s apart" in told and "0 to 0.2 s" in told


@pytest.mark.parametrize("starts, is_mirror", [("times = [120.0, 120.5]", True), ("frames = 2\ninterval = 0.5", False)])
def test_a_scene_is_looked_at_when_the_first_frame_begins(tmp_path, capsys, starts, is_mirror):
    """A wall, 7.5 m wide for mirrors, which its docstring wants at least 4 sqrt(wavelength distance) wide: 1 m at 20 m, 8.7 m
    at the 1.2 km that it is away when the clock begins."""
    path = tmp_path / "wall.toml"
    path.write_text("mark_mirrors = true\n[radar]\nspeed = 10.0\n" + WAVEFORM + ANTENNAS + """
[[objects]]
name = "wall"
actor = "wall"
parameters = {length = 10.0, height = 6.0}
material = "concrete"
position = [1210.0, 3.0, -3.0]
[sequence]
""" + starts)
    assert ep.load_scene(path).scene["wall"].material.mirror == is_mirror
    assert main(["info", str(path)]) == 0
    place = re.search(r"place +\((\d+)", capsys.readouterr().out)
    assert place[1] == ("1200" if is_mirror else "0")


@pytest.mark.parametrize("lines, told", [
    ("times = [0.0, 0.1]\nframes = 2", "sequence.frames: must not be given with times"),
    ("times = [0.0, 0.1]\ninterval = 0.1", "sequence.interval: must not be given with times"),
    ("interval = 0.1", "sequence.frames: is missing, or times"), ("times = []", "sequence.times: must be a list of numbers in s"),
    ("times = [true]", "sequence.times: must be a list of numbers in s"),
    ('times = "none.txt"', "sequence.times: .*none.txt: cannot be read"),
])
def test_wrong_times_of_scene_files_are_refused_by_name(scene_path, lines, told):
    scene_path.write_text(SCENE + lines + "\n")
    with pytest.raises((ValueError, ep.FileError), match=told):
        ep.load_scene(scene_path)


@pytest.mark.parametrize("text, told", [(b"0.0\nsoon\n", "line 2: must be the start of a frame in s, got 'soon'"),
                                        (b"0.0\nnan\n", "line 2: must be the start"),
                                        (b"# s\n", "must have the start of a frame in s in each line, has none"),
                                        (b"\xff\xfe0", "is not UTF-8 text")])
def test_wrong_files_of_times_are_refused_with_their_line(scene_path, text, told):
    scene_path.with_name("stamps.txt").write_bytes(text)
    with pytest.raises(ep.FileError, match=f"sequence.times: .*stamps.txt[:,] {told}"):
        ep.load_scene(scene_path)


@pytest.mark.parametrize("options, told", [(("--frames", "4"), "--frames: must be at most 3, the times of the scene file, got 4"),
                                           (("--interval", "0.1"), "--frames: must be given with --interval")])
def test_options_that_the_times_do_not_allow_are_refused(scene_path, tmp_path, capsys, options, told):
    assert main(["run", str(scene_path), "--out", str(tmp_path / "out"), *options]) == 2
    assert told in capsys.readouterr().err


PERIOD = 32 * 50e-6  # s, from the first chirp of a frame of `make_radar` to that of one that follows without a gap


@pytest.mark.parametrize("times, span_frames, longest", [
    (TIMES, "auto", "32, the chirps of the longest train, between which are gaps of 0.0384 s and more"),
    ((0.0, PERIOD, 1.0), "auto", "64, the chirps of the longest train, between which are gaps of 0.997 s and more"),
    ((0.0, PERIOD), True, "64, the chirps of the longest train"),
    ((0.0, PERIOD), False, "32, the chirps of the longest train; span_frames=True joins frames without gaps")])
def test_windows_longer_than_all_trains_are_refused_before_a_frame_is_made(times, span_frames, longest, monkeypatch):
    sequence = make_uneven(times)
    window_length = int(longest.split(",")[0]) + 1
    with monkeypatch.context() as patch:
        patch.setattr(ep.Sequence, "_recorded", lambda *_: pytest.fail("makes a frame"))
        with pytest.raises(ValueError, match=f"^window_length: must be at most {longest}, got {window_length}$"):
            ep.spectrogram(sequence, window_length=window_length, span_frames=span_frames)
    with pytest.raises(ValueError, match=f"^window_length: must be at most {longest}, got {window_length}$"):  # frames alone
        ep.spectrogram(list(sequence), window_length=window_length, span_frames=span_frames)
    assert ep.spectrogram(sequence, window_length=window_length - 1, span_frames=span_frames).window_length == window_length - 1
