"""Weather: attenuation to the digits that recommendations print, echoes of rain to the radar equation of a volume."""
import math
import pickle

import numpy as np
import pytest
import scipy.integrate
import scipy.special

import echopath as ep
from echopath.arguments.effects import ATTENUATION, RAIN_ECHOES
from echopath.signals import rain_echoes
from echopath.weather import drops, fog, gas, rain
from echopath.weather.weather import DB_PER_NEPER
from support.files.scene_text import ANTENNAS, WAVEFORM
from support.radars import build_radar

WET = ep.Weather(rain_mm_per_hour=20.0)
NOISE_BANDWIDTH = 2.0044  # of the Blackman-Harris window, cells

# k_H, alpha_H, k_V, alpha_V as Recommendation ITU-R P.838-3 prints them in table 5.
PRINTED = {1: ("0.0000259", "0.9691", "0.0000308", "0.8592"), 10: ("0.01217", "1.2571", "0.01129", "1.2156"),
           20: ("0.09164", "1.0568", "0.09611", "0.9847"), 40: ("0.4431", "0.8673", "0.4274", "0.8421"),
           60: ("0.8606", "0.7656", "0.8515", "0.7486"), 80: ("1.1704", "0.7115", "1.1668", "0.7021"),
           100: ("1.3671", "0.6815", "1.3680", "0.6765")}


@pytest.mark.parametrize("frequency_ghz", PRINTED)
def test_coefficients_of_rain_are_those_that_are_printed(frequency_ghz):
    found = [*rain.coefficients(1e9 * frequency_ghz, "h"), *rain.coefficients(1e9 * frequency_ghz, "v")]
    for value, text in zip(found, PRINTED[frequency_ghz]):
        assert f"{value:.{len(text) - 2}f}" == text


def test_rain_between_both_polarisations_mixes_their_coefficients():
    h, v, both = (rain.rain_attenuation(77e9, 25.0, tilt) for tilt in (0.0, math.pi / 2, math.pi / 4))
    (k_h, a_h), (k_v, a_v) = rain.coefficients(77e9, "h"), rain.coefficients(77e9, "v")
    assert h == pytest.approx(k_h * 25.0**a_h, rel=1e-12) and v == pytest.approx(k_v * 25.0**a_v, rel=1e-12)
    assert min(h, v) < both < max(h, v)
    assert rain.rain_attenuation(77e9, 0.0, 0.0) == 0.0


# Frequency in GHz, rain in mm/h, elevation of the path in degrees, dB/km: P.838-3 in the validation examples of study group 3 of
# ITU-R (CG-3M3J-13-ValEx, revision 5.1), horizontal polarisation.
RAIN_EXAMPLES = [(14.25, 26.480520, 31.076991, "1.581308"), (14.25, 33.936232, 40.232036, "2.061732"),
                 (29.0, 26.480520, 31.076991, "5.021802"), (29.0, 27.135868, 46.359693, "5.031355")]


@pytest.mark.parametrize("frequency_ghz, rate, elevation, text", RAIN_EXAMPLES)
def test_rain_takes_what_the_validation_examples_say(frequency_ghz, rate, elevation, text):
    """The recommendation mixes both polarisations by cos^2(elevation) cos(2 tilt): a level path has its elevation in the tilt."""
    tilt = 0.5 * math.acos(math.cos(math.radians(elevation))**2)
    assert f"{rain.rain_attenuation(1e9 * frequency_ghz, rate, tilt):.6f}" == text


# dB/km at 1013.25 hPa of dry air, 288.15 K and 7.5 g/m^3 by frequency in GHz: examples for P.676-12 in the same file.
GAS_EXAMPLES = {1: "0.005440", 5: "0.008714", 12: "0.018234", 20: "0.108931", 60: "14.778317", 90: "0.380843", 130: "0.793354"}


@pytest.mark.parametrize("frequency_ghz", GAS_EXAMPLES)
def test_gases_take_what_the_validation_examples_say(frequency_ghz):
    vapour = 7.5 * 288.15 / 216.7  # hPa: of g/m^3 and K, by the gas constant of water vapour
    assert f"{gas.gas_attenuation(1e9 * frequency_ghz, 288.15, 1013.25, vapour):.6f}" == GAS_EXAMPLES[frequency_ghz]


