"""Beams, maps beside range-Doppler, twins of ghosts and differences of maps, without a window."""
from __future__ import annotations

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.bench.live.street import house
from echopath.frame.maps import maps_of
from echopath_viewer.model import Session, from_file, from_frame
from echopath_viewer.model.frames.maps_input import from_maps
from echopath_viewer.model.maps.angle_maps import beat_signal, range_azimuth_map, range_elevation_map, spectrogram_map
from echopath_viewer.model.maps.attribution import Attribution
from echopath_viewer.model.maps.beams import beam_values, paths_in_beam
from echopath_viewer.model.maps.comparison import KeptMap, difference
from echopath_viewer.model.maps.ghost_twins import ghost_twins
from support import shapes

SUM_TOLERANCE = 1e-6  # of what makes a cell, of its value: what is promised


@pytest.fixture(scope="module")
def session(frame):
    return Session(from_frame(frame))


def test_beams_have_the_power_of_beamforming(frame):
    """Two transmitters take turns: the phase of motion between their slots is part of the beam."""
    for azimuth, elevation in ((0.0, 0.0), (0.3, -0.2)):
        power = np.asarray(ep.beamform(frame.spectrum, frame.radar, azimuth, elevation).power)[0, 0]
        for range_index in (30, 45):
            found = np.abs(beam_values(frame.spectrum, frame.radar, range_index, azimuth, elevation)) ** 2
            assert found == pytest.approx(power[:, range_index], rel=1e-6, abs=0)


@pytest.mark.parametrize("change", [{"extra_idle": (0.0, 2e-5)}, {"frequency_steps": (0.0, 10e6)}], ids=str)
def test_beams_know_when_and_at_which_carrier_each_slot_is_sent(frame, change):
    radar = frame.radar.replace(waveform=frame.radar.waveform.replace(**change))
    spectrum = ep.range_doppler(ep.add_noise(np.zeros(frame.cube.shape), radar, seed=1), radar)
    power = ep.beamform(spectrum, radar, 0.3, 0.0).power[0, 0, :, 30]
    assert np.abs(beam_values(spectrum, radar, 30, 0.3, 0.0)) ** 2 == pytest.approx(power, rel=1e-9, abs=0)


def test_a_beam_is_the_sum_of_its_contributions(session):
    session.attribution = Attribution(session.signals)
    session.select_beam(45, 0.1, 0.0)
    found, spectrum = session.cell_attribution(), session.parts.whole.spectrum
    value = beam_values(spectrum, session.radar, 45, 0.1, 0.0)[session.cell[1]]
    assert found.value == pytest.approx(value, rel=1e-9, abs=0)
    assert abs(sum(one.value for one in found.contributions) - value) < SUM_TOLERANCE * abs(value)


def test_paths_lie_in_the_beam_that_looks_at_their_object(stored_run):
    paths = stored_run[0].paths
    plate = np.asarray(ep.Selection("T 'plate' R").matches(paths))
    there = paths_in_beam(paths, plate, paths.frame.trace_time, np.arctan2(0.5, 6.0), 0.0)
    aside = paths_in_beam(paths, plate, paths.frame.trace_time, np.radians(50.0), 0.0)
    assert there.sum() == plate.sum() > 0 and not aside.any()


def test_side_maps_have_the_axes_and_peaks_of_their_functions(frame, moving_sequence):
    whole = frame.spectrum
    azimuth = range_azimuth_map(whole, frame.radar, "everything")
    truth = ep.range_azimuth(whole, frame.radar, combine="peak")
    assert azimuth.level == pytest.approx(10.0 * np.log10(np.asarray(truth.power)) + 30.0, rel=0, abs=1e-3)
    elevation = range_elevation_map(whole, frame.radar, "everything")
    assert elevation.level.shape == (len(elevation.y), len(whole.range)) and (np.diff(elevation.y) > 0.0).all()
    with pytest.raises(ValueError, match="tell no elevations apart"):
        range_elevation_map(whole, moving_sequence.radar, "")
    power = spectrogram_map(frame.cube, frame.radar, (0, 0))
    assert power.level.shape == (len(power.y), len(power.x)) and 0.0 < power.x[0] < power.x[-1]
    times, samples = beat_signal(frame.cube, frame.radar, (1, 0), 3)
    assert np.array_equal(samples, frame.cube[1, 0, 3]) and times[1] == pytest.approx(1e-7)


