"""Angles: against a slow beamformer, and of targets whose place is known, through the whole chain."""
from __future__ import annotations

import warnings

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from support.references import slow_beams
from support.signals.arrays import (
    DEGREE,
    HALF,
    LINE,
    TARGET_RADIUS,
    C,
    at,
    mimo,
    scene_of_spheres,
    spectrum_of,
    three_by_four,
    waveform,
)

# A sphere's echo comes from its point nearest to the antennas, within the footprint's error; beams of 7 to 30 degrees.
DIRECTION_TOLERANCE = 0.15 * DEGREE
SPACING_PHASE = 5e-4  # rad: the phase across half a wavelength near broadside, of four digits
SAMPLED = 0.02        # relative: 2e4 independent cells of noise (0.7 %), or side lobes of a second target (1.2 %)
SAMPLED_LINE = 0.05   # relative: one map of noise instead of six
SLOT_PHASE = 1e-4     # rad: of an echo beside the middle of its cell; 3e-5 found
SPEED_CELL = 0.2      # m/s: of the nearest cell, which are 0.34 m/s wide
ROUNDING = 1e-12      # relative to the peak, of sums of some hundred terms
PLANE = [(column, row) for row in range(2) for column in range(4)]


def four_by_eight(**changes):
    """A grid of 4 rows and 8 columns."""
    return mimo([(0, 0), (4, 0), (0, 2), (4, 2)], PLANE, **changes)


def noise_map(radar, seed=1):
    cube = ep.add_noise(np.zeros((len(radar.transmitters), len(radar.receivers), radar.waveform.num_chirps,
                                  radar.waveform.num_samples)), radar, seed=seed)
    return ep.range_doppler(cube, radar)


def cube_of_points(radar, points):
    """Signals of points (position [3], velocity [3], amplitude) from their two legs at the middle of each chirp."""
    cube = np.zeros((len(radar.transmitters), len(radar.receivers), radar.waveform.num_chirps,
                     radar.waveform.num_samples), complex)
    for position, velocity, amplitude in points:
        for m, transmitter in enumerate(radar.transmitters):
            times = np.array([radar.chirp_time(m, j) for j in range(radar.waveform.num_chirps)])
            places = np.asarray(position) + times[:, None] * np.asarray(velocity)
            out = np.linalg.norm(places - transmitter.position, axis=1)
            for n, receiver in enumerate(radar.receivers):
                delay = (out + np.linalg.norm(places - receiver.position, axis=1)) / C
                strength = np.full((len(times), 1), amplitude, complex)
                cube[m, n] += _core.synthesize_echoes(radar.waveform, delay[:, None], strength, method="direct",
                                                      num_slots=len(radar.transmitters))
    return cube


def strongest_cell(spectrum):
    power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
    return np.unravel_index(power.argmax(), power.shape)


def test_beams_equal_the_slow_sum():
    radar = four_by_eight()
    spectrum = noise_map(radar)
    azimuth, elevation = np.linspace(-1.2, 1.2, 7), np.array([-0.3, 0.0, 0.5])
    beams = ep.beamform(spectrum, radar, azimuth, elevation)
    assert beams.power.shape == (3, 7, 32, 128)
    grid = np.meshgrid(azimuth, elevation)
    expected = slow_beams.bartlett(spectrum, radar, grid[0].ravel(), grid[1].ravel()).reshape(beams.power.shape)
    np.testing.assert_allclose(beams.power, expected, rtol=0, atol=ROUNDING * expected.max())


def test_capon_equals_the_slow_inverse():
    """An echo in the cell lies in its neighbours, too: in all of them the slots are turned by the cell's velocity."""
    radar = three_by_four()
    spectrum = noise_map(radar)
    azimuth = np.linspace(-1.0, 1.0, 9)
    cell = (10, 50)
    keywords = dict(cells=[cell], method="capon", diagonal_loading=0.05, velocity_neighbours=1, range_neighbours=3)
    beams = ep.beamform(spectrum, radar, azimuth, **keywords)
    vectors = slow_beams.still_values(spectrum, radar, spectrum.velocity[10]).reshape(12, 32, 128)
    snapshots = vectors[:, 9:12, 47:54].reshape(12, -1)
    steering = slow_beams.steering(radar, azimuth, np.zeros(9)).reshape(9, 12)
    expected = slow_beams.capon(snapshots, vectors[:, 10, 50], steering, 0.05)
    np.testing.assert_allclose(beams.power[0, :, 0], expected, rtol=ROUNDING)
    compensated = ep.beamform(ep.compensate_tdm(spectrum, radar), radar, azimuth, **keywords)
    np.testing.assert_allclose(compensated.power, beams.power, rtol=ROUNDING)


