"""Range-Doppler maps: places, levels, windows and noise against closed forms and NumPy."""
import pickle

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath._core import main_lobe_half_width
from echopath.spectra.windows import samples_of
from support.radars import build_radar

C = 299792458.0
CELL = 1 / 8          # of a cell without padding: half of one of a map padded to four times
SAMPLED_DB = 0.1      # four maps of noise are known to 0.01 dB, the peak to the rounding of its cell
SAMPLED = 0.02        # relative: 2.6e5 cells of noise, neighbours alike; 0.2 % found
ROUNDING = 1e-12


def radar_of(num_chirps=128, num_tx=1, **settings):
    return build_radar([(0, 0, 0)] * num_tx, num_samples=512, num_chirps=num_chirps, chirp_interval=30e-6, **settings)


def moving_point(radar, distance, speed, amplitude=1.0):
    """Cube of a point at `distance` in the middle of the frame."""
    waveform = radar.waveform
    t = (np.arange(waveform.num_chirps) - waveform.num_chirps / 2) * waveform.chirp_interval
    delays = 2 * (distance + speed * t[:, None]) / C
    return _core.synthesize_echoes(waveform, delays, np.full(delays.shape, amplitude, complex))[None, None]


@pytest.mark.parametrize("real", (False, True))
def test_map_shows_a_point_where_it_is(real):
    radar = radar_of(real=real)
    result = ep.range_doppler(moving_point(radar, 20.0, 10.0), radar, window="hann", zero_pad=4)
    assert result.values.shape == (1, 1, 512, 1024 if real else 2048)
    velocity, distance = np.unravel_index(np.abs(result.values[0, 0]).argmax(), result.values.shape[2:])
    assert result.velocity[velocity] == pytest.approx(10.0, abs=CELL * 0.5037)
    # Range-Doppler coupling: a receding target looks farther by f v / slope.
    assert result.range[distance] == pytest.approx(20.0 + 77.5e9 * 10.0 / radar.waveform.slope, abs=CELL * 0.1499)
    # An eighth of a bin off the peak costs a Hann window 2 % on each axis.
    assert 0.96 < np.abs(result.values).max() ** 2 < 1.0001


def test_peak_over_noise_is_the_radar_equation():
    """R = 50 m, 1 m^2, 10 mW, 10 dBi: 18.00 dB in one bin without taper."""
    radar = radar_of()
    power = 10 ** (-119.128 / 10) / 1000
    bin_of_map = 2 * 50.0 / C * radar.waveform.slope / 20e6 * 512
    distance = 50.0 * round(bin_of_map) / bin_of_map
    cube = moving_point(radar, distance, 0.0, np.sqrt(power))
    peak = np.abs(ep.range_doppler(cube, radar, window="rect").values).max() ** 2
    empty = np.zeros_like(cube)
    noisy = [ep.range_doppler(ep.add_noise(empty, radar, seed=seed), radar, window="rect") for seed in range(4)]
    noise = np.mean([np.abs(result.values) ** 2 for result in noisy])
    assert 10 * np.log10(peak / noise) == pytest.approx(18.00, abs=SAMPLED_DB)


@pytest.mark.parametrize("window, bandwidth", [("hann", 1.5), (("chebyshev", 100), 1.9441)])
def test_noise_of_a_map_follows_the_noise_bandwidth(window, bandwidth):
    radar = radar_of(num_chirps=512)
    noise = ep.add_noise(np.zeros((1, 1, 512, 512)), radar, seed=3)
    level = np.mean(np.abs(ep.range_doppler(noise, radar, window=window).values) ** 2)
    assert level / (_core.noise_power(radar) * bandwidth**2 / 512**2) == pytest.approx(1.0, abs=SAMPLED)


def test_map_equals_numpy():
    radar = radar_of(num_chirps=16, num_tx=2)
    random = np.random.default_rng(2)
    cube = random.normal(size=(2, 1, 16, 512)) + 1j * random.normal(size=(2, 1, 16, 512))
    samples, chirps = _core.window("chebyshev", 512, 60), _core.window("chebyshev", 16, 60)
    expected = np.fft.fft2(cube * chirps[:, None] * samples, s=(32, 1024)) / samples.sum() / chirps.sum()
    result = ep.range_doppler(cube, radar, window=("chebyshev", 60), zero_pad=2)
    np.testing.assert_allclose(result.values, np.fft.fftshift(expected, axes=2), rtol=0, atol=1e-13)
    spacing = C / (2 * 77.5e9 * 32 * 2 * 30e-6)
    np.testing.assert_allclose(result.velocity, (np.arange(32) - 16) * spacing, rtol=ROUNDING, atol=ROUNDING)
    np.testing.assert_allclose(result.range, np.arange(1024) * C / 4e9, rtol=ROUNDING)


PAIR = ("hann", ("chebyshev", 60))  # of range, of velocity


def test_each_axis_may_have_its_own_window():
    """The map is the two transforms of the cube times both tapers, written out; its noise has both bandwidths."""
    radar = radar_of(num_chirps=32)
    cube = np.random.default_rng(0).standard_normal((1, 1, 32, 512)) + 0j
    tapers = [samples / samples.sum() for samples in (_core.window("chebyshev", 32, 60), _core.window("hann", 512))]
    expected = np.fft.fftshift(np.fft.fft2(cube[0, 0] * np.outer(*tapers)), axes=0)
    result = ep.range_doppler(cube, radar, window=PAIR)
    np.testing.assert_allclose(result.values[0, 0], expected, atol=ROUNDING * np.abs(expected).max())
    assert result.window == ("hann", ("chebyshev", 60.0))
    assert ep.range_doppler(cube, radar, window=["hann", "hann"]).window == "hann"
    bandwidths = [len(taper) * np.sum(taper**2) for taper in tapers]
    noise = _core.noise_power(radar) * np.prod(bandwidths) / (32 * 512)
    assert _core.cell_noise_power(radar, PAIR) == pytest.approx(noise, rel=ROUNDING)
    assert pickle.loads(pickle.dumps(result)) == result