def test_the_air_is_saturated_as_tables_of_steam_say():
    """611.2 Pa at the triple point, 2339 Pa at 20 degrees Celsius over water, .4 % more in air."""
    assert gas.saturation_pressure(273.15, 1013.25) == pytest.approx(6.1121 * 1.0039, rel=1e-3)
    assert gas.saturation_pressure(293.15, 1013.25) == pytest.approx(23.39 * 1.004, rel=2e-3)


@pytest.mark.parametrize("humidity", [0.0, 0.5, 1.0])
def test_vapour_is_a_part_of_the_pressure_of_the_air(humidity):
    """Dalton: what 1013.25 hPa has beside the vapour, which has 611.2 and 2339 Pa times 1.004 at saturation, is dry."""
    for temperature, saturated in ((273.15, 6.1121 * 1.0039), (293.15, 23.39 * 1.004)):
        radar = build_radar(start_frequency=60e9, bandwidth=1e9)
        found = ep.Weather(humidity=humidity, temperature=temperature).attenuation_db_per_km(radar)["gases"]
        vapour, frequency = humidity * saturated, radar.waveform.centre_frequency
        assert found == pytest.approx(gas.gas_attenuation(frequency, temperature, 1013.25 - vapour, vapour), rel=3e-4)


def test_drops_fall_as_fast_as_was_measured():
    """Gunn and Kinzer 1949: 4.03, 6.49, 8.06 and 9.09 m/s of 1, 2, 3 and 5 mm in still air at the ground."""
    assert drops.fall_speeds([1.0, 2.0, 3.0, 5.0]) == pytest.approx([4.03, 6.49, 8.06, 9.09], abs=0.12)


def test_rain_weakens_its_own_echoes_there_and_back():
    """The radar equation of a volume has e^{-4 a r} / r^2 of fields that lose a Np/m, from half a metre to the last range."""
    radar, loss = build_radar(), 0.02
    reached = [scipy.integrate.quad(lambda r: np.exp(-4.0 * a * r) / r**2, rain_echoes.NEAREST, radar.waveform.max_range)[0]
               for a in (loss, 0.0)]
    found = [rain_echoes.rain_power(radar, ep.Weather(rain_mm_per_hour=20.0), a) for a in (loss, 0.0)]
    assert found[0] / found[1] == pytest.approx(reached[0] / reached[1], rel=1e-4)


def test_fog_absorbs_as_small_drops_of_water_do():
    """Rayleigh: 6 pi/lambda Im((eps - 1)/(eps + 2)) of the share of the volume that is water, in field attenuation."""
    for temperature in (273.15, 293.15):
        permittivity = fog.water_permittivity(77e9, temperature)
        loss = -((permittivity - 1) / (permittivity + 2)).imag
        nepers = 3 * math.pi * 77e9 / ep.speed_of_light * loss * 1e-6
        assert fog.fog_attenuation(77e9, 1.0, temperature) == pytest.approx(1e3 * DB_PER_NEPER * nepers, rel=2e-3)


def measured_permittivity(frequency, temperature):
    """Of pure water, -20 to 40 degrees Celsius and up to 340 GHz: Meissner and Wentz 2004, table III."""
    f, t = 1e-9 * frequency, temperature - 273.15
    static, between = (3.70886e4 - 82.168 * t) / (421.854 + t), 5.7230 + 2.2379e-2 * t - 7.1237e-4 * t**2
    first = (45.0 + t) / (5.0478 - 7.0315e-2 * t + 6.0059e-4 * t**2)
    second, infinite = (45.0 + t) / (0.13652 + 1.4825e-3 * t + 2.4166e-4 * t**2), 3.6143 + 2.8841e-2 * t
    return (static - between) / (1 + 1j * f / first) + (between - infinite) / (1 + 1j * f / second) + infinite


@pytest.mark.parametrize("temperature", [273.15, 283.15, 303.15])
def test_water_has_the_permittivity_that_was_measured(temperature):
    for frequency in (5e9, 24e9, 77e9, 140e9):
        assert fog.water_permittivity(frequency, temperature) == pytest.approx(
            measured_permittivity(frequency, temperature), rel=0.025)