def test_angle_fft_equals_beams_at_its_directions():
    radar = four_by_eight()
    spectrum = noise_map(radar)
    angles = ep.angle_fft(spectrum, radar, window="rect", zero_pad=2)
    assert angles.values.shape == (8, 16, 32, 128)
    up, left = angles.sin_elevation[3], angles.sin_azimuth[11]
    elevation, azimuth = np.arcsin(up), np.arcsin(left / np.sqrt(1.0 - up**2))
    expected = slow_beams.bartlett(spectrum, radar, np.array([azimuth]), np.array([elevation]))[0]
    np.testing.assert_allclose(np.abs(angles.values[3, 11]) ** 2, expected, rtol=0, atol=ROUNDING * expected.max())
    np.testing.assert_allclose(np.sin(angles.azimuth), angles.sin_azimuth, rtol=0, atol=1e-15)


def test_range_azimuth_equals_the_slow_mean():
    """Over all velocities, Hann's noise bandwidth being 1.5."""
    radar = three_by_four()
    spectrum = noise_map(radar)
    azimuth = np.linspace(-1.0, 1.0, 5)
    slow = slow_beams.bartlett(spectrum, radar, azimuth, np.zeros(5))
    np.testing.assert_allclose(ep.range_azimuth(spectrum, radar, azimuth).power, slow.sum(axis=1) / 1.5, rtol=ROUNDING)
    velocity = spectrum.velocity[7]
    np.testing.assert_allclose(ep.range_azimuth(spectrum, radar, azimuth, velocity=velocity).power, slow[:, 7], rtol=0,
                               atol=ROUNDING * slow.max())


@pytest.mark.parametrize("transmitters", [[(0, 0)], [(0, 0), (4, 0), (8, 0)]])
def test_velocities_up_to_the_end_of_the_axis_are_those_of_its_first_cell(transmitters):
    """A point whose velocity is a quarter of a cell below the end, where no cell of its own is: what was checked before the trace
    is not to be refused behind it. The transmitters of the second radar take turns, which turns it by its own velocity."""
    radar, azimuth, takes_turns = mimo(transmitters, LINE), 0.3, len(transmitters) > 1
    end, cell = radar.waveform.max_velocity(len(transmitters)), radar.waveform.velocity_resolution(len(transmitters))
    speed = end - 0.25 * cell
    spectrum = ep.range_doppler(cube_of_points(radar, [(at(8.0, azimuth, 0.0), at(speed, azimuth, 0.0), 1.0)]), radar)
    found = ep.range_azimuth(spectrum, radar, velocity=speed)
    assert found.velocity == pytest.approx(end)
    top = np.unravel_index(found.power.argmax(), found.power.shape)[0]
    assert found.azimuth[top] == pytest.approx(azimuth, abs=DIRECTION_TOLERANCE + np.diff(found.azimuth).max())
    first = ep.range_azimuth(spectrum, radar, found.azimuth, velocity=-end, compensate=False).power
    without = ep.range_azimuth(spectrum, radar, found.azimuth, velocity=speed, compensate=False).power
    assert np.array_equal(without, first) and np.allclose(first, found.power) != takes_turns
    frame = ep.simulate(scene_of_spheres([8.0, 0.0, 0.0]), radar, num_rays=500, angles={"velocity": speed}, guard=False)
    assert frame.range_azimuth.velocity == pytest.approx(end)
    with pytest.raises(ValueError, match="^velocity: must be on the map's axis"):
        ep.range_azimuth(spectrum, radar, velocity=end + 0.1 * cell)


def test_noise_falls_by_the_number_of_elements():
    radar = three_by_four()
    power = np.mean([ep.beamform(noise_map(radar, seed), radar, [-0.5, 0.2]).power.mean() for seed in range(6)])
    cell = _core.noise_power(radar) * 1.5**2 / (32 * 128)  # of one channel, Hann on both axes
    assert power == pytest.approx(cell / 12, rel=SAMPLED, abs=0)
    assert ep.range_azimuth(noise_map(radar), radar, [-0.5, 0.2]).power.mean() == pytest.approx(
        _core.noise_power(radar) * 1.5 / 128 / 12, rel=SAMPLED_LINE)


