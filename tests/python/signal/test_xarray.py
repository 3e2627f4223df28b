"""Maps as xarray: named axes and units around the same numbers."""
import sys

import numpy as np
import pytest

import echopath as ep

RANGE, SPEED, AZIMUTH = 6.0, -2.0, 0.3  # of a plate that faces the radar
RANGE_CELL, SPEED_CELL = 0.15, 0.61  # m, m/s: an echo is in the nearest one
AZIMUTH_ERROR = 0.01                 # rad: of the nearest beam of the grid; 3e-3 found


@pytest.fixture(scope="module")
def radar():
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, sampling_rate=10e6, num_chirps=32,
                              chirp_interval=1e-4)
    half_wave = 0.5 * chirps.wavelength
    return ep.Radar(chirps, transmitters=[ep.Antenna(), ep.Antenna((0.0, 4 * half_wave, 0.0))],
                    receivers=[ep.Antenna((0.0, index * half_wave, 0.0)) for index in range(4)])


@pytest.fixture(scope="module")
def spectrum(radar):
    direction = np.array([np.cos(AZIMUTH), np.sin(AZIMUTH), 0.0])
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="plate", material=ep.Material(reflectivity=0.5, scattering=1.0),
              position=RANGE * direction, yaw=AZIMUTH + np.pi, motion=ep.LinearMotion(velocity=SPEED * direction))
    return ep.range_doppler(ep.synthesize(ep.trace(scene, radar, num_rays=2000)), radar)


def test_a_target_is_found_by_the_names_of_the_axes(spectrum, radar):
    power = abs(spectrum.to_xarray()).mean(("tx", "rx"))
    peak = power.where(power == power.max(), drop=True)
    assert float(peak.range[0]) == pytest.approx(RANGE, abs=0.5 * RANGE_CELL)
    assert float(peak.velocity[0]) == pytest.approx(SPEED, abs=0.5 * SPEED_CELL)
    assert float(power.sel(range=RANGE, method="nearest").max()) > 0.5 * float(power.max())
    above = ep.range_azimuth(spectrum, radar).to_xarray()
    assert float(above.max("range").idxmax("azimuth")) == pytest.approx(AZIMUTH, abs=AZIMUTH_ERROR)


def test_values_axes_and_units_are_those_of_the_map(spectrum, radar):
    named = spectrum.to_xarray()
    assert named.dims == ("tx", "rx", "velocity", "range") and np.shares_memory(named.values, spectrum.values)
    assert np.array_equal(named.velocity, spectrum.velocity) and np.array_equal(named.range, spectrum.range)
    assert named.attrs["units"] == "sqrt(W)"
    assert (named.velocity.attrs["units"], named.range.attrs["units"]) == ("m/s", "m")
    above = ep.range_azimuth(spectrum, radar, combine="peak")
    named = above.to_xarray()
    assert named.dims == ("azimuth", "range") and np.shares_memory(named.values, above.power)
    assert np.array_equal(named.azimuth, above.azimuth) and "velocity" not in named.attrs
    assert (named.attrs["units"], named.azimuth.attrs["units"]) == ("W", "rad")
    at_rest = ep.range_azimuth(spectrum, radar, velocity=0.0).to_xarray()
    assert at_rest.attrs["velocity"] == pytest.approx(0.0, abs=0.5 * SPEED_CELL)


def test_without_xarray_the_message_says_what_to_install(spectrum, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ModuleNotFoundError, match=r"to_xarray needs xarray, .*: pip install 'echopath\[xarray\]'"):
        spectrum.to_xarray()


def test_angle_spectra_have_directions_as_axes(spectrum, radar):
    found = ep.angle_fft(spectrum, radar)
    named = found.to_xarray()
    assert named.dims == ("sin_elevation", "sin_azimuth", "velocity", "range") and np.shares_memory(named.values, found.values)
    peak = abs(named).max(("sin_elevation", "velocity", "range")).idxmax("sin_azimuth")
    assert float(peak) == pytest.approx(np.sin(AZIMUTH), abs=0.05)  # a quarter of a beam


def test_paths_are_a_dataset_of_their_columns(radar):
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(RANGE, 0, 0), yaw=np.pi,
              motion=ep.LinearMotion(velocity=(10.0 * SPEED, 0.0, 0.0)))
    paths = ep.trace(scene, radar, num_rays=500)
    named = paths.to_xarray()
    assert dict(named.sizes) == {"path": paths.num_paths, "hit": paths.num_hits}
    assert np.array_equal(named.weight, paths.weight) and np.array_equal(named.triangle_id, paths.triangle_id)
    assert named.attrs["mesh_names"] == ["plate"] and named.length.attrs["units"] == "m"
    in_the_middle = RANGE + 10.0 * SPEED * radar.middle_of_frame(0.0)
    assert float(named.length.min()) == pytest.approx(2.0 * in_the_middle, abs=1e-3)


def test_maps_over_time_take_a_cube_of_xarray(radar):
    xarray = pytest.importorskip("xarray")
    cube = np.random.default_rng(1).normal(size=(2, 4, 32, 128)) + 0j
    named = xarray.DataArray(cube, dims=("tx", "rx", "chirp", "sample"))
    for over_time in (ep.spectrogram, ep.range_time, ep.angle_time):
        np.testing.assert_array_equal(over_time(named, radar).power, over_time(cube, radar).power)
