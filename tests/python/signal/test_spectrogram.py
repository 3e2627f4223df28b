"""Maps over time against closed forms: a pendulum, a rotor, tones, and the maps of single frames."""
import pickle

import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar

ROUNDING = 1e-11     # relative, of sums in another order
HANN_LOSS = 0.7205   # of a point half-way between two cells: 1.42 dB (Harris 1978, table 1)


def tone(radar, distance, velocity, power=1.0, times=None):
    """Cube of a point of constant velocity, after s(t, n) = A e^{j 2 pi (2 slope R / c n / fs + 2 f R(t) / c)}."""
    waveform = radar.waveform
    times = np.arange(waveform.num_chirps) * waveform.chirp_interval if times is None else times
    fast = np.arange(waveform.num_samples) / waveform.sampling_rate
    beat = 2.0 * waveform.slope * distance / ep.speed_of_light
    slow = 2.0 * velocity * times / waveform.wavelength
    signal = np.sqrt(power) * np.exp(2j * np.pi * (beat * fast + slow[:, None]))
    return signal[None, None]


def random_cube(radar, seed=1):
    waveform, generator = radar.waveform, np.random.default_rng(seed)
    shape = (len(radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples)
    values = generator.normal(size=shape)
    return values if waveform.real else values + 1j * generator.normal(size=shape)


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


def test_noise_has_the_power_that_is_told():
    radar = build_radar(num_chirps=512)
    noise = ep.add_noise(np.zeros((1, 1, 512, 64)), radar, seed=3, start_time=0.0)
    for gate in (None, (1.0, 4.0)):
        found = ep.spectrogram(noise, radar, window_length=32, hop=16, range_gate=gate)
        assert found.power.mean() / found.noise_power == pytest.approx(1.0, abs=0.1)  # of 31 x 32 cells of a few ranges


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
    with pytest.raises(TypeError, match="span_frames: must be True, False or 'auto', got 'always'"):
        ep.spectrogram(pendulum, span_frames="always")


def test_what_cannot_follow_is_refused():
    radar, cubes = build_radar(num_chirps=32), []
    cubes = [random_cube(radar, seed) for seed in range(2)]
    with pytest.raises(ValueError, match="frames: must come one after the other, got one that starts at 0.001 s"):
        ep.spectrogram(cubes, radar, start_times=[0.0, 0.001])
    with pytest.raises(ValueError, match="window_length: must be at most 64, the chirps of the longest train, got 65"):
        ep.spectrogram(cubes, radar, window_length=65, span_frames=True)
    with pytest.raises(ValueError, match="at most 32, the chirps of the longest train; span_frames=True joins frames"):
        ep.spectrogram(cubes, radar, window_length=64)
    with pytest.raises(ValueError, match="radar: must be that of the cubes"):
        ep.spectrogram(cubes)
    with pytest.raises(ValueError, match="frames: must have one frame"):
        ep.spectrogram(iter([]), radar)
    with pytest.raises(ValueError, match="start_times: must have one for each cube, got 1"):
        ep.spectrogram(cubes, radar, start_times=[0.0])
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


def test_a_part_is_an_object_a_part_or_a_selection(pendulum):
    bob = ep.spectrogram(pendulum[:1], part="pivot/bob")
    alone = ep.spectrogram(ep.synthesize(pendulum[0].paths), pendulum[0].radar)  # the bob is all that there is
    assert bob.part == "pivot/bob" and bob.power == pytest.approx(alone.power, rel=1e-6, abs=1e-9 * alone.power.max())
    assert np.array_equal(ep.spectrogram(pendulum[0], part=ep.hits("pivot")).power, bob.power)
    with pytest.raises(ValueError, match="part: must be a part of the frame, an object of its scene or a selection, got 'bobb'"):
        ep.spectrogram(pendulum, part="bobb")


EDGE_DB = 8.0  # half the field, as at the ends of a band, and some ripple


def test_the_velocities_of_a_rotor_reach_the_speed_of_its_tips():
    """Echoes of a bar at rest in its middle go up to 2 pi f L / 2 at its ends where it is across the line of sight."""
    turns, half = 6.0, 0.4
    radar = build_radar(receivers=((0, 0.001, 0),), num_chirps=1024, chirp_interval=60e-6, num_samples=32, bandwidth=0.5e9)
    times = np.arange(1024) * 60e-6
    angle = 2.0 * np.pi * turns * times
    cube = sum(tone(radar, 5.0, 0.0) * np.exp(4j * np.pi / radar.waveform.wavelength * along * np.sin(angle))[None, None, :, None]
               for along in np.linspace(-half, half, 801))
    found = ep.spectrogram(cube, radar, window_length=64, hop=16)
    lowest, highest = found.extent(EDGE_DB)
    tip = 2.0 * np.pi * turns * half * np.abs(np.cos(2.0 * np.pi * turns * found.times))
    cell = found.velocity[1] - found.velocity[0]
    is_fast = tip > 4 * cell  # elsewhere the flash of the whole bar hides its ends
    assert np.abs(highest - tip)[is_fast].max() < 2.0 * cell and np.abs(-lowest - tip)[is_fast].max() < 2.0 * cell
    with pytest.raises(ValueError, match="below_peak_db: must be a finite number of at least 0 dB"):
        found.extent(-1.0)


def test_the_tips_of_a_simulated_rotor_reach_their_speed():
    """Two balls at the ends of an arm that turns: the ridge of each object is the speed of its tip along the line of sight."""
    turns, arm, distance = 6.0, 0.3, 5.0
    scene = ep.Scene()
    scene.add(name="rotor", position=(distance, 0, 0), motion=ep.LinearMotion(angular_velocity=(0, 0, 2 * np.pi * turns)))
    for name, side in (("left", arm), ("right", -arm)):
        scene.add(ep.actors.sphere(0.02), name=name, parent="rotor", material="metal", position=(0, side, 0), smooth=True)
    radar = build_radar(receivers=((0, 0.001, 0),), num_chirps=64, bandwidth=0.5e9, transmit_power=10.0)
    length = radar.waveform.num_chirps * radar.waveform.chirp_interval
    frames = [ep.simulate(scene, radar, num_rays=1000, start_time=number * length, guard=False) for number in range(20)]
    for name, side in (("left", arm), ("right", -arm)):
        found = ep.spectrogram(frames, part=f"rotor/{name}", window_length=64, zero_pad=4)
        phase = 2.0 * np.pi * turns * found.times
        at = np.array([distance - side * np.sin(phase), side * np.cos(phase)])
        rate = 2.0 * np.pi * turns * side * np.array([-np.cos(phase), -np.sin(phase)])
        expected = np.sum(at * rate, axis=0) / np.hypot(*at)
        assert np.abs(found.ridge - expected).max() < radar.waveform.velocity_resolution()
        assert np.abs(found.ridge).max() == pytest.approx(2.0 * np.pi * turns * arm, abs=radar.waveform.velocity_resolution())


# --- range and azimuth over time ---

def array_radar(**settings):
    wavelength = ep.speed_of_light / 77e9
    return build_radar(receivers=tuple((0, 0.5 * wavelength * n, 0) for n in range(8)), **settings)


@pytest.fixture(scope="module")
def passing():
    """Six frames of a ball that passes at 30 m/s from the right to the left, 8 m ahead of an array."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", position=(8, -3, 0), smooth=True,
              motion=ep.LinearMotion(velocity=(5, 30, 0)))
    radar = array_radar(num_chirps=32, transmit_power=1000.0)
    return [ep.simulate(scene, radar, num_rays=1000, start_time=0.03 * number, guard=False) for number in range(6)]


@pytest.mark.parametrize("combine", ["sum", "peak"])
def test_range_and_azimuth_over_time_follow_a_ball(passing, combine):
    ranges, angles = ep.range_time(passing, combine=combine), ep.angle_time(passing, combine=combine, range_gate=(4, 9.5))
    x, y = 8 + 5 * ranges.times, -3 + 30 * ranges.times
    coupling = ranges.range[1] - ranges.range[0]  # range-Doppler coupling and the nearest cell
    assert np.abs(ranges.ridge - (np.hypot(x, y) - 0.1)).max() < coupling
    assert np.abs(angles.ridge - np.arctan2(y, x)).max() < 0.03  # of a beam of 0.25 rad
    received = [ep.received_power(frame.paths).power for frame in passing]
    lost = HANN_LOSS if combine == "sum" else HANN_LOSS**2  # along range alone, or along both axes
    for found in (ranges, angles):
        share = found.power.max(axis=1) / received
        assert share.min() > 0.97 * lost and share.max() < 1.03
        assert 0.0 < found.noise_power < 1e-3 * found.power.max()


def test_a_velocity_gate_leaves_out_what_stands_still():
    """A strong point at rest and a weak one that recedes, at other azimuths: each alone in the gate of its velocity."""
    radar = array_radar(num_chirps=32)
    rate = radar.waveform.velocity_resolution()
    distance = 20.0 * radar.waveform.range_resolution
    elements = np.arange(8)[:, None, None]
    cube = sum(tone(radar, distance, velocity, power) * np.exp(-1j * np.pi * elements * np.sin(azimuth))
               for velocity, azimuth, power in ((0.0, -0.3, 1e-9), (8.0 * rate, 0.4, 1e-12)))
    frames = [cube, cube]
    for gate, azimuth, power in ((None, -0.3, 1e-9), ((4.0 * rate, 12.0 * rate), 0.4, 1e-12),
                                 ((-3.0 * rate, 3.0 * rate), -0.3, 1e-9)):
        for combine in ("sum", "peak"):
            found = ep.angle_time(frames, radar, velocity_gate=gate, combine=combine)
            assert found.ridge == pytest.approx([azimuth] * 2, abs=0.03)  # of a beam of 0.25 rad
            assert found.power.max() / power == pytest.approx(1.0, rel=0.03)
            assert found.velocity_gate == gate
    still, goes = (ep.angle_time(frames, radar, velocity_gate=gate, angles={"combine": "sum"}).noise_power
                   for gate in (None, (0.0, 16.0 * rate)))
    assert goes / still == pytest.approx(0.5, rel=0.3)  # of a sum over half of the velocities
    assert pickle.loads(pickle.dumps(found)) == found
    for wrong, words in (({"velocity_gate": (3.0, 1.0)}, "velocity_gate: must be a pair"),
                         ({"velocity_gate": (900.0, 901.0)}, "velocity_gate: must hold a cell"),
                         ({"velocity_gate": (0, 1), "angles": {"velocity": 0.0}}, "velocity_gate: must be None"),
                         ({"angles": 3}, "angles: must be")):
        with pytest.raises((TypeError, ValueError), match=words):
            ep.angle_time(frames, radar, **wrong)


def test_windows_of_a_long_frame_are_columns(passing):
    found = ep.range_time(passing, window_length=8)
    assert found.power.shape[0] == 6 * 4 and np.all(np.diff(found.times) > 0)
    waveform = passing[0].radar.waveform
    assert found.times[1] - found.times[0] == pytest.approx(8 * waveform.chirp_interval)
    with pytest.raises(ValueError, match="window_length: must be at most 32"):
        ep.range_time(passing, window_length=33)
    with pytest.raises(ValueError, match="radar that sees no azimuth"):
        ep.angle_time(random_cube(build_radar(num_chirps=4)), build_radar(num_chirps=4))


# --- labels ---

def test_the_strongest_part_owns_a_cell():
    radar = build_radar(num_chirps=128)
    slow, fast = tone(radar, 3.0, 1.0, 1e-9), tone(radar, 3.0, 6.0, 1e-11)
    parts = {"slow": ep.spectrogram(slow, radar, window_length=64), "fast": ep.spectrogram(fast, radar, window_length=64)}
    labels = ep.spectrogram_labels(parts, ep.spectrogram(slow + fast, radar, window_length=64))
    at = {speed: np.abs(labels.velocity - speed).argmin() for speed in (1.0, 6.0, -10.0)}
    assert labels.dominant[0, at[1.0]] == 0 and labels.dominant[0, at[6.0]] == 1 and labels.dominant[0, at[-10.0]] == -1
    assert labels.share.sum(axis=0) == pytest.approx(1.0)
    assert np.array_equal(labels.mask, (labels.whole > 10 * labels.noise_power) & (labels.whole >= 1e-6 * labels.whole.max()))
    assert "fast:" in repr(labels)
    without = ep.spectrogram_labels(parts)
    assert np.array_equal(without.whole, parts["slow"].power + parts["fast"].power)
    with pytest.raises(ValueError, match="parts: must all have the same times, which 'b' has not"):
        ep.spectrogram_labels({"a": parts["slow"], "b": ep.spectrogram(fast, radar, window_length=64, hop=8)})


# --- as values ---

def values_of(passing):
    found = ep.spectrogram(passing, window_length=16)
    return [found, ep.range_time(passing), ep.angle_time(passing), ep.spectrogram_labels({"ball": found})]


def test_maps_travel_and_compare(passing):
    for one, other in zip(values_of(passing), values_of(passing)):
        assert pickle.loads(pickle.dumps(one)) == one == other
        assert one != values_of(passing[1:])[0]


def test_maps_become_xarray(passing):
    pytest.importorskip("xarray")
    found, ranges, angles, labels = values_of(passing)
    assert found.to_xarray().dims == ("time", "velocity") and ranges.to_xarray().dims == ("time", "range")
    assert angles.to_xarray().attrs["units"] == "W" and angles.to_xarray().azimuth.attrs["units"] == "rad"
    assert np.shares_memory(found.to_xarray().values, found.power)
    assert labels.to_xarray().dominant.attrs["names"] == ["ball"]


def test_maps_are_drawn(passing):
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    for one, label in zip(values_of(passing), ("velocity", "Range", "Azimuth", "velocity")):
        ax = one.plot(title="Mine")
        assert ax.get_title() == "Mine" and ax.get_xlabel() == "Time in s" and label in ax.get_ylabel()
        pyplot.close(ax.figure)
    with pytest.raises(TypeError, match="ax: must be Matplotlib axes"):
        values_of(passing)[0].plot(ax="here")