def slow_mie(size, index):
    """Efficiencies (backscatter, extinction) by Bessel functions of complex argument."""
    n = np.arange(1, int(size + 4 * size**(1 / 3) + 3))
    inside = index.conjugate() * size

    def riccati(function, z):
        return z * function(n, z), function(n, z) + z * function(n, z, derivative=True)

    psi, d_psi = riccati(scipy.special.spherical_jn, size)
    chi, d_chi = riccati(scipy.special.spherical_yn, size)
    xi, d_xi = psi + 1j * chi, d_psi + 1j * d_chi
    psi_in, d_psi_in = riccati(scipy.special.spherical_jn, inside)
    m = index.conjugate()
    a = (m * psi_in * d_psi - psi * d_psi_in) / (m * psi_in * d_xi - xi * d_psi_in)
    b = (psi_in * d_psi - m * psi * d_psi_in) / (psi_in * d_xi - m * xi * d_psi_in)
    return (abs(np.sum((2 * n + 1) * (-1.0)**n * (a - b)))**2 / size**2,
            2 * np.sum((2 * n + 1) * (a + b).real) / size**2)


@pytest.mark.parametrize(("size", "index"), [(0.05, 3.0 - 1.5j), (0.8, 3.2 - 1.8j), (3.0, 3.2 - 1.8j), (9.0, 1.33 - 1e-3j)])
def test_drops_scatter_as_mie_says(size, index):
    assert drops.mie_sums(size, index) == pytest.approx(slow_mie(size, index), rel=1e-6)


def test_the_series_has_the_published_extinction():
    """Wiscombe 1979, m = 1.5 - j: 2.336321 at x = 1, 2.097502 at x = 100."""
    assert drops.mie_sums(1.0, 1.5 - 1j)[1] == pytest.approx(2.336321, rel=1e-6)
    assert drops.mie_sums(100.0, 1.5 - 1j)[1] == pytest.approx(2.097502, rel=1e-6)


def test_rain_scatters_back_what_was_measured():
    """70 GHz: 4.2e-5 R^1.1 per m (Currie, Dyer, Hayes 1975, quoted from memory), within 3 dB from 5 to 30 mm/h."""
    for rate in (5.0, 10.0, 30.0):
        found = drops.reflectivities(70e9, rate, 288.15).sum()
        assert abs(10 * math.log10(found / (4.2e-5 * rate**1.1))) < 3.0


def test_drops_take_about_what_the_recommendation_says():
    for rate in (2.0, 10.0, 50.0):
        decibels = 1e4 / math.log(10.0) * drops.per_volume(77e9, rate, 288.15)[1].sum()  # per km
        assert decibels == pytest.approx(rain.rain_attenuation(77e9, rate, 0.0), rel=0.4)


def ball_scene(weather=None):
    scene = ep.Scene(weather=weather)
    scene.add(ep.Mesh([[40, -1, -1], [40, 1, -1], [40, 0, 1]], [[0, 1, 2]]), name="plate", motion=ep.LinearMotion((2.0, 0, 0)),
              material=ep.Material(reflectivity=0.5, scattering=0.8))
    return scene


@pytest.mark.parametrize("settings", [{}, {"evaluate": "chirps"}, {"evaluate": "samples"}, {"replay": "fermat"}])
def test_echoes_are_weakened_along_their_whole_way(settings):
    radar, still = build_radar(num_chirps=16, num_samples=256, bandwidth=250e6), {}
    for weather in (None, WET):
        paths = ep.trace(ball_scene(weather), radar, num_rays=200)
        still[weather] = ep.synthesize(paths, radar, tolerance=1e-10, **settings), paths
    (dry, dry_paths), (wet, wet_paths) = still[None], still[WET]
    attenuation = 1e-3 * sum(WET.attenuation_db_per_km(radar).values()) / DB_PER_NEPER
    assert wet_paths.frame.attenuation == attenuation and dry_paths.frame.attenuation == 0.0
    lengths = wet_paths.lengths([wet_paths.frame.trace_time], 0, 0)[0]
    assert wet_paths.amplitude == pytest.approx(dry_paths.amplitude * np.exp(-attenuation * lengths), rel=1e-9)
    spread = attenuation * (lengths.max() - lengths.min())
    factor = np.vdot(dry, wet) / np.vdot(dry, dry)
    assert factor == pytest.approx(math.exp(-attenuation * lengths.mean()), abs=spread + 1e-4)


