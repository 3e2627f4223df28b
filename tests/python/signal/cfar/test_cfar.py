"""False-alarm rates of CFAR on noise, and what it finds of echoes."""
from __future__ import annotations

import functools

import numpy as np
import pytest
from scipy.linalg import toeplitz

import echopath as ep
from echopath.bench.labels.false_alarms import NoiseMap, describe_false_alarms, measure_false_alarms
from echopath.receiver.filters import beat_frequencies, length_of_past, response
from echopath.spectra.noise_shape import noise_shape
from support.radars import build_radar

RATE_TOLERANCE = 0.1  # of the rate; a thousand false alarms scatter by 3 to 4 %
NOISE_UNDER = 0.1          # relative: a field 30 dB below adds up to 6 %
METHODS = 0.1              # relative: the two statistics ask for nearly the same level


@pytest.mark.parametrize("of_map", [
    NoiseMap("rect"), NoiseMap("hann"), NoiseMap(("chebyshev", 60)), NoiseMap("hann", receivers=4),
    NoiseMap("hann", receivers=2, transmitters=2), NoiseMap("hann", receivers=4, low_pass=8e6), NoiseMap("hann", real=True),
    NoiseMap(("hann", ("chebyshev", 60)))], ids=str)
def test_false_alarms_come_at_the_rate_asked_for(of_map):
    """A thousand false alarms; ten times as many, and rarer ones, in the benchmark. Also of real samples, and of antennas that
    take turns. Maps of as many channels follow each other: they share their thresholds, which take most of the time."""
    for row in measure_false_alarms(330_000, maps=[of_map], rates=[3e-3]):
        assert row["ratio"] == pytest.approx(1.0, abs=RATE_TOLERANCE) and row["holds"], row


@pytest.mark.parametrize(("num_chirps", "zero_pad"), [(1, 1), (1, 4), (2, 2), (2, 4)])
def test_an_echo_in_one_or_two_chirps_is_found_with_any_padding(num_chirps, zero_pad):
    """Cells of velocity are all the same then. A tone of 12.8 cells and 1e-8 W, 40 dB above the noise of a sample."""
    radar = build_radar(num_chirps=num_chirps, num_samples=64)
    noise = np.random.default_rng(1).normal(scale=7e-7, size=(2, 1, 1, num_chirps, 64))
    cube = 1e-4 * np.exp(0.4j * np.pi * np.arange(64)) + noise[0] + 1j * noise[1]
    found = ep.detect(ep.range_doppler(cube, radar, zero_pad=zero_pad), radar)
    assert found.range == pytest.approx([12.8 * radar.waveform.range_resolution], rel=1e-3)
    assert found.power == pytest.approx([1e-8], rel=0.02)


BEHIND = {"low pass": dict(low_pass=8e6), "steep": dict(low_pass=5e6, low_pass_poles=8),
          "high pass": dict(high_pass=[3e5, 8e5], low_pass=8e6), "imbalance": dict(low_pass=4e6, iq_gain_db=1.0, iq_phase=0.1),
          "converter": dict(low_pass=5e6, adc=ep.Adc(bits=12, gain_db=40.0)),
          "automatic gain": dict(low_pass=5e6, adc=ep.Adc(bits=10, automatic_gain=True)), "real": dict(low_pass=3e6)}
SIXTEENTHS = 0.25  # relative: of some 400 false alarms in each, of which neighbours come together; of 4 channels they are rarer
LEAKED = 0.3
RATE = 1e-2


def noise_behind(receiver, seed, real=False, receivers=4, num_samples=256):
    """(radar, what its receivers have of noise alone, [1, rx, chirp, sample])"""
    radar = build_radar(receivers=[(0, 0.002 * k, 0) for k in range(receivers)], num_chirps=64, num_samples=num_samples,
                        real=real, receiver=ep.Receiver(**receiver))
    nothing = np.zeros((1, receivers, 64, num_samples), complex)
    return radar, ep.receive(nothing, radar, seed=seed).cube


@functools.lru_cache(maxsize=25)
def noise_of(receiver, seed):
    """As `noise_behind`, of a name of BEHIND, kept for all methods and windows, which follow each other."""
    return noise_behind(BEHIND[receiver], seed, receiver == "real")


@functools.lru_cache(maxsize=25)
def map_of_noise(receiver, seed, window):
    radar, noise = noise_of(receiver, seed)
    return ep.range_doppler(noise, radar, window), radar