def test_the_edge_of_an_array_near_a_target_is_behind_by_its_published_phase():
    """k D^2 / 8R for D = 0.1 m, R = 5 m at 77 GHz: 0.4035 rad."""
    chirps = waveform(num_chirps=1, start_frequency=76.5e9)
    receivers = [ep.Antenna((0.0, y, 0.0)) for y in (-0.05, 0.0, 0.05)]
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=receivers)
    spectrum = ep.range_doppler(cube_of_points(radar, [((5.0, 0, 0), (0, 0, 0), 1.0)]), radar)
    _, distance = strongest_cell(spectrum)
    left, middle, right = spectrum.values[0, :, 0, distance]
    assert np.angle(left / middle) == pytest.approx(0.4035, abs=SPACING_PHASE)
    assert np.angle(right / middle) == pytest.approx(0.4035, abs=SPACING_PHASE)


@pytest.mark.parametrize("azimuth, elevation", [(25, 0), (-40, 0), (0, 20), (0, -15), (30, -12)])
def test_a_sphere_is_found_where_it_is(azimuth, elevation):
    """Left and right, up and down: through trace, replay, synthesis and both transforms."""
    radar = four_by_eight(height=1.0)
    centre = at(8.0, azimuth * DEGREE, elevation * DEGREE) + [0, 0, 1.0]
    spectrum = spectrum_of(scene_of_spheres(centre), radar)
    found = ep.estimate_angles(spectrum, radar, cells=[strongest_cell(spectrum)])
    assert found.azimuth[0] == pytest.approx(azimuth * DEGREE, abs=DIRECTION_TOLERANCE)
    assert found.elevation[0] == pytest.approx(elevation * DEGREE, abs=2 * DIRECTION_TOLERANCE)
    # At the sphere's front, in the cell of 0.15 m; seen from the middle of the antennas, 3 mm off the origin.
    front = at(8.0 - TARGET_RADIUS, azimuth * DEGREE, elevation * DEGREE) + [0, 0, 1.0]
    assert np.linalg.norm(found.points[0] - front) < 0.1
    angles = ep.angle_fft(spectrum, radar)
    _, e, a, *_ = np.unravel_index(np.abs(angles.values).argmax(), (1, *angles.values.shape))
    assert np.sign(np.round(angles.sin_azimuth[a], 1)) == np.sign(azimuth)
    assert np.sign(np.round(angles.sin_elevation[e], 1)) == np.sign(elevation)


@pytest.mark.parametrize("method", ["bartlett", "capon"])
@pytest.mark.parametrize("azimuth, elevation", [(20, 10), (55, -35), (-75, -40)])
def test_directions_aslant_are_found_between_the_steps_of_the_grid(method, azimuth, elevation):
    """A plane wave on 8 x 8 elements: beams there are long across azimuth and elevation, and those of Capon needles."""
    radar = mimo([(0, 0), (4, 0), (0, 4), (4, 4)], [(column, row) for row in range(4) for column in range(4)])
    toward = at(1.0, azimuth * DEGREE, elevation * DEGREE)
    shape, count = radar.waveform, radar.waveform.num_samples
    channels = np.array([[np.exp(-2j * np.pi * (tx.position + rx.position) @ toward / shape.wavelength)
                          for rx in radar.receivers] for tx in radar.transmitters])
    tone = np.exp(2j * np.pi * 20 * np.arange(count) / count)
    cube = channels[:, :, None, None] * np.broadcast_to(tone, (shape.num_chirps, count))
    spectrum = ep.range_doppler(cube, radar)
    found = ep.estimate_angles(spectrum, radar, cells=[strongest_cell(spectrum)], method=method)
    assert found.azimuth[0] == pytest.approx(azimuth * DEGREE, abs=1e-3 * DEGREE)
    assert found.elevation[0] == pytest.approx(elevation * DEGREE, abs=1e-3 * DEGREE)
    assert found.power[0] == pytest.approx(1.0, abs=1e-3)


def test_angles_are_those_in_the_frame_of_a_turned_radar():
    yaw, pitch = 50 * DEGREE, -10 * DEGREE  # to the left, then nose up (about +y, which points left)
    turn_left = np.array([np.cos(yaw / 2), 0, 0, np.sin(yaw / 2)])
    turn_up = np.array([np.cos(pitch / 2), 0, np.sin(pitch / 2), 0])
    w0, z0, w1, y1 = turn_left[0], turn_left[3], turn_up[0], turn_up[2]
    quaternion = (w0 * w1, -z0 * y1, w0 * y1, z0 * w1)
    place = [3.0, -2.0, 1.5]
    motion = ep.KeyframeMotion(times=[-1.0, 1.0], translations=[place, place], rotations=[quaternion, quaternion])
    radar = four_by_eight(motion=motion)
    world = radar.world_from_radar(0.0)
    centre = world[:3, :3] @ at(7.0, 0.3, 0.15) + world[:3, 3]
    spectrum = spectrum_of(scene_of_spheres(centre), radar)
    found = ep.estimate_angles(spectrum, radar, cells=[strongest_cell(spectrum)])
    assert found.azimuth[0] == pytest.approx(0.3, abs=DIRECTION_TOLERANCE)
    assert found.elevation[0] == pytest.approx(0.15, abs=2 * DIRECTION_TOLERANCE)