def test_without_weather_not_a_bit_differs():
    radar = build_radar(num_chirps=8, bandwidth=200e6)  # 48 m
    paths = [ep.trace(ball_scene(weather), radar, num_rays=500, effects=effects)
             for weather, effects in ((None, {}), (WET, {ATTENUATION: False}))]
    signals = [ep.synthesize(one, radar) for one in paths]
    assert signals[0].any() and np.array_equal(*signals) and np.array_equal(paths[0].weight, paths[1].weight)


def rain_radar():
    return build_radar(num_chirps=32, num_samples=128, bandwidth=150e6,
                       transmitters=[ep.Antenna(pattern=ep.CosinePower(exponent=6.0))],
                       receivers=[ep.Antenna(pattern=ep.CosinePower(exponent=6.0))])


def test_rain_has_the_power_of_the_radar_equation_in_each_range():
    """Of a volume: Pt lambda^2 eta/((4 pi)^3 r^2) dr times the integral of both gains, e^{-4 a r}."""
    radar, scene, seeds = rain_radar(), ep.Scene(weather=WET), range(6)
    maps = [ep.range_doppler(rain_echoes.rain_cube(scene, radar, start_time=0.0, seed=seed), radar, window="blackman_harris")
            for seed in seeds]
    power = np.mean([np.sum(np.abs(one.values[0, 0])**2, 0) for one in maps], 0) / NOISE_BANDWIDTH**2
    ranges = maps[0].range
    pattern = radar.transmitters[0].pattern
    angle = np.linspace(0, math.pi / 2, 20001)
    gains = np.array([pattern.gain(math.cos(one)) for one in angle[::20]])
    solid = 2 * math.pi * np.trapezoid(gains**2 * np.sin(angle[::20]), angle[::20])
    attenuation = 1e-3 * sum(WET.attenuation_db_per_km(radar).values()) / DB_PER_NEPER
    cells = slice(10, 110)
    r = ranges[cells]
    wavelength = ep.speed_of_light / radar.waveform.start_frequency
    truth = (radar.transmit_power * wavelength**2 * WET.rain_reflectivity(radar) / ((4 * math.pi)**3 * r**2) * solid
             * (ranges[1] - ranges[0]) * np.exp(-4 * attenuation * r))
    ratio = power[cells] / truth
    # Speckle: over 60 seeds six of them have standard deviations of 0.05, and of 0.08 and 0.1 in these thirds.
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.15)
    assert np.mean(ratio[:30]) == pytest.approx(1.0, abs=0.3) and np.mean(ratio[-30:]) == pytest.approx(1.0, abs=0.3)


@pytest.mark.parametrize("azimuth_deg, elevation_deg", [(10.0, 10.0), (1.8, 20.0), (2.0, 2.0), (0.5, 0.5)])
def test_rain_in_a_narrow_beam_has_the_power_of_the_radar_equation(azimuth_deg, elevation_deg):
    """The gains of two Gaussian beams, 16 ln 2 / (a e) at their peak, have the integral 32 pi ln 2 / (a e), and drops by
    themselves, without their phases, have no speckle."""
    widths = {"azimuth": math.radians(azimuth_deg), "elevation": math.radians(elevation_deg)}
    beam = ep.Antenna(pattern=ep.GaussianBeam(**widths))
    radar, weather = build_radar(num_chirps=1, transmitters=[beam], receivers=[beam]), WET
    solid = 32.0 * math.pi * math.log(2.0) / math.prod(widths.values())
    wavelength = ep.speed_of_light / radar.waveform.start_frequency
    density = radar.transmit_power * wavelength**2 * weather.rain_reflectivity(radar) * solid / (4.0 * math.pi)**3
    span = 1.0 / rain_echoes.NEAREST - 1.0 / radar.waveform.max_range
    # The sphere bends beams of 20 degrees, by 1 % of the integral.
    assert rain_echoes.rain_power(radar, weather, 0.0) == pytest.approx(density * span, rel=0.05)
    paths = rain_echoes.rain_paths(ep.Scene(weather=weather), radar, start_time=0.0, seed=1)
    lengths = paths.lengths([paths.frame.trace_time], 0, 0)[0]
    drops = np.abs(paths.amplitude)**2 * np.exp(2.0 * paths.frame.attenuation * lengths) * (0.5 * lengths)**2
    assert drops.sum() == pytest.approx(density * (radar.waveform.max_range - rain_echoes.NEAREST), rel=0.05)


