"""Faults of receivers against their closed forms."""

import re

import numpy as np
import pytest

import echopath as ep
from echopath.receiver.oscillator import Oscillator
from echopath.receiver.slots import SlotTimes
from echopath.transmit import code_signal
from support.radars import build_radar
from support.signals.received_tones import COUNT, LEVEL, RATE, db, one_channel, received, tone

C = ep.speed_of_light
SHARE = 0.01     # promised for amplitudes and times, relative
SLOPE = 1e9 * RATE / COUNT
SETTLED = 1e-5    # dB and relative: filters settle in 14 time constants, in which two poles forget all but exp(-14) or so


def levels(cube):
    """Mean power of each cell of the range transform, tones at their power: [COUNT] in W."""
    spectrum = np.fft.fft(cube, axis=-1) / COUNT
    return np.mean(np.abs(spectrum) ** 2, axis=(0, 1, 2))


def floor(cube):
    """Mean density of noise in each cell, [COUNT] in W/Hz: by Hann's window, for a floor that rises by 40 dB leaks otherwise."""
    window = np.sin(np.pi * np.arange(COUNT) / COUNT) ** 2
    spectrum = np.fft.fft(cube * window, axis=-1)
    return np.mean(np.abs(spectrum) ** 2, axis=(0, 1, 2)) / (RATE * np.sum(window ** 2))


def test_an_ideal_receiver_keeps_every_bit():
    cube, radar = tone(33.3), one_channel()
    plain = ep.add_noise(cube, radar, seed=5)
    np.testing.assert_array_equal(ep.receive(cube, radar, seed=5).cube, plain)
    np.testing.assert_array_equal(ep.receive(cube, radar.replace(receiver=ep.Receiver()), seed=5).cube, plain)


def test_real_samples_have_the_offset_of_one_branch():
    radar = build_radar(num_samples=32, num_chirps=2, real=True, receiver=ep.Receiver(dc_offset=(0.5, -0.25)))
    np.testing.assert_array_equal(ep.receive(np.zeros((1, 1, 2, 32)), radar, seed=None).cube, np.full((1, 1, 2, 32), 0.5 + 0j))


@pytest.mark.parametrize("fault", [{"phase_noise": ep.PhaseNoise(offsets=[1e4, 1e6], levels=[-70.0, -90.0])},
                                   {"adc": {"bits": 16, "automatic_gain": True, "clock_jitter": 1e-11}}])
def test_frames_of_one_seed_have_faults_of_their_own_and_the_same_alone(fault):
    """By the start of the frame, as their thermal noise has it, which lies far below."""
    cube, radar = tone(33.3), one_channel(receiver=ep.Receiver(**fault))
    first, again, later = (ep.receive(cube, radar, seed=5, start_time=time).cube for time in (0.1, 0.1, 0.2))
    np.testing.assert_array_equal(first, again)
    assert np.abs(later - first).max() > 1e-5 * np.abs(first).max()