def looking_to(yaw, spacing=HALF, looks=None):
    """A line of 8 receivers across `yaw` in the radar's frame, as at the corner of a car, whose antennas look to `looks`."""
    left, look = np.array([-np.sin(yaw), np.cos(yaw), 0.0]), yaw if looks is None else looks
    return ep.Radar(waveform(), transmitters=[ep.Antenna((0.0, 0.0, 0.0), yaw=look)],
                    receivers=[ep.Antenna(n * spacing * left, yaw=look) for n in range(8)])


@pytest.mark.parametrize("yaw", [60 * DEGREE, 120 * DEGREE, -150 * DEGREE, 180 * DEGREE])
@pytest.mark.parametrize("aside", [-70, -20, 50])
def test_antennas_that_look_aside_find_what_is_before_them(yaw, aside):
    """A line sees the same before and behind it: what it tells apart are the 180 degrees to which its antennas look."""
    radar = looking_to(yaw)
    azimuth = yaw + aside * DEGREE
    spectrum = ep.range_doppler(cube_of_points(radar, [(at(18.0, azimuth, 0.0), [0, 0, 0], 1.0)]), radar)
    found = ep.estimate_angles(spectrum, radar, cells=[strongest_cell(spectrum)])
    off = np.exp(1j * (found.azimuth[0] - azimuth))
    assert abs(np.angle(off)) < DIRECTION_TOLERANCE and -np.pi <= found.azimuth[0] <= np.pi
    np.testing.assert_allclose(found.points[0], found.range[0] * at(1.0, azimuth, 0.0), atol=18.0 * DIRECTION_TOLERANCE)
    seen = ep.range_azimuth(spectrum, radar)
    top = seen.azimuth[np.argmax(seen.power.max(axis=1))]
    assert abs(np.angle(np.exp(1j * (top - azimuth)))) < 1.5 * DEGREE and np.all(np.diff(seen.azimuth) > 0.0)
    assert seen.azimuth[[0, -1]] == pytest.approx([yaw - 90 * DEGREE, yaw + 90 * DEGREE], abs=1e-6)


def test_the_field_of_view_lies_across_the_array_on_the_side_to_which_its_antennas_look():
    wide = ep.virtual_array(looking_to(60 * DEGREE, spacing=2 * HALF)).default_angles()[0]   # unambiguous to +-30 degrees
    assert wide[[0, -1]] == pytest.approx([30 * DEGREE, 90 * DEGREE], abs=1e-6)
    squinting = ep.virtual_array(looking_to(60 * DEGREE, looks=85 * DEGREE)).default_angles()[0]
    assert squinting[[0, -1]] == pytest.approx([-30 * DEGREE, 150 * DEGREE], abs=1e-6)
    behind = ep.virtual_array(looking_to(60 * DEGREE, looks=-100 * DEGREE)).default_angles()[0]
    assert behind[[0, -1]] == pytest.approx([-210 * DEGREE, -30 * DEGREE], abs=1e-6)
    upright = ep.Radar(waveform(), transmitters=[ep.Antenna((0, 0, 0), yaw=1.0)],
                       receivers=[ep.Antenna((0, 0, n * HALF), yaw=1.0) for n in range(4)])
    assert ep.virtual_array(upright).default_angles()[0] == pytest.approx([1.0])
    ring = [(0.7 * np.cos(k), 0.7 * np.sin(k), 0.0) for k in 0.4 * np.pi * np.arange(5)]  # on no grid
    around = ep.Radar(waveform(), transmitters=[ep.Antenna((0, 0, 0), yaw=2.0)],
                      receivers=[ep.Antenna(place, yaw=2.0) for place in ring])
    ends = ep.virtual_array(around).default_angles()[0][[0, -1]]
    assert ends == pytest.approx([2.0 - 0.5 * np.pi, 2.0 + 0.5 * np.pi])


def test_a_moving_sphere_needs_its_slots_compensated():
    """10 m/s away: 0.974568 rad per slot, 4 elements of half a wavelength per slot."""
    radar = three_by_four(chirps=waveform(num_chirps=64))
    azimuth = 20 * DEGREE
    spectrum = spectrum_of(scene_of_spheres(at(8.0, azimuth, 0.0), velocity=at(10.0, azimuth, 0.0)), radar)
    cell = strongest_cell(spectrum)
    found = ep.estimate_angles(spectrum, radar, cells=[cell])
    assert found.azimuth[0] == pytest.approx(azimuth, abs=DIRECTION_TOLERANCE)
    wrong = ep.estimate_angles(spectrum, radar, cells=[cell], compensate=False)
    shift = np.sin(wrong.azimuth[0]) - np.sin(azimuth)
    assert shift == pytest.approx(-0.974568 / (4 * np.pi), abs=0.01)  # the steps within a slot hold the beam a little
    by_hand = ep.estimate_angles(ep.compensate_tdm(spectrum, radar), radar, cells=[cell])
    assert by_hand.azimuth[0] == found.azimuth[0]