def test_rain_speckles_and_moves_with_the_wind():
    radar = rain_radar()
    blown = WET.replace(wind=(5.0, 0, 0), turbulence=0.3)
    cube = rain_echoes.rain_cube(ep.Scene(weather=blown), radar, start_time=0.0, seed=1)
    first = np.abs(ep.range_doppler(cube, radar, window="rect").values[0, 0])**2
    velocity = ep.range_doppler(cube, radar).velocity
    mean = (first.sum(1) * velocity).sum() / first.sum()
    assert mean == pytest.approx(5.0 * 0.85, abs=0.6)  # along the beam, less toward its sides
    drops = rain_echoes._velocities(blown, np.full(20_000, 4.0), np.random.default_rng(1))
    assert drops.mean(axis=0) == pytest.approx([5.0, 0.0, -4.0], abs=0.01) and drops.std(axis=0) == pytest.approx(0.3, rel=0.02)
    one_chirp = np.abs(np.fft.fft(cube[0, 0], axis=-1))[:, 10:110]**2 * np.arange(10, 110)**2
    assert np.std(one_chirp) / np.mean(one_chirp) == pytest.approx(1.1, abs=0.3)  # 0.09 over seeds, and weaker far away


def rain_power(radar, start_time=0.0, **settings):
    """Mean over the cube, W."""
    cube = rain_echoes.rain_cube(ep.Scene(weather=WET), radar, start_time=start_time, seed=1, **settings)
    return np.mean(np.abs(cube) ** 2)


def test_rain_sends_back_the_polarisation_that_it_meets():
    """Spheres do: slanted antennas hear all of it, and those across them no more than the sides of a beam leave."""
    up = math.sqrt(0.5)
    slant, across = (ep.Antenna(pattern=ep.CosinePower(exponent=6.0), polarization=(0.0, y, up)) for y in (up, -up))
    whole = rain_power(rain_radar())
    alike, crossed = (rain_power(rain_radar().replace(transmitters=[slant], receivers=[one]), polarization="jones")
                      for one in (slant, across))
    assert alike == pytest.approx(whole, rel=0.02) and crossed < 0.02 * whole


def test_rain_is_before_a_radar_that_has_turned():
    turning = rain_radar().replace(motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 0.5 * math.pi)))
    # The speckle of a cube of some thousand cells varies by some percent.
    assert rain_power(turning, start_time=1.0) == pytest.approx(rain_power(rain_radar()), rel=0.2)


def test_each_frame_has_its_own_rain():
    """The correlation of the phases of N independent drops is 1 / sqrt(N)."""
    first, second = (np.angle(rain_echoes.rain_paths(ep.Scene(weather=WET), rain_radar(), start_time=time, seed=1).weight)
                     for time in (0.0, 0.05))
    assert abs(np.mean(np.exp(1j * (first - second)))) < 4.0 / math.sqrt(len(first))


def test_rain_behind_a_wall_is_not_seen():
    scene = ep.Scene(weather=WET)
    scene.add(ep.Mesh([[20, -80, -80], [20, 80, -80], [20, 80, 80], [20, -80, 80]], [[0, 1, 2], [0, 2, 3]]), name="wall",
              material="metal")
    paths = rain_echoes.rain_paths(scene, rain_radar(), start_time=0.0, seed=1)
    assert paths.points(paths.frame.trace_time)[:, 0].max() < 20.0