def test_codes_turn_leakage_as_they_turn_echoes():
    """By e^{j phase} of the slot; two transmitters of equal leakage add up as their codes do."""
    phases = np.array([[0.0, 0.4, 2.0], [1.0, -0.3, 2.5]])
    receiver = ep.Receiver(leakage_db=[[-30.0], [-30.0]], leakage_delay=1e-9)
    leaked = []
    for code in (phases, np.zeros((2, 1))):
        radar = build_radar([(0, 0, 0), (0, 0.01, 0)], num_samples=32, num_chirps=3, multiplexing="cdm", code_phases=code,
                            receiver=receiver)
        leaked.append(ep.receive(np.zeros((1, 1, 3, 32)), radar, seed=None).cube)
    expected = np.exp(1j * phases).sum(axis=0)[:, None] * leaked[1] / 2.0
    np.testing.assert_allclose(leaked[0], expected, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("receiver", [None, ep.Receiver()])
def test_what_a_receiver_gives_is_not_what_it_was_given(receiver):
    """Also where nothing is done to the cube: a caller who goes on in one of them keeps the other."""
    cube, radar = tone(33.3), one_channel().replace(receiver=receiver)
    kept = cube.copy()
    for other in (ep.receive(cube, radar, seed=None).cube, ep.receive(0.0 * cube, radar, seed=None, interference=cube).cube,
                  *ep.receive_parts({"one": cube, "two": cube}, radar, seed=None).values(),
                  *ep.receive_parts({"one": 0.0 * cube}, radar, seed=None, interference=cube).values()):
        other[...] = 7.0
    np.testing.assert_array_equal(cube, kept)


def test_each_part_may_be_changed_by_itself():
    """Leakage is alike in all chirps, which share no memory for it."""
    radar = one_channel().replace(receiver=ep.Receiver(leakage_db=[[-40.0]], leakage_delay=1e-9))
    leaked = ep.receive_parts({"one": tone(33.3)}, radar, seed=None)["leakage"]
    before = leaked[0, 0, 1:].copy()
    leaked[0, 0, 0] *= 2.0
    np.testing.assert_array_equal(leaked[0, 0, 1:], before)


@pytest.mark.parametrize("filters", [{"high_pass": [175e3]}, {"low_pass": 5e6}])
def test_white_noise_for_a_receiver_with_filters_is_warned_of(filters):
    radar = one_channel(receiver=ep.Receiver(**filters))
    with pytest.warns(RuntimeWarning, match=r"radar: .* filters shape its noise, .* ep.receive\(cube, radar, seed=1\).cube"):
        ep.add_noise(tone(33.3), radar, seed=5)


@pytest.mark.filterwarnings("error")
def test_white_noise_for_a_receiver_without_filters_is_not():
    ep.add_noise(tone(33.3), one_channel(receiver=ep.Receiver(iq_gain_db=0.2, compression_dbm=-12.0)), seed=5)


@pytest.mark.parametrize("distance", [3.0, 10.0, 30.0, 60.0])
@pytest.mark.parametrize("offset", [1.25e6, 3e6])
def test_phase_noise_falls_by_the_range_correlation(distance, offset):
    """L(f) 4 sin^2(pi f d) below the echo, by the mask and the delay d."""
    delay = 2.0 * distance / C
    cell = round(SLOPE * delay / RATE * COUNT)
    delay, density = cell * RATE / COUNT / SLOPE, 1e-13
    noise = ep.PhaseNoise(offsets=[1e3], levels=[-130.0])  # small: its square is no part of the form
    chirps = 800
    radar = one_channel(chirps, receiver=ep.Receiver(phase_noise=noise), noise_figure_db=0.0)
    slots = SlotTimes(radar, 0.0)
    mixed = Oscillator(radar, radar.receiver, slots, slots.generator(1, "phase noise")).mixed(tone(cell, 1.0, chirps))
    lines = round(offset * COUNT / RATE) + np.arange(-8, 9)
    measured = floor(mixed)
    wanted = density * 4.0 * np.sin(np.pi * lines * RATE / COUNT * delay) ** 2
    for side in (cell + lines, cell - lines):
        inside = (side > 0) & (side < COUNT - COUNT // 16)
        if inside.any():
            assert db(measured[side[inside]].mean() / wanted[inside].mean()) == pytest.approx(0.0, abs=LEVEL)


def test_echoes_of_one_delay_have_the_phase_noise_of_the_oscillator_then_and_now():
    """Against the phases themselves: phi(t) - phi(t - d), a whole number of samples ago."""
    noise = ep.PhaseNoise(offsets=[1e3, 4e6, 5e6], levels=[-80.0, -80.0, -200.0])
    radar = one_channel(1, receiver=ep.Receiver(phase_noise=noise))
    slots = SlotTimes(radar, 0.0)
    oscillator = Oscillator(radar, radar.receiver, slots, slots.generator(7, "phase noise"))
    ago = 8  # samples of the doubled rate
    cell = ago / (2.0 * RATE) * SLOPE / RATE * COUNT
    assert cell == round(cell)
    phase = oscillator._phase[0, 0]
    difference = phase[2 * COUNT::2] - phase[2 * COUNT - ago:4 * COUNT - ago:2]
    mixed = oscillator.mixed(tone(cell, 1.0, 1))[0, 0, 0] / tone(cell, 1.0, 1)[0, 0, 0]
    inner = slice(8, -8)
    inner = slice(COUNT // 8, -COUNT // 8)  # the signal is taken to repeat, which its ends feel
    error = np.abs(mixed - np.exp(1j * difference))[inner]
    assert np.sqrt(np.mean(error ** 2)) < SHARE * np.std(difference)


def test_frequency_errors_act_by_the_delay_of_each_echo():
    """A law c1 t is a slope that is off by c1: the beat frequency moves by c1 d."""
    cell = 60
    delay = cell * RATE / COUNT / SLOPE
    cube = received(tone(cell), frequency_error=(0.0, 1e-3 * SLOPE)).cube[0, 0, 0]
    beat = np.polyfit(np.arange(COUNT)[32:-32], np.unwrap(np.angle(cube))[32:-32], 1)[0] * RATE / (2 * np.pi)
    assert beat - cell * RATE / COUNT == pytest.approx(1e-3 * SLOPE * delay, rel=SHARE)


@pytest.mark.parametrize("cell", [3, 120, 240])
def test_a_frequency_that_is_off_turns_real_samples_by_the_delay_at_all_ranges(cell):
    """By 2 pi c0 d; 512 real samples have 256 cells, of which the last eighth had been silent."""
    error = 1e6
    radar = one_channel(real=True, receiver=ep.Receiver(frequency_error=(error,)))
    out = ep.receive(np.sqrt(2.0) * tone(cell).real, radar, seed=None).cube
    turned = tone(cell) * np.exp(2j * np.pi * error * cell * RATE / COUNT / SLOPE)
    inner = slice(32, -32)  # the signal is taken to repeat, which its ends feel
    np.testing.assert_allclose(out[..., inner], np.sqrt(2.0) * turned.real[..., inner], atol=SHARE)


def test_a_curved_frequency_law_bends_the_phase_of_an_echo():
    """c2 t^2: the phase is 2 pi c2 (t^3 - (t - d)^3) / 3."""
    cell, bend = 100, 2e16
    delay, time = cell * RATE / COUNT / SLOPE, np.arange(COUNT) / RATE
    cube = received(tone(cell), frequency_error=(0.0, 0.0, bend)).cube[0, 0, 0]
    found = np.unwrap(np.angle(cube / tone(cell)[0, 0, 0]))[40:-40]
    wanted = (2 * np.pi * bend * (time ** 3 - (time - delay) ** 3) / 3)[40:-40]
    assert found - found[0] == pytest.approx(wanted - wanted[0], abs=SHARE * np.ptp(wanted))


@pytest.mark.parametrize("cell, error", [(400, (-5e6,)), (20, (2.5e7,)), (20, (-1e8, 0.1 * SLOPE)), (60, (0.0, 0.03 * SLOPE)),
                                         (400, (0.0, -0.01 * SLOPE))])
def test_frequency_errors_beyond_the_sampling_rate_do_not_fold(cell, error):
    """c0 + c1 t turns an echo by 2 pi (c0 d + c1 (t d - d^2 / 2)); at 20 MHz these were off by radians."""
    delay, time = cell * RATE / COUNT / SLOPE, np.arange(COUNT) / RATE
    constant, rate = (*error, 0.0)[:2]
    wanted = tone(cell)[0, 0, 0] * np.exp(2j * np.pi * (constant * delay + rate * delay * (time - 0.5 * delay)))
    inner = slice(COUNT // 8, -COUNT // 8)  # the signal is taken to repeat, which its ends feel
    np.testing.assert_allclose(received(tone(cell), frequency_error=error).cube[0, 0, 0, inner], wanted[inner], atol=SHARE)


def test_frequency_errors_that_take_too_many_samples_are_refused():
    with pytest.raises(ValueError, match="^receiver.frequency_error: must be at most 6.2e\\+08 Hz within a chirp"):
        received(tone(20), frequency_error=(0.0, 1e15))


def test_a_frequency_that_is_off_turns_the_leakage_by_its_delay():
    """By 2 pi (c0 d + c1 (t d - d^2 / 2)), as an echo."""
    error, delay, time = (5e6, 0.01 * SLOPE), 20e-9, np.arange(COUNT) / RATE
    silent = np.zeros((1, 1, 8, COUNT))
    off, steady = (received(silent, leakage_db=[[-30.0]], leakage_delay=delay, frequency_error=law).cube[0, 0, 0]
                   for law in (error, ()))
    wanted = steady * np.exp(2j * np.pi * delay * (error[0] + error[1] * (time - 0.5 * delay)))
    inner = slice(COUNT // 8, -COUNT // 8)  # the signal is taken to repeat, which its ends feel
    np.testing.assert_allclose(off[inner], wanted[inner], atol=SHARE * np.abs(steady[0]))


def test_leakage_is_an_echo_of_its_level_and_delay():
    radar = one_channel(receiver=ep.Receiver(leakage_db=[[-30.0]], leakage_delay=1e-9), transmit_power=0.02)
    cube = ep.receive(np.zeros((1, 1, 8, COUNT)), radar, seed=None).cube[0, 0]
    assert np.mean(np.abs(cube) ** 2) == pytest.approx(0.02e-3, rel=SHARE)
    beat = np.polyfit(np.arange(COUNT), np.unwrap(np.angle(cube[3])), 1)[0] * RATE / (2 * np.pi)
    assert beat == pytest.approx(SLOPE * 1e-9, rel=SHARE)
    cycles = 77e9 * 1e-9 - 0.5 * SLOPE * 1e-18
    assert np.angle(cube[0, 0] * np.exp(-2j * np.pi * cycles)) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("real, share", [(False, 1.0), (True, 0.5)])
def test_leakage_beyond_the_last_range_is_filtered_as_echoes_are(real, share):
    """Its beat frequency is slope times delay, and the band ends at the sampling rate, of real samples at half of it."""
    def power(beat):
        receiver = ep.Receiver(leakage_db=[[-30.0]], leakage_delay=beat * RATE / SLOPE)
        radar = one_channel(receiver=receiver, transmit_power=1.0, real=real)
        return np.mean(np.abs(ep.receive(np.zeros((1, 1, 8, COUNT)), radar, seed=None).cube) ** 2)

    assert power(0.99 * share) == pytest.approx(1e-3, rel=0.01)
    assert power(1.01 * share) == power(4.3) == 0.0


def test_leakage_has_the_phase_noise_of_its_own_short_delay():
    noise = ep.PhaseNoise(offsets=[1e3], levels=[-130.0])
    radar = one_channel(200, receiver=ep.Receiver(phase_noise=noise, leakage_db=[[-20.0]], leakage_delay=5e-9),
                        transmit_power=1.0, noise_figure_db=0.0)
    cube = ep.receive(np.zeros((1, 1, 200, COUNT)), radar, seed=1).cube
    time = np.arange(COUNT) / RATE
    steady = cube * np.exp(-2j * np.pi * SLOPE * 5e-9 * time)
    lines = np.arange(60, 100)
    wanted = 1e-2 * 1e-13 * 4.0 * np.sin(np.pi * lines * RATE / COUNT * 5e-9) ** 2
    assert db(floor(steady)[lines].mean() / wanted.mean()) == pytest.approx(0.0, abs=LEVEL)


def test_coupling_adds_what_other_receivers_have():
    radar = build_radar(receivers=((0, 0, 0), (0, 0.01, 0)), num_samples=COUNT, num_chirps=2,
                        receiver=ep.Receiver(coupling_db=[[0, -20.0], [-30.0, 0]], coupling_delay=0.1e-9))
    cube = np.stack([tone(50, num_chirps=2)[0, 0], np.zeros((2, COUNT))])[None]
    out = ep.receive(cube, radar, seed=None).cube[0]
    turn = np.exp(2j * np.pi * (77e9 + SLOPE * np.arange(COUNT) / RATE) * 0.1e-9)
    np.testing.assert_allclose(out[0], cube[0, 0], rtol=1e-12)
    np.testing.assert_allclose(out[1], 0.1 * cube[0, 0] * turn, rtol=1e-9)


def test_errors_of_channels_and_their_drift():
    radar = build_radar(receivers=((0, 0, 0), (0, 0.01, 0)), transmitters=((0, 0, 0), (0, 0.02, 0)), num_samples=COUNT,
                        num_chirps=4, receiver=ep.Receiver(receiver_gain_db=[0, 1.0], receiver_phase=[0, 0.3],
                                                           transmitter_phase=[0, -0.2], gain_drift_db=[0, 2.0],
                                                           phase_drift=[5.0, 0]))
    ones = np.ones((2, 2, 4, COUNT))
    out = ep.receive(ones, radar, seed=None, start_time=10.0).cube
    time = 10.0 + 60e-6 * (2 * np.arange(4) + 1)  # of the second transmitter
    assert np.angle(out[1, 0, :, 0] * np.exp(-1j * (5.0 * time - 0.2))) == pytest.approx(0.0, abs=1e-9)
    assert 20 * np.log10(np.abs(out[1, 1, :, 0])) == pytest.approx(1.0 + 2.0 * time, rel=1e-9)
    assert np.angle(out[1, 1, :, 0]) == pytest.approx(0.1, abs=1e-9)


def pairs_of_real_samples(multiplexing, **faults):
    """A radar of 2 x 2 antennas with real samples, and its echo z [tx, rx, 1, sample] between the cells, as complex samples."""
    radar = build_radar(receivers=((0, 0, 0), (0, 0.01, 0)), transmitters=((0, 0, 0), (0, 0.02, 0)), num_samples=COUNT,
                        num_chirps=4, real=True, multiplexing=multiplexing, receiver=ep.Receiver(**faults))
    phases = np.array([[0.3, 2.0], [-1.0, 1.4]])[..., None, None]
    return radar, np.exp(1j * phases + 2j * np.pi * 60.37 * np.arange(COUNT) / COUNT)


@pytest.mark.parametrize("multiplexing", ["tdm", "bpm"])
def test_phases_of_channels_turn_real_samples(multiplexing):
    """sqrt(2) Re(z e^{j phase}), which stays real: a quarter of a turn is no silence behind the converter."""
    sent, had = np.array([0.4, np.pi / 2]), np.array([np.pi / 2, -2.1])
    radar, echo = pairs_of_real_samples(multiplexing, transmitter_phase=sent, receiver_phase=had, phase_drift=[9.0, 0.0],
                                        adc=ep.Adc(bits=16, full_scale_dbm=40.0, gain_db=0.0))
    cube = np.repeat(np.sqrt(2.0) * echo.real, 4, axis=2)
    rate, begin = np.array([9.0, 0.0])[:, None], 60e-6 * np.arange(8)
    turned = echo[:, :, 0] * np.exp(1j * (sent[:, None] + had))[..., None]
    if multiplexing == "bpm":
        signs = np.stack([np.ones(8), np.tile([1.0, -1.0], 4)])
        cube = code_signal(np.repeat(np.sqrt(2.0) * echo.real, 8, axis=2), signs * np.exp(1j * sent)[:, None], radar.waveform)
        wanted = np.einsum("trs,tk->rks", turned, signs)[None] * np.exp(1j * rate * begin)[..., None]
    else:
        wanted = turned[:, :, None] * np.exp(1j * rate * begin.reshape(4, 2).T[:, None])[..., None]
    out = ep.receive(cube, radar, seed=None).cube
    np.testing.assert_allclose(out, np.sqrt(2.0) * wanted.real, atol=2e-3)


def test_coupling_turns_real_samples_by_its_delay():
    radar, echo = pairs_of_real_samples("tdm", coupling_db=[[0, -20.0], [-30.0, 0]], coupling_delay=0.1e-9)
    out = ep.receive(np.repeat(np.sqrt(2.0) * echo.real, 4, axis=2), radar, seed=None).cube
    turn = np.exp(2j * np.pi * (77e9 + SLOPE * np.arange(COUNT) / RATE) * 0.1e-9)
    others = echo[:, ::-1] * np.array([10 ** -1.5, 0.1])[:, None, None] * turn
    np.testing.assert_allclose(out, np.repeat(np.sqrt(2.0) * (echo + others).real, 4, axis=2), atol=1e-4)


@pytest.mark.parametrize("multiplexing", ["tdm", "bpm"])
def test_phases_and_coupling_turn_leakage_of_less_than_a_period(multiplexing):
    """Of 0.3 ns and 1 GHz a chirp of real samples has 0.3 periods, which by themselves tell no phase."""
    sent, had, rate = np.array([0.4, np.pi / 2]), np.array([np.pi / 2, -2.1]), np.array([9.0, 0.0])
    radar, _ = pairs_of_real_samples(multiplexing, leakage_db=np.full((2, 2), -20.0), leakage_delay=0.3e-9, coupling_delay=0.1e-9,
                                     coupling_db=[[0, -20.0], [-30.0, 0]], transmitter_phase=sent, receiver_phase=had,
                                     phase_drift=rate)
    shape = (2, 2, 4, COUNT) if multiplexing == "tdm" else (1, 2, 8, COUNT)
    time, begin = np.arange(COUNT) / RATE, 60e-6 * np.arange(8)
    leaked = 0.1 * np.sqrt(radar.transmit_power) * np.exp(2j * np.pi * 0.3e-9 * (77e9 + SLOPE * (time - 0.15e-9)))
    leaked = leaked * (1.0 + np.array([[10 ** -1.5], [0.1]]) * np.exp(2j * np.pi * (77e9 + SLOPE * time) * 0.1e-9))
    signs = np.stack([np.ones(8), np.tile([1.0, -1.0], 4)]) * np.exp(1j * sent)[:, None]
    drift = np.exp(1j * (had[:, None] + rate[:, None] * begin))
    if multiplexing == "tdm":
        wanted = leaked[None, :, None] * np.einsum("t,rct->trc", np.exp(1j * sent), drift.reshape(2, 4, 2))[..., None]
    else:
        wanted = leaked[None, :, None] * (signs.sum(axis=0) * drift)[None, ..., None]
    wanted = np.sqrt(2.0) * wanted.real
    out = ep.receive(np.zeros(shape), radar, seed=None).cube
    np.testing.assert_allclose(out, wanted, atol=1e-9 * np.abs(wanted).max())
    parts = ep.receive_parts({"echo": np.zeros(shape)}, radar, seed=None)
    np.testing.assert_array_equal(parts["leakage"], out)


def test_thermal_noise_goes_through_the_errors_of_the_converter_and_not_of_the_transmitters():
    radar = one_channel(64, receiver=ep.Receiver(transmitter_gain_db=[20.0]))
    out = ep.receive(np.zeros((1, 1, 64, COUNT)), radar, seed=2).cube
    np.testing.assert_array_equal(out, ep.add_noise(np.zeros((1, 1, 64, COUNT)), radar, seed=2))


def test_a_blocker_compresses_a_weak_echo_and_mirrors_it():
    """Weak beside strong A of saturation S: gain (g + g'A / 2), image g'A / 2, with g = 1 / sqrt(1 + A^2 / S)."""
    point, blocker, weak = -10.0, 1e-4 * 10 ** 0.3, 1e-12
    out = received(tone(40, blocker) + tone(90, weak), compression_dbm=point).cube
    x = blocker / (1e-3 * 10 ** (point / 10) / (10 ** 0.1 - 1))
    gain = (1 + x) ** -0.5
    half = -0.5 * x * (1 + x) ** -1.5
    measured = levels(out)
    assert db(measured[40] / blocker) == pytest.approx(db(gain ** 2), abs=LEVEL)
    assert db(measured[90] / weak) == pytest.approx(db((gain + half) ** 2), abs=LEVEL)
    assert db(measured[(2 * 40 - 90) % COUNT] / weak) == pytest.approx(db(half ** 2), abs=LEVEL)
    alone = received(tone(40, 1e-3 * 10 ** (point / 10)), compression_dbm=point).cube
    assert db(levels(alone)[40] / 1e-4) == pytest.approx(-1.0, abs=1e-9)


@pytest.mark.parametrize("turns", [0.0, 0.125, 0.25])
def test_leakage_of_less_than_a_period_compresses_real_samples_by_its_power(turns):
    """A weak echo beside leakage of power P and phase p has the gain g + 2 h cos(p) e^{-jp} in real samples: those of the
    leakage are all 0 where p is a quarter of a turn, and the amplifier has its power all the same."""
    power, point, cell, weak = 1e-5, -30.0, 90, 1e-14
    faults = dict(leakage_db=[[10.0 * np.log10(power / 0.02)]], leakage_delay=turns / 77e9, compression_dbm=point)
    radar = one_channel(real=True, transmit_power=0.02, receiver=ep.Receiver(**faults))
    echo = np.sqrt(2.0) * tone(cell, weak).real
    beside, alone = (ep.receive(cube, radar, seed=None).cube for cube in (echo, 0.0 * echo))
    x = power / (1e-3 * 10 ** (point / 10) / (10 ** 0.1 - 1))
    gain, half = (1 + x) ** -0.5, -0.5 * x * (1 + x) ** -1.5
    phase = 2.0 * np.pi * turns
    wanted = abs(gain + 2.0 * half * np.cos(phase) * np.exp(-1j * phase))
    assert np.sqrt(2.0 * levels(beside - alone)[cell] / weak) == pytest.approx(wanted, rel=SHARE)
    part = ep.receive_parts({"echo": 0.0 * echo}, radar, seed=None)["leakage"]
    np.testing.assert_allclose(part, alone, rtol=0.0, atol=1e-12 * np.sqrt(power))


@pytest.mark.parametrize("frequency", [200e3, 781250.0, 4e6])
def test_filters_have_their_response(frequency):
    cell = round(frequency * COUNT / RATE)
    f = cell * RATE / COUNT
    out = received(tone(cell), high_pass=[350e3, 700e3], low_pass=5e6, low_pass_poles=3).cube
    high = (f / 350e3) ** 2 / (1 + (f / 350e3) ** 2) * (f / 700e3) ** 2 / (1 + (f / 700e3) ** 2)
    low = 1 / (1 + (f / 5e6) ** 6)
    assert db(levels(out)[cell]) == pytest.approx(db(high * low), abs=SETTLED)


def settled(cell, count, poles=3, **filters):
    """What filters leave of a tone of a cell after all time, and what comes out of a receiver, [count]."""
    echo, f = np.exp(2j * np.pi * cell * np.arange(count) / count), cell * RATE / count
    gain = np.prod([1j * f / (1j * f + corner) for corner in filters.get("high_pass", ())])
    if "low_pass" in filters:
        pole = filters["low_pass"] * np.exp(1j * np.pi * (2 * np.arange(poles) + poles + 1) / (2 * poles))
        gain *= np.prod(-pole / (1j * f - pole))
    radar = build_radar(num_samples=count, num_chirps=1, receiver=ep.Receiver(**filters, low_pass_poles=poles))
    return gain * echo, ep.receive(np.tile(echo, (1, 1, 1, 1)), radar, seed=None).cube[0, 0, 0]


@pytest.mark.parametrize("count", [256, 512])
@pytest.mark.parametrize("cell", [0.5, 2.3, 5.5, 20.5, 100.3, 204.7])
def test_filters_have_settled_when_a_chirp_begins(cell, count):
    """Tones between the cells, in every sample, behind corners that settle within a chirp and over many chirps."""
    for corners in ((20e3,), (100e3,), (400e3,), (175e3, 350e3)):
        wanted, found = settled(cell, count, high_pass=corners)
        np.testing.assert_allclose(found, wanted, atol=2e-5)
    for poles in (3, 10):  # cut at 15/16 of the sampling rate, where a low pass steps to its values below 0
        wanted, found = settled(cell, count, poles, low_pass=5e6)
        np.testing.assert_allclose(found, wanted, atol=5e-4)


@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("count", [64, 256])
def test_filters_leave_near_echoes_without_noise_as_their_response_does(count, real):
    """Five tones within six cells at both ends of a chirp are nearly a polynomial: a model that explained them down to the
    roundings of numbers had foretold a past that grows without bound."""
    random = np.random.default_rng(3)
    radar = build_radar(num_samples=count, num_chirps=64, real=real, receiver=ep.Receiver(high_pass=[175e3]))
    cells, phases = random.uniform(0.5, 6.0, (2, 64, 5, 1))
    echoes = np.exp(1j * phases + 2j * np.pi * cells * np.arange(count) / count)
    f = cells * RATE / count
    pick = (lambda z: np.sqrt(2.0) * z.real) if real else (lambda z: z)
    wanted = pick((1j * f / (1j * f + 175e3) * echoes).sum(axis=1))
    found = ep.receive(pick(echoes.sum(axis=1))[None, None], radar, seed=None).cube[0, 0]
    assert np.sqrt(np.mean(np.abs(found - wanted) ** 2)) < 0.1


def test_a_burst_does_not_come_back_at_the_begin_of_its_chirp():
    """A pulse behind a corner of 20 kHz leaves a tail of 160 samples, which runs off the end: against the integral of
    x(t) - w x(s) exp(-w (t - s)), and nothing before the pulse."""
    count, fine, w = 256, 16, 2 * np.pi * 20e3
    time = np.arange(count * fine) / (RATE * fine)
    pulse = np.exp(-0.5 * ((time * RATE - 128.0) / 8.0) ** 2)
    integral = np.exp(-w * time) * np.cumsum(pulse * np.exp(w * time)) / (RATE * fine)
    wanted = (pulse - w * integral)[::fine]
    radar = build_radar(num_samples=count, num_chirps=1, receiver=ep.Receiver(high_pass=[20e3]))
    found = ep.receive(pulse[::fine].reshape(1, 1, 1, count), radar, seed=None).cube[0, 0, 0]
    np.testing.assert_allclose(found, wanted, atol=1e-3)
    assert np.abs(found[:64]).max() < 1e-4


def test_leakage_is_gone_behind_a_high_pass():
    """0.3 ns stand at 11.7 kHz: -53 dB behind corners of 175 and 350 kHz; a step at the ends of the chirp would leave -29 dB."""
    out = received(np.zeros((1, 1, 8, COUNT)), leakage_db=[[0.0]], leakage_delay=0.3e-9, high_pass=(175e3, 350e3)).cube
    f = SLOPE * 0.3e-9
    gain = np.prod([f / np.hypot(f, corner) for corner in (175e3, 350e3)])
    assert db(np.mean(np.abs(out) ** 2) / 0.01) == pytest.approx(db(gain ** 2), abs=LEVEL)


def test_high_pass_filters_lead():
    cell = 20
    out = received(tone(cell), high_pass=[350e3, 700e3]).cube
    f = cell * RATE / COUNT
    assert np.angle(out / tone(cell)) == pytest.approx(np.arctan(350e3 / f) + np.arctan(700e3 / f), abs=1e-9)


def test_filters_of_real_samples_have_the_response_of_complex_ones():
    radar = one_channel(real=True, receiver=ep.Receiver(high_pass=[350e3], low_pass=3e6, low_pass_poles=2))
    cube = np.sqrt(2.0) * tone(37).real
    out = ep.receive(cube, radar, seed=None).cube
    complex_out = received(tone(37), high_pass=[350e3], low_pass=3e6, low_pass_poles=2).cube
    np.testing.assert_allclose(out, np.sqrt(2.0) * complex_out.real, atol=SETTLED)
    fastest = ep.receive(tone(COUNT // 2).real, radar, seed=None).cube  # at half the sampling rate, where no phase is known
    np.testing.assert_allclose(fastest.imag, 0.0, atol=1e-12)


@pytest.mark.parametrize("gain_db, phase", [(0.5, 0.0), (0.0, 0.05), (-0.3, -0.03)])
def test_imbalance_makes_an_image_line(gain_db, phase):
    out = levels(received(tone(70), iq_gain_db=gain_db, iq_phase=phase).cube)
    g = 10 ** (gain_db / 20)
    ratio = (1 - 2 * g * np.cos(phase) + g * g) / (1 + 2 * g * np.cos(phase) + g * g)
    assert db(out[COUNT - 70] / out[70]) == pytest.approx(db(ratio), abs=1e-6)


def test_the_branch_q_alone_is_wrong():
    out = received(np.full((1, 1, 8, COUNT), 3.0 + 4.0j), iq_gain_db=6.0, iq_phase=0.1, dc_offset=(0.5, -0.25)).cube
    g = 10 ** 0.3
    assert out[0, 0, 0, 0] == pytest.approx(3.5 + 1j * (g * (4.0 * np.cos(0.1) + 3.0 * np.sin(0.1)) - 0.25))


def test_masks_of_phase_noise_above_the_carrier_are_refused():
    assert ep.PhaseNoise(offsets=[10.0], levels=[20.0]).levels == (20.0,)
    with pytest.raises(ValueError, match="^levels: must be at most 20 dBc/Hz, got"):
        ep.PhaseNoise(offsets=[1e4, 1e6], levels=[80.0, -90.0])


@pytest.mark.parametrize("name, shape", [("leakage_db", "[tx, rx]"), ("coupling_db", "[rx, rx]")])
def test_levels_between_channels_are_asked_for_by_their_channels(name, shape):
    with pytest.raises(ValueError, match=re.escape(f"{name}: must be an array {shape} of finite real numbers, got -30")):
        ep.Receiver(**{name: -30.0})


@pytest.mark.parametrize("make, name", [
    (lambda: ep.Receiver(iq_gain_db=1e300), "iq_gain_db"), (lambda: ep.Receiver(leakage_db=[[0.0, 2e3]]), "leakage_db"),
    (lambda: ep.Receiver(receiver_gain_db=[-1e300]), "receiver_gain_db"), (lambda: ep.Adc(gain_db=1e300), "gain_db"),
    (lambda: ep.Receiver(compression_dbm=1e300), "compression_dbm"), (lambda: ep.Adc(full_scale_dbm=-1e9), "full_scale_dbm")])
def test_decibels_whose_powers_are_no_numbers_are_refused(make, name):
    """10^(3080 / 10) is the largest number."""
    with pytest.raises(ValueError, match=f"^{name}: must be .*from -1000 to 1000 dBm?, got"):
        make()


@pytest.mark.parametrize("make, name", [
    (lambda: ep.Receiver(leakage_delay=1e300), "leakage_delay"), (lambda: ep.Receiver(coupling_delay=2.0), "coupling_delay"),
    (lambda: ep.Receiver(phase_drift=[0.0, -1e300]), "phase_drift"), (lambda: ep.Receiver(dc_offset=(0.0, 1e300)), "dc_offset"),
    (lambda: ep.Receiver(frequency_error=[0.0, 1e308]), "frequency_error"), (lambda: ep.Adc(clock_jitter=1e300), "clock_jitter")])
def test_delays_and_turns_whose_phases_are_no_numbers_are_refused(make, name):
    with pytest.raises(ValueError, match=rf"^{name}: must be .*from .* to .* (s|rad/s|sqrt\(W\)|Hz, Hz/s, ...), got"):
        make()


@pytest.mark.parametrize("rate", [1.0, -1.0])
def test_gains_that_drift_away_until_a_late_start_are_refused_before_the_trace(rate, monkeypatch):
    """1 dB/s until 8 o'clock are 28 800 dB, whose amplitude 10^1440 no number tells: maps had been without numbers."""
    monkeypatch.setattr("echopath.frame.simulate.trace_scene", None)
    radar, late = one_channel(receiver=ep.Receiver(gain_drift_db=[rate])), 28800.0
    told = "^receiver.gain_drift_db: must be from -0.03472 to 0.03472 dB/s, by which gains drift by 1000 dB from time 0 to 28800"
    with pytest.raises(ValueError, match=told):
        ep.receive(tone(40), radar, seed=1, start_time=late)
    with pytest.raises(ValueError, match=told):
        ep.simulate(ep.Scene(), radar, start_time=late)
    with pytest.raises(ValueError, match=told):
        ep.Sequence(ep.Scene(), radar, frames=28801, interval=1.0)
    drifted = ep.receive(tone(40), radar, seed=None, start_time=100.0).cube / tone(40)
    assert 20.0 * np.log10(np.abs(drifted)) == pytest.approx(100.0 * rate, abs=0.001)


@pytest.mark.parametrize("filters, name", [({"high_pass": [350e3, 1.0]}, "high_pass"), ({"low_pass": 1e-300}, "low_pass")])
def test_corners_that_would_take_hours_are_refused(filters, name):
    """A filter of 1 Hz settles over seconds, 45 million samples of 10 MHz, of which a chirp has some hundred."""
    with pytest.raises(ValueError, match=rf"^receiver\.{name}: must be at least [\d.]+ Hz at this sampling rate, got"):
        received(tone(40), **filters)


def test_what_a_receiver_gives_is_told_in_a_line():
    assert repr(received(tone(40))) == "Reception(cube [1, 1, 8, 512], codes: none)"
    told = repr(received(tone(40, 1e-6), adc=ep.Adc(gain_db=36.0)))
    assert told == "Reception(cube [1, 1, 8, 512], codes: int16 [1, 1, 8, 512, 2], gain 36 dB)"