@pytest.mark.parametrize("window, told", [
    (("hann", "han"), r"window\[1\]: must be .* \(nearest: hann\), got 'han'"),
    (("hann", "hann", "hann"), "window: must be"), ((("chebyshev", -3), "hann"), r"window\[0\]: must be")])
def test_pairs_of_windows_are_checked(window, told):
    with pytest.raises((TypeError, ValueError), match=told):
        ep.range_doppler(np.zeros((1, 1, 128, 512)), radar_of(), window=window)


def test_one_sample_makes_a_radar_that_tells_velocities_alone():
    """Its cell of range, c / 2B, holds all that is nearer, and nothing beyond is heard."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="plate", material="metal", position=(20, 0, 0), yaw=np.pi,
              motion=ep.LinearMotion(velocity=(3, 0, 0)))
    for bandwidth, hears in ((1e6, True), (10e6, False)):
        radar = build_radar(num_samples=1, num_chirps=128, bandwidth=bandwidth, chirp_interval=150e-6)
        result = ep.range_doppler(ep.synthesize(ep.trace(scene, radar, num_rays=1000), radar), radar)
        assert result.range.tolist() == [0.0] and radar.waveform.max_range == pytest.approx(C / (2 * bandwidth))
        power = np.abs(result.values[0, 0, :, 0]) ** 2
        assert bool(power.any()) == hears
        step = result.velocity[1] - result.velocity[0]
        assert not hears or abs(result.velocity[power.argmax()] - 3.0) <= 0.5 * step


def test_window_names():
    n = np.arange(8)
    np.testing.assert_allclose(_core.window("hann", 8), np.sin(np.pi * n / 8) ** 2, atol=1e-3 * ROUNDING)
    assert (_core.window("rect", 8) == 1).all()
    with pytest.raises(ValueError, match="nearest: hamming"):
        _core.window("haming", 8)


def chebyshev_null(count: int, sidelobe_db: float) -> float:
    """Bins to the first null of Dolph's window: where its polynomial of degree count - 1 has its largest root."""
    edge = np.cosh(np.arccosh(10.0 ** (sidelobe_db / 20.0)) / (count - 1))
    return count / np.pi * np.arccos(np.cos(0.5 * np.pi / (count - 1)) / edge)


def taylor_null(lobes: int, sidelobe_db: float) -> float:
    """Bins to the first null of Taylor's window of a number of equal lobes (Taylor 1955)."""
    a = np.arccosh(10.0 ** (sidelobe_db / 20.0)) / np.pi
    return lobes * np.hypot(a, 0.5) / np.hypot(a, lobes - 0.5)


@pytest.mark.parametrize("window, bins", [("rect", 1.0), ("hann", 2.0), ("hamming", 2.0), ("blackman_harris", 4.0),
                                          (("chebyshev", 60.0), chebyshev_null(64, 60.0)),
                                          (("taylor", 30.0), taylor_null(4, 30.0)), ("taylor", taylor_null(6, 35.0)),
                                          ("blackman", 3.0), (("kaiser", 69.0), np.hypot(1.0, 9.366 / np.pi) * 64 / 63)])
def test_main_lobes_end_at_the_first_null(window, bins):
    assert main_lobe_half_width(samples_of(window, 64)) == pytest.approx(bins, abs=1.0 / 64.0)


def first_sidelobe_db(samples) -> float:
    """Level below the main lobe of the largest sidelobe."""
    response = np.abs(np.fft.rfft(samples, 1 << 14))
    rises = np.flatnonzero(np.diff(response) > 0.0)
    return 20.0 * np.log10(response[0] / response[rises[0]:].max())


@pytest.mark.parametrize("count, error_db", [(16, 3.0), (48, 1.0), (128, 1.0)])
def test_kaisers_level_is_met_as_closely_as_it_is_said_to_be(count, error_db):
    for sidelobe_db in range(20, 121, 5):
        assert first_sidelobe_db(samples_of(("kaiser", float(sidelobe_db)), count)) == pytest.approx(sidelobe_db, abs=error_db)


def test_bad_input_is_an_error():
    radar = radar_of(num_chirps=4)
    cube = np.zeros((1, 1, 4, 512))
    with pytest.raises(ValueError, match="^zero_pad: "):
        ep.range_doppler(cube, radar, zero_pad=0)
    for sidelobe_db in (1, 19.9, 300.1, np.inf, np.nan):
        with pytest.raises(ValueError, match="^window: .* 20 to 300"):
            ep.range_doppler(cube, radar, window=("chebyshev", sidelobe_db))
    for neither in (80, ("hann", "taylor", "rect"), {"range": "hann", "velocity": "taylor"}):
        with pytest.raises(TypeError, match="^window: .*, or a pair of these, of range and of velocity, got "):
            ep.range_doppler(cube, radar, window=neither)
    with pytest.raises(ValueError, match="^cube: "):
        ep.range_doppler(cube[..., :100], radar)
    for wrong, place in ((np.nan, (0, 0, 3, 17)), (np.inf, (0, 0, 0, 0)), (-1j * np.inf, (0, 0, 3, 511))):
        broken = cube.astype(complex)
        broken[place] = wrong
        with pytest.raises(ValueError, match=rf"^cube: must be finite, got .* = \[0, 0, {place[2]}, {place[3]}\]"):
            ep.range_doppler(broken, radar)
