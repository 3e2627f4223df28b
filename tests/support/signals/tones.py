"""Cubes of points of constant velocity, and of noise."""

import numpy as np

import echopath as ep


def tone(radar, distance, velocity, power=1.0, times=None):
    """Cube of a point of constant velocity, after s(t, n) = A e^{j 2 pi (2 slope R / c n / fs + 2 f R(t) / c)}."""
    waveform = radar.waveform
    times = np.arange(waveform.num_chirps) * waveform.chirp_interval if times is None else times
    fast = np.arange(waveform.num_samples) / waveform.sampling_rate
    beat = 2.0 * waveform.slope * distance / ep.speed_of_light
    slow = 2.0 * velocity * times / waveform.wavelength
    signal = np.sqrt(power) * np.exp(2j * np.pi * (beat * fast + slow[:, None]))
    return signal[None, None]


def random_cube(radar, seed=1):
    waveform, generator = radar.waveform, np.random.default_rng(seed)
    shape = (len(radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples)
    values = generator.normal(size=shape)
    return values if waveform.real else values + 1j * generator.normal(size=shape)