def test_elevations_are_those_where_the_antennas_look(frame):
    """Antennas in the x-z plane, turned to the left: what stands there is no echo from straight ahead."""
    half = 0.5 * frame.radar.waveform.wavelength
    waveform = frame.radar.waveform.replace(num_samples=64, num_chirps=2)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna(yaw=np.pi / 2)],
                     receivers=[ep.Antenna((left * half, 0, up * half), yaw=np.pi / 2) for left in range(6) for up in range(4)])
    up = np.radians(20.0)
    waves = np.exp(-2j * np.pi * ep.virtual_array(radar).positions @ [0, np.cos(up), np.sin(up)] / waveform.wavelength)
    beat = np.exp(2j * np.pi * 10 * np.arange(64) / 64)
    found = range_elevation_map(ep.range_doppler(waves[:, :, None, None] * np.ones((2, 1)) * beat, radar), radar, "everything")
    row, column = np.unravel_index(found.level.argmax(), found.level.shape)
    assert (found.y[row], column) == (pytest.approx(20.0, abs=1.0), 10)
    assert found.level.max() == pytest.approx(30.0, abs=0.1)  # dBm, of a wave of 1 W


def test_a_ghost_over_a_plane_seems_to_be_at_the_mirror_image():
    """Image method: an echo that goes over a wall both ways comes from behind it, as far as the object stands before it."""
    scene = ep.Scene()
    # Rough: a smooth box shows no face to the radar or its image, and too little of it comes back to tell where from.
    rough = ep.Material(reflectivity=0.8, scattering=1.0)
    scene.add(ep.Mesh(*_box((8.0, -1.0, 0.0))), name="box", material=rough)
    wall = ep.Material.metal(mirror=True)
    scene.add(ep.actors.wall(60, 8), name="wall", material=wall, position=(8, 3, -4))
    radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, sampling_rate=10e6, num_chirps=4,
                                      chirp_interval=1e-4), transmitters=[ep.Antenna((0, 0, 0))],
                     receivers=[ep.Antenna((0, 0.01, 0))])
    frame = ep.simulate(scene, radar, num_rays=20_000, max_bounces=3, seed=1)
    session = Session(from_frame(frame))
    twins = ghost_twins(session.paths, session.columns)
    both_ways = next(twin for twin in twins if (twin.object, twin.ghost_type) == ("box", 2) and "(2/3)" in twin.name)
    assert both_ways.offset == pytest.approx([0.0, 8.0, 0.0], rel=0, abs=0.7)  # from y = -1 to its image in
    # y = 3, but for the size of the box, whose nearest faces are seen.


def test_twins_of_what_was_read_as_one_object_leave_out_its_mirrors():
    """A ground that is a part of the object had been painted over all of the scene."""
    scene = ep.Scene()
    scene.add(None, name="town")
    road = ep.Mesh([[-60, -60, 0], [60, -60, 0], [60, 60, 0], [-60, 60, 0]], [[0, 1, 2], [0, 2, 3]])
    scene.add(road, name="road", parent="town", material=ep.Material.metal(mirror=True))
    rough = ep.Material(reflectivity=0.8, scattering=1.0)
    scene.add(ep.Mesh(*_box((10.0, 1.0, 1.0))), name="van", parent="town", material=rough)
    radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=3e8, num_samples=64, sampling_rate=10e6, num_chirps=4,
                                      chirp_interval=5e-5), transmitters=[ep.Antenna((0, 0, 1.5))],
                     receivers=[ep.Antenna((0, 0.01, 1.5))])
    session = Session(from_frame(ep.simulate(scene, radar, num_rays=2000, max_bounces=3)))
    twins = ghost_twins(session.paths, session.columns)
    assert twins and {session.mesh_names[mesh] for twin in twins for mesh in twin.meshes} == {"town/van"}