@pytest.mark.parametrize("window, method", [("hann", "ca"), ("hann", "os"), ("rect", "ca")])
@pytest.mark.parametrize("receiver", BEHIND)
def test_false_alarms_behind_filters_come_at_the_rate_at_all_ranges(receiver, window, method):
    """Noise falls by up to 80 dB over the ranges, and jumps up where the largest are those of negative frequencies: up to 60
    times the false alarms of the rate had been there, and none before."""
    maps = [map_of_noise(receiver, seed, window) for seed in range(25)]
    alarms = np.mean([ep.cfar(*one, method=method, false_alarm_rate=RATE).mask for one in maps], axis=(0, 1))
    first = len(alarms) // 16 if receiver == "real" else 0  # the image leaks into the main lobe of range 0
    shares = [one.mean() / RATE for one in np.array_split(alarms[first:], 16)]
    tolerance = SIXTEENTHS * (1.0 if method == "ca" else 1.5) * (1.5 if receiver == "real" else 1.0)
    # Where filters leave less than the window leaks from other ranges, neighbours vary together, and false alarms are rarer.
    least = LEAKED if receiver == "steep" or window == "rect" else 1.0 - tolerance
    assert max(shares) < 1.0 + tolerance and min(shares) > least, np.round(shares, 2)


@pytest.mark.parametrize("adc", [None, ep.Adc(bits=12, gain_db=50.0)], ids=["analogue", "converter"])
def test_noise_next_to_range_0_is_known_where_a_high_pass_leaves_none(adc):
    """The levels that tell white noise lie below those of the next ranges by 20 dB and more."""
    alarms, levels, told = [], [], []
    for seed in range(20):
        radar, noise = noise_behind(dict(high_pass=[4e5, 4e5], adc=adc), seed)
        spectrum = ep.range_doppler(noise, radar)
        alarms.append(ep.cfar(spectrum, radar, false_alarm_rate=RATE).mask[:, :2].mean())
        levels.append(np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1, 2))[:2] / ep.noise_power(radar, window="hann"))
        told.append(noise_shape(spectrum, radar)[:2])
    assert np.mean(alarms) < 2.0 * RATE                                  # 26 are asked for, which come in pairs
    assert 10 * np.log10(np.mean(told, axis=0) / np.mean(levels, axis=0)) == pytest.approx([0.0, 0.0], abs=0.4)  # dB


def test_noise_that_has_not_passed_the_filters_is_alike_at_all_ranges():
    radar, _ = noise_behind(BEHIND["low pass"], 0)
    alarms = [ep.cfar(ep.range_doppler(ep.add_noise(np.zeros((1, 4, 64, 256), complex), radar, seed=seed), radar), radar,
                      false_alarm_rate=RATE).mask.mean(axis=0) for seed in range(30)]
    shares = [one.mean() / RATE for one in np.array_split(np.mean(alarms, axis=0), 16)]
    assert shares == pytest.approx([1.0] * 16, abs=1.5 * SIXTEENTHS)


@functools.lru_cache(maxsize=1)
def levels_behind_a_low_pass():
    """[range] in W, the mean of 18 maps of noise."""
    made = (noise_behind(BEHIND["low pass"], seed) for seed in range(2, 20))
    return np.mean([np.abs(ep.range_doppler(noise, radar).values) ** 2 for radar, noise in made], axis=(0, 1, 2, 3))


@pytest.mark.parametrize("cell", [(20, 40), (20, 200), (20, 236), (20, 248)])
def test_an_echo_behind_filters_is_found_with_the_noise_at_its_range(cell):
    """Echoes 15 dB above the noise behind the filters, before the fall, in it, below the jump and behind it."""
    radar, noise = noise_behind(BEHIND["low pass"], 1)
    levels = levels_behind_a_low_pass()
    chirp, sample = np.arange(64)[:, None], np.arange(256)
    tone = np.exp(2j * np.pi * ((cell[0] - 32) * chirp / 64 + cell[1] * sample / 256)) * np.ones((1, 4, 1, 1))
    spectrum = ep.range_doppler(noise + np.sqrt(10.0 ** 1.5 * levels[cell[1]]) * tone, radar)
    found = ep.cfar(spectrum, radar)
    assert found.mask[cell] and len(found) < 12
    index = [tuple(one) for one in found.cells].index(cell)
    assert found.noise[index] == pytest.approx(levels[cell[1]], rel=0.2, abs=0)


