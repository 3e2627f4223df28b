"""Frames in time as the viewer finds and reads them."""
from __future__ import annotations

import dataclasses
import gc
import shutil
import weakref

import numpy as np
import pytest
import pyvista as pv

import echopath as ep
from echopath_viewer.model import Session, from_paths
from echopath_viewer.model.frames.carried import session_like
from echopath_viewer.model.frames.overview import Glance, glance_at, level_image, track_places, track_values, tracks_of
from echopath_viewer.model.frames.simulated_frames import SimulatedFrames
from echopath_viewer.model.frames.time_line import time_line_of
from echopath_viewer.model.view_state import state_of
from echopath_viewer.scene_builder.track_layer import TrackLayer
from support.frames_in_time import make_radar, make_scene

NUM_FRAMES = 3


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(64, 48))
    yield plotter
    plotter.close()


@pytest.fixture(scope="module")
def maps_of_run(moving_sequence, tmp_path_factory):
    return moving_sequence.save(tmp_path_factory.mktemp("maps"), keep="maps")


@pytest.mark.parametrize("what", [lambda folder: folder, lambda folder: ep.load_sequence(folder),
                                  lambda folder: f"{folder}/frame_*.h5",
                                  lambda folder: sorted(folder.glob("frame_*.h5"), reverse=True)])
def test_folders_patterns_and_lists_are_lines_in_the_order_of_time(stored_run, what):
    line = time_line_of(what(stored_run.path))
    assert [moment.start_time for moment in line.moments] == list(stored_run.times)
    assert [moment.path for moment in line.moments] == stored_run.paths_of_files
    second = line.read(1)
    assert second.paths.frame.start_time == stored_run.times[1] and second.paths.num_paths == stored_run[1].paths.num_paths


def test_frames_of_one_time_go_by_the_numbers_in_their_names(stored_run, tmp_path):
    names = ["seed9.h5", "seed9²3.h5", "seed10.h5"]
    for name in names:
        shutil.copy(stored_run.paths_of_files[0], tmp_path / name)
    assert [moment.name for moment in time_line_of(tmp_path).moments] == names


def test_one_file_is_no_line(stored_run):
    assert time_line_of(stored_run.paths_of_files[0]) is None


def test_one_file_of_all_frames_is_a_line(moving_sequence, stored_run, tmp_path):
    moving_sequence[:2].save(tmp_path / "drive.h5")
    line = time_line_of(tmp_path / "drive.h5")
    assert [moment.name for moment in line.moments] == ["frame 0", "frame 1"] and line.expected == 2
    assert line.read(1).paths.num_paths == stored_run[1].paths.num_paths
    assert glance_at(line.moments[1]).by_range == pytest.approx(glance_at(time_line_of(stored_run.path).moments[1]).by_range)
    session = Session(time_line_of(ep.load_sequence(tmp_path / "drive.h5")).read(0))
    assert session.parts.whole.spectrum.values.tobytes() == stored_run[0].spectrum.values.tobytes()


def test_folders_of_nothing_say_so(tmp_path):
    with pytest.raises(ep.FileError, match="holds neither frames"):
        time_line_of(tmp_path)
    with pytest.raises(ep.FileError, match=r"\*.h5: holds no frame"):
        time_line_of(f"{tmp_path}/*.h5")


def test_frames_appear_when_they_are_written(stored_run, tmp_path):
    for name in ("sequence.h5", "frame_0000.h5"):
        shutil.copy(stored_run.path / name, tmp_path / name)
    line = time_line_of(tmp_path)
    assert (len(line), line.expected, line.refresh()) == (1, NUM_FRAMES, False)
    (tmp_path / "frame_0001.h5").write_bytes(b"")  # of another program: a frame is renamed into its place when it is whole
    shutil.copy(stored_run.paths_of_files[1], tmp_path / "frame_0001.h5")
    assert line.refresh() and [moment.name for moment in line.moments] == ["frame 0", "frame 1"]


def test_a_glance_has_the_power_of_the_map(stored_run):
    line = time_line_of(stored_run.path)
    glance = glance_at(line.moments[1])
    power = np.abs(stored_run[1].spectrum.values) ** 2
    assert glance.by_velocity == pytest.approx(power.mean(axis=(0, 1)).sum(axis=1), rel=1e-5, abs=0)
    assert glance.by_range == pytest.approx(power.mean(axis=(0, 1)).sum(axis=0), rel=1e-5, abs=0)
    level, values = level_image([glance_at(moment) for moment in line.moments], "range")
    assert level.shape == (len(values), NUM_FRAMES)