def test_a_frame_has_the_rain_in_its_map_alone(tmp_path):
    radar, scene = build_radar(num_chirps=16, bandwidth=100e6), ball_scene(WET)
    frames = [ep.simulate(scene, radar, num_rays=300, start_time=start, parts={"plate": "T 'plate' R"}) for start in (0.0, 0.05)]
    frame = frames[0]
    assert not np.array_equal(frames[0].rain_cube, frames[1].rain_cube)
    assert sum(frame.parts["parts"].values()) == pytest.approx(frame.cube, abs=1e-18)
    without = ep.simulate(scene, radar, num_rays=300, effects={RAIN_ECHOES: False})
    assert without.rain_cube is None and np.array_equal(without.cube, frame.cube)
    assert np.allclose(frame.noisy_cube - without.noisy_cube, frame.rain_cube, atol=1e-18)
    ep.save_frame(frame, tmp_path / "frame.h5")
    again = ep.load_frame(tmp_path / "frame.h5")
    assert np.array_equal(again.rain_cube, frame.rain_cube) and again.paths.frame.attenuation > 0
    assert np.array_equal(again.spectrum.values, frame.spectrum.values)


def effect(effects, name):
    return next(one for one in effects if one.name == name)


def test_effects_say_what_the_weather_takes_and_carries():
    radar = build_radar(num_chirps=4)
    assert effect(ep.effects(ball_scene(), radar), ATTENUATION).reason == "the scene has no weather"
    asked = ep.effects(ball_scene(WET), radar)
    assert effect(asked, ATTENUATION).modelled and "rain 9" in effect(asked, ATTENUATION).reason
    assert effect(asked, RAIN_ECHOES).modelled and "dBm" in effect(asked, RAIN_ECHOES).reason
    paths = ep.trace(ball_scene(WET), radar, num_rays=300)  # a record knows no weather but what it took from its fields
    assert "a record has none" in effect(paths.effects, RAIN_ECHOES).reason
    off = ep.effects(ball_scene(WET), radar, effects={RAIN_ECHOES: False, ATTENUATION: False})
    for name in (ATTENUATION, RAIN_ECHOES):
        assert not effect(off, name).modelled and "effects has" in effect(off, name).reason
    frame = ep.simulate(ball_scene(WET), radar, num_rays=100)
    assert effect(frame.effects, RAIN_ECHOES).modelled and "dB of the power" in effect(frame.effects, ATTENUATION).reason


@pytest.mark.parametrize("frequency", [0.3e9, 1.1e12])
def test_beyond_the_band_of_the_recommendations_nothing_is_told(frequency):
    radar = build_radar(num_chirps=4, start_frequency=frequency, bandwidth=1e6)
    for call in (WET.attenuation_db_per_km, lambda one: ep.trace(ball_scene(WET), one, num_rays=50)):
        with pytest.raises(ValueError, match="^radar: must be of 1e[+]09 to 1e[+]12 Hz for attenuation by weather"):
            call(radar)
    assert not effect(ep.effects(ball_scene(WET), radar, effects={ATTENUATION: False}), ATTENUATION).modelled


@pytest.mark.parametrize(("choices", "error", "text"), [
    ({"rain": True}, ValueError, "has no 'rain'"), ({RAIN_ECHOES: 2}, TypeError, "echoes of rain"),
    ("rain", TypeError, "effects: must be"), ({RAIN_ECHOES: True}, ValueError, "needs Scene.weather")])
def test_wrong_choices_are_refused(choices, error, text):
    with pytest.raises(error, match=text):
        ep.simulate(ball_scene(), build_radar(num_chirps=4), num_rays=50, effects=choices)


def test_weather_travels_with_its_scene():
    scene = ball_scene(WET)
    assert pickle.loads(pickle.dumps(scene)).weather == WET and scene.copy().weather == WET
    assert pickle.loads(pickle.dumps(WET)) == WET == WET.replace()
    with pytest.raises(ValueError, match=r"^wind: must be \[3\], each of at most 1000 m/s, got"):
        ep.Weather(wind=(0.0, -1e300, 0.0))
    with pytest.raises(ValueError, match="^humidity: "):
        ep.Weather(humidity=60)
    # Steam tables: at 322.15 K water boils at 117.5 hPa.
    ep.Weather(temperature=322.15, pressure=1e4, humidity=0.84)
    with pytest.raises(ValueError, match=r"^humidity: must be at most 0\.8[45]\d* at 322.15 K and 10000 Pa, .*, got 1"):
        ep.Weather(temperature=322.15, pressure=1e4, humidity=1.0)
    with pytest.raises(TypeError, match="weather"):
        scene.weather = {"rain": 3}


