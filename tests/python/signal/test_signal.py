"""Beat signals of given echoes against their exact phase, and the thermal noise that is added to them."""
from types import SimpleNamespace

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.signals import measures

C = 299792458.0
METHODS = ("direct", "recurrence", "nufft")
THERMAL_DBM = -88.965  # k 290 K 20 MHz and a noise figure of 12 dB
LAST_DIGIT_DB = 1e-3   # of that figure
SAMPLED_DB = 0.1       # 131 072 samples are known to 0.012 dB


def reference(**changes):
    fields = dict(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=16,
                  chirp_interval=30e-6)
    return ep.ChirpSequence(**{**fields, **changes})


def one_by_one(waveform):
    return ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


def exact_chirp(waveform, delay_of, amplitude):
    """Samples of one chirp with the exact delay at every sample; delay_of(t) [P]."""
    t = np.arange(waveform.num_samples) / waveform.sampling_rate
    tau = np.stack([delay_of(time) for time in t])
    slope = waveform.slope
    turns = waveform.start_frequency * tau
    cycles = (turns - np.round(turns)) + slope * t[:, None] * tau - 0.5 * slope * tau**2
    return (np.conj(amplitude) * np.exp(2j * np.pi * cycles)).sum(axis=1)


@pytest.mark.parametrize("method", METHODS)
def test_static_echoes_equal_the_exact_phase(method):
    waveform = reference()
    delays = 2 * np.array([10.0, 37.5, 60.0]) / C
    amplitudes = np.array([1.0, 0.5j, -0.1 + 0.2j])
    samples = _core.synthesize_echoes(waveform, delays[None], amplitudes[None], method=method, tolerance=1e-10)
    assert samples.shape == (16, 512)
    # Plain products of 4e4 turns in NumPy leave 1e-11 rad.
    np.testing.assert_allclose(samples[5], exact_chirp(waveform, lambda t: delays, amplitudes), rtol=0, atol=1e-9)
    assert (samples == samples[0]).all()


@pytest.mark.parametrize("method", METHODS)
def test_moving_echoes_equal_the_exact_phase_up_to_the_model_error(method):
    waveform = reference()
    ranges, speeds = np.array([20.0, 45.0]), np.array([30.0, -30.0])
    starts = np.arange(16) * waveform.chirp_interval
    delay_of = lambda t: 2 * (ranges + speeds * t) / C
    delays = np.stack([delay_of(start + waveform.window_centre) for start in starts])
    amplitudes = np.broadcast_to(np.array([1.0, 1j]), delays.shape)
    samples = _core.synthesize_echoes(waveform, delays, amplitudes, method=method)
    exact = exact_chirp(waveform, lambda t: delay_of(starts[9] + t), amplitudes[0])
    error = np.abs(samples[9] - exact).max()
    assert 0.004 < error < 2 * 0.0081  # 2 pi slope taudot (Tc / 2)^2 = 0.0080 rad for each


@pytest.mark.hard
def test_no_echoes_give_zeros():
    samples = _core.synthesize_echoes(reference(), np.zeros((1, 0)), np.zeros((1, 0)))
    assert samples.shape == (16, 512) and not samples.any()


@pytest.mark.hard
@pytest.mark.parametrize("shape", [(16, 500), (1, 5000)])  # moving, at rest
def test_bits_do_not_depend_on_threads(shape):
    random = np.random.default_rng(1)
    delays = 2 * (5 + 60 * random.random(shape)) / C
    bits = []
    for threads in (1, 3):
        ep.set_num_threads(threads)
        bits.append(_core.synthesize_echoes(reference(), delays, np.ones_like(delays)))
    ep.set_num_threads(0)
    assert (bits[0] == bits[1]).all()


def test_bad_echoes_are_errors():
    good = np.full((1, 3), 1e-7)
    cases = [("delays", dict(delays=np.full((7, 3), 1e-7), amplitudes=np.ones((7, 3)))),
             ("delay", dict(delays=np.full((1, 3), np.nan), amplitudes=np.ones((1, 3)))),
             ("amplitudes", dict(delays=good, amplitudes=np.ones((1, 2)))),
             ("method", dict(delays=good, amplitudes=good, method="fft")),
             ("tolerance", dict(delays=good, amplitudes=good, tolerance=1.0))]
    for argument, arguments in cases:
        with pytest.raises(ValueError, match=f"^{argument}: "):
            _core.synthesize_echoes(reference(), **arguments)


def test_noise_is_thermal_seeded_and_added_to_a_copy():
    radar = one_by_one(reference(num_chirps=256))
    cube = np.zeros((1, 1, 256, 512), complex)
    noise = ep.add_noise(cube, radar, seed=7)
    assert not cube.any()
    assert 10 * np.log10(np.mean(np.abs(noise) ** 2)) + 30 == pytest.approx(THERMAL_DBM, abs=SAMPLED_DB)
    assert 10 * np.log10(_core.noise_power(radar)) + 30 == pytest.approx(THERMAL_DBM, abs=LAST_DIGIT_DB)
    assert (noise == ep.add_noise(cube, radar, seed=7)).all()
    assert (noise != ep.add_noise(cube, radar, seed=8)).all()
    np.testing.assert_array_equal(ep.add_noise(cube + 1, radar, seed=7), noise + 1)


def test_bad_noise_input_is_an_error():
    radar = one_by_one(reference())
    with pytest.raises(ValueError, match=r"cube: .*\[1, 1, 16, 512\], got \[1, 1, 16, 511\]"):
        ep.add_noise(np.zeros((1, 1, 16, 511)), radar, seed=1)
    with pytest.raises(ValueError, match="^seed: .*-1"):
        ep.add_noise(np.zeros((1, 1, 16, 512)), radar, seed=-1)


def test_powers_of_cubes_and_of_their_chirps_are_means_of_squares():
    """1 uW is -30 dBm, and as much more as 20 log10 of an amplitude's factor."""
    cube = np.zeros((2, 3, 4, 8), complex)
    cube[1, 2] = np.sqrt(1e-6) * np.array([1.0, 10.0, 0.1, 0.0])[:, None] * np.exp(1j * np.arange(8))
    assert ep.power_by_chirp(cube, tx=1, rx=2) == pytest.approx([-30.0, -10.0, -50.0, -2970.0])
    assert ep.power_by_chirp(cube) == pytest.approx([-2970.0] * 4)
    assert measures.power_dbm(cube) == pytest.approx(10.0 * np.log10(1e-3 * 101.01 / 24.0))
    assert measures.power_dbm(0.0 * cube) == -np.inf
    assert measures.residual(cube, {"half": 0.5 * cube, "fifth": 0.2 * cube}) == pytest.approx(0.3)
    for low, high, told in ((5e-4, 2e-3, "-3.01 to 3.01 dBm"), (0.0, 2e-3, "below 3.01 dBm")):
        power = SimpleNamespace(power=1e-3, low=low, high=high, resolved=False)
        assert measures.with_error(power) == f"not resolved, {told}"
    assert measures.with_error(SimpleNamespace(power=0.0, low=0.0, high=0.0, resolved=False)) == "nothing"
    assert measures.with_error(SimpleNamespace(power=1e-3, resolved=True, interval_db=0.125)) == "0.00 dBm +- 0.12 dB"
    for name, size in (("tx", 2), ("rx", 3)):
        with pytest.raises(IndexError, match=f"^{name}: must be below {size}, the number of its antennas, got {size}"):
            ep.power_by_chirp(cube, **{name: size})
