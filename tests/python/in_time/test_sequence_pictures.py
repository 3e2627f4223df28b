"""Sequences at a glance, as films, and iterated with progress."""
from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.film import write_film
from echopath.plots import drive, save_png
from echopath.plots.maps import limits_of_level
from echopath.sequence.movers import movers_at, own_speed
from echopath.sequence.pictures import drive_of
from support.frames_in_time import DISTANCE, INTERVAL, SPEED, make_radar, make_scene, make_sequence, signal_of


@pytest.fixture(scope="module")
def stored(tmp_path_factory) -> ep.StoredSequence:
    return make_sequence().save(tmp_path_factory.mktemp("pictures") / "drive.h5", keep="maps")


def shown_in(figure) -> list[np.ndarray]:
    """The maps of a picture, in dBm, and below them what is shown over time."""
    axes = [part.axes for part in figure.subfigs]
    return [ax.get_images()[0].get_array() for ax in axes[0] if ax.get_images()] + [
        ax.collections[0].get_array() for ax in axes[1] if ax.get_xlabel() == "Time in s"]


@pytest.mark.parametrize("num_frames, places", [(4, [0, 1, 2, 3]), (1, [0]), (2, [0, 3])])
def test_a_picture_has_maps_and_range_and_velocity_over_time(stored, num_frames, places):
    made, read = (row.plot(num_frames=num_frames, title="a plate") for row in (make_sequence(), stored))
    *maps, ranges, velocities = shown_in(read)
    for place, shown in zip(places, maps, strict=True):
        assert np.allclose(shown, 10.0 * np.log10(stored[place].power / 1e-3), rtol=0.0, atol=0.1)  # half precision
    rows = np.asarray(ranges).reshape(-1, 4).argmax(axis=0) * make_sequence().radar.waveform.range_resolution
    assert np.allclose(rows, DISTANCE + SPEED * stored.times, atol=0.45)  # a cell and the coupling to velocity
    axis = stored[0].velocity
    assert np.allclose(axis[np.asarray(velocities).reshape(-1, 4).argmax(axis=0)], SPEED, atol=axis[1] - axis[0])
    assert all(np.allclose(one, other, rtol=0.0, atol=0.1) for one, other in zip(shown_in(made), shown_in(read), strict=True))
    assert [ax.get_title() for ax in read.subfigs[0].axes][:len(places)] == [f"{stored.times[place]:.3f} s" for place in places]


def test_a_frame_of_a_small_file_is_drawn_as_the_whole_frame_is(stored, tmp_path):
    made, read = make_sequence()[1].plot(), stored[1].plot()
    for of_axes in (lambda ax: ax.get_images()[0].get_array(), lambda ax: ax.get_images()[0].get_clim(),
                    lambda ax: [*ax.get_xlim(), *ax.get_ylim()], lambda ax: ax.collections[0].get_offsets()):
        np.testing.assert_allclose(of_axes(read), of_axes(made), rtol=0.0, atol=1e-3)
    assert read.get_title() == made.get_title() == "Everything that the radar receives, with its noise"
    assert read.get_xlim()[0] < DISTANCE < read.get_xlim()[1] and read.get_ylim()[0] < SPEED < read.get_ylim()[1]
    without_map = make_sequence(frames=1).save(tmp_path / "labels", keep="labels")[0]
    with pytest.raises(ValueError, match="^frame: must be one with a map to draw, as files of keep='maps' and 'all' have, got"):
        without_map.plot()


def test_what_moves_is_not_the_main_lobe_of_what_stands(tmp_path):
    """The lobe of Hann's window reaches two cells of 1.2 m/s: in it the corner that stands is the stronger one."""
    scene, aside = ep.Scene(), np.array([np.cos(0.3), np.sin(0.3), 0.0])
    scene.add(ep.actors.trihedral(0.3), name="standing", material="metal", position=(4.0, 0.0, 0.0))
    scene.add(ep.actors.trihedral(0.1), name="moving", material="metal", position=DISTANCE * aside, yaw=0.3,
              motion=ep.LinearMotion(-SPEED * aside))
    made = ep.Sequence(scene, make_radar(), frames=2, interval=INTERVAL, num_rays=500, guard=False, window=("hann", "hann"))
    for row in (made, made.save(tmp_path / "corners", keep="maps")):
        figure = row.plot(num_frames=2)
        assert figure.subfigs[1].axes[0].get_title() == "strongest of what moves"
        ranges = np.asarray(shown_in(figure)[2]).reshape(-1, 2).argmax(axis=0) * made.radar.waveform.range_resolution
        assert np.allclose(ranges, DISTANCE - SPEED * made.times, atol=0.45)  # a cell and the coupling to velocity