def test_frames_of_a_radar_with_other_cells_are_not_shown_in_cells_that_they_have_not(stored_run):
    """A radar of half the bandwidth has as many cells, twice as long: an echo of 12 m would seem to come from 6 m."""
    glance = glance_at(time_line_of(stored_run.path).moments[0])
    other = dataclasses.replace(glance, range=2.0 * glance.range)
    level, values = level_image([glance, other, glance], "range")
    assert np.array_equal(values, glance.range) and np.isnan(level[:, 1]).all() and np.isfinite(level[:, [0, 2]]).all()
    assert np.isfinite(level_image([glance, other], "velocity")[0]).all()  # which both share


def test_tracks_go_with_the_object(stored_run):
    """The plate drives straight at the radar: its range falls by the way of a frame, its velocity is its speed."""
    glances = [glance_at(moment) for moment in time_line_of(stored_run.path).moments]
    tracks = tracks_of(glances)
    assert tracks.num_tracks >= 1
    rows = tracks.of_track(int(tracks.track[0]))
    distance = track_values(rows, glances, "range")
    assert np.diff(distance) == pytest.approx(-0.8, rel=0, abs=0.25)
    assert track_values(rows, glances, "velocity")[-1] == pytest.approx(-4.0, rel=0, abs=1.5)


def test_tracks_have_velocities_as_soon_as_they_know_them(stored_run):
    """Of what comes at 8 m/s the first place tells none, as those that differ by 9.7 m/s look the same; a second one does."""
    radar = stored_run.radar
    assert radar.waveform.wavelength / (2.0 * radar.waveform.chirp_interval) == pytest.approx(9.7, abs=0.1)
    glances = [glance_of(0.2 * number, radar, 12.0 - 1.6 * number, stored_run[0].detections, -8.0) for number in range(4)]
    tracks = tracks_of(glances)
    speeds = track_values(tracks, glances, "velocity")
    assert np.isnan(speeds[0]) and speeds[1:] == pytest.approx([-8.0] * 3, abs=0.5)
    assert track_values(tracks, glances, "range") == pytest.approx(12.0 - 1.6 * np.arange(4), abs=0.1)


def glance_of(time: float, radar, distance: float, detections=None, velocity: float = 0.0):
    """A glance whose one detection is straight ahead of the radar."""
    found = dataclasses.replace(detections, **{name: value[:1] for name, value in vars(detections).items()
                                               if isinstance(value, np.ndarray) and len(value) == len(detections)})
    found = dataclasses.replace(found, range=np.array([distance]), azimuth=np.zeros(1), velocity=np.array([velocity]))
    axis = np.arange(2.0)
    return Glance(time, axis, axis, axis, axis, found, radar)


def test_tracks_below_a_mast_have_the_ranges_and_velocities_of_the_map(stored_run, plotter):
    """A radar 7.5 m above the ground, of what goes away 1.5 m above it at 4 m/s, 8 m away at first: ranges by Pythagoras, and
    their rates. In the fourth frame nothing was found. They are drawn where that goes, not as high as the radar."""
    radar, times = stored_run.radar.replace(position=(0.0, 0.0, 7.5)), 0.2 * np.arange(6)
    ways = 8.0 + 4.0 * times
    distances = np.hypot(ways, 6.0)
    glances = []
    for time, way, distance in zip(times, ways, distances):
        one = glance_of(float(time), radar, float(distance), stored_run[0].detections, float(4.0 * way / distance))
        found = dataclasses.replace(one.detections, elevation=-np.arctan2([6.0], way))
        glances.append(dataclasses.replace(one, detections=found))
    nothing = {name: value[:0] for name, value in vars(glances[3].detections).items() if np.ndim(value) and name != "centre"}
    glances[3] = dataclasses.replace(glances[3], detections=dataclasses.replace(glances[3].detections, **nothing))
    tracks = tracks_of(glances)
    assert tracks.num_tracks == 1 and len(tracks) == 6
    assert track_values(tracks, glances, "range") == pytest.approx(distances, rel=0, abs=0.1)
    assert track_values(tracks, glances, "velocity")[-1] == pytest.approx(4.0 * ways[-1] / distances[-1], rel=0, abs=0.2)
    places = track_places(tracks, glances)
    assert places == pytest.approx(np.column_stack([ways, np.zeros(6), np.full(6, 1.5)]), rel=0, abs=0.1)
    layer = TrackLayer(plotter)
    layer.show(tracks, places)
    assert layer._actor.GetBounds() == pytest.approx([ways[0], ways[-1], 0.0, 0.0, 1.5, 1.5], rel=0, abs=0.1)


