"""A file of paths is enough: other waveforms, windows and arrays see the target where it is."""
import numpy as np
import pytest

import echopath as ep

DISTANCE, AZIMUTH, SPEED = 9.0, np.radians(20.0), -3.0  # of a small plate in the middle of the frame
ANGLE_TOLERANCE = np.radians(1.0)  # of the phase centre of a plate whose points have random phases
WAVELENGTH = ep.speed_of_light / 77.5e9
ADDITIVITY = 1e-12  # of the whole
RANGE_CELL = 0.15   # m


def waveform(**changes):
    settings = {"start_frequency": 77e9, "bandwidth": 1e9, "num_samples": 128, "sampling_rate": 10e6, "num_chirps": 32,
                "chirp_interval": 100e-6} | changes
    return ep.ChirpSequence(**settings)


def radar(num_rx=1, **changes):
    receivers = [ep.Antenna((0.0, 0.5 * WAVELENGTH * index, 0.0)) for index in range(num_rx)]
    return ep.Radar(waveform(**changes), transmitters=[ep.Antenna()], receivers=receivers)


@pytest.fixture(scope="module")
def paths():
    direction = np.array([np.cos(AZIMUTH), np.sin(AZIMUTH), 0.0])
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.02, 0.02), name="plate", material=ep.Material(reflectivity=0.5, scattering=1.0),
              position=DISTANCE * direction, yaw=AZIMUTH + np.pi, motion=ep.LinearMotion(velocity=SPEED * direction))
    one = radar()
    return ep.trace(scene, one, num_rays=2000, start_time=-0.5 * one.frame_duration)


@pytest.fixture
def read_back(paths, tmp_path):
    """From the file alone: what it does not hold is lost."""
    paths.save(tmp_path / "paths.h5")
    return ep.Paths.load(tmp_path / "paths.h5")


OTHERS = {
    "more bandwidth": {"bandwidth": 3e9, "num_samples": 512},
    "less bandwidth": {"bandwidth": 3e8},
    "slower chirps": {"sampling_rate": 5e6},
    "more chirps": {"num_chirps": 80, "chirp_interval": 40e-6},
    "real samples": {"real": True, "num_samples": 256},
}


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("window", ["rect", "hann", ("chebyshev", 60)])
def test_another_waveform_and_window_see_the_target_at_its_place(paths, read_back, other, window):
    seen_by = radar(**OTHERS[other])
    cube = ep.synthesize(read_back, seen_by)
    assert np.array_equal(cube, ep.synthesize(paths, seen_by))
    spectrum = ep.range_doppler(cube, seen_by, window=window, zero_pad=2)
    power = np.abs(spectrum.values[0, 0]) ** 2
    row, column = np.unravel_index(power.argmax(), power.shape)
    wave = seen_by.waveform
    coupling = wave.centre_frequency * SPEED / wave.slope  # range that the speed adds
    cell = 0.5 * ep.speed_of_light / wave.bandwidth
    middle = paths.frame.start_time + 0.5 * seen_by.frame_duration  # of the other frame, not that of the trace
    assert spectrum.range[column] == pytest.approx(DISTANCE + SPEED * middle + coupling, abs=cell)
    step = 0.5 * wave.wavelength / (wave.num_chirps * wave.chirp_interval)
    assert spectrum.velocity[row] == pytest.approx(SPEED, abs=step)


def test_another_array_sees_the_direction(paths, read_back):
    seen_by = radar(num_rx=8)
    cube = ep.synthesize(read_back, seen_by)
    assert np.array_equal(cube, ep.synthesize(paths, seen_by))
    assert np.array_equal(cube[:, :1], ep.synthesize(paths))  # the first receiver is that of the trace
    above = ep.range_azimuth(ep.range_doppler(cube, seen_by), seen_by, combine="peak")
    row, column = np.unravel_index(above.power.argmax(), above.power.shape)
    assert above.azimuth[row] == pytest.approx(AZIMUTH, abs=ANGLE_TOLERANCE)
    assert above.range[column] == pytest.approx(DISTANCE, abs=2.0 * RANGE_CELL)


def test_parts_of_the_file_add_up_for_another_radar(read_back):
    seen_by = radar(num_rx=2, bandwidth=5e8)
    parts = ep.decompose(read_back, seen_by, {"near": "T 'plate' R & power > 1e-20"})
    whole = ep.synthesize(read_back, seen_by)
    assert np.linalg.norm(whole - sum(parts.values())) <= ADDITIVITY * np.linalg.norm(whole)