def test_slots_of_one_place_differ_by_the_published_phase():
    radar = mimo([(0, 0), (0, 0)], [(0, 0)], chirps=waveform(num_chirps=128))
    spectrum = spectrum_of(scene_of_spheres([8.0, 0, 0], velocity=(10.0, 0, 0)), radar)
    first, second = spectrum.values[(slice(None), 0, *strongest_cell(spectrum))]
    assert np.angle(second / first) == pytest.approx(0.974568, abs=SLOT_PHASE)


def test_fast_targets_unfold_by_their_slots():
    """v_max = 10.75 m/s for three transmitters; 14 m/s appears at -7.5 m/s."""
    radar = three_by_four(chirps=waveform(num_chirps=64))
    spectrum = ep.range_doppler(cube_of_points(radar, [(at(10.0, 0.4, 0.0), at(14.0, 0.4, 0.0), 1e-5)]), radar)
    cell = strongest_cell(spectrum)
    assert spectrum.velocity[cell[0]] == pytest.approx(14.0 - 2 * radar.waveform.max_velocity(3), abs=SPEED_CELL)
    found = ep.estimate_angles(spectrum, radar, cells=[cell], folds=1)
    assert found.velocity[0] == pytest.approx(14.0, abs=SPEED_CELL)
    assert found.azimuth[0] == pytest.approx(0.4, abs=DIRECTION_TOLERANCE)
    assert abs(ep.estimate_angles(spectrum, radar, cells=[cell]).azimuth[0] - 0.4) > 2 * DEGREE


def test_a_column_of_transmitters_tells_folds_in_an_order_that_is_not_that_of_their_heights():
    """In order a fold has the phases of another elevation; 4 m/s is beyond the +-2.7 m/s of the map."""
    chirps = waveform(num_chirps=32).replace(chirp_interval=30e-6)
    step, heights = 0.5 * chirps.wavelength, (0, 7, 3, 10, 5, 1, 8, 4, 11, 2, 9, 6)
    row = [ep.Antenna((0, step * n, 0)) for n in range(4)]
    shuffled, column = (ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, step * m)) for m in order], receivers=row)
                        for order in (heights, sorted(heights)))
    for radar, is_told in ((shuffled, True), (column, False)):
        spectrum = ep.range_doppler(cube_of_points(radar, [(at(10.0, 0.2, 0.05), at(4.0, 0.2, 0.05), 1e-5)]), radar)
        cell = strongest_cell(spectrum)
        if is_told:
            found = ep.estimate_angles(spectrum, radar, cells=[cell], folds=1)
            assert found.velocity[0] == pytest.approx(4.0, abs=SPEED_CELL)
            assert found.elevation[0] == pytest.approx(0.05, abs=DIRECTION_TOLERANCE)
            continue
        assert abs(ep.estimate_angles(spectrum, radar, cells=[cell]).elevation[0] - 0.05) > 5 * DEGREE
        told = ep.estimate_angles(spectrum, radar, elevation=0.05, cells=[cell], folds=1)
        assert told.velocity[0] == pytest.approx(4.0, abs=SPEED_CELL)
        for call in (lambda: ep.estimate_angles(spectrum, radar, cells=[cell], folds=1),
                     lambda: ep.simulate(ep.Scene(), radar, detections={"folds": 1})):
            with pytest.raises(ValueError, match="^folds: must be 0 where transmitters stand in even steps in the order of"):
                call()


def test_codes_of_signs_tell_no_velocities_apart():
    """All transmitters of "bpm" send in every slot: there is no phase between turns that could tell."""
    radar = three_by_four().replace(multiplexing="bpm")
    with pytest.raises(ValueError, match="^folds: must be at least 0 and less than half the number of slots in which"):
        ep.estimate_angles(noise_map(radar), radar, cells=[[0, 0]], folds=1)
    with pytest.raises(ValueError, match="^folds: must be 0, or less than half of the 1 slots in which"):
        ep.simulate(ep.Scene(), radar, detections={"folds": 1})