def test_tracks_stand_still_before_a_radar_that_was_moved_between_files(stored_run):
    """Three radars, each at rest, 1 m apart, turned to look at what stands at (9, 0): the file of each has a radar of its own."""
    places = (np.array([0.0, 0.0]), np.array([0.6, 0.8]), np.array([1.2, 1.6]))
    glances = []
    for number, place in enumerate(places):
        way = np.array([9.0, 0.0]) - place
        radar = stored_run.radar.replace(position=(*place, 0.0), yaw=float(np.arctan2(way[1], way[0])))
        glances.append(glance_of(0.2 * number, radar, float(np.linalg.norm(way)), stored_run[0].detections))
    tracks = tracks_of(glances)
    assert tracks.num_tracks == 1
    assert tracks.state[:, :2] == pytest.approx(np.tile([9.0, 0.0], (3, 1)), rel=0, abs=1e-6)
    distances = [float(np.hypot(9.0 - place[0], place[1])) for place in places]
    assert track_values(tracks, glances, "range") == pytest.approx(distances, rel=0, abs=1e-6)
    assert track_values(tracks, glances, "velocity")[1:] == pytest.approx(np.zeros(2), abs=1e-6)  # of one place, none is known


def test_ranges_and_velocities_of_tracks_count_from_the_antennas(stored_run):
    """Antennas 4 m ahead of the middle of a car that turns on the spot go sideways by 4 m times its rate: at a right angle to
    what stands 5 m ahead of them, and by half of it towards what stands 30 degrees to their left."""
    turning = 0.5
    radar = stored_run.radar.replace(transmitters=[ep.Antenna((4, 0, 0))], receivers=[ep.Antenna((4, 0, 0))],
                                     motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, turning)))
    glances = [glance_of(0.0, radar, 5.0, stored_run[0].detections)]
    state = np.array([[9.0, 0.0, 0.0, 0.0], [4.0 + 5.0 * np.cos(np.pi / 6), 2.5, 0.0, 0.0]])
    tracks = ep.Tracks(track=np.arange(2, dtype=np.int32), frame=np.zeros(2, np.int32), time=np.zeros(2), state=state,
                       covariance=np.zeros((2, 4, 4)), is_detected=np.ones(2, bool), object=np.array(["", ""]))
    assert track_values(tracks, glances, "range") == pytest.approx([5.0, 5.0], rel=0, abs=1e-9)
    assert track_values(tracks, glances, "velocity") == pytest.approx([0.0, -0.5 * 4.0 * turning], rel=0, abs=1e-6)


def test_velocities_of_tracks_need_no_motion_beyond_the_last_frame(stored_run):
    """Towards what stands still, a radar of 3 m/s whose keyframes end with the last frame sees -3 m/s."""
    times = 0.2 * np.arange(3)
    short = stored_run.radar.replace(waveform=stored_run.radar.waveform.replace(chirp_interval=2e-5))
    end = times[-1] + short.frame_duration  # .64 ms
    motion = ep.KeyframeMotion([0.0, end], [[0.0, 0.0, 0.0], [3.0 * end, 0.0, 0.0]], None, "linear")
    radar = short.replace(motion=motion)
    middles = times + 0.5 * radar.frame_duration
    glances = [glance_of(time, radar, 9.0 - 3.0 * middle, stored_run[0].detections, -3.0)
               for time, middle in zip(times, middles)]
    tracks = tracks_of(glances)
    assert track_values(tracks, glances, "velocity") == pytest.approx(-3.0 * np.ones(3), abs=1e-5)