def test_sequences_have_rain_of_each_frame_and_folders_of_one_weather(tmp_path):
    radar = build_radar(num_chirps=4, bandwidth=100e6)
    scene = ball_scene(WET)
    frames = ep.Sequence(scene, radar, frames=2, interval=0.05, num_rays=200)
    frames.save(tmp_path, keep="all")
    stored = ep.load_sequence(tmp_path)
    for one, again in zip(frames, stored):
        assert np.array_equal(one.rain_cube, again.rain_cube)
    assert not np.array_equal(stored[0].rain_cube, stored[1].rain_cube)
    scene.weather = WET.replace(rain_mm_per_hour=5.0)
    with pytest.raises((ValueError, ep.FileError), match="weather"):
        ep.Sequence(scene, radar, frames=2, interval=0.05, num_rays=200).save(tmp_path, keep="all")


def test_scene_files_have_weather(tmp_path):
    (tmp_path / "wet.toml").write_text(WAVEFORM + ANTENNAS + "\n[weather]\nrain_mm_per_hour = 12\nwind = [1, 2, 0]\n[trace]\n"
                                       'effects = {"echoes of rain" = false}\n', encoding="utf-8")
    read = ep.load_scene(tmp_path / "wet.toml")
    assert read.scene.weather == ep.Weather(rain_mm_per_hour=12, wind=(1, 2, 0))
    assert read.trace.effects == ((RAIN_ECHOES, False),)


def test_rain_is_heard_by_every_pair_of_antennas_that_look_the_same_way():
    """Beams to the left and to the right in one radar: each hears what it does in a radar of its own, by the radar equation of a
    volume, and across nothing is heard, whichever stands first."""
    beams = [ep.Antenna((0, 0.01 * n, 0), yaw=side * np.pi / 2, pattern=ep.CosinePower(8)) for n, side in enumerate((1, -1))]
    scene = ep.Scene(weather=ep.Weather(rain_mm_per_hour=20.0, humidity=0.0))
    for receivers, heard in ((beams, np.eye(2)), (beams[::-1], 1.0 - np.eye(2))):
        radar = build_radar(transmitters=beams, receivers=receivers, num_samples=32, num_chirps=1, bandwidth=125e6)
        cubes = [rain_echoes.rain_cube(scene, radar, start_time=0.1 * frame, seed=1) for frame in range(2)]
        wavelength = ep.speed_of_light / radar.waveform.start_frequency
        solid = 18.0 ** 2 * 2.0 * np.pi / 17.0  # of a gain of 18 cos^8, squared
        expected = (radar.transmit_power * wavelength ** 2 * scene.weather.rain_reflectivity(radar) * solid / (4.0 * np.pi) ** 3
                    * (1.0 / rain_echoes.NEAREST - 1.0 / radar.waveform.max_range))
        assert rain_echoes.rain_power(radar, scene.weather, 0.0) == pytest.approx(expected, rel=0.05)
        powers = np.mean(np.abs(cubes) ** 2, axis=(0, 3, 4)) / expected
        np.testing.assert_allclose(10 * np.log10(powers[heard > 0.0]), 0.0, atol=4.0)  # speckle
        assert np.all(powers[heard == 0.0] < 1e-9)


def test_antennas_that_look_away_from_each_other_hear_no_rain():
    away = [ep.Antenna(yaw=side * np.pi / 2, pattern=ep.CosinePower(8)) for side in (1, -1)]
    radar = build_radar(transmitters=away[:1], receivers=away[1:], num_chirps=2)
    assert not rain_echoes.rain_cube(ep.Scene(weather=WET), radar, start_time=0.0, seed=1).any()
    assert rain_echoes.rain_power(radar, WET, 0.0) == pytest.approx(0.0, abs=1e-30)