def corner_at(scene: ep.Scene, name: str, x: float, y: float, speed: float = 0.0) -> None:
    scene.add(ep.actors.trihedral(0.2), name=name, material="metal", position=(x, y, 0.0), yaw=np.arctan2(y, x),
              motion=ep.LinearMotion((speed, 0.0, 0.0)) if speed else None)


def test_what_moves_before_a_radar_that_drives_is_what_moves_in_the_world(tmp_path):
    """What stands has a velocity to it, and what drives as fast as it does has none."""
    scene, drives = ep.Scene(), 12.0
    corner_at(scene, "standing", 6.0, 2.0)
    corner_at(scene, "as fast", 9.0, 0.0, drives)
    corner_at(scene, "oncoming", 15.0, -1.5, 6.0 - drives)
    made = ep.Sequence(scene, make_radar(speed=drives), frames=2, interval=INTERVAL, num_rays=2000, guard=False)
    for row in (made, made.save(tmp_path / "drive", keep="maps")):
        figure = row.plot(num_frames=2)
        ranges, velocities = figure.subfigs[1].axes[:2]
        assert ranges.get_title() == "strongest of what moves in the world"
        assert velocities.get_title() == "strongest of all ranges; dashed: what stands straight ahead"
        (ahead,) = (patch for patch in velocities.patches if hasattr(patch, "get_data"))
        assert np.allclose(ahead.get_data().values, -drives)
        shown = np.asarray(shown_in(figure)[2]).reshape(-1, 2)
        vmin = figure.subfigs[0].axes[0].get_images()[0].get_clim()[0]
        axis = np.arange(len(shown)) * made.radar.waveform.range_resolution
        for place, time in enumerate(made.times):
            signal = axis[shown[:, place] > vmin + 15.0]
            far = np.hypot(15.0 - 18.0 * time, 1.5)
            assert np.all(np.minimum(np.abs(signal - 9.0), np.abs(signal - far)) < 1.2)  # main lobe: 2 cells
            assert np.abs(signal - 9.0).min() < 0.6 and np.abs(signal - far).min() < 0.6


def test_what_stands_straight_ahead_is_told_of_no_time_without_frames():
    """The dashed line ends and begins with the columns below it."""
    scene = ep.Scene()
    corner_at(scene, "standing", 6.0, 2.0)
    made = ep.Sequence(scene, make_radar(speed=12.0), times=[0.0, 0.1, 0.2, 0.5, 0.6], num_rays=500, guard=False)
    for row in (made, made[::-1]):
        velocities = row.plot(num_frames=2).subfigs[1].axes[1]
        (ahead,) = (patch for patch in velocities.patches if hasattr(patch, "get_data"))
        line = ahead.get_data()
        np.testing.assert_allclose(line.values, [-12.0, -12.0, -12.0, np.nan, -12.0, -12.0])
        np.testing.assert_allclose(line.edges, [-0.05, 0.05, 0.15, 0.25, 0.45, 0.55, 0.65])
        np.testing.assert_allclose(velocities.get_xlim(), (-0.05, 0.65))


@pytest.mark.parametrize("yaw", [np.pi, 0.5 * np.pi, 2.0])
def test_straight_ahead_is_where_the_antennas_look_whichever_way_the_radar_drives(yaw):
    """A corner stands before them: to a radar that looks back it goes away as fast as that drives, to one aside not at all."""
    scene, drives = ep.Scene(), 3.0
    scene.add(ep.actors.trihedral(0.2), name="standing", material="metal", yaw=yaw,
              position=(6.0 * np.cos(yaw), 6.0 * np.sin(yaw), 0.0))
    radar = make_radar(yaw=yaw, motion=ep.LinearMotion((drives, 0.0, 0.0)))
    drive_by = drive_of(ep.Sequence(scene, radar, frames=1, interval=INTERVAL, num_rays=500, guard=False))
    strongest = drive_by.velocity[drive_by.level[0].max(axis=1).argmax()]
    (seen,) = -drive_by.driving.own_speed
    assert seen == pytest.approx(-drives * np.cos(yaw), abs=1e-6)
    assert strongest == pytest.approx(seen, abs=np.ptp(drive_by.velocity[:2]))