def test_things_of_a_town_are_told_apart_as_its_labels_do():
    """All had been told of as the object that the town was read as: its ghosts had covered the scene."""
    scene = ep.Scene()
    scene.add(None, name="town")
    scene.add(ep.Mesh(*house()), name="house", parent="town", material="brick", position=(10.0, 9.0, 0.0))
    road = ep.Mesh([[-60, -60, 0], [60, -60, 0], [60, 60, 0], [-60, 60, 0]], [[0, 1, 2], [0, 2, 3]])
    scene.add(road, name="road", parent="town", material="asphalt")
    for number in range(2):
        scene.add(ep.actors.box(size=(4.0, 1.8, 1.8)), name=f"van_{number}", parent="town", material="metal",
                  position=(12.0 + 8.0 * number, -2.0, 0.0))
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=3e8, num_samples=64, sampling_rate=10e6, num_chirps=4,
                              chirp_interval=5e-5)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1.5))], receivers=[ep.Antenna((0, 0.01, 1.5))])
    ep.mark_mirrors(scene, radar)
    vans = ep.find_objects(scene, radar)
    assert vans == {"van_0": "town/van_0", "van_1": "town/van_1"}
    for objects, told in ((vans, set(vans)), (["town/van_0"], {"town/van_0"}), (["town"], {"town"})):
        frame = ep.simulate(scene, radar, num_rays=2000, max_bounces=2, seed=1, labels={"objects": objects}, guard=False)
        session = Session(from_frame(frame))
        session.set_layer("truth", True)
        session.set_layer("ghost twins", True)
        assert set(session.known_data("truth").name) == told
        touched = Attribution(session.signals, session.told_objects()).things
        assert {name for name in touched if "van" in name} <= told
        for twin in session.known_data("ghost twins"):
            assert twin.object in told and (len(twin.meshes) == 1 or told == {"town"})


@pytest.mark.parametrize("objects", [["box"], ["plate"], ["plate", "box"], ["box", "plate"], None])
def test_what_makes_a_cell_is_of_the_objects_of_the_labels_in_their_order(objects):
    """A path over two objects is of the first: `ep.annotate` was told which, and the frame knows no more than its labels."""
    rough = ep.Material(reflectivity=0.5, scattering=1.0)
    scene = ep.Scene()
    scene.add(ep.actors.box(1.0), name="box", material=rough, position=(6.0, 0.7, 0.0))
    scene.add(ep.actors.ground(3.0), name="plate", material=rough, position=(6.0, -0.5, -0.6))
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=10e6, num_chirps=4,
                              chirp_interval=5e-5)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, 0.01, 0))])
    frame = ep.simulate(scene, radar, num_rays=1000, max_bounces=2, labels={"objects": objects}, guard=False)
    session = Session(from_frame(frame))
    found = ep.families(frame.paths, session.told_objects())
    expected = ep.families(frame.paths, objects)
    assert [str(one) for one in found] == [str(one) for one in expected] and len(expected) > 1
    assert np.array_equal(found.family_of_path, expected.family_of_path)


def _box(centre):
    corners = np.array([[x, y, z] for x in (-0.3, 0.3) for y in (-0.3, 0.3) for z in (-0.3, 0.3)]) + centre
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
             (1, 5, 7), (1, 7, 3)]
    return corners, np.array(faces)


def test_differences_are_of_the_same_place_and_of_signal_alone():
    axis = np.arange(10.0)
    noise = np.full((10, 10), -150.0, np.float32)
    first, second = noise.copy(), noise.copy()
    first[4, 5], second[4, 5] = -100.0, -93.0
    second[1, 1] = -149.0  # noise
    change = difference(KeptMap("a", first, axis, axis), KeptMap("b", second, axis, axis))
    assert change[4, 5] == pytest.approx(7.0) and change[1, 1] == 0.0
    other = KeptMap("coarse", first[::2, 1::2], axis[1::2], axis[::2])  # ranges 1, 3, ..., velocities 0, 2, ...
    change = difference(other, KeptMap("b", second, axis, axis))
    assert change[4, 5] == pytest.approx(7.0) and np.isnan(change[:, 0]).all() == (abs(axis[0] - 1.0) > 1.0)


