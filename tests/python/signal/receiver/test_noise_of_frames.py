"""Thermal noise of frames in a row: of one seed, of its own for each start time, the same alone and among others."""
import numpy as np
import pytest

import echopath as ep

NUM_SAMPLES, NUM_CHIRPS = 64, 32
# Of the correlation of N independent circular Gaussian samples: its rms is 1 / sqrt(N).
MOST_CORRELATION = 5.0 / np.sqrt(NUM_SAMPLES * NUM_CHIRPS)


def make_radar() -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=0.5e9, num_samples=NUM_SAMPLES, sampling_rate=10e6,
                                num_chirps=NUM_CHIRPS, chirp_interval=50e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


def make_scene() -> ep.Scene:
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(9.0, 0.0, 0.0))
    return scene


def frame_at(start_time: float, **settings) -> ep.Frame:
    return ep.simulate(make_scene(), make_radar(), num_rays=200, guard=False, start_time=start_time, **settings)


def noise_of(frame) -> np.ndarray:
    return (frame.noisy_cube - frame.cube).ravel()


def correlation(one, other) -> float:
    return abs(np.vdot(one, other)) / (np.linalg.norm(one) * np.linalg.norm(other))


def test_frames_in_a_row_have_noise_of_their_own():
    times = [0.0, 0.1, 0.2, np.nextafter(0.2, 1.0), -0.1]
    noises = [noise_of(frame_at(time)) for time in times]
    for index, noise in enumerate(noises):
        assert all(correlation(noise, other) < MOST_CORRELATION for other in noises[:index])
        assert np.isclose(np.mean(np.abs(noise) ** 2), np.mean(np.abs(noises[0]) ** 2), rtol=0.2)


def test_a_frame_is_the_same_alone_and_after_others():
    alone = frame_at(0.2)
    row = [frame_at(time) for time in (0.0, 0.1, 0.2)]
    assert np.array_equal(alone.noisy_cube, row[2].noisy_cube)
    assert np.array_equal(alone.spectrum.values, row[2].spectrum.values)


def test_another_seed_is_other_noise_at_the_same_time():
    one, other = (noise_of(frame_at(0.1, noise_seed=seed)) for seed in (1, 2))
    assert correlation(one, other) < MOST_CORRELATION


def test_noise_added_by_hand_is_that_of_the_frame(tmp_path):
    frame = frame_at(0.3, noise_seed=11)
    cube = ep.add_noise(frame.cube, frame.radar, seed=11, start_time=frame.paths.frame.start_time)
    assert np.array_equal(cube, frame.noisy_cube)
    ep.save_frame(frame, tmp_path / "frame.h5")
    assert np.array_equal(ep.load_frame(tmp_path / "frame.h5").noisy_cube, frame.noisy_cube)


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_a_frame_that_starts_at_zero_has_the_noise_of_the_bare_seed(zero):
    cube, radar = np.zeros((1, 1, NUM_CHIRPS, NUM_SAMPLES), complex), make_radar()
    assert np.array_equal(ep.add_noise(cube, radar, seed=3, start_time=zero), ep.add_noise(cube, radar, seed=3))


NOISY = ep.Radar(ep.ChirpSequence(num_samples=64, num_chirps=64, sampling_rate=5e6), transmitters=[ep.Antenna()],
                 receivers=[ep.Antenna()], noise_figure_db=7.0)
OF_SAMPLE = 1.380649e-23 * 290.0 * 10 ** 0.7 * 5e6  # W, k T0 F fs


@pytest.mark.parametrize("window, bandwidth", [("rect", 1.0), ("hann", 1.5)])  # in cells, Harris (1978), table 1
def test_noise_power_of_a_cell_is_that_of_a_sample_over_all_samples_times_the_bandwidths(window, bandwidth):
    wanted = OF_SAMPLE * bandwidth**2 / 64**2
    assert ep.noise_power(NOISY, of="sample") == pytest.approx(OF_SAMPLE, rel=1e-6)
    assert ep.noise_power(NOISY, window) == pytest.approx(wanted, rel=0.05)  # a window of 64 points, not an endless one


@pytest.mark.parametrize("window", ["rect", "hann", ("rect", "hann")])
def test_noise_power_is_the_mean_over_a_map_of_noise(window):
    cube = ep.add_noise(np.zeros((1, 1, 64, 64)), NOISY, seed=1)
    assert np.mean(np.abs(cube) ** 2) == pytest.approx(ep.noise_power(NOISY, of="sample"), rel=0.06)  # 4096 draws
    of_map = np.mean(np.abs(ep.range_doppler(cube, NOISY, window=window).values) ** 2)
    assert of_map == pytest.approx(ep.noise_power(NOISY, window), rel=0.06)
