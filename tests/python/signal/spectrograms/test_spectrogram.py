"""Maps over time against closed forms: a pendulum, a rotor, tones, and the maps of single frames."""
import dataclasses

import numpy as np
import pytest

import echopath as ep
from echopath.in_time.bursts import bursts
from echopath.in_time.sliding import Stft
from support.radars import build_radar
from support.signals.tones import random_cube, tone

ROUNDING = 1e-11     # relative, of sums in another order
ONE_DRAWING = 0.07   # relative, of the noise of one frame beside that of twenty; 0.04 found


# --- against the map of one frame ---

@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("window, bandwidth", [  # Harris 1978, table 1; that of range counts
    ("hann", 1.5), ("rect", 1.0), (("rect", "hann"), 1.0), (("hann", "rect"), 1.5)])
def test_a_window_over_the_whole_frame_is_the_map_of_the_frame(real, window, bandwidth):
    radar = build_radar(((0, 0, 0), (0, 0.01, 0)), ((0, 0, 0), (0, 0.02, 0)), num_chirps=25, real=real)
    cube = random_cube(radar)
    found = ep.spectrogram(cube, radar, window_length=25, window=window)
    map = ep.range_doppler(cube, radar, window)
    expected = np.mean(np.abs(map.values) ** 2, axis=(0, 1)).sum(axis=1) / bandwidth
    assert np.array_equal(found.velocity, map.velocity)
    assert found.power[0] == pytest.approx(expected, rel=ROUNDING)
    assert found.times == pytest.approx(np.mean([radar.chirp_time(slot, 12) for slot in (0, 1)]))
    finer = ep.spectrogram(cube, radar, window_length=25, window=window, zero_pad=2)
    assert finer.velocity[1::2] == pytest.approx(map.velocity) and finer.power[0, 1::2] == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize("window", ["hann", "rect", "blackman_harris", ("hann", "rect"), ("rect", ("chebyshev", 60))])
def test_a_point_gives_its_received_power(window):
    radar = build_radar(num_chirps=64)
    cell = ep.range_doppler(random_cube(radar), radar)
    for distance in (cell.range[20], cell.range[20] + 0.4 * (cell.range[1] - cell.range[0])):  # in a cell and between two
        cube = tone(radar, distance, cell.velocity[40], power=3.0)
        found = ep.spectrogram(cube, radar, window_length=64, window=window)
        assert found.power.max() == pytest.approx(3.0, rel=1e-9)
        assert found.ridge[0] == cell.velocity[40]


@pytest.mark.parametrize("zero_pad", [1, 3])
@pytest.mark.parametrize("window", ["hann", ("hann", "rect"), ("rect", ("chebyshev", 60))])
def test_a_point_gives_its_received_power_to_a_sum_over_velocities_or_ranges(window, zero_pad):
    """Wherever it lies between the cells that are summed (Parseval); straight ahead of an array of two."""
    radar = build_radar(receivers=((0, 0, 0), (0, 0.0019, 0)), num_chirps=64)
    cell = ep.range_doppler(random_cube(radar), radar)
    ranges, velocities = (axis[30] + np.array([0.0, 0.4]) * (axis[1] - axis[0]) for axis in (cell.range, cell.velocity))
    cube = np.repeat(tone(radar, ranges[0], velocities[1], power=3.0), 2, axis=1)
    found = ep.range_time(cube, radar, window=window, zero_pad=zero_pad)
    assert found.power.max() == pytest.approx(3.0, rel=1e-9) and found.ridge[0] == pytest.approx(ranges[0])
    cube = np.repeat(tone(radar, ranges[1], velocities[0], power=3.0), 2, axis=1)
    ahead = {"azimuth": [-0.1, 0.0, 0.1], "combine": "peak"}
    found = ep.angle_time(cube, radar, window=window, zero_pad=zero_pad, angles=ahead)
    assert found.power.max() == pytest.approx(3.0, rel=1e-9) and found.ridge[0] == 0.0


