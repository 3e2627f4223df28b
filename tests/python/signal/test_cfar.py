"""False-alarm rates of CFAR on noise, and what it finds of echoes."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.bench.labels.false_alarms import NoiseMap, describe_false_alarms, measure_false_alarms
from support.radars import build_radar

RATE_TOLERANCE = 0.1  # of the rate; a thousand false alarms scatter by 3 to 4 %
NOISE_UNDER = 0.1          # relative: a field 30 dB below adds up to 6 %
METHODS = 0.1              # relative: the two statistics ask for nearly the same level


@pytest.mark.parametrize("of_map", [
    NoiseMap("rect"), NoiseMap("hann"), NoiseMap(("chebyshev", 60)), NoiseMap("hann", receivers=3),
    NoiseMap("hann", receivers=2, transmitters=2), NoiseMap("hann", real=True), NoiseMap(("hann", ("chebyshev", 60)))], ids=str)
def test_false_alarms_come_at_the_rate_asked_for(of_map):
    """A million cells of noise; ten times as many in the benchmark. Also of real samples, and of antennas that take
    turns."""
    for row in measure_false_alarms(1_000_000, maps=[of_map], rates=[1e-3]):
        assert row["ratio"] == pytest.approx(1.0, abs=RATE_TOLERANCE) and row["holds"], row


def test_each_row_of_the_benchmark_has_its_verdict():
    row = {"map": "hann", "method": "ca", "rate": 1e-3, "cells": 1000, "false_alarms": 1, "ratio": 1.0,
           "standard_error": 0.0}
    lines = describe_false_alarms([row | {"holds": True}, row | {"holds": False}])
    assert lines[1].endswith("holds") and lines[2].endswith("MISSES 10%")


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


@pytest.mark.parametrize("method", ["ca", "os"])
def test_an_echo_in_noise_is_found_with_its_power_and_that_of_the_noise(method):
    radar = radar_with(receivers=4)
    noise = noise_in_a_cell(radar)
    found = ep.cfar(spectrum_of_tones(radar, [(20, 40, 1000 * noise)]), radar, method=method)
    assert found.mask[20, 40] and len(found) < 12  # the main lobe of Hann: 3 x 3 cells and two beyond, weakly
    index = [tuple(cell) for cell in found.cells].index((20, 40))
    assert found.power[20, 40] == pytest.approx(1001 * noise, rel=NOISE_UNDER, abs=0)
    assert found.noise[index] == pytest.approx(noise, rel=0.15, abs=0)  # 70 independent cells of 4 channels: 6 %


def test_ordered_statistics_find_the_weaker_of_two_neighbours():
    radar = radar_with(receivers=2)
    noise = noise_in_a_cell(radar)
    spectrum = spectrum_of_tones(radar, [(20, 40, 1e5 * noise), (20, 47, 100 * noise)])
    assert not ep.cfar(spectrum, radar, method="ca").mask[20, 47]
    assert ep.cfar(spectrum, radar, method="os").mask[20, 47]


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
    for name, value in (("method", "go"), ("false_alarm_rate", 0.0), ("guard_range", 1), ("training_velocity", 40),
                        ("rank", 0.0)):
        with pytest.raises(ValueError, match=name):
            ep.cfar(spectrum, radar, **{name: value})
    with pytest.raises(TypeError, match="false_alarm_rate"):
        ep.cfar(spectrum, radar, false_alarm=1e-3)