@pytest.mark.parametrize("steps", [dict(frequency_steps=(0.0, 3e6, 1e6)), dict(bandwidth_steps=(0.0, -2e6, 3e6)),
                                   dict(frequency_steps=(1e6, 0.0, 1e6), bandwidth_steps=(2e6, 0.0, 0.0))])
def test_transmitters_that_send_on_carriers_of_their_own_see_the_same_direction(steps):
    """1 MHz more turns an echo from 8 m by 0.34 rad, which looks like half a degree of four elements."""
    radar = three_by_four(chirps=waveform(num_chirps=16).replace(**steps))
    spectrum = spectrum_of(scene_of_spheres(at(8.0, 0.3, 0.0)), radar)
    cells = [strongest_cell(spectrum)]
    for found in (ep.estimate_angles(spectrum, radar, cells=cells),
                  ep.estimate_angles(ep.compensate_tdm(spectrum, radar), radar, cells=cells)):
        assert found.azimuth[0] == pytest.approx(0.3, abs=DIRECTION_TOLERANCE)
    assert abs(ep.estimate_angles(spectrum, radar, cells=cells, compensate=False).azimuth[0] - 0.3) > 3 * DIRECTION_TOLERANCE


HOPS = (0.0, 1e8, 2e8)
OF_CARRIERS = 0.004  # rad: 3 mm of range turn the third transmitter by 0.025 rad


def radar_that_hops(steps=HOPS):
    """Three transmitters in turns, each on a carrier of its own, before four receivers: a row of twelve elements."""
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=128, sampling_rate=10e6, num_chirps=32,
                              chirp_interval=20e-6, frequency_steps=steps)
    half = 0.5 * ep.speed_of_light / 77e9
    return ep.Radar(chirps, transmitters=[ep.Antenna((0, 4 * i * half, 0)) for i in range(3)],
                    receivers=[ep.Antenna((0, i * half, 0)) for i in range(4)])


@pytest.mark.parametrize("settings", [{}, {"method": "capon"}])
@pytest.mark.parametrize("distance, azimuth, speed", [(12.15, 0.3, 0.0), (20.85, -0.5, 6.0), (7.4, 0.1, -8.0)])
def test_carriers_of_their_own_turn_echoes_between_range_cells_as_those_within(distance, azimuth, speed, settings):
    """Half a cell of 0.3 m turns the third transmitter by 1.3 rad; 8 m/s show an echo 1.6 cm farther, which turns nothing."""
    radar, toward = radar_that_hops(), np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    cube = ep.point_targets(radar, positions=[distance * toward], velocities=[speed * toward], rcs=1e3)
    spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=1), radar)
    for one, beams in ((spectrum, False), (spectrum, True), (ep.compensate_tdm(spectrum, radar), False)):
        found = ep.detect(one, radar, false_alarm_rate=1e-9, angles=settings, beams=beams)
        strongest = found.power.argmax()
        assert found.azimuth[strongest] == pytest.approx(azimuth, abs=OF_CARRIERS)
        assert found.range[strongest] == pytest.approx(distance + 0.5 * speed * radar.frame_duration, abs=0.01)
    if distance != 7.4:  # which lies near the middle of its cell
        assert abs(ep.estimate_angles(spectrum, radar, cells=[strongest_cell(spectrum)]).azimuth[0] - azimuth) > 0.02
    shown = distance + speed * (0.5 * radar.frame_duration + 77.25e9 / radar.waveform.slope)
    for one in (spectrum, ep.compensate_tdm(spectrum, radar)):
        told = ep.estimate_angles(one, radar, cells=[strongest_cell(one)], velocity=[speed], range=[shown], **settings)
        assert told.azimuth[0] == pytest.approx(azimuth, abs=OF_CARRIERS)


@pytest.mark.parametrize("name", ["velocity", "range"])
@pytest.mark.parametrize("wrong", [[np.nan], [np.inf], [1.0, 2.0]])
def test_places_of_echoes_that_are_none_are_refused_by_name(name, wrong):
    """What is no number had no peaks, as if nothing were there."""
    radar = radar_that_hops()
    spectrum = ep.range_doppler(ep.point_targets(radar, positions=[(12.0, 4.0, 0.0)], rcs=1.0), radar)
    with pytest.raises(ValueError, match=f"^{name}: must "):
        ep.estimate_angles(spectrum, radar, cells=[strongest_cell(spectrum)], **{name: wrong})


def test_carriers_that_are_listed_twice_are_the_same():
    radars = [radar_that_hops(steps) for steps in (HOPS, HOPS + HOPS)]
    cubes = [ep.point_targets(radar, positions=[(12.0, 4.0, 0.0)], rcs=1.0) for radar in radars]
    assert np.array_equal(*cubes)
    found = [ep.detect(ep.range_doppler(ep.add_noise(cubes[0], radar, seed=1), radar), radar) for radar in radars]
    assert np.array_equal(found[0].azimuth, found[1].azimuth)