def test_frames_of_maps_alone_show_maps_and_labels(stored_run, maps_of_run):
    line = time_line_of(maps_of_run.path)
    session = Session(line.read(1))
    kept = maps_of_run[1]
    shown = np.abs(session.parts.whole.spectrum.values) ** 2
    assert shown == pytest.approx(np.broadcast_to(kept.power, shown.shape), rel=1e-6, abs=0)
    assert session.paths.num_paths == 0 and session.radar == stored_run.radar
    session.set_layer("detections", True)
    assert len(session.known_data("detections")) == len(kept.detections)
    assert "keeps maps" in session.note
    assert glance_at(line.moments[1]).by_range == pytest.approx(glance_at(time_line_of(stored_run.path).moments[1]).by_range,
                                                                rel=1e-5, abs=0)


def test_what_is_shown_goes_on_in_the_next_frame(stored_run):
    line = time_line_of(stored_run.path)
    first = Session(line.read(0))
    first.set_color_by("mesh")
    first.set_mesh_colour(0, (1, 2, 3))
    first.set_mesh_visible([1], False)
    first.set_layer("detections", True)
    first.select_ray(int(first.shown_rays(1)[0]))
    second = session_like(state_of(first), line.read(1))
    assert second.color_by == "mesh" and second.palette[0].tolist() == [1, 2, 3] and second.hidden_meshes == {1}
    assert second.layers == {"detections"} and second.ray is None


def test_frames_that_were_shown_are_forgotten(stored_run):
    line, kept, state = time_line_of(stored_run.path), [], None
    for place in (0, 1, 2, 0, 1):
        session = session_like(state, line.read(place))
        state = state_of(session)
        kept.append(weakref.ref(session))
    del session
    gc.collect()
    assert sum(one() is not None for one in kept) == 0


def test_a_sequence_is_simulated_beside(moving_sequence, stored_run):
    line = SimulatedFrames(moving_sequence)
    assert len(line) >= 1 and line.expected == NUM_FRAMES
    line._thread.join(60.0)
    line.refresh()
    assert len(line) == NUM_FRAMES and line.failure == ""
    paths = line.read(2).paths
    assert paths.frame.start_time == stored_run.times[2] and np.array_equal(paths.amplitude, stored_run[2].paths.amplitude)
    folder = line.moments[0].path.parent
    line.close()
    assert not folder.exists()


LABELS_ALONE = """
[dataset]
scenes = 1
frames = 2
interval = 0.05
keep = "labels"
[radar.waveform]
start_frequency = 77e9
bandwidth = 0.7e9
num_samples = 64
sampling_rate = 10e6
num_chirps = 16
chirp_interval = 40e-6
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.0050, 1.0]
[[objects]]
name = "walker"
actor = "pedestrian"
position = [6.0, 1.0, 0.0]
[trace]
num_rays = 300
[labels]
"""


def test_frames_of_a_dataset_that_are_remade_have_their_rays(tmp_path):
    (tmp_path / "template.toml").write_text(LABELS_ALONE)
    list(ep.dataset.make(tmp_path / "template.toml", tmp_path / "made"))
    dataset = ep.dataset.open(tmp_path / "made")
    assert time_line_of(dataset).read(1).paths.num_paths == 0
    remade = dataset.remade()[1:]
    line = time_line_of(remade)
    shown, wanted = line.read(0), remade[0].frame
    assert len(line) == 1 and shown.paths.num_paths == wanted.paths.num_paths > 0 and shown.note == ""
    assert np.array_equal(shown.cube, wanted.cube) and shown.paths.frame.start_time == pytest.approx(0.05)


def test_scenes_with_lifetimes_show_what_is_there(tmp_path):
    """The scene that was traced may be given with the paths, although it has more meshes than took part."""
    scene, radar = make_scene(), make_radar()
    scene.add(ep.actors.plate(1.0, 1.0), name="guest", material="metal", position=(8.0, 2.0, 0.0), yaw=np.pi)
    scene["guest"].lifetime = 0.05, 1.0
    for time, wanted in ((0.0, ["plate"]), (0.1, ["plate", "guest"])):
        session = Session(from_paths(scene, ep.trace(scene, radar, num_rays=200, start_time=time)))
        assert session.mesh_names == wanted
    stored = ep.Sequence(scene, radar, frames=2, interval=0.1, num_rays=200, guard=False).save(tmp_path / "maps", keep="maps")
    assert [Session(time_line_of(stored.path).read(place)).mesh_names for place in range(2)] == [["plate"], ["plate", "guest"]]