def test_noise_has_the_power_that_is_told():
    radar = build_radar(num_chirps=512)
    noise = ep.add_noise(np.zeros((1, 1, 512, 64)), radar, seed=3, start_time=0.0)
    for gate in (None, (1.0, 4.0)):
        found = ep.spectrogram(noise, radar, window_length=32, hop=16, range_gate=gate)
        assert found.power.mean() / found.noise_power == pytest.approx(1.0, abs=0.1)  # of 31 x 32 cells of a few ranges


def test_the_noise_of_a_channel_of_signs_is_what_their_sum_leaves():
    radar = build_radar(((0, 0, 0), (0, 0.01, 0)), num_chirps=256, multiplexing="bpm")
    received = ep.add_noise(np.zeros((1, 1, 512, 64)), radar, seed=3, start_time=0.0)
    cube = ep.demultiplex(received, radar)
    for channel in (None, (1, 0)):
        found = ep.range_time(cube, radar, channel=channel)
        assert found.power.mean() / found.noise_power == pytest.approx(1.0, abs=0.1)  # of 256 x 64 cells


@pytest.mark.parametrize("code", [{"multiplexing": "ddm", "empty_slots": 1}, {"multiplexing": "bpm"},
                                  {"multiplexing": "cdm", "code_phases": np.random.default_rng(1).uniform(0, 6, (4, 8))}])
@pytest.mark.parametrize("window_length", [None, 20])
def test_the_noise_of_angles_is_what_undoing_a_code_leaves(code, window_length):
    """The mean over frames of noise that are taken apart: their channels have noise in common."""
    half = 0.5 * ep.speed_of_light / 77e9
    radar = build_radar([(0, 4 * tx * half, 0) for tx in range(4)], [(0, rx * half, 0) for rx in range(4)], num_chirps=60, **code)
    slots = 60 * radar.num_slots
    frames = [ep.demultiplex(ep.add_noise(np.zeros((1, 4, slots, 64)), radar, seed=seed), radar) for seed in range(5, 25)]
    found = ep.angle_time(frames, radar, combine="peak", angles={"combine": "sum"}, window_length=window_length)
    assert found.noise_power == pytest.approx(found.power.mean(), rel=ONE_DRAWING)


def test_the_noise_of_a_sum_of_velocities_is_its_closed_form():
    """k T F fs over all cells, of a chirp's transform: PHYSICS 2.3, for so many velocities of the gate as there are."""
    radar = build_radar(num_chirps=64)
    waveform, cells = radar.waveform, ep.range_doppler(random_cube(radar), radar, "hann", 2).velocity
    inside = np.count_nonzero((cells >= -3.0) & (cells <= 5.0))
    found = ep.range_time(random_cube(radar), radar, velocity_gate=(-3.0, 5.0), window="hann", zero_pad=2)
    density = ep.boltzmann * 290.0 * 10.0 ** (0.1 * radar.noise_figure_db)
    expected = density * waveform.sampling_rate * 1.5 / (waveform.num_samples * 64) * inside / 2  # Hann: 1.5 cells of range
    assert found.noise_power == pytest.approx(expected, rel=1e-9)


def test_the_gate_takes_the_ranges_in_it():
    radar = build_radar(num_chirps=64)
    ranges = ep.range_doppler(random_cube(radar), radar).range
    cube = tone(radar, ranges[20], 0.0) + tone(radar, ranges[40], 3.0)
    near = ep.spectrogram(cube, radar, range_gate=(ranges[15], ranges[25]))
    assert near.range_gate == (ranges[15], ranges[25])
    assert near.ridge == pytest.approx(0.0) and near.power.sum() == pytest.approx(
        ep.spectrogram(tone(radar, ranges[20], 0.0), radar, range_gate=(ranges[15], ranges[25])).power.sum(), rel=1e-6)
    with pytest.raises(ValueError, match="range_gate: must hold a cell of the axis"):
        ep.spectrogram(cube, radar, range_gate=(1e4, 2e4))