def test_virtual_arrays_tell_what_they_are():
    array = ep.virtual_array(mimo([(0, 0), (3, 0)], LINE, height=1.0))
    assert array.positions.shape == (2, 4, 3) and array.elements.shape == (7, 3)
    np.testing.assert_allclose(array.positions, slow_beams.channel_positions(mimo([(0, 0), (3, 0)], LINE, height=1.0)))
    assert array.num_overlaps == 1 and array.element_of_channel.tolist() == [[0, 1, 2, 3], [3, 4, 5, 6]]
    assert array.grid_shape == (1, 7) and array.gaps.shape == (0, 2)
    assert array.grid_spacing == pytest.approx((0.0, HALF)) and array.grid_deviation < ROUNDING
    np.testing.assert_allclose(array.grid_axes, [[0, 0, 1], [0, 1, 0]], atol=ROUNDING)
    assert "7 elements on a grid of 1 x 7" in repr(array)
    sparse = ep.virtual_array(mimo([(0, 0)], [(0, 0), (1, 0), (4, 0)]))
    assert sparse.gaps.tolist() == [[0, 2], [0, 3]]
    bent = [(np.cos(0.7 * i), np.sin(0.7 * i)) for i in range(9)]
    none = ep.virtual_array(mimo([(0, 0)], bent))
    assert none.grid_shape is None and none.grid_axes is None and "no grid" in repr(none)


def with_noise_and_points(radar, bearings):
    """A map of points in the radar's plane at 6 m and further, some 50 dB above the noise of a cell."""
    points = [((6 + 2 * i) * np.array([np.cos(bearing), np.sin(bearing), 0.0]), (0, 0, 0), 3e-7)
              for i, bearing in enumerate(bearings)]
    return ep.range_doppler(ep.add_noise(cube_of_points(radar, points), radar, seed=1), radar)


@pytest.mark.parametrize("heights", [np.arange(12) * np.sin(0.035) * HALF, 0.02 * HALF * (np.arange(12) % 2)],
                         ids=["rolled by two degrees", "uneven by a hundredth of a wavelength"])
def test_a_line_that_is_not_quite_level_gives_azimuths_alone(heights):
    """Elevations of such a line are those of its noise, and took azimuths with them."""
    level, bearings = np.arange(12) * HALF, (0.5, -0.3, 0.8)
    radar = ep.Radar(waveform(), transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, y, z)) for y, z in zip(level, heights)])
    spectrum = with_noise_and_points(radar, bearings)
    cells = [(0, int(abs(spectrum.range - 6 - 2 * i).argmin())) for i in range(3)]
    found = ep.detect(spectrum, radar, false_alarm_rate=1e-9)
    nearest = [abs(found.range - spectrum.range[column]).argmin() for _, column in cells]
    np.testing.assert_allclose(found.azimuth[nearest], bearings, atol=2 * DEGREE)
    assert np.isnan(found.elevation).all()


def test_antennas_turned_to_one_side_look_there():
    """Antennas in a row ahead cannot tell left from right: the side to which they are turned is theirs."""
    for yaw, bearing in ((0.5 * np.pi, 1.2), (0.5 * np.pi, 2.3), (-0.5 * np.pi, -1.2), (2.6, 2.9), (2.6, -2.9)):
        along = (1.0, 0.0) if abs(yaw) < 2 else (0.0, 1.0)
        row = [ep.Antenna((n * HALF * along[0], n * HALF * along[1], 0), yaw=yaw) for n in range(12)]
        radar = ep.Radar(waveform(), transmitters=[ep.Antenna(yaw=yaw)], receivers=row)
        spectrum = with_noise_and_points(radar, [bearing])
        found = ep.estimate_angles(spectrum, radar, cells=[strongest_cell(spectrum)])
        assert found.azimuth[0] == pytest.approx(bearing, abs=2 * DEGREE)
        above = ep.range_azimuth(spectrum, radar)
        shown = above.azimuth[np.unravel_index(above.power.argmax(), above.power.shape)[0]]
        assert np.remainder(shown, 2 * np.pi) == pytest.approx(np.remainder(bearing, 2 * np.pi), abs=2 * DEGREE)
        assert ep.virtual_array(radar).boresight == pytest.approx(yaw)