def test_labels_of_azimuths_do_not_lie_over_velocities(stored_run):
    """The plate drives at the radar with 4 m/s, 5 degrees aside; its azimuth was shown as its velocity."""
    frame = stored_run[0]
    frame.labels = ep.annotate_frame(frame, plane="range_azimuth", objects=["plate"])
    shown = Session(from_frame(frame))
    shown.set_layer("objects and ghosts", True)
    image, _, markers = shown.map_layers()
    assert image.shape[:2] == shown.parts.whole.level(0, 0).shape
    plate = next(marker for marker in markers if marker.text == "plate")
    step = frame.spectrum.velocity[1] - frame.spectrum.velocity[0]
    assert plate.velocity == pytest.approx(-4.0, rel=0, abs=step)
    maps = maps_of(frame, with_power=True)
    with pytest.raises(ValueError, match="labels: this file keeps those of its range-azimuth map alone"):
        Session(from_maps(maps, stored_run)).set_layer("labels", True)


def test_maps_of_files_without_signals_are_called_the_means_that_they_are(stored_run):
    frame = stored_run[0]
    power = np.abs(frame.spectrum.values) ** 2
    kept, whole = Session(from_maps(maps_of(frame, with_power=True), stored_run)), Session(from_frame(frame))
    shown = 10.0 ** (0.1 * kept.parts.whole.level(*kept.channel) - 3.0)
    assert shown == pytest.approx(power.mean(axis=(0, 1)), rel=1e-3, abs=0)
    assert power.shape[:2] == (1, 4) and list(kept.channels) == [kept.channel_name] == ["mean of 4 channels"]
    assert len(whole.channels) == 4 and whole.channel_name == "TX 0, RX 0"


def test_true_centres_that_are_too_fast_for_the_map_are_where_their_echo_is(frame):
    """A plate that comes straight at the radar with 1.4 of the velocities of the map: its echo is folded to 0.6 of them away."""
    waveform = frame.radar.waveform.replace(num_chirps=32)
    radar = frame.radar.replace(waveform=waveform, transmitters=frame.radar.transmitters[:1])
    fastest = waveform.wavelength / (4.0 * waveform.chirp_interval)  # m/s
    scene = ep.Scene()
    scene.add(shapes.plate((8.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 0.3), name="plate", material=shapes.lambert(0.8),
              motion=ep.LinearMotion(velocity=(-1.4 * fastest, 0.0, 0.0)))
    session = Session(from_frame(ep.simulate(scene, radar, num_rays=500, noise_seed=None, truth=True)))
    session.set_layer("truth", True)
    (marker,) = session.map_layers()[2]
    assert marker.velocity == pytest.approx(0.6 * fastest, rel=0.01) and "beyond the velocities of the map" in marker.text
    spectrum, level = session.parts.whole.spectrum, session.parts.whole.level(0, 0)
    row = np.unravel_index(level.argmax(), level.shape)[0]
    assert marker.velocity == pytest.approx(spectrum.velocity[row], rel=0, abs=spectrum.velocity[1] - spectrum.velocity[0])


def test_the_range_azimuth_map_is_that_which_the_frame_was_asked_for(moving_sequence, tmp_path):
    angles = {"method": "capon", "azimuth": np.radians([-40.0, -20.0, 0.0, 20.0, 40.0]), "range_neighbours": 1}
    frame = ep.simulate(moving_sequence.scene, moving_sequence.radar, num_rays=500, angles=angles)
    ep.save_frame(frame, tmp_path / "frame.h5")
    session = Session(from_file(tmp_path / "frame.h5"))
    found = range_azimuth_map(session.part.spectrum, session.radar, "everything", angles=session.angles)
    with h5py.File(tmp_path / "frame.h5") as file:
        kept = file["range_azimuth/power"][:]
    assert found.title.endswith("everything, capon") and found.y.tolist() == pytest.approx([-40.0, -20.0, 0.0, 20.0, 40.0])
    assert found.level == pytest.approx(10.0 * np.log10(1e3 * kept), rel=0, abs=1e-3)