def test_a_large_wall_that_comes_nearer_is_as_near_as_its_middle():
    """40 m x 40 m, 5 m away: at its middle it comes as fast as it goes, at its corners by the cosine of their angle."""
    scene = ep.Scene()
    scene.add(ep.Mesh([[5, -20, -20], [5, 20, -20], [5, 20, 20], [5, -20, 20]], [[0, 1, 2], [0, 2, 3]]), name="wall",
              material="metal", motion=ep.LinearMotion((-1.0, 0.0, 0.0)))
    corner = np.sqrt(5.0 ** 2 + 2 * 20.0 ** 2)
    assert movers_at(scene, make_radar(), 0.0)[0] == pytest.approx([5.0, corner, -1.0, -5.0 / corner], rel=1e-3)


def test_movers_are_what_moves_in_the_world_but_the_car_of_the_radar():
    scene, radar = ep.Scene(), make_radar(speed=12.0, position=(0.0, 0.0, 0.6))
    scene.add(ep.actors.box((4.0, 1.8, 1.5)), name="own", material="metal", position=(-1.9, 0.0, 0.0),
              motion=ep.LinearMotion((12.0, 0.0, 0.0)))
    scene.add(ep.actors.plate(0.5, 0.5), name="waits", material="metal", position=(9.0, 2.0, 0.0),
              motion=ep.KeyframeMotion(times=[0.0, 1.0, 2.0], translations=[(0, 0, 0), (0, 0, 0), (0, 0, 0)]))
    scene.add(ep.actors.plate(0.5, 0.5), name="stands", material="metal", position=(9.0, 0.0, 0.0))
    assert movers_at(scene, radar, 1.0).shape == (0, 4) and own_speed(radar, 1.0) == pytest.approx(12.0)
    corner_at(scene, "oncoming", 36.0, 0.0, -12.0)
    (near, far, slow, fast), = movers_at(scene, radar, 1.0)
    assert 11.5 < near <= far < 12.5 and slow == pytest.approx(-24.0, abs=0.1) and fast == pytest.approx(-24.0, abs=0.1)


@pytest.mark.parametrize("distance", [0.2, 0.45, 0.7])
def test_a_hand_close_before_the_radar_is_a_mover(distance):
    for yaw, sign in ((0.0, 1.0), (np.pi, -1.0)):
        scene, place = ep.Scene(), (7.0, 0.0, 0.0)
        scene.add(ep.actors.sphere(0.04), name="hand", material="skin", position=(7.0 + sign * distance, 0.0, 0.0),
                  motion=ep.LinearMotion((sign * 0.5, 0.0, 0.0)))
        (near, far, slowest, fastest), = movers_at(scene, make_radar(position=place, yaw=yaw), 0.0)
        assert near == pytest.approx(distance - 0.04, abs=0.01) and far == pytest.approx(distance + 0.04, abs=0.01)
        assert 0.45 < slowest <= fastest == pytest.approx(0.5, abs=0.01)
        assert len(movers_at(scene, make_radar(position=place, yaw=np.pi - yaw), 0.0)) == (distance > 0.6)


def test_leakage_sets_no_scale_of_frames_in_time(tmp_path):
    receiver = ep.Receiver(leakage_db=[[0.0]], leakage_delay=0.3e-9)  # 110 dB above the plate
    clean, leaking = (ep.Sequence(make_scene(), make_radar(**some), frames=2, interval=INTERVAL, num_rays=500, guard=False)
                      for some in ({}, {"receiver": receiver}))
    wanted = drive._limits(drive_of(clean))
    for row in (leaking, leaking.save(tmp_path / "leaking", keep="maps")):
        assert drive._limits(drive_of(row)) == wanted
        assert row.plot(num_frames=1).subfigs[0].axes[0].get_images()[0].get_clim() == wanted


@pytest.mark.parametrize("interval, num_frames", [(0.002, 2), (0.1, 2), (0.1, 7), (1000.0, 2)])
def test_numbers_of_the_time_axes_stand_apart(interval, num_frames, tmp_path):
    times = np.arange(num_frames) * interval
    figure = drive.plot_drive(drive.Drive(times, np.zeros((num_frames, 8, 9), np.float16), np.arange(8.0), np.arange(9.0)))
    save_png(figure, tmp_path / "overview.png")  # which makes the numbers larger than a window does
    for axes in figure.subfigs[1].axes:
        if axes.get_xlabel() == "Time in s":
            left, right = axes.get_xlim()
            boxes = [tick.label1.get_window_extent() for tick in axes.xaxis.get_major_ticks() if left <= tick.get_loc() <= right]
            assert len(boxes) >= 3
            assert not any(one.overlaps(other) for one, other in zip(boxes, boxes[1:]))