def test_beams_over_several_polarisations_are_warned_of():
    """Echoes of HH and VV differ in more than the phases of places: those of a dihedral cancel."""
    upright, level = ep.Antenna((0, 0, 0)), [ep.Antenna((0, n * HALF, 0), polarization=(0, 1, 0)) for n in range(4)]
    rolled = ep.Antenna((0, 0, 0), orientation=(np.cos(np.pi / 4), np.sin(np.pi / 4), 0, 0))
    mixed = ep.Radar(waveform(), transmitters=[upright, rolled], receivers=level)
    spectrum, beyond = noise_map(mixed), {"cells": [(0, 5)]}
    for work, name in ((lambda: ep.range_azimuth(spectrum, mixed), "range_azimuth"),
                       (lambda: ep.estimate_angles(spectrum, mixed, **beyond), "estimate_angles"),
                       (lambda: ep.beamform(spectrum, mixed, 0.1, **beyond), "beamform"),
                       (lambda: ep.angle_fft(spectrum, mixed), "angle_fft"),
                       (lambda: ep.music(spectrum, mixed, [0.1], **beyond), "music")):
        with pytest.warns(RuntimeWarning, match=f"^{name}: the channels of this radar have several pairs of polarisations"):
            work()
    crossed = mixed.replace(transmitters=[upright])  # vertical to horizontal in all channels
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.range_azimuth(noise_map(crossed), crossed)


def test_axes_may_be_numbers_lists_or_left_to_the_array():
    radar = four_by_eight()
    spectrum = noise_map(radar)
    assert ep.beamform(spectrum, radar, 0.1, cells=[[0, 0], [1, 2]]).power.shape == (1, 1, 2)
    assert ep.beamform(spectrum, radar, [0.1, 0.2], [-0.1, 0, 0.1], cells=[[0, 0]]).power.shape == (3, 2, 1)
    azimuth, elevation = ep.virtual_array(radar).default_angles()
    whole = ep.beamform(spectrum, radar, None, None, cells=[[3, 4]])
    np.testing.assert_array_equal(whole.azimuth, azimuth)
    np.testing.assert_array_equal(whole.elevation, elevation)
    assert ep.range_azimuth(spectrum, radar, elevation=None).power.shape == (len(azimuth), 128)


def test_bad_input_names_the_argument():
    radar = three_by_four()
    kilometres = mimo([(0, 0), (1, 0), (1e7, 0)], [(0, 0)])
    slower = radar.replace(waveform=radar.waveform.replace(chirp_interval=2.0 * radar.waveform.chirp_interval))
    spectrum = noise_map(radar)
    compensated = ep.compensate_tdm(spectrum, radar)
    for call, error, text in [
            (lambda: ep.beamform(spectrum, radar, method="music"), ValueError, "^method: must be 'bartlett' or 'capon'"),
            (lambda: ep.beamform(spectrum, radar, [0.2, 0.1]), ValueError, "^azimuth: must be ascending"),
            (lambda: ep.beamform(spectrum, radar, elevation=2.0), ValueError, "^elevation: "),
            (lambda: ep.range_azimuth(noise_map(kilometres), kilometres), ValueError,
             "^azimuth: must be given: an array of this length in m tells more than 200,000 angles apart, got 19"),
            (lambda: ep.beamform(spectrum, radar, np.linspace(0, 1, 4000), np.linspace(0, 1, 4000)), ValueError,
             "^azimuth, elevation: must have at most 134,217,728 directions times elements of the array, got 192000000"),
            (lambda: ep.beamform(spectrum, radar, cells=[[32, 0]]), IndexError, "^cells: .*got \\(32, 0\\)"),
            (lambda: ep.beamform(spectrum, radar, cells=[[0.5, 0]]), TypeError, "^cells: "),
            (lambda: ep.beamform(spectrum, radar, overlap="first"), TypeError, "the nearest right one is 'overlaps'"),
            (lambda: ep.range_azimuth(spectrum, radar, velocity=99.0), ValueError, "^velocity: .*got 99"),
            (lambda: ep.angle_fft(spectrum, radar, windows="hann"), TypeError, "nearest right one is 'window'"),
            (lambda: ep.angle_fft(spectrum, four_by_eight()), ValueError, "^spectrum: must have the radar's 4 x 8"),
            (lambda: ep.music(compensated, four_by_eight(), [0.1], cells=[[0, 0]]), ValueError, "^spectrum: .* 4 x 8 channels"),
            (lambda: ep.music(compensated, slower, [0.1], cells=[[0, 0]]), ValueError, "^spectrum: .*whose velocities span"),
            (lambda: ep.estimate_angles(spectrum, radar, cells=[[0, 0]], folds=2), ValueError, "^folds: "),
            (lambda: ep.compensate_tdm(compensated, radar), ValueError, "^spectrum: ")]:
        with pytest.raises(error, match=text):
            call()
