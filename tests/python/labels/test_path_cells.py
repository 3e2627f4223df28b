"""Cells of paths: against the peak of the map that each path makes on its own."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.detections.echo_fields import EchoFields
from support.radars import build_radar, with_waveform
from support.shapes import lambert

NEAR_AN_EDGE = 0.02  # cells: the peak of a finite transform is that close to its frequency (TDM slots, window sidelobes)
CARRIER_SPAN = 4e-4   # the carrier of an echo lies up to 20 MHz (75 m) below that of the chirp's middle, 77.5 GHz
SPEEDS = (-27.0, -11.0, -3.0, 0.0, 4.0, 9.0, 31.0)  # m/s, folded beyond +-9.7 (one transmitter) or 4.9 (two)
RANGES = (3.0, 11.3, 24.9, 37.2, 52.0, 75.0, 90.0)  # m; the last beyond the anti-alias filter


def radar_of(real: bool, num_transmitters: int):
    return build_radar([(0, 0.2 * k, 0) for k in range(num_transmitters)], [(0, 0, 0), (0, -0.3, 0.1)], num_samples=512,
                       num_chirps=64, chirp_interval=1e-4, real=real)


def traced(radar):
    """A plate at each range, beside one another, with a speed of its own."""
    scene = ep.Scene()
    for index, (distance, speed) in enumerate(zip(RANGES, SPEEDS)):
        direction = np.array([1.0, 0.2 * (index - 3), 0.0])
        scene.add(ep.actors.plate(0.5, 0.5), name=f"plate_{index}", material=lambert(0.27), position=distance * direction,
                  motion=ep.LinearMotion(velocity=speed * direction / np.linalg.norm(direction)))
    return ep.trace(scene, radar, num_rays=700, max_bounces=1)


@pytest.mark.parametrize("real, num_transmitters, zero_pad", [(False, 1, 1), (True, 1, 2), (False, 2, 1)])
def test_the_map_of_a_path_peaks_in_its_cell(real, num_transmitters, zero_pad):
    assert_peaks_in_cells(radar_of(real, num_transmitters), zero_pad)


def test_steps_that_repeat_with_the_transmitters_are_those_of_the_map():
    """By the start frequency the fastest path lies five cells of velocity aside, by the slope 10 cells of range at 25 m."""
    radar = with_waveform(radar_of(False, 2), frequency_steps=(0.0, 2e9), bandwidth_steps=(0.0, -6e7))
    assert_peaks_in_cells(radar, 1, carrier_ratio=1.0 + (2e9 - 3e7) / radar.waveform.centre_frequency)


def assert_peaks_in_cells(radar, zero_pad: int, carrier_ratio: float = 1.0):
    """The map of each path alone, of the last channel, has its peak in the cell of the path.

    carrier_ratio: of the last transmitter's carrier to that of the waveform
    """
    paths = traced(radar)
    tx, rx = len(radar.transmitters) - 1, 1
    chosen = np.random.default_rng(1).choice(paths.num_paths, 60, replace=False)
    empty = ep.range_doppler(np.zeros(cube_shape(radar), complex), radar, zero_pad=zero_pad)
    cells = ep.path_cells(paths, empty, tx=tx, rx=rx)
    num_outside = 0
    for path in chosen:
        power = power_of_one(paths, path, radar, zero_pad)[tx, rx]
        if cells.range_index[path] == -1:
            num_outside += 1
            assert power.max() == 0.0 and cells.velocity_index[path] == -1
            continue
        peak = np.unravel_index(power.argmax(), power.shape)
        assert is_nearest(cells, path, peak, empty, carrier_ratio), (cells.range[path], cells.velocity[path], peak)
    assert 0 < num_outside < len(chosen) / 2


def cube_shape(radar) -> tuple:
    return len(radar.transmitters), len(radar.receivers), radar.waveform.num_chirps, radar.waveform.num_samples


def power_of_one(paths, path: int, radar, zero_pad: int):
    mask = np.zeros(paths.num_paths, bool)
    mask[path] = True
    cube = ep.synthesize(paths.select(mask), radar, method="direct", evaluate="chirps")
    return np.abs(ep.range_doppler(cube, radar, window="hann", zero_pad=zero_pad).values) ** 2


def is_nearest(cells, path: int, peak, spectrum, carrier_ratio: float) -> bool:
    """The cell is that of the peak, or its neighbour where the path lies at the edge between them."""
    at = (cells.velocity_index[path], cells.range_index[path])
    if at == peak:
        return True
    step = spectrum.range[1] - spectrum.range[0], spectrum.velocity[1] - spectrum.velocity[0]
    edge = [abs(abs((value / width) % 1.0) - 0.5) < NEAR_AN_EDGE
            for value, width in zip((carrier_ratio * cells.velocity[path], cells.range[path]), step[::-1])]
    return all(abs(a - b) <= near for a, b, near in zip(at, peak, edge))


@pytest.mark.parametrize("steps", ["frequency_steps", "bandwidth_steps"])
def test_chirps_of_a_transmitter_that_differ_are_told_and_lie_where_even_ones_do(steps):
    even = radar_of(False, 2)
    radar = with_waveform(even, **{steps: (0.0, 0.0, 1e7)})
    empty = ep.range_doppler(np.zeros(cube_shape(radar), complex), radar)
    with pytest.warns(RuntimeWarning, match=f"transmitter 1 of their radar differ .{steps}.*cells of all velocities"):
        cells = ep.path_cells(traced(radar), empty, tx=1)
    expected = ep.path_cells(traced(even), empty, tx=1)
    assert np.array_equal(cells.velocity_index, expected.velocity_index)
    assert np.array_equal(cells.range_index, expected.range_index)


def test_detections_of_chirps_that_differ_say_nothing_of_it(recwarn):
    radar = with_waveform(radar_of(False, 1), frequency_steps=(0.0, 1e7, 4e6))
    paths = traced(radar)
    ep.detect(ep.range_doppler(ep.synthesize(paths), radar), radar, paths=paths)
    assert not [str(one.message) for one in recwarn if "cells of all velocities" in str(one.message)]


def test_ranges_and_velocities_are_those_of_the_plates():
    paths = traced(radar_of(False, 1))
    cells = ep.path_cells(paths, ep.range_doppler(np.zeros((1, 2, 64, 512), complex), paths.radar))
    plate = paths.mesh_id[paths.offsets]
    tolerance = 0.05  # m/s: sight lines to the edges of a plate of 0.5 m at 3 m and more against that to its middle
    assert np.abs(cells.velocity - np.array(SPEEDS)[plate]).max() < tolerance * np.abs(SPEEDS).max()
    coupling = paths.radar.waveform.centre_frequency * cells.velocity / paths.radar.waveform.slope
    assert cells.range - 0.5 * cells.length == pytest.approx(coupling, rel=CARRIER_SPAN, abs=1e-12)


@pytest.mark.parametrize("num_chirps", [1, 8])
@pytest.mark.parametrize("start_time", [0.0, 0.3])
def test_keys_need_to_last_no_longer_than_the_frame(num_chirps, start_time):
    """From its first sample to its last one, as for the signal itself, of a chirp that is alone, too."""
    radar = build_radar(num_samples=64, num_chirps=num_chirps)
    end = start_time + radar.frame_duration
    keys = ep.KeyframeMotion([start_time, end], [[0.0, 0.0, 0.0], [4.0 * (end - start_time), 0.0, 0.0]], interpolation="linear")
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="plate", material=lambert(0.27), position=(9.0, 0.0, 0.0), motion=keys)
    frame = ep.simulate(scene, radar, num_rays=300, start_time=start_time, labels=True, detections=True, guard=False)
    velocity = ep.path_cells(frame.paths, frame.spectrum).velocity
    assert len(velocity) > 0 and velocity == pytest.approx(4.0, abs=0.01)  # straight ahead, to the cosine of its edge


def test_detections_of_single_samples_need_keys_no_longer_than_the_frame():
    """Of a radar that tells no ranges apart, whose frame begins and ends at a sample; a plate of 4 m/s is found as what it is."""
    radar = build_radar(num_samples=1, num_chirps=64, bandwidth=1e7, sampling_rate=2e4, transmit_power=10.0)
    keys = ep.KeyframeMotion([0.0, radar.frame_duration], [[0.0, 0.0, 0.0], [4.0 * radar.frame_duration, 0.0, 0.0]],
                             interpolation="linear")
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="plate", material=lambert(0.27), position=(9.0, 0.0, 0.0), motion=keys)
    paths = ep.trace(scene, radar, num_rays=300)
    noisy = ep.add_noise(ep.synthesize(paths), radar, seed=1)
    found = ep.detect(ep.range_doppler(noisy, radar), radar, paths=paths)
    assert list(found.object) == ["plate"] and found.velocity == pytest.approx(4.0, abs=0.1)


def test_a_rectangle_holds_what_a_loop_finds():
    paths = traced(radar_of(False, 1))
    cells = ep.path_cells(paths, ep.range_doppler(np.zeros((1, 2, 64, 512), complex), paths.radar))
    mask = cells.within((10, 300), (3, 40))
    for path in range(paths.num_paths):
        inside = 10 <= cells.range_index[path] <= 300 and 3 <= cells.velocity_index[path] <= 40
        assert mask[path] == inside
    assert mask.any() and not mask.all()
    seen = cells.range_index >= 0
    ends = [(values[seen].min(), values[seen].max()) for values in (cells.range_index, cells.velocity_index)]
    assert np.array_equal(cells.within(*ends), seen)  # both ends are in it


def test_what_the_anti_alias_filter_removes_does_not_come_back_in_front():
    """Just beyond the last cell, where the next would be the first."""
    waveform = radar_of(False, 1).waveform
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="plate", material=lambert(0.27), position=(waveform.max_range + 0.03, 0.0, 0.0))
    paths = ep.trace(scene, radar, num_rays=30, max_bounces=1)
    cube = ep.synthesize(paths)
    assert not cube.any() and paths.num_paths > 0
    assert np.all(ep.path_cells(paths, ep.range_doppler(cube, radar)).range_index == -1)


def test_what_lies_nearer_to_the_end_of_the_ranges_than_to_the_last_cell_is_in_the_first():
    """Of complex samples ranges are a circle; the echo is as strong there as the map has it."""
    waveform = radar_of(False, 1).waveform
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
    for nearer, index in ((0.3, 0), (0.7, waveform.num_samples - 1)):
        scene, distance = ep.Scene(), waveform.max_range - nearer * waveform.range_resolution
        scene.add(ep.actors.plate(0.01, 0.01), name="plate", material=lambert(0.27), position=(distance, 0.0, 0.0))
        paths = ep.trace(scene, radar, num_rays=30, max_bounces=1)
        spectrum = ep.range_doppler(ep.synthesize(paths), radar)
        strongest = np.argmax(np.abs(spectrum.values[0, 0]).max(axis=0))
        assert strongest == index and np.all(ep.path_cells(paths, spectrum).range_index == index)


def test_paths_that_bring_nothing_are_no_faster_than_what_moves():
    """Antennas see nothing behind them, where a wall mirrors a box that moves at 1 m/s: of the paths over it most bring
    nothing. Of four bounces two at most are on the box, each of which makes an echo faster by 1 m/s at most."""
    antenna = ep.Antenna((0.1, 0, 1.4), pattern=ep.CosinePower(1))
    radar = build_radar([antenna], [antenna], num_samples=128, num_chirps=64)
    concrete = ep.materials["concrete"].replace(mirror=True)
    scene = ep.Scene()
    scene.add(ep.actors.wall(8, 2.6), name="behind", material=concrete, yaw=-0.5 * np.pi)
    scene.add(ep.actors.wall(8, 2.6), name="beside", material=concrete, position=(2, 1.5, 0))
    rough = ep.Material(permittivity=4 - 0.3j, scattering=0.5)
    scene.add(ep.actors.box(0.3), name="box", material=rough, position=(2, 0.3, 1), yaw=0.5, speed=1.0)
    paths = ep.trace(scene, radar, num_rays=1000)
    cells = ep.path_cells(paths, ep.range_doppler(ep.synthesize(paths, radar), radar))
    assert np.count_nonzero(paths.power == 0.0) > paths.num_paths / 3
    assert np.abs(cells.velocity).max() < 2.0


def test_no_paths_give_no_cells():
    paths = traced(radar_of(False, 1)).select("T .{3} R")
    cells = ep.path_cells(paths, ep.range_doppler(np.zeros((1, 2, 64, 512), complex), paths.radar))
    assert cells.range.shape == cells.range_index.shape == cells.within((0, 9), (0, 9)).shape == (0,)


@pytest.fixture(scope="module")
def spinning():
    """Paths of a ball that spins where it is: its surface moves at 14 m/s, its point of reflection not at all. The rays lie far
    apart, so that the phases of the wide launch cells follow that point."""
    radar = build_radar([(0, 0, 0)], [(0, 0.02, 0)], num_samples=128, num_chirps=64, chirp_interval=1e-4)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.35), name="ball", material="metal", smooth=True, position=(8.0, 0.0, 0.0),
              motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 40.0)))
    return ep.trace(scene, radar, num_rays=500, max_bounces=1)


def test_a_ball_that_spins_lies_where_it_is(spinning):
    """The places that the rays have hit go away by several cells of 0.3 m/s."""
    radar = spinning.radar
    cells = ep.path_cells(spinning, ep.range_doppler(np.zeros(cube_shape(radar), complex), radar))
    strongest = np.argsort([power_of_one(spinning, path, radar, 1).max() for path in range(spinning.num_paths)])[-8:]
    assert np.abs(cells.velocity[strongest]).max() < 0.2
    assert cells.range[strongest] == pytest.approx(7.65, abs=0.05)
    step = 1e-5  # s
    before, after = spinning.lengths([spinning.frame.trace_time - step, spinning.frame.trace_time + step], 0, 0)
    assert np.abs(0.25 * (after - before)[strongest] / step).max() > 1.0


def test_the_cells_of_a_ball_that_spins_have_the_fields_of_its_paths(spinning):
    """Three quarters of the power of its cell, and next to none two cells aside, where half a turn of surface moves."""
    spectrum = ep.range_doppler(ep.synthesize(spinning), spinning.radar)
    power = np.abs(spectrum.values[0, 0]) ** 2
    velocity, distance = np.unravel_index(power.argmax(), power.shape)
    echoes = EchoFields(spinning, spectrum)
    fields = {shift: np.abs(echoes.fields((velocity + shift, distance))[1].sum(axis=1)[0]) ** 2 for shift in (0, 2)}
    assert fields[0] == pytest.approx(power.max(), rel=0.25) and fields[2] < 1e-2 * fields[0]


@pytest.mark.parametrize("change, words", [({"bandwidth": 4e8}, "last range"), ({"chirp_interval": 2e-4}, "velocities span")])
def test_maps_of_other_chirps_are_refused(change, words):
    radar = radar_of(False, 1)
    other = with_waveform(radar, **change)
    spectrum = ep.range_doppler(np.zeros(cube_shape(other), complex), other)
    with pytest.raises(ValueError, match=f"^spectrum: must have been made with the chirps of this radar, .*{words}"):
        ep.path_cells(traced(radar), spectrum)