# --- trains of chirps ---

@pytest.mark.parametrize("num_chirps, length", [(200, 128), (20, 20)])
def test_windows_are_of_128_chirps_or_a_frame_and_a_quarter_of_that_apart(num_chirps, length):
    radar = build_radar(num_chirps=num_chirps)
    found = ep.spectrogram(random_cube(radar), radar)
    assert (found.window_length, found.hop) == (length, length // 4)
    assert np.diff(found.times) == pytest.approx(length // 4 * radar.waveform.chirp_interval)


def test_times_without_power_have_no_ridge_and_no_extent():
    radar = build_radar(num_chirps=32)
    found = ep.spectrogram([tone(radar, 5.0, 1.0), np.zeros((1, 1, 32, 64))], radar, window_length=32)
    assert np.isnan([found.ridge[1], *(end[1] for end in found.extent())]).all() and np.isfinite(found.ridge[0])


@pytest.mark.parametrize("below_peak_db, cells", [(0.0, 0), (9.0, 0), (15.0, 1), (29.0, 2), (31.0, 3)])
def test_extents_reach_as_far_as_the_decibels_say(below_peak_db, cells):
    """Of a peak that falls by 10 dB a cell to both sides."""
    radar = build_radar(num_chirps=32)
    found = ep.spectrogram(random_cube(radar), radar, window_length=32)
    found = dataclasses.replace(found, power=10.0 ** -np.abs(np.arange(32.0) - 20.0)[None])
    assert found.extent(below_peak_db) == (found.velocity[20 - cells], found.velocity[20 + cells])


def test_windows_of_doppler_division_may_be_of_any_length():
    """Of 64 chirps in 4 shares 25 are no multiple: the map of these chirps by transmitters in turns of the same interval."""
    places = ((0, 0, 0), (0, 0.01, 0), (0, 0.02, 0))
    radar = build_radar(places, num_chirps=64, multiplexing="ddm", empty_slots=1)
    cube = random_cube(radar)
    found = ep.spectrogram(cube, radar, window_length=25, hop=25)
    waveform = radar.waveform.replace(num_chirps=25, chirp_interval=radar.waveform.chirp_interval / 3)
    plain = build_radar(places).replace(waveform=waveform)
    map = ep.range_doppler(cube[:, :, :25], plain)
    assert found.velocity == pytest.approx(map.velocity)
    assert found.power[0] == pytest.approx(np.mean(np.abs(map.values) ** 2, axis=(0, 1)).sum(axis=1) / 1.5, rel=ROUNDING)


def test_a_copy_of_what_has_begun_goes_on_by_itself():
    radar = build_radar(num_chirps=32)
    cubes = [random_cube(radar), random_cube(radar) * 2.0, np.zeros((1, 1, 32, 64), complex)]
    first, second, silent = bursts(cubes, radar)
    silent = silent._replace(start_time=second.start_time)
    whole = Stft(32, 8, "hann", 1, None, True, None)
    whole.add(first)
    other = whole.copy()
    whole.add(second)
    other.add(silent)
    for found, pair in ((whole, cubes[:2]), (other, cubes[::2])):
        expected = ep.spectrogram(pair, radar, window_length=32, hop=8, span_frames=True)
        assert np.array_equal(found.result(None).power, expected.power)


def test_no_window_spans_a_gap():
    radar = build_radar(num_chirps=32)
    period = radar.waveform.chirp_interval
    cubes = [random_cube(radar, seed) for seed in range(4)]
    starts = np.array([0, 32, 64, 100]) * period  # the last one after a gap of four chirps
    found = ep.spectrogram(cubes, radar, window_length=16, hop=8, start_times=starts, span_frames=True)
    long = radar.replace(waveform=radar.waveform.replace(num_chirps=96))
    joined = ep.spectrogram(np.concatenate(cubes[:3], axis=2), long, window_length=16, hop=8)
    alone = ep.spectrogram(cubes[3], radar, window_length=16, hop=8)
    assert found.train.tolist() == [0] * 11 + [1] * 3
    assert found.trains == pytest.approx(np.array([[0, 96], [100, 132]]) * period)
    assert found.power == pytest.approx(np.concatenate([joined.power, alone.power]))
    assert found.times == pytest.approx(np.concatenate([joined.times, alone.times + 100 * period]))
    assert "no window spans a gap" in repr(found) and "one train" in repr(joined)
    assert ep.spectrogram(cubes, radar, window_length=16, hop=8, start_times=starts) == found  # they are told to go on
    for told in ({"start_times": starts, "span_frames": False}, {}):
        apart = ep.spectrogram(cubes, radar, window_length=16, hop=8, **told)
        assert len(apart.trains) == 4 and len(apart.times) == 12


@pytest.mark.parametrize("window_length, hop", [(4, 6), (4, 10), (16, 5), (8, 19)])
def test_windows_are_as_far_apart_over_cubes_as_within_one(window_length, hop):
    radar = build_radar(num_chirps=8)
    cubes = [random_cube(radar, seed) for seed in range(8)]
    long = radar.replace(waveform=radar.waveform.replace(num_chirps=64))
    settings = {"window_length": window_length, "hop": hop, "span_frames": True}
    found, joined = ep.spectrogram(cubes, radar, **settings), ep.spectrogram(np.concatenate(cubes, axis=2), long, **settings)
    assert found.times == pytest.approx(joined.times, rel=1e-12) and found.power == pytest.approx(joined.power, rel=1e-12)


LEAKED = 0.01  # share of the power beyond the main lobe, of a plate whose points differ by 1 % in radial velocity


def rough_plate(scatterers, smooth=False):
    """Three frames without gaps of a plate that recedes at 3 m/s, with a share of power beyond the main lobe of its velocity."""
    scene = ep.Scene()
    material = "metal" if smooth else ep.Material(reflectivity=0.3, scattering=1.0)
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material=material, position=(6, 0, 0),
              motion=ep.LinearMotion(velocity=(3, 0, 0)))
    radar = build_radar(num_chirps=64, chirp_interval=100e-6, transmit_power=10.0)
    return ep.Sequence(scene, radar, frames=3, interval=64 * 100e-6, num_rays=3000, scatterers=scatterers, noise_seed=None,
                       guard=False)


def leaked(found):
    cell = found.velocity[1] - found.velocity[0]
    return 1.0 - found.power[:, np.abs(found.velocity - 3.0) < 2.5 * cell].sum() / found.power.sum()


def test_windows_go_on_over_frames_whose_scatterers_persist():
    """Of a plate that goes straight on, all windows of frames in a row have the power at its velocity."""
    frames = list(rough_plate("auto"))
    found = ep.spectrogram(frames, window_length=64, hop=16)
    assert len(found.trains) == 1 and len(found.times) == 9
    assert leaked(found) < LEAKED
    assert len(ep.spectrogram(frames, window_length=64, hop=16, span_frames=False).trains) == 3
    gap = ep.spectrogram([frames[0], frames[2]], window_length=64)
    assert len(gap.trains) == 2  # the chirps do not go on


def test_windows_stay_within_frames_whose_scatterers_are_their_own():
    frames = rough_plate("rays")
    for scatterers in ("rays", "surface"):
        own = [ep.simulate(frames.scene, frames.radar, num_rays=3000, seed=seed, start_time=start, guard=False, noise_seed=None,
                           scatterers=scatterers) for seed, start in enumerate(frames.times)]
        found = ep.spectrogram(own, window_length=64, hop=16)
        assert len(found.trains) == 3 and leaked(found) < LEAKED
        assert leaked(ep.spectrogram(own, window_length=64, hop=16, span_frames=True)) > 3 * LEAKED  # what is kept out
    assert len(ep.spectrogram(frames, window_length=64).trains) == 3


def test_windows_go_on_over_frames_without_speckle(pendulum):
    assert len(ep.spectrogram(pendulum).trains) == 1  # a smooth ball
    assert len(ep.spectrogram(list(rough_plate("rays", smooth=True)), window_length=64).trains) == 1
    with pytest.raises(ValueError, match="span_frames: must be True, False or 'auto', got 'always'"):
        ep.spectrogram(pendulum, span_frames="always")


def test_frames_may_follow_as_closely_as_those_of_a_sequence():
    """The next one begins with the last sample, before the chirp interval is over: its chirps do not go on evenly."""
    radar = build_radar(num_chirps=32)
    cubes = [random_cube(radar, seed) for seed in range(2)]
    found = ep.spectrogram(cubes, radar, start_times=[0.0, radar.frame_duration], window_length=32)
    alone = [ep.spectrogram(cube, radar, window_length=32).power for cube in cubes]
    assert len(found.trains) == 2 and np.array_equal(found.power, np.concatenate(alone))
    assert len(ep.range_time(cubes, radar, start_times=[0.0, radar.frame_duration]).times) == 2
    found.plot()


@pytest.mark.parametrize("num_samples", [64, 250])
def test_how_soon_a_frame_may_follow_is_named(num_samples):
    """From the last sample on, or the end of the last chirp, whichever is sooner; samples of 4 MHz take 16 or 62.5 us of a
    chirp's 64 us. Half of a sample, or of a chirp, is taken for rounding."""
    radar = build_radar(num_chirps=32, num_samples=num_samples, sampling_rate=4e6, chirp_interval=64e-6)
    cubes = [random_cube(radar, seed) for seed in range(2)]
    soonest = min(31 * 64e-6 + (num_samples - 1.5) / 4e6, 31.5 * 64e-6)
    with pytest.raises(ValueError, match=f"lets none begin before {soonest:.9g} s"):
        ep.spectrogram(cubes, radar, start_times=[0.0, soonest - 1e-9])
    assert len(ep.spectrogram(cubes, radar, start_times=[0.0, soonest + 1e-9], window_length=32).trains) == 2


@pytest.mark.parametrize("make", [ep.spectrogram, ep.range_time])
@pytest.mark.parametrize("wrong", [np.nan, np.inf, -1j * np.inf])
def test_samples_that_are_no_numbers_are_refused_as_maps_refuse_them(make, wrong):
    """A receiver that has lost one: it would be NaN in all cells of its windows."""
    radar = build_radar(num_chirps=8)
    good = random_cube(radar, 1)
    broken = good.copy()
    broken[0, 0, 3, 17], broken[0, 0, 4, 1] = wrong, -wrong
    with pytest.raises(ValueError, match=r"^frames: must be finite, got .* at \[tx, rx, chirp, sample\] = \[0, 0, 3, 17\]"):
        make([good, broken], radar)


def test_what_cannot_follow_is_refused():
    radar, cubes = build_radar(num_chirps=32), []
    cubes = [random_cube(radar, seed) for seed in range(2)]
    with pytest.raises(ValueError, match="frames: must come one after the other, got one that starts at 0.001 s"):
        ep.spectrogram(cubes, radar, start_times=[0.0, 0.001])
    with pytest.raises(ValueError, match="window_length: must be at most 64, the chirps of the longest train, got 65"):
        ep.spectrogram(cubes, radar, window_length=65, span_frames=True)
    with pytest.raises(ValueError, match="at most 32, the chirps of the longest train; span_frames=True joins frames"):
        ep.spectrogram(cubes, radar, window_length=64)
    with pytest.raises(ValueError, match="longest train, between which are gaps of 0.01 s and more, got"):
        ep.spectrogram(cubes, radar, window_length=64, start_times=[0.0, 0.01 + 32 * radar.waveform.chirp_interval])
    with pytest.raises(ValueError, match="radar: must be that of the cubes"):
        ep.spectrogram(cubes)
    with pytest.raises(ValueError, match="frames: must have one frame"):
        ep.spectrogram(iter([]), radar)
    with pytest.raises(ValueError, match="start_times: must have one for each cube, got 1"):
        ep.spectrogram(cubes, radar, start_times=[0.0])
    with pytest.raises(ValueError, match="start_times: must have one for each cube, got 3"):
        ep.spectrogram(cubes, radar, start_times=[0.0, 1.0, 2.0])
    with pytest.raises(IndexError, match="channel: rx: must be below 1"):
        ep.spectrogram(cubes, radar, channel=(0, 1))
    with pytest.raises(ValueError, match=r"frames: cubes must have the shape \(1, 1, 32, 64\)"):
        ep.spectrogram([cubes[0][:, :, 1:]], radar)


def test_a_channel_is_a_map_of_its_own():
    radar = build_radar(((0, 0, 0), (0, 0.01, 0)), ((0, 0, 0), (0, 0.02, 0)), num_chirps=16)
    cube = random_cube(radar)
    all_of_them = [ep.spectrogram(cube, radar, window_length=16, channel=(tx, rx)) for tx in (0, 1) for rx in (0, 1)]
    mean = ep.spectrogram(cube, radar, window_length=16)
    assert np.mean([one.power for one in all_of_them], axis=0) == pytest.approx(mean.power)
    assert all(np.array_equal(one.velocity, mean.velocity) for one in all_of_them)
    assert np.mean([one.times[0] for one in all_of_them]) == pytest.approx(mean.times[0])
    ranges = [ep.range_time(cube, radar, channel=(tx, rx)) for tx in (0, 1) for rx in (0, 1)]
    whole = ep.range_time(cube, radar)
    assert np.mean([one.power for one in ranges], axis=0) == pytest.approx(whole.power)
    assert all(np.allclose(one.velocity_gate, whole.velocity_gate) for one in ranges)


# --- bodies that move ---

DISTANCE, ARM, SWING, PERIOD = 6.0, 0.8, 0.5, 1.6  # m, m, rad, s


@pytest.fixture(scope="module")
def pendulum():
    """Four frames without gaps of a small ball that swings below a pivot 6 m away, towards the radar and away."""
    times = np.linspace(0.0, 0.5, 101)
    angle = SWING * np.sin(2.0 * np.pi * times / PERIOD)
    rotations = np.stack([np.cos(angle / 2), 0 * angle, np.sin(angle / 2), 0 * angle], axis=1)
    scene = ep.Scene()
    scene.add(name="pivot", position=(DISTANCE, 0, 0),
              motion=ep.KeyframeMotion(times=times, translations=np.zeros((101, 3)), rotations=rotations))
    scene.add(ep.actors.sphere(0.03), name="bob", parent="pivot", material="metal", position=(0, 0, -ARM), smooth=True)
    radar = build_radar(receivers=((0, 0.001, 0),), num_chirps=512, chirp_interval=200e-6, transmit_power=1.0)
    return [ep.simulate(scene, radar, num_rays=2000, start_time=start, guard=False)
            for start in 0.1024 * np.arange(4)]


def pendulum_velocity(times):
    """Rate of the distance of the bob's centre, m/s: turned by `angle` about y it is at (-ARM sin, 0, -ARM cos)."""
    def distance(time):
        angle = SWING * np.sin(2.0 * np.pi * time / PERIOD)
        return np.hypot(DISTANCE - ARM * np.sin(angle), ARM * np.cos(angle))
    return (distance(times + 1e-5) - distance(times - 1e-5)) / 2e-5


def test_the_ridge_of_a_pendulum_follows_its_velocity(pendulum):
    found = ep.spectrogram(pendulum, window_length=128, hop=32, range_gate=(5.0, 6.5), span_frames=True)
    assert len(found.trains) == 1 and found.trains[0] == pytest.approx([0.0, 0.4096])
    expected = pendulum_velocity(found.times)
    cell = found.velocity[1] - found.velocity[0]
    assert np.abs(found.ridge - expected).max() < cell
    assert np.ptp(expected) > 10 * cell


@pytest.mark.parametrize("retrace", ["never", "invalid"])
def test_a_part_is_what_the_whole_taken_apart_has_of_it(retrace):
    """Paths of other objects are left out before the signal of a part is made, or after."""
    scene = ep.Scene()
    for number, distance in enumerate((5.0, 7.0)):
        scene.add(ep.actors.sphere(0.2), name=f"ball_{number}", smooth=True,
                  material=ep.materials["metal"].replace(scattering=0.4), position=(distance, 0.4 * number, 0.0),
                  speed=2.0 - 3.0 * number)
    frames = list(ep.Sequence(scene, build_radar(num_chirps=32), frames=2, interval=0.01, num_rays=500, guard=False,
                              retrace=retrace, keyframes=2 if retrace == "invalid" else 0))
    for part, selection in (("ball_0", "T 'ball_0'+ R"), ("T .* 'ball_1' R", "T .* 'ball_1' R"), ("T 'ball_1' 'ball_1' R",) * 2):
        cubes = [ep.decompose(frame.paths, parts={"part": selection}, retrace=retrace, keyframes=frame.keyframes)["part"]
                 for frame in frames]
        expected = ep.spectrogram(cubes, frames[0].radar, start_times=[frame.start_time for frame in frames]).power
        found = ep.spectrogram(frames, part=part).power
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-9 * expected.max())
        assert (found.max() > 0.0) == ("'ball_1' 'ball_1'" not in part)