def test_a_film_has_a_picture_of_each_frame_in_real_time(stored, tmp_path):
    image = pytest.importorskip("PIL.Image")
    told = []
    stored.film(tmp_path / "drive.gif", progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told == [("frames", 0.25), ("frames", 0.5), ("frames", 0.75), ("frames", 1.0)]
    with image.open(tmp_path / "drive.gif") as film:
        assert film.n_frames == 4 and film.info["duration"] == round(1e3 * INTERVAL)
        pictures = [np.asarray(film.convert("L"), float) for place in range(4) if film.seek(place) is None]
    assert all(np.abs(one - other).max() > 50.0 for one, other in zip(pictures, pictures[1:]))
    stored[1::-1].film(tmp_path / "back.gif", frames_per_second=5)
    with image.open(tmp_path / "back.gif") as film:
        assert film.info["duration"] == 200


@pytest.mark.parametrize("frames_per_second", [1.0 / 0.066, 30.0, 60.0])
def test_a_film_takes_its_time_though_gif_counts_hundredths_of_a_second(frames_per_second, tmp_path):
    image, count = pytest.importorskip("PIL.Image"), 30
    write_film(tmp_path / "film.gif", (np.full((4, 6, 3), 8 * place, np.uint8) for place in range(count)), frames_per_second)
    with image.open(tmp_path / "film.gif") as film:
        shown = [film.info["duration"] for place in range(film.n_frames) if film.seek(place) is None]
    assert len(shown) == count and np.ptp(shown) <= 10
    assert abs(1e-3 * sum(shown) - count / frames_per_second) <= 0.005


def test_pictures_of_many_frames_hold_two_bytes_a_cell_and_one_frame():
    """Levels of noise, whose median and peak over all frames are those of all cells at once."""
    random, shape = np.random.default_rng(3), (80, 128, 256)
    levels = random.normal(-90.0, 8.0, shape).astype(np.float16)
    cells = levels.size
    axes = (np.linspace(-5.0, 5.0, shape[1]), np.linspace(0.0, 50.0, shape[2]))

    class Frames:
        radar = make_radar()

        def _maps(self):
            maps = ((0.1 * place, level.astype(np.float32), *axes) for place, level in enumerate(levels))
            return len(levels), maps, {"window": "hann", "zero_pad": 1}

    tracemalloc.start()
    try:
        made = drive_of(Frames())
        limits = drive._limits(made)
        columns = drive._columns(made, limits[0])
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert (made.level == levels).all() and made.level.dtype == np.float16
    assert limits == limits_of_level(levels.astype(np.float32))
    assert (columns[1].level == levels.max(axis=2)).all()
    assert peak < 3.0 * cells  # bytes; a frame in double precision has .1 of a byte


def test_frames_come_with_progress_and_with_the_same_bits():
    told = []
    frames = [signal_of(frame) for frame in make_sequence(frames=2).frames(progress=lambda *words: told.append(words))]
    assert told == [("frames", 0.5), ("frames", 1.0)] and frames == [signal_of(frame) for frame in make_sequence(frames=2)]


def test_what_cannot_be_drawn_is_told_by_its_argument(stored, tmp_path):
    with pytest.raises(ValueError, match="^path: must end in .gif or .mp4"):
        stored.film(tmp_path / "drive.avi")
    with pytest.raises(ValueError, match="^frames_per_second: must be"):
        stored.film(tmp_path / "drive.gif", frames_per_second=0)
    with pytest.raises(ValueError, match="^num_frames: must be"):
        stored.plot(num_frames=0)
    with pytest.raises(TypeError, match="^vmin: must be"):
        stored.plot(vmin="low")
    with pytest.raises(ValueError, match="^frames: must be one at least"):
        make_sequence()[:0].plot()
    labels = make_sequence(frames=1).save(tmp_path / "labels", keep="labels")
    with pytest.raises(ValueError, match="labels: must keep maps to be drawn"):
        labels.plot()
    assert not (tmp_path / "drive.gif").exists()
