"""Slips of units: what no radar can be is refused, what is unlikely is warned of once, at the line of the caller."""
import warnings

import numpy as np
import pytest

import echopath as ep

CHIRPS = ep.ChirpSequence(num_samples=16, num_chirps=4)


def _radar(**settings):
    return ep.Radar(CHIRPS, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, 0.01, 0))], **settings)


def _scene(scale=1.0, name="car"):
    scene = ep.Scene()
    block = ep.actors.box((4.0 * scale, 1.8 * scale, 1.5 * scale))
    scene.add(block, name=name, material="metal", position=(30.0, 0.0, 0.0))
    return scene


CARRIER = r"must be a finite number from 1000000 to 1e\+14 Hz \(77 GHz are 77e9\)"


@pytest.mark.parametrize("make, says", [
    (lambda: ep.ChirpSequence(start_frequency=77), r"^start_frequency: must be at least 1e6 Hz \(77 GHz are 77e9\), got 77"),
    (lambda: ep.rcs(_scene(), frequency=77, incidence=(1, 0, 0)), rf"^frequency: {CARRIER}, got 77$"),
    (lambda: ep.sheet_coefficients(ep.materials["glass_pane"], frequency=77, incidence=0.1), rf"^frequency: {CARRIER}, got 77$"),
    (lambda: ep.load_model("town.obj", frequency=77), rf"^frequency: {CARRIER}, got 77$"),
    (lambda: _radar(transmit_power=1e300), "^transmit_power: must be at most 1e30 W"),
    (lambda: _radar(noise_figure_db=1e300), "^noise_figure_db: must be at most 1000 dB"),
    (lambda: _radar(speed=3e8), "^speed: must be below the speed of light"),
    (lambda: ep.LinearMotion(velocity=(0, -4e8, 0)), "^velocity: must be below the speed of light"),
    (lambda: ep.KeyframeMotion([0, 1e-6], [[0, 0, 0], [1000, 0, 0]]), "^translations: must be below the speed of light"),
    (lambda: _scene().add(ep.actors.plate(1, 1), name="b", material="metal", speed=1e9), "must be below the speed of light"),
])
def test_what_cannot_be_is_refused(make, says):
    with pytest.raises(ValueError, match=says):
        make()


@pytest.mark.parametrize("make, says", [
    (lambda: _radar(yaw=90), r"^yaw: 90 rad are 14\.3239 turns; angles are in rad, 90 degrees would be 1\.5708"),
    (lambda: ep.Antenna(yaw=-45), "^yaw: -45 rad are"),
    (lambda: _scene().add(ep.actors.plate(1, 1), name="b", material="metal", yaw=180), "^yaw: 180 rad are"),
    (lambda: ep.ChirpSequence(start_frequency=77e6), r"^bandwidth: 1e\+09 Hz is more than start_frequency, 7\.7e\+07 Hz"),
    (lambda: ep.ChirpSequence(bandwidth=1), "^bandwidth: 1 Hz makes range cells of 149896 km"),
    (lambda: ep.ChirpSequence(bandwidth=4000), "^bandwidth: 4000 Hz makes range cells of 37.4741 km"),  # 4 GHz in MHz
    (lambda: ep.ChirpSequence(chirp_interval=60), "^chirp_interval: 60 s from chirp to chirp"),
    (lambda: ep.trace(_scene(1000.0), _radar(position=(-9e3, 0, 0)), num_rays=100), "^scene: 'car' is 4,000 m long .* mm"),
    (lambda: ep.trace(_scene(1e-4), _radar(), num_rays=100), "^scene: 'car' is 0.0004 m large, less than half a wavelength"),
    (lambda: ep.trace(ep.Scene(), _radar(), num_rays=100), "^scene: has no mesh that takes part"),
])
def test_what_is_unlikely_is_warned_of_once(make, says):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        make()
    assert [one.category for one in caught] == [RuntimeWarning] and caught[0].filename == __file__
    with pytest.warns(RuntimeWarning, match=says):
        make()


def test_a_node_that_is_turned_by_degrees_is_warned_of():
    scene = _scene()
    with pytest.warns(RuntimeWarning, match="^yaw: 90 rad"):
        scene["car"].yaw = 90