def test_an_object_is_a_part_with_what_goes_back_and_forth_on_it():
    """The corner of two plates sends most of its echo over both; it is all that there is."""
    scene = ep.Scene()
    scene.add(name="corner", position=(8, 0, 0), yaw=0.25 * np.pi)
    for name, place, yaw in (("left", (0, 0.5, 0), np.pi), ("right", (-0.5, 0, 0), 0.5 * np.pi)):
        scene.add(ep.actors.plate(1.0, 1.0), name=name, parent="corner", material="metal", position=place, yaw=yaw)
    frame = ep.simulate(scene, build_radar(num_chirps=16), num_rays=2000, max_bounces=2, guard=False)
    assert np.count_nonzero(frame.paths.num_bounces == 2) > 0
    whole = ep.spectrogram(ep.synthesize(frame.paths), frame.radar)
    once = ep.spectrogram(ep.synthesize(frame.paths.select("T 'corner' R")), frame.radar)
    assert ep.spectrogram(frame, part="corner").power == pytest.approx(whole.power, rel=1e-6, abs=1e-9 * whole.power.max())
    assert once.power.max() < 0.5 * whole.power.max()


def test_a_part_is_an_object_a_part_or_a_selection(pendulum):
    bob = ep.spectrogram(pendulum[:1], part="pivot/bob")
    alone = ep.spectrogram(ep.synthesize(pendulum[0].paths), pendulum[0].radar)  # the bob is all that there is
    assert bob.part == "pivot/bob" and bob.power == pytest.approx(alone.power, rel=1e-6, abs=1e-9 * alone.power.max())
    assert np.array_equal(ep.spectrogram(pendulum[0], part=ep.hits("pivot")).power, bob.power)
    with pytest.raises(ValueError, match="part: must be a part of the frame, an object of its scene or a selection, got 'bobb'"):
        ep.spectrogram(pendulum, part="bobb")
