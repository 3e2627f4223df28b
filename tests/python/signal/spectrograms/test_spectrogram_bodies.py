"""Velocity, range and azimuth over time of bodies that move; the maps as values."""
import copy
import pickle

import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar
from support.signals.tones import random_cube, tone

HANN_LOSS = 0.7205   # of a point half-way between two cells: 1.42 dB (Harris 1978, table 1)
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
    few = ep.spectrogram_labels(parts, noise_margin_db=-20.0, dynamic_range_db=24.0)
    assert np.array_equal(few.mask, few.whole >= 10.0 ** -2.4 * few.whole.max()) and 0 < few.mask.sum() < labels.mask.sum()
    without = ep.spectrogram_labels(parts)
    assert np.array_equal(without.whole, parts["slow"].power + parts["fast"].power)
    with pytest.raises(ValueError, match="parts: must all have the same times, which 'b' has not"):
        ep.spectrogram_labels({"a": parts["slow"], "b": ep.spectrogram(fast, radar, window_length=64, hop=8)})


@pytest.mark.parametrize("has_whole", [False, True])
def test_labels_stay_as_they_are_where_a_spectrogram_is_turned_to_other_units(has_whole):
    radar = build_radar(num_chirps=128)
    part = ep.spectrogram(tone(radar, 3.0, 1.0, 1e-9), radar, window_length=64)
    labels = ep.spectrogram_labels({"part": part}, part if has_whole else None)
    kept = copy.deepcopy(labels)
    for values in (part.power, part.times, part.velocity, part.train, part.trains):
        values *= 3
    assert labels == kept


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
    assert labels.to_xarray().dominant_names.values.tolist() == ["ball"]


@pytest.mark.parametrize("engine", ["scipy", "h5netcdf"])
def test_maps_become_netcdf(passing, engine, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip(engine)
    for number, one in enumerate(values_of(passing)):
        one.to_xarray().to_netcdf(tmp_path / f"{number}.nc", engine=engine)
        with xarray.open_dataset(tmp_path / f"{number}.nc", engine=engine) as read:
            named = one.to_xarray()
            assert read.equals(named if isinstance(named, xarray.Dataset) else named.to_dataset())


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