def test_what_is_likely_passes_without_a_word():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.trace(_scene(), _radar(yaw=-np.pi, position=(-5, 0, 0), speed=30), num_rays=100)
        ep.ChirpSequence(start_frequency=24e9, bandwidth=250e6, chirp_interval=1e-3)
        mountains = ep.Mesh([[-5e3, -5e3, -100], [5e3, -5e3, -100], [5e3, 5e3, -100], [-5e3, 5e3, -100], [3e3, 0, 800]],
                            [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
        terrain = ep.Scene()
        terrain.add(mountains, name="terrain", material=ep.Material(reflectivity=0.1, scattering=1.0))
        ep.trace(terrain, _radar(), num_rays=100)
        ground = ep.Scene()
        ground.add(ep.actors.wall(5000.0, 30.0), name="cliff", material="concrete", position=(100, 0, 0), yaw=np.pi / 2)
        ep.trace(ground, _radar(), num_rays=100)


@pytest.mark.parametrize("make, says", [
    (lambda: ep.Isotropic(100), "^gain: must be at most 1, .*, got 100"),
    (lambda: ep.CosinePower(2, peak_gain=100), r"^peak_gain: must be at most .* 2 \(exponent \+ 1\) = 6, got 100"),
    (lambda: ep.GaussianBeam(azimuth=1, elevation=0.5, peak_gain=100), "^peak_gain: .* without losses, 22.*, got 100"),
    (lambda: ep.GainTable(azimuth=[-3.1, 3.1], elevation=[-1.5, 1.5], gain=np.full((2, 2), 100.0)), "^gain: .*at most 1.02"),
])
def test_no_antenna_radiates_more_than_it_is_fed(make, says):
    with pytest.raises(ValueError, match=says):
        make()


def test_lossless_antennas_are_accepted():
    assert ep.CosinePower(2, peak_gain=6.0) == ep.CosinePower(2) and ep.Isotropic(1.0).efficiency == 1.0


@pytest.mark.parametrize(("given", "message"), [
    ({"start_frequency": 1e30}, "^start_frequency: must be at most 1e14 Hz"),
    ({"start_frequency": 77e6, "bandwidth": 1e30}, "^bandwidth: must leave frequencies up to 1e14 Hz"),
    ({"frequency_steps": [0.0, 1e20]}, "^frequency_steps: must leave frequencies up to 1e14 Hz"),
    ({"frequency_steps": [0.0, 1.0 - 76e9]}, "^frequency_steps: must leave frequencies from 1e6 Hz on"),
    ({"bandwidth_steps": [0.0, 1e20]}, "^bandwidth_steps: must leave frequencies up to 1e14 Hz"),
    ({"bandwidth": 1e-300}, "^bandwidth: must be at least 1e-3 Hz"),
    ({"sampling_rate": 1e300}, "^sampling_rate: must be at most 1e14 Hz"),
    ({"chirp_interval": 1e300}, "^chirp_interval: must be at most 1e6 s"),
    ({"extra_idle": [0.0, 1e300]}, "^extra_idle: must be at most 1e6 s"),
])
def test_frequencies_that_no_radar_has_are_refused(given, message):
    """At 1e30 Hz the signal of a plate was 1e58 sqrt(W), at 1e300 Hz NaN."""
    with pytest.raises(ValueError, match=message):
        ep.ChirpSequence(**{"start_frequency": 76e9, "bandwidth": 1e9, **given})


def test_chirps_may_sweep_more_than_their_start():
    """Echoes of chirps from 1 to 3 GHz are where the plate is: radars that look through walls sweep so."""
    with pytest.warns(RuntimeWarning, match="bandwidth: 2e.09 Hz is more than start_frequency"):
        waveform = ep.ChirpSequence(start_frequency=1e9, bandwidth=2e9, num_samples=256, sampling_rate=5e6, num_chirps=1)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
    scene = ep.Scene()
    scene.add(ep.actors.plate(2, 2), name="plate", material="metal", position=(6, 0, 0))
    spectrum = ep.range_doppler(ep.synthesize(ep.trace(scene, radar, num_rays=5000), radar), radar)
    assert spectrum.range[np.abs(spectrum.values[0, 0, 0]).argmax()] == pytest.approx(6.0, abs=waveform.range_resolution)


def test_a_function_of_actors_is_told_to_be_called():
    with pytest.raises(TypeError, match=r"a Model, a list of \(name, Mesh\) or None; car\(\) makes one, got <function car"):
        ep.Scene().add(ep.actors.car, name="car")