@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("receiver", [dict(high_pass=[1.75e5, 3.5e5], low_pass=5e6), dict(low_pass=3e6, low_pass_poles=8),
                                      dict(high_pass=[2e4])], ids=str)
def test_noise_behind_filters_is_the_sum_of_what_each_sample_sends(receiver, real):
    """Twice the cells, of a chirp of 768 samples: the responses to each of them, as a matrix of the filters' samples."""
    radar = build_radar(num_chirps=2, chirp_interval=1e-3, num_samples=768, real=real, receiver=ep.Receiver(**receiver))
    spectrum = ep.range_doppler(np.zeros((1, 1, 2, 768), complex), radar, window="hann", zero_pad=2)
    past = length_of_past(radar.waveform, radar.receiver)
    impulse = np.fft.ifft(response(radar.receiver, beat_frequencies(radar.waveform, 768 + past)))
    sent = toeplitz(impulse[:768], impulse[-np.arange(768)])  # [sample, sample of the noise]
    window = np.hanning(769)[:768]
    cells = np.fft.fft(window[:, None] * sent, 2 * 768, axis=0)
    expected = np.sum(np.abs(cells) ** 2, axis=1) / np.sum(window ** 2)
    shape = noise_shape(spectrum, radar)
    assert len(shape) == (768 if real else 1536)
    assert shape == pytest.approx(expected[:len(shape)], rel=0, abs=1e-12 * expected.max())


def test_the_image_of_noise_comes_from_the_opposite_frequency():
    """(1 - g e^{jp}) / 2 of what a narrow notch leaves there, cell by cell."""
    notch, branches = dict(high_pass=[3e5, 3e5]), dict(iq_gain_db=6.0, iq_phase=0.4)
    plain, found = (noise_shape(ep.range_doppler(np.zeros((1, 1, 2, 256), complex), radar), radar) for radar in (
        build_radar(num_chirps=2, num_samples=256, receiver=ep.Receiver(**faults)) for faults in (notch, notch | branches)))
    own, image = (abs(0.5 + sign * 0.5 * 10.0 ** 0.3 * np.exp(0.4j)) ** 2 for sign in (1, -1))
    assert found == pytest.approx(own * plain + image * plain[-np.arange(256)], rel=1e-9)


def test_each_row_of_the_benchmark_has_its_verdict():
    row = {"map": "hann", "method": "ca", "rate": 1e-3, "cells": 1000, "false_alarms": 1, "ratio": 1.0,
           "standard_error": 0.0}
    lines = describe_false_alarms([row | {"holds": True}, row | {"holds": False}])
    assert lines[1].endswith("holds") and lines[2].endswith("MISSED 10%")


def radar_with(num_chirps=64, num_samples=128, receivers=1):
    return build_radar(receivers=[(0, 0.002 * k, 0) for k in range(receivers)], num_chirps=num_chirps,
                       num_samples=num_samples)


def spectrum_of_tones(radar, tones, window="hann"):
    """(velocity cell, range cell, power in W) each, in noise of the receiver."""
    waveform = radar.waveform
    chirp, sample = np.arange(waveform.num_chirps), np.arange(waveform.num_samples)
    cube = np.zeros((1, len(radar.receivers), len(chirp), len(sample)), complex)
    for velocity, distance, power in tones:
        cycles = np.add.outer((velocity - len(chirp) // 2) * chirp / len(chirp), distance * sample / len(sample))
        cube += np.sqrt(power) * np.exp(2j * np.pi * cycles)
    return ep.range_doppler(ep.add_noise(cube, radar, seed=3), radar, window=window)


def noise_in_a_cell(radar, window_gain=1.5 ** 2):
    """W, for Hann on both axes."""
    waveform = radar.waveform
    power = ep.boltzmann * 290.0 * 10 ** (radar.noise_figure_db / 10) * waveform.sampling_rate
    return power * window_gain / (waveform.num_chirps * waveform.num_samples)


@pytest.mark.parametrize("method", ["ca", "os", "go", "so"])
def test_an_echo_in_noise_is_found_with_its_power_and_that_of_the_noise(method):
    radar = radar_with(receivers=4)
    noise = noise_in_a_cell(radar)
    found = ep.cfar(spectrum_of_tones(radar, [(20, 40, 1000 * noise)]), radar, method=method)
    assert found.mask[20, 40] and len(found) < 12  # the main lobe of Hann: 3 x 3 cells and two beyond, weakly
    index = [tuple(cell) for cell in found.cells].index((20, 40))
    assert found.power[20, 40] == pytest.approx(1001 * noise, rel=NOISE_UNDER, abs=0)
    assert found.noise[index] == pytest.approx(noise, rel=0.15, abs=0)  # 70 independent cells of 4 channels: 6 %


def test_ordered_statistics_find_the_weaker_of_two_neighbours():
    radar = radar_with(receivers=4)
    noise = noise_in_a_cell(radar)
    spectrum = spectrum_of_tones(radar, [(20, 40, 1e5 * noise), (20, 47, 100 * noise)])
    assert not ep.cfar(spectrum, radar, method="ca").mask[20, 47]
    assert ep.cfar(spectrum, radar, method="os").mask[20, 47]
    assert ep.cfar(spectrum, radar, method="so").mask[20, 47] and not ep.cfar(spectrum, radar, method="go").mask[20, 47]


def test_the_greatest_of_two_halves_keeps_the_rate_where_noise_begins():
    """Clutter of 30 dB from range 64 on: cells just before and behind have training cells of both kinds."""
    radar = radar_with()
    edges = {method: 0.0 for method in ("ca", "go", "so")}
    for seed in range(20):
        values = np.random.default_rng(seed).normal(size=(1, 1, 64, 128, 2)).view(complex)[..., 0]
        spectrum = ep.range_doppler(np.fft.ifft(np.fft.ifft(values * np.where(np.arange(128) < 64, 1.0, 31.6), axis=3), axis=2),
                                    radar, "rect")
        for method in edges:
            edges[method] += ep.cfar(spectrum, radar, method=method, false_alarm_rate=1e-3).mask[:, 64:72].mean() / 20
    # Half of the training cells of the first cell of clutter lie before it: their mean is half of what it should be.
    assert edges["go"] < 3e-3 < edges["ca"] < edges["so"] and edges["so"] > 0.1


def test_the_factor_is_power_over_noise_that_the_rate_needs():
    """Cell averaging without correlation: N (P^(-1/N) - 1)."""
    spectrum = spectrum_of_tones(radar_with(), [], window="rect")
    found = ep.cfar(spectrum, radar_with(), false_alarm_rate=1e-5, training_velocity=3, training_range=5)
    count = 9 * 13 - 9
    assert found.guard == (1, 1) and found.training == (3, 5)
    assert found.factor == pytest.approx(count * (1e-5 ** (-1 / count) - 1))
    ordered = ep.cfar(spectrum, radar_with(), method="os", false_alarm_rate=1e-5)
    assert ordered.factor == pytest.approx(found.factor, rel=METHODS, abs=0)


def test_arrays_fit_each_other_and_the_text_says_what_was_done():
    radar = radar_with()
    found = ep.cfar(spectrum_of_tones(radar, [(20, 40, 1e-10)]), radar, false_alarm_rate=0.01)
    assert found.power.shape == found.mask.shape == (64, 128)
    assert np.array_equal(np.argwhere(found.mask), found.cells)
    assert len(found) == len(found.noise) == found.mask.sum() > 0
    assert "method 'ca'" in repr(found) and "guard 2 x 2" in repr(found)


def test_bad_arguments_are_named():
    radar = radar_with()
    spectrum = spectrum_of_tones(radar, [])
    for name, value in (("method", "gold"), ("false_alarm_rate", 0.0), ("guard_range", 1), ("training_velocity", 40),
                        ("rank", 0.0)):
        with pytest.raises(ValueError, match=name):
            ep.cfar(spectrum, radar, **{name: value})
    with pytest.raises(TypeError, match="false_alarm_rate"):
        ep.cfar(spectrum, radar, false_alarm=1e-3)


def test_maps_without_room_for_noise_are_told_so():
    """The main lobe of Hann's window is two cells wide on each side: three velocities and two ranges lie within."""
    small = radar_with(num_chirps=3, num_samples=2)
    spectrum = ep.range_doppler(np.ones((1, 1, 3, 2), complex), small)
    with pytest.raises(ValueError, match="^spectrum: must have cells beside the main lobe .* got 3 x 2$"):
        ep.cfar(spectrum, small)
